//! Forces and torques between bonded bodies: pure functions of one bond and its own state.
//!
//! A bond law has four sub-models: when bonds are made (`creation`), how elastic force and moments follow from the motion
//! (`formulation`), damping, and breakage. Each is one file and one row in the list of its folder. They are written over
//! [`Number`], so the same source runs one bond at a time or several in a vector register: masks and selects, no branch
//! that changes a value.
//!
//! For each living bond a pass does the following, in this order (`docs/bonds.md` describes the whole step):
//!
//! 1. loads the two bodies ([`Body`]) and the rows of state, makes a [`Pair`] of them;
//! 2. calls the formulation: [`Motion`] and [`Elastic`];
//! 3. adds the damping force and torques, if the law has damping ([`damping::Damping::damp`]);
//! 4. adds force and torque to i, takes force from j, adds the torque of j;
//! 5. stores the rows that the formulation changes (none in the evaluation before the first step);
//! 6. if a rule of breakage holds ([`breakage::Breakage::judge`]), removes the bond, which does not act any more, and books
//!    its elastic energy as released; if [`Elastic::overbent`] holds, stops with an error that names the pair.
//!
//! The numbers of a law are the same for all its bonds; what differs from bond to bond (radius, arms, effective masses)
//! follows from the bodies. Each sub-model keeps its own numbers; no other code uses them.
//!
//! Signs: the axis points from j to i; force and torques are those on i, the force on j is the opposite.
//! The velocities are those of half a time step before the positions (velocity Verlet).

pub mod angle;
pub mod breakage;
mod carried;
pub mod creation;
pub mod damping;
pub mod elasticity;
pub mod formulation;
mod key_error;
pub mod keys;
mod law;
pub mod list;
pub mod motion;
mod pair;
mod part_keys;

pub use crate::base::geometry::Quaternion;
pub use carried::BondLoads;
pub use elasticity::{Coefficients, Elasticity};
pub use formulation::Formulation;
pub use law::{Law, OneBond, Reaction, remembered, rows};
pub use motion::{Lengths, Motion, Opening, RateRows, Rates};
pub use pair::{Body, Pair, Section};

use crate::base::number::{Number, Vector};

/// The largest number of state rows that a formulation has.
pub const MOST_ROWS: usize = 3;

/// State of one bond, or of a lane vector of bonds; rows beyond [`Formulation::ROWS`] are not used.
pub type Rows<N = f64> = [[N; 4]; MOST_ROWS];

/// The largest number of values that [`Formulation::halfway`] returns.
pub const MOST_HALFWAY: usize = 17;

/// Values that a formulation hands from the first half of its evaluation to the second.
pub type Intermediate<N = f64> = [N; MOST_HALFWAY];

/// The elastic response of a bond to the motion of its bodies.
#[derive(Clone, Copy, Debug)]
pub struct Elastic<N: Number> {
    /// u: above 0 compressed, below stretched \[m\].
    pub compression: N,
    /// Normal force along the axis, above 0 when it pushes \[N\].
    pub normal: N,
    /// Shear force on i \[N\].
    pub shear: Vector<N>,
    /// Torsion on i along the axis \[N m\].
    pub torsion: N,
    /// Bending torque on i \[N m\].
    pub bending: Vector<N>,
    /// Elastic force on i \[N\].
    pub force: Vector<N>,
    /// Elastic torque on i \[N m\].
    pub torque_i: Vector<N>,
    /// Elastic torque on j \[N m\].
    pub torque_j: Vector<N>,
    /// Elastic energy, after relaxation \[J\].
    pub energy: N,
    /// Elastic energy that relaxation took in this evaluation \[J\].
    pub relaxed: N,
    /// Whether the bond is bent further than the formulation can follow (π).
    pub overbent: N::Mask,
    /// The new state.
    pub rows: Rows<N>,
}

impl<N: Number> Elastic<N> {
    /// No force, no state.
    #[inline(always)]
    pub fn none() -> Self {
        let (zero, none) = (N::zero(), Vector::zero());
        Self {
            compression: zero,
            normal: zero,
            shear: none,
            torsion: zero,
            bending: none,
            force: none,
            torque_i: none,
            torque_j: none,
            energy: zero,
            relaxed: zero,
            overbent: zero.greater(zero),
            rows: [[zero; 4]; MOST_ROWS],
        }
    }

    /// What rules of breakage look at.
    #[inline(always)]
    pub fn loaded(&self, motion: &Motion<N>) -> breakage::Loaded<N> {
        breakage::Loaded {
            distance: motion.distance,
            section: motion.section,
            compression: self.compression,
            normal: self.normal,
            shear: self.shear,
            torsion: self.torsion,
            bending: self.bending,
        }
    }
}
