//! A scene brought to rest, as a start for others.

use super::error::{Failure, Refusal};
use super::files::{Checkpoint, write_checkpoint};
use crate::scene::{AxisMotion, Boundary, Scene};
use crate::step::{Description, Simulation};
use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Time steps between two looks at the unbalanced force.
const STEPS_BETWEEN_LOOKS: u32 = 100;

/// Looks in a row that must find the packing at rest: one alone may meet a swing at its middle, where forces balance.
const LOOKS: usize = 10;

/// What is to be settled, and where to.
#[derive(Clone, Copy, Debug)]
pub struct SettleOrder<'a> {
    /// The scene.
    pub scene: &'a Arc<Scene>,
    /// Its file name, for messages.
    pub scene_name: &'a str,
    /// The checkpoint that it begins with, which may be another scene's; none: the scene as its file has it.
    pub from: Option<&'a Path>,
    /// The file that gets the state.
    pub checkpoint: &'a Path,
    /// Time steps after which the attempt is given up.
    pub most_steps: u64,
    /// Set from outside to stop.
    pub stop: &'a AtomicBool,
}

/// How far settling is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettleProgress {
    /// Time steps made.
    pub steps: u64,
    /// Unbalanced force over the mean force of the contacts or bonds, the largest of the last looks.
    pub ratio: f64,
    /// Below what it is done.
    pub tolerance: f64,
}

/// A packing at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Settled {
    /// Time steps made.
    pub steps: u64,
    /// Time they took in the scene \[s\].
    pub time: f64,
    /// Unbalanced force over the mean force of the contacts or bonds, the largest of the last looks.
    pub ratio: f64,
    /// Below what it is done.
    pub tolerance: f64,
    /// Contacts, those with planes included.
    pub contacts: usize,
    /// Kinetic energy that is left \[J\].
    pub kinetic_energy: f64,
    /// Wall time \[s\].
    pub wall_time: f64,
    /// What could not be taken along from the checkpoint of another scene.
    pub left_behind: Vec<String>,
}

/// Runs a scene with damping, its boundaries standing still but for free axes, until the unbalanced force is below the scene's
/// tolerance; then writes the state as one at time 0, contact histories kept, velocities as they are.
pub fn settle(order: SettleOrder<'_>, watch: &mut dyn FnMut(SettleProgress)) -> Result<Settled, Failure> {
    let begun = Instant::now();
    let refused = |source| Refusal::Start { scene: order.scene_name.to_owned(), source };
    let still = standing_still(order.scene);
    let (mut simulation, left_behind) = match order.from {
        None => (Simulation::new(Arc::clone(&still)).map_err(refused)?, Vec::new()),
        Some(path) => {
            let not = |error| Refusal::not_taken_over(order.scene_name, error);
            let taken = Checkpoint::read(path)?.taken_over(&still).map_err(not)?;
            (taken.simulation, taken.left_behind)
        }
    };
    let steps_before = simulation.state().clock.steps;
    simulation.damp_rest(order.scene.run.settle_damping);
    let ratio = come_to_rest(&mut simulation, &order, watch)?;
    let (steps, time) = (simulation.state().clock.steps - steps_before, simulation.time());
    let reached = simulation.state().clone();
    let simulation = match order.from {
        None => Simulation::settled(Arc::clone(order.scene), reached)?,
        Some(_) => {
            let from = Description::of(&still, order.scene_name, time);
            Simulation::taken_over(Arc::clone(order.scene), &reached, &from)?.0
        }
    };
    write_checkpoint(order.checkpoint, simulation.state(), order.scene, order.scene_name)?;
    Ok(Settled {
        steps,
        time,
        ratio,
        tolerance: order.scene.run.settle_tolerance,
        contacts: simulation.contact_count(),
        kinetic_energy: simulation.kinetic_energy(),
        wall_time: begun.elapsed().as_secs_f64(),
        left_behind,
    })
}

/// Steps until several looks in a row find the unbalanced force below the tolerance. Returns the largest of them.
fn come_to_rest(
    simulation: &mut Simulation,
    order: &SettleOrder<'_>,
    watch: &mut dyn FnMut(SettleProgress),
) -> Result<f64, Failure> {
    let tolerance = order.scene.run.settle_tolerance;
    let before = simulation.state().clock.steps;
    let mut looks = VecDeque::from(vec![f64::INFINITY; LOOKS]);
    loop {
        let clock = simulation.state().clock;
        let ratio = looks.iter().copied().fold(0.0, f64::max);
        let steps = clock.steps - before;
        watch(SettleProgress { steps, ratio, tolerance });
        if ratio < tolerance {
            return Ok(ratio);
        }
        let latest = looks.back().copied().unwrap_or(ratio);
        if order.stop.load(Ordering::Relaxed) {
            return Err(Failure::SettlingInterrupted { steps, ratio: latest });
        }
        if steps >= order.most_steps {
            return Err(Failure::Unsettled { steps, time: simulation.time(), ratio: latest, tolerance });
        }
        let left = order.most_steps - steps;
        let count = f64::from(u32::try_from(left).unwrap_or(u32::MAX).min(STEPS_BETWEEN_LOOKS));
        simulation.advance(count * clock.step)?;
        looks.pop_front();
        looks.push_back(unbalanced_force(simulation));
    }
}

/// Unbalanced force over the mean force of the contacts or bonds; 0 where nothing moves by the forces on it.
fn unbalanced_force(simulation: &Simulation) -> f64 {
    let held = simulation.state().particles.owner.iter().all(|owner| *owner != 0);
    let free = |boundary: &Boundary| boundary.axes.iter().any(AxisMotion::is_free);
    let nothing_moves = held && !simulation.scene().boundaries.iter().any(free);
    if nothing_moves { 0.0 } else { simulation.unbalanced_force() }
}

/// The scene with boundaries that stand still but for their free axes, and without books to keep.
fn standing_still(scene: &Scene) -> Arc<Scene> {
    let mut still = scene.clone();
    for boundary in &mut still.boundaries {
        for axis in boundary.axes.iter_mut().filter(|axis| !axis.is_free()) {
            *axis = AxisMotion::Fixed;
        }
    }
    still.output.energy = false;
    Arc::new(still)
}
