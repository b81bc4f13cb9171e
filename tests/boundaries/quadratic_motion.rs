//! Boundaries that go through a communication step at constant acceleration, and the slope of the force on them.

use crate::support;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;

/// The first boundary.
const FLOOR: BoundaryIndex = BoundaryIndex(0);

/// Stiffness of the contact \[N/m\].
const STIFFNESS: f64 = 1.0e5;

/// Time step \[s\].
const STEP: f64 = 1.0e-5;

/// A sphere that is held, or rests on the floor under its weight.
fn start(held: bool, input: &str) -> Simulation {
    let ball = if held { "[boundary.ball]\nparticles = { set = \"ball\" }\n" } else { "" };
    let text = format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = {STEP:e}
threads = 1
[material.a]
density = 2500.0
[pair.a.a]
normal_stiffness = {STIFFNESS:e}
normal_damping = {damping}
[contact.touch.normal.hooke_stiffness]
[particles.ball]
material = "a"
list = [{{ position = [0.0, 0.0, 0.0499], radius = 0.05 }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
motion = {{ driven = ["x", "z"] }}
input = "{input}"
{ball}
"#,
        damping = if held { 0.0 } else { 50.0 }
    );
    support::start(&text)
}

/// Sends the floor to a height \[m\] at an acceleration \[m/s²\] within a communication step \[s\].
fn give(simulation: &mut Simulation, height: f64, acceleration: f64, length: f64) {
    simulation.set_input(FLOOR, 2, height);
    simulation.set_input_rate(FLOOR, 2, -0.5 * acceleration * length);
    simulation.set_input_acceleration(FLOOR, 2, acceleration);
}

#[test]
fn the_floor_goes_along_the_parabola_and_the_force_has_its_mean_and_slope() {
    let (length, height, acceleration, count) = (1.0e-3, 2.0e-5, 90.0, 100.0);
    let mut simulation = start(true, "quadratic");
    let overlap = 1.0e-4; // at the beginning [m]
    give(&mut simulation, height, acceleration, length);
    simulation.advance(length).expect("it runs");
    let floor = &simulation.state().boundaries[0];
    assert_eq!(floor.displacement[2], height);
    // Overlap: that at the beginning and the parabola, whose mean is its chord less a H²/12.
    let mean = -STIFFNESS * (overlap + 0.5 * height - acceleration * length * length / 12.0);
    let slope = -STIFFNESS * height / length;
    // Time steps take forces at their ends, linear between them: a hundredth squared off.
    assert!((floor.mean_force[2] / mean - 1.0).abs() < 0.1 / (count * count), "{} not {mean}", floor.mean_force[2]);
    assert!((floor.force_slope[2] / slope - 1.0).abs() < 1.1 / (count * count), "{} not {slope}", floor.force_slope[2]);
    let velocity = height / length + 0.5 * acceleration * (length - STEP);
    assert!((floor.velocity[2] / velocity - 1.0).abs() < 1e-9, "{} not {velocity}", floor.velocity[2]);
}

#[test]
fn work_is_that_of_mean_and_slope_of_the_force() {
    let mut simulation = start(false, "quadratic");
    let (mut work, mut place) = (0.0, 0.0);
    // Whole numbers of time steps and others, one time step among them.
    for (number, length) in [1.0e-3, 3.3e-4, 1.0e-5, 7.77e-4, 2.0e-3].into_iter().cycle().take(40).enumerate() {
        let height = 1.0e-4 * (0.7 * number as f64).sin();
        let acceleration = 40.0 * (1.3 * number as f64).cos();
        give(&mut simulation, height, acceleration, length);
        simulation.advance(length).expect("it runs");
        let floor = &simulation.state().boundaries[0];
        let parts = [
            floor.mean_force[2] * (floor.displacement[2] - place),
            floor.force_slope[2] * acceleration * length.powi(3) / 12.0,
        ];
        let scale = parts[0].abs() + parts[1].abs() + floor.work.abs();
        let error = floor.work - work + parts[0] + parts[1];
        assert!(error.abs() <= 1e-13 * scale, "step {number}: {error:e} of {scale:e} J");
        (work, place) = (floor.work, floor.displacement[2]);
    }
    assert!(work.abs() > 1e-6, "{work} J");
}

#[test]
fn an_acceleration_counts_for_one_step_and_goes_with_the_state() {
    let length = 1.0e-3;
    let mut simulation = start(false, "quadratic");
    give(&mut simulation, 1.0e-5, 50.0, length);
    let saved = simulation.state().clone();
    simulation.advance_or_roll_back(length).expect("it runs");
    let first = simulation.state().clone();
    simulation.restore(&saved).expect("it is its own state");
    simulation.advance_or_roll_back(length).expect("it runs");
    assert_eq!(simulation.state().boundaries, first.boundaries);
    // A second step without: at constant velocity, or rather at rest.
    simulation.advance_or_roll_back(length).expect("it runs");
    let floor = &simulation.state().boundaries[0];
    assert_eq!((floor.displacement[2], floor.velocity[2], floor.acceleration), (1.0e-5, 0.0, [0.0; 3]));
}

#[test]
fn without_an_acceleration_it_is_the_ramp() {
    let [mut bent, mut ramp] = ["quadratic", "ramp"].map(|input| start(true, input));
    for height in [1.0e-5, -2.0e-5, 3.0e-5] {
        for simulation in [&mut bent, &mut ramp] {
            simulation.set_input(FLOOR, 2, height);
            simulation.advance(3.3e-4).expect("it runs");
        }
        let [bent, ramp] = [&bent, &ramp].map(|simulation| simulation.state().boundaries[0]);
        assert_eq!((bent.displacement, bent.mean_force, bent.work), (ramp.displacement, ramp.mean_force, ramp.work));
        assert_eq!(ramp.force_slope, [0.0; 3], "a ramp is not asked for it");
    }
}
