//! Oblique impacts leave the velocities of the closed forms where the sphere slides all the time, and the converged
//! values of this law where it sticks.
//!
//! Source: set-ups 4 and 5 of Chung & Ooi (2011) with the parameters of A. H. Kharaz, D. A. Gorham & A. D. Salman,
//! *Powder Technol.* 120 (2001) 281–291; gross sliding: e_t = 1 − µ (1 + e)/tan θ, r ω' = −5/2 µ (1 + e) v_n.

use crate::physics::stage::{
    HERTZ, Rebound, assert_close, assert_near, hertz_duration, hit, material, properties, rigid, sphere,
};

/// Radius \[m\].
const R: f64 = 0.0025;

/// Time steps in a contact.
const STEPS: u64 = 4000;

/// An aluminium oxide sphere meets a rigid plane at 3.9 m/s, this angle \[°\] from the normal; e = 0.98, µ = 0.092.
fn oxide(angle: f64) -> (Rebound, f64, f64) {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let mut body = sphere(R, 4000.0);
    body.velocity = [3.9 * sine, 0.0, -3.9 * cosine];
    let modulus = 380e9 / (1.0 - 0.23 * 0.23);
    let duration = hertz_duration(modulus, R, body.mass(), 3.9 * cosine);
    let materials = vec![material(380e9, 0.23), rigid()];
    (hit(HERTZ, materials, properties(0.98, 0.092), body, duration, STEPS), 3.9 * sine, 3.9 * cosine)
}

#[test]
fn sliding_impacts_lose_the_friction_of_the_normal_impulse() {
    for angle in [40.0, 50.0, 60.0, 80.0] {
        let (rebound, tangential, normal) = oxide(angle);
        let lost = 0.092 * 1.98 * normal;
        // The attractive end of the contact pushes back, and rubs as if it pressed: 3e-3 of the friction at e = 0.98.
        assert_near(rebound.velocity[0], tangential - lost, 5e-3 * lost, "tangential velocity");
        assert_near(rebound.spin[1], 2.5 * lost / R, 5e-3 * 2.5 * lost / R, "angular velocity");
    }
}

#[test]
fn sticking_impacts_have_the_converged_values_of_a_spring_with_the_present_stiffness() {
    // Forces that grow by increments of k_t ds have 0.8890, −37.7 and 0.6120, −517.6 here.
    for (angle, ratio, spin) in [(5.0, 0.950, 17.0), (20.0, 0.6218, 503.7)] {
        let (rebound, tangential, _) = oxide(angle);
        assert_near(rebound.velocity[0] / tangential, ratio, 5e-4, "tangential restitution");
        assert_close(rebound.spin[1], spin, 5e-3, "angular velocity");
    }
}

#[test]
fn elastic_sliding_impacts_collapse_on_one_line() {
    // Steel and polyethylene, 5 m/s along the normal, radius 10 µm, e = 1, µ = 0.3; ψ = v_t/(µ v_n):
    // at the surface ψ' = ψ − 7, r ω'/(µ v_n) = −5.
    let (radius, friction, speed) = (1e-5, 0.3, 5.0);
    for (modulus, ratio, density) in [(208e9, 0.30, 7850.0), (1e9, 0.40, 1400.0)] {
        for psi in [7.0, 9.0, 14.0] {
            let mut body = sphere(radius, density);
            body.velocity = [psi * friction * speed, 0.0, -speed];
            let effective = modulus / (1.0 - ratio * ratio);
            let duration = hertz_duration(effective, radius, body.mass(), speed);
            let materials = vec![material(modulus, ratio), rigid()];
            let rebound = hit(HERTZ, materials, properties(1.0, friction), body, duration, STEPS);
            let unit = friction * speed;
            let surface = (rebound.velocity[0] - radius * rebound.spin[1]) / unit;
            // The arm is half an overlap short of the radius: up to 2 % for the soft sphere.
            let margin = 7.0
                * crate::physics::stage::hertz_overlap(effective, radius, sphere(radius, density).mass(), speed)
                / radius;
            assert_near(surface, psi - 7.0, margin.max(5e-3), "slip after");
            assert_near(radius * rebound.spin[1] / unit, 5.0, margin.max(5e-3), "spin after");
        }
    }
}
