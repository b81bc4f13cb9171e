//! The books of lift and added mass, and their bits.

use super::scenes::{AROUND, give, stirred_by, sum, swirl};
use crate::support::{assert_near, start, value, velocity_of_first};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;
use cograin::state::ledger::Source;

/// Keys and tables of a fluid with everything beside drag; drag follows.
const ALL: &str = "added_mass = 0.5\n[fluid.water.lift.saffman_mei]\n[fluid.water.lift.magnus]";

/// Momentum of all that moves by forces along an axis, and the sum of its parts without their signs \[N s\].
fn momentum(simulation: &Simulation, axis: usize) -> [f64; 2] {
    let (particles, clumps) = (&simulation.state().particles, &simulation.state().clumps);
    let free = particles.slots().filter(|&slot| particles.owner[slot] == 0).map(|slot| particles.velocity[slot]);
    let parts: Vec<f64> = free.chain(clumps.velocity.iter().copied()).map(|row| row[3] * row[axis]).collect();
    [parts.iter().sum(), parts.iter().map(|part| part.abs()).sum()]
}

#[test]
fn cells_give_what_grains_and_clumps_gain_with_lift_and_added_mass() {
    let mut simulation = stirred_by(2, AROUND, &format!("pressure = \"total\"\n{ALL}"), "");
    for turn in 0..4 {
        give(&mut simulation, "velocity", |cell| swirl(cell + turn));
        give(&mut simulation, "pressure_gradient", |cell| swirl(cell + turn + 3).map(|part| 1e3 * part));
        // Time steps of one length follow each other, and of another one from the next communication step on.
        let interval = 1e-3 + 7e-6 * turn as f64;
        let before = [0, 1, 2].map(|axis| momentum(&simulation, axis)[0]);
        simulation.advance(interval).unwrap();
        for axis in 0..3 {
            let [after, scale] = momentum(&simulation, axis);
            let along = ["x", "y", "z"][axis];
            let given = ["mean_drag", "mean_pressure_force"]
                .map(|name| -interval * sum(&simulation, &format!("{name}.{along}")));
            let gained = after - before[axis];
            assert!(
                (gained - given[0] - given[1]).abs() < 2e-13 * scale,
                "{gained:e} gained, {given:?} given of {scale:e} N s"
            );
        }
    }
}

#[test]
fn the_books_close_with_lift_and_added_mass() {
    for keys in [ALL.to_owned(), format!("pressure = \"dynamic\"\n{ALL}")] {
        let mut simulation = stirred_by(1, AROUND, &keys, "[output]\nenergy = true\nlosses = true");
        let (begun, mut first) = ([0, 1, 2].map(|axis| momentum(&simulation, axis)[0]), None);
        for (turn, interval) in [1e-3, 3e-4, 0.7e-5, 1e-3].into_iter().enumerate() {
            give(&mut simulation, "velocity", |cell| swirl(cell + turn));
            simulation.advance(interval).unwrap();
            let ledger = simulation.state().ledger.as_ref().unwrap();
            let residual = simulation.energy_residual().unwrap();
            assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual:e} of {:e} J", ledger.turnover);
            let (work, taken) = (value(&simulation, "water.work"), value(&simulation, "energy.lost.drag"));
            let on_grains = ledger.work_of(Source::Fluid);
            // The first half kick has another length than its load was found for: some work of contacts is booked with that of the fluid.
            let drifted = on_grains - (work - taken);
            let at_first = *first.get_or_insert(drifted);
            assert!(turn > 1 || (drifted - at_first).abs() < 1e-12 * taken, "{work:e}, {taken:e}, {on_grains:e} J");
            for axis in 0..3 {
                let ([now, scale], impulse) =
                    (momentum(&simulation, axis), simulation.state().fluid.as_ref().unwrap().impulse[axis]);
                assert!((now - begun[axis] - impulse).abs() < 2e-13 * scale, "{now:e}, {impulse:e} N s");
            }
        }
    }
}

