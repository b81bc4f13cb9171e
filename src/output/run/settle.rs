//! A scene brought to rest, as a start for others.

use super::meter::Pace;
use super::remarks::missed;
use crate::base::words::{counted, plain};
use crate::engine::simulation::{ContactRecord, Description, Simulation};
use crate::engine::statics::{Factorise, Motionless, come_to_rest};
use crate::laws::contact::{Properties, property};
use crate::output::results::files::{Checkpoint, EarlierFile, claim_unsettled, is_same, write_checkpoint};
use crate::output::results::{Failure, OutputError, Refusal};
use crate::scene::{AxisMotion, Boundary, CellMotion, ContactLaw, Scene, SceneDraft};
use std::collections::VecDeque;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Time steps between two looks at the unbalanced force.
const STEPS_BETWEEN_LOOKS: u32 = 100;

/// Looks in a row that must find the packing at rest: one alone may meet a swing at its middle, where forces balance.
const LOOKS: usize = 10;

/// Looks after which the smallest ratio is compared with that of the time before.
const LOOKS_TO_COMPARE: u32 = 400;

/// Part of the smallest ratio before that counts as nearer to rest.
const NEARER: f64 = 0.8;

/// Looks beyond which nobody would wait.
const MOST_TO_TELL: f64 = 1e6;

/// Cundall damping of grains: more of it slows them down on their way, less lets them swing.
const DAMPING: f64 = 0.2;

/// Cundall damping of scenes with bonds, which swing and do not travel.
const DAMPING_OF_BONDS: f64 = 0.7;

/// Where settling begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettleStart<'a> {
    /// With the scene as its file has it.
    Scene,
    /// With this checkpoint, which may be another scene's.
    From(&'a Path),
    /// With what an earlier attempt left beside the file of the settled state.
    Unsettled,
}

/// What is to be settled, and where to.
#[derive(Clone, Copy, Debug)]
pub struct SettleOrder<'a> {
    /// The scene.
    pub scene: &'a Arc<Scene>,
    /// Its file name, for messages.
    pub scene_name: &'a str,
    /// Where it begins.
    pub start: SettleStart<'a>,
    /// The file that gets the state.
    pub checkpoint: &'a Path,
    /// What happens to the state that an earlier attempt left beside it, where this one comes to no rest either.
    pub earlier: EarlierFile,
    /// Time steps after which the attempt is given up.
    pub most_steps: u64,
    /// What finds the factors for Newton's method; without it time steps are made.
    pub factorise: Option<Factorise>,
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
    /// The ratio below which settling is done.
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
    /// Whether it is the mean force of many steps, since bodies tremble about rest.
    pub trembles: bool,
    /// The ratio below which settling is done.
    pub tolerance: f64,
    /// Contacts, those with planes included.
    pub contacts: usize,
    /// Kinetic energy that is left \[J\].
    pub kinetic_energy: f64,
    /// Wall time \[s\].
    pub wall_time: f64,
    /// Iterations of Newton's method, where it was tried; why it led nowhere, so that time steps were made.
    pub newton: Option<Result<usize, Motionless>>,
    /// What could not be taken over from the checkpoint of another scene.
    pub left_behind: Vec<String>,
}

impl std::fmt::Display for Settled {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let way = match &self.newton {
            Some(Ok(iterations)) => format!("{} of Newton's method (", counted(*iterations as u64, "iteration")),
            _ => format!("{} (t = {} s, ", counted(self.steps, "step"), plain(self.time)),
        };
        write!(
            formatter,
            "settled after {way}{:.3} s wall): unbalanced force{} {:.3e} of the mean {} force, {}, kinetic energy {:.3e} J",
            self.wall_time,
            if self.trembles { ", in the mean of many steps," } else { "" },
            self.ratio,
            if self.contacts > 0 { "contact" } else { "bond" },
            counted(self.contacts, "contact"),
            self.kinetic_energy
        )?;
        // That particles touch is nothing to wonder about.
        if let Some(Err(why)) = self.newton.as_ref().filter(|newton| **newton != Err(Motionless::Touching)) {
            write!(formatter, "\nremark     by time steps, not by Newton's method: {why}")?;
        }
        self.left_behind.iter().try_for_each(|left| write!(formatter, "\nnot taken along: {left}"))
    }
}

