//! The force of surfaces on a sphere: of faces, edges, corners, bends and every shape.

use super::scenes::{MESH, RADIUS, ROUGH, assert_same, bend, force_at, forces, hertz, random, scene, sheet};
use crate::support::Triangle;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

#[test]
fn any_triangulation_of_a_plane_is_the_plane() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let triangles = sheet(&mut rng, 0.0);
    let corners: Vec<[f64; 3]> = triangles.iter().flatten().copied().collect();
    let mut places: Vec<[f64; 2]> = (0..15).map(|_| [0.0; 2].map(|_: f64| 0.04 * (random(&mut rng) - 0.5))).collect();
    // On vertices and on edges, too.
    let inner = |corner: &&[f64; 3]| corner[0].abs() < 0.02 && corner[1].abs() < 0.02;
    places.extend(corners.iter().filter(inner).take(8).map(|corner| [corner[0], corner[1]]));
    let middles = triangles.iter().map(|[a, b, _]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
    places.extend(middles.filter(|[x, y]| x.abs() < 0.02 && y.abs() < 0.02).take(8));
    let expected = [0.0, 0.0, hertz(5e-5)];
    for [x, y] in places {
        assert_same(force_at([x, y, RADIUS - 5e-5], MESH, &[("wall.stl", triangles.clone())]), expected, 1e-12);
    }
}

#[test]
fn friction_on_any_triangulation_of_a_plane_is_that_on_the_plane() {
    let square = [[-0.03, -0.03, 0.0], [0.03, -0.03, 0.0], [0.03, 0.03, 0.0], [-0.03, 0.03, 0.0]];
    let [a, b, c, d] = square;
    let middle = [0.0, 0.0, 0.0];
    let two = vec![[a, b, c], [a, c, d]];
    let four = vec![[a, b, middle], [b, c, middle], [c, d, middle], [d, a, middle]];
    let turned: Vec<Triangle> = two.iter().map(|[a, b, c]| [*b, *c, *a]).collect();
    // On a corner of four triangles and on edges of two, beside them, and inside of a face.
    let places = [[0.0, 0.0], [0.003, 0.003], [-0.007, 0.007], [0.003, 0.003 + 1e-12], [0.011, 0.002]];
    let places = places.map(|[x, y]| [x, y, RADIUS - 5e-5]);
    let belt = "material = \"wall\"\nmotion = { conveying = { x = 0.1, y = 0.07 } }\n";
    let plane = format!("[boundary.wall]\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\n{belt}");
    let mesh = format!("[boundary.wall]\nmesh = {{ file = \"wall.stl\", sides = 2 }}\n{belt}");
    for place in places {
        let expected = forces(&scene(&[place], ROUGH, &plane, &[]))[0];
        assert!(expected[0] > 0.0 && expected[1] > 0.0);
        for triangles in [&two, &four, &turned] {
            let found = forces(&scene(&[place], ROUGH, &mesh, &[("wall.stl", triangles.clone())]))[0];
            assert_same(found, expected, 1e-12);
        }
    }
}

#[test]
fn a_ridge_and_a_plate_of_two_triangles_push_from_the_nearest_point() {
    // Two faces at 45° that meet along y at the top.
    let at = |x: f64, y: f64| [x, y, -x.abs()];
    let face = |x: f64| [[at(0.0, -0.02), at(x, -0.02), at(x, 0.02)], [at(0.0, -0.02), at(x, 0.02), at(0.0, 0.02)]];
    let ridge = [face(0.02), face(-0.02)].concat();
    let reversed: Vec<Triangle> = ridge.iter().rev().copied().collect();
    for triangles in [ridge, reversed] {
        // From one normal to the other the force is that of the distance from the top; 0.066, 0 and 0.395 N at (0.8, 4.8) mm.
        let ways = [-39.0_f64, -20.0, 0.0, 31.0, 44.9].map(|degrees| degrees.to_radians().sin_cos());
        let around = ways.map(|(sine, cosine)| [4.866e-3 * sine, 4.866e-3 * cosine]);
        for [x, z] in around.into_iter().chain([[0.8e-3, 4.8e-3]]) {
            let away = x.hypot(z);
            let expected = [x, 0.0, z].map(|part| part / away * hertz(RADIUS - away));
            assert_same(force_at([x, 0.3e-3, z], MESH, &[("wall.stl", triangles.clone())]), expected, 1e-12);
        }
        let found = force_at([0.8e-3, 0.3e-3, 4.8e-3], MESH, &[("wall.stl", triangles)]);
        assert_same(found, [0.065_895_666_602_5, 0.0, 0.395_373_999_615], 1e-11);
    }
}

