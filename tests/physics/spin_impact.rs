//! A spinning sphere that falls on a plane is thrown aside by friction; two that spin against each other are not.
//!
//! Source: set-ups 6 and 7 of Chung & Ooi (2011). While it slides, v_t' = µ (1 + e) v_n and
//! r ω' = r ω − 5/2 µ (1 + e) v_n.

use crate::physics::stage::sphere;
use crate::physics::stage::{
    HERTZ, Stage, assert_close, assert_near, hertz_duration, hit, material, properties, rigid, scene,
};

/// Radius \[m\].
const R: f64 = 0.1;

/// Normal speed \[m/s\].
const SPEED: f64 = 0.2;

#[test]
fn friction_throws_a_spinning_sphere_aside() {
    for (modulus, ratio, density) in [(70e9, 0.33, 2700.0), (2.5e9, 0.40, 1000.0)] {
        for tangent in [8.0, 11.43] {
            let mut body = sphere(R, density);
            body.velocity[2] = -SPEED;
            body.angular_velocity[1] = -SPEED * tangent / R;
            let duration = hertz_duration(modulus / (1.0 - ratio * ratio), R, body.mass(), SPEED);
            let materials = vec![material(modulus, ratio), rigid()];
            let rebound = hit(HERTZ, materials, properties(1.0, 0.4), body, duration, 4000);
            let thrown = 0.4 * 2.0 * SPEED;
            // Sliding begins after the spring has grown to the limit, a few steps in.
            assert_close(-rebound.velocity[0], thrown, 2e-3, "tangential velocity");
            assert_close(rebound.spin[1] + SPEED * tangent / R, 2.5 * thrown / R, 2e-3, "change of angular velocity");
        }
    }
}

#[test]
fn opposite_spins_of_equal_spheres_do_not_slip() {
    for spin in [0.175, 3.0, 22.86] {
        let mut left = sphere(R, 2700.0);
        let mut right = left;
        left.velocity[0] = SPEED;
        right.velocity[0] = -SPEED;
        right.position[0] = 2.0 * R + 1e-7;
        left.angular_velocity[2] = spin;
        right.angular_velocity[2] = -spin;
        let effective = 70e9 / (1.0 - 0.33 * 0.33) / 2.0;
        let step = hertz_duration(effective, R / 2.0, left.mass() / 2.0, 2.0 * SPEED) / 200.0;
        let materials = vec![material(70e9, 0.33)];
        let mut stage = Stage::of(scene(HERTZ, step, materials, properties(0.5, 0.4), vec![left, right]));
        stage.steps(800);
        assert_close(stage.velocity(1)[0], 0.5 * SPEED, 1e-2, "rebound");
        for (body, before) in [(0, spin), (1, -spin)] {
            assert_near(stage.spin(body)[2], before, 1e-13 * spin, "angular velocity");
            assert_near(stage.velocity(body)[1], 0.0, 1e-13 * SPEED, "tangential velocity");
        }
    }
}
