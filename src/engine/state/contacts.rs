//! Pairs that may touch, with the history of those that do.

use super::in_place::clone_in_place;
use super::{History, Row, plain};
use serde::{Deserialize, Serialize};

/// When the neighbour lists were made, and for where.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Neighbours {
    /// How far beyond touch pairs are listed \[m\].
    pub skin: f64,
    /// A bound of how far any particle has moved since the lists were made \[m\].
    pub travel: f64,
    /// Where the particles were when the lists were made; empty where nothing can touch.
    pub reference: Columns,
    /// Offset of each boundary when the lists were made \[m\].
    pub boundary_reference: Vec<[f64; 3]>,
    /// Its orientation then.
    #[serde(with = "plain")]
    pub boundary_orientation: Vec<Row>,
    /// How far from its point of reference a surface that can turn meets particles \[m\].
    #[serde(with = "plain")]
    pub boundary_extent: Vec<f64>,
    /// First particle of each slab, and behind the last one the number of particles. Pairs reach no
    /// further than the next slab, so slabs of one parity can be worked on side by side.
    #[serde(with = "plain")]
    pub slabs: Vec<u32>,
    /// Time step when the lists were made.
    pub made_at: u64,
}

clone_in_place!(Neighbours {
    skin,
    travel,
    reference,
    boundary_reference,
    boundary_orientation,
    boundary_extent,
    slabs,
    made_at
});

/// Positions and radii in columns, for tests of several particles that stand side by side. Each column has room behind
/// the last particle for a register that begins there.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Columns {
    /// Along x \[m\].
    #[serde(with = "plain")]
    pub x: Vec<f64>,
    /// Along y \[m\].
    #[serde(with = "plain")]
    pub y: Vec<f64>,
    /// Along z \[m\].
    #[serde(with = "plain")]
    pub z: Vec<f64>,
    /// Radii \[m\].
    #[serde(with = "plain")]
    pub radius: Vec<f64>,
}

clone_in_place!(Columns { x, y, z, radius });

/// Near pairs of one contact law: a half list ordered by the first particle, then the second.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactList {
    /// First pair of each slab, and behind the last one the number of pairs.
    #[serde(with = "plain")]
    pub slabs: Vec<u32>,
    /// First particle of each pair (slot).
    #[serde(with = "plain")]
    pub first: Vec<u32>,
    /// Second particle of each pair (slot).
    #[serde(with = "plain")]
    pub second: Vec<u32>,
    /// Bits of each pair: [`TOUCHING`], [`SLIDING`] and what bonds leave of it.
    #[serde(with = "plain")]
    pub flags: Vec<u8>,
    /// What is kept of each pair, as `first` sees `second`: the rows of its law, in their order, and behind them
    /// [`OFFSET`](crate::laws::contact::OFFSET) where bonds suppress contacts.
    pub history: History,
    /// What the normal model keeps of each pair; empty where it keeps nothing. Follows from the pair.
    #[serde(with = "plain")]
    pub pair_constant: Vec<f64>,
}

clone_in_place!(ContactList { slabs, first, second, flags, history, pair_constant });

/// The two bodies overlapped in the last evaluation.
pub const TOUCHING: u8 = 1;

/// The tangential spring was at its limit in the last evaluation.
pub use crate::laws::contact::SLIDING;

/// A bond that suppresses the contact was made in the present time step: it still acts as it did before.
pub const FRESH: u8 = 4;

/// While a bond suppresses it nothing of the contact acts, not even friction.
pub const SILENT: u8 = 8;

/// The offset outlives the parting of the bodies, as in the engine.
pub const LASTING: u8 = 16;

/// A living bond suppresses the normal force of the contact.
pub const BONDED: u8 = 64;

/// No bond suppresses it any more; its normal force is taken from an offset.
pub const RELEASED: u8 = 128;

/// Whether a contact is one of those that are counted and told.
pub fn is_told(flags: u8) -> bool {
    flags & TOUCHING != 0 && !is_suppressed(flags)
}

/// Whether a bond takes the place of a contact.
pub fn is_suppressed(flags: u8) -> bool {
    flags & (BONDED | SILENT) == BONDED | SILENT
}

/// Whether there is nothing to do for a contact until its bond breaks: what it remembers follows from where the bodies are
/// then. A lasting offset is that of the last touch, which has to be followed.
pub fn is_resting(flags: u8) -> bool {
    flags & (BONDED | SILENT | LASTING) == BONDED | SILENT
}

/// Particles near one plane, for one contact law.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallContacts {
    /// Index of the boundary.
    pub boundary: u32,
    /// Index of the contact law.
    pub law: u32,
    /// The particles (slots), ascending.
    #[serde(with = "plain")]
    pub particle: Vec<u32>,
    /// Bits of each: [`TOUCHING`], [`SLIDING`] and what bonds leave of it.
    #[serde(with = "plain")]
    pub flags: Vec<u8>,
    /// What is kept of each, as for pairs.
    pub history: History,
    /// What the normal model keeps of each; empty where it keeps nothing.
    #[serde(with = "plain")]
    pub pair_constant: Vec<f64>,
    /// At a surface of features, whose contacts the lists above hold: the feature of each; elsewhere empty.
    #[serde(with = "plain")]
    pub feature: Vec<u32>,
    /// What is near a surface of features.
    pub near: NearParts,
}

/// Particles near a surface of features, and which of its parts are near each.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NearParts {
    /// The particles (slots), ascending.
    #[serde(with = "plain")]
    pub particle: Vec<u32>,
    /// First part of each, and behind the last one the number of parts.
    #[serde(with = "plain")]
    pub starts: Vec<u32>,
    /// The parts.
    #[serde(with = "plain")]
    pub parts: Vec<u32>,
    /// A feature of the plane in which those of each lie, if they lie in one that goes on as far as it may come until the lists
    /// are made again ([`NO_PLANE`](crate::laws::surface::NO_PLANE) otherwise).
    #[serde(with = "plain")]
    pub plane: Vec<u32>,
}

clone_in_place!(WallContacts { boundary, law, particle, flags, history, pair_constant, feature, near });

clone_in_place!(NearParts { particle, starts, parts, plane });
