//! On servos that miss their targets.

use crate::base::geometry::lattice::STRAINS;
use crate::engine::simulation::Simulation;
use crate::scene::{AxisMotion, CellMotion, Scene};

/// Share of the target by which a servo misses it that is remarked.
const MISSED: f64 = 0.01;

/// On servos that press with another force than they are to, as a mean over the last interval.
pub(in crate::output::run) fn missed(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut missed = Vec::new();
    let largest = largest(simulation.state().boundaries.iter().flat_map(|moved| moved.mean_force));
    for (boundary, moved) in scene.boundaries.iter().zip(&simulation.state().boundaries) {
        for axis in (0..3).filter(|&axis| boundary.axes[axis].servo().is_some()) {
            let (found, target) = (moved.mean_force[axis], 0.5 * (moved.start[axis] + moved.end[axis]));
            if simulation.state().clock.steps > 0 && misses(found, target, largest) {
                let [name, axis] = [&boundary.name, AxisMotion::WORDS[axis]];
                missed.push(format!(
                    "[boundary.{name}] servo: the particles press with {found:.4e} N along {axis} in the last interval, to be {target:.4e} N"
                ));
            }
        }
    }
    missed.extend(missed_by_cell(scene, simulation));
    missed
}

/// The same of stresses of a periodic cell.
fn missed_by_cell(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let state = simulation.state();
    let (Some(cell), Some(moved)) = (&scene.cell, &state.cell) else { return Vec::new() };
    let served = (0..6).filter(|&component| matches!(cell.motion[component], CellMotion::Servo(_)));
    let largest = largest(moved.mean_stress);
    let told = served.filter_map(|component| {
        let found = cell.motion[component].served(component, &moved.mean_stress);
        let target = 0.5 * (moved.start[component] + moved.end[component]);
        let name = if cell.motion[component].serves_mean() { "the mean stress" } else { STRAINS[component] };
        (state.clock.steps > 0 && misses(found, target, largest))
            .then(|| format!("[cell] servo: {name} has {found:.4e} Pa in the last interval, to be {target:.4e} Pa"))
    });
    told.collect()
}

/// Whether a servo misses its target, of which a share is allowed; of one that is zero that share of the largest of its kind.
fn misses(found: f64, target: f64, largest: f64) -> bool {
    let scale = if target == 0.0 { largest } else { target.abs() };
    (found - target).abs() > MISSED * scale
}

/// The largest magnitude.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| most.max(value.abs()))
}
