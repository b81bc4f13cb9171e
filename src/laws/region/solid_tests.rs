//! Volumes and lengths inside of meshes, against those of boxes, against random points, against sums.

use super::{Cuboid, Region, Solid};
use crate::base::geometry::rotation;
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;
use crate::laws::region::sphere::UNIT;
use crate::laws::surface::{Shape, mesh};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::{PI, TAU};

/// Corners of triangles.
type Triangles = Vec<[Vector; 3]>;

/// The surface of triangles, by way of an STL file in text.
fn surface(triangles: &Triangles) -> Shape {
    let mut text = String::from("solid it\n");
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for corner in corners {
            text += &format!("vertex {:?} {:?} {:?}\n", corner.x, corner.y, corner.z);
        }
        text += "endloop\nendfacet\n";
    }
    text += "endsolid it\n";
    mesh::of_files(MaterialIndex(0), &[text.into_bytes()], Some(1)).expect("a right mesh")
}

/// The inside of triangles.
fn solid(triangles: &Triangles) -> Region {
    Region::Solid(Solid::of(surface(triangles)).expect("a closed mesh"))
}

/// A box of so many squares along each edge, each of two triangles; `flip` turns the diagonals of some.
fn boxed([low, high]: [[f64; 3]; 2], squares: usize, flip: impl Fn(usize) -> bool) -> Triangles {
    let mut triangles = Vec::new();
    let mut number = 0;
    for axis in 0..3 {
        for side in [0, 1] {
            for place in 0..squares * squares {
                let corner = |u: usize, v: usize| {
                    let share = |step: usize| step as f64 / squares as f64;
                    let (u, v) = (share(place % squares + u), share(place / squares + v));
                    let mut parts = [0.0; 3];
                    parts[axis] = side as f64;
                    parts[(axis + 1) % 3] = if side == 1 { u } else { v };
                    parts[(axis + 2) % 3] = if side == 1 { v } else { u };
                    Vector::from([0, 1, 2].map(|axis| low[axis] * (1.0 - parts[axis]) + high[axis] * parts[axis]))
                };
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                match flip(number) {
                    true => triangles.extend([[a, b, d], [b, c, d]]),
                    false => triangles.extend([[a, b, c], [a, c, d]]),
                }
                number += 1;
            }
        }
    }
    triangles
}

/// The same turned.
fn turned(triangles: &Triangles, by: [f64; 3]) -> Triangles {
    let turn = rotation::orientation(by.into());
    triangles.iter().map(|corners| corners.map(|corner| turn.turn(corner))).collect()
}

/// A point, turned.
fn turn(point: [f64; 3], by: [f64; 3]) -> Vector {
    rotation::orientation(by.into()).turn(point.into())
}

/// Numbers from 0 to 1.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    move || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Rotations for a test.
const TURNS: [[f64; 3]; 4] = [[0.0; 3], [0.3, -0.7, 1.1], [1.5, 0.2, -0.4], [0.0, 0.0, std::f64::consts::FRAC_PI_4]];

/// Compares a box with the same as a mesh for a sphere.
#[track_caller]
fn compare(corners: [[f64; 3]; 2], solid: &Region, by: [f64; 3], centre: [f64; 3], radius: f64) -> f64 {
    let expected = Region::Box(Cuboid { corners }).volume_of_sphere(centre.into(), radius);
    let found = solid.volume_of_sphere(turn(centre, by), radius);
    let error = (found - expected).abs() / (UNIT * radius.powi(3));
    assert!(
        error < 1e-10,
        "{found:?}, {expected:?} expected, {error:e}, at {centre:?}, radius {radius}, turned by {by:?}"
    );
    error
}

#[test]
fn a_mesh_of_a_box_cuts_spheres_as_the_box_does() {
    let corners = [[-0.3, 0.1, -1.0], [0.9, 1.2, 0.4]];
    let mut next = numbers(1);
    let mut worst: f64 = 0.0;
    for by in TURNS {
        for (squares, pattern) in [(1, 0), (1, 1), (3, 2), (7, 3)] {
            let flip = |number: usize| pattern == 1 || pattern > 1 && (number * 7).is_multiple_of(pattern);
            let solid = solid(&turned(&boxed(corners, squares, flip), by));
            assert!((solid.volume() - 1.2 * 1.1 * 1.4).abs() < 1e-13);
            for _ in 0..300 {
                let centre =
                    [0, 1, 2].map(|axis| corners[0][axis] - 0.3 + (corners[1][axis] - corners[0][axis] + 0.6) * next());
                let radius = 0.02 + 0.6 * next();
                worst = worst.max(compare(corners, &solid, by, centre, radius));
            }
        }
    }
    assert!(worst < 1e-13, "{worst:e}");
}

