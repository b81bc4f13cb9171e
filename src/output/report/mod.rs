//! The report of `cograin check`: what a user should know of a scene before it runs.

mod economy;
mod forecast;
mod passing;
mod rules;
mod savings;
mod stiffness;
mod trial;
mod variables;

pub use stiffness::{StiffnessReport, stiffness};
pub use variables::{Variables, variables};

use crate::base::geometry::lattice::STRAINS;
use crate::base::words::counted;
use crate::engine::simulation::Simulation;
use crate::interface::Interface;
use crate::output::results::Refusal;
use crate::output::results::files::Checkpoint;
use crate::output::results::schedule::Schedule;
use crate::output::run::remarks::remarks;
use crate::scene::exchange::{Amount, Outside};
use crate::scene::{AxisMotion, Boundary, CellMotion, ContactLaw, Grid, Insertion, Kind, Scene, Step};
use rules::rules;
use serde::Serialize;
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use trial::{BETWEEN_LOOKS_AT_STEPS, Trial};

/// The numbers behind the lines, for programs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Particles at the start.
    pub particles: usize,
    /// Contacts at the start, those with boundaries included.
    pub contacts: usize,
    /// Threads.
    pub threads: usize,
    /// Time step at the start \[s\].
    pub time_step: f64,
    /// The stable one; none where nothing is stiff \[s\].
    pub stable_step: Option<f64>,
    /// Wall time of a time step, measured; none where none could be made \[s\].
    pub cost_of_step: Option<f64>,
    /// Time steps of the run: at least, expected, at most; none if the scene does not say when it ends.
    pub steps: Option<[u64; 3]>,
    /// Wall time of the run: at least, expected, at most \[s\].
    pub run_time: Option<[f64; 3]>,
}

/// What a user should know of a scene before it runs. Displays as text for a person.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The numbers behind the lines.
    pub figures: Figures,
    /// What the scene uses and pays for, a line each.
    pub uses: Vec<String>,
    /// The time step, the stable one and what limits it.
    pub time_step: String,
    /// Common rules of thumb for the time step, to compare with.
    pub rules: Option<String>,
    /// What a run writes, a line each; nothing if the scene does not say when it ends.
    pub outputs: Vec<String>,
    /// How many steps a run makes.
    pub steps: Option<String>,
    /// Size of the state and of the whole process.
    pub memory: String,
    /// Wall time of a step, measured.
    pub cost: String,
    /// Wall time of a run.
    pub time: Option<String>,
    /// What makes the run long, and what it would cost without, a line each.
    pub economy: Vec<String>,
    /// What the scene pays for and could do without, and what that saves, a line each.
    pub savings: Vec<String>,
    /// What is legal but risky.
    pub remarks: Vec<String>,
}

/// Starts a scene, makes a few steps, writes nothing, and reports what it found.
pub fn check(scene: &Arc<Scene>, scene_name: &str, from: Option<&Path>) -> Result<Report, Refusal> {
    let interface = Interface::of(scene);
    let chosen = interface.check_names(scene);
    chosen.map_err(|source| Refusal::Chosen { scene: scene_name.to_owned(), source: Box::new(source) })?;
    let schedule = scene.run.end.map(|end| Schedule::new(scene, scene_name, end)).transpose()?;
    let (mut simulation, left_behind) = begin(scene, scene_name, from)?;
    if let Some(schedule) = &schedule {
        schedule.check_step(scene_name, simulation.state().clock.step)?;
    }
    let begins = schedule.as_ref().map_or(0.0, |schedule| {
        let time = simulation.time();
        schedule.point_of(time).unwrap_or(time)
    });
    let mut remarks = remarks(scene, &simulation);
    remarks.extend(left_behind.into_iter().map(|left| format!("not taken along: {left}")));
    let uses = uses(scene, &simulation);
    let time_step = time_step(scene, &simulation);
    let rules = rules(scene, &simulation);
    let present = simulation.state().clone();
    let trial = trial::of(&mut simulation, &interface, schedule.as_ref().map(|schedule| (schedule, begins)));
    let trial = trial.map_err(|source| Refusal::Frame { scene: scene_name.to_owned(), source })?;
    let memory = memory(&trial);
    simulation.return_to(&present);
    let forecast = schedule.map(|schedule| forecast::of(scene, &simulation, (&schedule, begins), &trial));
    let cost = cost(&simulation, &trial);
    let economy = economy::of(scene, &simulation, forecast::fall(scene, &simulation));
    let savings = savings::of(scene, &simulation);
    remarks.extend(savings::foretold(scene, &simulation));
    if scene.changes_number() {
        let what = "the number of particles changes: memory and cost are as measured at the start; time is a range, from as many particles as in the trial to all that come and none that go";
        remarks.push(what.to_owned());
    }
    remarks.extend(trial.failed.map(|error| format!("it stops after {}: {error}", counted(trial.steps, "step"))));
    let stable = simulation.state().clock.stable;
    let mut figures = Figures {
        particles: scene.particles.len(),
        contacts: simulation.contact_count(),
        threads: simulation.threads(),
        time_step: simulation.state().clock.step,
        stable_step: Some(stable).filter(|stable| stable.is_finite()),
        cost_of_step: (trial.steps > 0).then_some(trial.step),
        steps: None,
        run_time: None,
    };
    let (mut outputs, mut steps, mut time) = (Vec::new(), None, None);
    if let Some(forecast) = forecast {
        (figures.steps, figures.run_time) = (Some(forecast.counts), forecast.times);
        (outputs, steps, time) = (forecast.outputs, Some(forecast.steps), Some(forecast.time));
    }
    Ok(Report { figures, uses, time_step, rules, outputs, steps, memory, cost, time, economy, savings, remarks })
}

