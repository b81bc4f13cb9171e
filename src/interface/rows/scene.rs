//! Variables of the scene as a whole.

use super::row::{COUNT, OUTPUT, Present, Row, count};
use crate::engine::state::{BondList, Loss};
use crate::interface::losses::LOSSES;
use crate::interface::{Quantity, Value, Variability, losses};

/// The output of a loss, by its place.
pub(super) const fn lost<const PLACE: usize>() -> Row {
    let (name, description) = LOSSES[PLACE];
    Row {
        name,
        description,
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| losses::is_booked(scene, Loss::ALL[PLACE]),
        read: |now, _| Value::Real(now.findings.losses(now.simulation)[PLACE]),
        ..OUTPUT
    }
}

/// What each loss took, and what they leave unaccounted.
pub(super) static OF_LOSSES: [Row; Loss::COUNT + 1] = [
    lost::<0>(),
    lost::<1>(),
    lost::<2>(),
    lost::<3>(),
    lost::<4>(),
    lost::<5>(),
    lost::<6>(),
    lost::<7>(),
    lost::<8>(),
    lost::<9>(),
    lost::<10>(),
    lost::<11>(),
    lost::<12>(),
    lost::<13>(),
    Row {
        name: "energy.physical_residual",
        description: "kinetic, elastic and potential energy and all losses since the start, less what boundaries and forces \
                      gave: the error of the time stepping",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.output.losses,
        read: |now, _| {
            let Present { simulation, findings } = now;
            let (kinetic, elastic) = (findings.kinetic(simulation), findings.elastic(simulation).all);
            let residual = simulation.physical_residual_beside(kinetic, elastic, findings.losses(simulation));
            Value::Real(residual.unwrap_or(0.0))
        },
        ..OUTPUT
    },
];

/// Variables of the scene as a whole.
pub(super) static OF_SCENE: [Row; 14] = [
    Row {
        name: "energy.kinetic",
        description: "kinetic energy of the particles, clumps and groups that move freely",
        quantity: Quantity::Energy,
        minimum: Some(0.0),
        follows_inputs_at_start: false,
        read: |now, _| Value::Real(now.findings.kinetic(now.simulation)),
        ..OUTPUT
    },
    Row {
        name: "energy.elastic",
        description: "elastic energy of normal forces, tangential springs and bonds",
        quantity: Quantity::Energy,
        minimum: Some(0.0),
        exists: |scene, _| !(scene.contacts.is_empty() && scene.bonds.is_empty()),
        read: |now, _| Value::Real(now.findings.elastic(now.simulation).all),
        ..OUTPUT
    },
    Row {
        name: "energy.dissipated",
        description: "energy that contacts, bonds and global damping took in and do not hold as elastic energy, since \
                      the start",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.output.energy,
        read: |now, _| {
            let elastic = now.findings.elastic(now.simulation).all;
            Value::Real(now.simulation.dissipated_energy_beside(elastic).unwrap_or(0.0))
        },
        ..OUTPUT
    },
    Row {
        name: "energy.residual",
        description: "change of the kinetic energy less the work of every force, as the time steps do it",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| scene.output.energy,
        read: |now, _| {
            let kinetic = now.findings.kinetic(now.simulation);
            Value::Real(now.simulation.energy_residual_beside(kinetic).unwrap_or(0.0))
        },
        ..OUTPUT
    },
    Row {
        name: "contacts.count",
        description: "number of contacts, those with boundaries included",
        read: |now, _| count(now.findings.contacts(now.simulation)),
        ..COUNT
    },
    Row {
        name: "contacts.near_switch",
        description: "number of contacts near a switch: a ten-thousandth of the overlap more or less would let them begin or end \
                      to slide, or to touch",
        exists: |scene, _| scene.output.near_switch,
        read: |now, _| count(now.findings.near_switch(now.simulation)),
        ..COUNT
    },
    Row {
        name: "overlap.max",
        description: "largest overlap over the smaller radius",
        minimum: Some(0.0),
        read: |now, _| Value::Real(now.findings.largest_overlap(now.simulation)),
        ..OUTPUT
    },
    Row {
        name: "bonds.intact",
        description: "number of living bonds",
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| count(now.bonds().iter().map(|list| list.first.len() as u64).sum()),
        ..COUNT
    },
    Row {
        name: "bonds.broken",
        description: "number of bonds that broke since the start",
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| count(now.bonds().iter().map(|list| list.broken).sum()),
        ..COUNT
    },
    Row {
        name: "bonds.removed",
        description: "number of bonds that were taken away with a particle since the start; they are not among the broken ones",
        exists: |scene, _| !scene.bonds.is_empty() && scene.removes(),
        read: |now, _| count(now.bonds().iter().map(|list| list.removed).sum()),
        ..COUNT
    },
    Row {
        name: "bonds.elastic_energy",
        description: "elastic energy of the living bonds",
        quantity: Quantity::Energy,
        minimum: Some(0.0),
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| Value::Real(now.findings.elastic(now.simulation).bonds),
        ..OUTPUT
    },
    Row {
        name: "bonds.dissipated_energy",
        description: "energy that damping and relaxation took of the bonds and that broken bonds released, since the \
                      start",
        quantity: Quantity::Energy,
        follows_inputs_at_start: false,
        exists: |scene, _| !scene.bonds.is_empty(),
        read: |now, _| Value::Real(now.bonds().iter().map(BondList::dissipated).sum()),
        ..OUTPUT
    },
    Row {
        name: "time_step.current",
        description: "the time step",
        quantity: Quantity::Time,
        variability: Variability::Discrete,
        minimum: Some(0.0),
        read: |now, _| Value::Real(now.simulation.state().clock.step),
        ..OUTPUT
    },
    Row {
        name: "time_step.stable",
        description: "a stable time step, as last computed; the largest one unless the given step is far below it",
        quantity: Quantity::Time,
        variability: Variability::Discrete,
        minimum: Some(0.0),
        // where nothing is stiff there is no bound, and infinity is not a value of a variable
        read: |now, _| Value::Real(now.simulation.state().clock.stable.min(f64::MAX)),
        ..OUTPUT
    },
];
