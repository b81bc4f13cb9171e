//! Parts of spheres and lines in the cells of a grid, and weights between their centres.

use super::sphere::UNIT;
use super::{Cuboid, Grid, Region};
use crate::base::number::Vector;
use std::f64::consts::PI;

/// A grid whose planes are no round numbers.
fn uneven() -> Grid {
    Grid { corners: [[-1.1, 0.3, 2.0], [1.7, 1.9, 5.3]], counts: [7, 3, 11], repeats: [false; 3] }
}

/// Numbers from 0 to below 1, the same each time.
fn numbers() -> impl FnMut() -> f64 {
    let mut seed = 1_u64;
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Places about a grid, up to this far outside \[m\].
fn places(grid: &Grid, outside: f64, count: usize) -> Vec<Vector> {
    let mut number = numbers();
    let [lower, upper] = grid.corners;
    let mut along = |axis: usize| lower[axis] - outside + (upper[axis] - lower[axis] + 2.0 * outside) * number();
    (0..count).map(|_| Vector::new(along(0), along(1), along(2))).collect()
}

/// The parts of a sphere.
fn parts(grid: &Grid, centre: Vector, radius: f64) -> Vec<(usize, f64)> {
    let mut parts = Vec::new();
    grid.parts_of_sphere(centre, radius, |cell, part| parts.push((cell, part)));
    parts
}

#[test]
fn a_sphere_on_a_face_an_edge_and_a_corner_is_halved_quartered_and_cut_in_eight() {
    let grid = Grid { corners: [[0.0; 3], [4.0; 3]], counts: [4; 3], repeats: [false; 3] };
    for (centre, count) in [([1.5, 2.0, 1.5], 2), ([1.5, 2.0, 1.0], 4), ([3.0, 2.0, 1.0], 8), ([1.5; 3], 1)] {
        let found = parts(&grid, centre.into(), 0.3);
        assert_eq!(found.len(), count, "{centre:?}");
        for (_, part) in found {
            let expected = UNIT * 0.3_f64.powi(3) / count as f64;
            assert!((part - expected).abs() < 1e-15 * expected * count as f64, "{part:?} {expected:?}");
        }
    }
    let [x, ..] = grid.counts.map(|count| count as usize);
    assert_eq!(parts(&grid, [1.5, 2.0, 1.5].into(), 0.3)[1].0, x * x + 2 * x + 1, "along x first, then y, then z");
}

#[test]
fn parts_add_up_to_the_part_of_the_sphere_in_the_box() {
    let grid = uneven();
    let whole = Cuboid { corners: grid.corners };
    for radius in [0.01, 0.15, 0.4, 1.3, 9.0] {
        for centre in places(&grid, radius, 300) {
            let sum: f64 = parts(&grid, centre, radius).iter().map(|(_, part)| part).sum();
            let (expected, sphere) = (whole.volume_of_sphere(centre, radius), UNIT * radius.powi(3));
            assert!((sum - expected).abs() <= 2e-14 * sphere, "{centre:?} {radius}: {sum:?}, {expected:?} expected");
        }
    }
}

#[test]
fn a_cell_has_what_a_region_of_the_same_box_has() {
    let grid = uneven();
    for centre in places(&grid, 0.2, 100) {
        let mut left = parts(&grid, centre, 0.35);
        for cell in 0..grid.cells() {
            let region = Region::Box(grid.box_of(grid.place(cell)));
            let found =
                left.iter().position(|(other, _)| *other == cell).map_or(0.0, |place| left.swap_remove(place).1);
            assert_eq!(found, region.volume_of_sphere(centre, 0.35), "cell {cell} of {centre:?}");
        }
        assert!(left.is_empty());
    }
}

#[test]
fn parts_go_on_as_a_sphere_goes_through_a_face() {
    let grid = Grid { corners: [[0.0; 3], [1.0; 3]], counts: [2, 1, 1], repeats: [false; 3] };
    let (radius, mut before) = (0.1, None);
    for step in 0..=1000 {
        let x = 0.35 + 0.3 * f64::from(step) / 1000.0;
        let found = parts(&grid, [x, 0.5, 0.5].into(), radius);
        let first = found.iter().find(|(cell, _)| *cell == 0).map_or(0.0, |(_, part)| *part);
        // No part changes faster than the area of the largest circle.
        if let Some(before) = before.replace(first) {
            assert!(before - first >= 0.0 && before - first <= PI * radius * radius * 0.3001e-3, "{before} {first}");
        }
    }
    assert_eq!(before, Some(0.0));
}

#[test]
fn parts_of_a_line_are_those_in_the_boxes_of_the_cells() {
    let grid = uneven();
    let ends = places(&grid, 0.5, 200);
    for ends in ends.chunks_exact(2) {
        let mut found = vec![0.0; grid.cells()];
        grid.parts_of_line(ends[0], ends[1], |cell, share| found[cell] += share);
        for (cell, found) in found.into_iter().enumerate() {
            assert_eq!(found, Region::Box(grid.box_of(grid.place(cell))).share_of_line(ends[0], ends[1]));
        }
    }
    let mut all = Vec::new();
    grid.parts_of_line([-1.0, 1.0, 3.0].into(), [-1.0, 1.0, 3.0].into(), |cell, share| all.push((cell, share)));
    assert_eq!(all, [(grid.cell_of([-1.0, 1.0, 3.0].into()).unwrap(), 1.0)], "a line of no length is in one cell");
}

#[test]
fn weights_are_parts_of_one_and_give_linear_fields_back() {
    let grid = uneven();
    let edges = grid.edges();
    let field = |[x, y, z]: [f64; 3]| 3.0 - 2.0 * x + 0.7 * y + 1.3 * z;
    for point in places(&grid, 0.5, 1000) {
        let weights = grid.weights(point);
        assert!(weights.iter().all(|(cell, weight)| *weight >= 0.0 && *cell < grid.cells()));
        assert!((weights.iter().map(|(_, weight)| weight).sum::<f64>() - 1.0).abs() < 1e-15);
        let clamped = [0, 1, 2].map(|axis| {
            let [lower, upper] = grid.corners.map(|corner| corner[axis]);
            point.to_array()[axis].clamp(lower + 0.5 * edges[axis], upper - 0.5 * edges[axis])
        });
        let found: f64 = weights.iter().map(|(cell, weight)| weight * field(grid.centre(*cell))).sum();
        assert!((found - field(clamped)).abs() < 1e-13, "{point:?}: {found:?}, {:?} expected", field(clamped));
    }
}

#[test]
fn weights_go_on_through_faces_where_space_repeats() {
    let grid = Grid { repeats: [true, false, true], ..uneven() };
    let [lower, upper] = grid.corners;
    for point in places(&grid, 0.0, 100) {
        let shifted = Vector::new(upper[0] - lower[0], 0.0, -3.0 * (upper[2] - lower[2]));
        for ((cell, weight), (other, shifted)) in grid.weights(point).into_iter().zip(grid.weights(point + shifted)) {
            assert!(cell == other && (weight - shifted).abs() < 1e-12, "{point:?}: {cell} {weight}, {other} {shifted}");
        }
    }
    let half = grid.weights([lower[0], lower[1], lower[2]].into());
    let sum = |cell: usize| half.iter().filter(|(other, _)| *other == cell).map(|(_, weight)| weight).sum::<f64>();
    assert!((sum(0) - 0.25).abs() < 1e-15 && (sum(6) - 0.25).abs() < 1e-15, "{half:?}");
}

#[test]
fn a_point_is_in_one_cell() {
    let grid = uneven();
    for cell in 0..grid.cells() {
        assert_eq!(grid.cell_of(grid.centre(cell).into()), Some(cell));
        let [lower, upper] = grid.box_of(grid.place(cell)).corners;
        assert_eq!(grid.cell_of(lower.into()), Some(cell), "the lower faces are in it");
        assert_ne!(grid.cell_of(upper.into()), Some(cell));
    }
    assert_eq!(grid.cell_of(grid.corners[1].into()), None);
}

#[test]
fn a_lattice_of_spheres_fills_each_cell_alike() {
    // Simple cubic: spheres that touch, their centres on corners of cells, in cells and anywhere between.
    let grid = Grid { corners: [[0.0; 3], [4.0; 3]], counts: [4; 3], repeats: [false; 3] };
    for offset in [[0.0; 3], [0.5; 3], [0.17, 0.39, 0.88]] {
        let mut solid = vec![0.0; grid.cells()];
        for number in 0..216 {
            let centre = [number % 6 - 1, number / 6 % 6 - 1, number / 36 - 1].map(f64::from);
            let centre = [0, 1, 2].map(|axis| centre[axis] + offset[axis]);
            grid.parts_of_sphere(centre.into(), 0.5, |cell, part| solid[cell] += part);
        }
        for solid in solid {
            assert!((solid - PI / 6.0).abs() < 1e-14, "{solid:?}");
        }
    }
}
