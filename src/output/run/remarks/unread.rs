//! On what nothing reads: properties, materials, laws.

use super::pairs;
use crate::laws::contact::{Material, MaterialPair, Properties, Thermal};
use crate::scene::{ContactLaw, Scene};

/// On properties of pairs of materials that nothing reads.
pub(super) fn unread(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let entries = (0..count).flat_map(|a| (a..count).map(move |b| (a, b)));
    let mut remarks = Vec::new();
    for ((a, b), (table, properties)) in entries.zip(pairs(scene)) {
        let laws: Vec<_> = scene.contacts.iter().filter(|law| law.between[a * count + b]).collect();
        let with = |law: &ContactLaw, properties: &Properties| {
            let pair = MaterialPair { a: &scene.materials[a], b: &scene.materials[b], properties };
            (law.choice.coefficients(&pair).ok(), law.heat_between(&pair))
        };
        let is_read = |variants: &[Properties]| {
            laws.iter().any(|law| variants.iter().any(|other| with(law, other) != with(law, properties)))
        };
        let keys: Vec<_> =
            properties.variants().filter(|(_, variants)| !is_read(variants)).map(|(key, _)| key).collect();
        if keys.is_empty() {
            continue;
        }
        let expected = if laws.is_empty() {
            "a [contact] law for these materials"
        } else {
            "a sub-model of [contact] that takes it, or no such key"
        };
        remarks.push(format!("[{table}] {}: nothing reads it; expected {expected}", keys.join(", ")));
    }
    remarks
}

/// On materials of which nothing is made, laws that are for none that can meet, and moduli that no law reads.
pub(super) fn idle(scene: &Scene) -> Vec<String> {
    let count = scene.materials.len();
    let particles =
        scene.particles.iter().map(|particle| particle.material).chain(scene.insertions.iter().map(|it| it.material));
    let (mut moving, mut there) = (vec![false; count], vec![false; count]);
    particles.for_each(|material| moving[material.index()] = true);
    there.clone_from(&moving);
    let walls = scene.boundaries.iter().filter_map(|boundary| boundary.shape.material());
    walls.for_each(|material| there[material.index()] = true);
    let mut remarks = Vec::new();
    for (index, material) in scene.materials.iter().enumerate() {
        if !there[index] {
            remarks.push(format!("[material.{}]: nothing is made of it", material.name));
            continue;
        }
        let own = material.thermal;
        if own.specific_heat.is_some() && !scene.has_heat() {
            remarks.push(format!(
                "[material.{}] specific_heat: nothing reads it; no heat flows without [contact.<law>.heat.<model>] or another table of heat",
                material.name
            ));
        }
        let elastic = [
            (
                "youngs_modulus",
                material.youngs_modulus.is_some(),
                Material { youngs_modulus: None, ..material.clone() },
            ),
            (
                "poissons_ratio",
                material.poissons_ratio.is_some(),
                Material { poissons_ratio: None, ..material.clone() },
            ),
        ];
        let declared = material.properties.iter().map(|(property, _)| {
            let without = material.properties.clone().without(property);
            (property.name, true, Material { properties: without, ..material.clone() })
        });
        let thermal = [
            ("conductivity", own.conductivity.is_some(), Thermal { conductivity: None, ..own }),
            ("real_youngs_modulus", own.real_youngs_modulus.is_some(), Thermal { real_youngs_modulus: None, ..own }),
        ];
        let thermal = thermal.map(|(key, given, thermal)| (key, given, Material { thermal, ..material.clone() }));
        let optional: Vec<_> = elastic.into_iter().chain(declared).chain(thermal).collect();
        let is_read = |other: &Material| {
            (0..count).any(|partner| {
                let entry = index * count + partner;
                let with = |own: &Material| {
                    let b = if partner == index { own } else { &scene.materials[partner] };
                    let pair = MaterialPair { a: own, b, properties: &scene.pairs[entry] };
                    let laws = scene.contacts.iter().filter(|law| law.between[entry]);
                    let read = |law: &ContactLaw| (law.choice.coefficients(&pair).ok(), law.heat_between(&pair));
                    laws.map(read).collect::<Vec<_>>()
                };
                with(other) != with(material)
            })
        };
        let keys: Vec<_> =
            optional.iter().filter(|(_, given, other)| *given && !is_read(other)).map(|(key, ..)| *key).collect();
        if !keys.is_empty() {
            remarks.push(format!(
                "[material.{}] {}: nothing reads it; no contact law takes it",
                material.name,
                keys.join(", ")
            ));
        }
    }
    let meet = |entry: usize| {
        let (a, b) = (entry / count, entry % count);
        moving[a] && there[b] || there[a] && moving[b]
    };
    for law in scene.contacts.iter().filter(|law| !(0..count * count).any(|entry| law.between[entry] && meet(entry))) {
        remarks.push(format!("[contact.{}]: no two bodies of the scene are of its materials", law.name));
    }
    remarks
}

#[cfg(test)]
mod tests {
    use super::super::fixture::scene;
    use super::super::surroundings::passed_through;
    use super::*;
    use crate::scene::Source;

