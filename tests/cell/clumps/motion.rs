//! Dense clumps that are strained, and clumps that fly through the faces.

use super::scenes::{LAW, STRAINS, dense, strain};
use crate::support::{DRIVEN, assert_all_near, start};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;

/// With friction and dashpots.
const ROUGH: &str = "restitution = 0.6\nfriction = 0.4";

/// Strains to which the dense cell is brought, one after the other.
const COURSE: [[f64; 6]; 3] = [
    [-0.30, -0.30, -0.30, 0.0, 0.0, 0.0],
    [-0.45, -0.42, -0.42, 0.05, -0.03, 0.02],
    [-0.42, -0.45, -0.45, 0.10, -0.06, 0.02],
];

#[test]
fn work_is_conjugate_stress_times_strain_times_volume_and_the_books_close() {
    let mut simulation = start(&dense(ROUGH, "", [0.0; 3], 1));
    let mut before = [0.0; 6];
    for strains in COURSE {
        for part in 1..=4 {
            let to: [f64; 6] = std::array::from_fn(|k| before[k] + (strains[k] - before[k]) * f64::from(part) / 4.0);
            let from: [f64; 6] = simulation.state().cell.as_ref().unwrap().strain;
            let (work, volume) = (simulation.state().cell.as_ref().unwrap().work, simulation.cell_volume());
            strain(&mut simulation, &STRAINS.into_iter().zip(to).collect::<Vec<_>>(), 2e-3);
            let cell = simulation.state().cell.as_ref().unwrap();
            let parts: [f64; 6] = std::array::from_fn(|k| cell.conjugate_stress[k] * (to[k] - from[k]) * volume);
            let (expected, size) = (parts.iter().sum::<f64>(), parts.iter().map(|part| part.abs()).sum::<f64>());
            assert!((cell.work - work - expected).abs() <= 1e-11 * size, "{} J, {expected} J", cell.work - work);
        }
        before = strains;
    }
    assert!(simulation.contact_count() > 100, "{}", simulation.contact_count());
    let turnover = simulation.state().ledger.as_ref().unwrap().turnover;
    let residual = simulation.energy_residual().unwrap();
    assert!(residual.abs() < 1e-12 * turnover, "{residual:e} J of {turnover:e} J");
    let (physical, work) = (simulation.physical_residual().unwrap(), simulation.state().cell.as_ref().unwrap().work);
    // The error of the time steps.
    assert!(physical.abs() < 1e-2 * work, "{physical:e} J of {work:e} J");
    // Nothing but the streaming motion changes the momentum.
    let (state, mut momentum, mut size) = (simulation.state(), [0.0; 3], 0.0);
    let loose = state.particles.slots().filter(|&slot| state.particles.owner[slot] == 0);
    for row in loose.map(|slot| state.particles.velocity[slot]).chain(state.clumps.velocity.iter().copied()) {
        for axis in 0..3 {
            momentum[axis] += row[3] * row[axis];
            size += row[3] * row[axis].abs();
        }
    }
    let given = state.cell.as_ref().unwrap().impulse;
    for axis in 0..3 {
        assert!((momentum[axis] - given[axis]).abs() < 1e-11 * size, "{momentum:?} {given:?} of {size}");
    }
}

#[test]
fn the_physical_residual_vanishes_with_the_square_of_the_step() {
    let residual = |step: &str| {
        let text = dense("restitution = 1.0\nfriction = 0.0", "", [0.0; 3], 1).replace("step = 5e-6", step);
        let mut simulation = start(&text);
        for strains in &COURSE[..2] {
            strain(&mut simulation, &STRAINS.into_iter().zip(*strains).collect::<Vec<_>>(), 8e-3);
        }
        (simulation.physical_residual().unwrap(), simulation.state().cell.as_ref().unwrap().work)
    };
    let ((coarse, work), (fine, _)) = (residual("step = 2e-5"), residual("step = 5e-6"));
    assert!(coarse.abs() < 5e-2 * work && fine.abs() < 0.25 * coarse.abs(), "{coarse:e} J, {fine:e} J of {work:e} J");
}

