//! When to look again. One rule: a look holds until what it foresaw is used up. Each look writes into the state how far it foresaw, and
//! here alone that is compared with what has happened since.
//!
//! | look | foresaw | holds until |
//! |---|---|---|
//! | stable step | a way, a strain, a speed, bonds to be made | one of them is used up; bonds that suppress contacts break; heat allows less |
//! | contacts to come | all pairs in the neighbour lists, for a time | the lists are made anew, the time is over, something is 1.5 times as fast |
//! | all contacts | that a packing changes slowly | 256 time steps are over |
//! | what servos press on | a load | it has changed, or 8 time steps are over |
//! | how stiff a cell is | that a packing changes slowly | 32 time steps are over |

use super::look::bonds_so_far;
use crate::engine::boundaries::course;
use crate::engine::contacts::FASTER;
use crate::engine::simulation::Simulation;
use crate::engine::state::BoundaryState;
use crate::engine::transfer;
use crate::laws::bond::creation::{Creation, CreationTime, Window};
use crate::scene::{Boundary, Step};

/// Time steps after which all contacts are looked at again. Such a look takes about as long as a time step.
pub(in crate::engine::simulation) const BETWEEN_LOOKS: u64 = 256;

/// Time steps between looks at what servos press on: fewer than a wave takes through a particle.
const STEPS_BETWEEN_LOOKS_OF_SERVOS: u64 = 8;

/// Time steps between looks at how stiff a cell is whose strains reach stresses.
const STEPS_BETWEEN_LOOKS_OF_CELL: u64 = 32;

/// Largest speed over that of the last look at which the stable time step is looked at again.
const CALMER: f64 = 0.25;

/// What of the contacts is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine::simulation) enum Seen {
    /// Nothing: it is not due.
    Nothing,
    /// Bodies in no contact and in one.
    Impacts,
    /// All contacts.
    Everything,
}

impl Simulation {
    /// What of the contacts is to be looked at: all, or those of bodies in at most one, or nothing. Boundaries are this fast \[m/s\].
    pub(super) fn contacts_due(&self, boundaries: f64) -> Seen {
        if self.scene.run.step != Step::Following {
            return Seen::Nothing;
        }
        let (pace, clock) = (&self.state.pace, &self.state.clock);
        let speed = clock.speed.max(boundaries);
        if clock.steps >= pace.whole_at + BETWEEN_LOOKS {
            return Seen::Everything;
        }
        let is_over = clock.rebuilds != pace.rebuilds || clock.time >= pace.until || speed > FASTER * pace.speed;
        if is_over { Seen::Impacts } else { Seen::Nothing }
    }

    /// Whether what was foreseen has been used up: by motion, by speed, by bonds. Boundaries are this fast \[m/s\], the next
    /// time step has this length \[s\].
    pub(in crate::engine::simulation) fn is_due(&self, boundaries: f64, step: f64) -> bool {
        if self.scene.heat.frozen {
            return false;
        }
        let (foresight, clock) = (&self.state.foresight, &self.state.clock);
        let speed = clock.speed.max(0.5 * (clock.speed + boundaries));
        let is_strained = foresight.strained > foresight.strain_reach;
        if step > transfer::longest_step(self.state.heat.as_ref()) {
            return true;
        }
        if foresight.travel > foresight.reach || speed > foresight.speed || is_strained {
            return true;
        }
        if self.scene.bonds.is_empty() {
            return false;
        }
        let [made, broken] = bonds_so_far(&self.state);
        let next = Window { after: clock.steps, until: clock.steps + 1, from: clock.time, to: clock.time + step };
        let unforeseen = |creation: &Creation| match creation.due() {
            CreationTime::Step(number) => number > foresight.until,
            CreationTime::Time(time) => time > foresight.to,
            CreationTime::AtStart | CreationTime::Always => false,
        };
        let coming =
            self.scene.bonds.iter().any(|bond| bond.keys.create.comes_within(&next) && unforeseen(&bond.keys.create));
        let uncovered = broken > foresight.bonds[1] && self.suppression.any();
        let unexpected = made > foresight.bonds[0] && clock.steps > foresight.until;
        coming || uncovered || unexpected
    }

    /// Whether what moves fastest has become so much slower since the stable time step was found that a longer one may be.
    pub(in crate::engine::simulation) fn is_calmer(&self) -> bool {
        self.state.clock.speed < CALMER * self.state.foresight.fastest
    }

    /// Whether what servos press on is to be looked at: where it has changed, and now and then.
    pub(super) fn servos_are_due(&self) -> bool {
        let has_changed = |(boundary, moved): (&Boundary, &BoundaryState)| {
            let served = |axis: &usize| boundary.axes[*axis].servo().is_some();
            (0..3).filter(served).any(|axis| moved.pressed[axis].has_changed(moved.force[axis]))
        };
        let changed = || self.scene.boundaries.iter().zip(&self.state.boundaries).any(has_changed);
        self.serves && (self.state.clock.steps.is_multiple_of(STEPS_BETWEEN_LOOKS_OF_SERVOS) || changed())
    }

    /// Whether the stiffness of a cell whose strains reach stresses is to be looked at.
    pub(super) fn cell_is_due(&self) -> bool {
        self.state.clock.steps.is_multiple_of(STEPS_BETWEEN_LOOKS_OF_CELL)
    }

    /// Largest speed of a boundary, as it is about to move \[m/s\].
    pub(in crate::engine::simulation) fn boundary_speed(&self) -> f64 {
        let streaming = self.cell.as_ref().map_or(0.0, |cell| cell.speed(&self.state));
        course::speeds(&self.scene, &self.bodies, &self.state, self.state.clock.step).fold(streaming, f64::max)
    }

    /// Whether the scene moves a boundary, at a speed that is not that of the communication step's beginning.
    pub(in crate::engine::simulation) fn boundaries_change_speed(&self) -> bool {
        let time = self.state.clock.time;
        self.scene.boundaries.iter().any(|boundary| boundary.axes.iter().any(|axis| axis.at(time).is_some()))
    }
}
