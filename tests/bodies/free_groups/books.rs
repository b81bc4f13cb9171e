//! The books of groups that forces move close.

use super::scenes::{FIRST, FREE, apart, group, momentum, paddle};
use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::scene::{AxisMotion, InputCourse};
use cograin::simulation::Simulation;

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
