//! Work of nodes, and runs of them.

use super::scenes::{
    DRIVEN, OVERLAP, RADIUS, Stage, advance, dot, drive, length, nodes, over, rough_stage, shake, sheet, sum, three,
};
use cograin::simulation::{RunError, Simulation};
use cograin::state::State;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::sync::Arc;

#[test]
fn work_is_that_of_the_nodes_whatever_the_spheres_do() {
    for input in ["", "input = \"ramp\""] {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let motion = format!("{DRIVEN}\n{input}");
        let mut simulation = Stage { motion: &motion, ..rough_stage(5) }.start();
        let mut turnover = 0.0;
        for _ in 0..40 {
            shake(&mut simulation, 3e-4, &mut rng);
            let (before, work) = (nodes(&simulation).displacement.clone(), simulation.state().boundaries[0].work);
            advance(&mut simulation, 2.5e-4);
            let nodes = nodes(&simulation);
            let mut done = 0.0;
            for ((now, then), force) in nodes.displacement.iter().zip(&before).zip(&nodes.mean_force) {
                let part = dot(three(*force), sum(three(*now), three(*then), -1.0));
                (done, turnover) = (done - part, turnover + part.abs());
            }
            let apart = (simulation.state().boundaries[0].work - work - done).abs();
            assert!(apart <= 1e-12 * turnover, "{apart} J of {turnover} J");
        }
        assert!(turnover > 1e-6, "{turnover} J");
    }
}

#[test]
fn the_energy_of_elastic_spheres_changes_by_the_work_of_the_nodes_with_the_second_power_of_the_step() {
    let error = |step: f64| {
        let run = format!("step = {step:?}\nthreads = 1");
        let stage = Stage {
            law: "",
            properties: [1.0, 0.0, 0.0],
            run: &run,
            motion: "nodes = \"driven\"\ninput = \"smooth\"",
            ..rough_stage(9)
        };
        let mut simulation = Stage { gravity: [0.0; 3], ..stage }.start();
        let energy = |it: &Simulation| it.kinetic_energy() + it.elastic_energy();
        let (begun, mut most) = (energy(&simulation), 0.0_f64);
        for number in 0..10 {
            let lift = 2e-4 * f64::from(number + 1);
            drive(&mut simulation, |[x, y, _]| [0.05 * lift, -0.02 * lift, lift * (1.0 + 20.0 * x - 10.0 * y)]);
            advance(&mut simulation, 8e-4);
            let gained = energy(&simulation) - begun;
            most = most.max((gained - simulation.state().boundaries[0].work).abs() / begun);
        }
        most
    };
    let errors = [8e-6, 4e-6, 2e-6].map(error);
    assert!(errors[0] < 2e-3 && errors[2] < 0.1 * errors[0], "{errors:?}");
}

#[test]
fn a_membrane_that_is_stretched_presses_as_before_and_carries_the_load() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mesh = sheet(8, 0.03, 0.0, &mut rng);
    let spheres = vec![[[1e-4, -2e-4, RADIUS - OVERLAP], [0.0; 3], [0.0; 3]]];
    let boundary = "[boundary.hand]\nparticles = { set = \"all\" }\n";
    let motion = format!("{DRIVEN}\n{boundary}");
    let stage = Stage { spheres, mesh, law: "", motion: &motion, properties: [1.0, 0.0, 0.0], ..Stage::default() };
    let mut simulation = stage.start();
    let modulus = 5.0e6 / (1.0 - 0.3 * 0.3) / 2.0;
    let hertz = 4.0 / 3.0 * modulus * (RADIUS * OVERLAP.powi(3)).sqrt();
    for number in 0..=20 {
        drive(&mut simulation, |[x, y, _]| [0.01 * f64::from(number) * x, 0.01 * f64::from(number) * y, 0.0]);
        advance(&mut simulation, 1e-4);
        let all = nodes(&simulation).force.iter().fold([0.0; 3], |all, row| sum(all, three(*row), 1.0));
        assert!(length(sum(all, [0.0, 0.0, -hertz], -1.0)) < 1e-11 * hertz, "{all:?} N, not {hertz} N down");
        // The sphere's force goes to the nodes around it alone, whose moment about its foot is zero.
        let loaded = nodes(&simulation).force.iter().filter(|row| row[2] != 0.0).count();
        assert!((1..=4).contains(&loaded), "{loaded} nodes");
    }
    assert!(simulation.state().boundaries[0].work.abs() < 1e-18, "no work along the surface");
}

#[test]
fn threads_and_saved_states_change_no_bit() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let (mesh, spheres) = (sheet(30, 0.35, 5e-4, &mut rng), over(2500, 0.34, 1e-4, &mut rng));
    let start = |threads: usize| {
        let run = format!("step = 1e-6\nthreads = {threads}");
        Stage {
            spheres: spheres.clone(),
            mesh: mesh.clone(),
            run: &run,
            gravity: [0.0, 0.0, -100.0],
            ..Stage::default()
        }
        .start()
    };
    let go_on = |simulation: &mut Simulation, from: u64| {
        for number in from..6 {
            shake(simulation, 1e-4, &mut ChaCha8Rng::seed_from_u64(number));
            advance(simulation, 2e-5);
        }
        simulation.state().to_bytes(0)
    };
    let mut first = start(1);
    let saved = {
        for number in 0..3 {
            shake(&mut first, 1e-4, &mut ChaCha8Rng::seed_from_u64(number));
            advance(&mut first, 2e-5);
        }
        first.state().to_bytes(0)
    };
    let expected = go_on(&mut first, 3);
    assert!(first.state().walls[0].particle.len() > 500);
    for threads in [2, 3] {
        assert!(go_on(&mut start(threads), 0) == expected, "{threads} threads");
    }
    let state = State::from_bytes(&saved, 0).unwrap_or_else(|error| panic!("{error}"));
    let mut resumed = Simulation::resume(Arc::clone(first.scene()), state).unwrap_or_else(|fault| panic!("{fault}"));
    assert!(go_on(&mut resumed, 3) == expected, "resumed");
}

#[test]
fn a_face_without_area_stops_the_run_in_words_and_the_way_back_leads_to_the_beginning() {
    let mut simulation = rough_stage(6).start();
    drive(&mut simulation, |[x, y, _]| [1e-3 * x, 0.0, 1e-3 * y]);
    simulation.advance_or_roll_back(1e-5).unwrap_or_else(|error| panic!("{error}"));
    let before = simulation.state().clone();
    drive(&mut simulation, |[x, _, z]| [-x, 0.0, -z]);
    let error = simulation.advance_or_roll_back(1e-5).expect_err("a sheet on a line");
    assert!(matches!(&error, RunError::Collapsed { boundary, face: 1, .. } if boundary == "sheet"), "{error}");
    let said = error.to_string();
    assert!(said.contains(" without one at t = 0.0000") && said.contains("moved onto a line or a point"), "{said}");
    drive(&mut simulation, |[x, y, _]| [1e-3 * x, 0.0, 1e-3 * y]);
    assert!(*simulation.state() == before, "the state of the beginning");
    advance(&mut simulation, 1e-5);
    drive(&mut simulation, |_| [1e300; 3]);
    assert!(simulation.advance(1e-5).is_err(), "nodes out of all bounds");
}