#[test]
fn a_concave_bend_gives_one_face_at_small_angles_and_two_at_large_ones() {
    let table = [(1.0, 0.092_085_453_653_6), (2.0, 0.093_610_861_398_6), (5.0, 0.104_045_787_795)];
    for (degrees, expected) in table.into_iter().chain([(10.0, 0.137_548_599_194)]) {
        let height = (RADIUS - 5e-5) / (0.5_f64 * f64::to_radians(degrees)).cos();
        let triangles = bend(degrees);
        let found = force_at([0.0, 1e-3, height], MESH, &[("wall.stl", triangles)]);
        assert_same(found, [0.0, 0.0, expected], 1e-11);
        // Both faces less the edge, if it is within reach.
        let upwards = 2.0 * hertz(5e-5) * (0.5_f64 * f64::to_radians(degrees)).cos();
        let edge = if height < RADIUS { hertz(RADIUS - height) } else { 0.0 };
        assert_same(found, [0.0, 0.0, upwards - edge], 1e-12);
    }
}

#[test]
fn the_force_is_continuous_where_a_sphere_crosses_a_shallow_bend() {
    let (count, triangles) = (400, bend(2.0));
    let mut before: Option<[f64; 3]> = None;
    for number in 0..count {
        let x = 4e-4 * (f64::from(number) / f64::from(count) - 0.5);
        let found = force_at([x, 0.0, RADIUS - 4.5e-4], MESH, &[("wall.stl", triangles.clone())]);
        if let Some(before) = before {
            // A step of 1 µm: far less than a face that comes or goes, which is the whole force.
            let jump = (0..3).map(|axis| (found[axis] - before[axis]).powi(2)).sum::<f64>().sqrt();
            assert!(jump < 0.01 * hertz(4.5e-4), "{jump:e} N at x = {x:e} m");
        }
        before = Some(found);
    }
}

#[test]
fn every_shape_pushes_across_itself_with_the_force_of_a_plane() {
    let force = hertz(5e-5);
    let near = RADIUS - 5e-5;
    let cases = [
        (
            "disc = { centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 2.0], radius = 0.02 }",
            [1e-3, 2e-3, near],
            [0.0, 0.0, 1.0],
        ),
        (
            "disc = { centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 2.0], radius = 0.02 }",
            [0.0, 0.0, -near],
            [0.0, 0.0, -1.0],
        ),
        (
            "disc = { centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 2.0], radius = 0.02 }",
            [0.02 + near, 0.0, 0.0],
            [1.0, 0.0, 0.0],
        ),
        (
            "rectangle = { corner = [-0.02, -0.02, 0.0], edges = [[0.04, 0.0, 0.0], [0.0, 0.04, 0.0]] }",
            [1e-3, 2e-3, near],
            [0.0, 0.0, 1.0],
        ),
        (
            "rectangle = { corner = [-0.02, -0.02, 0.0], edges = [[0.04, 0.0, 0.0], [0.0, 0.04, 0.0]] }",
            [0.02 + 0.6 * near, 0.0, 0.8 * near],
            [0.6, 0.0, 0.8],
        ),
        (
            "cylinder = { from = [0.0, 0.0, -1.0], to = [0.0, 0.0, 1.0], radius = 0.05 }",
            [0.05 - near, 0.0, 0.3],
            [-1.0, 0.0, 0.0],
        ),
        (
            "cylinder = { from = [0.0, 0.0, -1.0], to = [0.0, 0.0, 1.0], radius = 0.05, infinite = true }",
            [0.0, 0.05 + near, 7.0],
            [0.0, 1.0, 0.0],
        ),
        (
            "cylinder = { from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 1.0], radius = 0.05, caps = \"both\" }",
            [0.01, 0.0, 1.0 + near],
            [0.0, 0.0, 1.0],
        ),
        (
            "cone = { from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.3], radii = [0.0, 0.4] }",
            [0.2 - 0.6 * near, 0.0, 0.15 + 0.8 * near],
            [-0.6, 0.0, 0.8],
        ),
        (
            "cone = { from = [0.0, 0.0, 0.0], to = [0.0, 0.0, -0.3], radii = [0.0, 0.4] }",
            [0.0, 0.0, near],
            [0.0, 0.0, 1.0],
        ),
        (
            "revolution = { origin = [0.0, 0.0, 0.0], axis = [0.0, 0.0, 1.0], profile = [[0.0, 0.0], [0.05, 0.0], [0.05, 0.1]] }",
            [0.02, 0.0, near],
            [0.0, 0.0, 1.0],
        ),
    ];
    for (shape, place, direction) in cases {
        let found = force_at(place, &format!("[boundary.wall]\nmaterial = \"wall\"\n{shape}\n"), &[]);
        assert_same(found, direction.map(|part| part * force), 1e-11);
    }
}

