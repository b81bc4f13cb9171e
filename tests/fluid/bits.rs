//! A fluid gives the same bits for threads, lanes, restored states and scaled lengths.

use super::scenes::{AROUND, give, stirred, swirl};
use crate::support::{start, velocity_of_first};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;

/// Grains and clumps that fall on a floor through a fluid which stirs them.
const STIRRED: &str = r#"
gravity = [0.3, 0.0, -9.81]
[run]
step = 2.0e-5
threads = THREADS
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.a.a]
restitution = 0.6
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 2.0e-3 }, { position = [3.0e-3, 0.0, 0.0], radius = 2.0e-3 }]
[particles.pairs]
material = "a"
clump = "pair"
lattice = { kind = "simple_cubic", counts = [5, 5, 2], radius = 4.0e-3, spacing = 0.012, origin = [0.004, 0.004, 0.06] }
[particles.grains]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.004, 0.004, 0.004], counts = [12, 12, 6], spacing = 8.0e-3, radius = 4.02e-3 }
velocity = [0.4, 0.1, -0.6]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
porosity = 0.7
torque = true
velocity = { prescribed = { x = { sine = { amplitude = 0.01, frequency = 50.0 } } } }
[fluid.water.drag.di_felice]
[output]
energy = true
losses = true
"#;

#[test]
fn threads_lanes_and_restored_states_give_the_same_bits() {
    let run = |threads: &str, width: Option<Width>, restored: bool| {
        let mut simulation = start(&STIRRED.replace("THREADS", threads));
        width.into_iter().for_each(|width| simulation.set_width(width));
        simulation.advance(1e-3).unwrap();
        if restored {
            let scene = simulation.scene().clone();
            let bytes = simulation.state().to_bytes(scene.fingerprint);
            let state = State::from_bytes(&bytes, scene.fingerprint).unwrap();
            simulation = Simulation::resume(scene, state).unwrap();
        }
        simulation.advance(1e-3).unwrap();
        simulation.state().fingerprint()
    };
    let one = run("1", None, false);
    assert_eq!(run("3", None, false), one);
    assert_eq!(run("1", Some(Width::Least), false), one);
    assert_eq!(run("2", None, true), one);
}

#[test]
fn threads_lanes_restored_and_repeated_steps_give_the_same_bits() {
    let run = |threads, width: Option<Width>, again: bool| {
        let mut simulation = stirred(threads, AROUND, "[output]\nenergy = true\nlosses = true");
        width.into_iter().for_each(|width| simulation.set_width(width));
        give(&mut simulation, "velocity", swirl);
        simulation.advance(1e-3).unwrap();
        if again {
            let scene = simulation.scene().clone();
            let bytes = simulation.state().to_bytes(scene.fingerprint);
            let state = State::from_bytes(&bytes, scene.fingerprint).unwrap();
            simulation = Simulation::resume(scene, state.clone()).unwrap();
            give(&mut simulation, "velocity", |cell| swirl(cell + 7));
            simulation.advance(1e-3).unwrap();
            simulation.restore(&state).unwrap();
        }
        give(&mut simulation, "velocity", |cell| swirl(cell + 1));
        simulation.advance(1e-3).unwrap();
        simulation.state().fingerprint()
    };
    let one = run(1, None, false);
    assert_eq!(run(3, None, false), one);
    assert_eq!(run(1, Some(Width::Least), false), one);
    assert_eq!(run(2, None, true), one);
}

#[test]
fn lengths_scaled_by_a_power_of_two_give_the_same_bits() {
    // Density stays, viscosity goes with length²/time.
    let run = |lengths: f64, times: f64| {
        let (r, mu, step) = (1e-3 * lengths, 1e-3 * lengths * lengths / times, 1e-4 * times);
        let mut simulation = start(&format!(
            r#"
gravity = [0.0, 0.0, {:?}]
[run]
step = {step:?}
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{{ position = [0.0, 0.0, 0.0], radius = {r:?} }}]
[fluid.water]
density = 1000.0
viscosity = {mu:?}
porosity = 0.6
velocity = [{:?}, 0.0, 0.0]
[fluid.water.drag.beetstra]
"#,
            -9.81 * lengths / (times * times),
            0.25 * lengths / times
        ));
        simulation.advance(200.0 * step).unwrap();
        velocity_of_first(&simulation).map(|part| (part * times / lengths).to_bits())
    };
    assert_eq!(run(1.0, 1.0), run(4.0, 2.0));
    assert_eq!(run(1.0, 1.0), run(0.125, 0.5));
}

#[test]
fn lengths_scaled_by_a_power_of_two_give_the_same_bits_in_cells() {
    let run = |lengths: f64, times: f64| {
        let (r, mu, step) = (1e-3 * lengths, 1e-3 * lengths * lengths / times, 1e-4 * times);
        let mut simulation = start(&format!(
            r#"
gravity = [0.0, 0.0, {:?}]
[run]
step = {step:?}
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{{ position = [{:?}, {:?}, {:?}], radius = {r:?} }}]
[grid.column]
box = [[0.0, 0.0, 0.0], [{:?}, {:?}, {:?}]]
counts = [3, 2, 5]
[fluid.water]
density = 1000.0
viscosity = {mu:?}
grid = "column"
velocity = "driven"
[fluid.water.drag.beetstra]
"#,
            -9.81 * lengths / (times * times),
            0.0153 * lengths,
            0.0133 * lengths,
            0.0353 * lengths,
            0.03 * lengths,
            0.03 * lengths,
            0.04 * lengths,
        ));
        give(&mut simulation, "velocity", |cell| swirl(cell).map(|part| part * lengths / times));
        simulation.advance(100.0 * step).unwrap();
        let row = simulation.state().particles.velocity[0];
        [0, 1, 2].map(|axis| (row[axis] * times / lengths).to_bits())
    };
    assert_eq!(run(1.0, 1.0), run(4.0, 2.0));
    assert_eq!(run(1.0, 1.0), run(0.125, 0.5));
}