#[test]
fn spheres_about_faces_edges_and_corners_are_cut_as_by_the_box() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 2.0, 1.5]];
    let mut worst: f64 = 0.0;
    for by in TURNS {
        for squares in [1, 2, 4] {
            let solid = solid(&turned(&boxed(corners, squares, |number| number % 3 == 1), by));
            // Centres on faces, edges, corners, lines of the triangulation, and beside them by less and less.
            for number in 0..125 {
                for tiny in [0.0, 1e-17, 1e-15, 1e-12, 1e-8, 1e-4] {
                    let beside = [tiny, -0.7 * tiny, 0.4 * tiny];
                    let steps = [number % 5, number / 5 % 5, number / 25];
                    let centre = [0, 1, 2].map(|axis| corners[1][axis] * steps[axis] as f64 / 4.0 + beside[axis]);
                    for radius in [0.25, 0.5, 0.1, 1.0, 3.0] {
                        worst = worst.max(compare(corners, &solid, by, centre, radius));
                    }
                }
            }
        }
    }
    assert!(worst < 1e-11, "{worst:e}");
}

#[test]
fn small_spheres_at_large_faces_and_spheres_far_from_the_origin() {
    let corners = [[10.0, -3.0, 7.0], [11.0, -1.0, 8.5]];
    for by in TURNS {
        let solid = solid(&turned(&boxed(corners, 1, |_| true), by));
        let mut next = numbers(7);
        for _ in 0..400 {
            let radius = 1e-3;
            let near = |axis: usize, next: &mut dyn FnMut() -> f64| match (next() * 3.0) as usize {
                0 => corners[0][axis] + 2.0 * radius * (next() - 0.5),
                1 => corners[1][axis] + 2.0 * radius * (next() - 0.5),
                _ => corners[0][axis] + (corners[1][axis] - corners[0][axis]) * next(),
            };
            let centre = [near(0, &mut next), near(1, &mut next), near(2, &mut next)];
            compare(corners, &solid, by, centre, radius);
        }
    }
}

/// A torus about z.
fn torus(large: f64, small: f64, around: usize, across: usize) -> Triangles {
    let at = |i: usize, j: usize| {
        let (u, v) = (TAU * (i % around) as f64 / around as f64, TAU * (j % across) as f64 / across as f64);
        let r = large + small * libm::cos(v);
        Vector::new(r * libm::cos(u), r * libm::sin(u), small * libm::sin(v))
    };
    let cell = |number: usize| {
        let (i, j) = (number % around, number / around);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..around * across).flat_map(cell).collect()
}

