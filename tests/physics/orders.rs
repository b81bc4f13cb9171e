//! With which power of the time step the error of each scheme falls, against a converged run of the same scheme.
//!
//! `cargo test --test physics orders -- --nocapture` prints the errors.

use crate::physics::stage::{HERTZ, Stage, hertz_duration, material, plane, properties, scene, sphere};
use cograin::contact::rolling::rocking;
use cograin::contact::{LawChoice, Properties, RollingModel, Scheme, property, rolling};
use cograin::scene::{AppliedForce, SceneDraft};

/// Radius of all spheres \[m\].
const R: f64 = 5e-3;

/// Coefficient of rolling friction: never reached.
const ROLLING: f64 = 0.5;

/// One motion, for a time, with a wanted number of steps.
pub(super) struct Case {
    /// What is claimed of it.
    pub(super) name: &'static str,
    /// The scene of phase 0 to 1, without its step.
    pub(super) scene: fn(Scheme, f64) -> SceneDraft,
    /// How long it runs \[s\].
    pub(super) time: f64,
    /// Coarsest number of steps; three halvings follow.
    pub(super) steps: u64,
    /// How many phases.
    pub(super) phases: u32,
}

/// Velocities and spins of all spheres at the end, as speeds \[m/s\].
fn end(case: &Case, scheme: Scheme, phase: f64, steps: u64) -> Vec<f64> {
    let mut scene = (case.scene)(scheme, phase);
    let count = scene.particles.len();
    scene.run.step = cograin::scene::Step::Given(case.time / steps as f64);
    scene.run.allow_unstable = true;
    let mut stage = Stage::of(scene);
    stage.steps(steps);
    let of = |particle| [stage.velocity(particle), stage.spin(particle).map(|part| part * R)].concat();
    (0..count).flat_map(of).collect()
}

/// Errors with n, 2n, 4n and 8n steps, root mean square over the phases \[m/s\].
fn errors(case: &Case, scheme: Scheme) -> [f64; 4] {
    let mut squares = [0.0; 4];
    for phase in 0..case.phases {
        // Golden section: no phase is special.
        let phase = (f64::from(phase) * 0.618_033_988_749_895).fract();
        let converged = end(case, scheme, phase, 32 * case.steps);
        for (halving, square) in squares.iter_mut().enumerate() {
            let found = end(case, scheme, phase, case.steps << halving);
            *square += found.iter().zip(&converged).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        }
    }
    squares.map(|square| (square / f64::from(case.phases)).sqrt())
}

/// The order over three halvings, printed with the errors.
#[allow(clippy::print_stdout, reason = "the figures of docs/physics.md are what this test prints with --nocapture")]
pub(super) fn order(case: &Case, scheme: Scheme) -> f64 {
    let errors = errors(case, scheme);
    let order = (errors[0] / errors[3]).log2() / 3.0;
    let each = [0, 1, 2].map(|at| (errors[at] / errors[at + 1]).log2());
    let errors = errors.map(|error| format!("{error:.2e}")).join(" ");
    println!("{:36} {:9} {errors}   order {order:.2}, {each:.2?}", case.name, scheme.name());
    order
}

/// The law of all cases.
fn law(scheme: Scheme) -> LawChoice {
    LawChoice { scheme, ..HERTZ }
}

/// Young's modulus of the softer pairs \[Pa\]: the normal turns more.
const SOFT: f64 = 1e6;

/// A sphere that meets a plane 10° off its normal, and sticks.
fn stick_on_a_plane(scheme: Scheme, phase: f64) -> SceneDraft {
    let (sine, cosine) = 10.0_f64.to_radians().sin_cos();
    let mut body = sphere(R, 2500.0);
    body.position[2] = R + 1e-4 * phase;
    body.velocity = [sine, 0.2 * sine, -cosine];
    let mut scene = scene(law(scheme), 1.0, vec![material(1e7, 0.3); 2], properties(1.0, 2.0), vec![body]);
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    scene
}

/// Two spheres that meet obliquely and stick, with this spin \[rad/s\].
fn stuck_pair(scheme: Scheme, phase: f64, spin: [f64; 3]) -> SceneDraft {
    let (sine, cosine) = 20.0_f64.to_radians().sin_cos();
    let (mut one, mut other) = (sphere(R, 2500.0), sphere(R, 2500.0));
    one.position[2] = 2.0 * R + 1e-4 * phase;
    one.velocity = [sine, 0.1, -cosine];
    one.angular_velocity = spin;
    other.angular_velocity = spin.map(|part| -0.5 * part);
    scene(law(scheme), 1.0, vec![material(SOFT, 0.3)], properties(1.0, 2.0), vec![one, other])
}

/// Young's modulus and density give a sphere that sinks 5e-4 of its radius into the plane.
fn resting(law: LawChoice, pair: Properties) -> SceneDraft {
    let mut body = sphere(R, 2500.0);
    let modulus = 1e6 / (2.0 * 0.91);
    let overlap = (body.mass() * 9.81 / (4.0 / 3.0 * modulus * R.sqrt())).powf(2.0 / 3.0);
    body.position[2] = R - overlap;
    body.velocity = [1e-4, 2e-5, 2e-4];
    let mut scene = scene(law, 1.0, vec![material(1e6, 0.3); 2], pair, vec![body]);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.boundaries = vec![plane([0.0; 3], [0.0, 0.0, 1.0], 1)];
    scene
}

