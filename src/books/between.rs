//! What particles bear between one kind of force and the next: by that the energy book tells kinds apart.
//!
//! Loads are stored only where the next kind may act: near surfaces, and everywhere for bonds and fields.

use super::{bodies, dot, plus, row};
use crate::boundaries::RigidBody;
use crate::state::ledger::Source;
use crate::state::{Particles, Row, State};

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
pub(crate) struct Between {
    /// The kind of force that the passes added last but for surfaces that follow another kind.
    pub(super) last: Option<Source>,
    /// Loads before bonds acted.
    pub(super) bonds: Loads,
    /// Loads before surfaces acted, on the particles near them.
    walls: Loads,
    /// Loads before fields acted.
    pub(super) fields: Loads,
    /// The particles (slots) near surfaces, each once.
    near: Vec<u32>,
    /// Whether a particle is among them, for each slot; all false between two calls.
    is_near: Vec<bool>,
}

impl Between {
    /// Forgets the loads of the evaluation before.
    pub(crate) fn begin(&mut self) {
        self.last = None;
        for loads in [&mut self.bonds, &mut self.walls, &mut self.fields] {
            loads.stored = false;
        }
    }

    /// Notes the loads when the passes of one kind are done. `next` is the kind of those that follow.
    pub(crate) fn note(
        &mut self,
        state: &mut State,
        bodies: &[Option<RigidBody>],
        source: Source,
        next: Option<Source>,
    ) {
        if state.ledger.is_none() {
            return;
        }
        bodies::note(state, bodies, source);
        if !self.walls.stored {
            self.last = Some(source);
        }
        match next {
            Some(Source::Walls) => self.store_near(state),
            Some(_) => self.bonds.store(&state.particles),
            None => {}
        }
    }

    /// Stores the loads before fields act on the particles.
    pub(crate) fn note_before_fields(&mut self, state: &State) {
        if state.ledger.is_some() {
            self.fields.store(&state.particles);
        }
    }

    /// Power of surfaces on particles \[W\], and how fast it grows in a kick \[W/s\], if they follow another kind.
    pub(super) fn of_walls(&self, particles: &Particles, gravity: Option<[f64; 3]>) -> Option<[f64; 2]> {
        let before = self.walls.rows()?;
        let gravity = row(gravity.unwrap_or_default());
        let mut walls = [0.0; 2];
        for (place, slot) in self.near.iter().map(|&slot| slot as usize).enumerate() {
            if particles.owner[slot] != 0 {
                continue;
            }
            let (velocity, spin) = (&particles.velocity[slot], &particles.angular_velocity[slot]);
            let loads = [&particles.force[slot], &particles.torque[slot]];
            let after = self.fields.rows().map_or(loads, |rows| rows.map(|rows| &rows[slot]));
            let [force, torque] = [0, 1].map(|part| plus(after[part], &before[part][place], -1.0));
            walls[0] += dot(&force, velocity) + dot(&torque, spin);
            let growth = dot(&force, loads[0]) / velocity[3] + dot(&torque, loads[1]) / spin[3];
            walls[1] += growth + dot(&force, &gravity);
        }
        Some(walls)
    }

    /// Stores the loads on the particles near surfaces.
    fn store_near(&mut self, state: &State) {
        let Self { walls: Loads { stored, force, torque }, near, is_near, .. } = self;
        let particles = &state.particles;
        *stored = true;
        force.clear();
        torque.clear();
        near.clear();
        is_near.resize(particles.len(), false);
        for &slot in state.walls.iter().flat_map(|list| list.particle.iter().chain(&list.near.particle)) {
            if !std::mem::replace(&mut is_near[slot as usize], true) {
                near.push(slot);
                force.push(particles.force[slot as usize]);
                torque.push(particles.torque[slot as usize]);
            }
        }
        near.iter().for_each(|&slot| is_near[slot as usize] = false);
    }
}