#[test]
fn a_half_kick_that_its_load_tells_is_that_which_is_found_anew_with_lift_and_added_mass() {
    let run = |anew: bool| {
        let keys = format!("pressure = \"total\"\n{ALL}");
        let mut simulation = stirred_by(1, AROUND, &keys, "[output]\nenergy = true\nlosses = true");
        for turn in 0..20 {
            give(&mut simulation, "velocity", |cell| swirl(cell + turn / 7));
            give(&mut simulation, "pressure_gradient", |cell| swirl(cell + turn / 7 + 3).map(|part| 1e3 * part));
            simulation.advance(2e-5).unwrap();
            if anew {
                let mut state = simulation.state().clone();
                state.fluid.as_mut().unwrap().coming.step = 0.0;
                simulation.restore(&state).unwrap();
            }
        }
        simulation
    };
    let (told, anew) = (run(false), run(true));
    let [a, b] = [&told, &anew].map(Simulation::state);
    assert_eq!(a.particles.velocity, b.particles.velocity);
    let [one, other] = [a, b].map(|state| state.fluid.as_ref().unwrap());
    let most =
        |row: usize| one.mean.iter().skip(row).step_by(3).flatten().fold(0.0_f64, |most, part| most.max(part.abs()));
    for (place, (one, other)) in one.mean.iter().zip(&other.mean).enumerate() {
        let off = (0..4).map(|part| (one[part] - other[part]).abs()).fold(0.0, f64::max);
        assert!(off <= 1e-12 * most(place % 3), "row {place}: {one:?}, anew {other:?}");
    }
    assert_near(one.work, other.work, 1e-12);
    assert_near(value(&told, "energy.lost.drag"), value(&anew, "energy.lost.drag"), 1e-12);
}

#[test]
fn threads_lanes_restored_and_repeated_steps_give_the_same_bits_with_lift_and_added_mass() {
    let run = |threads, width: Option<Width>, again: bool| {
        let mut simulation = stirred_by(threads, AROUND, ALL, "[output]\nenergy = true\nlosses = true");
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
        simulation.advance(1.003e-3).unwrap();
        simulation.state().fingerprint()
    };
    let one = run(1, None, false);
    assert_eq!(run(3, None, false), one);
    assert_eq!(run(1, Some(Width::Least), false), one);
    assert_eq!(run(2, None, true), one);
}

#[test]
fn lengths_scaled_by_a_power_of_two_give_the_same_bits_with_lift_and_added_mass() {
    let run = |lengths: f64, times: f64| {
        let (r, mu, step) = (1e-3 * lengths, 1e-3 * lengths * lengths / times, 1e-4 * times);
        let mut simulation = start(&format!(
            r#"
gravity = [0.0, 0.0, {:?}]
[run]
step = {step:?}
[material.a]
density = 900.0
[particles.sphere]
material = "a"
list = [{{ position = [{:?}, {:?}, {:?}], radius = {r:?}, angular_velocity = [0.0, {:?}, 0.0] }}]
[grid.column]
box = [[0.0, 0.0, 0.0], [{:?}, {:?}, {:?}]]
counts = [3, 2, 5]
[fluid.water]
density = 1000.0
viscosity = {mu:?}
grid = "column"
velocity = "driven"
{ALL}
[fluid.water.drag.beetstra]
"#,
            -9.81 * lengths / (times * times),
            0.0153 * lengths,
            0.0133 * lengths,
            0.0253 * lengths,
            30.0 / times,
            0.03 * lengths,
            0.03 * lengths,
            0.04 * lengths,
        ));
        for turn in 0..3 {
            give(&mut simulation, "velocity", |cell| swirl(cell + turn).map(|part| part * lengths / times));
            simulation.advance(30.0 * step).unwrap();
        }
        velocity_of_first(&simulation).map(|part| (part * times / lengths).to_bits())
    };
    assert_eq!(run(1.0, 1.0), run(4.0, 2.0));
    assert_eq!(run(1.0, 1.0), run(0.125, 0.5));
}
