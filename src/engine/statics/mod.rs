//! Condensed static stiffness: how the force on a boundary changes by a small displacement, when everything else has come
//! to rest again.
//!
//! ```text
//! J = ∂(loads on bodies)/∂(their displacements),  f = ∂(loads on bodies)/∂(displacement of the boundary)
//! J u + f = 0,   stiffness = −∂(force on the boundary) of both together
//! ```
//!
//! The columns of J are differences of the evaluation that time steps make, at rest and so slowly that dashpots have no
//! effect. They include every law, formulation and surface, sticking and sliding contacts. Bodies that act on no
//! common body are displaced together, so a packing of any size takes about a hundred evaluations. Sliding, and
//! springs whose stiffness follows the overlap, make J unsymmetric; it is solved by iteration. Free directions make J singular:
//! bodies that bear nothing are left out, others stay where they are along them. At the end all bodies are
//! displaced by the solution, and the load that is left on them is reported.

mod columns;
mod network;
mod solution;

use crate::base::quantity::BoundaryIndex;
use crate::engine::run_error::RunError;
use crate::engine::simulation::{Displacement, Probe, ProbeBody, Simulation};
use crate::engine::state::State;
use columns::Columns;
use network::Network;
use solution::Factors;

/// Displacement by which differences are taken, over the mean overlap of the contacts.
const OF_OVERLAP: f64 = 1e-4;
/// Lower bound of that displacement, over the smallest radius: it must be large beside the rounding of positions.
const LEAST: f64 = 1e-9;
/// The displacement if nothing touches, so that bonds alone respond.
const OF_RADIUS: f64 = 1e-6;

/// Why there is no stiffness.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StaticsError {
    /// The scene has something that has no static stiffness.
    #[error("expected {expected}, found {what}, which has no static stiffness")]
    Refused {
        /// What it is.
        what: String,
        /// What was expected.
        expected: &'static str,
    },
    /// Forces cannot be evaluated.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The iteration finds no solution of the equations.
    #[error(
        "the network of {freedoms} freedoms comes to no rest when boundary {boundary} is displaced: it is not stable"
    )]
    Unstable {
        /// The boundary.
        boundary: String,
        /// How many degrees of freedom there are.
        freedoms: usize,
    },
}

/// The stiffness of a boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryStiffness {
    /// The boundary.
    pub boundary: BoundaryIndex,
    /// Decrease of the force \[N\] along the first axis for each displacement \[m\] along the second.
    pub matrix: [[f64; 3]; 3],
    /// Largest load that is left on a body, over the largest that the displaced boundary puts on one.
    pub residual: f64,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Stiffness {
    /// Boundaries, in the order in which they were asked for.
    pub boundaries: Vec<BoundaryStiffness>,
    /// How many degrees of freedom were solved for.
    pub freedoms: usize,
    /// Particles that bear nothing and are left out, by their numbers in the scene's order: they touch nothing, or one other thing,
    /// which is not a rattler.
    pub rattlers: Vec<u32>,
    /// Particles that bear something and are free in some direction, in which they stay, likewise.
    pub loose: Vec<u32>,
    /// Largest difference of two mirrored entries over the largest entry: 0 if all contacts stick and all springs are linear.
    pub asymmetry: f64,
}

/// The stiffness of some boundaries at the present state of a simulation, which should be at rest.
pub fn stiffness(simulation: &Simulation, boundaries: &[BoundaryIndex]) -> Result<Stiffness, StaticsError> {
    if let Some((what, expected)) = simulation.scene().without_statics() {
        return Err(StaticsError::Refused { what, expected });
    }
    let mut probe = Probe::of(simulation);
    let way = way(simulation, probe.rest());
    let Held { network, columns, factors, rattlers } = held(&mut probe, way)?;
    let freedoms = columns.freedoms();
    let mut loose: Vec<u32> = factors.loose().map(|body| network.ids[body]).collect();
    loose.sort_unstable();
    let mut found = Stiffness { boundaries: Vec::new(), freedoms, rattlers, loose, asymmetry: columns.asymmetry() };
    for &boundary in boundaries {
        let mut one = BoundaryStiffness { boundary, matrix: [[0.0; 3]; 3], residual: 0.0 };
        for axis in 0..3 {
            let shift = |amount| Displacement { body: ProbeBody::Boundary(boundary), axis, amount };
            let pushed = columns::difference(&mut probe, &network, way, |amount| vec![shift(amount)])?;
            let name = || simulation.scene().boundaries[boundary.index()].name.clone();
            let unstable = || StaticsError::Unstable { boundary: name(), freedoms };
            let answer = factors.solve(&columns, &pushed.loads).ok_or_else(unstable)?;
            let most = answer.iter().fold(1.0, |most: f64, part| most.max(part.abs()));
            let relaxed = columns::difference(&mut probe, &network, way / most, |amount| {
                network.displacements(&answer, amount).chain([shift(amount)]).collect()
            })?;
            let force = relaxed.boundaries[boundary.index()];
            for (row, force) in one.matrix.iter_mut().zip(force) {
                row[axis] = -force;
            }
            let largest = |loads: &[f64]| loads.iter().fold(0.0, |most: f64, load| most.max(load.abs()));
            if largest(&pushed.loads) > 0.0 {
                one.residual = one.residual.max(largest(&relaxed.loads) / largest(&pushed.loads));
            }
        }
        found.boundaries.push(one);
    }
    Ok(found)
}

/// What bears something of a packing.
struct Held {
    /// The bodies.
    network: Network,
    /// Their equations.
    columns: Columns,
    /// How these are solved.
    factors: Factors,
    /// Particles that bear nothing: numbers in the scene's order.
    rattlers: Vec<u32>,
}

/// Leaves out loose bodies that touch one other thing alone, again and again: they follow it, and what they touch may be such a
/// body then.
fn held(probe: &mut Probe, way: f64) -> Result<Held, RunError> {
    let mut rattlers = Vec::new();
    loop {
        let network = Network::of(probe);
        let columns = Columns::of(probe, &network, way)?;
        let factors = Factors::of(&columns, rounding(probe.rest()) / way);
        let follow: Vec<usize> = factors.loose().filter(|&body| network.touches[body] == 1).collect();
        if follow.is_empty() {
            rattlers.extend(&network.rattlers);
            rattlers.sort_unstable();
            return Ok(Held { network, columns, factors, rattlers });
        }
        rattlers.extend(follow.iter().map(|&body| network.ids[body]));
        probe.leave_out(follow.iter().map(|&body| network.slots[body]));
    }
}

/// Rounding of the coordinates of the particles \[m\].
fn rounding(state: &State) -> f64 {
    let farthest =
        state.particles.position.iter().flat_map(|row| &row[..3]).fold(0.0, |most: f64, x| most.max(x.abs()));
    f64::EPSILON * farthest
}

/// How far bodies are displaced \[m\].
fn way(simulation: &Simulation, state: &State) -> f64 {
    let least = state.particles.position.iter().fold(f64::INFINITY, |least, row| least.min(row[3]));
    match simulation.mean_overlap() {
        Some(overlap) => (OF_OVERLAP * overlap).max(LEAST * least),
        None => OF_RADIUS * least,
    }
}
