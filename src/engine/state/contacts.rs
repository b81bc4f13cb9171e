//! Pairs that may touch, with the history of those that do.

use super::check::{
    FINITE, StateFault, all_finite, ascending, column, demand, demand_all, ends, finite, has_rows, in_slabs, remembered,
};
use super::in_place::clone_in_place;
use super::{Clock, History, Row, plain};
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

impl Neighbours {
    /// Whether the lists can have been made for so many particles and boundaries.
    pub(super) fn check(&self, particles: usize, boundaries: usize, clock: &Clock) -> Result<(), StateFault> {
        all_finite(&[self.skin, self.travel], "neighbours")?;
        demand(self.skin >= 0.0 && self.travel >= 0.0, "neighbours", 0, "a skin and a way of 0 or above")?;
        demand(self.made_at <= clock.steps, "neighbours", 1, "a step in which the lists were made that is past")?;
        let Columns { x, y, z, radius } = &self.reference;
        let same = [y, z, radius].into_iter().all(|column| column.len() == x.len());
        let fits = x.is_empty() || x.len() >= particles;
        demand(same && fits, "reference", x.len(), "a place for each particle")?;
        for column in [x, y, z, radius] {
            all_finite(column, "reference")?;
        }
        let there = self.boundary_reference.len();
        demand(there == 0 || there == boundaries, "boundary_reference", there, "one for each boundary")?;
        let others = [self.boundary_orientation.len(), self.boundary_extent.len()];
        demand_all(others.iter().map(|other| *other == there), "boundary_reference", "one for each boundary")?;
        finite(&self.boundary_orientation, "boundary_orientation")?;
        let extents = self.boundary_extent.iter().map(|extent| *extent >= 0.0);
        demand_all(extents, "boundary_extent", "0 or above")?;
        demand_all(self.boundary_reference.iter().flatten().map(|it| it.is_finite()), "boundary_reference", FINITE)?;
        if self.slabs.is_empty() { Ok(()) } else { ends(&self.slabs, particles, "slabs") }
    }
}

impl ContactList {
    /// Whether the list can stand in these slabs of particles.
    pub(super) fn check(&self, particles: &[u32]) -> Result<(), StateFault> {
        let count = self.first.len();
        let equal = self.second.len() == count && self.flags.len() == count;
        demand(equal, "contacts", count, "columns of one length")?;
        if self.slabs.is_empty() {
            return demand(count == 0, "contacts", count, "no pair where there is no slab");
        }
        ends(&self.slabs, count, "contacts")?;
        in_slabs(|pair| (self.first[pair], self.second[pair]), &self.slabs, particles, "contacts")?;
        finite(self.history.all(), "history")?;
        all_finite(&self.pair_constant, "pair_constant")
    }

    /// Whether it has the columns of a law that remembers so many rows of each contact.
    pub(crate) fn check_columns(&self, history: usize, pair_constant: bool) -> Result<(), StateFault> {
        let columns = (&self.history, history, &self.pair_constant[..], pair_constant);
        remembered(columns, self.first.len())
    }

    /// Whether it has as many rows as its law remembers, if there is one.
    pub(crate) fn check_history(&self, rows: Option<usize>) -> Result<(), StateFault> {
        has_rows((&self.history, rows), self.first.len())
    }
}

impl WallContacts {
    /// Whether the list can be one of so many particles.
    pub(super) fn check(&self, particles: usize) -> Result<(), StateFault> {
        demand(self.flags.len() == self.particle.len(), "walls", self.flags.len(), "columns of one length")?;
        let order = self.particle.windows(2).map(|pair| pair[0] <= pair[1]);
        demand_all(order, "walls", "ascending order")?;
        let last = self.particle.last().is_none_or(|&last| (last as usize) < particles);
        demand(last, "walls", self.particle.len(), "slots of particles")?;
        self.near.check(particles)?;
        finite(self.history.all(), "history")?;
        all_finite(&self.pair_constant, "pair_constant")
    }

    /// Whether it has the columns of a law that remembers so many rows of each contact.
    pub(crate) fn check_columns(&self, history: usize, pair_constant: bool) -> Result<(), StateFault> {
        let columns = (&self.history, history, &self.pair_constant[..], pair_constant);
        remembered(columns, self.particle.len())?;
        let once = self.particle.windows(2).map(|pair| pair[0] < pair[1]);
        demand_all(once, "walls", "each particle once")?;
        demand(self.feature.is_empty() && self.near.particle.is_empty(), "feature", 0, "no feature at a plane")
    }

    /// The same of a list at a surface of so many parts and features. Pair constants are kept of the near particles.
    pub(crate) fn check_features(
        &self,
        history: usize,
        pair_constant: bool,
        [parts, features]: [usize; 2],
    ) -> Result<(), StateFault> {
        remembered((&self.history, history, &[], false), self.particle.len())?;
        column(&self.pair_constant, self.near.particle.len(), pair_constant, "pair_constant")?;
        column(&self.feature, self.particle.len(), true, "feature")?;
        let there = self.feature.iter().map(|&feature| (feature as usize) < features);
        demand_all(there, "feature", "features of the surface")?;
        let there = self.near.parts.iter().map(|&part| (part as usize) < parts);
        demand_all(there, "near", "parts of the surface")
    }

    /// The same.
    pub(crate) fn check_history(&self, rows: Option<usize>) -> Result<(), StateFault> {
        let feature = self.feature.is_empty() || self.feature.len() == self.particle.len();
        demand(feature, "feature", self.feature.len(), "one for each contact, or none")?;
        has_rows((&self.history, rows), self.particle.len())
    }
}

impl NearParts {
    /// Whether the lists can be of so many particles.
    pub(super) fn check(&self, particles: usize) -> Result<(), StateFault> {
        ascending(&self.particle, particles, "near")?;
        demand(self.plane.len() == self.particle.len(), "near", self.plane.len(), "a plane or none for each particle")?;
        if self.starts.is_empty() {
            return demand(self.particle.is_empty() && self.parts.is_empty(), "near", 0, "no part without a start");
        }
        demand(self.starts.len() == self.particle.len() + 1, "near", self.starts.len(), "a start for each particle")?;
        ends(&self.starts, self.parts.len(), "near")
    }
}
