//! Groups of particles that forces move, or that turn: against theory, against single particles, and their books.

use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::scene::{AxisMotion, InputCourse};
use cograin::simulation::{LimiterKind, RunError, Simulation};
use cograin::state::{BoundaryState, State};
use std::sync::Arc;

/// The first boundary.
const FIRST: BoundaryIndex = BoundaryIndex(0);

/// The first boundary of a simulation.
fn group(simulation: &Simulation) -> BoundaryState {
    simulation.state().boundaries[0]
}

/// Length of a difference.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Three spheres of unequal size that no axis goes through, as a group; nothing touches them.
fn top(step: f64, motion: &str, more: &str) -> String {
    format!(
        r#"
[run]
step = {step:?}
[material.a]
density = 1000.0
[particles.top]
material = "a"
list = [
    {{ position = [0.0, 0.0, 0.0], radius = 0.1 }},
    {{ position = [0.3, 0.1, 0.0], radius = 0.08 }},
    {{ position = [0.0, 0.5, 0.2], radius = 0.12 }},
]
[boundary.top]
particles = {{ set = "top" }}
motion = {motion}
{more}
"#
    )
}

/// All axes free.
const FREE: &str = r#"{ free = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"] }"#;

#[test]
fn a_free_group_falls_as_a_stone() {
    let mut simulation = start(&format!("gravity = [1.0, 0.0, -9.81]\n{}", top(1e-3, FREE, "")));
    simulation.advance(0.5).expect("it runs");
    let moved = group(&simulation);
    // Velocity Verlet is exact for a constant force; 500 roundings.
    assert!(apart(moved.displacement, [0.125, 0.0, -0.125 * 9.81]) < 1e-14, "{:?}", moved.displacement);
    assert!(apart(moved.velocity, [0.5, 0.0, -0.5 * 9.81]) < 1e-13, "{:?}", moved.velocity);
    assert!(apart(moved.angular_velocity, [0.0; 3]) < 1e-13, "{:?}", moved.angular_velocity);
    assert_eq!(moved.force, [0.0; 3], "its own weight is not in its force");
    assert_eq!(moved.work, 0.0);
}

#[test]
fn axes_that_are_not_free_stay_and_driven_ones_follow() {
    let motion = r#"{ driven = ["z"], free = ["x"] }"#;
    let mut simulation = start(&format!("gravity = [1.0, 2.0, 3.0]\n{}", top(1e-3, motion, "")));
    simulation.set_input(FIRST, 2, -0.25);
    simulation.advance(0.5).expect("it runs");
    let moved = group(&simulation);
    assert!(apart(moved.displacement, [0.125, 0.0, -0.25]) < 1e-14, "{:?}", moved.displacement);
    assert!(apart(moved.velocity, [0.5, 0.0, -0.5]) < 1e-13, "{:?}", moved.velocity);
}

/// Angular momentum of all particles about a point \[kg m²/s\].
fn angular_momentum(state: &State, about: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let particles = &state.particles;
    for (slot, [vx, vy, vz, mass]) in particles.velocity.iter().enumerate() {
        let [x, y, z, _] = particles.position[slot];
        let [x, y, z] = [x - about[0], y - about[1], z - about[2]];
        let spin = particles.angular_velocity[slot];
        let orbital = [y * vz - z * vy, z * vx - x * vz, x * vy - y * vx];
        for axis in 0..3 {
            sum[axis] += mass * orbital[axis] + spin[3] * spin[axis];
        }
    }
    sum
}

