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
//! springs whose stiffness follows the overlap, make J unsymmetric; it is solved by iteration, about sparse factors of its symmetric
//! part or, in the unit and where factors would be too large, about the bodies' own blocks. Free directions make J singular:
//! bodies that bear nothing are left out, others stay where they are along them. At the end all bodies are
//! displaced by the solution, and the load that is left on them is reported.
//!
//! The tangent of a cell is the same with a strain of the cell in the place of the boundary's displacement, and its stress in that of the
//! force.

mod columns;
mod factors;
mod network;
mod newton;
mod solution;

pub use factors::{Divide, Factorise, Factors};
pub use newton::{Motionless, come_to_rest};

use crate::base::geometry::lattice::STRAINS;
use crate::base::quantity::BoundaryIndex;
use crate::engine::run_error::RunError;
use crate::engine::simulation::{Displacement, Probe, ProbeBody, Simulation};
use crate::engine::state::State;
use crate::engine::state::cell::Strains;
use columns::{Columns, Difference};
use network::Network;
use solution::Equations;

/// Displacement by which differences are taken, over the mean overlap of the contacts.
const OF_OVERLAP: f64 = 1e-4;
/// Lower bound of that displacement, over the smallest radius: it must be large beside the rounding of positions.
const LEAST: f64 = 1e-9;
/// The displacement if nothing touches, so that bonds alone respond.
const OF_RADIUS: f64 = 4e-6;

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
    #[error("the network of {freedoms} freedoms comes to no rest when {moved} is displaced: it is not stable")]
    Unstable {
        /// What is displaced.
        moved: String,
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

/// The tangent of the periodic cell.
#[derive(Clone, Debug, PartialEq)]
pub struct CellStiffness {
    /// Change of the Cauchy stress xx, yy, zz, xy, xz, yz \[Pa\] for each unit of the strains, in the measures of `cell.strain`; zeros along
    /// edges that do not repeat.
    pub matrix: [Strains; 6],
    /// Largest load that is left on a body, over the largest that the strain puts on one.
    pub residual: f64,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Stiffness {
    /// Boundaries, in the order in which they were asked for.
    pub boundaries: Vec<BoundaryStiffness>,
    /// The cell, where there is one.
    pub cell: Option<CellStiffness>,
    /// How many degrees of freedom were solved for.
    pub freedoms: usize,
    /// Particles that bear nothing and are left out, by their numbers in the scene's order: they touch nothing, or one other thing, or
    /// others that nothing holds.
    pub rattlers: Vec<u32>,
    /// Particles that bear something and are free in some direction, by themselves or (as factors tell) together, in which they stay, likewise.
    pub loose: Vec<u32>,
    /// Largest difference of two mirrored entries over the largest entry: 0 if all contacts stick and all springs are linear.
    pub asymmetry: f64,
}

/// The stiffness of some boundaries and of the cell at the present state of a simulation, which should be at rest: about factors, or by iteration
/// alone, with the same bits on every processor.
pub fn stiffness(
    simulation: &Simulation,
    boundaries: &[BoundaryIndex],
    factorise: Option<Factorise>,
) -> Result<Stiffness, StaticsError> {
    let scene = simulation.scene();
    if let Some((what, expected)) = scene.without_statics() {
        return Err(StaticsError::Refused { what, expected });
    }
    let mut rest = Rest::of(simulation, factorise)?;
    let number = |body: usize| rest.network.ids[body];
    let mut loose: Vec<u32> = rest.equations.loose().into_iter().map(number).collect();
    loose.sort_unstable();
    let freedoms = rest.equations.columns.freedoms();
    let asymmetry = rest.equations.columns.asymmetry();
    let rattlers = std::mem::take(&mut rest.rattlers);
    let mut found = Stiffness { boundaries: Vec::new(), cell: None, freedoms, rattlers, loose, asymmetry };
    for &boundary in boundaries {
        let mut one = BoundaryStiffness { boundary, matrix: [[0.0; 3]; 3], residual: 0.0 };
        for axis in 0..3 {
            let shift = |amount| Displacement { body: ProbeBody::Boundary(boundary), axis, amount };
            let moved = || format!("boundary {}", scene.boundaries[boundary.index()].name);
            let (relaxed, residual) = rest.relaxed(shift, moved)?;
            for (row, force) in one.matrix.iter_mut().zip(relaxed.boundaries[boundary.index()]) {
                row[axis] = -force;
            }
            one.residual = one.residual.max(residual);
        }
        found.boundaries.push(one);
    }
    if let Some(cell) = &scene.cell {
        let mut one = CellStiffness { matrix: [[0.0; 6]; 6], residual: 0.0 };
        // A strain moves the next particle about as far as the way.
        let size = power_of_two(rest.network.radii.iter().copied().fold(0.0, f64::max));
        for component in (0..6).filter(|&component| cell.repeats(component)) {
            let strain = |amount| Displacement { body: ProbeBody::Cell, axis: component, amount: amount / size };
            let moved = || format!("the cell by strain {}", STRAINS[component]);
            let (relaxed, residual) = rest.relaxed(strain, moved)?;
            for row in (0..6).filter(|&row| cell.repeats(row)) {
                one.matrix[row][component] = relaxed.stress[row] * size;
            }
            one.residual = one.residual.max(residual);
        }
        found.cell = Some(one);
    }
    Ok(found)
}

/// What bears something of a packing at rest.
struct Rest {
    /// The packing, from which bodies are displaced.
    probe: Probe,
    /// How far \[m\].
    way: f64,
    /// The bodies.
    network: Network,
    /// Their equations.
    equations: Equations,
    /// Particles that bear nothing: numbers in the scene's order, ascending.
    rattlers: Vec<u32>,
}

impl Rest {
    /// Leaves out loose bodies that touch one other thing alone, again and again: they follow it, and what they touch may be such a
    /// body then.
    fn of(simulation: &Simulation, factorise: Option<Factorise>) -> Result<Self, RunError> {
        let mut probe = Probe::of(simulation);
        let way = way(simulation, probe.rest());
        let mut rattlers = Vec::new();
        loop {
            let network = Network::of(&probe);
            let columns = Columns::of(&mut probe, &network, way)?;
            let mut equations = Equations::of(columns, &network, f64::EPSILON * network.reach / way);
            let follow: Vec<usize> = equations.free().filter(|&body| network.touches[body] == 1).collect();
            if follow.is_empty() {
                rattlers.extend(&network.rattlers);
                rattlers.sort_unstable();
                if let Some(factorise) = factorise {
                    equations.factorise(factorise);
                }
                return Ok(Self { probe, way, network, equations, rattlers });
            }
            rattlers.extend(follow.iter().map(|&body| network.ids[body]));
            let slots: Vec<u32> = follow.iter().filter_map(|&body| network.bodies[body].slot(probe.rest())).collect();
            probe.leave_out(slots.into_iter());
        }
    }

    /// How everything changes with a displacement when the bodies have come to rest again; and the largest load that is left on one, over
    /// the largest that the displacement puts on one.
    fn relaxed(
        &mut self,
        shift: impl Fn(f64) -> Displacement,
        moved: impl Fn() -> String,
    ) -> Result<(Difference, f64), StaticsError> {
        let Self { probe, way, network, equations, .. } = self;
        let pushed = columns::difference(probe, network, *way, |amount| vec![shift(amount)])?;
        let unstable = || StaticsError::Unstable { moved: moved(), freedoms: equations.columns.freedoms() };
        let answer = equations.solve(&pushed.loads).ok_or_else(unstable)?;
        let most = answer.iter().fold(1.0, |most: f64, part| most.max(part.abs()));
        let relaxed = columns::difference(probe, network, *way / power_of_two(most), |amount| {
            network.displacements(&answer, amount).chain([shift(amount)]).collect()
        })?;
        let largest = |loads: &[f64]| loads.iter().fold(0.0, |most: f64, load| most.max(load.abs()));
        let before = largest(&pushed.loads);
        let residual = if equations.is_rounding(before) { 0.0 } else { largest(&relaxed.loads) / before };
        Ok((relaxed, residual))
    }
}

/// How far bodies are displaced \[m\]: a power of two, which coordinates take without rounding.
fn way(simulation: &Simulation, state: &State) -> f64 {
    let least = state.particles.position.iter().fold(f64::INFINITY, |least, row| least.min(row[3]));
    power_of_two(match simulation.mean_overlap() {
        Some(overlap) => (OF_OVERLAP * overlap).max(LEAST * least),
        None => OF_RADIUS * least,
    })
}

/// The power of two at or below a number.
fn power_of_two(number: f64) -> f64 {
    f64::from_bits(number.to_bits() & !((1 << 52) - 1))
}
