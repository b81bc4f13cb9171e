//! Set-ups 4, 5, 6 and 8 of Chung & Ooi with 200 time steps in a contact: sliding impacts leave the closed forms, sticking ones
//! what the same law leaves with 4000 steps.
//!
//! Source: Y. C. Chung & J. Y. Ooi, *Granular Matter* 13 (2011) 643–656. Sliding throughout, e_t = 1 − µ (1 + e)/tan θ, and
//! r ω' = r ω − 5/2 µ (1 + e) v_n; e is the restitution that was measured, since friction follows the impulse that acted.

use crate::physics::stage::{
    HERTZ, Rebound, Stage, assert_close, assert_near, hertz_duration, hit, material, properties, rigid,
};
use crate::physics::stage::{scene, sphere};
use cograin::contact::{LawChoice, Material, Switches};
use cograin::scene::Particle;

/// Time steps in a contact.
const STEPS: u64 = 200;

/// Time steps in a contact of the runs that sticking impacts are held against.
const CONVERGED: u64 = 4000;

/// Hertz with a tangential spring, no tangential dashpot, and a normal force that never pulls.
const PUSHING: LawChoice =
    LawChoice { switches: Switches { least_force: 0.0, tangential_damping_factor: 0.0, ..HERTZ.switches }, ..HERTZ };

/// A sphere of this material \[Pa, 1\], radius \[m\] and density \[kg/m³\] that meets a rigid plane.
struct Ball {
    /// Young's modulus \[Pa\].
    modulus: f64,
    /// Poisson's ratio.
    ratio: f64,
    /// Radius \[m\].
    radius: f64,
    /// Density \[kg/m³\].
    density: f64,
}

impl Ball {
    /// With this velocity \[m/s\] and this spin about y \[rad/s\].
    fn thrown(&self, velocity: [f64; 3], spin: f64) -> Particle {
        let mut body = sphere(self.radius, self.density);
        body.velocity = velocity;
        body.angular_velocity[1] = spin;
        body
    }

    /// Of ball and plane.
    fn materials(&self) -> Vec<Material> {
        vec![material(self.modulus, self.ratio), rigid()]
    }

    /// What it leaves the plane with.
    fn hit(&self, law: LawChoice, [restitution, friction]: [f64; 2], body: Particle, steps: u64) -> Rebound {
        let effective = self.modulus / (1.0 - self.ratio * self.ratio);
        let duration = hertz_duration(effective, self.radius, body.mass(), -body.velocity[2]);
        hit(law, self.materials(), properties(restitution, friction), body, duration, steps)
    }
}

/// Aluminium oxide of set-up 4.
const OXIDE: Ball = Ball { modulus: 380e9, ratio: 0.23, radius: 0.0025, density: 4000.0 };

/// Steel and polyethylene of set-up 5.
const SMALL: [Ball; 2] = [
    Ball { modulus: 208e9, ratio: 0.30, radius: 1e-5, density: 7850.0 },
    Ball { modulus: 1e9, ratio: 0.40, radius: 1e-5, density: 1400.0 },
];

/// Aluminium alloy and nylon of set-ups 6 and 8.
const LARGE: [Ball; 2] = [
    Ball { modulus: 70e9, ratio: 0.33, radius: 0.1, density: 2700.0 },
    Ball { modulus: 2.5e9, ratio: 0.40, radius: 0.1, density: 1000.0 },
];

/// Speed \[m/s\], restitution and friction of set-up 4.
const OXIDE_IMPACT: (f64, [f64; 2]) = (3.9, [0.98, 0.092]);

/// Velocity at this angle to the normal \[°\] \[m/s\].
fn at_angle(angle: f64) -> [f64; 3] {
    let (sine, cosine) = angle.to_radians().sin_cos();
    [OXIDE_IMPACT.0 * sine, 0.0, -OXIDE_IMPACT.0 * cosine]
}

#[test]
fn set_up_4_slides_as_the_closed_form_says() {
    for angle in [40.0, 50.0, 60.0, 70.0, 80.0] {
        let (velocity, friction) = (at_angle(angle), OXIDE_IMPACT.1[1]);
        let rebound = OXIDE.hit(PUSHING, OXIDE_IMPACT.1, OXIDE.thrown(velocity, 0.0), STEPS);
        let measured = -rebound.velocity[2] / velocity[2];
        let lost = friction * (1.0 + measured) * -velocity[2];
        assert_close(rebound.velocity[0] / velocity[0], 1.0 - lost / velocity[0], 2e-3, "tangential restitution");
        assert_close(rebound.spin[1] * OXIDE.radius, 2.5 * lost, 2e-3, "spin");
    }
}

