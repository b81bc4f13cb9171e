//! `cone`: a cone or the frustum of one, open or capped.

use super::cylinder::{Caps, axis};
use super::profile::Revolution;
use super::{Shape, ShapeContext, ShapeKeys};
use crate::base::document::keys;
use crate::base::quantity::{NonNegative, Triple};

keys! {
    /// `cone = { from, to, radii }`
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Keys {
        /// Where its axis begins \[m\].
        from: Triple = "required",
        /// Where its axis ends \[m\].
        to: Triple = "required",
        /// The radii there; one of them may be 0 \[m\].
        radii: [NonNegative; 2] = "required",
        /// Which ends are closed: `"from"`, `"to"`, `"both"`.
        #[serde(default)]
        caps: Caps = "`\"none\"`",
    }
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