/// Brings a scene to rest, its boundaries standing still but for free axes, until the unbalanced force is below the scene's
/// tolerance: bonded networks by Newton's method where it leads there, others by time steps with damping. Then writes the state as one at time 0, contact histories kept, velocities as they are.
pub fn settle(order: SettleOrder<'_>, watch: &mut dyn FnMut(SettleProgress)) -> Result<Settled, Failure> {
    let begun = Instant::now();
    let refused = |source| Refusal::Start { scene: order.scene_name.to_owned(), source };
    let still = standing_still(order.scene);
    let unsettled = kept(order.checkpoint);
    let from = match order.start {
        SettleStart::Scene => None,
        SettleStart::From(path) => Some(path),
        SettleStart::Unsettled => Some(unsettled.as_path()),
    };
    let goes_on = from.is_some_and(|from| is_same(from, &unsettled));
    claim_unsettled(&unsettled, if goes_on { EarlierFile::Replace } else { order.earlier })?;
    let (mut simulation, left_behind) = match from {
        None => (Simulation::new(Arc::clone(&still)).map_err(refused)?, Vec::new()),
        Some(path) => {
            let not = |error| Refusal::not_taken_over(order.scene_name, error);
            let checkpoint = Checkpoint::read(path)?;
            if order.start == SettleStart::Unsettled {
                checkpoint.expect_course_of(order.scene)?;
            }
            let taken = checkpoint.taken_over(&still).map_err(not)?;
            (taken.simulation, taken.left_behind)
        }
    };
    let steps_before = simulation.state().clock.steps;
    let moves = simulation.state().particles.owner.contains(&0);
    let bonded = !order.scene.bonds.is_empty() && moves && !simulation.is_filling();
    let newton = order.factorise.filter(|_| bonded).map(|factorise| {
        let tolerance = order.scene.run.settle_tolerance;
        let watch = &mut |ratio| {
            watch(SettleProgress { steps: 0, ratio, tolerance });
            !order.stop.load(Ordering::Relaxed)
        };
        come_to_rest(&mut simulation, tolerance, factorise, watch)
    });
    let suits = if order.scene.bonds.is_empty() { DAMPING } else { DAMPING_OF_BONDS };
    simulation.hold_temperatures();
    simulation.damp_rest(order.scene.run.settle_damping.unwrap_or(suits));
    let come = match newton {
        Some(Ok(_)) => Ok(unbalanced_force(&mut simulation)),
        _ => settle_down(&mut simulation, &order, watch),
    };
    if let Err(Failure::Run(error)) = come {
        return Err(error.into());
    }
    let (steps, time) = (simulation.state().clock.steps - steps_before, simulation.time());
    let reached = simulation.state().clone();
    let simulation = match order.start {
        SettleStart::Scene | SettleStart::Unsettled => Simulation::settled(Arc::clone(order.scene), reached)?,
        SettleStart::From(_) => {
            let from = Description::of(&still, order.scene_name, time);
            Simulation::taken_over(Arc::clone(order.scene), &reached, &from)?.0
        }
    };
    let ratio = match come {
        Ok(ratio) => ratio,
        Err(failure) => {
            write_checkpoint(&unsettled, simulation.state(), order.scene, order.scene_name)?;
            return Err(failure);
        }
    };
    write_checkpoint(order.checkpoint, simulation.state(), order.scene, order.scene_name)?;
    if order.start == SettleStart::Unsettled {
        fs::remove_file(&unsettled).map_err(OutputError::at(&unsettled))?;
    }
    Ok(Settled {
        steps,
        time,
        ratio,
        trembles: trembles(order.scene).is_some(),
        tolerance: order.scene.run.settle_tolerance,
        contacts: simulation.contact_count(),
        kinetic_energy: simulation.kinetic_energy(),
        wall_time: begun.elapsed().as_secs_f64(),
        newton,
        left_behind,
    })
}

/// Where the state of a packing goes that has not come to rest: nobody is to take it for one that has.
fn kept(checkpoint: &Path) -> PathBuf {
    let mut name = checkpoint.file_name().map_or_else(OsString::new, OsString::from);
    name.push(".unsettled");
    checkpoint.with_file_name(name)
}

