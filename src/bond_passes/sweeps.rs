//! Sweeps over the dashpots of bonds between particles that are integrated by themselves (`bond/damping/split.rs`).

use super::pair_of;
use super::sweep_slabs::{Room, Work};
use crate::bond::Law;
use crate::boundaries::felt::Swept;
use crate::interactions::Sweep;
use crate::lanes::Shared;
use crate::number::Vector;
use crate::state::State;
use crate::threads::Context;
use std::sync::{Mutex, PoisonError};

/// The sweeps of a bond law.
#[derive(Default)]
pub(super) struct Sweeps {
    /// Whether bodies of its bonds may belong to groups.
    groups: bool,
    /// Working space.
    room: Mutex<Room>,
}

impl Sweeps {
    /// Those of a law in a scene with groups or without.
    pub(super) fn of(groups: bool) -> Self {
        Self { groups, room: Mutex::default() }
    }

    /// Sweeps over a list. Returns the kinetic energy that particles moved by forces gained \[J\].
    pub(super) fn run(
        &self,
        (law, index): (&Law, usize),
        state: &mut State,
        sweep: Sweep,
        felt: &mut [Swept],
        context: &Context,
    ) -> f64 {
        let Some(dashpots) = law.split else { return 0.0 };
        let State { bonds, particles, boundaries, .. } = state;
        let list = &mut bonds[index];
        let work = Work {
            dashpots,
            elasticity: &law.elasticity,
            sweep,
            bodies: [&list.first, &list.second],
            position: &particles.position,
            velocity: Shared::new(&mut particles.velocity),
            spin: Shared::new(&mut particles.angular_velocity),
            lost: Shared::new(&mut list.lost),
            owner: &particles.owner,
            boundaries: if self.groups { boundaries } else { &[] },
        };
        let mut room = self.room.lock().unwrap_or_else(PoisonError::into_inner);
        let [taken, led] = work.slabs(&list.slabs, &mut room, felt, context);
        list.damped += taken;
        -(taken + led)
    }

    /// Adds the present loads of dashpots on groups.
    pub(super) fn add_loads(&self, (law, index): (&Law, usize), state: &State, felt: &mut [Swept]) {
        let (Some(dashpots), true) = (law.split, self.groups) else { return };
        let State { bonds, particles, boundaries, .. } = state;
        let coefficients = law.elasticity.at_step::<f64>(0.0);
        for (&i, &j) in bonds[index].first.iter().zip(&bonds[index].second) {
            let slots = [i, j].map(|slot| slot as usize);
            if slots.iter().all(|&slot| particles.owner[slot] == 0) {
                continue;
            }
            let impulse = dashpots.loads(&coefficients, &pair_of(particles, slots[0], slots[1]));
            for (body, &slot) in slots.iter().enumerate() {
                let Some(owner) = (particles.owner[slot] as usize).checked_sub(1) else { continue };
                let arm = Vector::from(particles.position[slot]) - boundaries[owner].pivot.into();
                felt[owner].add(&Swept::at(&impulse, body, arm, [Vector::zero(); 2]));
            }
        }
    }
}
