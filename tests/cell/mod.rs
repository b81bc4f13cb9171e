//! A periodic cell: its images, its motion, its stress and its work, against closed forms.

mod boundaries;
mod clumps;
mod exchange;

use crate::support::{read, start};
use cograin::lanes::Width;
use cograin::simulation::Simulation;
use std::fmt::Write as _;

/// Elastic spheres with these further lines: sets, the cell, what else there is.
fn scene(law: &str, pair: &str, rest: &str) -> String {
    format!(
        "[run]\nstep = 1e-5\nend = 1.0\n[material.glass]\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\ndensity = 2500.0\n\
         [pair.glass.glass]\n{pair}\n{law}\n[output]\nenergy = true\nlosses = true\n{rest}"
    )
}

/// Without friction and damping.
const SMOOTH: [&str; 2] = ["[contact.touch.normal.hertz]", "restitution = 1.0"];

/// With both.
const ROUGH: [&str; 2] =
    ["[contact.touch.normal.hertz]\n[contact.touch.tangential.history]", "restitution = 0.6\nfriction = 0.4"];

/// A set of spheres with velocities.
fn spheres(list: &[([f64; 3], f64, [f64; 3])]) -> String {
    let mut text = "[particles.all]\nmaterial = \"glass\"\nlist = [\n".to_owned();
    for (position, radius, velocity) in list {
        let _ = writeln!(text, "{{ position = {position:?}, radius = {radius:?}, velocity = {velocity:?} }},");
    }
    text + "]\n"
}

/// A cell.
fn cell(edges: [[f64; 3]; 3], more: &str) -> String {
    format!("[cell]\nedges = {edges:?}\n{more}\n")
}

/// All six components follow inputs.
const DRIVEN: &str = "motion = { driven = [\"xx\", \"yy\", \"zz\", \"xy\", \"xz\", \"yz\"] }";

/// Numbers from 0 to 1, the same each time.
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

const STRAINS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Sites of a lattice in parts of its cubic cell.
fn sites(kind: &str) -> Vec<[f64; 3]> {
    let all = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.5], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    match kind {
        "sc" => vec![all[0]],
        "bcc" => vec![all[0], all[1]],
        _ => vec![all[0], all[2], all[3], all[4]],
    }
}

/// Stress of a lattice whose cubic cell has these edges, by the force of Hertz between neighbours.
fn stress_of_lattice(kind: &str, edges: [[f64; 3]; 3], radius: f64) -> [f64; 6] {
    let modulus = 1e7 / (2.0 * (1.0 - 0.25 * 0.25));
    let place = |part: [f64; 3]| [0, 1, 2].map(|axis| (0..3).map(|edge| part[edge] * edges[edge][axis]).sum::<f64>());
    let mut sum = [0.0; 6];
    let sites = sites(kind);
    for a in &sites {
        for b in &sites {
            for shift in 0..125 {
                let shift = [shift % 5 - 2, shift / 5 % 5 - 2, shift / 25 - 2];
                let apart = place([0, 1, 2].map(|edge| b[edge] + f64::from(shift[edge]) - a[edge]));
                let distance = apart.iter().map(|part| part * part).sum::<f64>().sqrt();
                let overlap = 2.0 * radius - distance;
                if overlap > 0.0 && distance > 0.0 {
                    let force = 4.0 / 3.0 * modulus * (0.5 * radius * overlap).sqrt() * overlap;
                    for (sum, [row, column]) in sum.iter_mut().zip(STRAINS) {
                        *sum -= 0.5 * force * apart[row] * apart[column] / distance;
                    }
                }
            }
        }
    }
    let volume = edges[0][0] * edges[1][1] * edges[2][2];
    sum.map(|sum| sum / volume)
}

/// A cell of `counts` lattice cells of this size.
fn lattice(kind: &str, counts: [usize; 3], size: f64, radius: f64, motion: &str) -> String {
    let mut list = Vec::new();
    for place in 0..counts.iter().product() {
        let at = [place % counts[0], place / counts[0] % counts[1], place / counts[0] / counts[1]];
        for site in sites(kind) {
            list.push(([0, 1, 2].map(|axis| size * (at[axis] as f64 + site[axis] + 0.1)), radius, [0.0; 3]));
        }
    }
    let [a, b, c] = counts.map(|count| size * count as f64);
    let [law, pair] = SMOOTH;
    scene(law, pair, &(spheres(&list) + &cell([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]], motion)))
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let scale = expected.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance * scale, "{what}: found {found:?}, expected {expected:?}");
    }
}

