//! What steps do: motion, work, several instances.

use super::host::{Host, Unpacked, source};
use crate::types::Status;
use crate::v2::values::fmi2CancelStep;
use crate::v2::*;
use cograin::scene::Source;
use std::ptr;
use std::thread;

#[test]
fn setting_an_input_changes_no_output_before_the_next_step() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.shake(0, 3);
    let before = host.outputs();
    assert_eq!(host.set("floor.displacement.z", 3.0e-4), Status::Ok);
    assert_eq!(host.outputs(), before);
    assert_eq!(host.get("floor.displacement.z"), 3.0e-4);
}

#[test]
fn a_start_value_moves_the_boundary_without_motion() {
    let unit = Unpacked::new();
    let host = Host::instantiated(&unit);
    assert_eq!(host.set("floor.displacement.z", 1.0e-4), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    let pushed = host.get("floor.force.z");
    assert_eq!(host.set("floor.displacement.z", -1.0e-2), Status::Ok);
    assert_eq!(host.get("floor.force.z"), 0.0);
    assert_eq!(host.set("floor.displacement.z", 1.0e-4), Status::Ok);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);

    let rest = Host::started(&unit).get("floor.force.z");
    assert!(pushed < 2.0 * rest && rest < 0.0, "{pushed} N pushed up, {rest} N left alone");
    assert_eq!(host.get("floor.force.z"), pushed);
    assert_eq!(host.get("floor.mean_force.z"), pushed);
    assert_eq!((host.get("floor.work"), host.get("energy.kinetic")), (0.0, 0.0));
    let before = host.get("floor.displacement.z");
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
    assert_eq!(host.get("floor.displacement.z"), before);
    assert_eq!(host.get("floor.work"), 0.0, "a boundary that stays does no work");
}

#[test]
fn work_is_mean_force_times_displacement() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    let mut before = [("floor", ["x", "z"].as_slice(), 0.0, vec![0.0, 0.0]), ("grip", &["z"], 0.0, vec![0.0])];
    for index in 0..30 {
        host.shake(index, 1);
        for (boundary, axes, work, places) in &mut before {
            let mut expected = 0.0;
            let mut scale = f64::MIN_POSITIVE;
            for (axis, place) in axes.iter().zip(places.iter_mut()) {
                let now = host.get(&format!("{boundary}.displacement.{axis}"));
                let part = -host.get(&format!("{boundary}.mean_force.{axis}")) * (now - *place);
                expected += part;
                scale += part.abs();
                *place = now;
            }
            let now = host.get(&format!("{boundary}.work"));
            let change = now - *work;
            // work is a sum from the start: its rounding counts too
            let rounding = 1e-12 * (scale + now.abs());
            assert!((change - expected).abs() <= rounding, "{boundary}, step {index}: {change} J, {expected} J");
            *work = now;
        }
    }
    assert!(host.get("floor.work").abs() > 1e-7, "the floor did {} J", host.get("floor.work"));
}

#[test]
fn an_input_with_a_rate_ends_further_on() {
    let unit = Unpacked::new();
    let (host, other) = (Host::started(&unit), Host::started(&unit));
    assert_eq!(host.set("floor.displacement.z", 0.0), Status::Ok);
    assert_eq!(host.set_rate("floor.displacement.z", 0.5), Status::Ok);
    assert_eq!(other.set("floor.displacement.z", 0.5 * 2.0e-4), Status::Ok);
    for host in [&host, &other] {
        assert_eq!(host.step(0.0, 2.0e-4), Status::Ok);
    }
    assert_eq!(host.get("floor.force.z"), other.get("floor.force.z"));
    assert_eq!(host.get("floor.work"), other.get("floor.work"));
}

#[test]
fn communication_steps_may_vary_and_whole_time_steps_give_the_same_bits() {
    let unit = Unpacked::new();
    let (host, other) = (Host::started(&unit), Host::started(&unit));
    for index in 0..6 {
        assert_eq!(host.step(f64::from(index) * 1.0e-4, 1.0e-4), Status::Ok);
    }
    let mut time = 0.0;
    for length in [2.0e-4, 3.0e-4, 1.0e-5, 9.0e-5] {
        assert_eq!(other.step(time, length), Status::Ok, "{}", other.said());
        time += length;
    }
    for name in ["floor.force.x", "floor.force.z", "grip.force.z", "energy.kinetic", "overlap.max"] {
        assert_eq!(host.get(name).to_bits(), other.get(name).to_bits(), "{name}");
    }
}

#[test]
fn a_host_whose_steps_are_not_quite_whole_time_steps_is_followed() {
    let unit = Unpacked::new();
    for part in [-9e-7, 9e-7, -5e-7, 5e-7] {
        let host = Host::started(&unit);
        let length = 1.0e-5 * (1.0 + part);
        for count in 0..3000 {
            assert_eq!(host.step(f64::from(count) * length, length), Status::Ok, "{part}: {}", host.said());
        }
    }
}

