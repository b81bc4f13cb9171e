//! Which body is called i and which j, and in which order a scene lists them, is of no consequence.

use crate::physics::momentum::{cloud, whole_law};
use crate::physics::stage::{Stage, assert_near, material, scene};
use cograin::scene::Particle;

/// Runs these bodies for a while.
fn run(bodies: Vec<Particle>, steps: u64) -> Stage {
    let (law, pair) = whole_law();
    let mut stage = Stage::of(scene(law, 5e-6, vec![material(1e7, 0.3)], pair, bodies));
    stage.steps(steps);
    stage
}

#[test]
fn two_bodies_exchanged_do_the_same() {
    let bodies = cloud();
    let mut two = vec![bodies[0], bodies[1]];
    two[1].position = [two[0].position[0] + 0.0084, two[0].position[1] + 0.001, two[0].position[2]];
    let one = run(two.clone(), 600);
    two.reverse();
    let other = run(two, 600);
    let moved = one.velocity(0)[1] - bodies[0].velocity[1];
    assert!(moved.abs() > 1e-3, "they have not met: {moved:e}");
    for axis in 0..3 {
        for body in 0..2 {
            let (velocity, spin) = (one.velocity(body)[axis], one.spin(body)[axis]);
            assert_near(other.velocity(1 - body)[axis], velocity, 1e-12, "velocity");
            assert_near(other.spin(1 - body)[axis], spin, 1e-12 * 40.0, "angular velocity");
        }
    }
}

#[test]
fn a_cloud_listed_backwards_does_the_same() {
    let bodies = cloud();
    let count = bodies.len();
    let one = run(bodies.clone(), 600);
    let other = run(bodies.into_iter().rev().collect(), 600);
    for body in 0..count {
        for axis in 0..3 {
            // Collisions magnify rounding by the free path over the radius each: a few of them in this time.
            let velocity = one.velocity(body)[axis];
            assert_near(other.velocity(count - 1 - body)[axis], velocity, 1e-11, "velocity");
        }
    }
}