#[test]
fn clumps_of_one_sphere_do_what_loose_spheres_do() {
    let run = |is_clump: bool| {
        let text = dense(ROUGH, "", [0.0; 3], 1);
        let loose = "material = \"a\"\nlattice = { kind = \"simple_cubic\", origin = [0.0, 0.0, 0.022]";
        let text = if is_clump {
            text.replace(loose, &loose.replace("lattice", "clump = \"ball\"\nlattice")).replace(
                "[clump.bent]",
                "[clump.ball]\nspheres = [{ position = [0.0, 0.0, 0.0], radius = 0.0019 }]\n[clump.bent]",
            )
        } else {
            text
        };
        let mut simulation = start(&text);
        for strains in &COURSE[..2] {
            strain(&mut simulation, &STRAINS.into_iter().zip(*strains).collect::<Vec<_>>(), 1e-3);
        }
        assert_eq!(simulation.state().clumps.len(), if is_clump { 97 } else { 48 });
        (simulation.cell_stress(), simulation.state().cell.as_ref().unwrap().work)
    };
    let ((clumps, work), (loose, expected)) = (run(true), run(false));
    // Impacts make roundings larger.
    assert_all_near(&clumps, &loose, 1e-6, "velocities");
    assert_all_near(&[work], &[expected], 1e-6, "work");
}

#[test]
fn stress_follows_permuted_axes() {
    let run = |order: [usize; 3]| {
        let turn = |row: [f64; 3]| order.map(|axis| row[axis]);
        let (a, b) = (turn([0.75, 0.1, -0.3]), turn([-0.75, -0.1, 0.3]));
        let edges = turn([3.2, 1.98, 1.9]);
        let at: Vec<_> = [[0.0, 0.0, 0.0], [2.62, 0.79, 0.9]].into_iter().map(turn).collect();
        let speeds: Vec<_> = [[0.4, -0.7, 0.9], [-0.4, 0.7, -0.9]].into_iter().map(turn).collect();
        let edge = |axis: usize| {
            let mut row = [0.0; 3];
            row[axis] = edges[axis];
            row
        };
        let mut simulation = start(&format!(
            "[run]\nstep = 1e-4\nmax_overlap = 1.0\n{LAW}\n[pair.a.a]\nrestitution = 0.9\n[clump.pair]\nspheres = [{{ position = {a:?}, radius = 0.7 }}, \
             {{ position = {b:?}, radius = 0.7 }}]\n[particles.p]\nmaterial = \"a\"\nclump = \"pair\"\nlist = [{{ position = {:?}, \
             velocity = {:?} }}, {{ position = {:?}, velocity = {:?} }}]\n[cell]\nedges = {:?}\n{DRIVEN}\n",
            at[0],
            speeds[0],
            at[1],
            speeds[1],
            [edge(0), edge(1), edge(2)]
        ));
        let strains = turn([-0.01, 0.02, -0.015]);
        strain(&mut simulation, &STRAINS.into_iter().zip(strains).collect::<Vec<_>>(), 2e-3);
        let stress = simulation.cell_stress();
        let whole = |i: usize, j: usize| match (i.min(j), i.max(j)) {
            (a, b) if a == b => stress[a],
            (0, b) => stress[2 + b],
            _ => stress[5],
        };
        // Back into the first order.
        let place = [0, 1, 2].map(|axis| order.iter().position(|it| *it == axis).unwrap());
        [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]].map(|[i, j]| whole(place[i], place[j]))
    };
    let right = run([0, 1, 2]);
    assert!(right.iter().all(|part| part.abs() > 1e-6 * right[0].abs()), "{right:?}");
    for order in [[1, 2, 0], [2, 0, 1], [1, 0, 2]] {
        assert_all_near(&run(order), &right, 1e-9, "stress");
    }
}

