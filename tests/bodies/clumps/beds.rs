//! Beds of clumps: bits, books, momentum, rest, stiffness.

use super::scenes::{ELASTIC, apart, bed, bits, three, tumbling};
use crate::support::{read, start};
use cograin::lanes::Width;
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::statics::stiffness;
use cograin_sparse::factorise;
use std::sync::Arc;

#[test]
fn threads_lanes_saving_and_restoring_change_no_bit() {
    let books =
        "[output]\nenergy = true\nlosses = true\n[damping.all]\nlinear = 0.1\nangular = 0.1\ngravity_damped = false";
    for more in ["", books] {
        let mut one = start(&bed(1, 1.0, more));
        one.advance(0.008).expect("it runs");
        let saved = one.state().clone();
        one.advance(0.008).expect("it runs");
        for (threads, width) in [(2, Width::widest()), (3, Width::Least), (1, Width::Four)] {
            let mut other = start(&bed(threads, 1.0, more));
            other.set_width(width);
            other.advance(0.008).expect("it runs");
            assert_eq!(bits(&other), saved.fingerprint(), "{threads} threads, {width:?}");
            other.advance(0.001).expect("it runs");
            other.restore(&saved).expect("its own state");
            other.advance(0.008).expect("it runs");
            assert_eq!(bits(&other), bits(&one), "{threads} threads, {width:?}, restored");
        }
        assert!(one.contact_count() > 100, "{} contacts", one.contact_count());
    }
}

#[test]
fn a_scene_scaled_by_powers_of_two_gives_the_same_bits() {
    let (mut one, mut twice) = (start(&bed(1, 1.0, "")), start(&bed(1, 2.0, "")));
    one.advance(0.004).expect("it runs");
    twice.advance(0.004).expect("it runs");
    let (a, b) = (&one.state().clumps, &twice.state().clumps);
    for clump in 0..a.len() {
        for axis in 0..3 {
            assert_eq!(2.0 * a.position[clump][axis], b.position[clump][axis], "clump {clump}");
        }
        assert_eq!(a.orientation[clump], b.orientation[clump], "clump {clump}");
    }
}

#[test]
fn both_books_close_and_momentum_is_conserved() {
    for damping in ["", "[damping.all]\nlinear = 0.2\nangular = 0.1\ngravity_damped = true"] {
        let mut simulation = start(&bed(1, 1.0, &format!("[output]\nenergy = true\nlosses = true\n{damping}")));
        simulation.advance(0.02).expect("it runs");
        let turnover = simulation.state().ledger.as_ref().expect("a book").turnover;
        let residual = simulation.energy_residual().expect("a book");
        // Each of 2000 steps rounds.
        assert!(residual.abs() < 1e-12 * turnover, "{residual:e} J of {turnover:e} J");
        let physical = simulation.physical_residual().expect("a book");
        // The error of the time steps.
        assert!(physical.abs() < 2e-3 * turnover, "{physical:e} J of {turnover:e} J");
    }
}

#[test]
fn momentum_changes_by_the_impulses_of_boundaries_and_weight() {
    let mut simulation = start(&bed(1, 1.0, ""));
    let momentum = |simulation: &Simulation| {
        let mut sum = [0.0; 3];
        let particles = &simulation.state().particles;
        for [x, y, z, mass] in &simulation.state().clumps.velocity {
            sum.iter_mut().zip([x, y, z]).for_each(|(sum, part)| *sum += mass * part);
        }
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0) {
            let [x, y, z, mass] = particles.velocity[slot];
            sum.iter_mut().zip([x, y, z]).for_each(|(sum, part)| *sum += mass * part);
        }
        sum
    };
    let mass: f64 = simulation.scene().particles.iter().map(|it| it.mass()).sum();
    let before = momentum(&simulation);
    simulation.advance(0.02).expect("it runs");
    let after = momentum(&simulation);
    let impulse = |axis: usize| -simulation.state().boundaries.iter().map(|it| it.total_impulse[axis]).sum::<f64>();
    let size = mass * 9.81 * 0.02;
    for axis in 0..3 {
        let weight = if axis == 2 { -size } else { 0.0 };
        let rest = after[axis] - before[axis] - weight - impulse(axis);
        assert!(rest.abs() < 1e-11 * size, "along {axis}: {rest:e} N s of {size:e} N s");
    }
    assert!(impulse(2) > 0.1 * size, "the floor pushes");
}

