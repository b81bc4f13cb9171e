//! A user's scene over the time step: how far its outputs are from those of a fine step, what it costs, and which setting suffices.

use crate::picture::{Panel, Picture, logarithmic};
use crate::table::Table;
use crate::{ChartError, Drawing};
use cograin::interface::{Interface, Quantity};
use cograin::scene::{Models, Scene, SceneDraft, Setting, Step};
use cograin::simulation::Simulation;
use rayon::prelude::*;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Time steps, over the stable one where the step is automatic, over the given one where it is given; the last one is what the
/// others are held against.
const AUTOMATIC: [f64; 6] = [0.8, 0.4, 0.2, 0.1, 0.05, 0.025];

/// The same where the step is given.
const GIVEN: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125];

/// The fraction of the stable step that an automatic one takes about, to tell what a chart costs.
const USUAL: f64 = 0.4;

/// Rows of outputs that are compared, where the scene does not say how often it writes them.
const ROWS: f64 = 100.0;

/// Communication steps into which an interval is divided, to see what that changes.
const DIVISIONS: u32 = 4;

/// Wall time of the trial that tells what the chart costs \[s\].
const TRIAL: f64 = 0.5;

/// A user's scene that is to be charted.
pub struct SceneChart {
    /// The scene.
    scene: Arc<Scene>,
    /// Its end \[s\].
    end: f64,
    /// Time between compared outputs \[s\].
    interval: f64,
    /// Largest error that is wanted, over the largest value of each quantity.
    wanted: f64,
    /// Processor time of the chart, about \[s\].
    pub seconds: f64,
}

/// A step to be tried.
struct Choice {
    /// What it is called.
    name: String,
    /// The step.
    step: Step,
}

/// A run at one step.
struct Run {
    /// What its step is called.
    name: String,
    /// Time steps made.
    steps: u64,
    /// Wall time of its one thread, while other runs go on beside it \[s\].
    seconds: f64,
    /// Outputs, row by row.
    rows: Vec<Vec<f64>>,
}

impl SceneChart {
    /// Reads a scene, which may name these sub-models, and finds out what its chart costs.
    pub fn of(models: &Models, path: &Path, settings: &[Setting], wanted: f64) -> Result<Self, ChartError> {
        let (scene, _) = models.read(path, settings, &mut |_| {})?;
        // The runs are made side by side, a thread each.
        let scene = scene.with_threads(NonZeroUsize::new(1));
        let end = scene.run.end.ok_or(ChartError::NoEnd)?;
        let rows = (end / scene.output.history_interval.unwrap_or(end / ROWS)).ceil();
        let mut chart = Self { scene: Arc::new(scene), end, interval: end / rows, wanted, seconds: 0.0 };
        let mut simulation = Simulation::new(Arc::clone(&chart.scene))?;
        let (begun, step) = (Instant::now(), simulation.state().clock.step);
        let (mut made, mut each) = (0, f64::INFINITY);
        while begun.elapsed().as_secs_f64() < TRIAL && simulation.time() < end {
            simulation.advance((10.0 * step).min(end))?;
            made += 10;
            each = begun.elapsed().as_secs_f64() / f64::from(made);
        }
        // Times as many steps as the scene's own makes; what the automatic step makes of itself, about as many as a fifth.
        let times = |tried: Step| match (tried, chart.scene.run.step) {
            (Step::Automatic { safety }, Step::Automatic { safety: own }) => own / safety,
            (Step::Automatic { safety }, _) => USUAL / safety,
            (Step::Given(tried), Step::Given(own)) => own / tried,
            _ => 1.0,
        };
        let steps: f64 = chart.choices().into_iter().map(|choice| times(choice.step)).sum();
        chart.seconds = end / step * each * (steps + 2.0);
        Ok(chart)
    }

    /// The steps that are tried, the finest last.
    fn choices(&self) -> Vec<Choice> {
        let fraction = |safety: f64| Choice { name: format!("safety {safety}"), step: Step::Automatic { safety } };
        match self.scene.run.step {
            Step::Given(step) => GIVEN
                .map(|part| Choice { name: format!("given step times {part}"), step: Step::Given(part * step) })
                .into(),
            Step::Automatic { .. } | Step::Following => {
                let name = format!("accuracy {}", self.scene.run.accuracy);
                std::iter::once(Choice { name, step: Step::Following }).chain(AUTOMATIC.map(fraction)).collect()
            }
        }
    }

    /// Runs the scene at a step, each interval in so many communication steps.
    fn run(&self, choice: &Choice, communication_steps: u32) -> Result<Run, ChartError> {
        let mut draft = SceneDraft::clone(&self.scene);
        draft.run.step = choice.step;
        let mut simulation = Simulation::new(Arc::new(draft.build()?))?;
        let interface = Interface::of(&self.scene);
        let begun = Instant::now();
        let mut rows = Vec::new();
        for _ in 0..(self.end / self.interval).round() as u64 {
            for _ in 0..communication_steps {
                simulation.advance(self.interval / f64::from(communication_steps))?;
            }
            rows.push(interface.outputs().map(|(index, _)| interface.value(&simulation, index).number()).collect());
        }
        let (steps, seconds) = (simulation.state().clock.steps, begun.elapsed().as_secs_f64());
        Ok(Run { name: choice.name.clone(), steps, seconds, rows })
    }

