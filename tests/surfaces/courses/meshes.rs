//! Courses of spheres over bumps, edges and vertices, whatever the triangulation and the axes.

use super::scenes::{G, Law, MASS, MESH, RADIUS, ROUGH, SMOOTH, start};
use crate::support::Triangle;
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Largest deviation of the energy over its first value, and largest change of the force from one step to the next over the weight.
fn energy_and_force(simulation: &mut Simulation, gravity: f64, step: f64, duration: f64) -> [f64; 2] {
    let (mut first, mut before, mut worst) = (None, None, [0.0_f64; 2]);
    for _ in 0..(duration / step).round() as usize {
        simulation.advance(step).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        let height = particles.position[0][2];
        let kinetic = simulation.kinetic_energy();
        let energy = kinetic + simulation.elastic_energy() + MASS * gravity * height;
        let (start, scale) = *first.get_or_insert((energy, kinetic));
        worst[0] = worst[0].max((energy - start).abs() / scale);
        let force = particles.force[0];
        let earlier: [f64; 4] = before.replace(force).unwrap_or(force);
        let change = (0..3).map(|axis| (force[axis] - earlier[axis]).powi(2)).sum::<f64>().sqrt();
        worst[1] = worst[1].max(change / (MASS * gravity));
    }
    worst
}

#[test]
fn drops_on_a_vertex_an_edge_and_a_needle_keep_their_energy_to_the_second_order() {
    let top = [0.0, 0.0, 0.0];
    let base = [[0.01, 0.0, -0.01], [-0.006, 0.008, -0.01], [-0.006, -0.008, -0.01]];
    let vertex: Vec<Triangle> = (0..3).map(|side| [top, base[side], base[(side + 1) % 3]]).collect();
    let at = |x: f64, y: f64| [x, y, -x.abs()];
    let side = |x: f64| [[at(0.0, -0.02), at(x, -0.02), at(x, 0.02)], [at(0.0, -0.02), at(x, 0.02), at(0.0, 0.02)]];
    let edge = [side(0.02), side(-0.02)].concat();
    let needle = vec![[[-0.03, -3e-4, 0.0], [0.03, 0.0, 0.0], [-0.03, 3e-4, 0.0]]];
    for (name, mesh, x) in [("vertex", vertex, 4e-4), ("edge", edge, 1e-3), ("needle", needle, 0.0297)] {
        let error = |step: f64| {
            let sphere = [[x, 2e-4, RADIUS + 1e-4], [0.0, 0.0, -0.2]];
            let mut simulation = start(&[sphere], SMOOTH, [0.0, 0.0, -G], step, MESH, &mesh);
            energy_and_force(&mut simulation, G, step, 4e-3)[0]
        };
        let errors = [4e-6, 2e-6].map(error);
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "{name}: order {order} of {errors:?}");
    }
}

/// A number from −½ to ½.
fn random(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / f64::from(u32::MAX) - 0.5
}