#[test]
fn a_free_top_keeps_momentum_and_energy_and_its_course_is_of_second_order() {
    let spheres = "[particles.top]\nangular_velocity = [3.0, -2.0, 5.0]\nvelocity = [0.1, 0.2, 0.3]";
    let run = |step: f64| {
        let text = top(step, FREE, "").replace("[particles.top]", spheres);
        let mut simulation = start(&text);
        let (momentum, energy) = (group(&simulation).inertial.angular_momentum, simulation.kinetic_energy());
        // The angular momentum of its spheres' own spins is all that it starts with.
        let inertia: f64 = simulation.state().particles.angular_velocity.iter().map(|row| row[3]).sum();
        assert!(apart(momentum, [3.0 * inertia, -2.0 * inertia, 5.0 * inertia]) < 1e-14);
        simulation.advance(20.0).expect("it runs");
        let change = simulation.kinetic_energy() / energy - 1.0;
        assert!(change.abs() < 1e-12, "the energy changed by {change:e} of itself");
        let moved = group(&simulation);
        let now = angular_momentum(simulation.state(), moved.pivot);
        let scale = apart(momentum, [0.0; 3]);
        assert!(apart(now, momentum) < 1e-12 * scale, "{now:?}, not {momentum:?}");
        moved.orientation.0
    };
    let [coarse, middle, fine] = [0.05, 0.025, 0.0125].map(run);
    let away = |a: [f64; 4], b: [f64; 4]| (0..4).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt();
    let ratio = away(coarse, middle) / away(middle, fine);
    assert!((ratio - 4.0).abs() < 0.3, "halving the step divides the error by {ratio}, not by 4");
}

#[test]
fn a_top_held_on_an_axis_swings_as_a_pendulum() {
    let more = "reference = [0.0, 0.0, 1.0]";
    let mut simulation =
        start(&format!("gravity = [0.0, 0.0, -9.81]\n{}", top(1e-4, r#"{ free = ["rotation.y"] }"#, more)));
    // By hand: ½ J ω² = M g (height lost), J about the y axis through the reference.
    let spheres = [([0.0, 0.0, 0.0], 0.1_f64), ([0.3, 0.1, 0.0], 0.08), ([0.0, 0.5, 0.2], 0.12)];
    let (mut inertia, mut first) = (0.0, [0.0; 2]);
    for ([x, _, z], radius) in spheres {
        let mass = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * 1000.0;
        inertia += mass * (0.4 * radius * radius + x * x + (z - 1.0) * (z - 1.0));
        first = [first[0] + mass * x, first[1] + mass * (z - 1.0)];
    }
    simulation.advance(0.3).expect("it runs");
    let moved = group(&simulation);
    let angle = moved.rotation[1];
    let height = |angle: f64| first[1] * angle.cos() - first[0] * angle.sin();
    let expected = (2.0 * 9.81 * (height(0.0) - height(angle)) / inertia).sqrt();
    assert!(angle.abs() > 1e-3, "it swung: {angle}");
    // Verlet's energy error: (w Δt)²/8 with w near 3 rad/s.
    assert!(
        (moved.angular_velocity[1].abs() / expected - 1.0).abs() < 1e-6,
        "{:?}, not {expected}",
        moved.angular_velocity
    );
    assert_eq!([moved.rotation[0], moved.rotation[2]], [0.0; 2]);
}

/// A sphere that falls, spinning, onto an inclined floor and a fixed neighbour.
const FALLING: &str = r#"
gravity = [0.3, -0.2, -9.81]
[run]
step = 1.0e-5
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.cdt]
[particles.ball]
material = "a"
list = [{ position = [0.001, 0.002, 0.0103], radius = 0.01, velocity = [0.4, 0.1, -0.5], angular_velocity = [20.0, -30.0, 10.0] }]
[particles.rest]
material = "a"
list = [
    { position = [0.022, 0.001, 0.011], radius = 0.01 },
    { position = [0.019, 0.021, 0.012], radius = 0.01 },
]
[force.push]
particles = { set = "ball" }
force = [0.01, 0.0, 0.002]
[damping.all]
linear = 0.1
angular = 0.2
gravity_damped = true
applied_forces_damped = false
[output]
energy = true
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 0.99498743710662] }
material = "a"
"#;

