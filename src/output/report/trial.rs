//! A short trial of a run: what a step, a row, a frame and a checkpoint cost on this machine.

use super::passing::{Files, ParticleExchange};
use crate::engine::simulation::{RunError, Simulation};
use crate::interface::Interface;
use crate::output::results::frames;
use crate::output::results::schedule::Schedule;
use crate::output::results::vtk::EncodeError;
use crate::output::run::jobs::{frame, row};
use std::time::{Duration, Instant};

/// Wall time of the trial, unless the first look and one more take longer.
const PATIENCE: Duration = Duration::from_millis(1000);

/// Wall time of an output that is long beside that of touching its memory \[s\].
const LONG: f64 = 0.1;

/// Wall time between two looks at the clock.
const BETWEEN_LOOKS: f64 = 0.02;

/// Time steps for which the looks of a trial count, at least: where the first ones follow each other, the next come much later.
pub(crate) const BETWEEN_LOOKS_AT_STEPS: f64 = 256.0;

/// Parts of a trial in each of which somebody looks, until it ends all the same.
const MOST_PARTS: u32 = 6;

/// Time steps of a communication step of a scene that says no end.
const WITHOUT_END: f64 = 1000.0;

/// What the outputs of a kind cost, one of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct OutputCost {
    /// Wall time \[s\].
    pub time: f64,
    /// Size \[bytes\].
    pub bytes: f64,
}

/// What was measured.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trial {
    /// Wall time of a time step \[s\].
    pub step: f64,
    /// The same for each particle, in the second half of the trial; 0 where there were none \[s\].
    pub particle: f64,
    /// Time steps made.
    pub steps: u64,
    /// Wall time of a look for the stable time step, where there were more of them than a run has; 0 otherwise \[s\].
    pub look: f64,
    /// The time step at its end \[s\].
    pub last_step: f64,
    /// Wall time of the whole trial \[s\].
    pub cost: f64,
    /// A row of the history.
    pub row: OutputCost,
    /// A frame.
    pub frame: OutputCost,
    /// A checkpoint.
    pub checkpoint: OutputCost,
    /// Particles that come and go.
    pub passing: Option<ParticleExchange>,
    /// Why it ended early.
    pub failed: Option<RunError>,
}

impl Trial {
    /// Least and largest size that files may come to have which have this size now \[bytes\].
    pub(crate) fn sizes(&self, files: Files, now: f64) -> [f64; 2] {
        self.passing.map_or([now; 2], |passing| passing.sizes(files, now))
    }
}

/// Makes real steps from where the simulation stands, divided as the schedule says from this time on \[s\], and one output of each kind.
pub(crate) fn of(
    simulation: &mut Simulation,
    interface: &Interface,
    schedule: Option<(&Schedule, f64)>,
) -> Result<Trial, EncodeError> {
    let begun = Instant::now();
    let mut trial = steps(simulation, schedule, PATIENCE);
    trial.row = price(|| Ok(row(interface, simulation, simulation.time()).text().len() as f64 + 1.0))?;
    if simulation.scene().output.frame_interval.is_some() {
        trial.frame = price(|| bytes_of_frame(simulation))?;
    }
    trial.checkpoint = price(|| Ok(simulation.state().to_bytes(0).len() as f64))?;
    if let Some((schedule, begins)) = schedule {
        trial.passing = ParticleExchange::of(simulation, schedule.end() - begins)?;
    }
    trial.cost = begun.elapsed().as_secs_f64();
    Ok(trial)
}

/// Time steps and their wall time.
#[derive(Clone, Copy, Default)]
struct Made {
    /// How many.
    steps: u64,
    /// Wall time \[s\].
    time: f64,
    /// How often the stable time step was looked for in them.
    looks: u64,
}

impl Trial {
    /// Takes the cost of a step from those in which nobody looked for the stable one and from the others.
    fn weigh(&mut self, [plain, looking]: [Made; 2]) {
        let steps = (plain.steps + looking.steps) as f64;
        if plain.steps == 0 {
            self.step = looking.time / steps.max(1.0);
            return;
        }
        let each = plain.time / plain.steps as f64;
        let looks = (looking.time - looking.steps as f64 * each).max(0.0);
        self.step = each + looks / steps.max(BETWEEN_LOOKS_AT_STEPS);
        if looking.looks > 0 && steps < BETWEEN_LOOKS_AT_STEPS {
            self.look = looks / looking.looks as f64;
        }
    }
}