/// Two spheres that forces press together while they spin, roll and slip on each other.
fn pressed(law: LawChoice, pair: Properties) -> SceneDraft {
    let (mut one, mut other) = (sphere(R, 2500.0), sphere(R, 2500.0));
    one.position[2] = 2.0 * R - 2e-5;
    one.velocity = [0.02, 0.01, 0.0];
    one.angular_velocity = [3.0, 5.0, 9.0];
    other.velocity = [-0.02, -0.01, 0.0];
    other.angular_velocity = [-2.0, 3.0, 12.0];
    let mut scene = scene(law, 1.0, vec![material(SOFT, 0.3)], pair, vec![one, other]);
    let force = |name: &str, member, z| AppliedForce { name: name.into(), members: vec![member], force: [0.0, 0.0, z] };
    scene.forces = vec![force("down", 0, -0.02), force("up", 1, 0.02)];
    scene
}

/// Duration of the impact of a pair \[s\].
fn pair_duration() -> f64 {
    let mass = sphere(R, 2500.0).mass();
    hertz_duration(SOFT / (2.0 * 0.91), 0.5 * R, 0.5 * mass, 20.0_f64.to_radians().cos())
}

/// Elastic sticking impacts.
fn sticking() -> [Case; 2] {
    let plane = hertz_duration(1e7 / (2.0 * 0.91), R, sphere(R, 2500.0).mass(), 10.0_f64.to_radians().cos());
    let on_plane =
        Case { name: "sticks on a plane", scene: stick_on_a_plane, time: 1.3 * plane, steps: 100, phases: 32 };
    let pair = |scheme, phase| stuck_pair(scheme, phase, [0.0; 3]);
    [on_plane, Case { name: "two spheres stick", scene: pair, time: 1.3 * pair_duration(), steps: 100, phases: 32 }]
}

/// A spinning pair that sticks.
fn spinning() -> Case {
    let pair = |scheme, phase| stuck_pair(scheme, phase, [20.0, 40.0, 60.0]);
    Case { name: "two spinning spheres stick", scene: pair, time: 1.3 * pair_duration(), steps: 100, phases: 32 }
}

/// Smooth motion with dashpots, in permanent contact.
fn damped() -> [Case; 2] {
    let rest = |scheme, _| resting(law(scheme), properties(0.5, 2.0));
    let press = |scheme, _| pressed(law(scheme), properties(0.5, 20.0));
    [
        Case { name: "damped, on a plane", scene: rest, time: 0.02, steps: 400, phases: 1 },
        Case { name: "damped, two spinning spheres", scene: press, time: 0.02, steps: 400, phases: 1 },
    ]
}

/// Rolling springs without dashpots, in permanent contact.
fn rolling() -> [Case; 3] {
    /// With this rolling model, elastic.
    fn with(scheme: Scheme, rolling: RollingModel) -> (LawChoice, Properties) {
        let pair = properties(1.0, 20.0)
            .with(&property::ROLLING_FRICTION, ROLLING)
            .with(&property::ROLLING_VISCOUS_DAMPING, 0.0);
        (LawChoice { rolling, ..law(scheme) }, pair)
    }
    /// The spring as stiff as friction, with torsion.
    fn twisting(scheme: Scheme) -> (LawChoice, Properties) {
        with(
            scheme,
            RollingModel::of::<rolling::epsd2::Epsd2>(rocking::Keys { torsion: true, ..rocking::Keys::default() }),
        )
    }
    let rest = |scheme, _| {
        let (law, pair) = with(scheme, RollingModel::of::<rolling::epsd::Epsd>(rocking::Keys::default()));
        resting(law, pair)
    };
    let press = |scheme, _| {
        let (law, pair) = with(scheme, RollingModel::of::<rolling::epsd::Epsd>(rocking::Keys::default()));
        pressed(law, pair)
    };
    let twist = |scheme, _| {
        let (law, pair) = twisting(scheme);
        pressed(law, pair)
    };
    [
        Case { name: "rocks on a plane", scene: rest, time: 0.02, steps: 400, phases: 1 },
        Case { name: "two spinning spheres rock", scene: press, time: 0.02, steps: 400, phases: 1 },
        Case { name: "two spinning spheres rock and twist", scene: twist, time: 0.02, steps: 400, phases: 1 },
    ]
}

#[test]
fn springs_carried_at_mid_step_are_of_second_order_where_bodies_stick() {
    for case in sticking() {
        let found = [Scheme::Engine, Scheme::Midway, Scheme::Predicted].map(|scheme| order(&case, scheme));
        assert!(found[0] < 1.3, "the engine's scheme: {found:?}");
        assert!(found[1] >= 1.9 && found[2] >= 1.9, "{}: {found:?}", case.name);
    }
}

#[test]
fn a_spring_that_turns_with_the_spin_about_the_normal_converges_as_the_engines_does_not() {
    let found = [Scheme::Engine, Scheme::Midway, Scheme::Predicted].map(|scheme| order(&spinning(), scheme));
    assert!(found[1] >= 1.5 && found[2] >= 1.5, "{found:?}");
}

#[test]
fn predicted_dashpots_are_of_second_order_in_smooth_motion() {
    for case in damped() {
        let found = [Scheme::Engine, Scheme::Midway, Scheme::Predicted].map(|scheme| order(&case, scheme));
        assert!(found[0] < 1.3 && found[1] < 1.3 && found[2] >= 1.9, "{}: {found:?}", case.name);
    }
}

#[test]
fn rolling_springs_carried_at_mid_step_are_of_second_order() {
    for case in rolling() {
        let found = [Scheme::Engine, Scheme::Midway].map(|scheme| order(&case, scheme));
        assert!(found[1] >= 1.9, "{}: {found:?}", case.name);
    }
}
