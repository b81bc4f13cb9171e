//! Surfaces of features: the force is that of theory on faces, edges, vertices, bends and in corners, does not feel the
//! triangulation, and what crosses the surface balances.
//!
//! Unless something else is said: radius 5 mm, E = 5 MPa and ν = 0.3 of both, hence E* = 2.7473 MPa; F(δ) = 4/3 E* √(R δ³).

mod courses;
pub(crate) mod every_surface;
mod on_axis;
mod through;

use crate::support::{scene_with, start_with};
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, SceneDraft};
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Radius \[m\].
const RADIUS: f64 = 5e-3;

/// A triangle, or a point.
type Triangle = [[f64; 3]; 3];

/// Hertz's force of an overlap \[N\].
fn hertz(overlap: f64) -> f64 {
    let modulus = 5.0e6 / (1.0 - 0.3 * 0.3) / 2.0;
    4.0 / 3.0 * modulus * (RADIUS * overlap.powi(3)).sqrt()
}

/// Triangles as an STL file.
fn stl(triangles: &[Triangle]) -> Vec<u8> {
    let mut text = "solid surface\n".to_owned();
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in corners {
            text += &format!("vertex {x:.17e} {y:.17e} {z:.17e}\n");
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

/// A scene of spheres at these places, which do not feel each other, and boundaries.
fn scene(places: &[[f64; 3]], law: &str, boundaries: &str, files: &[(&str, Vec<Triangle>)]) -> Arc<Scene> {
    let spheres: Vec<String> =
        places.iter().map(|[x, y, z]| format!("{{ position = [{x:?}, {y:?}, {z:?}], radius = {RADIUS:?} }}")).collect();
    let text = format!(
        r#"
[run]
step = 1e-6
threads = 1
max_overlap = 0.5
[material.sphere]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[material.wall]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[pair.sphere.wall]
restitution = 0.5
friction = 0.4
rolling_friction = 0.1
[pair.sphere.sphere]
restitution = 0.5
friction = 0.4
rolling_friction = 0.1
[particles.all]
material = "sphere"
list = [{}]
{law}
{boundaries}
"#,
        spheres.join(", ")
    );
    let files: BTreeMap<String, Vec<u8>> = files.iter().map(|(name, list)| ((*name).to_owned(), stl(list))).collect();
    scene_with(&text, files)
}

/// Friction and rolling resistance.
const ROUGH: &str = "[contact.touch]\nbetween = [\"sphere\", \"wall\"]\n[contact.touch.normal.hertz]\n\
                     [contact.touch.tangential.history]\n[contact.touch.rolling.cdt]\n\
                     [contact.others]\nbetween = [\"sphere\", \"sphere\"]\n[contact.others.normal.hertz]\n";

/// No friction.
const SMOOTH: &str = "[contact.touch]\nbetween = [\"sphere\", \"wall\"]\n[contact.touch.normal.hertz]\n\
                      [contact.others]\nbetween = [\"sphere\", \"sphere\"]\n[contact.others.normal.hertz]\n";

/// Force on each sphere at the start \[N\].
fn forces(scene: &Arc<Scene>) -> Vec<[f64; 3]> {
    let simulation = Simulation::new(Arc::clone(scene)).unwrap_or_else(|error| panic!("{error}"));
    let particles = &simulation.state().particles;
    let force = |slot: &u32| [0, 1, 2].map(|axis| particles.force[*slot as usize][axis]);
    particles.slot.iter().map(force).collect()
}

/// The force on one sphere at a place \[N\], without friction.
fn force_at(place: [f64; 3], boundaries: &str, files: &[(&str, Vec<Triangle>)]) -> [f64; 3] {
    forces(&scene(&[place], SMOOTH, boundaries, files))[0]
}

/// Fails unless two forces agree within a share of the second.
#[track_caller]
fn assert_same(found: [f64; 3], expected: [f64; 3], tolerance: f64) {
    let length = |v: [f64; 3]| v.iter().map(|part| part * part).sum::<f64>().sqrt();
    let apart = length([0, 1, 2].map(|axis| found[axis] - expected[axis]));
    assert!(apart <= tolerance * length(expected), "{found:?} found, {expected:?} expected, {apart:e} apart");
}

/// A number from 0 to 1.
fn random(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / f64::from(u32::MAX)
}

/// A surface over a square of 60 mm that bends at x = 0 by an angle \[°\], upwards where it is above 0.
fn bend(degrees: f64) -> Vec<Triangle> {
    let (sine, cosine) = (0.5 * degrees.to_radians()).sin_cos();
    let at = |x: f64, y: f64| [0.03 * x * cosine, 0.03 * y, 0.03 * x.abs() * sine];
    let side = |x: f64| {
        let (a, b, c, d) = (at(0.0, -1.0), at(x, -1.0), at(x, 1.0), at(0.0, 1.0));
        [[a, b, c], [a, c, d]]
    };
    [side(-1.0), side(1.0)].concat()
}

/// A square of 60 mm in the plane z = 0, cut into triangles at random.
fn sheet(rng: &mut ChaCha8Rng, height: f64) -> Vec<Triangle> {
    const CELLS: usize = 12;
    let place = |part: f64| 0.06 * (part / CELLS as f64 - 0.5);
    let mut points = Vec::new();
    for i in 0..=CELLS {
        for j in 0..=CELLS {
            // Less than a quarter of a cell: no triangle folds over its neighbour.
            let mut shift = || 0.4 * (random(rng) - 0.5);
            let inside = |k: usize, by: f64| if k == 0 || k == CELLS { k as f64 } else { k as f64 + by };
            points.push([place(inside(i, shift())), place(inside(j, shift())), height * (2.0 * shift() + 0.4)]);
        }
    }
    let at = |i: usize, j: usize| points[i * (CELLS + 1) + j];
    let mut triangles = Vec::new();
    for i in 0..CELLS {
        for j in 0..CELLS {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            triangles.extend(if rng.next_u32().is_multiple_of(2) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            });
        }
    }
    triangles
}

/// A boundary of a mesh.
const MESH: &str = "[boundary.wall]\nmaterial = \"wall\"\nmesh = { file = \"wall.stl\", sides = 2 }\n";

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

/// The inside of a cylinder of radius 50 mm along y as this many facets, of which in- and circumscribed radius have it as
/// their mean.
fn drum(count: u32, length: f64) -> Vec<Triangle> {
    let angle = std::f64::consts::TAU / f64::from(count);
    let radius = 0.05 * 2.0 / (1.0 + (0.5 * angle).cos());
    let at = |number: u32, y: f64| {
        let (sine, cosine) = (angle * f64::from(number)).sin_cos();
        [radius * sine, y, -radius * cosine]
    };
    let facet = |number: u32| {
        let (a, b) = (at(number, -length), at(number + 1, -length));
        let (c, d) = (at(number + 1, length), at(number, length));
        [[a, b, c], [a, c, d]]
    };
    (0..count).flat_map(facet).collect()
}

#[test]
fn a_drum_of_facets_becomes_the_cylinder_with_the_square_of_their_number() {
    let expected = hertz(5e-5);
    let error = |count: u32| {
        let triangles = drum(count, 0.02);
        let angle = std::f64::consts::TAU / f64::from(count);
        // Over one facet at the bottom.
        let places: Vec<[f64; 3]> = (0..41)
            .map(|number| {
                let (sine, cosine) = (angle * f64::from(number) / 40.0).sin_cos();
                [(0.05 - RADIUS + 5e-5) * sine, 0.0, -(0.05 - RADIUS + 5e-5) * cosine]
            })
            .collect();
        let worst = |place: &[f64; 3]| {
            let found = force_at(*place, MESH, &[("wall.stl", triangles.clone())]);
            let towards = place.map(|part| -part / (0.05 - RADIUS + 5e-5) * expected);
            (0..3).map(|axis| (found[axis] - towards[axis]).powi(2)).sum::<f64>().sqrt() / expected
        };
        places.iter().map(worst).fold(0.0, f64::max)
    };
    let errors = [256, 512, 1024].map(error);
    assert!((errors[0] - 0.0570).abs() < 0.002, "{errors:?}");
    for two in errors.windows(2) {
        let order = (two[0] / two[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order} of {errors:?}");
    }
}

/// A box of six walls full of spheres, turned as a whole: its walls as planes, as meshes of two triangles, and the triangles.
struct FullBox {
    planes: String,
    meshes: String,
    files: Vec<(String, Vec<Triangle>)>,
    places: Vec<[f64; 3]>,
    gravity: [f64; 3],
}

impl FullBox {
    /// Spheres begin beside a lattice, where the seed says; gravity points into a corner of the box.
    fn turned(seed: u64, turn: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let (low, high) = (-0.036, 0.036);
        let corner = |bits: usize| turn([0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { high } else { low }));
        let (mut planes, mut meshes, mut files) = (String::new(), String::new(), Vec::new());
        for side in 0..6 {
            let (axis, upper) = (side / 2, side % 2);
            let [first, second] = [(axis + 1) % 3, (axis + 2) % 3];
            let at = |one: usize, other: usize| corner(upper << axis | one << first | other << second);
            let normal = turn([0, 1, 2].map(|along| if along == axis { 1.0 - 2.0 * upper as f64 } else { 0.0 }));
            let point = at(0, 0);
            planes += &format!(
                "[boundary.side{side}]\nmaterial = \"wall\"\nplane = {{ point = {point:?}, normal = {normal:?} }}\n"
            );
            meshes += &format!("[boundary.side{side}]\nmaterial = \"wall\"\nmesh = {{ file = \"side{side}.stl\" }}\n");
            files.push((
                format!("side{side}.stl"),
                vec![[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]],
            ));
        }
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let places = (0..216)
            .map(|number| [number % 6, number / 6 % 6, number / 36].map(|k| 0.0112 * (k as f64 - 2.5)))
            .map(|place| turn(place.map(|part| part + 4e-4 * (random(&mut rng) - 0.5))))
            .collect();
        Self { planes, meshes, files, places, gravity: turn([30.0, 20.0, -98.1]) }
    }

    /// Between planes or meshes, at time 0.
    fn start(&self, meshes: bool) -> Simulation {
        let files: Vec<(&str, Vec<Triangle>)> =
            self.files.iter().map(|(name, list)| (name.as_str(), list.clone())).collect();
        let (boundaries, files) = if meshes { (&self.meshes, files) } else { (&self.planes, Vec::new()) };
        let mut scene = SceneDraft::clone(&scene(&self.places, ROUGH, boundaries, &files));
        scene.gravity = self.gravity;
        scene.run.step = cograin::scene::Step::Given(2e-5);
        Simulation::new(Arc::new(scene.build().unwrap())).unwrap_or_else(|error| panic!("{error}"))
    }

    /// After so many time steps between planes or meshes: contacts and, of each sphere, position, velocity, angular velocity.
    fn run(&self, meshes: bool, steps: u32) -> (usize, Vec<[[f64; 4]; 3]>) {
        let mut simulation = self.start(meshes);
        simulation.advance(f64::from(steps) * 2e-5).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        let row = |slot: &u32| {
            let slot = *slot as usize;
            [particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot]]
        };
        (simulation.contact_count(), particles.slot.iter().map(row).collect())
    }
}

#[test]
fn a_box_of_meshes_gives_the_bits_of_six_planes() {
    let full = FullBox::turned(5, |place| place);
    let expected = full.run(false, 1000);
    assert!(expected.0 > 20, "{} contacts", expected.0);
    assert_eq!(full.run(true, 1000), expected);
}

/// A point or direction turned about two axes: no face of a box stays across an axis.
fn askew([x, y, z]: [f64; 3]) -> [f64; 3] {
    let ((sine, cosine), (high, flat)) = (0.4_f64.sin_cos(), 0.7_f64.sin_cos());
    let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
    [flat * x + high * z, y, flat * z - high * x]
}

/// Until spheres have had two impacts; every further one makes what rounding has changed larger.
#[test]
fn a_turned_box_of_meshes_goes_the_way_of_six_planes() {
    let upright = FullBox::turned(5, |place| place).run(false, 400);
    let (contacts, turned) = FullBox::turned(5, askew).run(true, 400);
    assert!(contacts > 20 && contacts == upright.0, "{contacts} and {} contacts", upright.0);
    for (found, before) in turned.iter().zip(&upright.1) {
        for (part, scale) in [(0, RADIUS), (1, 0.3), (2, 0.3 / RADIUS)] {
            let [x, y, z, _] = before[part];
            let expected = askew([x, y, z]);
            let apart = (0..3).map(|axis| (found[part][axis] - expected[axis]).abs()).fold(0.0, f64::max);
            assert!(apart <= 1e-10 * scale, "{:?} found, {expected:?} expected", found[part]);
        }
    }
}

/// What has settled: the force on the floor as a share of the weight, the mean height of the centres above it \[m\], and the force on all six walls
/// less the weight, as a share of that.
fn settled(full: &FullBox, meshes: bool) -> [f64; 3] {
    let mut simulation = full.start(meshes);
    simulation.advance(0.3).and_then(|()| simulation.advance(0.02)).unwrap_or_else(|error| panic!("{error}"));
    let strength = full.gravity.map(|part| part * part).iter().sum::<f64>().sqrt();
    let down = full.gravity.map(|part| part / strength);
    let along = |v: [f64; 3]| (0..3).map(|axis| v[axis] * down[axis]).sum::<f64>();
    let state = simulation.state();
    let weight: f64 = state.particles.velocity.iter().map(|row| row[3]).sum::<f64>() * strength;
    let forces: Vec<f64> = state.boundaries.iter().map(|moved| along(moved.mean_force)).collect();
    let depth = state.particles.position.iter().map(|[x, y, z, _]| along([*x, *y, *z])).sum::<f64>() / 216.0;
    [forces[4] / weight, 0.036 - depth, forces.iter().sum::<f64>() / weight - 1.0]
}

#[test]
fn what_settles_in_a_turned_box_of_meshes_lies_as_in_six_planes() {
    let of = |turn: fn([f64; 3]) -> [f64; 3], meshes: bool| -> Vec<[f64; 3]> {
        let from = |seed: u64| {
            let mut full = FullBox::turned(seed, turn);
            full.gravity = turn([0.0, 0.0, -98.1]);
            settled(&full, meshes)
        };
        (1..=4).map(from).collect()
    };
    let (planes, turned) = (of(|place| place, false), of(askew, true));
    for [.., unborne] in planes.iter().chain(&turned) {
        assert!(unborne.abs() < 2e-3, "all walls bear the weight but for {unborne} of it");
    }
    for part in [0, 1] {
        let mean = |list: &[[f64; 3]]| list.iter().map(|seen| seen[part]).sum::<f64>() / 4.0;
        let (expected, found) = (mean(&planes), mean(&turned));
        let scatter = (planes.iter().map(|seen| (seen[part] - expected).powi(2)).sum::<f64>() / 3.0).sqrt();
        assert!((found - expected).abs() <= scatter, "{turned:?}, between planes {planes:?}");
    }
}

#[test]
fn a_plane_that_turns_carries_a_sphere_like_one_that_stood_there_before() {
    let turned = "[boundary.wall]\nmaterial = \"wall\"\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n\
                  motion = { driven = [\"rotation.y\"] }\n";
    let (sine, cosine) = 0.3_f64.sin_cos();
    let near = RADIUS - 5e-5;
    let mut simulation = Simulation::new(scene(&[[near * sine, 0.0, near * cosine]], SMOOTH, turned, &[])).unwrap();
    simulation.set_input(BoundaryIndex(0), 4, 0.3);
    simulation.place(None).unwrap();
    let [x, y, z, _] = simulation.state().particles.force[0];
    assert_same([x, y, z], [sine, 0.0, cosine].map(|part| part * hertz(5e-5)), 1e-11);
}

/// Spheres in a turning drum with a bumpy sheet on the way, rough.
fn tumbling() -> Arc<Scene> {
    let mut places = Vec::new();
    for i in 0..4 {
        for j in 0..3 {
            for k in 0..3 {
                places.push([
                    0.011 * f64::from(i) - 0.0165,
                    0.011 * f64::from(j) - 0.011,
                    0.0108 * f64::from(k) - 0.03,
                ]);
            }
        }
    }
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut bumps = sheet(&mut rng, 2e-3);
    bumps.iter_mut().flatten().for_each(|corner| corner[2] -= 0.041);
    let boundaries = "[boundary.wall]\nmaterial = \"wall\"\nmesh = { file = \"wall.stl\", sides = 2 }\n\
                      motion = { driven = [\"x\", \"z\", \"rotation.y\"] }\nreference = [0.0, 0.0, 0.01]\n\
                      [boundary.bumps]\nmaterial = \"wall\"\nmesh = { file = \"bumps.stl\" }\n\
                      motion = { driven = [\"z\"] }\n[output]\nenergy = true\n";
    let scene = scene(&places, ROUGH, boundaries, &[("wall.stl", drum(48, 0.03)), ("bumps.stl", bumps)]);
    let mut scene = SceneDraft::clone(&scene);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.run.step = cograin::scene::Step::Given(2e-5);
    Arc::new(scene.build().unwrap())
}

/// Moves the boundaries of [`tumbling`] through a communication step.
fn drive(simulation: &mut Simulation, step: u32) {
    let wave = 2e-4 * f64::from(step % 5) - 3e-4;
    simulation.set_input(BoundaryIndex(0), 0, wave);
    simulation.set_input(BoundaryIndex(0), 2, 0.5 * wave);
    simulation.set_input(BoundaryIndex(0), 4, 0.01 * f64::from(step));
    simulation.set_input(BoundaryIndex(1), 2, 1e-4 * f64::from(step % 3));
    simulation.advance(3.3e-4 + 1e-5 * f64::from(step % 3)).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn change_of_work_is_mean_force_times_displacement_and_mean_moment_times_turn() {
    let mut simulation = Simulation::new(tumbling()).unwrap();
    let mut turnover = 0.0_f64;
    for step in 1..150 {
        let before = simulation.state().boundaries.clone();
        drive(&mut simulation, step);
        for (before, after) in before.iter().zip(&simulation.state().boundaries) {
            let moved = |axis: usize| after.displacement[axis] - before.displacement[axis];
            let turned = |axis: usize| after.rotation[axis] - before.rotation[axis];
            let expected: f64 = -(0..3)
                .map(|axis| after.mean_force[axis] * moved(axis) + after.mean_moment[axis] * turned(axis))
                .sum::<f64>();
            let found = after.work - before.work;
            turnover += found.abs();
            assert!((found - expected).abs() <= 1e-11 * turnover.max(1e-9), "{found:e} J, not {expected:e} J");
        }
    }
    assert!(simulation.contact_count() > 5, "{} contacts", simulation.contact_count());
    assert!(turnover > 1e-4, "the boundaries worked: {turnover:e} J");
}

/// Force and moment on all particles and surfaces together, about the origin, but for gravity, and the forces on the particles added up as
/// numbers \[N, N m, N\].
fn unbalanced(simulation: &Simulation, gravity: [f64; 3]) -> ([f64; 3], [f64; 3], f64) {
    let state = simulation.state();
    let (mut force, mut moment, mut turnover) = ([0.0; 3], [0.0; 3], 0.0);
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    for slot in 0..state.particles.len() {
        let row = |row: [f64; 4]| [row[0], row[1], row[2]];
        let (load, mass) = (row(state.particles.force[slot]), state.particles.velocity[slot][3]);
        let load = [0, 1, 2].map(|axis| load[axis] - mass * gravity[axis]);
        let about = cross(row(state.particles.position[slot]), load);
        for axis in 0..3 {
            force[axis] += load[axis];
            moment[axis] += about[axis] + state.particles.torque[slot][axis];
            turnover += load[axis].abs();
        }
    }
    for boundary in &state.boundaries {
        let about = cross(boundary.pivot, boundary.force);
        for axis in 0..3 {
            force[axis] += boundary.force[axis];
            moment[axis] += about[axis] + boundary.moment[axis];
        }
    }
    (force, moment, turnover)
}

#[test]
fn what_the_particles_lose_the_surfaces_get() {
    let mut simulation = Simulation::new(tumbling()).unwrap();
    (1..100).for_each(|step| drive(&mut simulation, step));
    let (force, moment, turnover) = unbalanced(&simulation, [0.0, 0.0, -9.81]);
    assert!(turnover > 0.01, "{turnover} N");
    assert!(force.iter().all(|part| part.abs() < 1e-12 * turnover), "{force:?} N of {turnover} N");
    assert!(moment.iter().all(|part| part.abs() < 1e-12 * 0.05 * turnover), "{moment:?} N m");
}

/// A ball of 512 triangles about the origin with this radius \[m\], its corners counter-clockwise as seen from outside.
fn ball(radius: f64) -> Vec<Triangle> {
    let signs = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let eighth = |[x, y]: [f64; 2], z: f64| {
        let corners = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
        if x * y * z > 0.0 { corners } else { [corners[1], corners[0], corners[2]] }
    };
    let mut triangles: Vec<Triangle> =
        signs.into_iter().flat_map(|sign| [eighth(sign, 1.0), eighth(sign, -1.0)]).collect();
    let out = |point: [f64; 3]| {
        let length = point.map(|part| part * part).iter().sum::<f64>().sqrt();
        point.map(|part| part / length)
    };
    for _ in 0..3 {
        let middle = |a: [f64; 3], b: [f64; 3]| out([0, 1, 2].map(|axis| a[axis] + b[axis]));
        let four = |[a, b, c]: Triangle| {
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(four).collect();
    }
    triangles.into_iter().map(|corners| corners.map(|corner| corner.map(|part| radius * part))).collect()
}

#[test]
fn a_closed_body_in_a_bed_gets_what_the_particles_lose() {
    let full = FullBox::turned(2, |place| place);
    let far = |place: &&[f64; 3]| place.map(|part| part * part).iter().sum::<f64>().sqrt() > 0.0165;
    let places: Vec<[f64; 3]> = full.places.iter().filter(far).copied().collect();
    let boundaries = format!("{}[boundary.body]\nmaterial = \"wall\"\nmesh = {{ file = \"ball.stl\" }}\n", full.planes);
    let mut scene = SceneDraft::clone(&scene(&places, ROUGH, &boundaries, &[("ball.stl", ball(0.011))]));
    scene.gravity = [0.0, 0.0, -98.1];
    scene.run.step = cograin::scene::Step::Given(2e-5);
    let mut simulation = Simulation::new(Arc::new(scene.build().unwrap())).unwrap_or_else(|error| panic!("{error}"));
    simulation.advance(0.1).unwrap_or_else(|error| panic!("{error}"));
    let (force, moment, turnover) = unbalanced(&simulation, [0.0, 0.0, -98.1]);
    assert!(simulation.state().boundaries[6].force[2].abs() > 1e-3 * turnover, "the bed lies on the body");
    assert!(force.iter().all(|part| part.abs() < 1e-12 * turnover), "{force:?} N of {turnover} N");
    assert!(moment.iter().all(|part| part.abs() < 1e-12 * 0.05 * turnover), "{moment:?} N m");
}

#[test]
fn a_drum_that_has_turned_pushes_as_one_that_stood_there_before() {
    let (sine, cosine) = 3.5_f64.sin_cos();
    let turned: Vec<Triangle> = drum(48, 0.02)
        .iter()
        .map(|corners| corners.map(|[x, y, z]| [cosine * x + sine * z, y, cosine * z - sine * x]))
        .collect();
    let turning = format!("{MESH}reference = [0.0, 0.0, 0.0]\nmotion = {{ driven = [\"rotation.y\"] }}\n");
    for degrees in [0.0_f64, 3.0, 3.75, 50.0, 200.0] {
        let (x, z) = degrees.to_radians().sin_cos();
        let place = [x, 0.0, z].map(|part| (0.05 - RADIUS + 3e-5) * part);
        let mut simulation =
            Simulation::new(scene(&[place], SMOOTH, &turning, &[("wall.stl", drum(48, 0.02))])).unwrap();
        simulation.set_input(BoundaryIndex(0), 4, 3.5);
        simulation.place(None).unwrap();
        let [x, y, z, _] = simulation.state().particles.force[0];
        assert_same([x, y, z], force_at(place, MESH, &[("wall.stl", turned.clone())]), 1e-11);
    }
}

#[test]
fn a_saved_state_gives_the_same_bits() {
    let run = |simulation: &mut Simulation, steps: std::ops::Range<u32>| steps.for_each(|step| drive(simulation, step));
    let mut one = Simulation::new(tumbling()).unwrap();
    run(&mut one, 1..60);
    let middle = one.state().clone();
    run(&mut one, 60..100);
    assert!(one.state().clock.rebuilds > 2, "the lists were made anew");
    let mut again = Simulation::resume(tumbling(), middle).unwrap();
    run(&mut again, 60..100);
    assert_eq!(one.state().fingerprint(), again.state().fingerprint());
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

/// Heights over a wall at z = 0, which is this boundary, of a sticky sphere that flies off it across the middle, and the forces
/// along z: in each step \[m, N\].
fn pulled_off(boundary: &str) -> Vec<[f64; 2]> {
    let text = format!(
        r#"
[run]
step = 2e-7
threads = 1
[material.sphere]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[material.wall]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[pair.sphere.wall]
restitution = 0.5
friction = 0.4
surface_energy = 0.5
damping_coefficient = 0.1
tangential_damping_ratio = 0.5
[contact.touch]
between = ["sphere", "wall"]
[contact.touch.normal.jkr]
[contact.touch.tangential.history]
[particles.one]
material = "sphere"
list = [{{ position = [-2e-5, 1e-5, 4.98e-3], radius = {RADIUS:?}, velocity = [0.2, 0.0, 0.2] }}]
[boundary.wall]
material = "wall"
{boundary}
"#
    );
    let corners = [[-0.05, -0.05, 0.0], [0.05, -0.05, 0.0], [0.05, 0.05, 0.0], [-0.05, 0.05, 0.0]];
    let floor = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let files = BTreeMap::from([("floor.stl".to_owned(), stl(&floor))]);
    let mut simulation = start_with(&text, files);
    let step = |_| {
        simulation.advance(2e-7).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        [particles.position[0][2], particles.force[0][2]]
    };
    (0..2000).map(step).collect()
}

#[test]
fn a_law_that_pulls_beyond_touch_does_so_at_a_mesh_and_at_a_plane_that_turns() {
    let plane = "plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";
    let expected = pulled_off(plane);
    let beyond = expected.iter().filter(|[height, force]| *height > RADIUS && *force < 0.0).count();
    assert!(beyond > 10 && expected[1999][1] == 0.0, "{beyond} steps beyond touch, {:?} at the end", expected[1999]);
    let turning = format!("{plane}motion = {{ driven = [\"rotation.y\"] }}\n");
    for other in ["mesh = { file = \"floor.stl\" }\n", &turning] {
        for (found, expected) in pulled_off(other).iter().zip(&expected) {
            let apart = (found[0] - expected[0]).abs() / RADIUS;
            assert!(apart < 1e-12, "{found:?} found, {expected:?} expected, {other}");
            assert!(
                (found[1] - expected[1]).abs() < 1e-9 * expected[1].abs().max(1e-3),
                "{found:?}, {expected:?}, {other}"
            );
        }
    }
}