/// Steps until several looks in a row find the unbalanced force below the tolerance. Returns the largest of them.
fn settle_down(
    simulation: &mut Simulation,
    order: &SettleOrder<'_>,
    watch: &mut dyn FnMut(SettleProgress),
) -> Result<f64, Failure> {
    let tolerance = order.scene.run.settle_tolerance;
    let before = simulation.state().clock.steps;
    let mut looks = VecDeque::from(vec![f64::INFINITY; LOOKS]);
    let (mut course, mut pace) = (Course::default(), Pace::default());
    let mut measure = Measure::of(simulation);
    loop {
        let clock = simulation.state().clock;
        let ratio = looks.iter().copied().fold(0.0, f64::max);
        let steps = clock.steps - before;
        watch(SettleProgress { steps, ratio, tolerance });
        let balanced = ratio < tolerance;
        let served = if balanced { missed(simulation.scene(), simulation) } else { Vec::new() };
        if balanced && served.is_empty() {
            return Ok(ratio);
        }
        let latest = looks.back().copied().unwrap_or(ratio);
        if steps >= order.most_steps {
            return Err(Failure::Unsettled {
                kept: kept(order.checkpoint),
                steps,
                time: simulation.time(),
                ratio: latest,
                tolerance,
                why: match served.first() {
                    Some(missed) => missed.clone(),
                    None => format!("{}{}", course.left_to_go(latest, tolerance), why_not(simulation)),
                },
            });
        }
        // What a servo still presses on is at rest and does not stay so.
        if let Some(best) = course.stalled(ratio, simulation).filter(|_| !balanced) {
            let why = why_not(simulation);
            return Err(Failure::Restless {
                kept: kept(order.checkpoint),
                steps,
                time: simulation.time(),
                ratio: best,
                tolerance,
                why,
            });
        }
        let left = order.most_steps - steps;
        let count = f64::from(u32::try_from(left).unwrap_or(u32::MAX).min(STEPS_BETWEEN_LOOKS));
        // The step may become shorter on the way: the steps are counted, not the time.
        let mut left = left;
        while left > 0 && !pace.part_of(simulation, count * clock.step, left)? && !order.stop.load(Ordering::Relaxed) {
            let steps = simulation.state().clock.steps - before;
            left = order.most_steps.saturating_sub(steps);
            watch(SettleProgress { steps, ratio, tolerance });
        }
        if order.stop.load(Ordering::Relaxed) {
            let steps = simulation.state().clock.steps - before;
            return Err(Failure::SettlingInterrupted { kept: kept(order.checkpoint), steps, ratio: latest });
        }
        looks.pop_front();
        let ratio = measure.ratio(simulation);
        course.ratios.push(ratio);
        looks.push_back(if simulation.is_filling() { f64::INFINITY } else { ratio });
    }
}

/// How the unbalanced force is measured.
enum Measure {
    /// As it is at the moment.
    Moment,
    /// As the mean of the steps since the last look, by what it did to velocities: where bodies tremble about rest.
    Mean {
        /// Velocities at the last look \[m/s\].
        before: Vec<[f64; 3]>,
        /// When that was \[s\].
        time: f64,
    },
}

impl Measure {
    /// What this scene needs.
    fn of(simulation: &Simulation) -> Self {
        match trembles(simulation.scene()) {
            None => Self::Moment,
            Some(_) => Self::Mean { before: velocities(simulation), time: simulation.time() },
        }
    }

    /// Unbalanced force over the mean force of the contacts or bonds, damping apart; 0 where nothing moves by the forces on it.
    fn ratio(&mut self, simulation: &mut Simulation) -> f64 {
        let Self::Mean { before, time } = self else { return unbalanced_force(simulation) };
        let (now, elapsed) = (velocities(simulation), simulation.time() - *time);
        let state = simulation.state();
        let (mut sum, mut count) = (0.0, 0_usize);
        for ((grain, now), before) in state.grains().zip(&now).zip(&*before) {
            if state.is_loose(state.particles.slot[grain.index as usize] as usize) {
                let change = [0, 1, 2].map(|axis| now[axis] - before[axis]);
                sum += grain.velocity[3] * change.iter().map(|part| part * part).sum::<f64>().sqrt();
                count += 1;
            }
        }
        let same = now.len() == before.len();
        (*before, *time) = (now, simulation.time());
        match simulation.mean_interaction() {
            Some(mean) if count > 0 && same => sum / count as f64 / elapsed / mean,
            _ => unbalanced_force(simulation),
        }
    }
}

/// Velocities of all grains \[m/s\].
fn velocities(simulation: &Simulation) -> Vec<[f64; 3]> {
    simulation.state().grains().map(|grain| [0, 1, 2].map(|axis| grain.velocity[axis])).collect()
}

/// The law whose rolling friction makes bodies tremble about rest for ever: its torque changes its sign from step to step.
fn trembles(scene: &Scene) -> Option<&ContactLaw> {
    let rubs = |pair: &Properties| pair.get(&property::ROLLING_FRICTION).is_some_and(|friction| friction > 0.0);
    let rolls = |law: &&ContactLaw| law.choice.rolling.name() == "cdt";
    scene.contacts.iter().find(rolls).filter(|_| scene.pairs.iter().any(rubs))
}

/// How settling has gone so far: whether it comes nearer to rest.
struct Course {
    /// What each look found.
    ratios: Vec<f64>,
    /// Looks since the last comparison.
    looks: u32,
    /// When that was \[s\].
    since: f64,
    /// The smallest ratio since then, and that of the time before.
    best: [f64; 2],
    /// Comparisons in a row in which it came no nearer.
    idle: u32,
}

