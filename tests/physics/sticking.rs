//! Sticky spheres part with the work that the theory says.
//!
//! Sources: C. Thornton & Z. Ning, *Powder Technol.* 99 (1998) 154–162: the work 7.09 (Γ⁵ R*⁴/E*²)^(1/3) and the sticking speed that
//! follows from it, Γ = 2 γ. A contact that ends at the largest pull does half of this work.

use crate::support::start;
use std::f64::consts::PI;

/// Radius of the sphere \[m\].
const RADIUS: f64 = 1e-3;

/// Young's modulus and Poisson's ratio of sphere and plane, surface energy γ \[J/m²\].
const MATERIAL: [f64; 3] = [1e7, 0.3, 0.05];

/// Density \[kg/m³\].
const DENSITY: f64 = 2500.0;

/// (Γ⁵ R*⁴/E*²)^(1/3) \[J\].
fn scale(radius: f64) -> f64 {
    let [modulus, ratio, energy] = MATERIAL;
    let modulus = modulus / (2.0 * (1.0 - ratio * ratio));
    ((2.0 * energy).powi(5) * radius.powi(4) / (modulus * modulus)).cbrt()
}

/// Mass of the sphere \[kg\].
fn mass(radius: f64) -> f64 {
    DENSITY * 4.0 / 3.0 * PI * radius.powi(3)
}

/// The sticking speed of theory \[m/s\].
fn sticking(radius: f64) -> f64 {
    (2.0 * 7.09 * scale(radius) / mass(radius)).sqrt()
}

/// Speed with which a sphere leaves that came with this one \[m/s\]; 0 where it stays.
fn rebound(tear_off: &str, speed: f64) -> f64 {
    rebound_of(RADIUS, "step = 2e-8", tear_off, speed)
}

/// The same of a sphere of this radius \[m\], with the time step of this line.
fn rebound_of(radius: f64, step: &str, tear_off: &str, speed: f64) -> f64 {
    let [modulus, ratio, energy] = MATERIAL;
    let text = format!(
        "[run]\n{step}\nthreads = 1\n[material.a]\ndensity = {DENSITY}\nyoungs_modulus = {modulus:?}\npoissons_ratio = {ratio}\n\
         [pair.a.a]\nsurface_energy = {energy}\ndamping_coefficient = 0.0\n[contact.c.normal.jkr]\ntear_off = \"{tear_off}\"\n\
         [particles.p]\nmaterial = \"a\"\n\
         list = [{{ position = [0.0, 0.0, {:?}], radius = {radius:?}, velocity = [0.0, 0.0, {:?}] }}]\n\
         [boundary.floor]\nmaterial = \"a\"\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\n\
         [output]\nlosses = true\n",
        (1.0 + 1e-5) * radius,
        -speed
    );
    let mut simulation = start(&text);
    for _ in 0..200 {
        simulation.advance(0.1 * radius).expect("it moves slowly");
        let ([_, _, z, _], [_, _, w, _]) =
            (simulation.state().particles.position[0], simulation.state().particles.velocity[0]);
        if z > 1.03 * radius {
            assert!(w > 0.0);
            return w;
        }
    }
    0.0
}

#[test]
fn spheres_part_with_the_whole_work_of_separation_where_the_branch_is_followed() {
    let (sticking, work) = (sticking(RADIUS), 7.09 * scale(RADIUS));
    let fast = 1.5 * sticking;
    let lost = 0.5 * mass(RADIUS) * (fast * fast - rebound("whole_branch", fast).powi(2));
    assert!((lost / work - 1.0).abs() < 0.01, "{lost:e} J, {work:e} J by theory");
    assert_eq!(rebound("whole_branch", 0.985 * sticking), 0.0);
    assert!(rebound("whole_branch", 1.015 * sticking) > 0.0);
}

#[test]
fn the_automatic_step_is_as_accurate_near_sticking_as_it_says() {
    // The smallest of them pull themselves into the plane deeper than a hundredth of the radius: their step followed no accuracy.
    let theory = (1.0_f64 - 1.0 / 1.5_f64.powi(2)).sqrt();
    for radius in [1e-3, 1e-4, 1e-5] {
        let fast = 1.5 * sticking(radius);
        for (line, accuracy) in [("", 0.01), ("accuracy = \"high\"", 0.001)] {
            let found = rebound_of(radius, line, "whole_branch", fast) / fast;
            // Theory has three digits.
            assert!((found - theory).abs() < accuracy + 0.001, "{radius:e} m, {line}: {found}, {theory} by theory");
        }
    }
}

#[test]
fn at_the_largest_pull_half_of_it_is_missing() {
    // ∫ F dδ from touch to the largest pull: with a³ = c x³, c = π γ R*²/E*, in units of E* c^(5/3)/R*²:
    // U = 8/15 x⁵ − 8/3 x^(7/2) + 2 x², from x³ = 4 to 9/4.
    let (radius, [modulus, ratio, energy]) = (RADIUS, MATERIAL);
    let modulus = modulus / (2.0 * (1.0 - ratio * ratio));
    let c = PI * energy * radius * radius / modulus;
    let held = |cube: f64| {
        let x = cube.cbrt();
        8.0 / 15.0 * x.powi(5) - 8.0 / 3.0 * x.powf(3.5) + 2.0 * x * x
    };
    let work = (held(2.25) - held(4.0)) * modulus * c.cbrt().powi(5) / (radius * radius);
    let speed = 1.5 * sticking(RADIUS);
    let lost = 0.5 * mass(RADIUS) * (speed * speed - rebound("largest_pull", speed).powi(2));
    assert!((lost / work - 1.0).abs() < 0.01, "{lost:e} J, {work:e} J by theory");
    assert!((work / (7.09 * scale(RADIUS)) - 0.494).abs() < 0.001);
}
