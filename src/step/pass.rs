//! What the passes of a time step have in common.

use super::error::RunError;
use super::lanes::{Shared, Width};
use super::observe::{BondRecord, ContactRecord};
use super::team::Team;
use super::walls::PlanePass;
use crate::bond::creation::Moment;
use crate::contact::Response;
use crate::number::Vector;
use crate::state::State;
use crate::state::ledger::Source;

/// Particles in one piece of work. Sums over particles are taken piece by piece, in order, so that they do not
/// depend on the number of threads.
pub(super) const CHUNK: usize = 1024;

/// What a pass needs to know beside the state.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    /// Time since springs were last advanced \[s\]: the time step, or 0 in the evaluation before the first one.
    pub step: f64,
    /// Lane width.
    pub width: Width,
    /// Who works, if several threads do.
    pub team: Option<&'a Team>,
}

impl Context<'_> {
    /// Does pieces 0 to `count` − 1 of the work, in any order.
    pub(super) fn each(&self, count: usize, piece: impl Fn(usize) + Sync + Send) {
        match self.team {
            Some(team) if count > 1 => team.each(count, &piece),
            _ => (0..count).for_each(piece),
        }
    }

    /// Does slabs 0 to `count` − 1 of the work: those of even number in any order, each of odd number when both its
    /// neighbours are done. What two neighbours add to one place thus always comes in the same order, and what is
    /// near in space is near in time.
    pub(super) fn slabs(&self, count: usize, work: impl Fn(usize) + Sync + Send) {
        match self.team {
            Some(team) if count > 2 => team.slabs(count, &work),
            _ => (0..count).for_each(|turn| work(in_turn(turn, count))),
        }
    }

    /// What the pieces 0 to `count` − 1 give, in order.
    pub(super) fn collect<T: Send>(&self, count: usize, piece: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        let Some(team) = self.team.filter(|_| count > 1) else { return (0..count).map(piece).collect() };
        let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
        let places = Shared::new(&mut results);
        // SAFETY: each piece has a place of its own.
        team.each(count, &|number| unsafe { *places.at(number) = Some(piece(number)) });
        results.into_iter().flatten().collect()
    }
}

/// The slab that one thread works on in this turn: 0, 2, 1, 4, 3, ..
fn in_turn(turn: usize, count: usize) -> usize {
    match turn {
        0 => 0,
        turn if turn % 2 == 1 && turn + 1 < count => turn + 1,
        turn if turn % 2 == 1 => turn,
        turn => turn - 1,
    }
}

/// One kind of interaction, composed for the scene.
pub(super) trait Pass: Send + Sync {
    /// Adds its forces and torques to the particles and its loads to the boundaries. An error tells of a state
    /// that must not be continued from; the evaluation is complete all the same.
    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError>;

    /// The pass as that of a plane, if it is one: those of all planes are done together, not by [`Pass::apply`].
    fn at_plane(&self) -> Option<&dyn PlanePass> {
        None
    }

    /// Makes what is to be made at this moment, in a time step of this length \[s\] (0 before the first). Returns
    /// whether anything was made: the lists are then made anew.
    fn create(&self, _state: &mut State, _moment: &Moment, _step: f64) -> bool {
        false
    }

    /// Whether particles need an attitude for it.
    fn needs_attitudes(&self) -> bool {
        false
    }

    /// Whether particles feel torque from it.
    fn has_torque(&self) -> bool;

    /// Prepares its part of the state after the neighbour lists were made anew.
    fn prepare(&self, state: &mut State);

    /// The kind of force it is, for the energy book.
    fn source(&self) -> Source;

    /// Tells the stiffness of each interaction at work, for the stable time step.
    fn stiffness(&self, state: &State, tell: &mut dyn FnMut(Link));

    /// The stiffest that it gets between two bodies of this effective radius \[m\] and mass \[kg\] which meet at
    /// this speed \[m/s\].
    fn impact(&self, radius: f64, mass: f64, speed: f64) -> Option<Response>;

    /// Tells each contact at work as it was in the last evaluation. Changes nothing.
    fn contacts(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord));

    /// Elastic energy at the present time, as far as it has a closed form \[J\].
    fn elastic_energy(&self, state: &State) -> f64;

    /// Tells each living bond and what it carries. Changes nothing.
    fn bonds(&self, _state: &State, _tell: &mut dyn FnMut(BondRecord)) {}
}

/// The stiffness of one interaction at work.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// One particle (slot).
    pub first: u32,
    /// The other particle (slot), or none at a wall.
    pub second: Option<u32>,
    /// Stiffnesses \[N/m\] and damping coefficients \[kg/s\].
    pub response: Response,
    /// Arm at the first particle \[m\].
    pub first_arm: f64,
    /// Arm at the second particle \[m\].
    pub second_arm: f64,
    /// Unit normal, from the second to the first.
    pub normal: Vector,
    /// Stiffness against twisting about the normal \[N m\].
    pub torsion: f64,
    /// Stiffness against bending \[N m\].
    pub bending: f64,
}
