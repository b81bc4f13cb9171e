//! Cundall's damping: an oscillation decays by (1 − a)/(1 + a) each cycle with a period that is a little long, and a
//! free fall is slowed where gravity comes before the damping.
//!
//! Source: P. A. Cundall, *Analytical and Computational Methods in Engineering Rock Mechanics* (1987), chapter 4;
//! half a cycle under k (1 − a), half under k (1 + a): T/T₀ = ½ (1/√(1 − a) + 1/√(1 + a)).

use crate::physics::stage::{SMOOTH, SPRING, Stage, assert_close, material, plane, properties, scene, sphere};
use cograin::contact::property;
use cograin::scene::{Damping, SceneDraft};
use std::f64::consts::PI;

/// Damping of every particle by these fractions.
pub(crate) fn damping(scene: &SceneDraft, linear: f64, angular: f64, gravity_damped: bool) -> Vec<Damping> {
    let each = |fraction: f64| vec![fraction; scene.particles.len()];
    let (linear, angular) = (each(linear), each(angular));
    vec![Damping {
        name: "cundall".into(),
        linear,
        angular,
        newcomers: [0.0; 2],
        gravity_damped,
        applied_forces_damped: false,
    }]
}

/// Gravity \[m/s²\].
const G: f64 = 9.81;

/// Lowest positions \[m\] above the rest position and their times \[s\], of a sphere on a spring under gravity.
fn low_points(fraction: f64) -> Vec<(f64, f64)> {
    let mut body = sphere(0.005, 2500.0);
    let stiffness = 1000.0;
    let rest = body.mass() * G / stiffness;
    body.position[2] = 0.005 - 1.9 * rest;
    let pair = properties(1.0, 0.0).with(&property::NORMAL_STIFFNESS, stiffness).with(&property::NORMAL_DAMPING, 0.0);
    let period = 2.0 * PI * (body.mass() / stiffness).sqrt();
    let mut scene = scene(SPRING, period / 5000.0, vec![material(1e7, 0.0)], pair, vec![body]);
    scene.gravity = [0.0, 0.0, -G];
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 0)];
    scene.damping = damping(&scene, fraction, 0.0, true);
    let mut stage = Stage::of(scene);
    let height = |stage: &Stage| stage.position(0)[2] - (0.005 - rest);
    let mut points = vec![(height(&stage), 0.0)];
    let mut last = [height(&stage); 2];
    while points.len() < 4 {
        stage.steps(1);
        let now = height(&stage);
        if last[1] < last[0] && last[1] < now {
            points.push((last[1], stage.simulation.time() - stage.step));
        }
        last = [last[1], now];
    }
    points
}

#[test]
fn an_oscillation_decays_by_the_ratio_of_its_two_stiffnesses() {
    for fraction in [0.1, 0.3, 0.5] {
        for two in low_points(fraction).windows(2) {
            let expected = (1.0 - fraction) / (1.0 + fraction);
            // The sign of the velocity turns inside a step: one part in 5000 steps of a cycle.
            assert_close(two[1].0 / two[0].0, expected, 2e-3, "ratio of amplitudes");
        }
    }
}

#[test]
fn the_period_is_that_of_the_two_stiffnesses() {
    for fraction in [0.1_f64, 0.3, 0.5] {
        let points = low_points(fraction);
        let mass = sphere(0.005, 2500.0).mass();
        let free = 2.0 * PI * (mass / 1000.0).sqrt();
        let longer = 0.5 * (1.0 / (1.0 - fraction).sqrt() + 1.0 / (1.0 + fraction).sqrt());
        // Times of low points are known to a step: 2/5000 over three cycles.
        assert_close(points[3].1 / 3.0, longer * free, 1e-3, "period");
    }
}

/// Vertical velocity \[m/s\] after 0.1 s of free flight that began at this one.
fn flight(start: f64, gravity_damped: bool) -> f64 {
    let mut body = sphere(0.005, 2500.0);
    body.velocity[2] = start;
    let mut scene = scene(SMOOTH, 1e-4, vec![material(1e7, 0.0)], properties(1.0, 0.0), vec![body]);
    scene.gravity = [0.0, 0.0, -G];
    scene.damping = damping(&scene, 0.3, 0.0, gravity_damped);
    let mut stage = Stage::of(scene);
    stage.steps(1000);
    stage.velocity(0)[2]
}

#[test]
fn a_fall_is_slowed_and_a_rise_is_braked_where_gravity_is_damped() {
    assert_close(flight(0.0, true), -0.7 * G * 0.1, 1e-12, "fall from rest");
    assert_close(flight(-1.0, true), -1.0 - 0.7 * G * 0.1, 1e-12, "fall");
    assert_close(flight(3.0, true), 3.0 - 1.3 * G * 0.1, 1e-12, "rise");
}

#[test]
fn a_flight_is_free_where_gravity_is_not() {
    assert_close(flight(0.0, false), -G * 0.1, 1e-12, "fall");
    assert_close(flight(3.0, false), 3.0 - G * 0.1, 1e-12, "rise");
}
