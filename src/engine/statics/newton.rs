//! A bonded network brought to rest by Newton's method: the loads that are left, divided by the stiffness, again and again.

use super::columns::{Columns, loads};
use super::network::Network;
use super::solution::Equations;
use super::{Factorise, way};
use crate::engine::run_error::RunError;
use crate::engine::simulation::{Probe, Simulation};
use crate::engine::state::State;
use crate::scene::{Boundary, CellMotion};

/// Most iterations: where a network bends far each leads some way.
const MOST: usize = 50;

/// The farthest that a body goes in one iteration against one that it is bonded to, over the smallest radius; that it turns, likewise at its
/// radius. Loads turn with the bodies, so the stiffness holds about as far.
const FARTHEST: f64 = 0.25;

/// Why Newton's method does not lead to rest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Motionless {
    /// The scene has something that it cannot follow.
    #[error("{0} is beyond it")]
    Beyond(String),
    /// Particles touch, so that where they come to rest depends on the way.
    #[error("particles touch: where they rest depends on their way")]
    Touching,
    /// Forces cannot be evaluated.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Some particles can move without a load.
    #[error("{} can move without a load, first {first}", crate::base::words::counted(*count as u64, "particle"))]
    Loose {
        /// The first of them, by its number in the scene's order.
        first: u32,
        /// How many.
        count: usize,
    },
    /// It gives way.
    #[error("the network gives way, or is too large for factors")]
    Unstable,
    /// A bond broke on the way.
    #[error("bonds break on the way")]
    Breaks,
    /// It was told to stop.
    #[error("it was stopped")]
    Stopped,
    /// Too many iterations.
    #[error("{iterations} iterations left an unbalanced force of {ratio:.1e} of the mean bond force")]
    Slow {
        /// How many.
        iterations: usize,
        /// What they left.
        ratio: f64,
    },
}

/// Brings a bonded network in which nothing touches to rest, until its unbalanced force is below a `tolerance` of the mean force of the bonds.
/// Returns the number of iterations; where there is no rest to be found so, nothing has changed. Each iteration tells the ratio
/// before it, and is made if the answer is that it goes on.
pub fn come_to_rest(
    simulation: &mut Simulation,
    tolerance: f64,
    factorise: Factorise,
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<usize, Motionless> {
    let scene = simulation.scene();
    if let Some((what, _)) = scene.without_rest() {
        return Err(Motionless::Beyond(what));
    }
    let surface = |it: &&Boundary| {
        it.shape.members().is_empty() && it.axes.iter().any(|axis| axis.is_free() || axis.takes_force())
    };
    if let Some(boundary) = scene.boundaries.iter().find(surface) {
        return Err(Motionless::Beyond(format!("[boundary.{}], a surface moved by forces,", boundary.name)));
    }
    if scene.cell.as_ref().is_some_and(|cell| cell.motion.iter().any(|motion| matches!(motion, CellMotion::Servo(_)))) {
        return Err(Motionless::Beyond("a cell that reaches a stress".to_owned()));
    }
    if simulation.contact_count() > 0 {
        return Err(Motionless::Touching);
    }
    let broken = |state: &State| state.bonds.iter().map(|list| list.broken).sum::<u64>();
    let before = broken(simulation.state());
    let mut probe = Probe::of(simulation);
    for iterations in 0..=MOST {
        let loaded = probe.loaded()?;
        let ratio = loaded.unbalanced_force();
        if broken(loaded.state()) > before {
            return Err(Motionless::Breaks);
        }
        if !watch(ratio) {
            return Err(Motionless::Stopped);
        }
        if ratio < tolerance {
            if loaded.contact_count() > 0 {
                return Err(Motionless::Touching);
            }
            let state = State { ledger: simulation.state().ledger.clone(), ..loaded.state().clone() };
            simulation.return_to(&state);
            return Ok(iterations);
        }
        if iterations == MOST || ratio.is_nan() {
            return Err(Motionless::Slow { iterations, ratio });
        }
        let loaded = loaded.state().clone();
        let network = Network::of(&probe);
        let left: Vec<f64> = loads(&loaded, &network).collect();
        if left.iter().all(|load| *load == 0.0) {
            return Err(Motionless::Slow { iterations, ratio });
        }
        let way = way(simulation, probe.rest());
        let columns = Columns::of(&mut probe, &network, way)?;
        let mut equations = Equations::of(columns, &network, f64::EPSILON * network.reach / way);
        equations.factorise(factorise);
        let mut loose: Vec<u32> = equations.loose().into_iter().map(|body| network.ids[body]).collect();
        loose.extend(&network.rattlers);
        if let Some(&first) = loose.iter().min() {
            return Err(Motionless::Loose { first: simulation.number(first), count: loose.len() });
        }
        if !equations.is_stable() {
            return Err(Motionless::Unstable);
        }
        let answer = equations.solve(&left).ok_or(Motionless::Unstable)?;
        let least = network.radii.iter().copied().fold(f64::INFINITY, f64::min);
        let share = (FARTHEST * least / farthest(&network, &answer)).min(1.0);
        probe.follow(network.displacements(&answer, share))?;
    }
    Err(Motionless::Unstable)
}

/// The farthest that a body goes against a neighbour, or turns \[m\].
fn farthest(network: &Network, ways: &[f64]) -> f64 {
    let of = |body: usize| &ways[body * network.each..(body + 1) * network.each];
    let mut most = 0.0_f64;
    for (body, near) in network.near.iter().enumerate() {
        of(body).iter().skip(3).for_each(|turn| most = most.max(turn.abs()));
        for &other in near {
            let apart = of(body).iter().zip(of(other as usize)).take(3);
            apart.for_each(|(one, other)| most = most.max((one - other).abs()));
        }
    }
    most
}
