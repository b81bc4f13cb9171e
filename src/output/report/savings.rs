//! What a scene pays for and could drop, with the saving measured: the scene is run for a moment with and without it.

use super::{economy, trial};
use crate::engine::simulation::Simulation;
use crate::interface::Interface;
use crate::laws::contact::{Property, property};
use crate::scene::{ContactLaw, DRY, ROLLING_FREELY, SMOOTH, Scene, SceneDraft, Step};
use std::sync::Arc;
use std::time::Duration;

/// Wall time of one trial, with or without.
const PATIENCE: Duration = Duration::from_millis(100);

/// Trials of each, in turn; the least counts.
const ROUNDS: u32 = 3;

/// The smallest saving that is reported, over the time of a step: short trials cannot measure less.
const LEAST: f64 = 0.03;

/// Part of the stable step below which a given step is reported: the automatic step is longer by more than half.
const SHORT: f64 = 0.6;

/// The stable step of a packing over that of its grains in flight.
const PACKED: [f64; 2] = [1.0 / 3.0, 0.5];

/// So many grains pack.
const FEW: usize = 30;

/// Something that a scene could drop.
struct Unused {
    /// What it is and why.
    what: String,
    /// The scene without it.
    without: SceneDraft,
}

/// What the scene could drop, a line each.
pub(super) fn of(scene: &Arc<Scene>, present: &Simulation) -> Vec<String> {
    let mut lines = Vec::new();
    for Unused { what, without } in unused(scene) {
        let without = without.build().ok().map(Arc::new);
        if let Some([with, less]) = without.and_then(|without| costs(scene, &without)) {
            let saved = 1.0 - less / with;
            lines.push(if saved > LEAST {
                format!("{what}: without it a step takes {:.0} % less time", 100.0 * saved)
            } else {
                format!("{what}: without it a step takes as long, to {:.0} %", 100.0 * LEAST)
            });
        }
    }
    lines.extend(short_step(scene, present));
    lines
}

/// The stable time steps, least first, that grains which are loose now have once they pack \[s\]; none where few or none do.
fn packed(scene: &Scene, present: &Simulation) -> Option<[f64; 2]> {
    let bodies = scene.particles.len();
    let packs = bodies >= FEW || !scene.insertions.is_empty();
    let is_loose = present.contact_count() < bodies && !scene.contacts.is_empty() && !present.state().is_bonded();
    (packs && is_loose).then(|| PACKED.map(|part| part * present.stable_step()))
}

/// On a given step that is divided once grains pack.
pub(super) fn foretold(scene: &Scene, present: &Simulation) -> Option<String> {
    let Step::Given(step) = scene.run.step else { return None };
    let [least, most] = packed(scene, present)?;
    (step > least).then(|| {
        let then = if scene.run.strict_step { "the run then stops" } else { "longer steps are then divided" };
        format!("[run] step: the grains are loose at the start; where they pack the stable step falls to about {least:.1e} to {most:.1e} s, and {then}")
    })
}

/// A given step that is much shorter than an automatic one, and will be.
fn short_step(scene: &Scene, present: &Simulation) -> Option<String> {
    let Step::Given(step) = scene.run.step else { return None };
    if packed(scene, present).is_some() {
        return None;
    }
    let (stable, part) = (present.stable_step(), step / economy::default_step(scene)?);
    (stable.is_finite() && part < SHORT).then(|| {
        format!(
            "[run] step = {step:e}: {:.3} of the stable one; \"auto\" makes {:.2} times as many steps at the start",
            step / stable,
            part
        )
    })
}

/// Wall time of a step with and without \[s\]; nothing where one of them does not start or does not go on.
fn costs(with: &Arc<Scene>, without: &Arc<Scene>) -> Option<[f64; 2]> {
    let mut least = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        for (scene, least) in [with, without].into_iter().zip(&mut least) {
            let mut simulation = Simulation::new(Arc::clone(scene)).ok()?;
            let trial = trial::steps(&mut simulation, None, PATIENCE);
            if trial.failed.is_some() {
                return None;
            }
            if trial.step > 0.0 {
                *least = least.min(trial.step);
            }
        }
    }
    least.iter().all(|cost| cost.is_finite()).then_some(least)
}

/// What the scene has and does not need.
fn unused(scene: &Scene) -> Vec<Unused> {
    let mut unused = Vec::new();
    for (index, law) in scene.contacts.iter().enumerate() {
        let zero = |of: &Property| is_zero(scene, law, of);
        let mut add = |part: &str, model: &str, property: &str, drop: fn(&mut ContactLaw)| {
            let mut without = SceneDraft::clone(scene);
            drop(&mut without.contacts[index]);
            let what = format!("[contact.{}.{part}.{model}]: {property} is 0 in all its pairs", law.name);
            unused.push(Unused { what, without });
        };
        if law.choice.tangential.row().is_active() && zero(&property::FRICTION) {
            add("tangential", law.choice.tangential.name(), "friction", |law| law.choice.tangential = SMOOTH);
        }
        if law.choice.rolling.row().is_active() && zero(&property::ROLLING_FRICTION) {
            add("rolling", law.choice.rolling.name(), "rolling_friction", |law| law.choice.rolling = ROLLING_FREELY);
        }
        if law.choice.cohesion.row().is_active() && zero(&property::COHESION_ENERGY_DENSITY) {
            add("cohesion", law.choice.cohesion.name(), "cohesion_energy_density", |law| law.choice.cohesion = DRY);
        }
    }
    for (index, damping) in scene.damping.iter().enumerate() {
        if damping.linear.iter().chain(&damping.angular).all(|fraction| *fraction == 0.0) {
            let mut without = SceneDraft::clone(scene);
            without.damping.remove(index);
            unused.push(Unused { what: format!("[damping.{}]: damps no particle", damping.name), without });
        }
    }
    for bond in 0..scene.bonds.len() {
        unused.extend(without_breakage(scene, bond));
    }
    for (key, is_kept) in [
        ("energy", scene.output.energy),
        ("losses", scene.output.losses && !scene.heat.warms() && scene.output.impacts.is_none()),
    ] {
        if !is_kept || is_read(scene) {
            continue;
        }
        let mut without = SceneDraft::clone(scene);
        match key {
            "energy" => without.output.energy = false,
            _ => without.output.losses = false,
        }
        let what = format!("[output] {key}: the book is kept, and no row of history.csv has it, only summary.json");
        unused.push(Unused { what, without });
    }
    unused
}

/// Whether rows of the history have energies.
fn is_read(scene: &Scene) -> bool {
    let recorded = || Interface::of(scene).recorded().any(|(_, variable)| variable.name.starts_with("energy."));
    scene.output.history_interval.is_some() && recorded()
}

/// A scene in which the bonds of a law never break, if they may.
fn without_breakage(scene: &Scene, bond: usize) -> Option<Unused> {
    let what = format!("[bond.{}] breakage, if its strengths are never reached", scene.bonds[bond].name);
    let mut without = SceneDraft::clone(scene);
    let breakage = std::mem::take(&mut without.bonds[bond].keys.breakage);
    // Its strengths are none.
    without.parameters.clear();
    (!breakage.is_empty()).then_some(Unused { what, without })
}

/// Whether a property is given as 0 for all pairs of a law that say it.
fn is_zero(scene: &Scene, law: &ContactLaw, of: &Property) -> bool {
    let own =
        || scene.pairs.iter().zip(&law.between).filter(|(_, between)| **between).filter_map(|(pair, _)| pair.get(of));
    own().next().is_some() && own().all(|value| value == 0.0)
}
