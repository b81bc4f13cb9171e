//! Closed forms at edges, vertices and bends; any triangulation of a plane is the plane.

use super::*;
use crate::surface_mesh::{Placement, Soup};

/// Radius of the sphere \[m\].
const RADIUS: f64 = 5e-3;
/// Effective modulus of two bodies of 5 MPa and ν = 0.3 \[Pa\].
const MODULUS: f64 = 5e6 / (2.0 * (1.0 - 0.3 * 0.3));

/// Hertz' force at an overlap \[N\]; with a plane, an edge and a vertex alike.
fn hertz(overlap: f64) -> f64 {
    4.0 / 3.0 * MODULUS * RADIUS.sqrt() * overlap * overlap.sqrt()
}

/// The surface of these triangles.
fn mesh(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> SurfaceMesh {
    let faces = (1..=triangles.len() as u32).collect();
    SurfaceMesh::new(&Soup { vertices, triangles, faces }, &Placement::default()).unwrap().0
}

/// The touches of a sphere, all triangles asked.
fn touches(mesh: &SurfaceMesh, centre: [f64; 3], sides: Sides) -> Vec<Touch> {
    mesh.touches(centre, RADIUS, sides, 0..mesh.triangles.len() as u32)
}

/// The force on a sphere: of every feature, as often as it counts.
fn force(mesh: &SurfaceMesh, centre: [f64; 3], sides: Sides) -> [f64; 3] {
    let sum = touches(mesh, centre, sides).iter().fold(Vector::zero(), |sum, touch| {
        let normal = Vector::new(touch.normal[0], touch.normal[1], touch.normal[2]);
        sum + normal * (f64::from(touch.multiplicity) * hertz(RADIUS - touch.distance))
    });
    sum.to_array()
}

/// Two strips that meet in an edge along y at the origin, each turned down by this angle; cut into triangles.
fn bend(down: f64, cuts: i32) -> SurfaceMesh {
    let (sine, cosine) = (libm::sin(down), libm::cos(down));
    let mut vertices = Vec::new();
    for row in -cuts..=cuts {
        let y = 0.02 * f64::from(row) / f64::from(cuts);
        vertices.extend([[-0.03 * cosine, y, -0.03 * sine], [0.0, y, 0.0], [0.03 * cosine, y, -0.03 * sine]]);
    }
    let mut triangles = Vec::new();
    for row in 0..2 * cuts as u32 {
        for strip in 0..2 {
            let corner = 3 * row + strip;
            triangles.push([corner, corner + 1, corner + 4]);
            triangles.push([corner, corner + 4, corner + 3]);
        }
    }
    mesh(vertices, triangles)
}

/// A number from −1 to 1 from a whole one, without pattern.
fn scattered(seed: u64) -> f64 {
    let mixed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// A flat floor whose vertices are scattered and whose diagonals run either way.
fn floor() -> SurfaceMesh {
    let mut vertices = Vec::new();
    for row in 0..9_u64 {
        for column in 0..9_u64 {
            let shift = |seed: u64| 1e-3 * scattered(100 * row + column + seed);
            vertices.push([4e-3 * column as f64 - 0.016 + shift(1), 4e-3 * row as f64 - 0.016 + shift(7777), 0.0]);
        }
    }
    let mut triangles = Vec::new();
    for row in 0..8 {
        for column in 0..8 {
            let [a, b] = [9 * row + column, 9 * row + column + 1];
            let [c, d] = [b + 9, a + 9];
            let one_way = scattered(u64::from(a)) > 0.0;
            triangles.extend(if one_way { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    mesh(vertices, triangles)
}

#[test]
fn any_triangulation_of_a_plane_is_the_plane_on_faces_edges_and_vertices() {
    let floor = floor();
    let mut places: Vec<[f64; 2]> = (0..500).map(|k| [0.008 * scattered(k), 0.008 * scattered(k + 9999)]).collect();
    let inner = |place: &[f64; 2]| place.iter().all(|part| part.abs() < 0.009);
    places.extend(floor.vertices.iter().map(|vertex| [vertex[0], vertex[1]]).filter(inner));
    places.extend(
        floor
            .edges
            .iter()
            .map(|edge| {
                let [a, b] = edge.ends.map(|end| floor.vertices[end as usize]);
                [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
            })
            .filter(inner),
    );
    for [x, y] in places {
        for (height, sides) in [(4.95e-3, Sides::Both), (-4.95e-3, Sides::Both), (4.95e-3, Sides::Front)] {
            let found = touches(&floor, [x, y, height], sides);
            let count: i32 = found.iter().map(|touch| touch.multiplicity).sum();
            assert_eq!(count, 1, "{found:?}");
            let [fx, fy, fz] = force(&floor, [x, y, height], sides);
            let expected = hertz(50e-6).copysign(height);
            assert!((fz - expected).abs() < 1e-12 * hertz(50e-6), "{fz} {expected}");
            assert!(fx.abs() + fy.abs() < 1e-12 * hertz(50e-6));
        }
    }
}

#[test]
fn a_ridge_pushes_from_its_edge_once() {
    let ridge = bend(std::f64::consts::FRAC_PI_4, 3);
    let [x, y, z] = force(&ridge, [0.8e-3, 1e-3, 4.8e-3], Sides::Both);
    assert!(
        (x - 0.065_895_666_602_5).abs() < 1e-12 && y.abs() < 1e-15 && (z - 0.395_373_999_615).abs() < 1e-12,
        "{x} {z}"
    );
}

#[test]
fn a_sphere_at_the_end_of_a_ridge_touches_its_vertex() {
    let ridge = bend(std::f64::consts::FRAC_PI_4, 3);
    let found = touches(&ridge, [0.0, 0.02 + 1e-3, 4.8e-3], Sides::Both);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(matches!(found[0].feature, Feature::Vertex(_)) && found[0].multiplicity == 1);
    assert!((found[0].distance - (1e-6_f64 + 4.8e-3 * 4.8e-3).sqrt()).abs() < 1e-17);
}

#[test]
fn shallow_concave_bends_have_the_closed_form() {
    for (bend_angle, expected) in
        [(1.0, 0.092_085_453_653_6), (2.0, 0.093_610_861_398_6), (5.0, 0.104_045_787_795), (10.0, 0.137_548_599_194)]
    {
        let half = 0.5_f64 * f64::to_radians(bend_angle);
        let dish = bend(-half, 4);
        let height = (RADIUS - 50e-6) / libm::cos(half);
        for y in [0.3e-3, 0.0] {
            let [x, _, z] = force(&dish, [0.0, y, height], Sides::Both);
            assert!((z - expected).abs() < 1e-12 && x.abs() < 1e-15, "{bend_angle}: {z}, not {expected}");
        }
    }
}

#[test]
fn the_force_is_continuous_across_a_concave_bend() {
    let dish = bend(-0.5_f64 * f64::to_radians(2.0), 4);
    let mut before: Option<[f64; 3]> = None;
    for step in -2000..=2000 {
        let now = force(&dish, [1e-6 * f64::from(step), 0.1e-3, 4.9e-3], Sides::Both);
        if let Some(before) = before {
            let jump = (0..3).map(|axis| (now[axis] - before[axis]).abs()).fold(0.0, f64::max);
            assert!(jump < 2e-3 * hertz(100e-6), "{jump} at {step}");
        }
        before = Some(now);
    }
}

#[test]
fn a_corner_of_a_box_is_three_planes_and_its_outside_a_vertex() {
    let vertices = (0..8).map(|k| [0.1 * f64::from(k & 1), 0.1 * f64::from(k >> 1 & 1), 0.1 * f64::from(k >> 2)]);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let cube = mesh(vertices.collect(), triangles);
    assert!((cube.volume().unwrap() - 1e-3).abs() < 1e-18);
    let [x, y, z] = force(&cube, [4.95e-3, 4.9e-3, 4.95e-3], Sides::Both);
    assert!((x - hertz(50e-6)).abs() < 1e-14 && (y - hertz(100e-6)).abs() < 1e-14 && (z - hertz(50e-6)).abs() < 1e-14);
    let outside = touches(&cube, [-2e-3, -2e-3, -2e-3], Sides::Front);
    assert_eq!(outside.len(), 1, "{outside:?}");
    assert!(matches!(outside[0].feature, Feature::Vertex(0)) && outside[0].multiplicity == 1);
    assert!(touches(&cube, [2e-3, 2e-3, 2e-3], Sides::Front).is_empty());
}

#[test]
fn weights_of_a_closed_surface_are_one_less_one_and_one() {
    let floor = floor();
    let flat: Vec<i32> = floor.vertex_weights();
    let inner = |vertex: &[f64; 3]| vertex[0].abs() < 0.012 && vertex[1].abs() < 0.012;
    assert!(floor.vertices.iter().zip(&flat).all(|(vertex, weight)| !inner(vertex) || *weight == 1));
    for (edge, it) in floor.edges.iter().enumerate() {
        assert_eq!(floor.edge_weight(edge as u32), 1 - it.triangles as i32);
    }
    // The Euler characteristic of a disc.
    let sum: i32 = flat.iter().sum::<i32>()
        + (0..floor.edges.len() as u32).map(|edge| floor.edge_weight(edge)).sum::<i32>()
        + floor.triangles.len() as i32;
    assert_eq!(sum, 1);
}
