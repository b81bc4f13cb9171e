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
    remarks.extend(friction(scene));
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
        let found = if stable.is_finite() { format!(" ({stable:.3e} s as last found)") } else { String::new() };
        return Some(format!(
            "[run] allow_unstable: nothing stops this run when its time step, {step:e} s, is above the stable one{found}; its numbers are worth nothing then"
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

/// On friction whose dashpot stretches its spring backwards where it exceeds the limit, as it does at first touch: what follows then depends
/// on how deep the first time step finds the contact.
fn friction(scene: &Scene) -> Vec<String> {
    let named = scene.contacts.iter().filter(|law| law.choice().stretches_backwards());
    let told = named.map(|law| {
        format!(
            "[contact.{}] tangential: with {}, rebounds of impacts that slide first may depend on the time step by some percent, and a shorter one need not help; with backward_spring = false, or history, they converge",
            law.name,
            law.tangential.name()
        )
    });
    told.collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Source;

    #[test]
    fn a_spring_that_its_dashpot_stretches_backwards_is_remarked() {
        let told = |tangential: &str, damping: &str| {
            let text = format!(
                "[material.a]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.3\n[pair.a.a]\nrestitution = 0.5\nfriction = 0.5\n\
                 [contact.c]\ntangential_damping = {damping}\n[contact.c.normal.hertz]\n[contact.c.tangential.{tangential}]\n\
                 [particles.p]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, 0.0], radius = 1e-3 }}]\n"
            );
            let source = Source { name: "scene.toml".into(), text, files: Default::default() };
            friction(&Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}")))
        };
        assert!(told("turned_history", "true")[0].starts_with("[contact.c] tangential: with turned_history, rebounds"));
        assert!(told("turned_history]\nbackward_spring = false\n[contact.c.rolling.none", "true").is_empty());
        for [tangential, damping] in [["turned_history", "false"], ["history", "true"], ["no_history", "true"]] {
            assert!(told(tangential, damping).is_empty(), "{tangential}, damping {damping}");
        }
    }
}
