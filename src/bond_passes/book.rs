//! Results of a pass over bonds: energies, and the bonds that broke.

use crate::bond::{Carried, Reaction};
use crate::neighbours::bonds::remove;
use crate::run_error::{Cause, RunError};
use crate::state::State;
use crate::state::bonds::Break;

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
            outcome = outcome.and(Err(RunError::Overbent { first, second, time, cause: Cause::Unknown }));
        }
    }
    for &(bond, cause, energy) in &gone {
        let (first, second) = (id(list.first[bond as usize]), list.second.get(bond as usize).copied().map(id));
        state.breaks.push(Break { time, law: law as u32, first, second, cause, energy });
        list.released += energy;
        list.broken += 1;
    }
    for broken in &state.breaks[told..] {
        state.particles.count_break([broken.first].into_iter().chain(broken.second));
    }
    if !gone.is_empty() {
        remove(list, &gone);
    }
    outcome
}

/// Results of a part of a list.
#[derive(Clone, Debug, Default)]
pub(crate) struct Done {
    /// Elastic energy that relaxation took \[J\].
    pub(crate) relaxed: f64,
    /// Energy that damping took \[J\].
    pub(crate) damped: f64,
    /// Bonds that broke: bond, cause, released energy \[J\].
    pub(crate) broken: Vec<(u32, f64, f64)>,
    /// A bond bent beyond what can be followed.
    pub(crate) overbent: Option<u32>,
}

impl Done {
    /// Finds what broken bonds release: what they held in the middle of the step. Up to there their force acted, and this is
    /// what the books lose, to second order in the step.
    pub(crate) fn release(&mut self, step: f64, carried: impl Fn(usize) -> Carried) {
        for (bond, _, energy) in &mut self.broken {
            let carried = carried(*bond as usize);
            *energy = carried.energy + 0.5 * step * carried.power;
        }
    }

    /// Adds what one bond did.
    pub(crate) fn add(&mut self, bond: u32, reaction: &Reaction) {
        self.relaxed += reaction.relaxed;
        self.damped += reaction.damped;
        if reaction.cause != 0.0 {
            self.broken.push((bond, reaction.cause, 0.0));
        }
        if reaction.overbent && self.overbent.is_none() {
            self.overbent = Some(bond);
        }
    }
}