#[test]
fn one_sphere_as_a_free_group_is_the_free_sphere() {
    let mut particle = start(FALLING);
    let grouped = format!("{FALLING}[boundary.ball]\nparticles = {{ set = \"ball\" }}\nmotion = {FREE}\n");
    let mut grouped = start(&grouped);
    for _ in 0..40 {
        particle.advance(1e-3).expect("it runs");
        grouped.advance(1e-3).expect("it runs");
    }
    assert!(particle.contact_count() > 0, "nothing touched");
    let rows = |simulation: &Simulation| {
        let particles = &simulation.state().particles;
        let all = [&particles.position, &particles.velocity, &particles.angular_velocity];
        [0, 1, 2].map(|index| all.map(|rows| rows[particles.slot[index] as usize]))
    };
    for (one, other) in rows(&particle).into_iter().flatten().zip(rows(&grouped).into_iter().flatten()) {
        for (a, b) in one.iter().zip(other) {
            // 4000 steps of rounding, more than one collision.
            assert!((a - b).abs() < 1e-10 * (1.0 + a.abs()), "{one:?} and {other:?}");
        }
    }
    let [one, other] = [&particle, &grouped].map(Simulation::kinetic_energy);
    assert!((one - other).abs() < 1e-10 * one, "{one} J and {other} J");
}

/// A paddle of three spheres in a bed of loose ones.
fn paddle(motion: &str, input: &str) -> String {
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-5
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "a"
lattice = {{ kind = "simple_cubic", radius = 0.005, counts = [5, 5, 2], origin = [-0.02, -0.02, 0.005] }}
velocity = [0.1, -0.05, 0.0]
[particles.paddle]
material = "a"
list = [
    {{ position = [-0.01, 0.0, 0.0249], radius = 0.005 }},
    {{ position = [0.0, 0.001, 0.0249], radius = 0.005 }},
    {{ position = [0.009, 0.0, 0.0259], radius = 0.006 }},
]
[force.push]
particles = {{ set = "paddle" }}
force = [0.01, 0.02, -0.03]
[damping.some]
particles = {{ set = "paddle" }}
linear = 0.1
angular = 0.3
gravity_damped = false
applied_forces_damped = true
[output]
energy = true
[boundary.paddle]
particles = {{ set = "paddle" }}
motion = {motion}
{input}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
motion = {{ driven = ["z"] }}
"#
    )
}

/// Runs a paddle over a shaken floor and checks the books of energy, momentum and work in every communication step.
fn books_close(motion: &str, input: &str, drive: impl Fn(&mut Simulation, f64)) {
    let mut simulation = start(&paddle(motion, input));
    let start = momentum(&simulation);
    let (mut turnover, mut pressed) = ([0.0_f64; 2], 0.0_f64);
    for step in 1..=30 {
        simulation.set_input(BoundaryIndex(1), 2, 2e-5 * f64::from(step % 3));
        drive(&mut simulation, f64::from(step));
        let before = simulation.state().boundaries.clone();
        simulation.advance(1e-3).expect("it runs");
        pressed = pressed.max(apart(group(&simulation).mean_force, [0.0; 3]));
        for (index, (before, after)) in before.iter().zip(&simulation.state().boundaries).enumerate() {
            let led = |axis: usize| simulation.scene().boundaries[index].axes[axis] != AxisMotion::Free;
            let mut expected = 0.0;
            for axis in 0..3 {
                if led(axis) {
                    expected -= after.mean_force[axis] * (after.displacement[axis] - before.displacement[axis]);
                }
                if led(3 + axis) {
                    expected -= after.mean_moment[axis] * after.turn[axis];
                }
            }
            turnover[index] += expected.abs();
            // The equality is that of constant velocity.
            let ramp = simulation.scene().boundaries[index].input == InputCourse::Ramp;
            let off = (after.work - before.work - expected).abs();
            assert!(
                !ramp || off <= 1e-12 * turnover[index].max(1e-9),
                "boundary {index}: {off:e} of {:e} J",
                turnover[index]
            );
        }
    }
    assert!(pressed > 1e-3, "the bed pressed on the group with {pressed:e} N");
    let ledger = simulation.state().ledger.as_ref().expect("the scene keeps a book");
    let residual = simulation.energy_residual().expect("the scene keeps a book");
    assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
    momentum_closes(&simulation, start);
}

