//! Cohesion pulls, `sjkr2` twice as hard as `sjkr` between spheres and as hard at a wall, and friction ignores it
//! unless told otherwise.
//!
//! The area of the documents is negative for overlapping spheres; taken at its word it would push.

use crate::physics::stage::{HERTZ, SPRING, Stage, assert_close, material, plane, properties, scene, sphere};
use cograin::contact::cohesion::sjkr;
use cograin::contact::{CohesionModel, LawChoice, NoKeys, Properties, TangentialModel, cohesion, property, tangential};
use cograin::scene::SceneDraft;
use std::f64::consts::PI;

/// Radius \[m\].
const R: f64 = 0.005;

/// Overlap \[m\].
const OVERLAP: f64 = 1e-6;

/// Cohesion energy density \[J/m³\].
const DENSITY: f64 = 1e4;

/// A law without springs that holds by cohesion alone.
fn law(cohesion: CohesionModel) -> (LawChoice, Properties) {
    let pair = properties(1.0, 0.0)
        .with(&property::NORMAL_STIFFNESS, 0.0)
        .with(&property::NORMAL_DAMPING, 0.0)
        .with(&property::COHESION_ENERGY_DENSITY, DENSITY);
    (LawChoice { cohesion, ..SPRING }, pair)
}

/// Force on the first of two overlapping spheres along the line to the second \[N\].
fn between_spheres(cohesion: CohesionModel) -> f64 {
    let (law, pair) = law(cohesion);
    let mut other = sphere(R, 2500.0);
    other.position[0] = 2.0 * R - OVERLAP;
    let bodies = vec![sphere(R, 2500.0), other];
    Stage::of(scene(law, 1e-6, vec![material(1e7, 0.3)], pair, bodies)).force(0)[0]
}

/// Force on a sphere towards a plane that it overlaps \[N\].
fn at_wall(cohesion: CohesionModel) -> f64 {
    let (law, pair) = law(cohesion);
    let mut body = sphere(R, 2500.0);
    body.position[2] = R - OVERLAP;
    let mut scene = scene(law, 1e-6, vec![material(1e7, 0.3)], pair, vec![body]);
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 0)];
    -Stage::of(scene).force(0)[2]
}

/// Both models.
const MODELS: [CohesionModel; 2] = [
    CohesionModel::fixed::<cohesion::sjkr::Sjkr>(&sjkr::Keys { tangential_reduce: false }),
    CohesionModel::fixed::<cohesion::sjkr2::Sjkr2>(&sjkr::Keys { tangential_reduce: false }),
];

#[test]
fn pulls_overlapping_spheres_together() {
    // R* = R/2: 2π R* δ c, and 2π (2 R*) δ c; the section differs from 2π R* δ by δ/(4 R*)
    assert_close(between_spheres(MODELS[0]), 2.0 * PI * (R / 2.0) * OVERLAP * DENSITY, 2e-4, "sjkr");
    assert_close(between_spheres(MODELS[1]), 2.0 * PI * R * OVERLAP * DENSITY, 1e-10, "sjkr2");
}

#[test]
fn sjkr2_is_twice_sjkr_between_spheres_and_equal_at_a_wall() {
    assert_close(between_spheres(MODELS[1]) / between_spheres(MODELS[0]), 2.0, 2e-4, "spheres");
    assert_close(at_wall(MODELS[1]) / at_wall(MODELS[0]), 1.0, 2e-4, "wall");
    assert_close(at_wall(MODELS[0]), PI * OVERLAP * (2.0 * R - OVERLAP) * DENSITY, 1e-10, "sjkr at a wall");
}

/// Tangential force on a sphere that slides on a plane, with cohesion as strong as half its elastic force \[N\].
fn friction(tangential_reduce: bool) -> (f64, f64) {
    let mut body = sphere(R, 2500.0);
    let overlap = 1e-5;
    body.position[2] = R - overlap;
    body.velocity[0] = 1.0;
    let elastic = 4.0 / 3.0 * 1e7 / 2.0 * (R * overlap).sqrt() * overlap;
    let density = 0.5 * elastic / (2.0 * PI * R * overlap);
    let law = LawChoice {
        tangential: TangentialModel::of::<tangential::no_history::NoHistory>(NoKeys {}),
        cohesion: CohesionModel::of::<cohesion::sjkr2::Sjkr2>(sjkr::Keys { tangential_reduce }),
        ..HERTZ
    };
    let pair = properties(0.5, 0.1).with(&property::COHESION_ENERGY_DENSITY, density);
    let mut scene: SceneDraft = scene(law, 1e-7, vec![material(1e7, 0.0); 2], pair, vec![body]);
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    (-Stage::of(scene).force(0)[0], 0.1 * elastic)
}

#[test]
fn friction_ignores_cohesion_unless_told() {
    let (found, without_cohesion) = friction(false);
    assert_close(found, without_cohesion, 1e-9, "tangential_reduce = false");
    let (found, without_cohesion) = friction(true);
    assert_close(found, 0.5 * without_cohesion, 1e-9, "tangential_reduce = true");
}
