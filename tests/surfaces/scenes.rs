//! Spheres before surfaces, and the forces on them.

use crate::support::{Triangle, scene_with};
use cograin::scene::{Scene, SceneDraft};
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Radius \[m\].
pub(super) const RADIUS: f64 = 5e-3;

/// Hertz's force of an overlap \[N\].
pub(super) fn hertz(overlap: f64) -> f64 {
    let modulus = 5.0e6 / (1.0 - 0.3 * 0.3) / 2.0;
    4.0 / 3.0 * modulus * (RADIUS * overlap.powi(3)).sqrt()
}

/// Triangles as an STL file.
pub(super) fn stl(triangles: &[Triangle]) -> Vec<u8> {
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
pub(super) fn scene(places: &[[f64; 3]], law: &str, boundaries: &str, files: &[(&str, Vec<Triangle>)]) -> Arc<Scene> {
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
pub(super) const ROUGH: &str = "[contact.touch]\nbetween = [\"sphere\", \"wall\"]\n[contact.touch.normal.hertz]\n\
                     [contact.touch.tangential.history]\n[contact.touch.rolling.cdt]\n\
                     [contact.others]\nbetween = [\"sphere\", \"sphere\"]\n[contact.others.normal.hertz]\n";

/// No friction.
pub(super) const SMOOTH: &str = "[contact.touch]\nbetween = [\"sphere\", \"wall\"]\n[contact.touch.normal.hertz]\n\
                      [contact.others]\nbetween = [\"sphere\", \"sphere\"]\n[contact.others.normal.hertz]\n";

/// Force on each sphere at the start \[N\].
pub(super) fn forces(scene: &Arc<Scene>) -> Vec<[f64; 3]> {
    let simulation = Simulation::new(Arc::clone(scene)).unwrap_or_else(|error| panic!("{error}"));
    let particles = &simulation.state().particles;
    let force = |slot: &u32| [0, 1, 2].map(|axis| particles.force[*slot as usize][axis]);
    particles.slot.iter().map(force).collect()
}

/// The force on one sphere at a place \[N\], without friction.
pub(super) fn force_at(place: [f64; 3], boundaries: &str, files: &[(&str, Vec<Triangle>)]) -> [f64; 3] {
    forces(&scene(&[place], SMOOTH, boundaries, files))[0]
}

/// Fails unless two forces agree within a share of the second.
#[track_caller]
pub(super) fn assert_same(found: [f64; 3], expected: [f64; 3], tolerance: f64) {
    let length = |v: [f64; 3]| v.iter().map(|part| part * part).sum::<f64>().sqrt();
    let apart = length([0, 1, 2].map(|axis| found[axis] - expected[axis]));
    assert!(apart <= tolerance * length(expected), "{found:?} found, {expected:?} expected, {apart:e} apart");
}

/// A number from 0 to 1.
pub(super) fn random(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / f64::from(u32::MAX)
}

/// A surface over a square of 60 mm that bends at x = 0 by an angle \[°\], upwards where it is above 0.
pub(super) fn bend(degrees: f64) -> Vec<Triangle> {
    let (sine, cosine) = (0.5 * degrees.to_radians()).sin_cos();
    let at = |x: f64, y: f64| [0.03 * x * cosine, 0.03 * y, 0.03 * x.abs() * sine];
    let side = |x: f64| {
        let (a, b, c, d) = (at(0.0, -1.0), at(x, -1.0), at(x, 1.0), at(0.0, 1.0));
        [[a, b, c], [a, c, d]]
    };
    [side(-1.0), side(1.0)].concat()
}

/// A square of 60 mm in the plane z = 0, cut into triangles at random.
pub(super) fn sheet(rng: &mut ChaCha8Rng, height: f64) -> Vec<Triangle> {
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
pub(super) const MESH: &str = "[boundary.wall]\nmaterial = \"wall\"\nmesh = { file = \"wall.stl\", sides = 2 }\n";

/// The inside of a cylinder of radius 50 mm along y as this many facets, of which in- and circumscribed radius have it as
/// their mean.
pub(super) fn drum(count: u32, length: f64) -> Vec<Triangle> {
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

/// A box of six walls full of spheres, turned as a whole: its walls as planes, as meshes of two triangles, and the triangles.
pub(super) struct FullBox {
    pub(super) planes: String,
    pub(super) meshes: String,
    pub(super) files: Vec<(String, Vec<Triangle>)>,
    pub(super) places: Vec<[f64; 3]>,
    pub(super) gravity: [f64; 3],
}

impl FullBox {
    /// Spheres begin beside a lattice, where the seed says; gravity points into a corner of the box.
    pub(super) fn turned(seed: u64, turn: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
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
    pub(super) fn start(&self, meshes: bool) -> Simulation {
        let files: Vec<(&str, Vec<Triangle>)> =
            self.files.iter().map(|(name, list)| (name.as_str(), list.clone())).collect();
        let (boundaries, files) = if meshes { (&self.meshes, files) } else { (&self.planes, Vec::new()) };
        let mut scene = SceneDraft::clone(&scene(&self.places, ROUGH, boundaries, &files));
        scene.gravity = self.gravity;
        scene.run.step = cograin::scene::Step::Given(2e-5);
        Simulation::new(Arc::new(scene.build().unwrap())).unwrap_or_else(|error| panic!("{error}"))
    }

    /// After so many time steps between planes or meshes: contacts and, of each sphere, position, velocity, angular velocity.
    pub(super) fn run(&self, meshes: bool, steps: u32) -> (usize, Vec<[[f64; 4]; 3]>) {
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

/// A point or direction turned about two axes: no face of a box stays across an axis.
pub(super) fn askew([x, y, z]: [f64; 3]) -> [f64; 3] {
    let ((sine, cosine), (high, flat)) = (0.4_f64.sin_cos(), 0.7_f64.sin_cos());
    let (x, y) = (cosine * x - sine * y, sine * x + cosine * y);
    [flat * x + high * z, y, flat * z - high * x]
}