#[test]
fn set_up_4_sticks_as_the_law_does_with_small_steps() {
    for angle in [5.0, 10.0, 20.0, 25.0] {
        let [coarse, fine] =
            [STEPS, CONVERGED].map(|steps| OXIDE.hit(HERTZ, OXIDE_IMPACT.1, OXIDE.thrown(at_angle(angle), 0.0), steps));
        assert_close(coarse.velocity[0], fine.velocity[0], 1e-2, "tangential velocity");
        assert_close(coarse.spin[1], fine.spin[1], 1e-2, "angular velocity");
    }
}

#[test]
fn set_up_5_collapses_where_it_slides_and_converges_where_it_sticks() {
    let (friction, speed) = (0.3, 5.0);
    for ball in &SMALL {
        let run = |psi: f64, steps| {
            let body = ball.thrown([psi * friction * speed, 0.0, -speed], 0.0);
            let rebound = ball.hit(HERTZ, [1.0, friction], body, steps);
            let unit = friction * speed;
            let spin = ball.radius * rebound.spin[1] / unit;
            [rebound.velocity[0] / unit - spin, spin]
        };
        for psi in [1.0, 2.0, 4.0] {
            let [coarse, fine] = [STEPS, CONVERGED].map(|steps| run(psi, steps));
            assert_near(coarse[0], fine[0], 1e-2 * psi, "slip after");
            assert_near(coarse[1], fine[1], 1e-2 * psi, "spin after");
        }
    }
    // Steel is hard enough for the arm to be the radius: the overlap is 1 % of it.
    let body = SMALL[0].thrown([9.0 * friction * speed, 0.0, -speed], 0.0);
    let rebound = SMALL[0].hit(HERTZ, [1.0, friction], body, STEPS);
    assert_close(rebound.velocity[0] / (friction * speed), 9.0 - 2.0, 1e-2, "tangential velocity");
    assert_close(SMALL[0].radius * rebound.spin[1] / (friction * speed), 5.0, 1e-2, "spin after");
}

#[test]
fn set_up_6_returns_the_spin_of_the_closed_form() {
    let speed = 0.2;
    for ball in &LARGE {
        for tangent in [8.0, 11.43, 20.0] {
            let body = ball.thrown([0.0, 0.0, -speed], speed * tangent / ball.radius);
            let rebound = ball.hit(PUSHING, [0.5, 0.4], body, STEPS);
            let measured = rebound.velocity[2] / speed;
            // velocity of the surface after over before
            let surface = rebound.velocity[0] - ball.radius * rebound.spin[1];
            let returned = surface / (speed * tangent);
            assert_close(returned, -1.0 + 3.5 * 0.4 * (1.0 + measured) / tangent, 5e-3, "tangential restitution");
        }
    }
}

#[test]
fn set_up_8_falls_on_set_up_6() {
    let (speed, tangent) = (0.2, 11.43);
    for ball in &LARGE {
        let spin = speed * tangent / ball.radius;
        let alone = ball.hit(PUSHING, [0.5, 0.4], ball.thrown([0.0, 0.0, -speed], spin), CONVERGED);
        // The other sphere is five times as large, hard and heavy beyond comparison: E and density are 1000 times larger.
        let mut large = sphere(5.0 * ball.radius, 1e3 * ball.density);
        let mut small = ball.thrown([0.0, 0.0, -speed], spin);
        let effective = ball.modulus / (1.0 - ball.ratio * ball.ratio) / 1.001;
        let duration = hertz_duration(effective, ball.radius / 1.2, small.mass(), speed);
        let step = duration / STEPS as f64;
        small.position[2] = ball.radius + 0.5 * step * speed;
        large.position[2] = -5.0 * ball.radius;
        large.material = cograin::quantity::MaterialIndex(1);
        let materials = vec![material(ball.modulus, ball.ratio), material(1e3 * ball.modulus, ball.ratio)];
        let mut stage = Stage::of(scene(PUSHING, step, materials, properties(0.5, 0.4), vec![small, large]));
        stage.steps(2 * STEPS);
        assert_close(stage.velocity(0)[2], alone.velocity[2], 1e-2, "rebound");
        assert_close(stage.velocity(0)[0], alone.velocity[0], 1e-2, "tangential velocity");
        assert_close(stage.spin(0)[1], alone.spin[1], 1e-2, "angular velocity");
    }
}
