//! The algorithmic energy book.

use super::check::{StateFault, all_finite, demand};
use super::in_place::clone_in_place;
use serde::{Deserialize, Serialize};

/// The kinds of force that are booked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Contacts between particles.
    Contacts,
    /// Bonds.
    Bonds,
    /// Planes on particles.
    Walls,
    /// Global damping.
    Damping,
    /// Gravity.
    Gravity,
    /// Applied forces.
    Applied,
    /// Springs and dashpots from bodies to the ground.
    Support,
    /// The streaming motion of a periodic cell that is deformed.
    Cell,
    /// Drag and buoyancy of the fluid.
    Fluid,
}

impl Source {
    /// Kinds that passes make, in the order in which they are added up.
    pub const PASSES: usize = 3;
    /// All kinds, those of passes first.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Contacts,
        Self::Bonds,
        Self::Walls,
        Self::Damping,
        Self::Gravity,
        Self::Applied,
        Self::Support,
        Self::Cell,
        Self::Fluid,
    ];
    /// How many there are.
    pub const COUNT: usize = 9;

    /// Its name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contacts => "contacts",
            Self::Bonds => "bonds",
            Self::Walls => "walls",
            Self::Damping => "damping",
            Self::Gravity => "gravity",
            Self::Applied => "applied",
            Self::Support => "support",
            Self::Cell => "cell",
            Self::Fluid => "fluid",
        }
    }
}

/// Work of each kind of force on the particles that move by the forces on them, as the integrator does it: each half
/// kick times the mean of the velocities before and after. The sum is the change of kinetic energy, to rounding,
/// unless a force is forgotten.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Kinetic energy when the book was opened \[J\].
    pub initial_kinetic: f64,
    /// Elastic energy then \[J\].
    pub initial_elastic: f64,
    /// Work of each of [`Source::ALL`] since then \[J\].
    pub work: [f64; Source::COUNT],
    /// Sum of the magnitudes of all entries \[J\]: what a residual is measured against.
    pub turnover: f64,
    /// Power of each kind of force on the particles with their present velocities \[W\].
    pub power: [f64; Source::COUNT],
    /// How fast these powers grow in a kick with the present loads \[W/s\].
    pub growth: [f64; Source::COUNT],
    /// Sum of the magnitudes of the powers of each piece of the particles \[W\].
    pub power_turned_over: f64,
    /// Force \[N\] and moment \[N m\] on the spheres of each body, by its number, when those of each kind that passes make have been added; empty
    /// where the scene has no such kind.
    pub on_bodies: [Vec<[f64; 6]>; Source::PASSES],
}

clone_in_place!(Ledger {
    initial_kinetic,
    initial_elastic,
    work,
    turnover,
    power,
    growth,
    power_turned_over,
    on_bodies
});

impl Ledger {
    /// Counts work from here.
    pub(super) fn begin_counting(&mut self) {
        (self.work, self.turnover) = ([0.0; Source::COUNT], 0.0);
    }

    /// Books what the fluid did to the bodies that forces move \[J\].
    pub(crate) fn book_fluid(&mut self, work: f64) {
        self.work[Source::Fluid as usize] += work;
        self.turnover += work.abs();
    }

    /// Work of one kind of force \[J\].
    pub fn work_of(&self, source: Source) -> f64 {
        self.work[source as usize]
    }

    /// Work of all forces \[J\].
    pub fn total(&self) -> f64 {
        self.work.iter().sum()
    }
}

impl Ledger {
    /// Whether the book can be one of a scene with so many bodies.
    pub(super) fn check(&self, bodies: usize) -> Result<(), StateFault> {
        let Self { initial_kinetic, initial_elastic, turnover, power_turned_over, .. } = *self;
        all_finite(&[initial_kinetic, initial_elastic, turnover, power_turned_over], "ledger")?;
        for powers in [&self.work, &self.power, &self.growth] {
            all_finite(powers, "ledger")?;
        }
        for loads in &self.on_bodies {
            let expected = "one for each body, or none";
            demand(loads.is_empty() || loads.len() == bodies, "loads", loads.len(), expected)?;
            loads.iter().try_for_each(|load| all_finite(load, "loads"))?;
        }
        Ok(())
    }
}
