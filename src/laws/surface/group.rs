//! `particles`: a group of particles that moves as one rigid body.

use super::{Shape, ShapeContext, ShapeKeys, Surface};
use crate::base::document::keys;
use crate::base::quantity::Corners;
use crate::base::words::counted;

/// A group of particles that moves as one rigid body. Its particles touch others as all particles do; its load is the sum
/// of theirs.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Indices into the scene's particles, ascending.
    pub members: Vec<u32>,
}

impl Surface for Group {
    fn key(&self) -> &'static str {
        "particles"
    }

    fn words(&self) -> String {
        format!("group of {}", counted(self.members.len(), "particle"))
    }

    fn members(&self) -> &[u32] {
        &self.members
    }

    fn turns(&self) -> bool {
        true
    }
}

impl ShapeKeys for Selection {
    const KEY: &'static str = "particles";
    const HINT: &'static str = "particles = { set, box, ids }";

    fn shape(&self, around: &mut dyn ShapeContext) -> Option<Shape> {
        around.no_material("particles have their own material");
        Some(Shape::of(Group { members: around.select(self) }))
    }
}

keys! {
    /// Which particles: those for which everything given here holds.
    #[derive(Clone, Debug, Default)]
    pub struct Selection {
        /// Name of a set.
        pub(crate) set: Option<String> = "all",
        /// Names of sets.
        pub(crate) sets: Option<Vec<String>> = "all",
        /// Lower and upper corner of a box that holds the centres, faces included \[m\].
        pub(crate) r#box: Option<Corners> = "all",
        /// Numbers of particles.
        pub(crate) ids: Option<Vec<u32>> = "all",
    }
}
