//! The same scene and inputs give the same bits: for any number of threads, any lane width, after save and restore.
//!
//! Hashes are of the whole state: positions alone would forgive what has not yet moved them. `every_law.rs` looks at
//! every law, and at what the platform brings along.

use crate::support::start;
use cograin::lanes::Width;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::state::State;

/// Two materials, rolling friction and cohesion, a driven floor, damping, a falling cloud that meets it: enough
/// particles for several threads, and motion enough for new neighbour lists.
const SCENE: &str = r#"
gravity = [0.3, 0.0, -9.81]
[run]
end = 1.0
step = 2.0e-5
threads = THREADS
skin = SKIN
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[material.b]
youngs_modulus = 2.0e7
poissons_ratio = 0.25
density = 1500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
cohesion_energy_density = 2.0e3
[pair.a.b]
restitution = 0.6
friction = 0.3
rolling_friction = 0.05
cohesion_energy_density = 1.0e3
[pair.b.b]
restitution = 0.4
friction = 0.4
rolling_friction = 0.02
cohesion_energy_density = 0.0
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.cdt]
[contact.touch.cohesion.sjkr]
[particles.heavy]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.004, 0.004, 0.004], counts = [14, 14, 8], spacing = 8.0e-3, radius = 4.02e-3 }
velocity = [0.4, 0.1, -0.6]
[particles.light]
material = "b"
lattice = { kind = "simple_cubic", origin = [0.006, 0.005, 0.075], counts = [13, 13, 6], spacing = 8.2e-3, radius = 4.0e-3 }
velocity = [-0.3, 0.2, -1.0]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
motion = { driven = ["z"] }
[boundary.west]
plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "b"
[damping.all]
linear = 0.1
angular = 0.05
gravity_damped = false
[output]
energy = true
"#;

/// The scene with this many threads.
fn simulation(threads: usize) -> Simulation {
    simulation_with(threads, "4.0e-4")
}

/// The scene with this many threads and this skin.
fn simulation_with(threads: usize, skin: &str) -> Simulation {
    let text = SCENE.replace("THREADS", &threads.to_string()).replace("SKIN", skin);
    start(&text)
}

/// Runs some communication steps with a moving floor.
fn run(simulation: &mut Simulation, steps: std::ops::Range<u32>) {
    for step in steps {
        simulation.set_input(BoundaryIndex(0), 2, 1e-5 * f64::from(step % 7));
        simulation.advance(4.0e-4).expect("it runs");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let hashes: Vec<(usize, u64)> = [1, 2, 3, 4]
        .into_iter()
        .map(|threads| {
            let mut simulation = simulation(threads);
            run(&mut simulation, 0..15);
            assert_eq!(simulation.threads(), threads);
            assert!(simulation.state().clock.rebuilds > 2, "the lists were made anew");
            (simulation.contact_count(), simulation.state().fingerprint())
        })
        .collect();
    assert!(hashes[0].0 > 1000, "{} contacts", hashes[0].0);
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:x?}");
}

#[test]
fn any_lane_width_gives_the_same_bits() {
    let offered = Width::ALL.into_iter().filter(|width| width.offered());
    let hashes: Vec<(Width, u64)> = offered
        .map(|width| {
            let mut simulation = simulation(1);
            simulation.set_width(width);
            run(&mut simulation, 0..15);
            (width, simulation.state().fingerprint())
        })
        .collect();
    assert!(hashes.iter().all(|hash| hash.1 == hashes[0].1), "{hashes:x?}");
}

#[test]
fn a_state_that_went_through_bytes_continues_with_the_same_bits() {
    let mut unbroken = simulation(2);
    run(&mut unbroken, 0..8);
    let scene = unbroken.scene().clone();
    let bytes = unbroken.state().to_bytes(scene.fingerprint);
    run(&mut unbroken, 8..15);

    let state = State::from_bytes(&bytes, scene.fingerprint).expect("the bytes are whole");
    let mut resumed = Simulation::resume(scene, state.clone()).unwrap();
    run(&mut resumed, 8..15);
    assert_eq!(resumed.state().fingerprint(), unbroken.state().fingerprint());

    unbroken.restore(&state).unwrap();
    run(&mut unbroken, 8..15);
    assert_eq!(unbroken.state().fingerprint(), resumed.state().fingerprint());
}

#[test]
fn more_neighbour_lists_change_rounding_only() {
    let mut often = simulation_with(1, "1.0e-4");
    let mut seldom = simulation_with(1, "4.0e-4");
    run(&mut often, 0..5);
    run(&mut seldom, 0..5);
    let (more, fewer) = (often.state().clock.rebuilds, seldom.state().clock.rebuilds);
    assert!(more > 2 * fewer, "{more} and {fewer} lists");
    let apart = largest_difference(&often, &seldom);
    // A hundred steps of 2e-5 s at about 1 m/s, over which rounding of 1e-16 m grows.
    assert!(apart < 1e-12, "{apart:e} m");
}

/// Largest distance of any particle in the two simulations \[m\].
fn largest_difference(a: &Simulation, b: &Simulation) -> f64 {
    let at = |simulation: &Simulation, index: usize| {
        let particles = &simulation.state().particles;
        particles.position[particles.slot[index] as usize]
    };
    let count = a.scene().particles.len();
    let differences = (0..count).flat_map(|index| {
        let (p, q) = (at(a, index), at(b, index));
        (0..3).map(move |axis| (p[axis] - q[axis]).abs())
    });
    differences.fold(0.0, f64::max)
}

#[test]
fn a_communication_step_made_in_parts_and_saved_between_them_gives_the_same_bits() {
    let given = SCENE.replace("THREADS", "2").replace("SKIN", "4.0e-4");
    let automatic = given.replace("step = 2.0e-5", "step = \"auto\"\nsafety = 0.7");
    assert_ne!(given, automatic);
    for text in [given, automatic] {
        let (mut whole, mut parts) = (start(&text), start(&text));
        let scene = whole.scene().clone();
        for (number, interval) in (0..).zip([4.0e-4, 1.0e-3, 2.03e-3]) {
            for simulation in [&mut whole, &mut parts] {
                simulation.set_input(BoundaryIndex(0), 2, 3e-5 * f64::from(number % 2));
            }
            whole.advance(interval).expect("it runs");
            let mut made = 0;
            while !parts.advance_part(interval, 1 + made % 3).expect("it runs") {
                made += 1;
                let underway = parts.state().underway.expect("a part is left");
                assert!((whole.time() - interval + underway.elapsed() - parts.time()).abs() < 1e-12);
                let bytes = parts.state().to_bytes(scene.fingerprint);
                let state = State::from_bytes(&bytes, scene.fingerprint).expect("the bytes are whole");
                parts = Simulation::resume(scene.clone(), state).expect("it is a state of the scene");
            }
            assert!(made >= 2, "{made} parts");
            assert_eq!(parts.state().fingerprint(), whole.state().fingerprint(), "after {interval} s");
        }
    }
}

#[test]
fn what_was_left_on_its_way_is_not_gone_on_with_unasked() {
    let mut simulation = simulation(1);
    assert!(!simulation.advance_part(1.0e-3, 5).unwrap());
    let time = simulation.time();
    simulation.advance(4.0e-4).unwrap();
    assert!((simulation.time() - time - 4.0e-4).abs() < 1e-15);
    assert_eq!(simulation.state().underway, None);
}
