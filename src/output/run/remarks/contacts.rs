//! On contact laws: cohesion that pulls deep, friction that depends on the time step.

use crate::engine::simulation::COLLAPSING_COHESION;
use crate::laws::contact::property;
use crate::scene::Scene;

/// Cohesion energy density over effective modulus from which contacts at rest are visibly pulled together.
const DEEP_COHESION: f64 = 0.03;

/// On cohesion that pulls contacts deep into each other.
pub(super) fn cohesion(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let pairs = (0..count).flat_map(|a| (a..count).map(move |b| (a, b)));
    let deep = pairs.filter_map(|(a, b)| {
        let ratio = scene.cohesion_ratio(a, b).filter(|ratio| *ratio > DEEP_COHESION)?;
        let density = scene.pairs[a * count + b].get(&property::COHESION_ENERGY_DENSITY)?;
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
pub(super) fn friction(scene: &Scene) -> Vec<String> {
    let named = scene.contacts.iter().filter(|law| law.choice.stretches_backwards());
    let told = named.map(|law| {
        format!(
            "[contact.{}] tangential: with {}, rebounds of impacts that slide first may depend on the time step by some percent, and a shorter one need not help; with backward_spring = false, or history, they converge",
            law.name,
            law.choice.tangential.name()
        )
    });
    told.collect()
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
