//! The bound for impacts to come is that of the hardest two bodies that can meet: a single body of steel never counts as two, nor its
//! modulus as that of the lightest grain.

use super::stated;
use crate::support::checked;

/// Young's modulus \[Pa\] and density \[kg/m³\].
type Material = [f64; 2];

/// What the bed is made of.
const SOFT: Material = [1e9, 2500.0];

/// What the ball is made of.
const STEEL: Material = [2.1e11, 7200.0];

/// Poisson's ratio of both.
const RATIO: f64 = 0.2;

/// Speed of the ball, and the speed at which two bodies may meet by then \[m/s\].
const SPEEDS: [f64; 2] = [5.0, 2.0 * 1.5 * 5.0];

/// 2/√(K/m*) of Hertz's spheres without friction, of these materials and radii \[m\], where their impact is deepest \[s\]. A wall has no radius.
fn step(materials: [Material; 2], radii: [f64; 2]) -> f64 {
    let mass = |k: usize| materials[k][1] * 4.0 / 3.0 * std::f64::consts::PI * radii[k].powi(3);
    let of = |f: &dyn Fn(usize) -> f64| 1.0 / (1.0 / f(0) + if radii[1] > 0.0 { 1.0 / f(1) } else { 0.0 });
    let (radius, mass) = (of(&|k| radii[k]), of(&mass));
    let compliance: f64 = materials.iter().map(|[modulus, _]| (1.0 - RATIO * RATIO) / modulus).sum();
    let modulus = 1.0 / compliance;
    let deepest = (15.0 * mass * SPEEDS[1] * SPEEDS[1] / (16.0 * modulus * radius.sqrt())).powf(0.4);
    2.0 / (2.0 * modulus * (radius * deepest).sqrt() / mass).sqrt()
}

/// A few grains of 1 mm, balls of 10 mm, and what else there is.
fn scene(balls: usize, more: &str) -> f64 {
    let ball = |k: usize| {
        format!("{{ position = [0.0, {:?}, 0.05], radius = 0.01, velocity = [0.0, 0.0, -5.0] }}", 0.05 * k as f64)
    };
    let balls = (0..balls).map(ball).collect::<Vec<_>>().join(", ");
    let pairs: String = ["soft.soft", "soft.steel", "steel.steel"]
        .iter()
        .map(|it| format!("[pair.{it}]\nrestitution = 1.0\n"))
        .collect();
    stated(&checked(&format!(
        "[run]\nthreads = 1\n[material.soft]\nyoungs_modulus = 1e9\npoissons_ratio = {RATIO}\ndensity = 2500.0\n\
         [material.steel]\nyoungs_modulus = 2.1e11\npoissons_ratio = {RATIO}\ndensity = 7200.0\n{pairs}\
         [contact.c.normal.hertz]\n[particles.bed]\nmaterial = \"soft\"\n\
         lattice = {{ kind = \"simple_cubic\", origin = [0.0, 0.0, 0.0], counts = [3, 3, 1], spacing = 2.5e-3, radius = 1e-3 }}\n\
         [particles.ball]\nmaterial = \"steel\"\nlist = [{balls}]\n{more}"
    )))
}

#[track_caller]
fn holds(found: f64, expected: f64) {
    assert!((0.99..=1.0).contains(&(found / expected)), "{found:e} s, {expected:e} s is the true one");
}

#[test]
fn one_steel_ball_does_not_meet_another() {
    let pairs = [step([SOFT, SOFT], [1e-3, 1e-3]), step([SOFT, STEEL], [1e-3, 0.01])];
    holds(scene(1, ""), pairs[0].min(pairs[1]));
    holds(scene(2, ""), pairs[0].min(pairs[1]).min(step([STEEL, STEEL], [0.01, 0.01])));
}

#[test]
fn a_group_meets_what_it_does_not_hold() {
    let group = "[boundary.ball]\nparticles = { set = \"ball\" }\nmotion = { free = [\"x\", \"y\", \"z\"] }\n";
    holds(scene(1, group), step([SOFT, SOFT], [1e-3, 1e-3]).min(step([SOFT, STEEL], [1e-3, 0.01])));
}

#[test]
fn a_steel_wall_is_met_by_the_lightest_of_each_material() {
    let wall =
        "[boundary.wall]\nmaterial = \"steel\"\nplane = { point = [0.0, 0.0, -0.1], normal = [0.0, 0.0, 1.0] }\n";
    // In an edge it meets two at once.
    let at_walls = step([SOFT, STEEL], [1e-3, 0.0]).min(step([STEEL, STEEL], [0.01, 0.0])) / 2.0_f64.sqrt();
    let pairs = step([SOFT, SOFT], [1e-3, 1e-3]).min(step([SOFT, STEEL], [1e-3, 0.01]));
    holds(scene(1, wall), pairs.min(at_walls));
}

#[test]
fn what_comes_meets_what_comes() {
    let rain = "[region.feed]\nbox = [[-0.02, -0.02, 0.1], [0.02, 0.02, 0.12]]\n[insertion.rain]\nregion = \"feed\"\n\
                material = \"steel\"\nsizes = { uniform = [0.5e-3, 1e-3] }\ncount_rate = 100.0\n";
    let pairs = [step([STEEL, STEEL], [0.5e-3, 0.5e-3]), step([SOFT, STEEL], [1e-3, 0.5e-3])];
    holds(scene(1, rain), pairs[0].min(pairs[1]));
}