impl Report {
    /// The report as JSON, lines and numbers.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: writing them to memory has no way to fail.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// The scene at its start, which may be that of a checkpoint, and what could not be taken over from it.
fn begin(scene: &Arc<Scene>, scene_name: &str, from: Option<&Path>) -> Result<(Simulation, Vec<String>), Refusal> {
    let Some(path) = from else {
        let start = |source| Refusal::Start { scene: scene_name.to_owned(), source };
        return Ok((Simulation::new(Arc::clone(scene)).map_err(start)?, Vec::new()));
    };
    let not = |error| Refusal::not_taken_over(scene_name, error);
    let taken = Checkpoint::read(path)?.taken_over(scene).map_err(not)?;
    Ok((taken.simulation, taken.left_behind))
}

impl fmt::Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for line in &self.uses {
            writeln!(formatter, "uses       {line}")?;
        }
        writeln!(formatter, "time step  {}", self.time_step)?;
        if let Some(rules) = &self.rules {
            writeln!(formatter, "rules      {rules}")?;
        }
        for line in &self.outputs {
            writeln!(formatter, "writes     {line}")?;
        }
        if let Some(steps) = &self.steps {
            writeln!(formatter, "steps      {steps}")?;
        }
        writeln!(formatter, "memory     {}", self.memory)?;
        write!(formatter, "cost       {}", self.cost)?;
        if let Some(time) = &self.time {
            write!(formatter, "\ntime       {time}")?;
        }
        for line in &self.economy {
            write!(formatter, "\neconomy    {line}")?;
        }
        for saving in &self.savings {
            write!(formatter, "\nunused     {saving}")?;
        }
        for remark in &self.remarks {
            write!(formatter, "\nremark     {remark}")?;
        }
        Ok(())
    }
}

/// What the scene uses and pays for.
fn uses(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let particles = counted(scene.particles.len(), "particle");
    let contacts = counted(simulation.contact_count(), "contact");
    let mut uses = vec![format!("{particles}, {contacts} at the start, {}", counted(simulation.threads(), "thread"))];
    uses.extend(scene.contacts.iter().map(contact_law));
    if scene.contacts.is_empty() {
        uses.push("no contact law: no neighbour search".to_owned());
    }
    uses.extend(
        scene
            .bonds
            .iter()
            .zip(&simulation.state().bonds)
            .map(|(bond, list)| format!("bond {}: {} at the start", bond.name, counted(list.first.len(), "bond"))),
    );
    uses.extend(scene.boundaries.iter().map(|it| boundary(scene, it)));
    if scene.gravity.iter().any(|part| *part != 0.0) {
        uses.push(format!("gravity {:?} m/s²", scene.gravity));
    }
    uses.extend(scene.damping.iter().map(|damping| {
        let damped = damping.linear.iter().zip(&damping.angular).filter(|(a, b)| **a != 0.0 || **b != 0.0).count();
        format!("damping {} of {}", damping.name, counted(damped, "particle"))
    }));
    uses.extend(
        scene
            .forces
            .iter()
            .map(|force| format!("force {} on {}", force.name, counted(force.members.len(), "particle"))),
    );
    uses.extend(scene.fluid.iter().map(|fluid| {
        let motion = if fluid.velocity.is_driven() { "driven" } else { "given" };
        let place = fluid.grid.map(|grid| format!(" in the cells of grid {}", scene.grids[grid].name));
        format!("fluid {}: drag {}, its velocity {motion}{}", fluid.name, fluid.drag.name(), place.unwrap_or_default())
    }));
    uses.extend(scene.regions.iter().map(|region| format!("region {}: computed when it is read", region.name)));
    uses.extend(scene.grids.iter().map(grid));
    uses.extend(exchange(scene));
    if scene.output.energy {
        uses.push("the algorithmic energy book".to_owned());
    }
    if scene.output.losses {
        uses.push("the physical energy book".to_owned());
    }
    if let Some(impacts) = scene.output.impacts {
        let each = if impacts.events { ", and each by itself" } else { "" };
        let bins = impacts.histogram.bins_per_decade;
        uses.push(format!("impacts from touch to parting, counted by energy, {bins} bins a decade{each}"));
    }
    uses
}

