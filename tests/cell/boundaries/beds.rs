//! Beds on a floor that goes on through the faces of a cell.

use super::scenes::{EDGE, bumpy, floor_file, scene, sheet};
use crate::support::{Files, cell, read_with, start_with};
use cograin::lanes::Width;
use cograin::simulation::Simulation;

/// A bed on a mesh that goes on, between a group and a plate that presses.
fn bed(threads: usize) -> (String, Files) {
    let mut list = Vec::new();
    for k in 0..6 * 6 * 3 {
        let [i, j, layer] = [k % 6, k / 6 % 6, k / 36].map(f64::from);
        list.push([
            [0.0065 * i + 0.001 * layer, 0.0065 * j + 0.0004 * i, 0.0046 + 0.0062 * layer],
            [0.2 * (0.3 * i).sin(), 0.1 * (j + layer).cos(), -0.1],
            [0.0; 3],
        ]);
    }
    for k in 0..8 * 8 {
        list.push([[0.005 * f64::from(k % 8), 0.005 * f64::from(k / 8), 0.0225], [0.0; 3], [0.0; 3]]);
    }
    let rest = "[boundary.floor]\nmaterial = \"glass\"\nmesh = { file = \"floor.obj\" }\nmotion = { prescribed = { x = 0.8 } }\n\
                [boundary.post]\nmaterial = \"glass\"\ndisc = { centre = [0.039, 0.01, 0.01], normal = [1.0, 0.0, 0.2], radius = 0.004 }\n\
                motion = { conveying = { z = 0.1 } }\n\
                [boundary.platen]\nparticles = { box = [[-1.0, -1.0, 0.022], [1.0, 1.0, 0.023]] }\n\
                motion = { prescribed = { x = -0.3 }, servo = { z = { target = 3.0, speed = 0.2 } } }\n";
    let (a, b) = ([EDGE, 0.0, 0.0], [0.0, EDGE, 0.0]);
    let edges = [a, b, [0.0, 0.0, EDGE]];
    let text = scene(&list, &(rest.to_owned() + &cell(edges, "periodic = [\"x\", \"y\"]")));
    let text = text.replace("[run]", &format!("[run]\nthreads = {threads}"));
    let files = floor_file(&sheet([a, b], [[0, 1], [0, 1]], |i, j| 0.4 * bumpy(i, j)));
    (text.replace("2e-6", "1e-5").replace("max_overlap = 0.3", "max_overlap = 0.9"), files)
}

#[test]
fn bits_are_the_same_for_threads_lanes_and_after_save_and_restore() {
    let begin = |threads: usize, width: Width| {
        let (text, files) = bed(threads);
        let mut simulation = start_with(&text, files);
        simulation.set_width(width);
        simulation
    };
    let run = |threads: usize, width: Width, kept: bool| {
        let mut simulation = begin(threads, width);
        for step in 0..6 {
            simulation.advance(5e-3).unwrap();
            if kept && step == 3 {
                let state = simulation.state().clone();
                simulation = begin(threads, width);
                simulation.restore(&state).unwrap();
            }
        }
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    assert!(first.clock.rebuilds > 4 && first.boundaries[0].brought_back[0] > 0.0);
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn another_scene_takes_over_what_has_gone_through_the_faces() {
    use cograin::simulation::Description;
    use std::sync::Arc;
    let (text, files) = bed(1);
    let mut first = start_with(&text, files.clone());
    for _ in 0..7 {
        first.advance(5e-3).unwrap();
    }
    assert!(first.state().boundaries[0].brought_back[0] > 0.0);
    let from = Description::of(first.scene(), "first.toml", first.time());
    let second = Arc::new(read_with(&text.replace("[output]", "[output]\nhistory_interval = 0.1"), files).unwrap());
    let (second, left) = Simulation::taken_over(second, first.state(), &from).unwrap();
    assert!(left.is_empty(), "{left:?}");
    assert_eq!(second.contact_count(), first.contact_count());
    let energies = [first.elastic_energy(), second.elastic_energy()];
    assert!((energies[1] - energies[0]).abs() < 1e-3 * energies[0], "{energies:?}");
}

#[test]
fn a_platen_presses_a_bed_over_a_floor_that_goes_on() {
    let (text, files) = bed(1);
    let damping =
        "[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = false\napplied_forces_damped = false\n[run]";
    let still = text.replace("motion = { prescribed = { x = 0.8 } }", "").replace("x = -0.3", "x = 0.0");
    let still = still.replace("motion = { conveying = { z = 0.1 } }", "");
    let mut simulation = start_with(&still.replace("[run]", damping), files);
    simulation.advance(0.35).unwrap();
    simulation.advance(0.05).unwrap();
    let forces = simulation.state().boundaries.iter().map(|boundary| boundary.mean_force[2]).collect::<Vec<_>>();
    let weight = 108.0 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.003_f64.powi(3) * 9.81;
    assert!((forces[2] - 3.0).abs() < 0.05, "{forces:?}");
    assert!((forces.iter().sum::<f64>() + weight).abs() < 0.02 * weight, "{forces:?} {weight}");
}
