//! `[region.<name>]` as a scene writes it.

use super::{Cuboid, Cylinder, Region};
use crate::document::Mistake;
use crate::quantity::{Corners, Positive, Triple};
use serde::Deserialize;

/// `[region.<name>]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Keys {
    /// Corners of a box \[m\].
    #[serde(rename = "box")]
    corners: Option<Corners>,
    /// A cylinder.
    cylinder: Option<CylinderKeys>,
    /// Name of the boundary with which it is displaced.
    pub(crate) follows: Option<String>,
}

/// `cylinder = { from, to, radius }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CylinderKeys {
    /// Centre of one end \[m\].
    from: Triple,
    /// Centre of the other \[m\].
    to: Triple,
    /// Radius \[m\].
    radius: Positive,
}

impl Keys {
    /// The region; otherwise the key that is wrong.
    pub(crate) fn shape(&self) -> Result<Region, (&'static str, Mistake)> {
        let wrong = |key, found: String, right: &str| Err((key, Mistake::Wrong { found, right: right.to_owned() }));
        let (key, shape) = match (self.corners, self.cylinder) {
            (Some(Corners(corners)), None) => ("box", Region::Box(Cuboid { corners })),
            (None, Some(CylinderKeys { from: Triple(from), to: Triple(to), radius })) => {
                let Some(cylinder) = Cylinder::new(from, to, radius.get()) else {
                    return wrong("cylinder", format!("from and to at {from:?}"), "two different points");
                };
                ("cylinder", Region::Cylinder(cylinder))
            }
            (Some(_), Some(_)) => return wrong("", "box and cylinder".to_owned(), "one shape"),
            (None, None) => {
                let shapes = "box = [[x, y, z], [x, y, z]] or cylinder = { from, to, radius }";
                return Err(("", Mistake::Missing { right: format!("{shapes} gives its shape") }));
            }
        };
        match shape.volume() {
            volume if volume.is_normal() => Ok(shape),
            volume => wrong(key, format!("a volume of {volume:?} m³"), "one that 64 bits hold"),
        }
    }
}
