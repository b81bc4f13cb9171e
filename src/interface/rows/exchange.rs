//! Variables of what comes, goes and passes.

use super::row::{COUNT, Each, OUTPUT, Row, Write, count};
use crate::engine::simulation::Input;
use crate::interface::{Quantity, Value};
use crate::scene::exchange::{Amount, Outside};

/// The rate of an insertion, as it is given.
pub(super) const RATE: Row = Row {
    name: "rate",
    each: Each::Insertion,
    quantity: Quantity::MassFlow,
    minimum: Some(0.0),
    write: Some(Write {
        set: |simulation, at, value| simulation.set_insertion_rate(at.place(), value),
        set_rate: |simulation, at, rate| simulation.set_insertion_rate_of_rate(at.place(), rate),
        held: |state, at| state.exchange.as_ref().map_or(0.0, |exchange| exchange.feeds[at.place()].rate),
        start: |scene, at| scene.insertions[at.place()].rate().unwrap_or(0.0),
        input: |at| Input::Rate(at.place()),
    }),
    read: |now, at| Value::Real(now.exchanged(|exchange| exchange.feeds[at.place()].rate)),
    ..OUTPUT
};

/// A number of particles that came, went or passed since the start.
pub(super) const EXCHANGED: Row = Row { name: "count", follows_inputs_at_start: false, ..COUNT };

/// Their mass.
pub(super) const EXCHANGED_MASS: Row =
    Row { name: "mass", quantity: Quantity::Mass, follows_inputs_at_start: false, ..OUTPUT };

/// A number of clumps among them.
pub(super) const EXCHANGED_CLUMPS: Row =
    Row { name: "clumps", follows_inputs_at_start: false, exists: |scene, _| scene.has_clumps(), ..COUNT };

/// Variables of each insertion.
pub(super) static OF_INSERTIONS: [Row; 5] = [
    Row {
        description: "mass that comes by {owner} in each second, held in a communication step, or the mean of what changes at its rate",
        exists: |scene, at| matches!(scene.insertions[at.place()].amount, Amount::MassRate(_)),
        ..RATE
    },
    Row {
        description: "number of particles, or clumps, that come by {owner} in each second, held in a communication step, or the mean \
                      of what changes at its rate",
        quantity: Quantity::CountRate,
        exists: |scene, at| matches!(scene.insertions[at.place()].amount, Amount::CountRate(_)),
        ..RATE
    },
    Row {
        each: Each::Insertion,
        description: "number of particles that came by {owner} since the start",
        read: |now, at| count(now.exchanged(|exchange| exchange.feeds[at.place()].came.count)),
        ..EXCHANGED
    },
    Row {
        each: Each::Insertion,
        description: "number of clumps that came by {owner} since the start",
        exists: |scene, at| scene.insertions[at.place()].has_clumps(),
        read: |now, at| count(now.exchanged(|exchange| exchange.feeds[at.place()].came.clumps)),
        ..EXCHANGED_CLUMPS
    },
    Row {
        each: Each::Insertion,
        description: "mass of the particles that came by {owner} since the start",
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.feeds[at.place()].came.mass)),
        ..EXCHANGED_MASS
    },
];

/// Variables of each outlet.
pub(super) static OF_OUTLETS: [Row; 3] = [
    Row {
        each: Each::Outlet,
        description: "number of particles that {owner} took away since the start",
        read: |now, at| count(now.exchanged(|exchange| exchange.outlets[at.place()].count)),
        ..EXCHANGED
    },
    Row {
        each: Each::Outlet,
        description: "number of clumps that {owner} took away since the start",
        read: |now, at| count(now.exchanged(|exchange| exchange.outlets[at.place()].clumps)),
        ..EXCHANGED_CLUMPS
    },
    Row {
        each: Each::Outlet,
        description: "mass of the particles that {owner} took away since the start",
        minimum: Some(0.0),
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.outlets[at.place()].mass)),
        ..EXCHANGED_MASS
    },
];

/// Variables of each flow meter.
pub(super) static OF_METERS: [Row; 4] = [
    Row {
        name: "mass_flow",
        each: Each::Meter,
        description: "mass that passed {owner} towards its front in a second, less what went back: mean over the last communication step",
        quantity: Quantity::MassFlow,
        follows_inputs_at_start: false,
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.meters[at.place()].mass_flow)),
        ..OUTPUT
    },
    Row {
        each: Each::Meter,
        description: "mass that passed {owner} towards its front since the start, less what went back",
        read: |now, at| Value::Real(now.exchanged(|exchange| exchange.meters[at.place()].mass)),
        ..EXCHANGED_MASS
    },
    Row {
        each: Each::Meter,
        description: "number of particles that passed {owner} towards its front since the start, less those that went back",
        minimum: None,
        read: |now, at| Value::Integer(now.exchanged(|exchange| exchange.meters[at.place()].net_count())),
        ..EXCHANGED
    },
    Row {
        each: Each::Meter,
        description: "number of clumps that passed {owner} towards its front since the start, less those that went back",
        minimum: None,
        read: |now, at| Value::Integer(now.exchanged(|exchange| exchange.meters[at.place()].net_clumps())),
        ..EXCHANGED_CLUMPS
    },
];

/// Variables of what lies outside of the domain.
pub(super) static OF_DOMAIN: [Row; 3] = [
    Row {
        name: "domain.count",
        description: "number of particles taken away since the start because they were outside of the domain",
        exists: |scene, _| scene.domain.is_some() && scene.outside == Outside::Remove,
        read: |now, _| count(now.exchanged(|exchange| exchange.outside.count)),
        ..EXCHANGED
    },
    Row {
        name: "domain.clumps",
        description: "number of clumps taken away since the start because they were outside of the domain",
        exists: |scene, _| scene.has_clumps() && scene.domain.is_some() && scene.outside == Outside::Remove,
        read: |now, _| count(now.exchanged(|exchange| exchange.outside.clumps)),
        ..EXCHANGED_CLUMPS
    },
    Row {
        name: "domain.mass",
        description: "mass of the particles taken away since the start because they were outside of the domain",
        minimum: Some(0.0),
        exists: |scene, _| scene.domain.is_some() && scene.outside == Outside::Remove,
        read: |now, _| Value::Real(now.exchanged(|exchange| exchange.outside.mass)),
        ..EXCHANGED_MASS
    },
];
