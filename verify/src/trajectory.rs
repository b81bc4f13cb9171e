//! Runs of a case: from its start, or from each of its samples to the next.

use super::case::Case;
use super::heat::{self, Heated};
use super::history::{History, PairRow};
use super::samples::{Row, Samples};
use super::surfaces::OnSurface;
use cograin::quantity::SetIndex;
use cograin::scene::Scene;
use cograin::simulation::{BondRecord, PlacedBond, PlacedParticle, PlacedSpring, Placement, RunError, Simulation};
use cograin::state::BoundaryState;
use std::sync::Arc;

/// What a run left at one step.
pub(super) struct Sample {
    /// The step.
    pub(super) step: u64,
    /// The particles, in the case's order.
    pub(super) rows: Vec<Row>,
    /// Living bonds between particles.
    pub(super) bonds: Vec<BondRecord>,
    /// Loads on the boundaries, in the order of the case's walls.
    pub(super) surfaces: Vec<OnSurface>,
    /// Kinetic energy, that of contacts without their springs, and that in the field of gravity, 0 at the origin \[J\]; 0 in a case without
    /// surfaces.
    pub(super) energy: f64,
    /// Temperatures and heat flows, in the case's order; empty where no heat flows.
    pub(super) heat: Vec<Heated>,
}

/// What a run left.
#[derive(Default)]
pub(super) struct Run {
    /// Each step that was asked for, in order.
    pub(super) samples: Vec<Sample>,
    /// Why it stopped before its end.
    pub(super) stopped: Option<String>,
}

/// Runs the scene from its start and keeps these steps, in ascending order.
pub(super) fn free(case: &Case, scene: &Arc<Scene>, steps: &[u64]) -> Run {
    let mut run = Run::default();
    let mut go = || -> Result<(), String> {
        let mut simulation = Simulation::new(scene.clone()).map_err(told)?;
        let mut now = 0;
        for &step in steps {
            advance(&mut simulation, case, now, step).map_err(told)?;
            now = step;
            run.samples.push(observe(case, &simulation, step));
        }
        Ok(())
    };
    let result = go();
    run.stopped = result.err();
    run
}

/// Runs the scene from each sample to the next; the first window has the other engine's start, as the first sample.
pub(super) fn windows(case: &Case, scene: &Arc<Scene>, samples: &Samples, history: &History) -> Run {
    let mut run = Run::default();
    let mut go = || -> Result<(), String> {
        for (at, (step, rows)) in samples.rows.iter().enumerate() {
            let mut simulation = if *step == 0 {
                Simulation::new(scene.clone()).map_err(told)?
            } else {
                Simulation::placed(scene.clone(), &placement(case, scene, *step, rows, history.at(*step)))
                    .map_err(told)?
            };
            if at == 0 {
                run.samples.push(observe(case, &simulation, *step));
            }
            let Some((next, _)) = samples.rows.get(at + 1) else { break };
            advance(&mut simulation, case, *step, *next).map_err(told)?;
            run.samples.push(observe(case, &simulation, *next));
        }
        Ok(())
    };
    let result = go();
    run.stopped = result.err();
    run
}

/// Why a run stopped, in words.
fn told(cause: RunError) -> String {
    cause.to_string()
}

/// Makes the steps between two numbers.
fn advance(simulation: &mut Simulation, case: &Case, from: u64, to: u64) -> Result<(), RunError> {
    if to > from { simulation.advance((to - from) as f64 * case.dt) } else { Ok(()) }
}

/// A stored sample as a simulation takes it.
fn placement(case: &Case, scene: &Scene, step: u64, rows: &[Row], pairs: &[PairRow]) -> Placement {
    let particle = |in_case: usize| {
        let [position, velocity, angular_velocity, force, torque] = rows[in_case];
        PlacedParticle { position, velocity, angular_velocity, force, torque }
    };
    let spring = |pair: &PairRow| PlacedSpring { bodies: pair.bodies, spring: pair.spring, offset: pair.offset };
    Placement {
        steps: step,
        particles: case.by_id().into_iter().map(particle).collect(),
        springs: pairs.iter().map(spring).collect(),
        bonds: pairs.iter().filter(|pair| pair.bonded).filter_map(|pair| placed_bond(scene, pair)).collect(),
    }
}

/// A stored bond, in the rows of `engine_exact`.
fn placed_bond(scene: &Scene, pair: &PairRow) -> Option<PlacedBond> {
    let set = |body: u32| scene.particles[body as usize].set;
    let mut between: [SetIndex; 2] = pair.bodies.map(set);
    between.sort_by_key(|set| set.0);
    let law = scene.bonds.iter().position(|bond| bond.plane.is_none() && bond.between == between)?;
    let row = |[x, y, z]: [f64; 3], last: f64| [x, y, z, last];
    Some(PlacedBond {
        law,
        bodies: pair.bodies,
        rows: [row(pair.shear, pair.rest), row(pair.torsion, 0.0), row(pair.bending, 0.0)],
    })
}

/// The case as it is now.
fn observe(case: &Case, simulation: &Simulation, step: u64) -> Sample {
    let particles = &simulation.state().particles;
    let three = |row: &[f64; 4]| [row[0], row[1], row[2]];
    let mut rows = vec![Row::default(); case.particles.len()];
    for (in_scene, in_case) in case.by_id().into_iter().enumerate() {
        let slot = particles.slot[in_scene] as usize;
        rows[in_case] = [
            three(&particles.position[slot]),
            three(&particles.velocity[slot]),
            three(&particles.angular_velocity[slot]),
            three(&particles.force[slot]),
            three(&particles.torque[slot]),
        ];
    }
    let bonds = simulation.bonds().into_iter().filter(|bond| bond.second.is_some()).collect();
    let about_origin = |moved: &BoundaryState| {
        let ([x, y, z], [a, b, c], [u, v, w]) = (moved.pivot, moved.force, moved.moment);
        [moved.force, [u + y * c - z * b, v + z * a - x * c, w + x * b - y * a]]
    };
    let surfaces = simulation.state().boundaries.iter().map(about_origin).collect();
    let energy = if case.walls.is_empty() { 0.0 } else { energy(case, simulation) };
    Sample { step, rows, bonds, surfaces, energy, heat: heat::observe(case, simulation) }
}

/// Kinetic energy, that of contacts without their springs, and that in the field of gravity \[J\].
fn energy(case: &Case, simulation: &Simulation) -> f64 {
    let particles = &simulation.state().particles;
    let height = |place: &[f64; 4]| (0..3).map(|axis| case.gravity[axis] * place[axis]).sum::<f64>();
    let field = particles.position.iter().zip(&particles.velocity).map(|(place, motion)| motion[3] * height(place));
    simulation.kinetic_energy() + simulation.pressing_energy() - field.sum::<f64>()
}
