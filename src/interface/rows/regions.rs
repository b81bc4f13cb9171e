//! Variables of each region.

use super::row::{COUNT, Each, OUTPUT, Row, count};
use crate::base::geometry::lattice::STRAIN_PLACES;
use crate::interface::{Quantity, Value};

/// What most outputs of regions have in common.
pub(super) const OF_REGION: Row = Row { each: Each::Region, ..OUTPUT };

/// Variables of each region.
pub(super) static OF_REGIONS: [Row; 9] = [
    Row {
        name: "stress",
        each: Each::Component,
        description: "mean stress in {region}, component {axis}, tension positive: of contacts and bonds by the part of their \
                      branch inside, and of the velocities less their mean",
        quantity: Quantity::Pressure,
        read: |now, at| Value::Real(now.findings.stress(now.simulation, at.place(), STRAIN_PLACES[at.axis()])),
        ..OF_REGION
    },
    Row {
        name: "porosity",
        description: "part of the volume of {region} that no particle fills; overlaps of particles count twice",
        read: |now, at| {
            let volume = now.simulation.scene().regions[at.place()].shape.volume();
            Value::Real(1.0 - now.content(at).solid / volume)
        },
        ..OF_REGION
    },
    Row {
        name: "coordination",
        description: "contacts of a particle whose centre is in {region}, in the mean; those at boundaries count",
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.findings.coordination(now.simulation, at.place())),
        ..OF_REGION
    },
    Row {
        name: "granular_temperature",
        description: "a third of the mean square of the velocity in {region} less the mean velocity, by mass",
        quantity: Quantity::GranularTemperature,
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.content(at).granular_temperature()),
        ..OF_REGION
    },
    Row {
        name: "temperature",
        description: "temperature in {region}, mean by heat capacity; 0 where there is no particle",
        quantity: Quantity::Temperature,
        minimum: Some(0.0),
        exists: |scene, _| scene.has_heat(),
        read: |now, at| Value::Real(now.content(at).temperature),
        ..OF_REGION
    },
    Row {
        name: "mass",
        description: "mass in {region}, of each particle by the part of its volume inside",
        quantity: Quantity::Mass,
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.content(at).mass),
        ..OF_REGION
    },
    Row {
        name: "velocity",
        each: Each::RegionAxis,
        description: "mean velocity of the mass in {region} along {axis}; 0 where there is none",
        quantity: Quantity::Velocity,
        read: |now, at| Value::Real(now.content(at).velocity[at.axis()]),
        ..OF_REGION
    },
    Row {
        name: "count",
        each: Each::Region,
        description: "number of particles whose centre is in {region}, a clump as one",
        read: |now, at| count(now.findings.counts(now.simulation, at.place()).all),
        ..COUNT
    },
    Row {
        name: "count_by_set",
        each: Each::RegionSet,
        description: "number of particles of the set {axis} whose centre is in {region}, a clump as one",
        read: |now, at| count(now.findings.counts(now.simulation, at.place()).of_set[at.axis()]),
        ..COUNT
    },
];
