//! On numbers outside of the usual range: often a slip of units or sign.

use super::pairs;
use crate::laws::contact::property;
use crate::scene::Scene;

/// Young's moduli that a widely used program of the field takes without further ado \[Pa\].
const USUAL_MODULI: [f64; 2] = [5e6, 1e9];

/// Densities that scenes usually have \[kg/m³\].
const USUAL_DENSITIES: [f64; 2] = [50.0, 25_000.0];
/// Radii from powders to boulders \[m\].
const USUAL_RADII: [f64; 2] = [1e-7, 2.0];
/// Coefficients of friction.
const USUAL_FRICTION: [f64; 2] = [0.0, 2.0];
/// Gravity, that of centrifuges included \[m/s²\].
const USUAL_GRAVITY: [f64; 2] = [0.0, 2000.0];
/// Surface energies \[J/m²\].
const USUAL_SURFACE_ENERGIES: [f64; 2] = [0.0, 10.0];

/// On moduli that others would ask to confirm.
pub(super) fn moduli(scene: &Scene) -> Vec<String> {
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

/// On numbers outside of the usual range, with the range.
pub(super) fn unusual(scene: &Scene) -> Vec<String> {
    let mut remarks = Vec::new();
    let mut look = |key: String, value: f64, unit: &str, [least, most]: [f64; 2]| {
        if value < least || value > most {
            remarks
                .push(format!("{key}: expected {least:e} to {most:e}{unit} as usual, found {value:e}; check the unit"));
        }
    };
    for material in &scene.materials {
        look(format!("[material.{}] density", material.name), material.density, " kg/m³", USUAL_DENSITIES);
    }
    let gravity = scene.gravity.iter().map(|part| part * part).sum::<f64>().sqrt();
    look("gravity".to_owned(), gravity, " m/s²", USUAL_GRAVITY);
    for (set, name) in scene.sets.iter().enumerate() {
        let radii =
            || scene.particles.iter().filter(|particle| particle.set.index() == set).map(|particle| particle.radius);
        let key = || format!("[particles.{name}] radius");
        if let Some(least) = radii().reduce(f64::min).filter(|least| *least < USUAL_RADII[0]) {
            look(key(), least, " m", USUAL_RADII);
        }
        if let Some(most) = radii().reduce(f64::max).filter(|most| *most > USUAL_RADII[1]) {
            look(key(), most, " m", USUAL_RADII);
        }
    }
    for (table, properties) in pairs(scene) {
        let keys = [
            (&property::FRICTION, "", USUAL_FRICTION),
            (&property::ROLLING_FRICTION, "", USUAL_FRICTION),
            (&property::SURFACE_ENERGY, " J/m²", USUAL_SURFACE_ENERGIES),
        ];
        for (key, unit, range) in keys {
            if let Some(value) = properties.get(key) {
                look(format!("[{table}] {}", key.name), value, unit, range);
            }
        }
    }
    remarks
}

#[cfg(test)]
mod tests {
    use super::super::fixture::scene;
    use super::*;

    #[test]
    fn what_is_outside_of_the_usual_range_is_remarked_with_the_range() {
        let law = "[contact.c.normal.hertz]\n[contact.c.tangential.history]";
        assert!(unusual(&scene("restitution = 0.5\nfriction = 0.4", law, 2500.0)).is_empty());
        let told = unusual(&scene("restitution = 0.5\nfriction = 40.0", law, 2.5));
        assert_eq!(
            told,
            [
                "[material.g] density: expected 5e1 to 2.5e4 kg/m³ as usual, found 2.5e0; check the unit",
                "[pair.g.g] friction: expected 0e0 to 2e0 as usual, found 4e1; check the unit",
            ]
        );
    }
}
