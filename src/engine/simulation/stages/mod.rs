//! The stages of a time step.
//!
//! `rows` lists them in their order. A simulation chooses those that its scene needs once; what a scene does not have adds none. A
//! new stage is one row: its name, which scenes have it, what it reads and writes, and a function.

mod forces;
mod kick;
mod motion;
mod rows;

use super::Simulation;
use super::time_step::TimeStep;
use rows::ROWS;

/// The parts of a time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Half a kick and the drift; lists and bonds for the places that everything has then.
    Motion,
    /// The forces of contacts, bonds and surfaces, and the loads on bodies.
    Forces,
    /// The other half of the kick.
    Kick,
}

impl Phase {
    /// All, in their order.
    pub const ALL: [Self; 3] = [Self::Motion, Self::Forces, Self::Kick];
}

/// What stages read and write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Positions and orientations of particles.
    Places,
    /// Velocities and angular velocities of particles.
    Motions,
    /// Forces and torques on particles.
    Loads,
    /// Which particles are there, and in which order.
    Particles,
    /// Which particles and surfaces are near each other.
    Lists,
    /// Contacts: what touches, and what laws remember.
    Contacts,
    /// Bonds.
    Bonds,
    /// Boundaries and nodes of meshes: places, motions, loads.
    Boundaries,
    /// Clumps: places, motions, loads.
    Clumps,
    /// The periodic cell and its images.
    Cell,
    /// Temperatures, and the heat of particles and boundaries.
    Heat,
    /// The fluid: its velocity, and what it exchanged with the particles.
    Fluid,
    /// What contacts leave behind: wear, losses of facets, impacts that ended.
    Traces,
    /// Energy books, and the impulse of global damping.
    Books,
    /// The largest speed of what forces move, and how far all went since the stable step was found.
    Speed,
}

impl Part {
    /// All.
    pub const ALL: [Self; 15] = [
        Self::Places,
        Self::Motions,
        Self::Loads,
        Self::Particles,
        Self::Lists,
        Self::Contacts,
        Self::Bonds,
        Self::Boundaries,
        Self::Clumps,
        Self::Cell,
        Self::Heat,
        Self::Fluid,
        Self::Traces,
        Self::Books,
        Self::Speed,
    ];
}

/// One stage.
pub struct Stage {
    /// What it is called.
    pub name: &'static str,
    /// Which scenes have it, in words.
    pub scenes: &'static str,
    /// Whether a simulation needs it.
    pub(super) is_needed: fn(&Simulation) -> bool,
    /// What it reads.
    pub reads: &'static [Part],
    /// What it writes.
    pub writes: &'static [Part],
    /// What it does.
    pub(super) run: fn(&mut Simulation, &mut TimeStep),
}

/// The stages that a simulation needs.
#[derive(Default)]
pub(super) struct Stages([Vec<&'static Stage>; Phase::ALL.len()]);

impl Stages {
    /// Those of a simulation.
    pub(super) fn of(simulation: &Simulation) -> Self {
        // Where the mechanics are frozen heat alone flows, but forces are evaluated at the start: they tell what touches.
        let frozen = simulation.scene.heat.frozen;
        let runs = |phase, stage: &Stage| !frozen || phase == Phase::Forces || stage.writes == [Part::Heat];
        let needed = |phase, stage: &Stage| (stage.is_needed)(simulation) && runs(phase, stage);
        let of_phase = |phase| ROWS[phase as usize].iter().filter(|stage| needed(phase, stage)).collect();
        Self(Phase::ALL.map(of_phase))
    }

    /// Those of a phase.
    pub(super) fn in_phase(&self, phase: Phase) -> &[&'static Stage] {
        &self.0[phase as usize]
    }
}

impl Simulation {
    /// The stages of its time step, phase by phase in their order.
    pub fn stages(&self) -> impl Iterator<Item = (Phase, &'static Stage)> + '_ {
        Phase::ALL.into_iter().flat_map(|phase| self.stages.in_phase(phase).iter().map(move |stage| (phase, *stage)))
    }
}

/// All stages that there are, phase by phase in their order.
pub fn all_stages() -> impl Iterator<Item = (Phase, &'static Stage)> {
    Phase::ALL.into_iter().flat_map(|phase| ROWS[phase as usize].iter().map(move |stage| (phase, stage)))
}
