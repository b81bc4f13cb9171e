//! What is written at a communication point.

use crate::engine::simulation::Simulation;
use crate::interface::{Findings, Interface, fields};
use crate::output::results::job::Job;

/// The row of the history at the present time.
pub(crate) fn row(interface: &Interface, simulation: &Simulation, time: f64) -> Job {
    let found = Findings::default();
    let values = interface.recorded().map(|(index, _)| interface.value_with(simulation, &found, index)).collect();
    Job::Row { time, values }
}

/// The frame at the present time.
pub(crate) fn frame(simulation: &Simulation, time: f64) -> Job {
    let scene = simulation.scene();
    let particles = Box::new(simulation.state().particles.clone());
    let output = &scene.output;
    let contacts = (output.contacts || output.boundaries).then(|| simulation.contacts());
    let bonds = (!scene.bonds.is_empty()).then(|| simulation.bonds());
    let boundaries =
        output.boundaries.then(|| (simulation.state().boundaries.clone(), simulation.state().nodes.clone()));
    let traces = simulation.state().traces.as_ref().filter(|_| output.boundaries);
    let traces = traces.map(|traces| traces.boundaries.clone());
    let cell = simulation.state().cell.clone().map(Box::new);
    let clumps = scene.has_clumps().then(|| Box::new(simulation.state().clumps.clone()));
    let grids = scene.grids.iter().enumerate().filter(|(_, grid)| !grid.outputs.is_empty());
    let grids = grids.map(|(place, _)| fields(simulation, place)).collect();
    Job::Frame { time, particles, contacts, bonds, boundaries, traces, cell, clumps, grids }
}