    /// Computes the chart.
    pub fn draw(&self) -> Result<Drawing, ChartError> {
        let own = Choice { name: String::new(), step: self.scene.run.step };
        // The finest first: what is left at the end, for fewer threads than there are, is short.
        let choices = self.choices();
        let wanted: Vec<_> =
            choices.iter().rev().map(|choice| (choice, 1)).chain([(&own, 1), (&own, DIVISIONS)]).collect();
        let runs: Vec<_> = wanted.par_iter().with_max_len(1).map(|&(choice, count)| self.run(choice, count)).collect();
        let mut runs = runs.into_iter();
        let expected = runs.next().expect("the finest step is among them")?;
        let mut table = Table::new(COLUMNS);
        let mut notes = Vec::new();
        let mut coarser = Vec::new();
        for (choice, run) in choices.iter().rev().skip(1).zip(runs.by_ref()) {
            match run {
                Ok(run) => coarser.push(run),
                Err(error) => notes.push(format!("{}: {error}", choice.name)),
            }
        }
        coarser.sort_by_key(|run| run.steps);
        let mut enough = [None, None];
        for run in &coarser {
            let worst = self.compare(run, &expected, &mut table);
            notes.push(format!(
                "{}: {} time steps, {:.2e} s, error {:.1e} at any moment, {:.1e} in the mean",
                run.name, run.steps, run.seconds, worst[0], worst[1]
            ));
            for (enough, worst) in enough.iter_mut().zip(worst) {
                if enough.is_none() && worst <= self.wanted {
                    *enough = Some(&run.name);
                }
            }
        }
        if let (Some(Ok(whole)), Some(Ok(divided))) = (runs.next(), runs.next()) {
            notes.push(self.communication(&whole, &divided));
        }
        for (enough, when) in enough.into_iter().zip(["at any moment", "in the mean"]) {
            let wanted = self.wanted;
            notes.push(match enough {
                Some(name) => format!("recommended for an error of {wanted} {when}: {name}"),
                None => {
                    format!("an error of {wanted} {when} was not reached: a chaotic scene, or a finer step is needed")
                }
            });
        }
        let panel = |title: &str, column| Panel::new(title, logarithmic("time steps"), logarithmic(column), "quantity");
        let panels = vec![
            panel("outputs at any moment", "largest error over the largest value"),
            panel("means of outputs over time", "error of the mean over the largest value"),
        ];
        Ok(Drawing { table, picture: Picture { panels, ..Picture::default() }, notes })
    }

    /// What shorter communication steps change at the scene's own step: in a run alone they shorten time steps that do not fit.
    fn communication(&self, whole: &Run, divided: &Run) -> String {
        let [moment, mean] = self.compare(divided, whole, &mut Table::new(COLUMNS));
        format!("communication steps 1/{DIVISIONS} as long change {moment:.1e} at any moment, {mean:.1e} in the mean")
    }

    /// Adds how far a run is from the finest one, a row for each quantity. Returns the worst at any moment and in the mean.
    fn compare(&self, run: &Run, expected: &Run, table: &mut Table) -> [f64; 2] {
        let interface = Interface::of(&self.scene);
        let columns: Vec<(usize, Quantity)> =
            interface.outputs().map(|(_, variable)| variable.quantity).enumerate().collect();
        let mut kinds: Vec<Quantity> = columns.iter().map(|(_, quantity)| *quantity).collect();
        kinds.sort();
        kinds.dedup();
        let mut worst = [0.0_f64; 2];
        for kind in kinds.into_iter().filter(|kind| *kind != Quantity::Time) {
            let own = || columns.iter().filter(|(_, quantity)| *quantity == kind).map(|(place, _)| *place);
            let largest =
                own().flat_map(|place| expected.rows.iter().map(move |row| row[place].abs())).fold(0.0, f64::max);
            if largest == 0.0 {
                continue;
            }
            let (mut moment, mut mean) = (0.0_f64, 0.0_f64);
            for place in own() {
                let difference = |(a, b): (&Vec<f64>, &Vec<f64>)| a[place] - b[place];
                let all = || run.rows.iter().zip(&expected.rows).map(difference);
                moment = all().map(f64::abs).fold(moment, f64::max);
                mean = mean.max((all().sum::<f64>() / expected.rows.len() as f64).abs());
            }
            let errors = [moment / largest, mean / largest];
            worst = [worst[0].max(errors[0]), worst[1].max(errors[1])];
            let (steps, seconds) = (run.steps as f64, run.seconds);
            let [moment, mean] = errors;
            table.push([
                kind.name().into(),
                run.name.clone().into(),
                steps.into(),
                seconds.into(),
                moment.into(),
                mean.into(),
            ]);
        }
        worst
    }
}

/// Columns of the table.
const COLUMNS: [(&str, &str); 6] = [
    ("quantity", ""),
    ("step", ""),
    ("time steps", "1"),
    ("wall time", "s"),
    ("largest error over the largest value", "1"),
    ("error of the mean over the largest value", "1"),
];
