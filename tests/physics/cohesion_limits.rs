//! Cohesion by the area of contact sinks spheres into each other: with Hertz to a depth of theory, with linear springs without end.
//!
//! Two equal spheres of radius R, R* = R/2, cohesion energy density C. Hertz with `sjkr`, small overlaps: 4/3 E* √R* δ^(3/2) =
//! C 2 π R* δ at δ/R* = (3 π C/(2 E*))². Linear springs: k_n δ against C 2 π R* δ = C π R δ; from C = k_n/(π R) on nothing holds.

use crate::physics::cundall_decay::damping;
use crate::physics::stage::{SMOOTH, SPRING, Stage, assert_close, material, properties, scene, sphere};
use cograin::contact::cohesion::sjkr;
use cograin::contact::{CohesionModel, LawChoice, Properties, cohesion, property};
use std::f64::consts::PI;

/// Radius \[m\].
const R: f64 = 0.001;

/// `sjkr`
const COHESION: CohesionModel = CohesionModel::fixed::<cohesion::sjkr::Sjkr>(&sjkr::Keys { tangential_reduce: false });

/// Overlap \[m\] that two spheres begin with.
const TOUCH: f64 = 1e-6 * R;

/// Overlap \[m\] of two spheres at rest, or none where the run stops.
fn at_rest(law: LawChoice, pair: Properties, step: f64) -> Option<f64> {
    let mut other = sphere(R, 2500.0);
    other.position[0] = 2.0 * R - TOUCH;
    let mut scene = scene(law, step, vec![material(1.82e7, 0.3)], pair, vec![sphere(R, 2500.0), other]);
    scene.run.allow_unstable = true;
    scene.damping = damping(&scene, 0.7, 0.7, false);
    let mut stage = Stage::of(scene);
    for _ in 0..20 {
        stage.simulation.advance(1000.0 * step).ok()?;
    }
    Some(2.0 * R - (stage.position(1)[0] - stage.position(0)[0]))
}

#[test]
fn hertz_rests_where_attraction_and_elasticity_are_equal() {
    let effective = 1.82e7 / (1.0 - 0.09) / 2.0;
    for part in [0.002, 0.005, 0.01] {
        let density = part * effective;
        let pair = properties(0.5, 0.0).with(&property::COHESION_ENERGY_DENSITY, density);
        let found = at_rest(LawChoice { cohesion: COHESION, ..SMOOTH }, pair, 1e-6).expect("it rests");
        // The area is that of the lens, 2 π R* δ (1 − δ/(4 R) …): within the overlap over the radius.
        let expected = 0.5 * R * (1.5 * PI * part) * (1.5 * PI * part);
        assert_close(found, expected, 1e-6 + found / R, "overlap at rest");
    }
}

#[test]
fn linear_springs_hold_below_the_limit_and_not_above() {
    let stiffness = 1e4;
    let limit = stiffness / (PI * R);
    let overlap = |part: f64| {
        let pair = properties(1.0, 0.0)
            .with(&property::COHESION_ENERGY_DENSITY, part * limit)
            .with(&property::NORMAL_STIFFNESS, stiffness)
            .with(&property::NORMAL_DAMPING, 0.0);
        at_rest(LawChoice { cohesion: COHESION, ..SPRING }, pair, 1e-6)
    };
    let held = overlap(0.99).expect("it goes on");
    assert!(held <= TOUCH, "{held:e} m at 0.99 of the limit: linear springs push to no overlap");
    let sunk = overlap(1.01);
    assert!(sunk.is_none_or(|depth| depth > 100.0 * TOUCH), "{sunk:?} at 1.01 of the limit");
}
