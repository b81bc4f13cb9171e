//! `summary.json`: how a run went.

use super::meter::{Meter, intact_bonds};
use super::momentum::MomentumBalance;
use super::order::RunOrder;
use super::remarks::remarks;
use crate::base::words::{counted, plain};
use crate::engine::simulation::Simulation;
use crate::engine::state::ledger::Source;
use crate::engine::state::{Deepest, Loss, Named};
use crate::output::results::Failure;
use crate::scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// It reached its end.
    Completed,
    /// Someone asked to stop.
    Interrupted,
    /// It could not go on.
    Failed,
}

/// Numbers of things.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Counts {
    /// Particles, spheres of clumps among them.
    pub particles: usize,
    /// Clumps, where there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clumps: Option<usize>,
    /// Boundaries.
    pub boundaries: usize,
    /// Contacts at the end, those with planes included.
    pub contacts: usize,
    /// Contacts on average over the time steps of this session.
    pub mean_contacts: f64,
    /// Bonds that live.
    pub bonds_intact: usize,
    /// Bonds that broke since time 0.
    pub bonds_broken: u64,
    /// Times the neighbour lists were made since time 0.
    pub neighbour_rebuilds: u64,
}

/// Time steps \[s\].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeSteps {
    /// The present one \[s\].
    pub current: f64,
    /// A stable one, as last computed \[s\]: the largest unless the given step is far below it. None where nothing is stiff.
    pub stable: Option<f64>,
    /// What scheme and time step were chosen for.
    pub accuracy: String,
    /// How springs and dashpots of contacts went on in time.
    pub scheme: &'static str,
    /// Whether a given step above the stable one was let run.
    pub allow_unstable: bool,
}

/// The algorithmic energy book: work of each kind of force on the free particles since time 0 \[J\].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnergyBook {
    /// Kinetic energy when the book was opened \[J\].
    pub initial_kinetic: f64,
    /// Kinetic energy at the end \[J\].
    pub kinetic: f64,
    /// Elastic energy of contacts and bonds when the book was opened \[J\].
    pub initial_elastic: f64,
    /// Elastic energy at the end \[J\].
    pub elastic: f64,
    /// What contacts, bonds and global damping took and do not hold as elastic energy \[J\].
    pub dissipated: f64,
    /// Work of each kind of force \[J\].
    pub work: BTreeMap<&'static str, f64>,
    /// Change of kinetic energy less all work \[J\].
    pub residual: f64,
    /// That, over the sum of the magnitudes of all entries.
    pub relative_residual: f64,
}

/// The physical energy book: what each loss took since time 0 \[J\].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LossBook {
    /// By cause \[J\].
    pub lost: BTreeMap<&'static str, f64>,
    /// All of them \[J\].
    pub sum: f64,
    /// Energy that is there and was lost, less what was there and came from outside \[J\].
    pub residual: f64,
}

/// The contact that was deepest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeepestContact {
    /// When \[s\].
    pub time: f64,
    /// Its two bodies, in words.
    pub between: [String; 2],
}

impl DeepestContact {
    /// That of a simulation, if anything touched.
    pub(super) fn of(simulation: &Simulation) -> Option<Self> {
        let Deepest { overlap, time, particle, partner, boundary } = simulation.state().deepest;
        let number = |named: Named| named.number.unwrap_or_else(|| simulation.number(named.index));
        let other = match boundary {
            Some(boundary) => format!("[boundary.{}]", simulation.scene().boundaries[boundary as usize].name),
            None => format!("particle {}", number(partner.unwrap_or(particle))),
        };
        let between = [format!("particle {}", number(particle)), other];
        (overlap > 0.0).then_some(Self { time, between })
    }
}