/// Makes real steps for some wall time. The first look is not counted: memory is touched for the first time.
pub(crate) fn steps(simulation: &mut Simulation, schedule: Option<(&Schedule, f64)>, patience: Duration) -> Trial {
    let mut trial = Trial::default();
    let begun = Instant::now();
    let mut made_in = [Made::default(); 2];
    let (mut late_time, mut late_particles) = (0.0, 0.0);
    let mut time = schedule.map_or(0.0, |(_, begins)| begins);
    let (mut at_once, mut interval) = (1.0, 0.0);
    let mut parts = 0;
    while begun.elapsed() < patience || (made_in[0].steps == 0 && parts < MOST_PARTS) {
        // A communication step is as long as the run's: what its beginning costs counts as often as there.
        if simulation.state().underway.is_none() {
            interval = match schedule.map(|(schedule, _)| schedule.after(time)) {
                Some(None) => break,
                Some(Some(point)) => {
                    time = point.time;
                    point.interval
                }
                // Where nothing limits the step, any interval is a single one.
                None if !simulation.stable_step().is_finite() => simulation.scene().run.end.unwrap_or(1.0),
                None => WITHOUT_END * simulation.state().clock.step,
            };
        }
        let so_far = |it: &Simulation| (it.state().clock.steps, it.state().foresight.looks);
        let (looked, (before, looks)) = (Instant::now(), so_far(simulation));
        // An interval may have any number of time steps: the clock is looked at within it, too.
        match simulation.advance_part(interval, at_once as u64) {
            Ok(_) => {}
            Err(error) => {
                trial.failed = Some(error);
                break;
            }
        }
        let (steps, after) = so_far(simulation);
        let (made, looks, took) = (steps - before, after - looks, looked.elapsed().as_secs_f64());
        if trial.steps > 0 {
            parts += 1;
            let all = &mut made_in[usize::from(looks > 0)];
            *all = Made { steps: all.steps + made, time: all.time + took, looks: all.looks + looks };
        }
        trial.steps += made;
        if looked.duration_since(begun) >= patience / 2 {
            late_time += took;
            late_particles += made as f64 * simulation.state().particles.len() as f64;
        }
        let each = took / made.max(1) as f64;
        at_once = (BETWEEN_LOOKS / each.max(1e-9)).clamp(1.0, 1e6).floor();
    }
    trial.last_step = simulation.state().clock.step;
    trial.weigh(made_in);
    if trial.step == 0.0 && trial.steps > 0 {
        trial.step = begun.elapsed().as_secs_f64() / trial.steps as f64;
    }
    trial.particle = if late_particles > 0.0 { late_time / late_particles } else { 0.0 };
    trial
}

/// What one output costs: the least of three, since the first one finds its memory cold; of one where that takes long.
fn price(mut make: impl FnMut() -> Result<f64, EncodeError>) -> Result<OutputCost, EncodeError> {
    let mut price = OutputCost { time: f64::INFINITY, bytes: 0.0 };
    for _ in 0..3 {
        let begun = Instant::now();
        price.bytes = make()?;
        let took = begun.elapsed().as_secs_f64();
        price.time = price.time.min(took);
        if took > LONG {
            break;
        }
    }
    Ok(price)
}

/// Bytes of all files of a frame.
fn bytes_of_frame(simulation: &Simulation) -> Result<f64, EncodeError> {
    let mut files = frames::files(simulation.scene(), frame(simulation, 0.0));
    files.try_fold(0.0, |sum, file| Ok(sum + file?.len() as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, Source};
    use std::collections::BTreeMap;
    use std::sync::Arc;

    #[test]
    fn the_first_look_alone_is_no_measure_however_long_it_takes() {
        let text = "[run]\nstep = 1e-5\nthreads = 1\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
                    list = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }]\n";
        let source = Source { name: "scene.toml".into(), text: text.into(), files: BTreeMap::new() };
        let mut simulation = Simulation::new(Arc::new(Scene::from_source(&source).unwrap())).unwrap();
        assert!(steps(&mut simulation, None, Duration::ZERO).steps > 1);
    }

    #[test]
    fn looks_of_a_short_trial_count_for_as_many_steps_as_a_run_has_between_them() {
        let mut trial = Trial::default();
        trial.weigh([Made { steps: 8, time: 0.8, looks: 0 }, Made { steps: 2, time: 2.76, looks: 2 }]);
        // A step takes 0.1 s, two looks 2.56 s: a hundredth of a second in each of 256 steps.
        assert!((trial.step - 0.11).abs() < 1e-12, "{} s", trial.step);
        assert!((trial.look - 1.28).abs() < 1e-12, "{} s", trial.look);
    }

    #[test]
    fn a_long_trial_counts_its_looks_as_they_came() {
        let mut trial = Trial::default();
        trial.weigh([Made { steps: 500, time: 5.0, looks: 0 }, Made { steps: 12, time: 2.68, looks: 3 }]);
        assert!((trial.step - 7.68 / 512.0).abs() < 1e-12, "{} s", trial.step);
        assert_eq!(trial.look, 0.0);
    }

    #[test]
    fn a_trial_makes_the_communication_steps_of_the_run() {
        let text = "[run]\nstep = 1e-9\nend = 1.0\nthreads = 1\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
                    list = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }]\n";
        let source = Source { name: "scene.toml".into(), text: text.into(), files: BTreeMap::new() };
        let scene = Arc::new(Scene::from_source(&source).unwrap());
        let schedule = Schedule::new(&scene, "scene.toml", 1.0).unwrap();
        let mut simulation = Simulation::new(scene).unwrap();
        steps(&mut simulation, Some((&schedule, 0.0)), Duration::from_millis(20));
        // The first one has 1e7 time steps.
        assert!(simulation.state().underway.is_some());
    }

    #[test]
    fn an_interval_of_any_number_of_time_steps_takes_no_longer_than_the_patience() {
        let text = "[run]\nstep = 1e-9\nend = 1.0\nthreads = 1\n[material.a]\ndensity = 2500.0\n[particles.p]\nmaterial = \"a\"\n\
                    list = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }]\n";
        let source = Source { name: "scene.toml".into(), text: text.into(), files: BTreeMap::new() };
        let mut simulation = Simulation::new(Arc::new(Scene::from_source(&source).unwrap())).unwrap();
        let trial = steps(&mut simulation, None, Duration::from_millis(20));
        assert!(trial.steps > 1 && trial.steps < 100_000_000, "{} time steps", trial.steps);
    }
}