#[test]
fn a_step_left_out_or_made_twice_is_refused_at_any_start_time() {
    let unit = Unpacked::new();
    for start in [0.0, 86400.0, 3.0e7, 1.7e9] {
        for (wrong, length) in [2.0, 4.0].into_iter().flat_map(|wrong| [(wrong, 1.0e-3), (wrong, 1.0e-5)]) {
            let host = Host::instantiated(&unit);
            assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, start, 0, 0.0), Status::Ok);
            assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
            assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
            for count in 0..3 {
                assert_eq!(host.step(start + f64::from(count) * length, length), Status::Ok, "{}", host.said());
            }
            host.refused(
                host.step(start + wrong * length, length),
                &["communication point: expected the present time"],
            );
        }
    }
}

#[test]
fn two_instances_in_turn_do_what_each_does_alone() {
    let unit = Unpacked::new();
    let text = source().text.replace("friction = 0.4", "friction = 0.1");
    let slippery = Unpacked::of(&Source { text, ..source() }, "slippery");
    let alone = [Host::started(&unit).shake(0, 12), Host::started(&slippery).shake(0, 12)];
    assert!(alone[0] != alone[1]);

    let (host, other) = (Host::started(&unit), Host::started(&slippery));
    let mut seen = [Vec::new(), Vec::new()];
    for index in 0..12 {
        seen[0].extend(host.shake(index, 1));
        seen[1].extend(other.shake(index, 1));
    }
    assert!(seen == alone, "the instances disturb each other");
}

#[test]
fn instances_in_threads_do_what_each_does_alone() {
    let unit = Unpacked::new();
    let alone = Host::started(&unit).shake(0, 12);
    let runs: Vec<Vec<u64>> = thread::scope(|scope| {
        let threads: Vec<_> = (0..3).map(|_| scope.spawn(|| Host::started(&unit).shake(0, 12))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(runs.iter().all(|run| *run == alone));
}

#[test]
fn the_energy_book_closes() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.shake(0, 40);
    let (residual, work) = (host.get("energy.residual"), host.get("floor.work").abs());
    assert!(residual.abs() < 1e-12 * work, "{residual} J left over of {work} J");
}

#[test]
fn a_step_under_way_is_cancelled_from_another_thread() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.refused(fmi2CancelStep(host.component), &["no communication step is under way"]);
    host.shake(0, 3);
    let before = host.outputs();
    let address = host.component.addr();
    let canceller = thread::spawn(move || {
        // long enough for the step to be under way
        thread::sleep(std::time::Duration::from_millis(500));
        fmi2CancelStep(ptr::without_provenance_mut(address))
    });
    let time = 3.0 * 2.0e-4;
    // a hundred million time steps
    assert_eq!(host.step(time, 1.0e3), Status::Discard, "{}", host.said());
    assert_eq!(canceller.join().unwrap(), Status::Ok);
    assert!(host.said().contains("stopped at t = "), "{}", host.said());
    assert_eq!(host.outputs(), before, "the state is that of the step's beginning");
    assert_eq!(host.step(time, 2.0e-4), Status::Ok);
}

#[test]
fn a_step_that_nobody_would_see_the_end_of_is_refused_with_the_count() {
    let unit = Unpacked::new();
    let host = Host::started(&unit);
    host.refused(
        host.step(0.0, 1.0e5),
        &["expected at most 9.9e8 time steps", "found 1.0e10", "time steps of 1.00e-5 s"],
    );
    assert_eq!(host.step(0.0, 1.0e-4), Status::Ok);
}

#[test]
fn a_unit_that_begins_in_a_state_counts_from_there_whatever_is_set() {
    let source = source();
    let scene = std::sync::Arc::new(cograin::scene::Scene::from_source(&source).unwrap());
    let mut simulation = cograin::simulation::Simulation::new(std::sync::Arc::clone(&scene)).unwrap();
    simulation.advance(2.0e-3).unwrap();
    assert!(simulation.dissipated_energy().unwrap() != 0.0);
    let state = simulation.state().to_bytes(scene.fingerprint);
    let unit = Unpacked::begun(&source, Some(state), "begun");
    for start in [None, Some(1.0e-5)] {
        let host = Host::instantiated(&unit);
        if let Some(start) = start {
            assert_eq!(host.set("floor.displacement.z", start), Status::Ok);
        }
        assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
        for name in ["floor.work", "energy.dissipated", "energy.residual"] {
            assert_eq!(host.get(name), 0.0, "{name} with a start value of {start:?}");
        }
    }
}

#[test]
fn termination_tells_of_a_servo_that_missed_its_stress() {
    let text = "[run]\nend = 1.0\n[material.g]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\n[pair.g.g]\nrestitution = 0.5\n\
                friction = 0.3\n[contact.c.normal.hertz]\n[particles.p]\nmaterial = \"g\"\nlist = [{ position = [0.5, 0.5, 0.5], radius = 0.1 }]\n\
                [cell]\nedges = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n\
                motion = { servo = { zz = { stress = -1e3, max_rate = 0.1 } } }\n";
    let source = Source { name: "scene.toml".to_owned(), text: text.to_owned(), files: Default::default() };
    let unit = Unpacked::of(&source, "servo");
    let host = Host::started(&unit);
    assert_eq!(host.step(0.0, 1.0e-2), Status::Ok);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    let (status, category, said) = host.heard().pop().unwrap();
    assert_eq!((status, category.as_str()), (Status::Warning, "logStatusWarning"));
    assert!(said.starts_with("fmi2Terminate: [cell] servo: zz has ") && said.ends_with("to be -1.0000e3 Pa"), "{said}");
}