/// How a run went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The program and its version.
    pub program: String,
    /// File name of the scene.
    pub scene: String,
    /// How it ended.
    pub ended: Ending,
    /// The reason, unless it reached its end.
    pub reason: Option<String>,
    /// Where this session began \[s\].
    pub start: f64,
    /// Time at the end \[s\].
    pub time: f64,
    /// Time steps since time 0.
    pub steps: u64,
    /// Time steps of this session.
    pub session_steps: u64,
    /// Time steps \[s\].
    pub time_step: TimeSteps,
    /// Threads.
    pub threads: usize,
    /// Numbers of things.
    pub counts: Counts,
    /// Largest overlap over the smaller radius of all time steps since time 0.
    pub largest_overlap: f64,
    /// Which contact had it, and when; none where nothing touched.
    pub deepest_contact: Option<DeepestContact>,
    /// Wall time of this session, output included \[s\].
    pub wall_time: f64,
    /// Wall time of its time steps alone \[s\].
    pub stepping_time: f64,
    /// Of the time steps, for each contact and step \[ns\]; none without contacts.
    pub ns_per_contact_and_step: Option<f64>,
    /// Of the time steps, for each bond that lives and step \[ns\]; none without bonds, or with contacts beside them.
    pub ns_per_bond_and_step: Option<f64>,
    /// Of the time steps, for each contact or bond and step \[ns\]; none without both.
    pub ns_per_interaction_and_step: Option<f64>,
    /// Of the time steps, for each particle and step \[ns\]; none without steps.
    pub ns_per_particle_and_step: Option<f64>,
    /// The algorithmic energy book, where the scene keeps one.
    pub energy: Option<EnergyBook>,
    /// The physical energy book, where the scene keeps one.
    pub losses: Option<LossBook>,
    /// The momentum balance of this session.
    pub momentum: MomentumBalance,
    /// What is legal but risky in the scene.
    pub remarks: Vec<String>,
    /// What could not be taken over from the checkpoint of another scene.
    pub left_behind: Vec<String>,
    /// Units of the columns of `history.csv` that have one.
    pub units: BTreeMap<String, &'static str>,
    /// Names of the sets, materials and boundaries that files of frames number, in the order of their numbers.
    pub names: BTreeMap<&'static str, Vec<String>>,
}

/// Names by the fields of frames that number them.
fn names(scene: &Scene) -> BTreeMap<&'static str, Vec<String>> {
    let materials = scene.materials.iter().map(|material| material.name.clone()).collect();
    let boundaries = scene.boundaries.iter().map(|boundary| boundary.name.clone()).collect();
    BTreeMap::from([("set", scene.sets.clone()), ("material", materials), ("boundary", boundaries)])
}

impl Summary {
    /// The summary at the present time.
    pub(crate) fn new(
        order: &RunOrder<'_>,
        simulation: &Simulation,
        meter: &Meter,
        start: f64,
        momentum: MomentumBalance,
        failure: Option<&Failure>,
    ) -> Self {
        let state = simulation.state();
        let session_steps = state.clock.steps - meter.steps_before;
        let particles = state.particles.slots().count();
        let nanoseconds = meter.stepping.as_secs_f64() * 1e9;
        let share = |count: f64| (count > 0.0).then(|| nanoseconds / count);
        Self {
            program: concat!("cograin ", env!("CARGO_PKG_VERSION")).to_owned(),
            scene: order.scene_name.to_owned(),
            ended: match failure {
                None => Ending::Completed,
                Some(Failure::Interrupted { .. }) => Ending::Interrupted,
                Some(_) => Ending::Failed,
            },
            reason: failure.map(ToString::to_string),
            start,
            time: state.clock.time,
            steps: state.clock.steps,
            session_steps,
            time_step: TimeSteps {
                current: state.clock.step,
                stable: Some(state.clock.stable).filter(|stable| stable.is_finite()),
                accuracy: order.scene.run.accuracy.to_string(),
                scheme: order.scene.run.scheme.name(),
                allow_unstable: order.scene.run.allow_unstable,
            },
            threads: simulation.threads(),
            counts: Counts {
                particles,
                clumps: Some(state.clumps.len()).filter(|count| *count > 0),
                boundaries: state.boundaries.len(),
                contacts: meter.contacts,
                mean_contacts: if session_steps > 0 { meter.contact_steps / session_steps as f64 } else { 0.0 },
                bonds_intact: intact_bonds(simulation),
                bonds_broken: state.bonds.iter().map(|list| list.broken).sum(),
                neighbour_rebuilds: state.clock.rebuilds,
            },
            largest_overlap: state.deepest.overlap,
            deepest_contact: DeepestContact::of(simulation),
            wall_time: meter.begun.elapsed().as_secs_f64(),
            stepping_time: meter.stepping.as_secs_f64(),
            ns_per_contact_and_step: share(meter.contact_steps),
            ns_per_bond_and_step: share(if meter.contact_steps > 0.0 { 0.0 } else { meter.bond_steps }),
            ns_per_interaction_and_step: share(if meter.contact_steps > 0.0 && meter.bond_steps > 0.0 {
                meter.contact_steps + meter.bond_steps
            } else {
                0.0
            }),
            ns_per_particle_and_step: share(session_steps as f64 * particles as f64),
            energy: energy_book(simulation),
            losses: loss_book(simulation),
            momentum,
            remarks: remarks(order.scene, simulation),
            left_behind: Vec::new(),
            units: BTreeMap::new(),
            names: names(order.scene),
        }
    }

