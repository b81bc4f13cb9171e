//! The box around the particles of a file.

use super::FileFault;
use crate::base::document::Mistake;
use crate::base::geometry::Lattice;
use crate::scene::cell::fault_of;

/// The box of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FileBox {
    /// Its corner and edges, and along which edges it repeats if the file says so \[m\].
    pub(crate) lattice: Lattice,
    /// Whether the file says along which edges it repeats.
    pub(crate) is_told: bool,
    /// The line that tells it, or the first one with a particle that crossed its faces; none in a file without lines.
    pub(crate) line: Option<usize>,
    /// Whether there is such a particle.
    pub(crate) is_crossed: bool,
}

impl FileBox {
    /// Whether particles of the file are in a cell that repeats.
    pub(crate) fn is_periodic(&self) -> bool {
        self.is_crossed || self.lattice.periodic != [false; 3]
    }
}

/// Numbers of a box as a file writes them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// The lower corner.
    pub(super) low: [f64; 3],
    /// The edges.
    pub(super) edges: [[f64; 3]; 3],
}

impl Bounds {
    /// The box of these numbers at a line, if its edges are as a cell has them.
    pub(super) fn lattice(self, line: Option<usize>) -> Result<Lattice, Vec<FileFault>> {
        let lattice = Lattice { origin: self.low, edges: self.edges, periodic: [false; 3] };
        match fault_of(&lattice) {
            None => Ok(lattice),
            Some(expected) => {
                let found = format!("a box with edges {:?}", self.edges);
                let mistake = Mistake::Unexpected { found, expected: expected.to_owned() };
                Err(vec![FileFault { line, column: String::new(), mistake }])
            }
        }
    }
}
