//! A Hertz impact has the largest overlap, the largest force and the duration of the theory.
//!
//! Source: K. L. Johnson, *Contact Mechanics* (1985), section 11.4; set-ups 1 and 2 of Y. C. Chung & J. Y. Ooi,
//! *Granular Matter* 13 (2011) 643–656.

use crate::physics::stage::{
    SMOOTH, Stage, assert_close, hertz_duration, hertz_overlap, material, plane, properties, rigid,
};
use crate::physics::stage::{scene, sphere};
use std::f64::consts::PI;

/// Time steps in a contact, and what is then right to: the step errs by (π/steps)²/24 and more where the force is not linear.
const STEPS: [(u64, f64); 2] = [(200, 1e-3), (2000, 1e-5)];

/// The largest of values that are known at equal steps: that of the parabola through the largest and its neighbours.
fn peak(values: &[f64]) -> f64 {
    let at = (1..values.len() - 1).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap();
    let [before, most, after] = [values[at - 1], values[at], values[at + 1]];
    most + (after - before) * (after - before) / (8.0 * (2.0 * most - before - after))
}

/// Largest overlap \[m\], largest force \[N\] and duration \[s\] of an impact that begins now.
fn measure(mut stage: Stage, steps: u64, overlap: impl Fn(&Stage) -> f64) -> [f64; 3] {
    let (mut depths, mut forces) = (vec![0.0], vec![0.0]);
    for _ in 0..steps + 10 {
        stage.steps(1);
        let [x, y, z] = stage.force(0);
        depths.push(overlap(&stage));
        forces.push((x * x + y * y + z * z).sqrt());
    }
    let apart = (1..depths.len()).find(|at| depths[*at] <= 0.0).expect("the contact ends");
    let part = depths[apart - 1] / (depths[apart - 1] - depths[apart]);
    [peak(&depths), peak(&forces), ((apart - 1) as f64 + part) * stage.step]
}

/// Two equal spheres of radius 10 mm meet at 10 m/s each.
fn pair(modulus: f64, ratio: f64, density: f64, steps: u64) -> ([f64; 3], [f64; 3]) {
    let (radius, speed) = (0.01, 20.0);
    let mass = 4.0 / 3.0 * PI * radius * radius * radius * density / 2.0;
    let effective = modulus / (1.0 - ratio * ratio) / 2.0;
    let step = hertz_duration(effective, radius / 2.0, mass, speed) / steps as f64;
    let mut left = sphere(radius, density);
    let mut right = left;
    left.velocity[0] = 10.0;
    right.velocity[0] = -10.0;
    right.position[0] = 2.0 * radius;
    let materials = vec![material(modulus, ratio)];
    let stage = Stage::of(scene(SMOOTH, step, materials, properties(1.0, 0.0), vec![left, right]));
    let found = measure(stage, steps, |stage| 2.0 * radius - (stage.position(1)[0] - stage.position(0)[0]));
    (found, theory(effective, radius / 2.0, mass, speed))
}

/// A sphere of radius 0.1 m meets a rigid plane at 0.2 m/s.
fn wall(modulus: f64, ratio: f64, density: f64, steps: u64) -> ([f64; 3], [f64; 3]) {
    let (radius, speed) = (0.1, 0.2);
    let mass = 4.0 / 3.0 * PI * radius * radius * radius * density;
    let effective = modulus / (1.0 - ratio * ratio);
    let step = hertz_duration(effective, radius, mass, speed) / steps as f64;
    let mut body = sphere(radius, density);
    body.velocity[2] = -speed;
    body.position[2] = radius;
    let mut scene = scene(SMOOTH, step, vec![material(modulus, ratio), rigid()], properties(1.0, 0.0), vec![body]);
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    let found = measure(Stage::of(scene), steps, |stage| radius - stage.position(0)[2]);
    (found, theory(effective, radius, mass, speed))
}

/// Largest overlap, largest force 4/3 E* √R* δ^(3/2), and duration.
fn theory(modulus: f64, radius: f64, mass: f64, speed: f64) -> [f64; 3] {
    let overlap = hertz_overlap(modulus, radius, mass, speed);
    let force = 4.0 / 3.0 * modulus * radius.sqrt() * overlap * overlap.sqrt();
    [overlap, force, hertz_duration(modulus, radius, mass, speed)]
}

/// Holds measured against theory, and theory against the published digits.
#[track_caller]
fn check(run: impl Fn(u64) -> ([f64; 3], [f64; 3]), published: [f64; 3]) {
    for (steps, tolerance) in STEPS {
        let (found, expected) = run(steps);
        for (index, what) in ["largest overlap", "largest force", "duration"].into_iter().enumerate() {
            // the published numbers have five to six digits
            assert_close(expected[index], published[index], 2e-5, what);
            assert_close(found[index], expected[index], tolerance, what);
        }
    }
}

#[test]
fn two_glass_spheres() {
    check(|steps| pair(48e9, 0.20, 2800.0, steps), [274.113e-6, 10.6969e3, 40.339e-6]);
}

#[test]
fn two_limestone_spheres() {
    check(|steps| pair(20e9, 0.25, 2500.0, steps), [368.304e-6, 7.10824e3, 54.201e-6]);
}

#[test]
fn an_aluminium_sphere_and_a_rigid_plane() {
    check(|steps| wall(70e9, 0.30, 2699.0, steps), [49.7172e-6, 11.3699e3, 731.66e-6]);
}

#[test]
fn a_magnesium_sphere_and_a_rigid_plane() {
    check(|steps| wall(40e9, 0.35, 1800.0, steps), [52.1233e-6, 7.23268e3, 767.07e-6]);
}