#[test]
fn planes_push_whatever_surfaces_stand_before_and_between_them() {
    // A plane whose list stood behind that of another surface once worked on that one's list: it pushed nobody.
    let disc = "disc = { centre = [0.0, 0.0, 1.0], normal = [0.0, 0.0, 1.0], radius = 0.02 }";
    let plane =
        |x: f64, normal: f64| format!("plane = {{ point = [{x:?}, 0.0, 0.0], normal = [{normal:?}, 0.0, 0.0] }}");
    let boundaries: String = [("a", disc.to_owned()), ("b", plane(-0.05, 1.0)), ("c", disc.replace("1.0]", "2.0]"))]
        .into_iter()
        .chain([("d", plane(0.05, -1.0))])
        .map(|(name, shape)| format!("[boundary.{name}]\nmaterial = \"wall\"\n{shape}\n"))
        .collect();
    for side in [-1.0, 1.0] {
        let found = force_at([side * (0.05 - RADIUS + 5e-5), 0.0, 0.0], &boundaries, &[]);
        assert_same(found, [-side * hertz(5e-5), 0.0, 0.0], 1e-11);
    }
}

#[test]
fn a_capped_cylinder_has_floor_and_wall_in_its_corner_and_the_rim_outside() {
    let can = "[boundary.wall]\nmaterial = \"wall\"\n\
               cylinder = { from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.1], radius = 0.03, caps = \"from\" }\n";
    let (near, force) = (RADIUS - 5e-5, hertz(5e-5));
    // Both at once: the corner itself is out of reach.
    assert_same(force_at([0.03 - near, 0.0, near], can, &[]), [-force, 0.0, force], 1e-11);
    // The convex corner outside counts once, along the line from it.
    assert_same(force_at([0.03 + 0.6 * near, 0.0, -0.8 * near], can, &[]), [0.6 * force, 0.0, -0.8 * force], 1e-11);
    // So does the free rim at the top.
    assert_same(force_at([0.03 + 0.6 * near, 0.0, 0.1 + 0.8 * near], can, &[]), [0.6 * force, 0.0, 0.8 * force], 1e-11);
}

#[test]
fn four_triangles_in_place_of_each_change_nothing() {
    let split = |triangles: &[Triangle]| -> Vec<Triangle> {
        let middle = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis]));
        let four = |[a, b, c]: &Triangle| {
            let (d, e, f) = (middle(*a, *b), middle(*b, *c), middle(*c, *a));
            [[*a, d, f], [d, *b, e], [f, e, *c], [d, e, f]]
        };
        triangles.iter().flat_map(four).collect()
    };
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let bumps = sheet(&mut rng, 2e-4);
    let finer = split(&bumps);
    for _ in 0..12 {
        let place = [0.03 * (random(&mut rng) - 0.5), 0.03 * (random(&mut rng) - 0.5), RADIUS + 4e-5];
        let coarse = force_at(place, MESH, &[("wall.stl", bumps.clone())]);
        let fine = force_at(place, MESH, &[("wall.stl", finer.clone())]);
        assert_same(fine, coarse, 1e-10);
    }
}
