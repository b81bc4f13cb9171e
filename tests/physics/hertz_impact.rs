//! A Hertz impact has the largest overlap, the largest force and the duration of the theory.
//!
//! Source: K. L. Johnson, *Contact Mechanics* (1985), section 11.4; set-ups 1 and 2 of Y. C. Chung & J. Y. Ooi,
//! *Granular Matter* 13 (2011) 643–656.

use crate::stage::{SMOOTH, Stage, assert_close, hertz_duration, hertz_overlap, material, plane, properties, rigid};
use crate::stage::{scene, sphere};
use std::f64::consts::PI;

/// Time steps in a contact.
const STEPS: u64 = 2000;

/// The largest value is looked for at steps: it may be missed by 1 − cos(π/2/2000) < 1e-6, and the step itself errs
/// by about as much.
const PEAK: f64 = 5e-6;

/// First and last step of the contact are known to one step each.
const DURATION: f64 = 2.0 / STEPS as f64;

/// Largest overlap \[m\], largest force \[N\] and duration \[s\] of a running impact.
fn measure(mut stage: Stage, overlap: impl Fn(&Stage) -> f64) -> [f64; 3] {
    let mut found = [0.0_f64; 3];
    for _ in 0..STEPS + 10 {
        stage.steps(1);
        let depth = overlap(&stage);
        if depth > 0.0 {
            let [x, y, z] = stage.force(0);
            found[0] = found[0].max(depth);
            found[1] = found[1].max((x * x + y * y + z * z).sqrt());
            found[2] += stage.step;
        }
    }
    found
}

/// Two equal spheres of radius 10 mm meet at 10 m/s each.
fn pair(modulus: f64, ratio: f64, density: f64) -> ([f64; 3], [f64; 3]) {
    let (radius, speed) = (0.01, 20.0);
    let mass = 4.0 / 3.0 * PI * radius * radius * radius * density / 2.0;
    let effective = modulus / (1.0 - ratio * ratio) / 2.0;
    let step = hertz_duration(effective, radius / 2.0, mass, speed) / STEPS as f64;
    let mut left = sphere(radius, density);
    let mut right = left;
    left.velocity[0] = 10.0;
    right.velocity[0] = -10.0;
    right.position[0] = 2.0 * radius;
    let materials = vec![material(modulus, ratio)];
    let stage = Stage::of(scene(SMOOTH, step, materials, properties(1.0, 0.0), vec![left, right]));
    let found = measure(stage, |stage| 2.0 * radius - (stage.position(1)[0] - stage.position(0)[0]));
    (found, theory(effective, radius / 2.0, mass, speed))
}

/// A sphere of radius 0.1 m meets a rigid plane at 0.2 m/s.
fn wall(modulus: f64, ratio: f64, density: f64) -> ([f64; 3], [f64; 3]) {
    let (radius, speed) = (0.1, 0.2);
    let mass = 4.0 / 3.0 * PI * radius * radius * radius * density;
    let effective = modulus / (1.0 - ratio * ratio);
    let step = hertz_duration(effective, radius, mass, speed) / STEPS as f64;
    let mut body = sphere(radius, density);
    body.velocity[2] = -speed;
    body.position[2] = radius;
    let mut scene = scene(SMOOTH, step, vec![material(modulus, ratio), rigid()], properties(1.0, 0.0), vec![body]);
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    let found = measure(Stage::of(scene), |stage| radius - stage.position(0)[2]);
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
fn check((found, expected): ([f64; 3], [f64; 3]), published: [f64; 3]) {
    for (index, what) in ["largest overlap", "largest force", "duration"].into_iter().enumerate() {
        // the published numbers have five to six digits
        assert_close(expected[index], published[index], 2e-5, what);
        assert_close(found[index], expected[index], [PEAK, PEAK, DURATION][index], what);
    }
}

#[test]
fn two_glass_spheres() {
    check(pair(48e9, 0.20, 2800.0), [274.113e-6, 10.6969e3, 40.339e-6]);
}

#[test]
fn two_limestone_spheres() {
    check(pair(20e9, 0.25, 2500.0), [368.304e-6, 7.10824e3, 54.201e-6]);
}

#[test]
fn an_aluminium_sphere_and_a_rigid_plane() {
    check(wall(70e9, 0.30, 2699.0), [49.7172e-6, 11.3699e3, 731.66e-6]);
}

#[test]
fn a_magnesium_sphere_and_a_rigid_plane() {
    check(wall(40e9, 0.35, 1800.0), [52.1233e-6, 7.23268e3, 767.07e-6]);
}
