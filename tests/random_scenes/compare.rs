//! The default time step of a scene against a tenth of it.

use super::scenes::{Random, random};
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::step::Simulation;
use std::sync::Arc;

/// Length of a communication step \[s\].
const INTERVAL: f64 = 1e-4;

/// Communication steps of which means are compared.
const WINDOW: usize = 8;

/// Part of the stable step: the default, a tenth of it, and another to see what is chaotic.
const PARTS: [f64; 3] = [0.2, 0.02, 0.028];

/// What a user may expect, over the largest of its kind.
pub(crate) const ALLOWED: f64 = 0.02;

/// How well the two fine runs agree where a motion is not chaotic: over the largest of its kind, and over the difference of the
/// default from them. An error of the first order in the step would be 0.2 − 0.02 to 0.028 − 0.02, or 0.044.
const CHAOTIC: [f64; 2] = [0.003, 0.08];

/// What became of a scene.
pub(crate) enum Outcome {
    /// Both agree up to this time \[s\], with the largest difference.
    Agrees(f64, f64),
    /// They differ by this much at this time \[s\], in this quantity.
    Differs(f64, f64, &'static str),
    /// A run stopped, in these words.
    Stopped(String),
    /// The scene is refused.
    Refused(String),
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Agrees(until, apart) => write!(out, "agrees until {until:.1e} s, largest difference {apart:.1e}"),
            Self::Differs(apart, at, what) => write!(out, "differs by {apart:.3} at {at:.1e} s: {what}"),
            Self::Stopped(words) => write!(out, "stops: {words}"),
            Self::Refused(words) => write!(out, "is refused: {words}"),
        }
    }
}

/// What is compared, at one time: the quantity's name, its numbers and what they are measured by.
struct Course {
    /// Kinetic energy, elastic energy, momentum, impulses on the walls.
    numbers: Vec<[Vec<f64>; 4]>,
    /// Largest energy \[J\], largest sum of magnitudes of momentum \[N s\], all impulses of the walls \[N s\].
    scales: [f64; 3],
}

/// Names of the quantities.
const NAMES: [&str; 4] = ["kinetic energy", "elastic energy", "momentum", "impulse on a wall"];

/// Which scale each has.
const SCALES: [usize; 4] = [0, 0, 1, 2];

/// Runs a scene with this part of the stable step and these lines in `[run]`, for so many communication steps.
fn run(scene: &Random, part: f64, intervals: usize, lines: &str) -> Result<Course, Outcome> {
    let text = scene.text.replace("SAFETY", &format!("safety = {part}\n{lines}"));
    let source = Source { name: "scene.toml".into(), text, files: Default::default() };
    let checked = Scene::from_source(&source).map_err(|errors| Outcome::Refused(errors.to_string()))?;
    let mut simulation = Simulation::new(Arc::new(checked)).map_err(|error| Outcome::Stopped(error.to_string()))?;
    let mut course = Course { numbers: Vec::new(), scales: [0.0; 3] };
    let mut impulses = vec![0.0; 3 * simulation.state().boundaries.len()];
    let lid = simulation.scene().boundaries.iter().position(|boundary| boundary.name == "lid");
    for done in 1..=intervals {
        if let (Some(lid), Some(speed)) = (lid, scene.driven) {
            simulation.set_input(BoundaryIndex(lid as u32), 2, speed * done as f64 * INTERVAL);
        }
        simulation.advance(INTERVAL).map_err(|error| Outcome::Stopped(error.to_string()))?;
        let state = simulation.state();
        for (boundary, impulses) in state.boundaries.iter().zip(impulses.chunks_mut(3)) {
            for axis in 0..3 {
                impulses[axis] += INTERVAL * boundary.mean_force[axis];
                course.scales[2] += INTERVAL * boundary.mean_force[axis].abs();
            }
        }
        let (kinetic, elastic) = (simulation.kinetic_energy(), simulation.elastic_energy());
        let free = || state.particles.velocity.iter().zip(&state.particles.owner).filter(|(_, owner)| **owner == 0);
        let momentum = [0, 1, 2].map(|axis| free().map(|(v, _)| v[3] * v[axis]).sum());
        let magnitudes: f64 = free().map(|(v, _)| v[3] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()).sum();
        course.scales[0] = course.scales[0].max(kinetic + elastic);
        course.scales[1] = course.scales[1].max(magnitudes);
        course.numbers.push([vec![kinetic], vec![elastic], momentum.to_vec(), impulses.clone()]);
    }
    course.scales[2] = course.scales[2].max(course.scales[1]);
    Ok(course)
}

/// Means of each window, quantity by quantity.
fn means(course: &Course, window: usize) -> [Vec<f64>; 4] {
    let rows = &course.numbers[window * WINDOW..(window + 1) * WINDOW];
    std::array::from_fn(|quantity| {
        let count = rows[0][quantity].len();
        (0..count).map(|k| rows.iter().map(|row| row[quantity][k]).sum::<f64>() / WINDOW as f64).collect()
    })
}

/// The largest difference of two courses in a window, over what each quantity is measured by, and whose it is.
fn difference(course: &Course, other: &Course, window: usize) -> (f64, &'static str) {
    let (a, b) = (means(course, window), means(other, window));
    (0..4)
        .map(|quantity| {
            let scale = other.scales[SCALES[quantity]].max(f64::MIN_POSITIVE);
            let apart = a[quantity].iter().zip(&b[quantity]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            (apart / scale, NAMES[quantity])
        })
        .fold((0.0, NAMES[0]), |most, next| if next.0 > most.0 { next } else { most })
}

/// What becomes of the scene of a seed, with these lines in `[run]`, in so many communication steps.
pub(crate) fn judge(seed: u64, intervals: usize, lines: &str) -> (String, Outcome) {
    let scene = random(seed);
    let name = format!("seed {seed}: {}", scene.name);
    let courses: Result<Vec<Course>, Outcome> = PARTS.iter().map(|part| run(&scene, *part, intervals, lines)).collect();
    let courses = match courses {
        Ok(courses) => courses,
        Err(outcome) => return (name, outcome),
    };
    let [default, fine, other] = courses.as_slice() else { unreachable!("three parts") };
    let (mut largest, mut agreed) = (0.0_f64, 0.0);
    for window in 0..intervals / WINDOW {
        let (apart, what) = difference(default, fine, window);
        let unsure = difference(other, fine, window).0;
        // Here two converged runs part: a matter of the scene, not of the step.
        if unsure > CHAOTIC[0] || (apart > ALLOWED && unsure > CHAOTIC[1] * apart) {
            break;
        }
        agreed = (window + 1) as f64 * WINDOW as f64 * INTERVAL;
        if apart > ALLOWED {
            return (name, Outcome::Differs(apart, agreed, what));
        }
        largest = largest.max(apart);
    }
    (name, Outcome::Agrees(agreed, largest))
}
