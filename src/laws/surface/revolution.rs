//! `revolution`: any profile of straight segments, turned about an axis: hoppers, funnels, vessels.

use super::profile::Revolution;
use super::{Shape, ShapeContext, ShapeKeys, direction};
use crate::base::document::keys;
use crate::base::quantity::{Finite, Triple};

keys! {
    /// `revolution = { origin, axis, profile }`
    #[derive(Clone, Debug)]
    pub(crate) struct Keys {
        /// Where heights are counted from on the axis \[m\].
        origin: Triple = "required",
        /// Along the axis, of any length but 0.
        axis: Triple = "required",
        /// Corners `[radius, height]` of the profile, joined by straight lines and turned about the axis \[m\].
        profile: Vec<[Finite; 2]> = "required",
    }
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "revolution";
    const HINT: &'static str = "revolution = { origin, axis, profile }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let (material, axis) = (around.material("a surface of revolution"), direction(self.axis.0));
        if axis.is_none() {
            around.refuse("revolution.axis", "one of length 0".to_owned(), "a vector along the axis");
        }
        let profile: Vec<[f64; 2]> = self.profile.iter().map(|corner| corner.map(Finite::get)).collect();
        let wrong = match &profile[..] {
            [] | [_] => Some(("fewer".to_owned(), "two corners or more")),
            _ => {
                let inward = profile.iter().find(|corner| corner[0] < 0.0);
                let inward = inward.map(|corner| (format!("radius {:?}", corner[0]), "radii of 0 or above"));
                let twice = profile.windows(2).find(|two| two[0] == two[1]);
                inward.or(twice.map(|two| (format!("corner {:?} twice", two[0]), "corners apart from each other")))
            }
        };
        if let Some((found, expected)) = wrong {
            around.refuse("revolution.profile", found, expected);
            return None;
        }
        let about = (self.origin.0.into(), axis?.into());
        Some(Shape::of(Revolution::of("revolution", material?, about, &profile)))
    }
}
