//! Free axes against closed forms.

use super::scenes::{FALLING, FIRST, FREE, angular_momentum, apart, group, group_orientation, paddle, row, top};
use crate::support::start;
use cograin::simulation::{LimiterKind, Simulation};
use cograin::state::State;
use std::sync::Arc;

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
