//! What a run will write and how long it will take, before it runs.

use super::passing::{Files, ParticleExchange};
use super::trial::Trial;
use crate::base::words::{counted, duration};
use crate::engine::simulation::Simulation;
use crate::output::results::schedule::{Counted, Schedule};
use crate::scene::{Scene, Step};
use std::sync::Arc;

/// Part of the step of an impact that a packing may need: its particles have several contacts each. Models that fall and settle made 0.9 to
/// 1.1 times the steps that are expected without it.
const IN_A_PACKING: f64 = 0.5;

/// How much longer the step of what comes to rest may become than it is now.
const AT_REST: f64 = 1.5;

/// Contacts for each particle of a packing at rest.
const CONTACTS_IN_A_PACKING: f64 = 3.0;

/// What a contact costs on one thread in a time step of a machine of these years \[s\].
const CONTACT_COST: f64 = 3e-8;

/// Factor up to which a forecast is told as one number.
const CERTAIN: f64 = 1.1;

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
    /// Time steps: at least, expected, at most.
    pub counts: [u64; 3],
    /// Wall time likewise \[s\]; none where no step could be tried.
    pub times: Option<[f64; 3]>,
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
    let steps = steps(scene, present, (schedule, begins), trial);
    let mut outputs =
        vec![format!("{} of history.csv, about {}", counted(rows, "row"), size(rows as f64 * trial.row.bytes))];
    if frames > 0 {
        let each = trial.sizes(Files::Frame, trial.frame.bytes);
        let all = each.map(|each| frames as f64 * each);
        let of = if trial.passing.is_some() { "of" } else { "of about" };
        outputs.push(format!("{} {of} {}, {} in all", counted(frames, "frame"), range(each), range(all)));
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
    let counts = steps.map(|counted| counted.all);
    let costs = costs(scene, present, trial);
    let times = [0, 1, 2].map(|place| writing + counts[place] as f64 * costs[place]);
    let given = matches!(scene.run.step, Step::Given(_));
    let shortened = match steps[1].shortened {
        0 => "none of them shortened to meet an output".to_owned(),
        count => format!("{count} of them shortened to meet an output"),
    };
    let [from, about, to] = counts;
    Forecast {
        outputs,
        steps: match given {
            true => format!("{about} up to t = {end} s, {shortened}"),
            false => format!("about {about} up to t = {end} s, {from} to {to}, as the step is automatic"),
        },
        time: if trial.steps > 0 { time(times) } else { "unknown: no time step could be made".to_owned() },
        counts,
        times: (trial.steps > 0).then_some(times),
    }
}

/// A wall time with its uncertainty, in words \[s\].
fn time([least, expected, most]: [f64; 3]) -> String {
    let factor = (most / expected).max(expected / least);
    let expected = duration(expected);
    match factor {
        factor if factor > CERTAIN => {
            format!(
                "about {expected} for the run, within a factor of {factor:.1}: {} to {}",
                duration(least),
                duration(most)
            )
        }
        _ => format!("about {expected} for the run, as measured at its start"),
    }
}

/// How many steps a run makes: at least, expected, at most. The automatic step begins as it is now, and is at its shortest when
/// everything has fallen as far as it can, into a packing.
fn steps(scene: &Scene, present: &Simulation, (schedule, begins): (&Schedule, f64), trial: &Trial) -> [Counted; 3] {
    let now = present.state().clock.step;
    let Some(part) = present.part_of_stable() else {
        return [schedule.steps(begins, now); 3];
    };
    let [smallest, largest] = match scene.run.step {
        Step::Following => [present.part_of_impacts(), present.longest_part()],
        _ => [part; 2],
    };
    let bound = present.stable_step_at(fall(scene, present));
    let longest = AT_REST * now.max(trial.last_step) * largest / part;
    let fallen = ((smallest * largest).sqrt() * bound).min(longest);
    let shortest = (IN_A_PACKING * smallest * bound).min(fallen).min(now).min(trial.last_step);
    [longest, fallen.max(shortest), shortest].map(|step| schedule.steps(begins, step))
}

/// Wall time of a step at least, expected, and at most \[s\]: as measured, and with the contacts and particles that may come.
fn costs(scene: &Scene, present: &Simulation, trial: &Trial) -> [f64; 3] {
    // Each particle costs as much as in the second half of the trial.
    let full = trial.passing.map_or(trial.step, |passing| trial.step.max(passing.mean * trial.particle));
    let particles = scene.particles.iter().len() as f64;
    let falls = scene.gravity != [0.0; 3] && !scene.contacts.is_empty() && !scene.boundaries.is_empty();
    let missing =
        if falls { (CONTACTS_IN_A_PACKING * particles - present.contact_count() as f64).max(0.0) } else { 0.0 };
    let most = full + missing * CONTACT_COST / present.threads() as f64;
    [trial.step, (trial.step * most).sqrt(), most]
}

/// The largest speed to be expected: of the fastest particle or boundary, with what a fall through all of the scene adds
/// \[m/s\].
pub(crate) fn fall(scene: &Scene, present: &Simulation) -> f64 {
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
