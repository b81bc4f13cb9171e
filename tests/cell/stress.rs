//! Stress of gases in a cell: by their kinetic energy, conjugate to the strain, turned with the axes.

use super::scenes::{ROUGH, SMOOTH, STRAINS, cube, dense, gas, scene};
use crate::support::{DRIVEN, assert_all_near, cell, spheres, start};
use cograin::simulation::Simulation;

#[test]
fn an_ideal_gas_presses_by_its_kinetic_energy_and_heats_up_as_it_is_compressed() {
    let text = scene("", "", &(spheres(&gas(60, 1.0, 1.0)) + &cell(cube(1.0), DRIVEN)));
    let text = text.replace("[pair.glass.glass]\n\n", "");
    let mut simulation = start(&text);
    let energy = simulation.kinetic_energy();
    let pressure = |simulation: &Simulation| simulation.cell_stress()[..3].iter().sum::<f64>() / -3.0;
    assert_all_near(&[pressure(&simulation)], &[2.0 / 3.0 * energy], 1e-14, "pressure");
    for component in 0..3 {
        simulation.set_strain(component, -0.2);
    }
    simulation.advance(0.05).unwrap();
    let (warm, volume) = (simulation.kinetic_energy(), (-0.6_f64).exp());
    assert_all_near(&[simulation.cell_volume()], &[volume], 1e-14, "volume");
    // 5000 time steps multiply each velocity by the same rounded factor.
    let rounding = 5000.0 * 4.0 * f64::EPSILON;
    assert_all_near(&[warm], &[energy * volume.powf(-2.0 / 3.0)], rounding, "energy");
    assert_all_near(&[pressure(&simulation)], &[2.0 / 3.0 * warm / volume], 1e-12, "pressure");
    let work = simulation.state().cell.as_ref().unwrap().work;
    assert_all_near(&[energy + work], &[warm], rounding, "work");
    assert!(simulation.energy_residual().unwrap().abs() < 1e-12 * warm);
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
            assert_all_near(run(edges, sums).as_flattened(), straight.as_flattened(), 1e-9, &format!("{sums:?}"));
        }
    }
}