/// Momentum of what moves freely along x, y, z \[N s\].
fn momentum(simulation: &Simulation) -> [f64; 3] {
    let (scene, state) = (simulation.scene(), simulation.state());
    [0, 1, 2].map(|axis| {
        let particles = state.particles.velocity.iter().zip(&state.particles.owner);
        let free: f64 = particles.filter(|(_, owner)| **owner == 0).map(|(row, _)| row[3] * row[axis]).sum();
        let group_mass: f64 = scene.particles.iter().filter(|it| it.set.0 == 1).map(|it| it.mass()).sum();
        let is_free = scene.boundaries[0].axes[axis] == AxisMotion::Free;
        free + if is_free { group_mass * state.boundaries[0].velocity[axis] } else { 0.0 }
    })
}

/// The momentum is what gravity, forces, damping and boundaries gave.
fn momentum_closes(simulation: &Simulation, start: [f64; 3]) {
    let (scene, state) = (simulation.scene(), simulation.state());
    let end = momentum(simulation);
    for axis in 0..3 {
        let is_free = scene.boundaries[0].axes[axis] == AxisMotion::Free;
        let inside = scene.particles.iter().filter(|it| it.set.0 == 0 || is_free);
        let mass: f64 = inside.map(|it| it.mass()).sum();
        let pushed = if is_free { 3.0 * scene.forces[0].force[axis] } else { 0.0 };
        let given = [
            state.clock.time * (mass * scene.gravity[axis] + pushed),
            state.damping_impulse[axis],
            -state.boundaries[0].total_impulse[axis],
            -state.boundaries[1].total_impulse[axis],
        ];
        let turnover: f64 = given.iter().map(|part| part.abs()).sum();
        let residual = end[axis] - start[axis] - given.iter().sum::<f64>();
        assert!(residual.abs() < 1e-12 * turnover, "axis {axis}: {residual:e} N s of {turnover:e} N s");
    }
}

#[test]
fn books_of_a_free_group_close() {
    books_close(FREE, "", |_, _| {});
}

#[test]
fn books_of_a_group_driven_along_one_axis_and_free_along_others_close() {
    let motion = r#"{ driven = ["z"], free = ["x", "y", "rotation.z"] }"#;
    books_close(motion, "", |simulation, step| simulation.set_input(FIRST, 2, -2e-5 * step));
}

#[test]
fn books_of_a_driven_group_that_turns_freely_close() {
    let motion = r#"{ driven = ["z"], free = ["rotation.x", "rotation.y", "rotation.z"] }"#;
    books_close(motion, "", |simulation, step| simulation.set_input(FIRST, 2, -2e-5 * step));
}

#[test]
fn books_of_a_group_driven_about_an_axis_close() {
    for input in ["", "input = \"smooth\""] {
        books_close(r#"{ driven = ["z", "rotation.z"] }"#, input, |simulation, step| {
            simulation.set_input(FIRST, 2, -1e-5 * step);
            simulation.set_input(FIRST, 5, 0.05 * step);
        });
    }
}

#[test]
fn books_of_a_group_driven_about_all_axes_close() {
    books_close(r#"{ driven = ["rotation.x", "rotation.y", "rotation.z"], free = ["z"] }"#, "", |simulation, step| {
        simulation.set_input(FIRST, 3, 0.02 * step);
        simulation.set_input(FIRST, 4, -0.01 * step);
        simulation.set_input(FIRST, 5, 0.05 * step);
    });
}

