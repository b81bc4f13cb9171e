//! What a part of space meets in a periodic cell: particles, and images of them wherever they stand.

use crate::base::geometry::Lattice;
use crate::base::number::Vector;
use crate::engine::state::{IMAGE, State};
use crate::scene::Scene;

/// A part of space, as particles see it.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// The cell as it is now and between which parts of its edges the part lies, where there is a cell.
    cell: Option<(Lattice, [[f64; 2]; 3])>,
}

impl Place {
    /// A box \[m\].
    pub(crate) fn of(scene: &Scene, state: &State, corners: [[f64; 3]; 2]) -> Self {
        let lattice = lattice(scene, state);
        Self { cell: lattice.map(|lattice| (lattice, lattice.parts_of_box(corners))) }
    }

    /// Hands out where what is at a point, or an image of it, is no further than `depth` from the part \[m\]; without a cell the point.
    #[inline]
    pub(crate) fn meets(&self, point: Vector, depth: f64, mut hand: impl FnMut(Vector)) {
        match &self.cell {
            None => hand(point),
            Some((lattice, parts)) => {
                lattice.near(point.to_array(), parts, depth, |shift| hand(point + Vector::from(shift)));
            }
        }
    }
}

/// The periodic cell of a scene as it is now.
pub(crate) fn lattice(scene: &Scene, state: &State) -> Option<Lattice> {
    let (cell, now) = (scene.cell.as_ref()?, state.cell.as_ref()?);
    Some(Lattice { edges: now.edges, ..cell.lattice })
}

/// The rows of particles that are no images of others (slots).
pub(crate) fn particles(state: &State) -> impl Iterator<Item = usize> + '_ {
    let owners = state.particles.owner.iter().enumerate();
    owners.filter(|(_, owner)| **owner != IMAGE).map(|(slot, _)| slot)
}