#[test]
fn a_bed_comes_to_rest_and_a_checkpoint_of_it_is_where_another_scene_begins() {
    let settled = bed(1, 1.0, "[damping.all]\nlinear = 0.4\nangular = 0.4\ngravity_damped = true");
    let mut simulation = start(&settled);
    simulation.advance(0.1).expect("it runs");
    let (first, reached) = (simulation.scene().clone(), simulation.state().clone());
    let description = cograin::simulation::Description::of(&first, "settled.toml", simulation.time());
    let next = Arc::new(read(&bed(1, 1.0, "")).expect("a scene"));
    let (again, left) = Simulation::taken_over(next, &reached, &description).expect("it is taken over");
    assert!(left.is_empty(), "{left:?}");
    for (slot, row) in reached.particles.position.iter().enumerate() {
        let index = reached.particles.id[slot] as usize;
        let there = again.state().particles.position[again.state().particles.slot[index] as usize];
        assert!(apart(three(*row), three(there)) < 1e-15, "{row:?}, {there:?}");
    }
    assert_eq!(again.contact_count(), simulation.contact_count());
    assert!((again.kinetic_energy() - simulation.kinetic_energy()).abs() <= 1e-12 * simulation.kinetic_energy());
}

#[test]
fn a_bed_of_clumps_is_as_stiff_as_it_is_when_time_steps_have_settled() {
    let mut list = Vec::new();
    for (x, y, z) in (0..2).flat_map(|x| (0..4).flat_map(move |y| (0..3).map(move |z| (x, y, z)))) {
        let place = [0.009995 + 0.03998 * f64::from(x), 0.01999 * f64::from(y), 0.009995 + 0.01999 * f64::from(z)];
        list.push(format!("{{ position = {place:?} }}"));
    }
    let plane = |name: &str, point: [f64; 3], normal: [f64; 3]| {
        format!("[boundary.{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"a\"\n")
    };
    let planes = [
        plane("west", [-0.009995, 0.0, 0.0], [1.0, 0.0, 0.0]),
        plane("east", [0.069965, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        plane("south", [0.0, -0.009995, 0.0], [0.0, 1.0, 0.0]),
        plane("north", [0.0, 0.069965, 0.0], [0.0, -1.0, 0.0]),
        plane("lid", [0.0, 0.0, 0.05997], [0.0, 0.0, -1.0]),
        plane("floor", [0.0; 3], [0.0, 0.0, 1.0]),
    ];
    let mut simulation = start(&format!(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 5.0e-6\n{}\n[contact.touch.tangential.history]\n[clump.pair]\nspheres = [{{ position = \
         [0.0, 0.0, 0.0], radius = 0.01 }}, {{ position = [0.01999, 0.0, 0.0], radius = 0.01 }}]\n[particles.bed]\nmaterial = \"a\"\nclump = \
         \"pair\"\nlist = [{}]\n[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = true\n{}motion = {{ driven = [\"x\", \"z\"] }}\n",
        ELASTIC.replace("1.0e9", "5.0e7").replace("restitution = 1.0", "restitution = 0.5\nfriction = 0.5"),
        list.join(", "),
        planes.concat()
    ));
    let floor = BoundaryIndex(5);
    let to = |simulation: &mut Simulation, axis: usize, way: f64, time: f64| {
        simulation.set_input(floor, axis, way);
        simulation.advance(0.02).expect("it runs");
        simulation.advance(time).expect("it runs");
        simulation.state().boundaries[5].force[2]
    };
    // Pressed and sheared a little, and left alone.
    to(&mut simulation, 2, 2.0e-6, 0.05);
    to(&mut simulation, 0, 1.0e-6, 0.25);
    let found = stiffness(&simulation, &[floor], Some(factorise)).expect("a stiffness").boundaries[0].matrix[2][2];
    let state = simulation.state().clone();
    let there = to(&mut simulation, 2, 2.0e-6 + 1.0e-9, 0.15);
    simulation.restore(&state).expect("its own state");
    let back = to(&mut simulation, 2, 2.0e-6 - 1.0e-9, 0.15);
    let expected = (back - there) / 2.0e-9;
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} N/m, {expected} N/m when it has settled");
}

#[test]
fn the_stable_step_is_that_of_the_group_of_the_same_spheres() {
    let (clump, group) = (tumbling(true), tumbling(false));
    let (a, b) = (clump.stable_step(), group.stable_step());
    assert!((0.5..=2.0).contains(&(a / b)), "{a:e} s, {b:e} s in a group");
}
