//! Clumps in a periodic cell: stress against closed forms, work, motion through the faces, bits.

use crate::support::start;
use cograin::interface::{Interface, Value};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use cograin::state::State;
use cograin::statics::stiffness;
use cograin_sparse::factorise;
use std::fmt::Write as _;

/// Spheres of this modulus and Poisson's ratio 0.25.
const LAW: &str = r#"
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[contact.touch.normal.hertz]
"#;

/// Force between two equal spheres of this radius \[m\] that overlap by so much \[m\] \[N\].
fn hertz(radius: f64, overlap: f64) -> f64 {
    let modulus = 1e7 / (2.0 * (1.0 - 0.0625));
    4.0 / 3.0 * modulus * (0.5 * radius).sqrt() * overlap.powf(1.5)
}

/// All components of the strain follow inputs.
const DRIVEN: &str = "motion = { driven = [\"xx\", \"yy\", \"zz\", \"xy\", \"xz\", \"yz\"] }";

/// The strains in the order of the program.
const STRAINS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

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

/// Strains a cell at once, in one communication step, by its inputs.
fn strain(simulation: &mut Simulation, strains: &[(&str, f64)], interval: f64) {
    let interface = Interface::of(simulation.scene());
    for (name, value) in strains {
        let input = interface.find(&format!("cell.strain.{name}")).expect("an input");
        interface.set(simulation, input, Value::Real(*value)).expect("a strain");
    }
    simulation.advance(interval).expect("it runs");
}

/// Whether numbers are those that are expected.
#[track_caller]
fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    let size = expected.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let near = found.iter().zip(expected).all(|(found, it)| (found - it).abs() <= tolerance * size);
    assert!(near, "{found:?}, {expected:?} expected");
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
            assert_near(&simulation.cell_stress(), &stress_of_pairs(0.0), 1e-12);
            strain(&mut simulation, &[("xy", 0.01)], 1e-4);
            assert_near(&simulation.cell_stress(), &stress_of_pairs(0.01), 1e-10);
        }
    }
    let simulation = lattice([1, 1, 1], [0.0; 3], "", "restitution = 1.0");
    // The union of two spheres: their volume less the lens, of two caps of height 1/4.
    let pi = std::f64::consts::PI;
    let solid = 8.0 / 3.0 * pi - 2.0 * pi * 0.25_f64.powi(2) * (1.0 - 0.25 / 3.0);
    let [_, _, long, wide] = PAIR;
    assert_near(&[simulation.cell_porosity()], &[1.0 - solid / (long * wide * wide)], 1e-12);
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
        assert_near(&[0, 1, 2].map(|axis| carried[axis][axis] / volume), &expected[..3], 1e-12);
    }
    let mut spinning = start(&format!(
        "[run]\nstep = 1e-4\n{LAW}\n[pair.a.a]\nrestitution = 1.0\n[clump.pair]\nspheres = [{{ position = [0.0, 0.0, 0.0], \
         radius = 1.0 }}, {{ position = [{apart:?}, 0.0, 0.0], radius = 0.5 }}]\n[particles.p]\nmaterial = \"a\"\nclump = \"pair\"\n\
         list = [{{ position = [0.1, 0.2, 0.3], velocity = [0.5, 0.0, 0.0], angular_velocity = [0.0, 3.0, 1.0] }}]\n\
         [region.all]\nbox = [[-5.0, -5.0, -5.0], [5.0, 5.0, 5.0]]\n"
    ));
    spinning.advance(0.01).unwrap();
    let content = cograin::averages::contents(&spinning)[0];
    assert_near(&content.velocity, &[0.5, 0.0, 0.0], 1e-12);
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
            assert_near(&entries, &expected, 1e-5);
        }
    }
}

/// Clumps of three spheres and loose ones in a cell, that are pressed together; each at a place and turned as a generator says.
fn dense(pair: &str, more: &str, shift: [f64; 3], threads: usize) -> String {
    format!(
        r#"
[run]
step = 5e-6
threads = {threads}
{LAW}
[contact.touch.tangential.history]
[pair.a.a]
{pair}
[clump.bent]
spheres = [
    {{ position = [0.0, 0.0, 0.0], radius = 0.002 }},
    {{ position = [0.003, 0.0, 0.0], radius = 0.002 }},
    {{ position = [0.003, 0.003, 0.0], radius = 0.0015 }},
]
[particles.bent]
material = "a"
clump = "bent"
orientation = "random"
lattice = {{ kind = "simple_cubic", origin = {:?}, counts = [4, 4, 3], radius = 0.0039, spacing = 0.008 }}
[particles.loose]
material = "a"
lattice = {{ kind = "simple_cubic", origin = {:?}, counts = [7, 7, 1], radius = 0.0019, spacing = 0.0045 }}
[cell]
edges = [[0.032, 0.0, 0.0], [0.0, 0.032, 0.0], [0.0, 0.0, 0.028]]
{DRIVEN}
[output]
energy = true
losses = true
{more}
"#,
        shift,
        [shift[0], shift[1], shift[2] + 0.022],
    )
}

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
    assert_near(&clumps, &loose, 1e-6);
    assert_near(&[work], &[expected], 1e-6);
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
        assert_near(&run(order), &right, 1e-9);
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
    assert_near(&again, &stress, 1e-6);
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
        assert_near(&found, &velocity, 1e-9);
        assert_near(&turned, &spin, 1e-9);
    }
}
