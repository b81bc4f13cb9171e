//! Courses of spheres in drums of facets and over bends.

use super::scenes::{DRUM, G, Law, MASS, MESH, RADIUS, ROUGH, SMOOTH, start};
use crate::support::Triangle;
use std::f64::consts::{PI, TAU};

/// The exact drum.
const CYLINDER: &str =
    "cylinder = { from = [0.0, -0.02, 0.0], to = [0.0, 0.02, 0.0], radius = 0.05, infinite = true }\n";

/// The drum as this many facets, of which in- and circumscribed radius have its radius as their mean; a facet begins at this share
/// of its angle from the bottom.
fn drum(count: u32, phase: f64) -> Vec<Triangle> {
    let angle = TAU / f64::from(count);
    let radius = DRUM * 2.0 / (1.0 + (0.5 * angle).cos());
    let at = |number: u32, y: f64| {
        let (sine, cosine) = (angle * (f64::from(number % count) + phase)).sin_cos();
        [radius * sine, y, -radius * cosine]
    };
    let facet = |number: u32| {
        let (a, b) = (at(number, -0.02), at(number + 1, -0.02));
        let (c, d) = (at(number + 1, 0.02), at(number, 0.02));
        [[a, b, c], [a, c, d]]
    };
    (0..count).flat_map(facet).collect()
}

/// A sphere at rest in the drum, so many degrees from the bottom, pressed in as by its weight.
fn released(degrees: f64) -> [[f64; 3]; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let modulus = 5.0e6 / (1.0 - 0.3 * 0.3) / 2.0;
    let overlap = (MASS * G * cosine / (4.0 / 3.0 * modulus * RADIUS.sqrt())).powf(2.0 / 3.0);
    let out = DRUM - RADIUS + overlap;
    [[out * sine, 0.0, -out * cosine], [0.0; 3]]
}

/// What is compared of a course: place over R, spin · R, torque of friction.
type Seen = [[f64; 3]; 3];

/// The course of a sphere in a drum, every 20th step over 0.3 s.
fn course(degrees: f64, law: Law, wall: &str, mesh: &[Triangle]) -> Vec<Seen> {
    let mut simulation = start(&[released(degrees)], law, [0.0, 0.0, -G], 1e-5, wall, mesh);
    let look = |_| {
        simulation.advance(20.0 * 1e-5).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        let three = |row: [f64; 4], scale: f64| [0, 1, 2].map(|axis| row[axis] * scale);
        let [place, spin] = [particles.position[0], particles.angular_velocity[0]];
        [three(place, 1.0 / RADIUS), three(spin, RADIUS), three(particles.torque[0], 1.0)]
    };
    (0..1500).map(look).collect()
}

/// Largest difference of two courses, of each thing seen.
fn apart(one: &[Seen], other: &[Seen]) -> [f64; 3] {
    let length = |a: [f64; 3], b: [f64; 3]| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    [0, 1, 2].map(|part| one.iter().zip(other).map(|(a, b)| length(a[part], b[part])).fold(0.0, f64::max))
}

/// Largest difference from the exact drum with so many facets, over four phases.
fn facets(degrees: f64, law: Law, exact: &[Seen], count: u32) -> [f64; 3] {
    let phase = |quarter: u32| apart(&course(degrees, law, MESH, &drum(count, 0.25 * f64::from(quarter))), exact);
    (0..4).map(phase).fold([0.0; 3], |most, found| [0, 1, 2].map(|part| most[part].max(found[part])))
}

#[test]
fn a_sphere_in_a_drum_of_facets_goes_the_way_of_the_cylinder() {
    // mesh-contact, row d: worst of 4 phases 0.19, 0.056, 0.020, 0.0065 of the radius.
    let exact = course(40.0, SMOOTH, CYLINDER, &[]);
    let errors = [64, 512].map(|count| facets(40.0, SMOOTH, &exact, count)[0]);
    let order = (errors[0] / errors[1]).log2() / 3.0;
    assert!(order >= 1.4, "order {order} of {errors:?}");
    assert!(errors[1] <= 0.01, "{} R at 512 facets", errors[1]);
}

#[test]
fn a_sphere_that_rolls_over_bends_keeps_spring_and_spin() {
    let exact = course(20.0, ROUGH, CYLINDER, &[]);
    let most = |part: usize| {
        exact.iter().map(|seen| seen[part].iter().map(|it| it * it).sum::<f64>().sqrt()).fold(0.0, f64::max)
    };
    let [place, spin, torque] = facets(20.0, ROUGH, &exact, 512);
    assert!(place <= 0.01, "{place} R");
    assert!(spin <= 0.01 * most(1), "spin: {} of its largest", spin / most(1));
    // A spring that is forgotten at a bend loses the whole torque there.
    assert!(torque <= 0.05 * most(2), "torque: {} of its largest", torque / most(2));
}

#[test]
fn rolling_resistance_holds_a_sphere_on_the_slope_of_a_turning_drum() {
    // Slip is 0 and the moments about the contact balance: tan θ = µ_r R/(R − δ/2), spin Ω (C + δ/2)/(R − δ/2).
    let law = ([0.3, 0.5, 0.1], "[contact.touch.tangential.history]\n[contact.touch.rolling.cdt]\n");
    let wall =
        format!("{MESH}reference = [0.0, 0.0, 0.0]\nmotion = {{ prescribed = {{ \"rotation.y\" = {PI:?} }} }}\n");
    let mut simulation = start(&[released(-5.7)], law, [0.0, 0.0, -G], 2e-5, &wall, &drum(180, 0.0));
    simulation.advance(0.3).unwrap_or_else(|error| panic!("{error}"));
    // It swings a little about that slope, and the resistance, which has always the same direction, does not damp it: means over four periods.
    let period = TAU * (1.4 * (DRUM - RADIUS) / G).sqrt();
    let count = (4.0 * period / 4e-4).round() as u32;
    let (mut slope, mut spin) = (0.0, 0.0);
    for _ in 0..count {
        simulation.advance(4e-4).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        let [x, _, z, _] = particles.position[0];
        slope += x / z / f64::from(count);
        spin += particles.angular_velocity[0][1] / f64::from(count);
    }
    let overlap = 13.5e-6;
    let expected = 0.1 * RADIUS / (RADIUS - 0.5 * overlap);
    assert!((slope / expected - 1.0).abs() < 0.02, "tan θ = {slope}, not {expected}");
    let expected = PI * (DRUM + 0.5 * overlap) / (RADIUS - 0.5 * overlap);
    assert!((spin / expected - 1.0).abs() < 0.002, "{spin} rad/s, not {expected} rad/s");
}
