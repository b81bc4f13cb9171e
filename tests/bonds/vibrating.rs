//! Bonded bodies vibrate as accurately as `[run] accuracy` says, and those that only hold a load pay nothing for it.

use crate::support::start;
use cograin::simulation::Simulation;
use std::f64::consts::TAU;

/// Radius of the spheres \[m\].
const RADIUS: f64 = 5e-3;

/// Density of the spheres \[kg/m³\].
const DENSITY: f64 = 2500.0;

/// Normal stiffness of bonds per area \[Pa/m\].
const STIFFNESS: f64 = 1e10;

/// A scene of spheres that bonds hold in a row.
fn scene(run: &str, spheres: &[[f64; 2]], rest: &str) -> String {
    let list: Vec<String> = spheres
        .iter()
        .map(|[x, v]| format!("{{ position = [{x:?}, 0.0, 0.0], radius = {RADIUS:?}, velocity = [{v:?}, 0.0, 0.0] }}"))
        .collect();
    format!(
        "[run]\nthreads = 1\nend = 1.0\n{run}\n[output]\nenergy = true\n[material.g]\ndensity = {DENSITY:?}\nyoungs_modulus = 1e8\npoissons_ratio = 0.3\n\
         [pair.g.g]\nrestitution = 0.9\nfriction = 0.3\n[contact.c.normal.hertz]\n[contact.c.tangential.history]\n\
         [particles.p]\nmaterial = \"g\"\nlist = [{}]\n\
         [bond.b]\nbetween = [\"p\", \"p\"]\ncreate_distance = 0.01025\nnormal_stiffness = {STIFFNESS:?}\ntangential_stiffness = 4e9\n\
         contact = \"none\"\n{rest}",
        list.join(",\n")
    )
}

/// Angular frequency of two bonded spheres along their axis \[rad/s\].
fn frequency() -> f64 {
    let mass = DENSITY * 2.0 / 3.0 * TAU * RADIUS.powi(3);
    (STIFFNESS * 0.5 * TAU * RADIUS * RADIUS / (0.5 * mass)).sqrt()
}

/// Velocity along x of a particle \[m/s\].
fn velocity(simulation: &Simulation, id: usize) -> f64 {
    let particles = &simulation.state().particles;
    particles.velocity[particles.slot[id] as usize][0]
}

/// The period that the sphere of this index has, from where its velocity beside a drift goes through 0 upwards \[s\].
fn period(simulation: &mut Simulation, drift: f64, expected: f64) -> f64 {
    let interval = expected / 50.0;
    let (mut crossings, mut before) = (Vec::new(), velocity(simulation, 0) - drift);
    while crossings.len() < 9 {
        simulation.advance(interval).expect("it runs");
        let now = velocity(simulation, 0) - drift;
        if before < 0.0 && now >= 0.0 {
            crossings.push(simulation.time() - interval * now / (now - before));
        }
        before = now;
    }
    (crossings[8] - crossings[0]) / 8.0
}

#[test]
fn two_bonded_spheres_swing_with_the_right_frequency_and_energy_also_in_flight() {
    for drift in [0.0, 0.01, 10.0] {
        for (run, error) in [("", 1e-2), ("accuracy = 0.001", 1e-3)] {
            let row = [[0.0, drift + 0.01], [0.01, drift - 0.01]];
            let mut simulation = start(&scene(run, &row, ""));
            let energy = |simulation: &Simulation| simulation.kinetic_energy() + simulation.elastic_energy();
            let (begun, vibration) = (energy(&simulation), 1.3e-7);
            let expected = TAU / frequency();
            let found = period(&mut simulation, drift, expected);
            assert!((found / expected - 1.0).abs() < 0.5 * error, "{found} s, {expected} s expected");
            let gained = (energy(&simulation) - begun).abs() / vibration;
            assert!(gained < 2.5 * error, "the energy is off by {gained}");
        }
    }
}

