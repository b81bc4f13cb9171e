//! Variables of each probe.

use super::row::{At, Each, OUTPUT, Row};
use crate::interface::{Quantity, Value};
use crate::scene::{Probed, Scene};

/// What most outputs of probes have in common.
const OF_PROBE: Row = Row { each: Each::ProbeAxis, follows_inputs_at_start: false, ..OUTPUT };

/// Whether it looks at particles.
fn of_particles(scene: &Scene, at: At) -> bool {
    !of_contact(scene, at)
}

/// Whether it looks at one particle.
fn of_one(scene: &Scene, at: At) -> bool {
    matches!(scene.probes[at.place()].of, Probed::Particle(_))
}

/// Whether it looks at a contact.
fn of_contact(scene: &Scene, at: At) -> bool {
    matches!(scene.probes[at.place()].of, Probed::Contact(_))
}

/// Variables of each probe.
pub(super) static OF_PROBES: [Row; 8] = [
    Row {
        name: "position",
        description: "place of the particle of {owner}, or of the mass centre of its set, along {axis}",
        quantity: Quantity::Length,
        exists: of_particles,
        read: |now, at| Value::Real(now.sight(at).position[at.axis()]),
        ..OF_PROBE
    },
    Row {
        name: "velocity",
        description: "velocity of the particle of {owner}, or of the mass centre of its set, along {axis}",
        quantity: Quantity::Velocity,
        exists: of_particles,
        read: |now, at| Value::Real(now.sight(at).velocity[at.axis()]),
        ..OF_PROBE
    },
    Row {
        name: "angular_velocity",
        description: "angular velocity of the particle of {owner} about {axis}",
        quantity: Quantity::AngularVelocity,
        exists: of_one,
        read: |now, at| Value::Real(now.sight(at).angular_velocity[at.axis()]),
        ..OF_PROBE
    },
    Row {
        name: "temperature",
        each: Each::Probe,
        description: "temperature of the particle of {owner}, or mean by heat capacity of its set",
        quantity: Quantity::Temperature,
        minimum: Some(0.0),
        exists: |scene, at| scene.has_heat() && of_particles(scene, at),
        read: |now, at| Value::Real(now.sight(at).temperature),
        ..OF_PROBE
    },
    Row {
        name: "force",
        description: "sum of all forces on the particle or set of {owner} along {axis}; of a contact, what contact and bond of the \
                      second particle do to the first",
        quantity: Quantity::Force,
        read: |now, at| Value::Real(now.sight(at).force[at.axis()]),
        ..OF_PROBE
    },
    Row {
        name: "torque",
        description: "sum of all torques on the particle of {owner} about {axis}",
        quantity: Quantity::Torque,
        exists: of_one,
        read: |now, at| Value::Real(now.sight(at).torque[at.axis()]),
        ..OF_PROBE
    },
    Row {
        name: "normal_force",
        each: Each::Probe,
        description: "force between the two particles of {owner} along the line of their centres, positive where they push",
        quantity: Quantity::Force,
        exists: of_contact,
        read: |now, at| Value::Real(now.sight(at).normal_force),
        ..OF_PROBE
    },
    Row {
        name: "overlap",
        each: Each::Probe,
        description: "sum of the radii of the two particles of {owner} less the distance of their centres",
        quantity: Quantity::Length,
        exists: of_contact,
        read: |now, at| Value::Real(now.sight(at).overlap),
        ..OF_PROBE
    },
];
