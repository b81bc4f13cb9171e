//! What the passes of a time step have in common.

use super::ahead::{Frame, Link, Meeting, SearchLimits};
use super::coefficients::MaterialRow;
use super::encounters::Encounters;
use super::records::{BondRecord, ContactRecord};
use crate::base::threads::Context;
use crate::engine::run_error::RunError;
use crate::engine::state::ledger::Source;
use crate::engine::state::{State, StateFault};
use crate::laws::bond::creation::Moment;
use crate::laws::surface::NodeWeights;
use crate::scene::Scene;

/// A particle touches a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceTouch<'a> {
    /// The particle (slot).
    pub slot: u32,
    /// Index of the boundary.
    pub boundary: u32,
    /// Index of the contact law.
    pub law: u32,
    /// Overlap \[m\].
    pub overlap: f64,
    /// How often it counts: 1, or the weight of a feature.
    pub weight: f64,
    /// What the nodes around the foot give, where these have temperatures.
    pub nodes: &'a [NodeWeights],
}

/// One kind of interaction, composed for the scene: its forces.
pub(crate) trait Pass: Stiffness + Telling + Send + Sync {
    /// Adds its forces and torques to the particles and its loads to the boundaries. An error tells of a state
    /// that must not be continued from; the evaluation is complete all the same.
    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError>;

    /// Makes what is to be made at this moment, in a time step of this length \[s\] (0 before the first). Returns
    /// whether anything was made: the lists are then made anew.
    fn create(&self, _state: &mut State, _moment: &Moment, _step: f64) -> bool {
        false
    }

    /// Whether particles need an orientation for it.
    fn needs_orientations(&self) -> bool {
        false
    }

    /// Whether particles feel torque from it.
    fn has_torque(&self) -> bool;

    /// Takes over the coefficients of contact laws that a state has.
    fn take_coefficients(&mut self, _state: &State) {}

    /// Takes over the strengths of bonds that a state has.
    fn take_strengths(&mut self, _scene: &Scene, _state: &State) {}

    /// Whether its part of a state from outside has the columns that the law trusts. Slots, order and finite numbers have
    /// been looked at.
    fn check(&self, state: &State) -> Result<(), StateFault>;

    /// Prepares its part of the state after the neighbour lists were made anew.
    fn prepare(&self, _state: &mut State) {}

    /// The kind of force it is, for the energy book.
    fn source(&self) -> Source;

    /// Ends the contacts of particles (slots) that go, and books what their bonds did in the first half of the present time step \[s\].
    /// Returns the elastic energy that those gave in it: their force acted as long \[J\].
    fn let_go(&self, _state: &mut State, _goes: &[bool], _step: f64) -> f64 {
        0.0
    }
}

/// How stiff an interaction is or may get: for the stable and the automatic time step.
pub(crate) trait Stiffness {
    /// Tells the stiffness of each interaction at work or, where `ahead` looks further, as stiff as each may get: for the
    /// stable time step. In the order of the lists, whichever thread found it.
    fn stiffness(&self, state: &State, ahead: &SearchLimits, context: &Context, tell: &mut dyn FnMut(Link));

    /// Tells springs and dashpots of an impact where it is deepest: of two particles, or of one and each surface with a boundary's
    /// index.
    fn impacts(&self, _state: &State, _meeting: &Meeting, _tell: &mut dyn FnMut(Option<u32>, [Frame; 2])) {}

    /// Tells each law with its coefficients for two materials that can meet, where these are those of particles: number of the law,
    /// materials, law, row.
    fn rows(&self, _scene: &Scene, _tell: &mut dyn FnMut(MaterialRow)) {}

    /// Adds the energies of contacts at work and of those to come until the lists are made anew.
    fn encounters(&self, _state: &State, _found: &mut Encounters) {}
}

/// What an interaction tells when it is asked. Changes nothing.
pub(crate) trait Telling {
    /// Tells each contact at work as it was in the last evaluation. Changes nothing.
    fn contacts(&self, _state: &State, _step: f64, _tell: &mut dyn FnMut(ContactRecord)) {}

    /// How many contacts are near a switch (`listed::near_switch`): of planes and pairs of particles.
    fn near_switch(&self, _state: &State, _step: f64, _margin: f64) -> u64 {
        0
    }

    /// Elastic energy at the present time, as far as it has a closed form \[J\].
    fn elastic_energy(&self, state: &State) -> f64;

    /// Energy at the present time of rolling springs, of sticky and of plastic normal forces \[J\]: for a book of losses.
    fn held_energy(&self, _state: &State) -> [f64; 3] {
        [0.0; 3]
    }

    /// Largest overlap at the present time over the smaller radius of the two (the particle's, at a surface).
    fn largest_overlap(&self, _state: &State) -> f64 {
        0.0
    }

    /// Tells each contact with a surface that has one of these flags, as it stands now.
    fn touched(&self, _chosen: (&State, u8), _tell: &mut dyn FnMut(SurfaceTouch)) {}

    /// Tells each living bond and what it carries. Changes nothing.
    fn bonds(&self, _state: &State, _tell: &mut dyn FnMut(BondRecord)) {}
}