#[test]
fn a_chain_that_swings_slowly_takes_longer_time_steps_than_a_pair() {
    let count = 30;
    // The longest wave of a free chain.
    let row: Vec<[f64; 2]> = (0..count)
        .map(|place| [0.01 * f64::from(place), 0.01 * (0.5 * TAU * (f64::from(place) + 0.5) / f64::from(count)).cos()])
        .collect();
    let mut simulation = start(&scene("", &row, ""));
    let part = simulation.state().clock.step / simulation.state().clock.stable;
    assert!(part > 0.75, "{part} of the stable step");
    let highest = frequency() * 2.0_f64.sqrt();
    let expected = TAU / (highest * (0.25 * TAU / f64::from(count)).sin());
    let found = period(&mut simulation, 0.0, expected);
    assert!((found / expected - 1.0).abs() < 5e-3, "{found} s, {expected} s expected");
}

#[test]
fn a_bonded_row_that_holds_a_load_takes_the_stable_step() {
    let row: Vec<[f64; 2]> = (0..6).map(|place| [0.01 * f64::from(place), 0.0]).collect();
    let grips = "[boundary.left]\nparticles = { set = \"p\", box = [[-1e-3, -1.0, -1.0], [1e-3, 1.0, 1.0]] }\nmotion = \"fixed\"\n\
                 [boundary.right]\nparticles = { set = \"p\", box = [[0.049, -1.0, -1.0], [0.051, 1.0, 1.0]] }\n\
                 motion = { driven = [\"x\"] }\n";
    let damped = "[bond.b.damping.viscous]\nnormal_force = 0.1\n";
    let text = scene("", &row, &format!("{damped}{grips}"));
    let mut simulation = start(&text);
    for done in 1..=40 {
        simulation.set_input(cograin::quantity::BoundaryIndex(1), 0, -1e-8 * f64::from(done));
        simulation.advance(1e-3).expect("it runs");
    }
    let part = simulation.state().clock.step / simulation.state().clock.stable;
    assert!(part > 0.7, "{part} of the stable step");
}

#[test]
fn a_pair_that_spins_or_hangs_on_what_moves_does_not_vibrate() {
    let spins = scene("", &[[0.0, 0.0], [0.01, 0.0]], "")
        .replacen("velocity = [0.0, 0.0, 0.0]", "velocity = [3.0, -0.5, 0.0], angular_velocity = [0.0, 0.0, 100.0]", 1)
        .replacen("velocity = [0.0, 0.0, 0.0]", "velocity = [3.0, 0.5, 0.0], angular_velocity = [0.0, 0.0, 100.0]", 1);
    let moves = scene(
        "",
        &[[0.0, 0.0], [0.01, 0.0]],
        "[boundary.left]\nparticles = { set = \"p\", box = [[-1e-3, -1.0, -1.0], [1e-3, 1.0, 1.0]] }\nmotion = \"fixed\"\n\
         [boundary.right]\nparticles = { set = \"p\", box = [[9e-3, -1.0, -1.0], [0.011, 1.0, 1.0]] }\n\
         motion = { prescribed = { x = 1e-5 } }\n",
    );
    for text in [spins, moves] {
        let mut simulation = start(&text);
        // What stretches as it begins to spin swings; as it is it has far less energy than the motion.
        let square = simulation.state().pace.vibration;
        assert!(square < 1.01 * frequency() * frequency(), "{square}, {} at most", frequency() * frequency());
        simulation.advance(1e-4).expect("it runs");
    }
}

#[test]
fn the_frequency_that_the_step_follows_is_part_of_the_state() {
    let row = [[0.0, 0.02], [0.01, -0.01], [0.02, 0.005]];
    let text = scene("", &row, "");
    let (mut whole, mut straight) = (start(&text), start(&text));
    for _ in 0..40 {
        whole.advance(1.7e-4).expect("it runs");
        let bytes = whole.state().to_bytes(0);
        let mut restored = start(&text.replace("threads = 1", "threads = 2"));
        restored.restore(&cograin::state::State::from_bytes(&bytes, 0).unwrap()).unwrap();
        whole = restored;
        straight.advance(1.7e-4).expect("it runs");
    }
    assert!(straight.state() == whole.state(), "a run that was saved and restored has other bits");
}
