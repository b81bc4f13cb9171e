//! Lattices of pairs of spheres, whose stress has a closed form.

use super::scenes::{LAW, strain};
use crate::support::{DRIVEN, assert_all_near, start};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::statics::stiffness;
use cograin_sparse::factorise;
use std::fmt::Write as _;

/// Force between two equal spheres of this radius \[m\] that overlap by so much \[m\] \[N\].
fn hertz(radius: f64, overlap: f64) -> f64 {
    let modulus = 1e7 / (2.0 * (1.0 - 0.0625));
    4.0 / 3.0 * modulus * (0.5 * radius).sqrt() * overlap.powf(1.5)
}

/// Of a pair of spheres of radius 1 along x: how far each is from the middle, and the other; the edges of its cell along and across.
const PAIR: [f64; 4] = [0.75, 1.5, 3.46, 1.98];

/// A pair whose mass centre is here in cells of one pair each, so many along each edge; with this law beside that of Hertz.
fn lattice(counts: [usize; 3], at: [f64; 3], law: &str, pair: &str) -> Simulation {
    let [_, _, long, wide] = PAIR;
    let size = [long, wide, wide];
    let mut list = String::new();
    for x in 0..counts[0] {
        for y in 0..counts[1] {
            for z in 0..counts[2] {
                let place = [x, y, z].into_iter().zip(size).zip(at).map(|((n, size), at)| n as f64 * size + at);
                let _ = write!(list, "{{ position = {:?} }},", place.collect::<Vec<_>>());
            }
        }
    }
    let edge = |axis: usize| counts[axis] as f64 * size[axis];
    let mut simulation = start(&format!(
        r#"
[run]
step = 1e-4
{LAW}
{law}
[pair.a.a]
{pair}
[clump.pair]
spheres = [{{ position = [-0.75, 0.0, 0.0], radius = 1.0 }}, {{ position = [0.75, 0.0, 0.0], radius = 1.0 }}]
[particles.p]
material = "a"
clump = "pair"
list = [{list}]
[cell]
edges = [[{:?}, 0.0, 0.0], [0.0, {:?}, 0.0], [0.0, 0.0, {:?}]]
{DRIVEN}
"#,
        edge(0),
        edge(1),
        edge(2)
    ));
    simulation.set_width(Width::widest());
    simulation
}

/// Stress of the lattice of pairs: along x each touches the next with one sphere, along y and z with both; the cell is so sheared.
fn stress_of_pairs(shear: f64) -> [f64; 6] {
    let [_, apart, long, wide] = PAIR;
    let volume = long * wide * wide;
    let along = hertz(1.0, 2.0 - (long - apart)) * long / volume;
    let across = hertz(1.0, 2.0 - wide) * wide / volume;
    // From a sphere to its image along the second edge.
    let (x, y) = (shear * wide, wide);
    let length = x.hypot(y);
    let leaning = hertz(1.0, 2.0 - length) / length / volume;
    [-along - 2.0 * leaning * x * x, -2.0 * leaning * y * y, -2.0 * across, -2.0 * leaning * x * y, 0.0, 0.0]
}

#[test]
fn a_lattice_of_pairs_carries_the_stress_of_its_branches() {
    // In the middle of the cell, astride one face, astride a corner, and many edges away.
    for at in [[1.7, 0.99, 0.99], [0.1, 0.99, 0.99], [0.0, 0.0, 0.0], [3.3, 1.9, 0.01], [-33.0, 17.0, 5.0]] {
        for counts in [[1, 1, 1], [2, 1, 1], [2, 3, 2]] {
            let mut simulation = lattice(counts, at, "", "restitution = 1.0");
            assert_all_near(&simulation.cell_stress(), &stress_of_pairs(0.0), 1e-12, "stress");
            strain(&mut simulation, &[("xy", 0.01)], 1e-4);
            assert_all_near(&simulation.cell_stress(), &stress_of_pairs(0.01), 1e-10, "stress sheared");
        }
    }
    let simulation = lattice([1, 1, 1], [0.0; 3], "", "restitution = 1.0");
    // The union of two spheres: their volume less the lens, of two caps of height 1/4.
    let pi = std::f64::consts::PI;
    let solid = 8.0 / 3.0 * pi - 2.0 * pi * 0.25_f64.powi(2) * (1.0 - 0.25 / 3.0);
    let [_, _, long, wide] = PAIR;
    assert_all_near(&[simulation.cell_porosity()], &[1.0 - solid / (long * wide * wide)], 1e-12, "porosity");
}

