//! Variables of what contacts leave on each boundary.

use super::row::{At, Each, OUTPUT, Present, Row};
use crate::engine::state::FacetTraces;
use crate::interface::{Quantity, Value};

/// An output of each boundary that sums up what its contacts left.
const OF_BOUNDARY: Row =
    Row { each: Each::Boundary, quantity: Quantity::Energy, follows_inputs_at_start: false, ..OUTPUT };

/// The sum over the facets of a boundary.
fn sum(now: Present, at: At, of: fn(&FacetTraces) -> &[f64]) -> Value {
    let traces = now.simulation.state().traces.as_ref();
    let facets = traces.and_then(|traces| traces.boundaries.get(at.boundary.index()));
    Value::Real(facets.map_or(0.0, |facets| of(facets).iter().sum()))
}

/// Variables of boundaries.
pub(super) static OF_TRACES: [Row; 3] = [
    Row {
        name: "wear",
        description: "volume that particles wore off {boundary} since the start",
        quantity: Quantity::Volume,
        exists: |scene, at| !scene.boundaries[at.boundary.index()].wear.is_empty(),
        read: |now, at| sum(now, at, |facets| &facets.wear),
        ..OF_BOUNDARY
    },
    Row {
        name: "impact_energy.normal",
        description: "energy that contacts with {boundary} lost along the normal since the start",
        exists: |scene, _| scene.output.impacts.is_some(),
        read: |now, at| sum(now, at, |facets| &facets.normal),
        ..OF_BOUNDARY
    },
    Row {
        name: "impact_energy.tangential",
        description: "energy that contacts with {boundary} lost across the normal since the start: sliding, its dashpots, rolling",
        exists: |scene, _| scene.output.impacts.is_some(),
        read: |now, at| sum(now, at, |facets| &facets.tangential),
        ..OF_BOUNDARY
    },
];