/// An L of two arms, as a prism.
fn angle_piece() -> Triangles {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let at = |corner: usize, z: f64| Vector::new(outline[corner % 6][0], outline[corner % 6][1], z);
    let mut triangles = Vec::new();
    for corner in 0..6 {
        let (a, b, c, d) = (at(corner, 0.0), at(corner + 1, 0.0), at(corner + 1, 1.0), at(corner, 1.0));
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    for [a, b, c] in [[0, 1, 3], [1, 2, 3], [0, 3, 4], [0, 4, 5]] {
        triangles.extend([[at(a, 1.0), at(b, 1.0), at(c, 1.0)], [at(a, 0.0), at(c, 0.0), at(b, 0.0)]]);
    }
    triangles
}

#[test]
fn an_angle_is_two_boxes() {
    let boxes = [[[0.0, 0.0, 0.0], [2.0, 1.0, 1.0]], [[0.0, 1.0, 0.0], [1.0, 2.0, 1.0]]]
        .map(|corners| Region::Box(Cuboid { corners }));
    let mut next = numbers(3);
    for by in TURNS {
        let solid = solid(&turned(&angle_piece(), by));
        for number in 0..2000 {
            let radius = 0.05 + 1.2 * next();
            // Every third centre on the grid of corners and halves.
            let mut along = |length: f64| match number % 3 {
                0 => ((next() * 2.0 * length) as i32) as f64 * 0.5,
                _ => (length + 0.4) * next() - 0.2,
            };
            let centre = [along(2.0), along(2.0), along(1.0)];
            let expected: f64 = boxes.iter().map(|part| part.volume_of_sphere(centre.into(), radius)).sum();
            let found = solid.volume_of_sphere(turn(centre, by), radius);
            let error = (found - expected).abs() / (UNIT * radius.powi(3));
            assert!(error < 1e-13, "{error:e}: {found:?}, {expected:?} expected at {centre:?}, {radius}");
            let far = [along(2.0), along(2.0), along(1.0)];
            let expected: f64 = boxes.iter().map(|part| part.share_of_line(centre.into(), far.into())).sum();
            let found = solid.share_of_line(turn(centre, by), turn(far, by));
            // A line in the face between the boxes is inside of both; one in a face of the surface counts or not.
            let in_face = (0..3).any(|axis| centre[axis] == far[axis] && centre[axis].fract() == 0.0);
            assert!(
                in_face || (found - expected).abs() < 1e-13,
                "{found:?}, {expected:?} expected from {centre:?} to {far:?}"
            );
        }
    }
}

#[test]
fn random_points_say_the_same_of_a_torus() {
    let (large, small) = (1.0, 0.4);
    let region = solid(&torus(large, small, 48, 24));
    let mut next = numbers(5);
    for (centre, radius) in
        [([1.0, 0.1, 0.2], 0.5), ([0.0, 0.0, 0.0], 0.9), ([0.3, -0.2, 0.4], 0.7), ([1.3, 0.5, -0.1], 0.3)]
    {
        let centre = Vector::from(centre);
        let (mut inside, count) = (0, 40_000);
        for _ in 0..count {
            let place = loop {
                let place = Vector::new(next() * 2.0 - 1.0, next() * 2.0 - 1.0, next() * 2.0 - 1.0);
                if place.dot(place) <= 1.0 {
                    break place * radius + centre;
                }
            };
            inside += i32::from(region.holds(place));
        }
        let share = f64::from(inside) / f64::from(count);
        let found = region.volume_of_sphere(centre, radius) / (UNIT * radius.powi(3));
        let spread = (share * (1.0 - share) / f64::from(count)).sqrt();
        assert!((found - share).abs() < 4.0 * spread, "{found}, {share} ± {spread} expected at {centre:?}");
        assert!(found > 0.05 && found < 0.95, "{found}");
    }
    // A sphere around all of it; Pappus, less what the facets cut off.
    let all = region.volume_of_sphere(Vector::zero(), 2.0);
    assert!((all - region.volume()).abs() < 1e-14, "{all}");
    let smooth = 2.0 * PI * PI * large * small * small;
    assert!((all / smooth - 1.0).abs() < 0.02, "{all}, {smooth}");
}

#[test]
fn a_tetrahedron_takes_of_a_ball_at_its_corner_what_its_solid_angle_says() {
    let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::from);
    for by in TURNS {
        let region = solid(&turned(&vec![[a, c, b], [a, b, d], [a, d, c], [b, c, d]], by));
        let radius = 0.25;
        let at = |point: Vector| region.volume_of_sphere(turn(point.to_array(), by), radius) / (UNIT * radius.powi(3));
        assert!((at(a) - 1.0 / 8.0).abs() < 1e-13);
        // At (1, 0, 0): directions (−1,0,0), (−1,1,0), (−1,0,1); Ω by van Oosterom and Strackee.
        let (first, second, third) =
            (Vector::new(-1.0, 0.0, 0.0), Vector::new(-1.0, 1.0, 0.0), Vector::new(-1.0, 0.0, 1.0));
        let angle = super::solid::solid_angle([first, second, third]).abs();
        assert!((at(b) - angle / (2.0 * TAU)).abs() < 1e-13, "{} {}", at(b), angle);
        // In the middle of the edge from a to b: a right angle; of the edge from b to c: that of the planes, atan √2.
        assert!((at(Vector::new(0.5, 0.0, 0.0)) - 0.25).abs() < 1e-13);
        let dihedral = libm::atan2(2.0_f64.sqrt(), 1.0);
        assert!((at(Vector::new(0.5, 0.5, 0.0)) - dihedral / TAU).abs() < 1e-13);
        // The ball inside of it that touches all faces.
        let inscribed = (3.0 - 3.0_f64.sqrt()) / 6.0;
        let inner = region.volume_of_sphere(turn([inscribed; 3], by), inscribed * (1.0 - 1e-12));
        assert!((inner - UNIT * inscribed.powi(3)).abs() < 1e-11 * UNIT * inscribed.powi(3));
    }
}