#[test]
fn what_is_written_whole_edges_away_has_the_same_bits_and_a_shift_changes_roundings_only() {
    let run = |shift: [f64; 3]| {
        let mut simulation = start(&dense(ROUGH, "", shift, 1));
        strain(&mut simulation, &STRAINS.into_iter().zip(COURSE[0]).collect::<Vec<_>>(), 2e-3);
        let state = simulation.state();
        (simulation.cell_stress(), state.clumps.velocity.clone(), state.clumps.position.clone())
    };
    let (stress, velocities, places) = run([0.0; 3]);
    // A shift by which no number is rounded otherwise: the clumps are astride the same faces.
    let (again, _, _) = run([0.011, -0.0203, 0.005]);
    assert_all_near(&again, &stress, 1e-6, "stress");
    let one = |shift: f64| {
        let at = [0.25 + shift, 1.75, 0.5 - shift];
        let mut simulation = start(&format!(
            "[run]\nstep = 1e-4\nmax_overlap = 1.0\n{LAW}\n[pair.a.a]\nrestitution = 0.9\n[clump.pair]\nspheres = [{{ position = [-0.5, 0.0, 0.0], radius = 0.5 \
             }}, {{ position = [0.5, 0.0, 0.0], radius = 0.5 }}]\n[particles.p]\nmaterial = \"a\"\nclump = \"pair\"\nlist = [{{ position = \
             {at:?}, velocity = [0.3, 0.0, 0.2] }}, {{ position = [1.25, 1.25, 1.25], velocity = [0.0, 0.5, -0.5] }}]\n[cell]\nedges = \
             [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]\n{DRIVEN}\n"
        ));
        strain(&mut simulation, &[("xx", -0.05), ("xy", 0.1)], 0.05);
        let state = simulation.state();
        (simulation.cell_stress(), state.clumps.velocity.clone(), state.clumps.position.clone())
    };
    assert_eq!(one(0.0), one(4.0));
    assert_eq!(one(0.0), one(-64.0));
    assert!(velocities.len() == 48 && places.len() == 48);
}

#[test]
fn bits_are_the_same_for_threads_lanes_and_after_save_and_restore() {
    let run = |threads: usize, width: Width, is_saved: bool| {
        let mut simulation = start(&dense(ROUGH, "", [0.0; 3], threads));
        simulation.set_width(width);
        for (place, strains) in COURSE.into_iter().enumerate() {
            strain(&mut simulation, &STRAINS.into_iter().zip(strains).collect::<Vec<_>>(), 4e-4);
            if is_saved && place == 1 {
                let bytes = simulation.state().to_bytes(1);
                let scene = std::sync::Arc::clone(simulation.scene());
                simulation = Simulation::resume(scene, State::from_bytes(&bytes, 1).unwrap()).unwrap();
            }
        }
        simulation.state().fingerprint()
    };
    let right = run(1, Width::widest(), false);
    assert_eq!(run(1, Width::Least, false), right);
    assert_eq!(run(3, Width::Four, false), right);
    assert_eq!(run(2, Width::widest(), true), right);
}

#[test]
fn two_clumps_that_meet_across_a_face_do_what_they_do_in_the_open() {
    let run = |cell: &str, at: f64| {
        let mut simulation = start(&format!(
            "[run]\nstep = 1e-4\n{LAW}\n[contact.touch.tangential.history]\n[pair.a.a]\nrestitution = 0.8\nfriction = 0.3\n[clump.pair]\nspheres \
             = [{{ position = [-0.5, 0.0, 0.0], radius = 0.5 }}, {{ position = [0.5, 0.0, 0.0], radius = 0.4 }}]\n[particles.p]\nmaterial = \
             \"a\"\nclump = \"pair\"\nlist = [{{ position = [{:?}, 2.0, 2.0], velocity = [1.0, 0.1, 0.0], angular_velocity = [0.0, 1.0, 3.0] \
             }}, {{ position = [{:?}, 2.2, 2.1], velocity = [-1.0, 0.0, 0.2] }}]\n{cell}",
            at - 1.2,
            at + 1.2
        ));
        simulation.advance(1.0).expect("it runs");
        let clumps = &simulation.state().clumps;
        let three = |rows: &[[f64; 4]]| rows.iter().flat_map(|row| row[..3].to_vec()).collect::<Vec<_>>();
        (three(&clumps.velocity), three(&clumps.angular_velocity))
    };
    let (velocity, spin) = run("", 4.0);
    assert!(velocity[0] < 0.9 && spin[5] != 0.0, "they have met: {velocity:?} {spin:?}");
    let cell = "[cell]\nedges = [[8.0, 0.0, 0.0], [1.0, 8.0, 0.0], [0.5, 1.0, 8.0]]\n";
    for at in [4.0, 8.6, 0.4, 1.9] {
        let (found, turned) = run(cell, at);
        assert_all_near(&found, &velocity, 1e-9, "velocity");
        assert_all_near(&turned, &spin, 1e-9, "spin");
    }
}
