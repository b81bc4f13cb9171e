//! What crosses a boundary, and where energy goes: balances that hold to rounding whatever happens inside.

use crate::support::start;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::state::ledger::Source as Kind;

/// Grains in a moving, tilted tray, some of them a driven group, damped, pushed and shaken.
const SCENE: &str = r#"
gravity = [0.5, -0.2, -9.81]
[run]
end = 1.0
step = 1.0e-5
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
cohesion_energy_density = 2.0e3
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.cdt]
[contact.touch.cohesion.sjkr2]
[particles.bed]
material = "a"
lattice = { kind = "face_centred_cubic", origin = [0.005, 0.005, 0.006], counts = [4, 4, 3], spacing = 1.0e-2, radius = 4.98e-3 }
velocity = [0.1, 0.05, -0.5]
[particles.press]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.02, 0.02, 0.053], counts = [2, 2, 1], spacing = 1.0e-2, radius = 5.0e-3 }
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 0.99498743710662] }
material = "a"
motion = { driven = ["x", "z"] }
[boundary.west]
plane = { point = [-0.002, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "a"
[boundary.stamp]
particles = { set = "press" }
motion = { driven = ["z"] }
[damping.all]
linear = 0.2
angular = 0.1
gravity_damped = true
applied_forces_damped = false
[force.push]
particles = { set = "bed" }
force = [0.001, 0.0, 0.0]
[output]
energy = true
"#;

/// The scene at time 0.
fn simulation() -> Simulation {
    start(SCENE)
}

/// Where the inputs go in a communication step.
fn drive(simulation: &mut Simulation, step: u32) -> [[f64; 3]; 2] {
    let wave = 2e-4 * f64::from(step % 5) - 3e-4;
    simulation.set_input(BoundaryIndex(0), 0, wave);
    simulation.set_input(BoundaryIndex(0), 2, 0.5 * wave);
    simulation.set_input(BoundaryIndex(2), 2, -3e-4 * f64::from(step));
    let before = [0, 2].map(|boundary| simulation.state().boundaries[boundary].displacement);
    // Neither a whole number of time steps nor the same each time.
    simulation.advance(3.3e-4 + 1e-5 * f64::from(step % 3)).expect("it runs");
    before
}

#[test]
fn change_of_work_is_mean_force_times_displacement() {
    let mut simulation = simulation();
    let mut turnover = 0.0_f64;
    for step in 1..40 {
        let work_before = [0, 2].map(|boundary| simulation.state().boundaries[boundary].work);
        let before = drive(&mut simulation, step);
        for (place, boundary) in [0, 2].into_iter().enumerate() {
            let state = simulation.state().boundaries[boundary];
            let moved = [0, 1, 2].map(|axis| state.displacement[axis] - before[place][axis]);
            let expected: f64 = -(0..3).map(|axis| state.mean_force[axis] * moved[axis]).sum::<f64>();
            let found = state.work - work_before[place];
            turnover += found.abs();
            assert!((found - expected).abs() <= 1e-12 * turnover.max(1e-9), "{found:e} J, not {expected:e} J");
        }
    }
    assert!(turnover > 1e-4, "the boundaries worked: {turnover:e} J");
}

#[test]
fn momentum_changes_by_what_gravity_boundaries_forces_and_damping_give() {
    let mut simulation = simulation();
    let start = momentum(&simulation);
    for step in 1..40 {
        drive(&mut simulation, step);
    }
    let (state, scene) = (simulation.state(), simulation.scene());
    let free: Vec<usize> = (0..scene.particles.len()).filter(|&index| scene.particles[index].set.0 == 0).collect();
    let mass: f64 = free.iter().map(|&index| scene.particles[index].mass()).sum();
    let end = momentum(&simulation);
    for axis in 0..3 {
        let gravity = mass * scene.gravity[axis] * state.clock.time;
        let pushed = free.len() as f64 * scene.forces[0].force[axis] * state.clock.time;
        let boundaries = [0, 1, 2].map(|boundary| state.boundaries[boundary].total_impulse[axis]);
        let given = gravity + pushed + state.damping_impulse[axis] - boundaries.iter().sum::<f64>();
        let turnover = gravity.abs()
            + pushed.abs()
            + state.damping_impulse[axis].abs()
            + boundaries.iter().map(|impulse| impulse.abs()).sum::<f64>();
        let residual = end[axis] - start[axis] - given;
        assert!(residual.abs() < 1e-12 * turnover, "axis {axis}: {residual:e} N s of {turnover:e} N s");
    }
}

/// Momentum of the particles that move by the forces on them \[N s\].
fn momentum(simulation: &Simulation) -> [f64; 3] {
    let particles = &simulation.state().particles;
    let mut sum = [0.0; 3];
    for (row, owner) in particles.velocity.iter().zip(&particles.owner) {
        if *owner == 0 {
            for axis in 0..3 {
                sum[axis] += row[3] * row[axis];
            }
        }
    }
    sum
}

#[test]
fn the_energy_book_closes() {
    let mut simulation = simulation();
    for step in 1..40 {
        drive(&mut simulation, step);
    }
    let ledger = simulation.state().ledger.as_ref().expect("the scene keeps a book");
    for kind in [Kind::Contacts, Kind::Walls, Kind::Damping, Kind::Gravity, Kind::Applied] {
        assert!(ledger.work_of(kind).abs() > 1e-9, "{} did nothing", kind.name());
    }
    let residual = simulation.energy_residual().expect("the scene keeps a book");
    assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
}

#[test]
fn keeping_the_book_changes_no_bit() {
    let without = SCENE.replace("energy = true", "energy = false");
    let mut bare = start(&without);
    let mut booked = simulation();
    for step in 1..10 {
        drive(&mut bare, step);
        drive(&mut booked, step);
    }
    assert_eq!(bare.state().particles, booked.state().particles);
}

#[test]
fn a_particle_too_fast_for_the_step_is_refused_before_it_moves() {
    let text = SCENE.replace("velocity = [0.1, 0.05, -0.5]", "velocity = [0.1, 0.05, -500.0]");
    let mut simulation = start(&text);
    let before = simulation.state().particles.position.clone();
    let message = simulation.advance(1e-5).expect_err("half a radius in a step is too much").to_string();
    assert!(message.contains("of its radius in one step at t = 0 s"), "{message}");
    assert_eq!(simulation.state().particles.position, before);
}
