//! `cone`: a cone or the frustum of one, open or capped.

use super::cylinder::{Caps, axis};
use super::profile::Revolution;
use super::{Shape, ShapeContext, ShapeKeys};
use crate::base::quantity::{NonNegative, Triple};
use serde::Deserialize;

/// `cone = { from, to, radii }`
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Keys {
    /// Where its axis begins \[m\].
    from: Triple,
    /// Where its axis ends \[m\].
    to: Triple,
    /// The radii there; one of them may be 0 \[m\].
    radii: [NonNegative; 2],
    /// Which ends are closed.
    #[serde(default)]
    caps: Caps,
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "cone";
    const HINT: &'static str = "cone = { from, to, radii }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let (material, axis) = (around.material("a cone"), axis(self.from, self.to, "cone", around));
        let [from, to] = self.radii.map(NonNegative::get);
        if from == 0.0 && to == 0.0 {
            around.refuse("cone.radii", "two radii of 0".to_owned(), "at least one above 0");
            return None;
        }
        let (material, (origin, along, length)) = (material?, axis?);
        let profile = self.caps.close([[from, 0.0], [to, length]]);
        Some(Shape::of(Revolution::of("cone", material, (origin, along), &profile)))
    }
}
