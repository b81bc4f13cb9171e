//! Living bonds, and what became of the others.

use super::check::{MOST, StateFault, all_finite, ascending, column, demand, described, ends, finite, in_slabs};
use super::in_place::clone_in_place;
use super::{Row, plain};
use serde::{Deserialize, Serialize};

/// Living bonds of one law: between particles ordered by slab and first particle, at a plane by particle.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BondList {
    /// First bond of each slab, and behind the last one the number of bonds. A bond belongs to the slab of the
    /// particle that stands first in memory, and reaches no further than the next.
    #[serde(with = "plain")]
    pub slabs: Vec<u32>,
    /// Body i of each bond (slot).
    #[serde(with = "plain")]
    pub first: Vec<u32>,
    /// Body j of each bond (slot); empty at a plane.
    #[serde(with = "plain")]
    pub second: Vec<u32>,
    /// At a plane: foot of each bond, where it was when the plane stood as at time 0 \[m\]; otherwise empty.
    #[serde(with = "plain")]
    pub foot: Vec<Row>,
    /// State of the bonds: the rows of the law, each a column here.
    pub rows: Vec<Vec<Row>>,
    /// Load of damping on each bond in the last evaluation: force on i, torque on i, torque on j, each a column; empty where
    /// the law has no damping. What it takes of the bodies is known half a step later. Two more columns are the rates at the
    /// middle of the last step, where dashpots see those at the end of the step.
    pub damping: Vec<Vec<Row>>,
    /// Energy that damping and relaxation took of each bond so far \[J\]; empty where the law takes none.
    #[serde(with = "plain")]
    pub lost: Vec<f64>,
    /// Bonds made so far.
    pub made: u64,
    /// Bonds broken so far.
    pub broken: u64,
    /// Bonds taken away with a particle so far.
    pub removed: u64,
    /// Elastic energy that relaxation took so far \[J\].
    pub relaxed: f64,
    /// Energy that damping took so far \[J\].
    pub damped: f64,
    /// Elastic energy that broken bonds released so far \[J\].
    pub released: f64,
}

clone_in_place!(BondList {
    slabs,
    first,
    second,
    foot,
    rows,
    damping,
    lost,
    made,
    broken,
    removed,
    relaxed,
    damped,
    released
});

impl BondList {
    /// Counts the living bonds as made, and what left them from here.
    pub(super) fn begin_counting(&mut self) {
        (self.made, self.broken, self.removed) = (self.first.len() as u64, 0, 0);
        (self.relaxed, self.damped, self.released) = (0.0, 0.0, 0.0);
        self.lost.fill(0.0);
    }

    /// Energy that left the bonds so far: by damping, by relaxation, and with those that broke \[J\].
    pub fn dissipated(&self) -> f64 {
        self.damped + self.relaxed + self.released
    }
}

/// A bond broke.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Break {
    /// When \[s\].
    pub time: f64,
    /// Bond law: index in the scene.
    pub law: u32,
    /// Body i: index into the scene's particles.
    pub first: u32,
    /// Body j: index into the scene's particles; none where it is the law's plane.
    pub second: Option<u32>,
    /// Why: code of the cause.
    pub cause: f64,
    /// Elastic energy released \[J\].
    pub energy: f64,
    /// Middle of the cross-section that parted \[m\].
    pub position: [f64; 3],
    /// Unit normal of the cross-section, from j to i.
    pub direction: [f64; 3],
    /// Area of the cross-section \[m²\].
    pub area: f64,
}

impl BondList {
    /// Whether it has as many rows as its formulation, if there is one, and a foot or a second body of each bond.
    pub(crate) fn check_rows(&self, rows: Option<usize>, at_plane: bool) -> Result<(), StateFault> {
        let count = self.first.len();
        column(&self.foot, count, at_plane, "foot")?;
        column(&self.second, count, !at_plane, "second")?;
        demand([0, count].contains(&self.lost.len()), "lost", self.lost.len(), "one for each bond, or none")?;
        described((&self.rows, rows), count)
    }

    /// Whether the list can be one of so many particles in these slabs.
    pub(super) fn check(&self, count: usize, particles: &[u32]) -> Result<(), StateFault> {
        let numbers = [self.relaxed, self.damped, self.released];
        all_finite(&numbers, "bonds")?;
        all_finite(&self.lost, "lost")?;
        demand(
            [self.made, self.broken, self.removed].iter().all(|count| *count < MOST),
            "bonds",
            0,
            "a count that can be reached",
        )?;
        for column in self.rows.iter().chain(&self.damping).chain([&self.foot]) {
            finite(column, "bonds")?;
        }
        let bonds = self.first.len();
        if !self.slabs.is_empty() {
            ends(&self.slabs, bonds, "bonds")?;
        }
        if self.second.is_empty() {
            return ascending(&self.first, count, "bonds");
        }
        demand(self.second.len() == bonds, "bonds", self.second.len(), "columns of one length")?;
        demand(!self.slabs.is_empty(), "bonds", 1, "slabs")?;
        let pair = |bond: usize| {
            let (i, j) = (self.first[bond], self.second[bond]);
            (i.min(j), i.max(j))
        };
        in_slabs(pair, &self.slabs, particles, "bonds")
    }

    /// Whether it has the columns of a law: rows of state, what each lost, and a foot or a second body.
    pub(crate) fn check_columns(&self, rows: usize, lost: bool, at_plane: bool) -> Result<(), StateFault> {
        let count = self.first.len();
        column(&self.foot, count, at_plane, "foot")?;
        column(&self.second, count, !at_plane, "second")?;
        column(&self.lost, count, lost, "lost")?;
        if count > 0 {
            demand(self.rows.len() == rows, "rows", self.rows.len(), "the rows of the law")?;
        }
        self.rows.iter().try_for_each(|row| column(row, count, true, "rows"))
    }

    /// Whether it has as many columns of what damping leaves as its law has rows.
    pub(crate) fn check_damping(&self, rows: usize) -> Result<(), StateFault> {
        let fits = self.damping.len() == rows || self.damping.is_empty() && self.first.is_empty();
        demand(fits, "damping", self.damping.len(), "a column for each row of the law's damping")?;
        self.damping.iter().try_for_each(|row| column(row, self.first.len(), true, "damping"))
    }
}
