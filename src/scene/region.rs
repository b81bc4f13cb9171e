//! Regions as parts of a scene.

use crate::base::document::Mistake;
use crate::base::quantity::BoundaryIndex;
use crate::laws::region::{self, Keys};
use crate::laws::surface::Files;

/// `[region.<name>]`: a part of space that is looked at.
#[derive(Clone, Debug)]
pub struct Region {
    /// Its name in the scene and in the unit's variables.
    pub name: String,
    /// What it looks like at time 0.
    pub shape: region::Region,
    /// The boundary whose displacement it shares; none for one that stays where it is.
    pub follows: Option<BoundaryIndex>,
}

impl Region {
    /// The region that a scene with these boundaries writes so; refuses what is wrong, with its key.
    pub(crate) fn of(name: &str, keys: &Keys, boundaries: &[&str], around: &mut dyn Files) -> Option<Self> {
        if boundaries.contains(&name) {
            let (found, expected) = (format!("that of [boundary.{name}]"), "a name of its own".to_owned());
            around.report("", Mistake::Unexpected { found, expected });
        }
        let follows = keys.follows.as_ref().map(|followed| {
            let place = boundaries.iter().position(|boundary| boundary == followed);
            BoundaryIndex(place.unwrap_or_else(|| {
                let (found, known) = (followed.clone(), boundaries.iter().map(|&name| name.to_owned()).collect());
                around.report("follows", Mistake::UnknownName { found, kind: "boundary", known });
                0
            }) as u32)
        });
        keys.shape(around).map(|shape| Self { name: name.to_owned(), shape, follows })
    }
}