    /// What of it is no finite number, if anything.
    pub(super) fn lacking(&self) -> Option<&'static str> {
        let book = self.energy.iter().flat_map(|book| {
            let EnergyBook {
                initial_kinetic,
                kinetic,
                initial_elastic,
                elastic,
                dissipated,
                work,
                residual,
                relative_residual,
            } = book;
            let numbers = [initial_kinetic, kinetic, initial_elastic, elastic, dissipated, residual, relative_residual];
            numbers.into_iter().chain(work.values())
        });
        let losses = self.losses.iter().flat_map(|book| book.lost.values().chain([&book.sum, &book.residual]));
        let finite = |number: &f64| number.is_finite();
        if !book.chain(losses).all(finite) {
            return Some("the energy books");
        }
        if !self.momentum.is_finite() {
            return Some("the momentum balance");
        }
        (![self.largest_overlap, self.time_step.current].iter().all(finite)).then_some("the summary")
    }

    /// Notes how the run ended.
    pub(super) fn end_with(&mut self, failure: &Failure) {
        self.ended = if matches!(failure, Failure::Interrupted { .. }) { Ending::Interrupted } else { Ending::Failed };
        self.reason = Some(failure.to_string());
    }

    /// The text of `summary.json`.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: writing them to memory has no way to fail.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

impl std::fmt::Display for Summary {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            formatter,
            "{} to t = {} s, {}, {:.0} contact{} on average, {:.3} s wall",
            counted(self.session_steps, "step"),
            plain(self.time),
            counted(self.counts.particles, "particle"),
            self.counts.mean_contacts,
            if self.counts.mean_contacts.round() == 1.0 { "" } else { "s" },
            self.wall_time
        )?;
        let costs = [
            (self.ns_per_interaction_and_step, "contact or bond"),
            (self.ns_per_contact_and_step, "contact"),
            (self.ns_per_bond_and_step, "bond"),
            (self.ns_per_particle_and_step, "particle"),
        ];
        // Where there are fewer contacts and bonds than particles, these are what costs.
        let most = self.ns_per_particle_and_step.unwrap_or(f64::INFINITY);
        let told = costs.into_iter().find_map(|(cost, of)| Some((cost.filter(|cost| *cost <= most)?, of)));
        if let Some((cost, of)) = told {
            write!(formatter, ", {cost:.1} ns per {of} and step")?;
        }
        write!(formatter, ", {}", counted(self.threads, "thread"))?;
        self.left_behind.iter().try_for_each(|left| write!(formatter, "\nnot taken along: {left}"))?;
        self.remarks.iter().try_for_each(|remark| write!(formatter, "\nremark: {remark}"))
    }
}

/// What the summary in a folder tells of the run that left it, in a few words.
pub(crate) fn told(path: &Path) -> String {
    let summary = fs::read(path).ok().and_then(|bytes| serde_json::from_slice::<serde_json::Value>(&bytes).ok());
    let Some(summary) = summary else { return "it did not come to its end".to_owned() };
    match (summary["scene"].as_str(), summary["ended"].as_str(), summary["time"].as_f64()) {
        (Some(scene), Some(ended), Some(time)) => format!("{scene}, {ended} at t = {} s", plain(time)),
        _ => "its summary.json cannot be read".to_owned(),
    }
}

/// The energy book at the present time, where the scene keeps one.
fn energy_book(simulation: &Simulation) -> Option<EnergyBook> {
    let ledger = simulation.state().ledger.as_ref()?;
    let kinetic = simulation.kinetic_energy();
    let residual = simulation.energy_residual_beside(kinetic)?;
    let exchanged = simulation.exchanged();
    let deforms = simulation.scene().cell.is_some();
    let sources = Source::ALL.into_iter().filter(|source| deforms || *source != Source::Cell);
    let scale = ledger.turnover.max(kinetic).max(ledger.initial_kinetic).max(exchanged.turnover);
    Some(EnergyBook {
        initial_kinetic: ledger.initial_kinetic,
        kinetic,
        initial_elastic: ledger.initial_elastic,
        elastic: simulation.elastic_energy(),
        dissipated: simulation.dissipated_energy().unwrap_or(0.0),
        work: sources.map(|source| (source.name(), ledger.work_of(source))).collect(),
        residual,
        relative_residual: if scale > 0.0 { residual / scale } else { 0.0 },
    })
}

/// What was lost up to the present time, where the scene asks for it.
fn loss_book(simulation: &Simulation) -> Option<LossBook> {
    let (losses, residual) = (simulation.losses()?, simulation.physical_residual()?);
    let lost = Loss::ALL.into_iter().zip(losses).map(|(loss, energy)| (loss.name(), energy)).collect();
    Some(LossBook { lost, sum: losses.iter().sum(), residual })
}
