//! Results of a pass over bonds: energies, and the bonds that broke.

use crate::base::number::Vector;
use crate::engine::neighbours::bonds::remove;
use crate::engine::run_error::{Cause, RunError};
use crate::engine::state::State;
use crate::engine::state::bonds::Break;
use crate::laws::bond::{BondLoads, Reaction};

/// Sums energies of the bonds of a law, takes out what broke and tells of it.
pub(crate) fn book<'a>(state: &mut State, law: usize, results: impl Iterator<Item = &'a Done>) -> Result<(), RunError> {
    let (list, particles, time) = (&mut state.bonds[law], &state.particles, state.clock.time);
    let mut outcome = Ok(());
    let mut gone = Vec::new();
    let told = state.breaks.len();
    let id = |slot: u32| particles.id[slot as usize];
    for done in results {
        list.relaxed += done.relaxed;
        list.damped += done.damped;
        gone.extend_from_slice(&done.broken);
        if let Some(bond) = done.overbent {
            let (first, second) = (id(list.first[bond as usize]), list.second.get(bond as usize).copied().map(id));
            outcome = outcome.and(Err(RunError::Overbent { first, second, time, cause: Cause::NotSearched }));
        }
    }
    for &Broken { bond, cause, energy, axis, arm, area } in &gone {
        let slot = list.first[bond as usize];
        let (first, second) = (id(slot), list.second.get(bond as usize).copied().map(id));
        let position = (Vector::from(particles.position[slot as usize]) + Vector::from(arm)).to_array();
        let law = law as u32;
        state.breaks.push(Break { time, law, first, second, cause, energy, position, direction: axis, area });
        list.released += energy;
        list.broken += 1;
    }
    for broken in &state.breaks[told..] {
        state.particles.count_break([broken.first].into_iter().chain(broken.second));
    }
    if !gone.is_empty() {
        remove(list, gone.iter().map(|broken| broken.bond));
    }
    outcome
}

/// A bond that broke.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Broken {
    /// Its place in the list.
    pub(crate) bond: u32,
    /// Code of the cause.
    pub(crate) cause: f64,
    /// Released energy \[J\].
    pub(super) energy: f64,
    /// Unit vector from j to i.
    axis: [f64; 3],
    /// From the centre of i to the middle of the cross-section \[m\].
    arm: [f64; 3],
    /// Area of the cross-section \[m²\].
    area: f64,
}

impl Broken {
    /// A bond that breaks for the cause of this code.
    pub(crate) fn new(bond: u32, cause: f64) -> Self {
        Self { bond, cause, ..Self::default() }
    }
}

/// Results of a part of a list.
#[derive(Clone, Debug, Default)]
pub(crate) struct Done {
    /// Elastic energy that relaxation took \[J\].
    pub(crate) relaxed: f64,
    /// Energy that damping took \[J\].
    pub(crate) damped: f64,
    /// Bonds that broke.
    pub(crate) broken: Vec<Broken>,
    /// A bond bent beyond what can be followed.
    pub(crate) overbent: Option<u32>,
}

impl Done {
    /// Finds where broken bonds parted, and what they release: what they held in the middle of the step. Up to there their
    /// force acted, and this is what the books lose, to second order in the step.
    pub(crate) fn release(&mut self, step: f64, carried: impl Fn(usize) -> BondLoads) {
        for broken in &mut self.broken {
            let BondLoads { energy, power, axis, arm, area, .. } = carried(broken.bond as usize);
            *broken = Broken { energy: energy + 0.5 * step * power, axis, arm, area, ..*broken };
        }
    }

    /// Adds what one bond did.
    pub(crate) fn add(&mut self, bond: u32, reaction: &Reaction) {
        self.relaxed += reaction.relaxed;
        self.damped += reaction.damped;
        if reaction.cause != 0.0 {
            self.broken.push(Broken::new(bond, reaction.cause));
        }
        if reaction.overbent && self.overbent.is_none() {
            self.overbent = Some(bond);
        }
    }
}
