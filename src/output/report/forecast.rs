//! What a run will write and how long it will take, before it runs.

use super::passing::{Files, ParticleExchange};
use super::trial::Trial;
use crate::engine::simulation::Simulation;
use crate::output::results::schedule::{Counted, Schedule};
use crate::scene::{Scene, Step};
use std::sync::Arc;

/// Part of the step of an impact that a packing may need: its particles have several contacts each.
const IN_A_PACKING: f64 = 0.5;

/// Bytes in a megabyte.
const MEGABYTE: f64 = 1e6;

/// The lines of the report on what a run writes, on its steps, and on its time.
pub(crate) struct Forecast {
    /// What is written, a line each.
    pub outputs: Vec<String>,
    /// How many steps.
    pub steps: String,
    /// How long it takes.
    pub time: String,
}

/// Numbers of time steps: as many where the step is given, a range where it is automatic.
struct Steps {
    /// At least.
    least: Counted,
    /// At most; with `least` where the step is given.
    most: Counted,
}

/// Foretells a run that begins at this time \[s\]. `present` is the simulation as it begins.
pub(crate) fn of(
    scene: &Arc<Scene>,
    present: &Simulation,
    (schedule, begins): (&Schedule, f64),
    trial: &Trial,
) -> Forecast {
    let end = schedule.end();
    let earlier = |all: u64, before: u64| all - before.saturating_sub(1);
    let rows = earlier(schedule.rows_until(end), schedule.rows_until(begins));
    let frames = schedule.frames_until(end).len() as u64;
    let frames = earlier(frames, schedule.frames_until(begins).len() as u64);
    let checkpoints = schedule.checkpoints(begins);
    let steps = steps(scene, present, (schedule, begins));
    let mut outputs = vec![format!("{rows} rows of history.csv, about {}", size(rows as f64 * trial.row.bytes))];
    if frames > 0 {
        let each = trial.sizes(Files::Frame, trial.frame.bytes);
        let all = each.map(|each| frames as f64 * each);
        let of = if trial.passing.is_some() { "of" } else { "of about" };
        outputs.push(format!("{frames} frames {of} {}, {} in all", range(each), range(all)));
    }
    let often = checkpoints.map_or("every 30 s of wall time".to_owned(), |count| format!("{count} times"));
    let checkpoint = trial.sizes(Files::Checkpoint, trial.checkpoint.bytes);
    outputs.push(format!("a checkpoint of {}, written {often}", range(checkpoint)));
    if let Some(ParticleExchange { counts: [least, most], .. }) = trial.passing {
        outputs.push(format!(
            "sizes without contacts to come, for {least:.0} to {most:.0} particles: all that come, none that go"
        ));
    }
    let writing = rows as f64 * trial.row.time
        + frames as f64 * trial.frame.time
        + checkpoints.unwrap_or(2) as f64 * trial.checkpoint.time;
    let Steps { least, most } = steps;
    // Each particle costs as much as in the second half of the trial.
    let full = trial.passing.map_or(trial.step, |passing| trial.step.max(passing.mean * trial.particle));
    let time = |steps: &Counted, step: f64| writing + steps.all as f64 * step;
    let given = matches!(scene.run.step, Step::Given(_));
    let shortened = |steps: &Counted| match steps.shortened {
        0 => "none of them shortened to meet an output".to_owned(),
        count => format!("{count} of them shortened to meet an output"),
    };
    Forecast {
        outputs,
        steps: if given {
            format!("{} up to t = {end} s, {}", least.all, shortened(&least))
        } else {
            format!("{} to {} up to t = {end} s, as the step is automatic", least.all, most.all)
        },
        time: if given && full == trial.step {
            duration(time(&least, trial.step))
        } else {
            format!("{} to {}", duration(time(&least, trial.step)), duration(time(&most, full)))
        },
    }
}

/// How many steps a run makes.
fn steps(scene: &Arc<Scene>, present: &Simulation, (schedule, begins): (&Schedule, f64)) -> Steps {
    let Step::Automatic { safety } = scene.run.step else {
        let counted = schedule.steps(begins, present.state().clock.step);
        return Steps { least: counted, most: counted };
    };
    let mut falling = present.state().clone();
    let speed = fall(scene, present);
    for velocity in &mut falling.particles.velocity {
        velocity[0] = speed;
    }
    let bound =
        Simulation::resume(Arc::clone(scene), falling).map_or_else(|_| present.stable_step(), |it| it.stable_step());
    let shortest = (IN_A_PACKING * safety * bound).min(present.state().clock.step);
    Steps { least: schedule.steps(begins, f64::INFINITY), most: schedule.steps(begins, shortest) }
}

/// The largest speed to be expected: of the fastest particle or boundary, with what a fall through all of the scene adds
/// \[m/s\].
fn fall(scene: &Scene, present: &Simulation) -> f64 {
    let norm = |v: &[f64]| v.iter().map(|part| part * part).sum::<f64>().sqrt();
    let particles = &present.state().particles;
    let fastest = particles.velocity.iter().map(|row| norm(&row[..3]));
    let boundaries = present.state().boundaries.iter().map(|boundary| norm(&boundary.velocity));
    let fastest = fastest.chain(boundaries).fold(0.0, f64::max);
    let places = || {
        let centres = particles.position.iter().map(|row| [row[0], row[1], row[2]]);
        centres.chain(scene.boundaries.iter().map(|boundary| boundary.reference))
    };
    let heights = || places().map(|place| place.iter().zip(&scene.gravity).map(|(x, g)| x * g).sum::<f64>());
    let (low, high) = heights().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let gained = if high > low { 2.0 * (high - low) } else { 0.0 };
    (fastest * fastest + gained).sqrt()
}

/// Two sizes in words, or one where they are the same.
fn range([least, most]: [f64; 2]) -> String {
    if least == most { size(least) } else { format!("{} to {}", size(least), size(most)) }
}

/// A size in words.
fn size(bytes: f64) -> String {
    match bytes {
        bytes if bytes >= 1e3 * MEGABYTE => format!("{:.2} GB", bytes / (1e3 * MEGABYTE)),
        bytes if bytes >= 0.1 * MEGABYTE => format!("{:.2} MB", bytes / MEGABYTE),
        bytes => format!("{:.1} kB", bytes / 1e3),
    }
}

/// A time in words.
fn duration(seconds: f64) -> String {
    match seconds {
        seconds if seconds >= 2.0 * 86400.0 => format!("{:.1} days", seconds / 86400.0),
        seconds if seconds >= 7200.0 => format!("{:.1} h", seconds / 3600.0),
        seconds if seconds >= 120.0 => format!("{:.1} min", seconds / 60.0),
        seconds if seconds >= 100.0 => format!("{seconds:.0} s"),
        seconds if seconds >= 10.0 => format!("{seconds:.1} s"),
        seconds if seconds >= 0.1 => format!("{seconds:.2} s"),
        seconds => format!("{seconds:.2e} s"),
    }
}
