//! What is legal in a scene but risky: said once, by `check`, in `summary.json` and by the unit's logger.

use crate::exchange::Amount;
use crate::scene::{Scene, Step};
use crate::step::{COLLAPSING_COHESION, Simulation};

/// Part of the stable step above which a given step is said to be near it.
const NEAR_THE_BOUND: f64 = 0.8;

/// Young's moduli that a widely used program of the field takes without further ado \[Pa\].
const USUAL_MODULI: [f64; 2] = [5e6, 1e9];

/// Cohesion energy density over effective modulus from which contacts at rest are visibly pulled together.
const DEEP_COHESION: f64 = 0.03;

/// Overlap over radius above which contact laws are hardly valid.
const DEEP_OVERLAP: f64 = 0.05;

/// The remarks on a scene in its present state.
pub fn remarks(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut remarks = Vec::new();
    remarks.extend(time_step(scene, simulation));
    remarks.extend(intervals(scene));
    remarks.extend(moduli(scene));
    remarks.extend(cohesion(scene));
    remarks.extend(overlap(simulation));
    remarks.extend(falling(scene));
    remarks.extend(full(scene, simulation));
    remarks
}

/// On a given step near the stable one.
fn time_step(scene: &Scene, simulation: &Simulation) -> Option<String> {
    let Step::Given(step) = scene.run.step else { return None };
    let stable = simulation.state().clock.stable;
    if scene.run.allow_unstable {
        return Some(format!(
            "[run] allow_unstable: nothing stops this run when its time step, {step:e} s, is above the stable one ({stable:.3e} s as last found); its numbers are worth nothing then"
        ));
    }
    (step > NEAR_THE_BOUND * stable).then(|| {
        format!("[run] step: {step:e} s is {:.2} of the computed stable step, {stable:.3e} s; accuracy suffers well before stability", step / stable)
    })
}

/// On what insertions did not let come for want of room.
fn full(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let feeds = simulation.state().exchange.iter().flat_map(|exchange| &exchange.feeds);
    let told = scene.insertions.iter().zip(feeds).filter(|(_, feed)| feed.dropped > 0.0);
    told.map(|(insertion, feed)| {
        let what = match insertion.amount {
            Amount::CountRate(_) => "particles",
            Amount::MassRate(_) | Amount::Mass(_) => "kg",
        };
        format!(
            "[insertion.{}]: {:.4e} {what} found no room; a larger region, or one from which spheres move away faster, lets more come",
            insertion.name, feed.dropped
        )
    })
    .collect()
}

/// Remarks on intervals that are not a whole number of given steps.
fn intervals(scene: &Scene) -> Vec<String> {
    let Step::Given(step) = scene.run.step else { return Vec::new() };
    let output = &scene.output;
    let named = [
        ("history_interval", output.history_interval),
        ("frame_interval", output.frame_interval),
        ("checkpoint_interval", output.checkpoint_interval),
    ];
    let uneven = |interval: f64| ((interval / step).round() * step - interval).abs() > 1e-6 * step;
    (named.into_iter())
        .filter_map(|(key, interval)| interval.filter(|interval| uneven(*interval)).map(|interval| (key, interval)))
        .map(|(key, interval)| {
            format!(
                "[output] {key}: {interval:e} s is not a whole number of steps of {step:e} s; they are shortened to fit"
            )
        })
        .collect()
}

/// On moduli that others would ask to confirm.
fn moduli(scene: &Scene) -> Vec<String> {
    let [soft, hard] = USUAL_MODULI;
    let outside = |modulus: &f64| *modulus < soft || *modulus > hard;
    (scene.materials.iter())
        .filter_map(|material| material.youngs_modulus.filter(outside).map(|modulus| (&material.name, modulus)))
        .map(|(name, modulus)| {
            let effect = if modulus < soft { "overlaps will be large" } else { "time steps will be short" };
            format!("[material.{name}] youngs_modulus: {modulus:e} Pa is outside {soft:e} to {hard:e} Pa, which particle programs usually take; {effect}")
        })
        .collect()
}

/// On cohesion that pulls contacts deep into each other.
fn cohesion(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let pairs = (0..count).flat_map(|a| (a..count).map(move |b| (a, b)));
    let deep = pairs.filter_map(|(a, b)| {
        let ratio = scene.cohesion_ratio(a, b).filter(|ratio| *ratio > DEEP_COHESION)?;
        let density = scene.pairs[a * count + b].cohesion_energy_density?.get();
        let effect = if ratio > COLLAPSING_COHESION { "contacts collapse" } else { "contacts rest deep in each other" };
        let [a, b] = [a, b].map(|index| &scene.materials[index].name);
        Some(format!(
            "[pair.{a}.{b}] cohesion_energy_density: {density:e} J/m³ is {ratio:.2e} of the effective modulus; above {DEEP_COHESION} {effect}"
        ))
    });
    deep.collect()
}

/// On overlaps that contact laws are not made for.
fn overlap(simulation: &Simulation) -> Option<String> {
    let overlap = simulation.largest_overlap();
    (overlap > DEEP_OVERLAP)
        .then(|| format!("the largest overlap is {overlap:.3} of a radius; contact laws hold for small ones"))
}

/// On particles that fall for ever.
fn falling(scene: &Scene) -> Option<String> {
    let endless =
        scene.boundaries.is_empty() && scene.domain.is_none() && scene.gravity.iter().any(|part| *part != 0.0);
    endless.then(|| "gravity acts and there is no boundary and no [domain]: particles fall for ever".to_owned())
}