#[test]
fn a_cavity_is_outside() {
    let mut triangles = boxed([[0.0; 3], [1.0; 3]], 1, |_| false);
    let hole = boxed([[0.25; 3], [0.75; 3]], 2, |_| true);
    triangles.extend(hole.iter().map(|[a, b, c]| [*a, *c, *b]));
    let region = solid(&triangles);
    assert!((region.volume() - 0.875).abs() < 1e-14);
    let [outer, inner] = [[[0.0; 3], [1.0; 3]], [[0.25; 3], [0.75; 3]]].map(|corners| Region::Box(Cuboid { corners }));
    let mut next = numbers(11);
    for number in 0..500 {
        let mut centre = [next(), next(), next()];
        if number % 4 == 0 {
            // On the surface of the cavity, and at its corners.
            centre = centre.map(|part| {
                if part < 0.4 {
                    0.25
                } else if part > 0.6 {
                    0.75
                } else {
                    part
                }
            });
        }
        let radius = 0.05 + 0.9 * next();
        let of = |region: &Region| region.volume_of_sphere(centre.into(), radius);
        let error = (of(&region) - of(&outer) + of(&inner)).abs() / (UNIT * radius.powi(3));
        assert!(error < 1e-13, "{error:e} at {centre:?}, {radius}");
    }
    assert!(!region.holds(Vector::new(0.5, 0.5, 0.5)) && region.holds(Vector::new(0.1, 0.5, 0.5)));
    let share = region.share_of_line(Vector::new(-0.5, 0.4, 0.5), Vector::new(1.5, 0.4, 0.5));
    assert!((share - 0.25).abs() < 1e-15, "{share}");
}

#[test]
fn normals_that_point_inwards_give_the_same_inside() {
    let triangles = angle_piece();
    let inwards: Triangles = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let [one, other] = [&triangles, &inwards].map(solid);
    let mut next = numbers(13);
    for _ in 0..200 {
        let (centre, radius) = (Vector::new(2.0 * next(), 2.0 * next(), next()), 0.1 + next());
        let difference = one.volume_of_sphere(centre, radius) - other.volume_of_sphere(centre, radius);
        assert!(difference.abs() < 1e-14 * radius.powi(3), "{difference:e}");
        let far = Vector::new(2.0 * next(), 2.0 * next(), next());
        assert!((one.share_of_line(centre, far) - other.share_of_line(centre, far)).abs() < 1e-14);
    }
}

#[test]
fn parts_that_contradict_each_other_are_refused() {
    let one = boxed([[0.0; 3], [1.0; 3]], 1, |_| false);
    let inwards = |triangles: Triangles| -> Triangles { triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect() };
    let beside = boxed([[2.0; 3], [2.5; 3]], 1, |_| false);
    let within = boxed([[0.2; 3], [0.5; 3]], 1, |_| false);
    let both =
        |other: &Triangles| Solid::of(surface(&one.iter().chain(other).copied().collect())).map(|solid| solid.volume());
    assert!(both(&beside).is_ok_and(|volume| (volume - 1.125).abs() < 1e-14));
    assert!(both(&inwards(beside)).is_err());
    assert!(both(&within).is_err());
    assert!(both(&inwards(within)).is_ok_and(|volume| (volume - 0.973).abs() < 1e-14));
}

#[test]
fn a_sphere_is_put_whole_inside_at_places_all_equally_likely() {
    let region = solid(&angle_piece());
    let (mut next, radius) = (numbers(17), 0.2);
    let mut counts = [0_u32; 3];
    for _ in 0..3000 {
        let [x, y, z] = region.place(radius, &mut next).expect("it fits").to_array();
        assert!(region.volume_of_sphere(Vector::new(x, y, z), radius) > (1.0 - 1e-12) * UNIT * radius.powi(3));
        counts[if x > 0.8 {
            1
        } else if y > 0.8 {
            2
        } else {
            0
        }] += 1;
    }
    // 0.6² in the corner, 1 × 0.6 in each arm.
    let expected = [0.36, 0.6, 0.6].map(|area| 3000.0 * area / 1.56);
    for (count, expected) in counts.into_iter().zip(expected) {
        assert!((f64::from(count) - expected).abs() < 4.0 * expected.sqrt(), "{counts:?}, {expected}");
    }
    assert!(region.place(0.51, &mut next).is_none());
}
