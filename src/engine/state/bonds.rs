//! Living bonds, and what became of the others.

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