    #[test]
    fn what_nothing_reads_is_remarked() {
        let (pair, law) =
            ("restitution = 0.5\nfriction = 0.4", "[contact.c.normal.hertz]\n[contact.c.tangential.history]");
        assert!(unread(&scene(pair, law, 2500.0)).is_empty());
        let forgotten = scene(pair, "", 2500.0);
        assert_eq!(
            unread(&forgotten),
            ["[pair.g.g] restitution, friction: nothing reads it; expected a [contact] law for these materials"]
        );
        assert_eq!(
            passed_through(&forgotten),
            ["[boundary.floor]: particles of g pass through it: expected a [contact] law for g and g"]
        );
        let more = format!("{pair}\ncohesion_energy_density = 1e4\nrolling_friction = 0.3");
        let told = unread(&scene(&more, law, 2500.0));
        assert!(
            told[0].starts_with("[pair.g.g] rolling_friction, cohesion_energy_density: nothing reads it"),
            "{told:?}"
        );
        let read = format!("{law}\n[contact.c.rolling.cdt]\n[contact.c.cohesion.sjkr]");
        assert!(unread(&scene(&more, &read, 2500.0)).is_empty());
    }

    #[test]
    fn what_particles_and_sets_say_themselves_is_remarked_where_it_stands_once_more() {
        let unread = |more: &str| {
            let text = format!(
                "[material.g]\ndensity = 2500.0\n[clump.c]\nspheres = [{{ position = [0.0, 0.0, 0.0], radius = 1e-3 }}]\n{more}"
            );
            let source = Source { name: "scene.toml".into(), text, files: Default::default() };
            Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}")).unread.clone()
        };
        let list = |keys: &str| format!("list = [{{ position = [0.0, 0.0, 0.0]{keys} }}]\n");
        let spheres = "[particles.a]\nmaterial = \"g\"\nvelocity = [1.0, 0.0, 0.0]\n";
        let own = ", radius = 1e-3, velocity = [0.0, 0.0, 1.0]";
        assert_eq!(
            unread(&format!("{spheres}{}", list(own))),
            [
                "[clump.c] spheres: nothing reads it; no set or insertion has such clumps",
                "[particles.a] velocity: nothing reads it; each of its particles has its own"
            ]
        );
        let clumps = "[particles.a]\nclump = \"c\"\norientation = \"random\"\n";
        let told =
            unread(&format!("material = \"g\"\n{clumps}{}", list(", material = \"g\", orientation = [1, 0, 0, 0]")));
        assert_eq!(
            told,
            [
                "[clump.c] material: nothing reads it; all that place such clumps have their own",
                "[particles.a] orientation: nothing reads it; each of its particles has its own"
            ]
        );
        assert!(unread(&format!("material = \"g\"\n{clumps}{}", list(""))).is_empty());
    }

    #[test]
    fn what_heat_reads_is_not_remarked_and_what_it_does_not_read_is() {
        let told = |heat: &str, pair: &str| {
            let text = format!(
                "[material.g]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\nspecific_heat = 800.0\nconductivity = 1.0\n\
                 real_youngs_modulus = 1e10\n[pair.g.g]\nrestitution = 0.5\n{pair}\n[contact.c.normal.hertz]\n{heat}\n[particles.a]\n\
                 material = \"g\"\ntemperature = 300.0\nlist = [{{ position = [0.0, 0.0, 0.02], radius = 0.01 }}]\n"
            );
            let source = Source { name: "scene.toml".into(), text, files: Default::default() };
            let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
            [unread(&scene), idle(&scene)].concat()
        };
        let transfer = "[contact.c.heat.transfer]";
        assert!(told("[contact.c.heat.constriction]", "").is_empty());
        assert_eq!(
            told(transfer, "heat_transfer_coefficient = 1e3"),
            ["[material.g] conductivity: nothing reads it; no contact law takes it"]
        );
        let both = "conductivity = 2.0\nheat_transfer_coefficient = 1e3";
        assert!(told(transfer, both)[0].starts_with("[pair.g.g] conductivity: nothing reads it"));
        let told_of_none = told("", "");
        assert!(told_of_none[0].starts_with("[material.g] specific_heat: nothing reads it; no heat flows"));
        assert!(told_of_none[1].starts_with("[material.g] conductivity, real_youngs_modulus: nothing reads it"));
    }

    #[test]
    fn materials_laws_and_moduli_that_nothing_takes_are_remarked() {
        let pair = "restitution = 0.5\nfriction = 0.4";
        let law = "[contact.c.normal.hertz]\n[contact.c.tangential.history]";
        assert!(idle(&scene(pair, law, 2500.0)).is_empty());
        let more = "[material.steel]\ndensity = 7800.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.3\n";
        assert_eq!(idle(&scene(pair, &format!("{more}{law}"), 2500.0)), ["[material.steel]: nothing is made of it"]);
        let other = format!(
            "{more}[pair.g.steel]\nrestitution = 0.5\nfriction = 0.4\n[contact.c]\nbetween = [[\"g\", \"g\"]]\n{law}\n[contact.s]\n\
             between = [[\"g\", \"steel\"]]\n[contact.s.normal.hertz]\n[contact.s.tangential.history]"
        );
        let told = idle(&scene(pair, &other, 2500.0));
        assert_eq!(
            told,
            ["[material.steel]: nothing is made of it", "[contact.s]: no two bodies of the scene are of its materials"]
        );
        assert_eq!(
            idle(&scene(pair, "", 2500.0)),
            ["[material.g] youngs_modulus, poissons_ratio: nothing reads it; no contact law takes it"]
        );
    }
}
