//! The physical energy book: what each kind of loss took, by itself.

use super::check::{StateFault, all_finite};
use super::in_place::clone_in_place;
use serde::{Deserialize, Serialize};

/// Where energy goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Dashpots along the normal.
    NormalDamping,
    /// Dashpots in the tangent plane, those of friction without memory included.
    TangentialDamping,
    /// Friction at its limit.
    Sliding,
    /// Rolling torque, less what rolling springs hold.
    Rolling,
    /// Tangential springs whose stiffness changes while they are loaded: a gain, where it is below 0.
    TangentialStiffness,
    /// The part of a tangential spring along the normal of a contact that turned.
    Projection,
    /// Tangential springs that are still loaded as the bodies part.
    Parting,
    /// Attraction: what it holds or has lost.
    Cohesion,
    /// Normal forces that depend on what was before, less what they hold.
    Plastic,
    /// Damping and relaxation of bonds.
    BondDamping,
    /// Elastic energy of bonds that broke.
    BondRelease,
    /// Cundall's global damping.
    GlobalDamping,
    /// Drag of the fluid.
    Drag,
    /// Particles that went, less what came with others: kinetic, elastic and potential energy.
    Removed,
}

impl Loss {
    /// How many there are.
    pub const COUNT: usize = 14;
    /// All, in order.
    pub const ALL: [Self; Self::COUNT] = [
        Self::NormalDamping,
        Self::TangentialDamping,
        Self::Sliding,
        Self::Rolling,
        Self::TangentialStiffness,
        Self::Projection,
        Self::Parting,
        Self::Cohesion,
        Self::Plastic,
        Self::BondDamping,
        Self::BondRelease,
        Self::GlobalDamping,
        Self::Drag,
        Self::Removed,
    ];

    /// Its name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::NormalDamping => "normal_damping",
            Self::TangentialDamping => "tangential_damping",
            Self::Sliding => "sliding",
            Self::Rolling => "rolling",
            Self::TangentialStiffness => "tangential_stiffness",
            Self::Projection => "projection",
            Self::Parting => "parting",
            Self::Cohesion => "cohesion",
            Self::Plastic => "plastic",
            Self::BondDamping => "bond_damping",
            Self::BondRelease => "bond_release",
            Self::GlobalDamping => "global_damping",
            Self::Drag => "drag",
            Self::Removed => "removed",
        }
    }
}

/// Losses since the book was opened, as far as they are counted step by step: those of bonds stand in their lists.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Losses {
    /// Kinetic energy when the book was opened \[J\].
    pub initial_kinetic: f64,
    /// Elastic energy then \[J\].
    pub initial_elastic: f64,
    /// Potential of gravity and applied forces on the free particles then \[J\].
    pub initial_potential: f64,
    /// Energy then of rolling springs, of sticky and of plastic normal forces \[J\].
    pub initial_held: [f64; 3],
    /// What each of [`Loss::ALL`] took \[J\]; of those that hold energy the whole work against them.
    pub taken: [f64; Loss::COUNT],
    /// Work of weight, applied forces, springs and dashpots to the ground and added inertia on bodies \[J\].
    pub given_to_bodies: f64,
    /// What global damping takes in the half kick to come, over its length and over the square of it \[W, W/s\].
    pub braking: [f64; 2],
}

clone_in_place!(Losses {
    initial_kinetic,
    initial_elastic,
    initial_potential,
    initial_held,
    taken,
    given_to_bodies,
    braking
});

impl Losses {
    /// Counts from here.
    pub(super) fn begin_counting(&mut self) {
        (self.taken, self.given_to_bodies) = ([0.0; Loss::COUNT], 0.0);
    }

    /// Adds what a loss took \[J\].
    pub(crate) fn add(&mut self, loss: Loss, energy: f64) {
        self.taken[loss as usize] += energy;
    }
}

impl Losses {
    /// Whether all its numbers are finite.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let Self { initial_kinetic, initial_elastic, initial_potential, given_to_bodies, .. } = self;
        all_finite(&[*initial_kinetic, *initial_elastic, *initial_potential, *given_to_bodies], "losses")?;
        all_finite(&self.initial_held, "losses")?;
        all_finite(&self.taken, "losses")?;
        all_finite(&self.braking, "losses")
    }
}