/// A square of 60 mm about the origin of 625 points that are shifted at random, also up and down by as much as this \[m\].
fn bumps(height: f64) -> Vec<Triangle> {
    const CELLS: usize = 24;
    let mut rng = ChaCha8Rng::seed_from_u64(29);
    let mut point = |number: usize| {
        let (i, j) = (number / (CELLS + 1), number % (CELLS + 1));
        // Less than a quarter of a cell: no triangle folds over its neighbour.
        let mut place = |k: usize| {
            let inside = if k == 0 || k == CELLS { 0.0 } else { 0.4 };
            0.06 * ((k as f64 + inside * random(&mut rng)) / CELLS as f64 - 0.5)
        };
        let [x, y] = [place(i), place(j)];
        [x, y, height * (random(&mut rng) - 0.5)]
    };
    let points: Vec<[f64; 3]> = (0..(CELLS + 1) * (CELLS + 1)).map(&mut point).collect();
    let at = |i: usize, j: usize| points[i * (CELLS + 1) + j];
    let cell = |number: usize| {
        let (i, j) = (number / CELLS, number % CELLS);
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    (0..CELLS * CELLS).flat_map(cell).collect()
}

#[test]
fn over_bumps_energy_and_force_follow_the_time_step() {
    // mesh-contact, row l: a contact that comes or goes would give steps of 3 to 6 times the weight at any Δt.
    for height in [1e-5, 2e-4] {
        let mesh = bumps(height);
        let errors = [1e-5, 5e-6].map(|step| {
            let sphere = [[-0.027, 0.004, RADIUS + 0.2 * height], [0.54, 0.0, 0.0]];
            let mut simulation = start(&[sphere], SMOOTH, [0.0, 0.0, -100.0], step, MESH, &mesh);
            energy_and_force(&mut simulation, 100.0, step, 0.1)
        });
        let [energy, force] = [0, 1].map(|part| (errors[0][part] / errors[1][part]).log2());
        assert!(energy >= 1.3, "{height} m: energy of order {energy}, {errors:?}");
        assert!((force - 1.0).abs() < 0.1, "{height} m: force steps of order {force}, {errors:?}");
    }
}

/// A vector turned about (1, 2, 2)/3 by 0.7 rad.
fn turned(v: [f64; 3]) -> [f64; 3] {
    let (sine, cosine) = 0.7_f64.sin_cos();
    let n = [1.0, 2.0, 2.0].map(|part| part / 3.0);
    let along = (0..3).map(|axis| n[axis] * v[axis]).sum::<f64>() * (1.0 - cosine);
    let cross = [n[1] * v[2] - n[2] * v[1], n[2] * v[0] - n[0] * v[2], n[0] * v[1] - n[1] * v[0]];
    [0, 1, 2].map(|axis| v[axis] * cosine + cross[axis] * sine + n[axis] * along)
}

/// Places and velocities of spheres that fall on bumps and touch each other, after 3 ms.
fn tossed(law: Law, mesh: &[Triangle], turn: fn([f64; 3]) -> [f64; 3]) -> Vec<[[f64; 3]; 2]> {
    let sphere = |number: u32| {
        let [i, j] = [number % 4, number / 4].map(f64::from);
        [turn([0.0102 * i - 0.0151, 0.0103 * j - 0.0153, RADIUS + 2e-4]), turn([0.3, 0.1, -0.2])]
    };
    let spheres: Vec<_> = (0..16).map(sphere).collect();
    let mesh: Vec<Triangle> = mesh.iter().map(|corners| corners.map(turn)).collect();
    let mut simulation = start(&spheres, law, turn([0.0, 0.0, -G]), 1e-5, MESH, &mesh);
    simulation.advance(3e-3).unwrap_or_else(|error| panic!("{error}"));
    let state = simulation.state();
    assert!(state.boundaries[0].force[2].abs() > 0.0, "they touch the bumps");
    let three = |row: [f64; 4]| [row[0], row[1], row[2]];
    let slots = state.particles.slot.iter().map(|slot| *slot as usize);
    slots.map(|slot| [three(state.particles.position[slot]), three(state.particles.velocity[slot])]).collect()
}

/// Fails unless places agree to a share of the radius, and velocities to one of 0.3 m/s.
#[track_caller]
fn assert_same(found: &[[[f64; 3]; 2]], expected: &[[[f64; 3]; 2]], share: f64) {
    for (found, expected) in found.iter().zip(expected) {
        for (part, scale) in [(0, RADIUS), (1, 0.3)] {
            let apart = (0..3).map(|axis| (found[part][axis] - expected[part][axis]).abs()).fold(0.0, f64::max);
            assert!(apart <= share * scale, "{found:?} found, {expected:?} expected");
        }
    }
}

#[test]
fn order_and_orientation_of_the_triangles_do_not_matter() {
    let mesh = bumps(2e-4);
    let expected = tossed(ROUGH, &mesh, |v| v);
    let mixed = mesh.iter().rev().zip(0..).map(|([a, b, c], k)| match k % 3 {
        0 => [*a, *b, *c],
        1 => [*b, *c, *a],
        _ => [*c, *a, *b],
    });
    assert_same(&tossed(ROUGH, &mixed.collect::<Vec<_>>(), |v| v), &expected, 1e-12);
    let over: Vec<Triangle> = mesh.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    assert_same(&tossed(ROUGH, &over, |v| v), &expected, 1e-12);
}

#[test]
fn four_triangles_in_place_of_each_change_no_course() {
    let middle = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis]));
    let four = |[a, b, c]: &Triangle| {
        let (d, e, f) = (middle(*a, *b), middle(*b, *c), middle(*c, *a));
        [[*a, d, f], [d, *b, e], [f, e, *c], [d, e, f]]
    };
    let mesh = bumps(2e-4);
    let finer: Vec<Triangle> = mesh.iter().flat_map(four).collect();
    for law in [SMOOTH, ROUGH] {
        assert_same(&tossed(law, &finer, |v| v), &tossed(law, &mesh, |v| v), 1e-10);
    }
}

#[test]
fn a_scene_that_is_turned_as_a_whole_goes_on_turned() {
    let mesh = bumps(2e-4);
    let expected: Vec<_> = tossed(ROUGH, &mesh, |v| v).into_iter().map(|both| both.map(turned)).collect();
    assert_same(&tossed(ROUGH, &mesh, turned), &expected, 1e-10);
}

#[test]
fn a_floor_and_walls_of_triangles_bear_the_weight_of_what_lies_in_them() {
    let (low, high) = (-0.0125, 0.0125);
    let corner = |x: usize, y: usize, z: f64| [[low, high][x], [low, high][y], z];
    let quad = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| [[a, b, c], [a, c, d]];
    let ring = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let mut mesh = quad(corner(0, 0, 0.0), corner(1, 0, 0.0), corner(1, 1, 0.0), corner(0, 1, 0.0)).to_vec();
    for side in 0..4 {
        let ([a, b], [c, d]) = (ring[side], ring[(side + 1) % 4]);
        mesh.extend(quad(corner(a, b, 0.0), corner(a, b, 0.05), corner(c, d, 0.05), corner(c, d, 0.0)));
    }
    let sphere = |number: usize| {
        let [i, j, k] = [number % 2, number / 2 % 2, number / 4].map(|it| it as f64);
        [[0.0125 * i - 0.00625 + 1e-4 * k, 0.0124 * j - 0.0061, 0.0051 + 0.0104 * k], [0.0; 3]]
    };
    let spheres: Vec<_> = (0..8).map(sphere).collect();
    let law = ([0.1, 0.5, 0.0], ROUGH.1);
    let mut simulation = start(&spheres, law, [0.0, 0.0, -G], 2e-5, MESH, &mesh);
    simulation.advance(1.0).unwrap_or_else(|error| panic!("{error}"));
    let force = simulation.state().boundaries[0].force;
    let weight = 8.0 * MASS * G;
    assert!((force[2] / -weight - 1.0).abs() < 1e-6, "{} N, not {} N", force[2], -weight);
}
