//! `disc`: a circular plate, with or without a hole.

use super::profile::Revolution;
use super::{Shape, ShapeContext, ShapeKeys, direction};
use crate::base::document::keys;
use crate::base::quantity::{Positive, Triple};

keys! {
    /// `disc = { centre, normal, radius }`
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Keys {
        /// Its centre \[m\].
        centre: Triple = "required",
        /// Across it, of any length but 0.
        normal: Triple = "required",
        /// Its radius \[m\].
        radius: Positive = "required",
        /// Radius of the hole in its middle \[m\].
        hole: Option<Positive> = "none",
    }
}

impl ShapeKeys for Keys {
    const KEY: &'static str = "disc";
    const HINT: &'static str = "disc = { centre, normal, radius }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        let (material, normal) = (around.material("a disc"), direction(self.normal.0));
        if normal.is_none() {
            around.refuse("disc.normal", "one of length 0".to_owned(), "a normal across the disc");
        }
        let (hole, radius) = (self.hole.map_or(0.0, Positive::get), self.radius.get());
        if hole >= radius {
            around.refuse("disc.hole", format!("{hole:?}"), "a radius below that of the disc");
            return None;
        }
        let (centre, axis) = (self.centre.0.into(), normal?.into());
        Some(Shape::of(Revolution::of("disc", material?, (centre, axis), &[[hole, 0.0], [radius, 0.0]])))
    }
}