/// A contact law in one line.
fn contact_law(law: &ContactLaw) -> String {
    let parts = [
        ("normal", law.choice.normal.name()),
        ("tangential", law.choice.tangential.name()),
        ("rolling", law.choice.rolling.name()),
        ("cohesion", law.choice.cohesion.name()),
    ];
    let chosen: Vec<_> =
        parts.iter().filter(|(_, name)| *name != "none").map(|(kind, name)| format!("{kind} {name}")).collect();
    format!("contact {}: {}", law.name, chosen.join(", "))
}

/// What lets particles come and go, a line each.
fn exchange(scene: &Scene) -> Vec<String> {
    let mut uses: Vec<String> = scene.insertions.iter().map(insertion).collect();
    uses.extend(
        scene
            .outlets
            .iter()
            .map(|outlet| format!("outlet {}: looked at after each half of the smallest radius", outlet.name)),
    );
    uses.extend(scene.meters.iter().map(|meter| format!("flow meter {}: every particle in every step", meter.name)));
    for (index, shape) in (0..).zip(&scene.clump_shapes) {
        let count = scene.clumps.iter().filter(|clump| clump.shape == index).count();
        let error =
            if shape.error > 0.0 { format!(", inertia integrated to {:.0e}", shape.error) } else { String::new() };
        uses.push(format!("clump {}: {count} of {} spheres each{error}", shape.name, shape.spheres.len()));
    }
    if let Some(cell) = &scene.cell {
        let edges = ["x", "y", "z"].into_iter().zip(cell.lattice.periodic).filter(|(_, periodic)| *periodic);
        let edges: Vec<&str> = edges.map(|(name, _)| name).collect();
        let moves = STRAINS.into_iter().zip(cell.motion).filter_map(|(name, motion)| match motion {
            CellMotion::Fixed => None,
            CellMotion::Driven => Some(format!("{name} driven")),
            CellMotion::Prescribed(rate) => Some(format!("{name} at {rate} 1/s")),
            CellMotion::Servo(servo) => {
                let of = if motion.serves_mean() { " of the mean stress" } else { "" };
                Some(format!("{name} servo{of}, from {} Pa on", servo.stress))
            }
        });
        let moves: Vec<String> = moves.collect();
        let moves = if moves.is_empty() { "fixed".to_owned() } else { moves.join(", ") };
        uses.push(format!("cell: repeats along {}; {moves}", edges.join(", ")));
    }
    if scene.domain.is_some() && scene.outside == Outside::Remove {
        uses.push("domain: takes away what leaves it".to_owned());
    }
    let through = scene.boundaries.iter().filter(|boundary| boundary.outside == Outside::Remove);
    uses.extend(through.map(|boundary| format!("boundary {}: takes away what comes through it", boundary.name)));
    uses
}

/// An insertion in one line.
fn insertion(insertion: &Insertion) -> String {
    let kind = |kind: &Kind| {
        let [least, most] = kind.sizes.bounds();
        let radii = if least == most { format!("{least:?} m") } else { format!("{least:?} to {most:?} m") };
        let clump = kind.clump.as_ref().map(|clump| format!("clump {} of bounding ", clump.shape.name));
        format!("{}radius {radii}", clump.unwrap_or_default())
    };
    let kinds: Vec<String> = insertion.kinds.iter().map(kind).collect();
    let what = if insertion.has_clumps() { "clumps" } else { "particles" };
    let amount = match insertion.amount {
        Amount::MassRate(rate) => format!("{rate:?} kg/s"),
        Amount::CountRate(rate) => format!("{rate:?} {what} a second"),
        Amount::Mass(mass) => format!("{mass:?} kg"),
    };
    format!("insertion {}: {amount}, {}", insertion.name, kinds.join(", "))
}