impl Default for Course {
    fn default() -> Self {
        Self { ratios: Vec::new(), looks: 0, since: 0.0, best: [f64::INFINITY; 2], idle: 0 }
    }
}

impl Course {
    /// The smallest ratio so far, if the scene comes no nearer to rest: twice in a row, or ten times where particles are
    /// still on their way.
    fn stalled(&mut self, ratio: f64, simulation: &Simulation) -> Option<f64> {
        self.looks += 1;
        self.best[0] = self.best[0].min(ratio);
        if self.looks < LOOKS_TO_COMPARE {
            return None;
        }
        let [now, before] = self.best;
        let nearer = now < NEARER * before;
        let elapsed = simulation.time() - self.since;
        let on_their_way = simulation.fastest().is_some_and(|(_, speed, radius)| speed * elapsed > radius);
        (self.looks, self.since) = (0, simulation.time());
        (self.best, self.idle) = ([f64::INFINITY, now.min(before)], self.idle + 1);
        if nearer || !now.is_finite() && on_their_way {
            self.idle = 0;
        }
        (self.idle >= if on_their_way { 10 } else { 2 }).then_some(now.min(before))
    }

    /// How many steps are left at the pace of the later half of the way; nothing where the ratio has not fallen.
    fn left_to_go(&self, ratio: f64, tolerance: f64) -> String {
        let half = &self.ratios[self.ratios.len() / 2..];
        let fallen = half.iter().find(|begun| begun.is_finite()).map_or(0.0, |begun| libm::log(begun / ratio));
        let left = half.len() as f64 * libm::log(ratio / tolerance) / fallen;
        if fallen > 0.0 && left.is_finite() && left < MOST_TO_TELL {
            format!("about {:.0e} steps are left at the pace of late; ", left * f64::from(STEPS_BETWEEN_LOOKS))
        } else {
            String::new()
        }
    }
}

/// Why a scene is not at rest.
fn why_not(simulation: &Simulation) -> String {
    let scene = simulation.scene();
    if let Some(law) = trembles(scene) {
        return format!(
            "[contact.{}.rolling.cdt] has a torque of constant size that changes its sign from step to step about rest: bodies \
             tremble for ever; settle without it, or with a larger settle_tolerance",
            law.name
        );
    }
    if let Some(damping) = scene.damping.iter().find(|damping| !damping.gravity_damped)
        && scene.gravity != [0.0; 3]
    {
        return format!(
            "[damping.{}]: expected gravity_damped = true while it settles, found false, which leaves a part of the \
             load undamped, so that bodies swing about rest",
            damping.name
        );
    }
    match simulation.fastest() {
        Some((index, speed, radius)) if speed > 0.0 => {
            let touches = |record: &ContactRecord| [Some(record.first), record.second].contains(&Some(index));
            let held = match simulation.contacts().iter().filter(|record| touches(record)).count() {
                0 => "touching nothing".to_owned(),
                count => format!("with {}", counted(count as u64, "contact")),
            };
            format!(
                "it still moves: particle {} (radius {radius:.3e} m) at {speed:.3e} m/s, fastest of all, {held}; a bed that \
                 flows, or a particle that nothing holds, never rests",
                simulation.number(index)
            )
        }
        _ => "nothing moves, and still the forces do not balance".to_owned(),
    }
}

/// Unbalanced force over the mean force of the contacts or bonds, damping apart; 0 where nothing moves by the forces on it.
fn unbalanced_force(simulation: &mut Simulation) -> f64 {
    let state = simulation.state();
    let held = state.particles.slots().all(|slot| !state.is_loose(slot));
    let free = |boundary: &Boundary| boundary.axes.iter().any(AxisMotion::is_free);
    if held && !simulation.scene().boundaries.iter().any(free) { 0.0 } else { simulation.undamped_unbalanced_force() }
}

/// The scene with boundaries that stand still but for their free axes and servos, insertions without a rate, and without books to keep.
fn standing_still(scene: &Scene) -> Arc<Scene> {
    let mut still = SceneDraft::clone(scene);
    for boundary in &mut still.boundaries {
        for axis in boundary.axes.iter_mut().filter(|axis| !axis.is_free() && axis.servo().is_none()) {
            *axis = AxisMotion::Fixed;
        }
    }
    for motion in still.cell.iter_mut().flat_map(|cell| &mut cell.motion) {
        if let CellMotion::Prescribed(_) = motion {
            *motion = CellMotion::Fixed;
        }
    }
    for insertion in &mut still.insertions {
        insertion.stop();
    }
    still.output.energy = false;
    // What stands still is right wherever what moves is.
    Arc::new(Scene::of_checked(still))
}