#[test]
fn a_region_of_clumps_carries_the_stress_of_its_branches_and_one_that_spins_freely_none() {
    let [_, apart, long, wide] = PAIR;
    let region = |from: [f64; 3]| {
        let to = [from[0] + long, from[1] + wide, from[2] + wide];
        format!("[region.all]\nbox = [{from:?}, {to:?}]\n")
    };
    for from in [[0.0, 0.0, 0.0], [0.4, 0.3, -7.1]] {
        let simulation = lattice([1, 1, 1], [1.7, 0.97, 0.95], &region(from), "restitution = 1.0");
        let carried = cograin::averages::carried(&simulation)[0];
        let volume = long * wide * wide;
        let expected = stress_of_pairs(0.0);
        assert_all_near(&[0, 1, 2].map(|axis| carried[axis][axis] / volume), &expected[..3], 1e-12, "stress carried");
    }
    let mut spinning = start(&format!(
        "[run]\nstep = 1e-4\n{LAW}\n[pair.a.a]\nrestitution = 1.0\n[clump.pair]\nspheres = [{{ position = [0.0, 0.0, 0.0], \
         radius = 1.0 }}, {{ position = [{apart:?}, 0.0, 0.0], radius = 0.5 }}]\n[particles.p]\nmaterial = \"a\"\nclump = \"pair\"\n\
         list = [{{ position = [0.1, 0.2, 0.3], velocity = [0.5, 0.0, 0.0], angular_velocity = [0.0, 3.0, 1.0] }}]\n\
         [region.all]\nbox = [[-5.0, -5.0, -5.0], [5.0, 5.0, 5.0]]\n"
    ));
    spinning.advance(0.01).unwrap();
    let content = cograin::averages::contents(&spinning)[0];
    assert_all_near(&content.velocity, &[0.5, 0.0, 0.0], 1e-12, "velocity");
    assert!(content.granular_temperature() < 1e-20, "{}", content.granular_temperature());
}

#[test]
fn the_tangent_of_a_lattice_of_pairs_is_the_derivative_of_its_stress() {
    for counts in [[1, 1, 1], [2, 1, 2]] {
        let simulation = lattice(
            counts,
            [0.1, 0.99, 0.0],
            "[contact.touch.tangential.history]",
            "restitution = 1.0\nfriction = 0.5",
        );
        let found = stiffness(&simulation, &[], Some(factorise)).expect("a tangent");
        assert_eq!(found.freedoms, 6 * counts.iter().product::<usize>(), "six for each clump");
        let matrix = found.cell.expect("a cell").matrix;
        let stress = |strains: [f64; 3]| {
            let [_, apart, long, wide] = PAIR;
            let [a, b, c] =
                [long, wide, wide].into_iter().zip(strains).map(|(edge, it)| edge * it.exp()).collect::<Vec<_>>()[..]
            else {
                panic!("three edges")
            };
            let along = hertz(1.0, 2.0 - (a - apart)) / (b * c);
            [-along, -2.0 * hertz(1.0, 2.0 - b) / (a * c), -2.0 * hertz(1.0, 2.0 - c) / (a * b)]
        };
        for component in 0..3 {
            let at = |way: f64| stress([0, 1, 2].map(|k| if k == component { way } else { 0.0 }));
            let (there, back) = (at(1e-6), at(-1e-6));
            let expected: Vec<f64> = there.iter().zip(back).map(|(there, back)| (there - back) / 2e-6).collect();
            let entries: Vec<f64> = matrix[..3].iter().map(|row| row[component]).collect();
            assert_all_near(&entries, &expected, 1e-5, "tangent");
        }
    }
}