/// A grid in one line.
fn grid(grid: &Grid) -> String {
    let [nx, ny, nz] = grid.shape.counts;
    let told: Vec<_> = grid.outputs.iter().map(|output| output.name()).collect();
    let told =
        if told.is_empty() { "without outputs".to_owned() } else { format!("{}: computed when read", told.join(", ")) };
    format!("grid {}: {nx} × {ny} × {nz} cells, {told}", grid.name)
}

/// A boundary in one line.
fn boundary(scene: &Scene, boundary: &Boundary) -> String {
    if let Some(leader) = boundary.moves_with {
        let leader = &scene.boundaries[leader.index()].name;
        return format!(
            "boundary {}: {}, moves with {leader}{}",
            boundary.name,
            boundary.shape.words(),
            worn(boundary)
        );
    }
    let axes: Vec<_> = (AxisMotion::WORDS.iter().zip(&boundary.axes).zip(0..))
        .filter_map(|((axis, motion), index)| {
            Some(format!("{axis} {}", motion.words(if index < 3 { "m/s" } else { "rad/s" })?))
        })
        .collect();
    let motion = match boundary.driven_nodes() {
        0 if axes.is_empty() => "fixed".to_owned(),
        0 => axes.join(", "),
        nodes => format!("its {nodes} nodes driven"),
    };
    format!("boundary {}: {}, {motion}{}", boundary.name, boundary.shape.words(), worn(boundary))
}

/// By what a boundary is worn.
fn worn(boundary: &Boundary) -> String {
    boundary.wear.iter().map(|model| format!(", worn by {}", model.name())).collect()
}

/// The time step, the stable one and what limits it.
fn time_step(scene: &Scene, simulation: &Simulation) -> String {
    let step = simulation.state().clock.step;
    let chosen = match scene.run.step {
        Step::Given(_) => "given".to_owned(),
        Step::Automatic { safety } => format!("automatic, safety {safety}"),
        Step::Following => "automatic".to_owned(),
    };
    let chosen = format!("{chosen}, accuracy {}, scheme {}", scene.run.accuracy, scene.run.scheme.name());
    let limit = simulation.limit();
    if !limit.safe.is_finite() {
        let most = if scene.run.step.is_automatic() { " at most" } else { "" };
        return format!("{step:.4e} s{most} ({chosen}); nothing is stiff, no bound");
    }
    let by = limit.by.map_or_else(String::new, |by| format!(", limited by {}", simulation.words(&by)));
    format!("{step:.4e} s ({chosen}), {:.3} of the stable one, {:.4e} s{by}", step / limit.safe, limit.safe)
}

/// Wall time of a step.
fn cost(simulation: &Simulation, trial: &Trial) -> String {
    if trial.steps == 0 {
        return "unknown".to_owned();
    }
    let (contacts, particles) = (simulation.contact_count(), simulation.state().particles.slots().count());
    // Where there are fewer contacts than particles, these are what costs.
    let [count, of] = if contacts >= particles { [contacts, 0] } else { [particles, 1] };
    let share = match count {
        0 => String::new(),
        count => format!(", {:.1} ns for each {}", trial.step * 1e9 / count as f64, ["contact", "particle"][of]),
    };
    let look = match trial.look {
        0.0 => String::new(),
        look => format!(", with a look for the stable one, {look:.2} s, in {BETWEEN_LOOKS_AT_STEPS}"),
    };
    format!(
        "{:.3e} s wall for each step{share} (measured over {}{look}; the trial took {:.2} s)",
        trial.step,
        counted(trial.steps, "step"),
        trial.cost
    )
}

/// Size of the state and of the whole process.
fn memory(trial: &Trial) -> String {
    /// Bytes in a mebibyte.
    const MEBIBYTE: f64 = 1_048_576.0;
    let state = trial.checkpoint.bytes / MEBIBYTE;
    let process = std::fs::read_to_string("/proc/self/status").ok().and_then(|status| {
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
        line.split_whitespace().next()?.parse::<f64>().ok()
    });
    match process {
        Some(kibibytes) => format!("{state:.2} MiB of state, {:.1} MiB at most in all", kibibytes / 1024.0),
        None => format!("{state:.2} MiB of state"),
    }
}
