//! A bonded block that breaks: the same bits for threads, lane widths and saved states, and books that close.

use crate::support::start;
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;

/// A block that is glued to a plane and thrown sideways, half of it faster than the other half.
const SCENE: &str = r#"
[run]
step = 2.0e-7
threads = THREADS
[material.ice]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.slow]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [13, 13, 7], spacing = 2.0e-3, radius = 1.0e-3 }
velocity = [1.0, 0.3, 0.0]
[particles.fast]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.014], counts = [13, 13, 6], spacing = 2.0e-3, radius = 1.0e-3 }
velocity = [3.0, -1.0, 0.5]
[boundary.floor]
plane = { point = [0.0, 0.0, -1.0e-3], normal = [0.0, 0.0, 1.0] }
material = "ice"
motion = { prescribed = { z = -0.2 } }
[bond.slow]
FORMULATION
between = ["slow", "slow"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.slow.breakage]
max_normal_stress = 4.0e6
max_shear_stress = 4.0e6
[bond.fast]
FORMULATION
between = ["slow", "fast"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.fast.breakage]
max_normal_stress = 4.0e6
max_shear_stress = 4.0e6
[bond.glue]
FORMULATION
between = ["slow", "floor"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.glue.breakage]
max_normal_stress = 2.0e6
max_shear_stress = 2.0e6
[output]
energy = true
"#;

/// The formulations, with the rows that each keeps.
const FORMULATIONS: [&str; 3] = ["finite_rotation", "incremental", "engine_exact"];

/// The scene with this many threads and this formulation.
fn simulation(threads: usize, formulation: &str) -> Simulation {
    let formulation = format!("formulation = \"{formulation}\"");
    let text = SCENE.replace("THREADS", &threads.to_string()).replace("FORMULATION", &formulation);
    start(&text)
}

/// Runs some communication steps. Returns how many bonds broke.
fn run(simulation: &mut Simulation, steps: usize) -> usize {
    (0..steps)
        .map(|_| {
            simulation.advance(2.0e-6).expect("it runs");
            simulation.state().breaks.len()
        })
        .sum()
}

#[test]
fn threads_and_lane_widths_give_the_same_bits() {
    for formulation in FORMULATIONS {
        let mut first = simulation(1, formulation);
        let broken = run(&mut first, 25);
        assert!(broken > 100, "{formulation}: {broken} bonds broke");
        let expected = first.state().fingerprint();
        for threads in 2..=4 {
            let mut other = simulation(threads, formulation);
            assert_eq!(other.threads(), threads);
            assert_eq!(run(&mut other, 25), broken, "{formulation}, {threads} threads");
            assert_eq!(other.state().fingerprint(), expected, "{formulation}, {threads} threads");
        }
        for width in Width::ALL.into_iter().filter(|width| width.offered()) {
            let mut other = simulation(1, formulation);
            other.set_width(width);
            run(&mut other, 25);
            assert_eq!(other.state().fingerprint(), expected, "{formulation}, {width:?}");
        }
    }
}

#[test]
fn a_state_that_went_through_bytes_continues_with_the_same_bits() {
    for formulation in FORMULATIONS {
        let mut unbroken = simulation(2, formulation);
        run(&mut unbroken, 12);
        let scene = unbroken.scene().clone();
        let bytes = unbroken.state().to_bytes(scene.fingerprint);
        run(&mut unbroken, 12);
        let state = State::from_bytes(&bytes, scene.fingerprint).expect("the bytes are whole");
        let mut resumed = Simulation::resume(scene, state).unwrap();
        run(&mut resumed, 12);
        assert_eq!(resumed.state().fingerprint(), unbroken.state().fingerprint(), "{formulation}");
    }
}

#[test]
fn every_bond_is_alive_or_told_and_the_books_close() {
    for formulation in FORMULATIONS {
        let mut simulation = simulation(1, formulation);
        let made: u64 = simulation.state().bonds.iter().map(|list| list.made).sum();
        assert_eq!(made, 12 * 13 * 7 * 2 + 13 * 13 * 6 + 2 * 13 * 13, "{formulation}");
        let told = run(&mut simulation, 25) as u64;
        let state = simulation.state();
        let living: u64 = state.bonds.iter().map(|list| list.first.len() as u64).sum();
        assert_eq!(living + told, made, "{formulation}");
        assert!(told > 0 && state.bonds.iter().any(|list| list.released > 0.0));
        let turnover = state.ledger.as_ref().expect("the scene keeps a book").turnover;
        let residual = simulation.energy_residual().expect("the scene keeps a book");
        assert!(residual.abs() < 1e-12 * turnover, "{formulation}: {residual:e} J of {turnover:e} J");
    }
}