#[test]
fn a_driven_rotation_takes_the_spheres_along_and_arrives() {
    let mut simulation = start(&top(1e-3, r#"{ driven = ["rotation.z"] }"#, "reference = [0.0, 0.0, 0.0]"));
    simulation.set_input(FIRST, 5, 3.5 * std::f64::consts::PI);
    simulation.advance(0.35).expect("it runs");
    let moved = group(&simulation);
    assert_eq!(moved.rotation[2], 3.5 * std::f64::consts::PI, "one axis turns by any angle");
    let w = 10.0 * std::f64::consts::PI;
    assert!((moved.angular_velocity[2] / w - 1.0).abs() < 1e-14, "{:?}", moved.angular_velocity);
    // The sphere at (0.3, 0.1, 0) has turned by −π/2, and moves with w × r.
    let particles = &simulation.state().particles;
    let slot = particles.slot[1] as usize;
    let [x, y, z, _] = particles.position[slot];
    assert!(apart([x, y, z], [0.1, -0.3, 0.0]) < 1e-14, "{x}, {y}, {z}");
    let [u, v, _, _] = particles.velocity[slot];
    assert!(apart([u, v, 0.0], [0.3 * w, 0.1 * w, 0.0]) < 1e-12 * w, "{u}, {v}");
    assert!((particles.angular_velocity[slot][2] / w - 1.0).abs() < 1e-14);
}

#[test]
fn a_driven_rotation_about_several_axes_turns_at_constant_angular_velocity() {
    let motion = r#"{ driven = ["rotation.x", "rotation.y", "rotation.z"] }"#;
    let mut simulation = start(&top(1e-3, motion, ""));
    for axis in 3..6 {
        simulation.set_input(FIRST, axis, 0.5);
    }
    simulation.advance(0.1).expect("it runs");
    simulation.set_input(FIRST, 3, -0.4);
    simulation.set_input(FIRST, 5, 0.1);
    simulation.advance(0.1).expect("it runs");
    let moved = group(&simulation);
    assert_eq!(moved.rotation, [-0.4, 0.5, 0.1]);
    // By matrices: exp(turn) exp(0.5, 0.5, 0.5) = exp(-0.4, 0.5, 0.1), and turn = w H.
    let w = moved.angular_velocity.map(|part| 0.1 * part);
    let there = turned(w, turned([0.5; 3], [1.0, 0.0, 0.0]));
    assert!(apart(there, turned([-0.4, 0.5, 0.1], [1.0, 0.0, 0.0])) < 1e-14, "{there:?}");
    assert!(apart(w, moved.turn) < 1e-15, "{w:?}, not {:?}", moved.turn);
}

/// Where a rotation vector takes a vector (Rodrigues).
fn turned(rotation: [f64; 3], vector: [f64; 3]) -> [f64; 3] {
    let angle = apart(rotation, [0.0; 3]);
    let n = rotation.map(|part| part / angle);
    let along: f64 = n.iter().zip(vector).map(|(a, b)| a * b).sum();
    let across =
        [n[1] * vector[2] - n[2] * vector[1], n[2] * vector[0] - n[0] * vector[2], n[0] * vector[1] - n[1] * vector[0]];
    [0, 1, 2].map(|k| vector[k] * angle.cos() + across[k] * angle.sin() + n[k] * along * (1.0 - angle.cos()))
}

#[test]
fn half_a_turn_about_several_axes_is_refused_and_changes_nothing() {
    let mut simulation = start(&top(1e-3, r#"{ driven = ["rotation.x", "rotation.y"] }"#, ""));
    simulation.set_input(FIRST, 3, 2.5);
    simulation.set_input(FIRST, 4, 2.5);
    let before = simulation.state().clone();
    let error = simulation.advance(0.1).expect_err("it is refused");
    assert!(matches!(error, RunError::Turn { .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "boundary top: expected less than half a turn (pi) about several axes in one communication step, found \
         3.5355 rad at t = 0 s"
    );
    assert_eq!(*simulation.state(), before);
    simulation.set_input(FIRST, 4, 0.0);
    simulation.advance(0.1).expect("2.5 rad are less");
}

#[test]
fn a_prescribed_rotation_goes_on_for_ever() {
    let mut simulation = start(&top(1e-2, r#"{ prescribed = { "rotation.x" = 3.0 } }"#, ""));
    simulation.advance(10.0).expect("it runs");
    let moved = group(&simulation);
    assert!((moved.rotation[0] - 30.0).abs() < 1e-12, "{:?}", moved.rotation);
    assert_eq!(moved.angular_velocity, [3.0, 0.0, 0.0]);
}

#[test]
fn a_saved_free_group_continues_bit_for_bit() {
    for motion in [FREE, r#"{ driven = ["z", "rotation.x", "rotation.z"], free = ["x", "y"] }"#] {
        let mut whole = start(&paddle(motion, ""));
        whole.advance(5e-3).expect("it runs");
        let bytes = whole.state().to_bytes(7);
        let saved = State::from_bytes(&bytes, 7).expect("it reads back");
        let mut resumed = Simulation::resume(Arc::clone(whole.scene()), saved).unwrap();
        for simulation in [&mut whole, &mut resumed] {
            simulation.set_input(FIRST, 2, -1e-5);
            simulation.set_input(FIRST, 3, 0.1);
            simulation.advance(5e-3).expect("it runs");
        }
        assert_eq!(whole.state(), resumed.state());
    }
}

#[test]
fn a_light_group_on_a_stiff_contact_shortens_the_stable_step() {
    let run = |motion: &str| {
        let text = paddle(motion, "")
            .replace("radius = 0.006 }", "radius = 0.006, density = 0.25 }")
            .replace("step = 2.0e-5", "safety = 0.2");
        let text = text.replace("0.0249], radius = 0.005 }", "0.0249], radius = 0.005, density = 0.25 }");
        start(&text).limit()
    };
    let (fixed, free) = (run("\"fixed\""), run(FREE));
    // The mass is 1e4 times smaller on the same springs. What limits the scene with the fixed group are impacts to come, at a step
    // shorter than that of its contacts: the ratio is not the whole factor of 100.
    assert_eq!(free.by.expect("something limits it").kind, LimiterKind::Contact);
    let (fixed, free) = (fixed.safe, free.safe);
    assert!(free < 0.1 * fixed && free > 0.002 * fixed, "{free:e} s free, {fixed:e} s fixed");
}

#[test]
fn free_groups_stay_stable_at_the_step_that_is_computed() {
    // Elastic and without damping: at 0.9 of the bound the energy must not grow.
    let text = paddle(r#"{ free = ["z", "rotation.x", "rotation.y", "rotation.z"] }"#, "")
        .replace("restitution = 0.5", "restitution = 1.0")
        .replace("friction = 0.5", "friction = 0.0")
        .replace("step = 2.0e-5", "step = \"auto\"\nsafety = 0.9")
        .replace("linear = 0.1", "linear = 0.0")
        .replace("angular = 0.3", "angular = 0.0");
    let mut simulation = start(&text);
    let before = simulation.kinetic_energy();
    for _ in 0..50 {
        simulation.advance(1e-3).expect("it runs");
    }
    let ledger = simulation.state().ledger.as_ref().expect("the scene keeps a book");
    let fed = ledger.work_of(cograin::state::ledger::Source::Gravity).abs()
        + ledger.work_of(cograin::state::ledger::Source::Applied).abs();
    let most = before + 1.5 * fed;
    assert!(simulation.kinetic_energy() < most, "{} J of {most} J", simulation.kinetic_energy());
}

/// Six bonded spheres in a bent row; nothing damps them.
fn row(more: &str) -> String {
    format!(
        r#"
[run]
step = 2.0e-7
[material.a]
density = 2500.0
[particles.row]
material = "a"
list = [
    {{ position = [0.0, 0.0, 0.0], radius = 0.001 }},
    {{ position = [0.002, 0.0, 0.0], radius = 0.001 }},
    {{ position = [0.004, 0.0001, 0.0], radius = 0.001 }},
    {{ position = [0.006, 0.0, 0.0002], radius = 0.001 }},
    {{ position = [0.008, 0.0, 0.0], radius = 0.001 }},
    {{ position = [0.010, 0.0005, 0.0], radius = 0.001 }},
]
angular_velocity = [400.0, 6000.0, -10000.0]
velocity = [0.0, 1.0, -0.5]
[bond.glue]
between = ["row", "row"]
create_distance = 2.2e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[output]
energy = true
{more}
"#
    )
}

#[test]
fn a_free_group_among_bonds_keeps_momentum_angular_momentum_and_the_book() {
    let group = format!("[boundary.end]\nparticles = {{ ids = [5, 6] }}\nmotion = {FREE}\n");
    let mut simulation = start(&row(&group));
    let momentum = |simulation: &Simulation| -> [f64; 3] {
        let rows = &simulation.state().particles.velocity;
        [0, 1, 2].map(|axis| rows.iter().map(|row| row[3] * row[axis]).sum())
    };
    let before = (momentum(&simulation), angular_momentum(simulation.state(), [0.0; 3]));
    let orientation = group_orientation(&simulation);
    simulation.advance(4e-3).expect("it runs");
    let after = (momentum(&simulation), angular_momentum(simulation.state(), [0.0; 3]));
    assert!(group_orientation(&simulation)[0] < orientation[0] - 0.1, "the group turned");
    // 20,000 steps of rounding.
    assert!(apart(before.0, after.0) < 1e-12 * apart(before.0, [0.0; 3]), "{before:?} {after:?}");
    assert!(apart(before.1, after.1) < 1e-11 * apart(before.1, [0.0; 3]), "{before:?} {after:?}");
    let ledger = simulation.state().ledger.as_ref().expect("the scene keeps a book");
    let residual = simulation.energy_residual().expect("the scene keeps a book");
    assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
}

/// Orientation of the first boundary, which its spheres share.
fn group_orientation(simulation: &Simulation) -> [f64; 4] {
    let orientation = group(simulation).orientation.0;
    let particles = &simulation.state().particles;
    assert_eq!(particles.orientation[particles.slot[5] as usize], orientation);
    orientation
}

#[test]
fn bonds_resist_a_driven_rotation_with_their_torsional_stiffness() {
    let straight = row("")
        .replace("0.0001, 0.0]", "0.0, 0.0]")
        .replace("0.0, 0.0002]", "0.0, 0.0]")
        .replace("0.0005, 0.0]", "0.0, 0.0]")
        .replace("angular_velocity = [400.0, 6000.0, -10000.0]\nvelocity = [0.0, 1.0, -0.5]", "")
        .replace("[bond.glue]", "[damping.all]\nlinear = 0.5\nangular = 0.5\n[bond.glue]");
    let held = "[boundary.clamp]\nparticles = { ids = [1] }\n[boundary.grip]\nparticles = { ids = [6] }\n";
    let mut simulation = start(&format!("{straight}{held}motion = {{ driven = [\"rotation.x\"] }}\n"));
    // Several turns: the twist is followed on.
    let angle = 10.0;
    simulation.set_input(BoundaryIndex(1), 3, angle);
    simulation.advance(2e-3).expect("it runs");
    simulation.advance(4e-3).expect("it comes to rest");
    // Five bonds in a row, each k_t J with J = π R⁴/2.
    let expected = -4.0e11 * 0.5 * std::f64::consts::PI * 1e-12 * angle / 5.0;
    let [clamp, grip] = [0, 1].map(|index| simulation.state().boundaries[index].moment[0]);
    assert!((grip / expected - 1.0).abs() < 1e-9, "{grip} N m, not {expected} N m");
    assert!((clamp / -expected - 1.0).abs() < 1e-9, "{clamp} N m, not {} N m", -expected);
}

#[test]
fn a_group_that_is_put_elsewhere_at_once_meets_what_is_there() {
    let text =
        paddle(r#"{ driven = ["x"] }"#, "input = \"hold\"").replace("0.0249", "0.0149").replace("0.0259", "0.0149");
    let text = text.replace("[-0.01, 0.0", "[-0.31, 0.0").replace("[0.0, 0.001", "[-0.3, 0.001");
    let mut simulation = start(&text.replace("[0.009, 0.0", "[-0.291, 0.0"));
    simulation.set_input(FIRST, 0, 0.2711);
    simulation.advance(2e-5).expect("it runs");
    assert!(apart(group(&simulation).force, [0.0; 3]) > 0.0, "it stands in the bed and feels nothing");
}

#[test]
fn a_free_group_goes_on_from_a_state_that_was_reached_before() {
    let mut first = start(&format!("gravity = [0.3, 0.0, -1.0]\n{}", top(1e-3, FREE, "")));
    first.advance(0.4).expect("it runs");
    let mut second = Simulation::settled(first.scene().clone(), first.state().clone()).expect("it starts");
    for simulation in [&mut first, &mut second] {
        simulation.advance(0.2).expect("it runs");
    }
    for (a, b) in first.state().particles.position.iter().zip(&second.state().particles.position) {
        let (a, b) = ([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
        assert!(apart(a, b) < 1e-14, "{a:?} and {b:?}");
    }
    assert_eq!(group(&second).displacement, group(&first).displacement);
}