#[test]
fn lattices_carry_the_stress_of_their_neighbours_however_they_are_strained() {
    let radius = 1e-3;
    for (kind, counts, size) in [
        ("sc", [1, 1, 1], 1.96e-3),
        ("sc", [3, 4, 2], 1.96e-3),
        ("bcc", [1, 1, 1], 2.26e-3),
        ("bcc", [2, 3, 2], 2.26e-3),
        ("fcc", [1, 1, 1], 2.77e-3),
        ("fcc", [3, 2, 2], 2.77e-3),
    ] {
        let mut simulation = start(&lattice(kind, counts, size, radius, DRIVEN));
        let cube = [[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
        let what = format!("{kind} {counts:?}");
        assert_near(&simulation.cell_stress(), &stress_of_lattice(kind, cube, radius), 1e-12, &what);
        let strain = [-0.01_f64, 0.004, -0.006, 0.012, -0.02, 0.008];
        (0..6).for_each(|component| simulation.set_strain(component, strain[component]));
        simulation.advance(2e-3).unwrap();
        let [x, y, z] = [0, 1, 2].map(|axis| size * strain[axis].exp());
        let [xy, xz, yz] = [strain[3] * y, strain[4] * z, strain[5] * z];
        let edges = [[x, 0.0, 0.0], [xy, y, 0.0], [xz, yz, z]];
        assert_near(&simulation.cell_stress(), &stress_of_lattice(kind, edges, radius), 1e-9, &what);
    }
}

#[test]
fn a_lattice_that_is_sheared_by_a_whole_edge_is_what_it_was() {
    let size = 1.96e-3;
    let text = |counts| lattice("sc", counts, size, 1e-3, "motion = { shear = \"xz\" }");
    let mut simulation = start(&text([1, 1, 1]));
    let before = simulation.cell_stress();
    for share in 1..=32 {
        simulation.set_strain(4, f64::from(share) / 24.0);
        simulation.advance(2e-3).unwrap();
        let strain = f64::from(share) / 24.0;
        let edges = [[size, 0.0, 0.0], [0.0, size, 0.0], [strain * size, 0.0, size]];
        assert_near(&simulation.cell_stress(), &stress_of_lattice("sc", edges, 1e-3), 1e-9, &format!("{strain}"));
    }
    // Rows that lie in each other's gaps buckle in the end: quickly, before rounding grows.
    let mut simulation = start(&text([4, 3, 3]));
    for edges in 1..=4 {
        simulation.set_strain(4, f64::from(edges));
        simulation.advance(1e-3).unwrap();
        assert_near(&simulation.cell_stress(), &before, 1e-6, &format!("{edges} edges"));
    }
    assert!(simulation.state().cell.as_ref().unwrap().edges[2][0].abs() < size);
}

/// Spheres that do not touch, with random velocities of no momentum in sum.
fn gas(count: usize, size: f64, speed: f64) -> Vec<([f64; 3], f64, [f64; 3])> {
    let (mut random, per) = (7, (count as f64).cbrt().ceil() as usize);
    let mut list: Vec<_> = (0..count)
        .map(|place| {
            let at = [place % per, place / per % per, place / per / per];
            let position = at.map(|at| size * (at as f64 + 0.5 + 0.2 * (uniform(&mut random) - 0.5)) / per as f64);
            (position, 0.2 * size / per as f64, [(); 3].map(|()| speed * (uniform(&mut random) - 0.5)))
        })
        .collect();
    for axis in 0..3 {
        let mean = list.iter().map(|(.., velocity)| velocity[axis]).sum::<f64>() / count as f64;
        list.iter_mut().for_each(|(.., velocity)| velocity[axis] -= mean);
    }
    list
}

/// A cube.
fn cube(size: f64) -> [[f64; 3]; 3] {
    [[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]]
}

#[test]
fn an_ideal_gas_presses_by_its_kinetic_energy_and_heats_up_as_it_is_compressed() {
    let text = scene("", "", &(spheres(&gas(60, 1.0, 1.0)) + &cell(cube(1.0), DRIVEN)));
    let text = text.replace("[pair.glass.glass]\n\n", "");
    let mut simulation = start(&text);
    let energy = simulation.kinetic_energy();
    let pressure = |simulation: &Simulation| simulation.cell_stress()[..3].iter().sum::<f64>() / -3.0;
    assert_near(&[pressure(&simulation)], &[2.0 / 3.0 * energy], 1e-14, "pressure");
    for component in 0..3 {
        simulation.set_strain(component, -0.2);
    }
    simulation.advance(0.05).unwrap();
    let (warm, volume) = (simulation.kinetic_energy(), (-0.6_f64).exp());
    assert_near(&[simulation.cell_volume()], &[volume], 1e-14, "volume");
    // 5000 time steps multiply each velocity by the same rounded factor.
    let rounding = 5000.0 * 4.0 * f64::EPSILON;
    assert_near(&[warm], &[energy * volume.powf(-2.0 / 3.0)], rounding, "energy");
    assert_near(&[pressure(&simulation)], &[2.0 / 3.0 * warm / volume], 1e-12, "pressure");
    let work = simulation.state().cell.as_ref().unwrap().work;
    assert_near(&[energy + work], &[warm], rounding, "work");
    assert!(simulation.energy_residual().unwrap().abs() < 1e-12 * warm);
}

/// A dense gas of rough spheres, some across the faces, in a cell that leans over.
fn dense(law: [&str; 2], more: &str) -> String {
    let mut list = gas(120, 0.1, 1.0);
    list.iter_mut().for_each(|(_, radius, _)| *radius *= 2.2);
    let edges = [[0.1, 0.0, 0.0], [0.02, 0.1, 0.0], [-0.03, 0.01, 0.1]];
    let list: Vec<_> = list
        .into_iter()
        .map(|(part, radius, velocity)| {
            let place = [0, 1, 2].map(|axis| (0..3).map(|edge| part[edge] / 0.1 * edges[edge][axis]).sum::<f64>());
            (place, radius, velocity)
        })
        .collect();
    scene(law[0], law[1], &(spheres(&list) + &cell(edges, more))).replace("[run]", "[run]\nmax_overlap = 0.3")
}

#[test]
fn work_is_conjugate_stress_times_strain_times_volume_and_the_books_close() {
    for law in [SMOOTH, ROUGH] {
        let mut simulation = start(&dense(law, DRIVEN));
        let mut strain = [0.0; 6];
        for step in 1..=6 {
            let before = simulation.state().cell.as_ref().unwrap().work;
            let volume = simulation.cell_volume();
            let ways = [-0.004, 0.002, -0.003, 0.1, -0.002, 0.01].map(|way| way * f64::from(step));
            (0..6).for_each(|component| simulation.set_strain(component, strain[component] + ways[component]));
            simulation.advance(7e-4).unwrap();
            let cell = simulation.state().cell.as_ref().unwrap();
            let expected: f64 = (0..6).map(|k| cell.conjugate_stress[k] * (cell.strain[k] - strain[k]) * volume).sum();
            let scale: f64 =
                (0..6).map(|k| (cell.conjugate_stress[k] * (cell.strain[k] - strain[k]) * volume).abs()).sum();
            assert!((cell.work - before - expected).abs() < 1e-12 * scale, "{} {expected}", cell.work - before);
            strain = cell.strain;
        }
        let ledger = simulation.state().ledger.as_ref().unwrap();
        let residual = simulation.energy_residual().unwrap();
        assert!(residual.abs() < 1e-12 * ledger.turnover, "{residual} of {}", ledger.turnover);
        let momentum = momentum(&simulation);
        assert!(momentum.iter().all(|part| part.abs() < 1e-12), "{momentum:?}");
    }
}

/// Mean Cauchy stress and conjugate stress over 70 time steps of a shear from 0.4 to 0.41, and the mean of what the stress is at their ends.
fn means_of_a_shear(law: [&str; 2]) -> [[f64; 6]; 3] {
    const STEPS: u32 = 70;
    let mut simulation = start(&dense(law, DRIVEN));
    simulation.set_strain(2, -0.02);
    simulation.set_strain(4, 0.4);
    simulation.advance(0.02).unwrap();
    let begun = simulation.state().clone();
    simulation.set_strain(4, 0.41);
    simulation.advance(7e-4).unwrap();
    let cell = simulation.state().cell.as_ref().unwrap();
    let (whole, conjugate) = (cell.mean_stress, cell.conjugate_stress);
    simulation.restore(&begun).unwrap();
    let (mut mean, mut before) = ([0.0; 6], simulation.cell_stress());
    for step in 1..=STEPS {
        simulation.set_strain(4, 0.4 + 0.01 * f64::from(step) / f64::from(STEPS));
        simulation.advance(1e-5).unwrap();
        let after = simulation.cell_stress();
        (0..6).for_each(|k| mean[k] += 0.5 * (before[k] + after[k]) / f64::from(STEPS));
        before = after;
    }
    [whole, conjugate, mean]
}

#[test]
fn mean_stress_is_the_mean_of_the_cauchy_stress() {
    for law in [SMOOTH, ROUGH] {
        let [whole, conjugate, mean] = means_of_a_shear(law);
        let largest = mean.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        for (whole, mean) in whole.into_iter().zip(mean) {
            // Velocities at the ends of time steps stand for those at their middle.
            assert!((whole - mean).abs() < 1e-3 * largest, "{whole} {mean}");
        }
        assert!((whole[2] - conjugate[2]).abs() > 0.05 * largest, "{} {}", whole[2], conjugate[2]);
    }
}

#[test]
fn stress_is_conjugate_to_the_strains_of_sheared_edges_by_their_shear() {
    // Without friction the stress is symmetric at each moment; in a shear the volume stays.
    let [whole, conjugate, _] = means_of_a_shear(SMOOTH);
    let gamma = 0.405;
    let expected = [whole[0] - gamma * whole[4], whole[2] + gamma * whole[4], whole[4]];
    let largest = whole.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    for (found, expected) in [conjugate[0], conjugate[2], conjugate[4]].into_iter().zip(expected) {
        assert!((found - expected).abs() < 2e-3 * largest, "{found} {expected}");
    }
}

/// Momentum of the particles.
fn momentum(simulation: &Simulation) -> [f64; 3] {
    let particles = &simulation.state().particles;
    let rows = particles.slots().map(|slot| particles.velocity[slot]);
    rows.fold([0.0; 3], |sum, row| [0, 1, 2].map(|axis| sum[axis] + row[3] * row[axis]))
}

#[test]
fn the_physical_residual_is_of_second_order() {
    let residual = |step: &str| {
        let mut simulation = start(&dense(SMOOTH, DRIVEN).replace("step = 1e-5", &format!("step = {step}")));
        (0..6).for_each(|k| simulation.set_strain(k, [-0.1, 0.02, -0.05, 0.1, -0.05, 0.02][k]));
        simulation.advance(4e-3).unwrap();
        let work = simulation.state().cell.as_ref().unwrap().work;
        (simulation.physical_residual().unwrap(), work)
    };
    let ((coarse, work), (fine, _)) = (residual("2e-5"), residual("5e-6"));
    assert!(coarse.abs() < 1e-3 * work.abs(), "{coarse} of {work}");
    assert!(fine.abs() < 0.15 * coarse.abs(), "{coarse} {fine}");
}

/// Edges of which the first is to be along x and the second in the plane of x and y, as lower triangular ones, and the axes in which
/// they are that (Gram and Schmidt).
fn upright(edges: [[f64; 3]; 3]) -> ([[f64; 3]; 3], [[f64; 3]; 3]) {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (mut axes, mut lower) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
    for (row, edge) in edges.into_iter().enumerate() {
        let mut rest = edge;
        for other in 0..row {
            lower[row][other] = dot(edge, axes[other]);
            (0..3).for_each(|axis| rest[axis] -= lower[row][other] * axes[other][axis]);
        }
        lower[row][row] = dot(rest, rest).sqrt();
        axes[row] = rest.map(|part| part / lower[row][row]);
    }
    (lower, axes)
}

#[test]
fn stress_turns_with_the_axes() {
    let list = gas(60, 0.1, 2.0);
    let [law, pair] = ROUGH;
    let leaning = [[0.1, 0.0, 0.0], [0.03, 0.08, 0.0], [-0.02, 0.025, 0.12]];
    let upright_box = [[0.1, 0.0, 0.0], [0.0, 0.08, 0.0], [0.0, 0.0, 0.12]];
    // Stress in the axes of the first cell, of the same lattice spanned by sums of its edges: in another order they permute the
    // axes where the cell is upright, and else turn them about no axis in particular.
    let run = |edges: [[f64; 3]; 3], sums: [[i32; 3]; 3]| {
        let sum = |counts: [i32; 3]| {
            [0, 1, 2].map(|axis: usize| (0..3).map(|edge| f64::from(counts[edge]) * edges[edge][axis]).sum::<f64>())
        };
        let (lower, axes) = upright(sums.map(sum));
        let turned = |vector: [f64; 3]| axes.map(|axis| (0..3).map(|part| axis[part] * vector[part]).sum::<f64>());
        let list: Vec<_> = list
            .iter()
            .map(|(part, radius, velocity)| {
                let place = [0, 1, 2].map(|axis| (0..3).map(|edge| part[edge] / 0.1 * edges[edge][axis]).sum::<f64>());
                (turned(place), 2.0 * radius, turned(*velocity))
            })
            .collect();
        let lower = [[lower[0][0], 0.0, 0.0], [lower[1][0], lower[1][1], 0.0], lower[2]];
        let text = scene(law, pair, &(spheres(&list) + &cell(lower, DRIVEN)));
        let mut simulation = start(&text.replace("[run]", "[run]\nmax_overlap = 0.5"));
        (0..3).for_each(|axis| simulation.set_strain(axis, -0.05));
        simulation.advance(1e-3).unwrap();
        let mut own = [[0.0; 3]; 3];
        for (part, [row, column]) in simulation.cell_stress().into_iter().zip(STRAINS) {
            (own[row][column], own[column][row]) = (part, part);
        }
        let mut back = [[0.0; 3]; 3];
        for (row, column) in (0..9).map(|place| (place / 3, place % 3)) {
            for (i, j) in (0..9).map(|place| (place / 3, place % 3)) {
                back[row][column] += axes[i][row] * own[i][j] * axes[j][column];
            }
        }
        back
    };
    let (a, b, c) = ([1, 0, 0], [0, 1, 0], [0, 0, 1]);
    for edges in [upright_box, leaning] {
        let straight = run(edges, [a, b, c]);
        assert!(straight[0][1].abs() > 1e-3 * straight[0][0].abs(), "{straight:?}");
        for sums in [[b, c, a], [c, a, b], [[0, 1, 1], c, a], [[1, 1, 0], [0, 1, 1], [1, 1, 1]]] {
            assert_near(run(edges, sums).as_flattened(), straight.as_flattened(), 1e-9, &format!("{sums:?}"));
        }
    }
}

#[test]
fn one_particle_flies_around_a_million_steps_without_drift() {
    let velocity = [7.3, -3.1, 5.7];
    let edges = [[0.1, 0.0, 0.0], [0.03, 0.08, 0.0], [-0.02, 0.025, 0.12]];
    let began = [0.01, 0.02, 0.03];
    // Its lists, and with them its place, are made anew as if it could touch something.
    let [law, pair] = SMOOTH;
    let mut simulation = start(&scene(law, pair, &(spheres(&[(began, 0.01, velocity)]) + &cell(edges, ""))));
    for _ in 0..10 {
        simulation.advance(1.0).unwrap();
    }
    let (state, time) = (simulation.state(), 10.0);
    assert_eq!(state.clock.steps, 1_000_000);
    let slot = state.particles.slot[0] as usize;
    assert_eq!(state.particles.velocity[slot][..3], velocity);
    let away = state.cell.as_ref().unwrap().edges_away[0];
    assert!(away.iter().all(|count| count.abs() > 100), "{away:?}");
    let place = [0, 1, 2].map(|axis: usize| {
        state.particles.position[slot][axis] + (0..3).map(|edge| away[edge] as f64 * edges[edge][axis]).sum::<f64>()
    });
    for axis in 0..3 {
        // Each step rounds a place in the cell by at most half a digit of its largest number, and the way is that of 10 s.
        let rounding = 1e6 * 0.5 * f64::EPSILON * 0.125 + 1e-13;
        let expected = began[axis] + velocity[axis] * time;
        assert!((place[axis] - expected).abs() < rounding, "{} {expected}", place[axis]);
    }
}

#[test]
fn a_pulse_goes_through_the_faces_at_the_speed_of_waves_in_a_chain() {
    // Mass points a apart joined by springs: each wave of wave number k turns by 2 √(s/m) sin(k a/2), long ones go at a √(s/m).
    let (count, radius) = (128, 1e-3);
    let (spacing, stiffness) = (2.0 * radius, 1e12 * std::f64::consts::PI * radius * radius);
    let mass = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let pulse = |site: i32| {
        let apart = f64::from((site - 20 + 64).rem_euclid(count) - 64);
        1e-4 * (-apart * apart / 72.0).exp()
    };
    let sites = (0..count).map(|site| ([spacing * f64::from(site), 0.0, 0.0], radius, [pulse(site), 0.0, 0.0]));
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
    let edges = [[spacing * f64::from(count), 0.0, 0.0], [0.0, 0.01, 0.0], [0.0, 0.0, 0.01]];
    let rest = spheres(&sites.collect::<Vec<_>>()) + bond + &cell(edges, "periodic = [\"x\"]");
    let text = scene("", "", &rest).replace("[pair.glass.glass]\n\n", "");
    let speed = spacing * (stiffness / mass).sqrt();
    // Both halves of the pulse go half way round and meet there.
    let time = 0.5 * f64::from(count) * spacing / speed;
    let mut simulation = start(&text.replace("step = 1e-5", &format!("step = {:?}", time / 4000.0)));
    simulation.advance(time).unwrap();
    let particles = &simulation.state().particles;
    let found: Vec<f64> = particles.slot.iter().map(|&slot| particles.velocity[slot as usize][0]).collect();
    let turn = 2.0 * std::f64::consts::PI / f64::from(count);
    for site in 0..count {
        let mut expected = 0.0;
        for wave in 0..count {
            let rate = 2.0 * (stiffness / mass).sqrt() * (0.5 * turn * f64::from(wave)).sin().abs();
            let sum: f64 =
                (0..count).map(|other| pulse(other) * (turn * f64::from(wave * (site - other) % count)).cos()).sum();
            expected += sum / f64::from(count) * (rate * time).cos();
        }
        let found = found[site as usize];
        // The steps of velocity Verlet turn the shortest waves too fast by (rate · step)²/24: 2e-5 of a way of 64 sites.
        assert!((found - expected).abs() < 1e-3 * 1e-4, "{site}: {found} {expected}");
    }
    let top = (0..count).max_by(|a, b| found[*a as usize].total_cmp(&found[*b as usize])).unwrap();
    assert_eq!(top, 20 + 64);
    assert!(found[84] > 0.97e-4, "{}", found[84]);
}

#[test]
fn a_pair_that_drifts_through_the_faces_does_what_it_does_in_the_open() {
    let [law, pair] = ROUGH;
    let drift = [31.0, -17.0, 23.0];
    let list = [
        ([0.05, 0.02, 0.03], 0.01, drift),
        ([0.0695, 0.023, 0.031], 0.008, [0, 1, 2].map(|axis| drift[axis] + [-1.0, 0.4, -0.3][axis])),
    ];
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 0.03\nnormal_stiffness = 1e9\ntangential_stiffness = 5e8\n";
    let run = |periodic: bool, bond: &str| {
        let edges = [[0.09, 0.0, 0.0], [0.03, 0.08, 0.0], [-0.02, 0.03, 0.085]];
        let cell = if periodic { cell(edges, "") } else { String::new() };
        let text = scene(law, pair, &(spheres(&list) + bond + &cell)).replace("[run]", "[run]\nmax_overlap = 0.1");
        let mut simulation = start(&text);
        for _ in 0..40 {
            simulation.advance(1e-3).unwrap();
        }
        let particles = &simulation.state().particles;
        let slots: Vec<usize> = particles.slots().collect();
        let spins: Vec<f64> = slots.iter().flat_map(|&slot| particles.angular_velocity[slot][..3].to_vec()).collect();
        let velocities: Vec<f64> = slots.iter().flat_map(|&slot| particles.velocity[slot][..3].to_vec()).collect();
        let away = simulation
            .state()
            .cell
            .as_ref()
            .map_or(0, |cell| cell.edges_away.iter().flatten().map(|it| it.abs()).sum());
        (spins, velocities, away, simulation.elastic_energy())
    };
    for bond in ["", bond] {
        let (open, closed) = (run(false, bond), run(true, bond));
        assert!(closed.2 > 30, "only {} faces crossed", closed.2);
        assert_near(&closed.0, &open.0, 1e-7, "spins");
        assert_near(&closed.1, &open.1, 1e-9, "velocities");
        assert!((closed.3 - open.3).abs() <= 1e-6 * open.3.max(1e-12), "{} {}", closed.3, open.3);
    }
}

#[test]
fn gravity_along_an_edge_that_repeats_is_booked_and_a_probe_follows_the_fall() {
    let [law, pair] = SMOOTH;
    let probe = "[probe.grain]\nparticle = 1\n";
    let text = scene(law, pair, &(spheres(&[([0.5, 0.5, 0.5], 0.01, [0.0; 3])]) + probe + &cell(cube(0.6), "")));
    let mut simulation = start(&format!("gravity = [0.0, 0.0, -10.0]\n{text}"));
    simulation.advance(1.0).unwrap();
    assert!(simulation.state().cell.as_ref().unwrap().edges_away[0][2] < -5);
    let place = cograin::averages::sights(&simulation)[0].position[2];
    assert!((place - 0.5 + 5.0).abs() < 1e-9, "{place}");
    let kinetic = simulation.kinetic_energy();
    assert!(simulation.physical_residual().unwrap().abs() < 1e-9 * kinetic);
}

#[test]
fn one_particle_flies_on_for_many_periods() {
    let [law, pair] = SMOOTH;
    let velocity = [120.0, -75.0, 33.0];
    let text = scene(law, pair, &(spheres(&[([0.5, 0.5, 0.5], 0.01, velocity)]) + &cell(cube(1.0), "")));
    let mut simulation = start(&text);
    simulation.advance(1.0).unwrap();
    let state = simulation.state();
    let (slot, cell) = (state.particles.slot[0] as usize, state.cell.as_ref().unwrap());
    for axis in 0..3 {
        let place = state.particles.position[slot][axis] + cell.edges_away[0][axis] as f64;
        assert!((place - 0.5 - velocity[axis]).abs() < 1e-9, "{place}");
        assert!((-0.1..1.1).contains(&state.particles.position[slot][axis]));
    }
    assert_eq!(state.particles.velocity[slot][..3], velocity);
}

#[test]
fn bits_are_the_same_for_threads_lanes_and_after_save_and_restore() {
    let text = |threads: usize| dense(ROUGH, DRIVEN).replace("[run]", &format!("[run]\nthreads = {threads}"));
    let drive = |simulation: &mut Simulation, step: u32| {
        (0..6).for_each(|k| simulation.set_strain(k, f64::from(step) * [-0.01, 0.0, -0.02, 0.6, 0.01, -0.3][k]));
        simulation.advance(5e-4).unwrap();
    };
    let run = |threads: usize, width: Width, kept: bool| {
        let mut simulation = start(&text(threads));
        simulation.set_width(width);
        for step in 1..=6 {
            drive(&mut simulation, step);
            if kept && step == 3 {
                let state = simulation.state().clone();
                simulation = start(&text(threads));
                simulation.set_width(width);
                simulation.restore(&state).unwrap();
            }
        }
        let cell = simulation.state().cell.as_ref().unwrap();
        assert!(simulation.state().clock.rebuilds > 4 && cell.images.len() > 50);
        simulation.state().clone()
    };
    let first = run(1, Width::widest(), false);
    for (threads, width, kept) in [(3, Width::widest(), false), (1, Width::Least, false), (2, Width::widest(), true)] {
        assert!(run(threads, width, kept) == first, "{threads} threads, {width:?}, restored {kept}");
    }
}

#[test]
fn the_automatic_step_knows_images() {
    let automatic = |text: String| text.replace("step = 1e-5", "step = \"auto\"");
    for law in [SMOOTH, ROUGH] {
        let mut simulation = start(&automatic(dense(law, "motion = { shear = \"xz\" }")));
        simulation.set_strain(4, 0.3);
        simulation.advance(5e-3).unwrap();
        let clock = &simulation.state().clock;
        assert!(
            clock.step > 0.0 && clock.step < clock.stable && clock.stable < 1e-3,
            "{} {}",
            clock.step,
            clock.stable
        );
    }
    // One particle between its own images is as stiff as the same lattice of many.
    let stable = |counts| {
        let simulation = start(&automatic(lattice("sc", counts, 1.96e-3, 1e-3, "")));
        simulation.state().clock.stable
    };
    let (one, many) = (stable([1, 1, 1]), stable([4, 4, 4]));
    assert!(one <= many * (1.0 + 1e-9) && one > 0.4 * many, "{one} {many}");
}

#[test]
fn the_automatic_step_follows_a_strain_that_closes_all_contacts() {
    // At the start spheres hardly touch, and nothing is stiff.
    let more = "motion = { driven = [\"xx\", \"yy\", \"zz\"] }";
    for law in [SMOOTH, ROUGH] {
        let text = lattice("fcc", [3, 3, 3], 2.828_427e-3, 1e-3, more).replace("step = 1e-5", "step = \"auto\"");
        let mut simulation = start(&text.replace(SMOOTH[0], law[0]).replace(SMOOTH[1], law[1]));
        for step in 1..=10 {
            (0..3).for_each(|component| simulation.set_strain(component, -2e-3 * f64::from(step)));
            simulation.advance(1e-3).unwrap();
        }
        let energy = simulation.state().cell.as_ref().unwrap().work;
        let residual = simulation.physical_residual().unwrap();
        assert!(residual.abs() < 0.02 * energy, "{residual} of {energy}");
    }
}

#[test]
fn the_automatic_step_follows_the_largest_rates_of_servos() {
    // In a step in which nothing goes farther than a tenth of a radius strains would change by 0.08.
    let each = ["xx", "yy", "zz"].map(|axis| format!("{axis} = {{ stress = -1e4, max_rate = 500.0 }}")).join(", ");
    let text = lattice("sc", [3, 3, 3], 2.1e-3, 1e-3, &format!("motion = {{ servo = {{ {each} }} }}"));
    let mut simulation = start(&text.replace("step = 1e-5", "step = \"auto\""));
    simulation.advance(2e-4).unwrap();
    assert!(simulation.state().clock.last_step <= 0.05 / 1500.0, "{}", simulation.state().clock.last_step);
}

#[test]
fn a_servo_reaches_its_stress() {
    let more = "motion = { servo = { xx = { stress = -2e4, max_rate = 5.0 }, yy = { stress = -2e4, max_rate = 5.0 }, \
                zz = { stress = -4e4, max_rate = 5.0 } } }";
    let mut simulation = start(&damped(&dense(ROUGH, more)));
    simulation.advance(0.15).unwrap();
    let stress = simulation.cell_stress();
    assert_near(&stress[..3], &[-2e4, -2e4, -4e4], 0.02, "stress");
}

fn damped(text: &str) -> String {
    let damping =
        "[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = false\napplied_forces_damped = false\n[run]";
    text.replace("[run]", damping)
}

#[test]
fn a_stress_of_zero_is_reached_where_it_is_small_beside_the_others() {
    let each = ["xx", "yy", "zz"].map(|axis| format!("{axis} = {{ stress = -2e4, max_rate = 5.0 }}")).join(", ");
    let more = format!("motion = {{ servo = {{ {each}, xz = {{ stress = 0.0, max_rate = 5.0 }} }} }}");
    let mut simulation = start(&damped(&dense(ROUGH, &more)));
    simulation.advance(0.3).unwrap();
    simulation.advance(1e-2).unwrap();
    assert!(simulation.state().cell.as_ref().unwrap().mean_stress[4] != 0.0, "rounding is left");
    let told = cograin::run::remarks(simulation.scene(), &simulation);
    assert!(!told.iter().any(|remark| remark.starts_with("[cell] servo: ")), "{told:?}");
}

/// Grains in a cell that moves so.
fn sand(more: &str, motion: &str) -> String {
    let text = scene(ROUGH[0], "restitution = 0.5\nfriction = 0.5", &cell(cube(0.0116), ""));
    let text = text.replace("step = 1e-5\n", more).replace("youngs_modulus = 1e7", "youngs_modulus = 3e8");
    let sand =
        "[particles.sand]\nmaterial = \"glass\"\npacking = { solid_fraction = 0.58, radius = [0.8e-3, 1.2e-3] }\n";
    format!("{text}{motion}\n{sand}")
}

/// Grains between sides that are held at 100 kPa, in a cell that is driven along z.
fn triaxial(more: &str) -> Simulation {
    let side = "{ stress = -1e5, max_rate = 20.0 }";
    start(&sand(more, &format!("motion = {{ driven = [\"zz\"], servo = {{ xx = {side}, yy = {side} }} }}")))
}

#[test]
fn a_servo_holds_its_stress_while_the_cell_is_driven() {
    // An inertial number γ̇ d √(ρ/p) of 1e-3.
    let rate = 1e-3 / 2e-3 * (1e5_f64 / 2500.0).sqrt();
    let (mut simulation, interval) = (triaxial(""), 0.002 / rate);
    let mut sum = [0.0; 2];
    for step in 1..=40 {
        simulation.set_strain(2, -0.002 * f64::from(step));
        simulation.advance(interval).unwrap();
        let cell = simulation.state().cell.as_ref().unwrap();
        if step > 20 {
            (0..2).for_each(|k| sum[k] += cell.mean_stress[k] / 20.0);
        }
    }
    assert_near(&sum, &[-1e5; 2], 2e-3, "stress");
    let interface = cograin::interface::Interface::of(simulation.scene());
    let found = interface.value(&simulation, interface.find("cell.servo_error.yy").unwrap());
    let expected = -1e5 - simulation.cell_stress()[1];
    assert_eq!(found, cograin::interface::Value::Real(expected));
}

#[test]
fn servos_hold_the_mean_stress_while_the_cell_is_pressed_at_a_constant_rate() {
    let rate = 1e-3 / 2e-3 * (1e5_f64 / 2500.0).sqrt();
    let side = "{ mean_stress = -1e5, max_rate = 20.0 }";
    let motion = format!("motion = {{ prescribed = {{ zz = {:?} }}, servo = {{ xx = {side}, yy = {side} }} }}", -rate);
    let mut simulation = start(&sand("", &motion));
    let (interval, mut sum) = (0.002 / rate, [0.0; 3]);
    for step in 1..=40 {
        simulation.advance(interval).unwrap();
        let cell = simulation.state().cell.as_ref().unwrap();
        assert_near(&[cell.strain[2]], &[-0.002 * f64::from(step)], 1e-12, "strain");
        if step > 20 {
            (0..3).for_each(|k| sum[k] += cell.mean_stress[k] / 20.0);
        }
    }
    let [x, y, z] = sum;
    assert!(((x + y + z) / 3.0 + 1e5).abs() < 2e-3 * 1e5, "{sum:?}");
    // Both sides have the same, and the axis bears more.
    assert!((x - y).abs() < 4e-3 * 1e5 && z < 1.2 * x, "{sum:?}");
    let interface = cograin::interface::Interface::of(simulation.scene());
    let found = interface.value(&simulation, interface.find("cell.servo_error.yy").unwrap());
    let expected = -1e5 - simulation.cell_stress()[..3].iter().sum::<f64>() / 3.0;
    assert_eq!(found, cograin::interface::Value::Real(expected));
    assert!(
        interface.find("cell.strain.zz").is_some() && interface.inputs().count() == 2,
        "a prescribed strain is an output"
    );
}

#[test]
fn a_servo_goes_on_with_the_same_bits_from_a_saved_state_and_for_any_threads() {
    let run = |threads: usize, kept: bool| {
        let more = format!("threads = {threads}\n");
        let mut simulation = triaxial(&more);
        for step in 1..=6 {
            simulation.set_strain(2, -0.002 * f64::from(step));
            simulation.advance(4e-4).unwrap();
            if kept && step == 3 {
                let state = simulation.state().clone();
                simulation = triaxial(&more);
                simulation.restore(&state).unwrap();
            }
        }
        assert!(simulation.state().cell.as_ref().unwrap().held_rate[0] != 0.0);
        simulation.state().clone()
    };
    let first = run(1, false);
    assert!(run(2, false) == first && run(1, true) == first);
}

#[test]
fn servos_hold_the_pressure_of_a_gas() {
    let each = ["xx", "yy", "zz"].map(|axis| format!("{axis} = {{ stress = -200.0, max_rate = 5.0 }}")).join(", ");
    let [law, pair] = SMOOTH;
    let text = scene(
        law,
        pair,
        &(spheres(&gas(125, 0.1, 2.0)) + &cell(cube(0.1), &format!("motion = {{ servo = {{ {each} }} }}"))),
    );
    let mut simulation = start(&text.replace("step = 1e-5\n", ""));
    simulation.advance(0.5).unwrap();
    simulation.advance(1.0).unwrap();
    let cell = simulation.state().cell.as_ref().unwrap();
    // It fluctuates with the few collisions.
    assert_near(&cell.mean_stress[..3], &[-200.0; 3], 0.03, "pressure");
}

#[test]
fn a_stress_that_a_servo_does_not_reach_is_remarked() {
    let remarked = |stress: &str| {
        let more = format!("motion = {{ servo = {{ yy = {{ stress = {stress}, max_rate = 5.0 }} }} }}");
        let mut simulation = start(&dense(ROUGH, &more));
        simulation.advance(1e-3).unwrap();
        simulation.advance(1e-3).unwrap();
        let told = cograin::run::remarks(simulation.scene(), &simulation);
        told.into_iter().find(|remark| remark.starts_with("[cell] servo: "))
    };
    // Grains that do not stick bear no tension.
    let told = remarked("1e4").unwrap();
    assert!(told.starts_with("[cell] servo: yy has ") && told.ends_with(", to be 1.0000e4 Pa"), "{told}");
    assert!(told.contains(" Pa in the last interval"), "{told}");
}

#[test]
fn a_bonded_pair_that_is_sheared_is_not_said_to_gain_energy() {
    // The streaming motion is in no book: its energy made the error of a few steps look like a gain.
    let pair = spheres(&[([0.05, 0.05, 0.04], 0.004, [0.0; 3]), ([0.05, 0.05, 0.06], 0.004, [0.0; 3])]);
    let glue = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 0.03\nnormal_stiffness = 1e7\ntangential_stiffness = 4e6\n";
    let edges = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
    let text = scene(SMOOTH[0], SMOOTH[1], &format!("{pair}{glue}{}", cell(edges, "motion = { driven = [\"xz\"] }")));
    let mut simulation = start(&text.replace("step = 1e-5\n", ""));
    for share in 1..=50 {
        simulation.set_strain(4, 0.01 * f64::from(share) / 50.0);
        simulation.advance(0.002).unwrap();
    }
}

#[test]
fn a_plane_along_the_edges_that_repeat_carries_the_weight() {
    let [law, pair] = ROUGH;
    let mut list = Vec::new();
    for place in 0..27 {
        let at = [place % 3, place / 3 % 3, place / 9].map(f64::from);
        list.push(([0.01 * at[0] + 0.0005 * at[2], 0.01 * at[1], 0.005 + 0.0101 * at[2]], 0.005, [0.0; 3]));
    }
    let floor =
        "[boundary.floor]\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"\n";
    let cell = cell(cube(0.03), "periodic = [\"x\", \"y\"]");
    let text = scene(law, pair, &(spheres(&list) + floor + &cell));
    let damping = "gravity = [0.0, 0.0, -9.81]\n[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = false\napplied_forces_damped = false\n[run]";
    let mut simulation = start(&text.replace("[run]", damping));
    simulation.advance(0.5).unwrap();
    simulation.advance(0.2).unwrap();
    let weight = 27.0 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.005_f64.powi(3) * 9.81;
    assert_near(&[simulation.state().boundaries[0].mean_force[2]], &[-weight], 1e-3, "weight");
}

#[test]
fn what_a_cell_does_not_go_with_is_refused() {
    let [law, pair] = SMOOTH;
    let with = |more: &str, rest: &str| {
        let list = spheres(&[([0.5, 0.5, 0.5], 0.1, [0.0; 3])]);
        read(&scene(law, pair, &(list + rest + &cell(cube(1.0), more)))).err().unwrap_or_default()
    };
    let floor =
        "[boundary.floor]\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nmaterial = \"glass\"\n";
    for (more, rest, words) in [
        ("", floor, "one that crosses them"),
        (
            "periodic = [\"x\", \"y\"]\nmotion = { driven = [\"xx\"] }",
            floor,
            "no boundary beside a [cell] that is deformed",
        ),
        ("periodic = [\"x\"]\nmotion = { driven = [\"xy\"] }", "", "xy, where the cell does not repeat"),
        ("motion = { driven = [\"xx\"], fixed = [\"xx\"] }", "", "xx twice"),
        ("motion = { shear = \"zx\" }", "", "expected \"xy\", \"xz\" or \"yz\", found \"zx\""),
        ("periodic = []", "", "at least one edge"),
        (
            "motion = { driven = [\"xx\"] }",
            "[force.push]\nparticles = { set = \"all\" }\nforce = [1.0, 0.0, 0.0]\n",
            "neither gravity nor [force]",
        ),
        ("", "[region.r]\nbox = [[-1e9, 0.0, 0.0], [1e9, 1.0, 1.0]]\n", "found one over 2000000000.0 edges along x"),
        (
            "",
            "[flow_meter.m]\npolygon = [[0.0, 0.0, 0.5], [11.0, 0.0, 0.5], [11.0, 1.0, 0.5]]\n",
            "found one over 11.0 edges along x",
        ),
        ("", "[domain]\nbox = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]\n", "no [domain] beside [cell]"),
    ] {
        let found = with(more, rest);
        assert!(found.contains(words), "{found}");
    }
    let close = spheres(&[([0.05, 0.5, 0.5], 0.1, [0.0; 3]), ([0.95, 0.5, 0.5], 0.1, [0.0; 3])]);
    let through = read(&scene(law, pair, &(close + &cell(cube(1.0), "")))).unwrap_err();
    assert!(through.contains("between particles 1 and 2 through a face of the cell"), "{through}");
    let narrow = scene(law, pair, &(spheres(&[([0.0; 3], 0.1, [0.0; 3])]) + &cell(cube(0.05), "")));
    assert!(read(&narrow).unwrap_err().contains("at least the largest radius"));
}

#[test]
fn bonds_across_the_faces_carry_their_stiffness() {
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
    let (size, radius, strain) = (2e-3, 1e-3, 1e-4_f64);
    for count in [1, 3] {
        let sites = (0..count * count * count).map(|place| {
            let at = [place % count, place / count % count, place / count / count];
            (at.map(|at| size * f64::from(at)), radius, [0.0; 3])
        });
        let edges = cube(size * f64::from(count));
        let rest = spheres(&sites.collect::<Vec<_>>()) + bond + &cell(edges, "motion = { driven = [\"xx\", \"zz\"] }");
        let mut simulation = start(&scene("", "", &rest).replace("[pair.glass.glass]\n\n", "").replace("1e-5", "1e-7"));
        assert_eq!(simulation.bonds().len(), 3 * (count as usize).pow(3));
        simulation.set_strain(0, strain);
        simulation.advance(2e-6).unwrap();
        let force = 1e12 * std::f64::consts::PI * radius * radius * size * strain.exp_m1();
        let expected = [force / (size * size), 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_near(&simulation.cell_stress(), &expected, 1e-9, &format!("{count}"));
    }
}

#[test]
fn bonds_that_are_made_at_any_time_are_made_across_the_faces() {
    let [law, pair] = ROUGH;
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate = \"always\"\ncreate_distance = 0.0215\nnormal_stiffness = 1e9\ntangential_stiffness = 5e8\n";
    let list = [
        ([0.03, 0.02, 0.03], 0.01, [1.5, 0.3, 0.1]),
        ([0.07, 0.022, 0.031], 0.008, [-0.5, 0.2, 0.0]),
        ([0.052, 0.06, 0.03], 0.009, [0.3, -0.8, 0.0]),
    ];
    // With contacts, and without any.
    for laws in [[law, pair], ["", ""]] {
        let run = |shift: [f64; 3], cell: &str| {
            let list: Vec<_> = list
                .iter()
                .map(|(place, radius, velocity)| ([0, 1, 2].map(|axis| place[axis] + shift[axis]), *radius, *velocity))
                .collect();
            let text = scene(laws[0], laws[1], &(spheres(&list) + bond + cell));
            let text = if laws[0].is_empty() { text.replace("[pair.glass.glass]\n\n", "") } else { text };
            let mut simulation = start(&text.replace("[run]", "[run]\nmax_overlap = 0.1"));
            simulation.advance(0.03).unwrap();
            let particles = &simulation.state().particles;
            let rows: Vec<f64> = particles.slots().flat_map(|slot| particles.velocity[slot][..3].to_vec()).collect();
            (rows, simulation.bonds().len())
        };
        let edges = cell([[0.2, 0.0, 0.0], [0.03, 0.15, 0.0], [-0.02, 0.03, 0.15]], "");
        let open = run([0.0; 3], "");
        assert_eq!(open.1, 2);
        for shift in [[0.15, 0.0, 0.0], [0.0, 0.12, 0.0], [0.14, -0.04, -0.03]] {
            let closed = run(shift, &edges);
            assert_eq!(closed.1, open.1);
            assert_near(&closed.0, &open.0, 1e-8, &format!("{shift:?}"));
        }
    }
}

#[test]
fn a_bonded_lattice_has_the_moduli_of_its_bonds() {
    // Between nearest neighbours, which an even strain of a lattice with a centre of symmetry moves evenly.
    let (radius, [normal, tangential]) = (1e-3, [1e12, 4e11].map(|stiffness| stiffness * std::f64::consts::PI * 1e-6));
    for (kind, edge, around, moduli) in [
        ("sc", 2.0, 6, [normal, 0.0, 0.5 * tangential]),
        (
            "bcc",
            4.0 / 3.0_f64.sqrt(),
            8,
            [
                (2.0 * normal + 4.0 * tangential) / 3.0,
                2.0 * (normal - tangential) / 3.0,
                (2.0 * normal + tangential) / 3.0,
            ],
        ),
        ("fcc", 8.0_f64.sqrt(), 12, [2.0 * (normal + tangential), normal - tangential, normal + tangential]),
    ] {
        for counts in [[1, 1, 1], [2, 3, 2]] {
            let size = edge * radius;
            let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 2.1e-3\n\
                        normal_stiffness = 1e12\ntangential_stiffness = 4e11\n";
            let text = lattice(kind, counts, size, radius, &format!("{DRIVEN}\n{bond}"));
            let contacts = format!("[pair.glass.glass]\n{}\n{}\n", SMOOTH[1], SMOOTH[0]);
            let mut simulation = start(&text.replace(&contacts, "").replace("1e-5", "1e-7"));
            let particles = sites(kind).len() * counts.iter().product::<usize>();
            assert_eq!(simulation.bonds().len(), particles * around / 2);
            let strain = [1e-6, -4e-7, 7e-7, 9e-7, -1.1e-6, 5e-7];
            (0..6).for_each(|component| simulation.set_strain(component, strain[component]));
            simulation.advance(2e-6).unwrap();
            let [along, across, shear] = moduli.map(|modulus| modulus / size);
            let sum = strain[0] + strain[1] + strain[2];
            let expected = [0, 1, 2, 3, 4, 5].map(|component| match component {
                0..3 => across * sum + (along - across) * strain[component],
                _ => shear * strain[component],
            });
            assert_near(&simulation.cell_stress(), &expected, 1e-5, &format!("{kind} {counts:?}"));
        }
    }
}

#[test]
fn lengths_scaled_by_a_power_of_two_give_the_same_bits() {
    let run = |scale: f64| {
        let mut list = gas(40, 0.1, 1.0);
        for (place, radius, velocity) in &mut list {
            (*place, *radius) = (place.map(|part| scale * part), 2.2 * *radius * scale);
            *velocity = velocity.map(|part| scale * part);
        }
        // Pressures scale by the square of lengths, where densities and times stay.
        let rest = spheres(&list) + &cell(cube(0.1 * scale), DRIVEN);
        let text = scene(ROUGH[0], ROUGH[1], &rest).replace("1e7", &format!("{:?}", 1e7 * scale * scale));
        let mut simulation = start(&text.replace("[run]", "[run]\nmax_overlap = 0.3"));
        (0..6).for_each(|k| simulation.set_strain(k, [-0.05, 0.02, -0.05, 0.4, -0.05, 0.02][k]));
        simulation.advance(2e-3).unwrap();
        let cell = simulation.state().cell.as_ref().unwrap();
        (simulation.cell_stress().map(|part| part / (scale * scale)), cell.work / scale.powi(5), cell.images.len())
    };
    let unit = run(1.0);
    assert!(unit.2 > 10 && unit.0[0] < 0.0);
    assert_eq!(run(0.125), unit);
    assert_eq!(run(1024.0), unit);
}

#[test]
fn variables_of_a_cell_are_its_inputs_and_what_it_answers() {
    let [law, pair] = SMOOTH;
    let more = "motion = { driven = [\"xx\"], servo = { yy = { stress = -1e3, max_rate = 1.0 } }, shear = \"xz\" }";
    let text = scene(law, pair, &(spheres(&[([0.5; 3], 0.1, [0.0; 3])]) + &cell(cube(1.0), more)));
    let interface = cograin::interface::Interface::of(&text.parse().unwrap());
    let names = |outputs: bool| -> Vec<String> {
        let (ins, outs) = (interface.inputs(), interface.outputs());
        let all: Vec<_> = if outputs { outs.collect() } else { ins.collect() };
        all.into_iter().map(|(_, it)| it.name.clone()).filter(|name| name.starts_with("cell.")).collect()
    };
    assert_eq!(names(false), ["cell.strain.xx", "cell.shear", "cell.target_stress.yy"]);
    let outputs = names(true);
    for name in [
        "cell.strain.yy",
        "cell.strain.zz",
        "cell.stress.xz",
        "cell.mean_stress.yz",
        "cell.conjugate_stress.xy",
        "cell.servo_error.yy",
        "cell.work",
        "cell.volume",
    ] {
        assert!(outputs.iter().any(|output| output == name), "{name} is missing in {outputs:?}");
    }
    assert_eq!(outputs.len(), 4 + 6 + 1 + 6 + 6 + 6 + 5);
}

#[test]
fn another_scene_takes_over_what_a_cell_has_come_to() {
    use cograin::simulation::Description;
    use std::sync::Arc;
    let bond = "[bond.glue]\nbetween = [\"all\", \"all\"]\ncreate_distance = 0.02\nnormal_stiffness = 1e9\n\
                tangential_stiffness = 5e8\n";
    // At its start the second scene cuts springs of contacts that slide with the velocities of the end of a step.
    for (law, bond, tolerance) in [(SMOOTH, "", 1e-12), (ROUGH, "", 1e-3), (ROUGH, bond, 1e-3)] {
        let text = |motion: &str, end: &str| dense(law, &format!("{motion}\n{bond}")).replace("end = 1.0", end);
        let mut first = start(&text("motion = { shear = \"xz\" }", "end = 1.0"));
        for step in 1..=4 {
            first.set_strain(4, 0.3 * f64::from(step));
            first.advance(2e-3).unwrap();
        }
        first.advance(1e-5).unwrap();
        let from = Description::of(first.scene(), "first.toml", first.time());
        let second: Arc<cograin::scene::Scene> = Arc::new(text(DRIVEN, "end = 2.0").parse().unwrap());
        let (second, left) = Simulation::taken_over(second, first.state(), &from).unwrap();
        assert!(left.is_empty(), "{left:?}");
        let (before, after) = (first.state().cell.as_ref().unwrap(), second.state().cell.as_ref().unwrap());
        assert_eq!(after.strain, before.strain);
        assert_eq!(after.target, before.strain);
        assert_eq!(second.bonds().len(), first.bonds().len());
        assert_eq!(second.contact_count(), first.contact_count());
        let energies = [first.elastic_energy(), second.elastic_energy()];
        assert!((energies[1] - energies[0]).abs() < tolerance * energies[0], "{energies:?}");
    }
}
