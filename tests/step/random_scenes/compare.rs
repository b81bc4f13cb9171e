//! The default time step of a scene against a tenth of it: run against run as long as the motion is not chaotic, then means over
//! ensembles of runs that begin a little otherwise.

use super::scenes::{Random, random};
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, SceneErrors};
use cograin::simulation::Simulation;
use std::num::NonZero;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Length of a communication step \[s\].
const INTERVAL: f64 = 1e-4;

/// Communication steps of which means are compared.
const WINDOW: usize = 8;

/// The step to be judged: the default one, or a part of the stable step.
pub(crate) type Judged = Option<f64>;

/// Parts of the stable step that are fine, one to compare with and another to see what is chaotic.
const FINE: [f64; 2] = [0.02, 0.028];

/// Runs in an ensemble.
const MEMBERS: u64 = 16;

/// A difference of means counts where it is larger than so many of its standard errors.
const SURE: f64 = 4.0;

/// What a user may expect, over the largest of its kind.
pub(crate) const ALLOWED: f64 = 0.02;

/// How far apart two fine runs may be before their motion counts as chaotic, over the largest of its kind.
const CHAOTIC: f64 = 0.003;

/// What became of a scene.
pub(crate) enum Outcome {
    /// Both agree.
    Agrees(Agreement),
    /// They, or their means, differ by this much at this time \[s\], in this quantity.
    Differs(f64, f64, &'static str),
    /// A run stopped, in these words.
    Stopped(String),
    /// The scene is refused.
    Refused(String),
}

/// How a scene's runs agree.
#[derive(Clone, Copy, Default)]
pub(crate) struct Agreement {
    /// Up to this time run by run \[s\].
    pub(crate) until: f64,
    /// The largest difference there.
    pub(crate) apart: f64,
    /// The largest difference of means of ensembles after that, and its standard error.
    pub(crate) means: Option<[f64; 2]>,
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Agrees(Agreement { until, apart, means }) => {
                write!(out, "agrees run by run until {until:.1e} s, largest difference {apart:.1e}")?;
                means.map_or(Ok(()), |[apart, error]| {
                    write!(out, ", then in the mean, {apart:.1e} with error {error:.1e}")
                })
            }
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

/// Runs a scene with the default step or this part of the stable one, and these lines in `[run]`, for so many communication steps.
fn run(scene: &Random, part: Judged, intervals: usize, lines: &str) -> Result<Course, Outcome> {
    let safety = part.map_or(String::new(), |part| format!("safety = {part}"));
    let text = scene.text.replace("SAFETY", &format!("{safety}\n{lines}"));
    let checked: Scene = text.parse().map_err(|errors: SceneErrors| Outcome::Refused(errors.to_string()))?;
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

/// What becomes of the scene of a seed with the default step or this part of the stable one, and these lines in `[run]`, in so many communication steps.
pub(crate) fn judge(seed: u64, intervals: usize, part: Judged, lines: &str) -> (String, Outcome) {
    let scene = random(seed, 0);
    let name = format!("seed {seed}: {}", scene.name);
    let courses: Result<Vec<Course>, Outcome> =
        [part, Some(FINE[0]), Some(FINE[1])].into_iter().map(|part| run(&scene, part, intervals, lines)).collect();
    let courses = match courses {
        Ok(courses) => courses,
        Err(outcome) => return (name, outcome),
    };
    let [default, fine, other] = courses.as_slice() else { unreachable!("three parts") };
    let mut agreement = Agreement::default();
    for window in 0..intervals / WINDOW {
        let (apart, _) = difference(default, fine, window);
        let unsure = difference(other, fine, window).0;
        if apart > ALLOWED || unsure > CHAOTIC {
            return (name, judge_means(seed, window..intervals / WINDOW, (part, lines), agreement));
        }
        agreement.until = (window + 1) as f64 * WINDOW as f64 * INTERVAL;
        agreement.apart = agreement.apart.max(apart);
    }
    (name, Outcome::Agrees(agreement))
}

/// The same in these windows, by means over ensembles: two runs have parted there, as a motion is chaotic or as the step is too long.
/// A step that is too long changes the means.
fn judge_means(seed: u64, windows: Range<usize>, (part, lines): (Judged, &str), mut agreement: Agreement) -> Outcome {
    let ensembles = [part, Some(FINE[0])].map(|part| ensemble(seed, part, windows.end * WINDOW, lines));
    let [default, fine] = match ensembles {
        [Ok(default), Ok(fine)] => [default, fine],
        [Err(outcome), _] | [_, Err(outcome)] => return outcome,
    };
    for window in windows {
        let found = differences_of_means(&default, &fine, window);
        let most =
            |[apart, error]: [f64; 2], (next, _): &([f64; 2], _)| if next[0] > apart { *next } else { [apart, error] };
        agreement.means = Some(found.iter().fold(agreement.means.unwrap_or_default(), most));
        if let Some(&([apart, _], what)) = found.iter().find(|([apart, error], _)| *apart > ALLOWED + SURE * error) {
            return Outcome::Differs(apart, (window + 1) as f64 * WINDOW as f64 * INTERVAL, what);
        }
    }
    Outcome::Agrees(agreement)
}

/// Runs of a scene that begin a little otherwise, on all processors.
fn ensemble(seed: u64, part: Judged, intervals: usize, lines: &str) -> Result<Vec<Course>, Outcome> {
    let next = AtomicU64::new(1);
    let work = || {
        let mut courses = Vec::new();
        loop {
            let member = next.fetch_add(1, Ordering::Relaxed);
            if member > MEMBERS {
                return courses;
            }
            courses.push((member, run(&random(seed, member), part, intervals, lines)));
        }
    };
    let count = std::thread::available_parallelism().map_or(1, NonZero::get);
    let mut courses: Vec<(u64, Result<Course, Outcome>)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..count).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("a run does not panic")).collect()
    });
    courses.sort_by_key(|(member, _)| *member);
    courses.into_iter().map(|(_, course)| course).collect()
}

/// The differences of the means of two ensembles in a window and their standard errors, both over what each quantity is measured by, and
/// whose they are.
fn differences_of_means(some: &[Course], others: &[Course], window: usize) -> Vec<([f64; 2], &'static str)> {
    let numbers = |courses: &[Course]| courses.iter().map(|course| means(course, window)).collect::<Vec<_>>();
    let (a, b) = (numbers(some), numbers(others));
    let mut found = Vec::new();
    for quantity in 0..4 {
        let largest = others.iter().map(|course| course.scales[SCALES[quantity]]).fold(f64::MIN_POSITIVE, f64::max);
        for k in 0..a[0][quantity].len() {
            let of = |rows: &[[Vec<f64>; 4]]| {
                let count = rows.len() as f64;
                let mean = rows.iter().map(|row| row[quantity][k]).sum::<f64>() / count;
                let squares: f64 = rows.iter().map(|row| (row[quantity][k] - mean).powi(2)).sum();
                [mean, squares / (count - 1.0) / count]
            };
            let ([a, doubt_of_a], [b, doubt_of_b]) = (of(&a), of(&b));
            found.push(([(a - b).abs() / largest, (doubt_of_a + doubt_of_b).sqrt() / largest], NAMES[quantity]));
        }
    }
    found
}
