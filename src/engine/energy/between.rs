//! The loads on particles between one kind of force and the next, by which the energy book tells the kinds apart.
//!
//! Loads are stored only where the next kind may act: near surfaces, and everywhere for bonds and fields.

use super::{multiply, plus, row};
use crate::base::lanes::{self, Kernel, Lane, Width};
use crate::engine::contacts::Pass;
use crate::engine::integration::mobility;
use crate::engine::state::ledger::Source;
use crate::engine::state::{Particles, Row, State, WallContacts};

/// Loads on particles between two kinds of force.
#[derive(Default)]
pub(super) struct Loads {
    /// Whether they were stored in the last evaluation.
    pub(super) stored: bool,
    /// Forces \[N\].
    force: Vec<Row>,
    /// Torques \[N m\].
    torque: Vec<Row>,
}

impl Loads {
    /// Stores the loads on all particles.
    fn store(&mut self, particles: &Particles) {
        self.stored = true;
        self.force.clone_from(&particles.force);
        self.torque.clone_from(&particles.torque);
    }

    /// Forces and torques, if they were stored.
    #[inline(always)]
    pub(super) fn rows(&self) -> Option<[&[Row]; 2]> {
        self.stored.then_some([&self.force[..], &self.torque[..]])
    }
}

/// What the book stores from the evaluation of the forces to the kick that follows.
#[derive(Default)]
pub(crate) struct PendingWork {
    /// The last kind of force that passes add; that before surfaces where these follow another kind.
    pub(super) last: Option<Source>,
    /// Loads before bonds acted.
    pub(super) bonds: Loads,
    /// Loads before surfaces acted, on the particles near them.
    walls: Loads,
    /// Loads before fields acted.
    pub(super) fields: Loads,
}

impl PendingWork {
    /// For these passes.
    pub(crate) fn of(passes: &[Box<dyn Pass>]) -> Self {
        let acts = |source: &Source| passes.iter().any(|pass| pass.source() == *source);
        let last = [Source::Bonds, Source::Contacts].into_iter().find(acts);
        Self { last, ..Self::default() }
    }

    /// Forgets the loads of the evaluation before.
    pub(crate) fn begin(&mut self) {
        for loads in [&mut self.bonds, &mut self.walls, &mut self.fields] {
            loads.stored = false;
        }
    }

    /// Stores the loads before bonds act on the particles.
    pub(crate) fn before_bonds(&mut self, particles: &Particles) {
        self.bonds.store(particles);
    }

    /// Stores the loads before fields act on the particles.
    pub(crate) fn before_fields(&mut self, state: &State) {
        if state.ledger.is_some() {
            self.fields.store(&state.particles);
        }
    }

    /// Stores the loads before surfaces act, on the particles near them.
    pub(crate) fn before_surfaces(&mut self, state: &State) {
        let (Loads { stored, force, torque }, particles) = (&mut self.walls, &state.particles);
        *stored = true;
        force.resize(particles.len(), [0.0; 4]);
        torque.resize(particles.len(), [0.0; 4]);
        for slot in near(&state.walls) {
            (force[slot], torque[slot]) = (particles.force[slot], particles.torque[slot]);
        }
    }

    /// Products of the loads of surfaces with velocities and with accelerations, if surfaces follow another kind of force. `gravity`
    /// \[m/s²\] is given where the weight is not yet among the loads. The half kick lasts so long \[s\].
    pub(super) fn of_walls(
        &mut self,
        particles: &Particles,
        walls: &[WallContacts],
        gravity: Option<[f64; 3]>,
        (half, width): (f64, Width),
    ) -> Option<[Row; 2]> {
        let (before, fields) = (&mut self.walls, self.fields.rows());
        let mut sums = [[0.0; 4]; 2];
        let gravity = row(gravity.unwrap_or_default());
        lanes::run(width, WallLoads { particles, walls, fields, gravity, half, before, sums: &mut sums });
        before.stored.then_some(sums)
    }
}

/// The particles (slots) near surfaces, some of them several times.
#[inline(always)]
fn near(walls: &[WallContacts]) -> impl Iterator<Item = usize> {
    walls.iter().flat_map(|list| list.particle.iter().chain(&list.near.particle)).map(|&slot| slot as usize)
}

/// What surfaces do to the particles near them.
struct WallLoads<'a, 'b> {
    /// The particles.
    particles: &'a Particles,
    /// Who is near.
    walls: &'a [WallContacts],
    /// Loads when surfaces had acted, if others followed.
    fields: Option<[&'a [Row]; 2]>,
    /// Gravity that is not yet among the forces \[m/s²\].
    gravity: Row,
    /// Length of the half kick \[s\].
    half: f64,
    /// Loads before surfaces acted.
    before: &'b mut Loads,
    /// Products of the loads of surfaces with velocities and with accelerations.
    sums: &'b mut [Row; 2],
}

impl Kernel for WallLoads<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { particles, walls, fields, gravity, half, before, sums } = self;
        let Loads { stored: true, force: forces, torque: torques } = before else { return };
        let mut found = [[0.0; 4]; 2];
        for list in walls {
            for slots in [&list.particle, &list.near.particle] {
                for &slot in slots {
                    let slot = slot as usize;
                    if particles.owner[slot] != 0 {
                        continue;
                    }
                    let loads = [&particles.force[slot], &particles.torque[slot]];
                    let after = fields.map_or(loads, |[forces, torques]| [&forces[slot], &torques[slot]]);
                    let pushed = plus(after[0], &forces[slot], -1.0);
                    let turned = plus(after[1], &torques[slot], -1.0);
                    // Who is met again was counted.
                    (forces[slot], torques[slot]) = (*after[0], *after[1]);
                    let (velocity, spin) = (&particles.velocity[slot], &particles.angular_velocity[slot]);
                    let acceleration = plus(&gravity, loads[0], mobility(velocity, loads[0], half));
                    let turning = plus(&[0.0; 4], loads[1], mobility(spin, loads[1], half));
                    multiply(&mut found, [&pushed, &turned], [[velocity, spin], [&acceleration, &turning]]);
                }
            }
        }
        *sums = found;
    }
}
