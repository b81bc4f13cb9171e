//! Spheres over sheets whose nodes the outside moves.

use crate::support::{Triangle, obj, scene_with};
use cograin::quantity::BoundaryIndex;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::Nodes;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Radius \[m\].
pub(super) const RADIUS: f64 = 5e-3;

/// Overlap at the start \[m\].
pub(super) const OVERLAP: f64 = 5e-5;

/// The sheet.
pub(super) const SHEET: BoundaryIndex = BoundaryIndex(0);

/// Three numbers.
pub(super) type Three = [f64; 3];

/// Nodes that the outside moves.
pub(super) const DRIVEN: &str = "nodes = \"driven\"";

/// What a scene is made of.
pub(super) struct Stage<'a> {
    /// Place, velocity and angular velocity of each sphere.
    pub(super) spheres: Vec<[Three; 3]>,
    /// The sheet.
    pub(super) mesh: Vec<Triangle>,
    /// How it moves.
    pub(super) motion: &'a str,
    /// Restitution, friction and rolling friction.
    pub(super) properties: Three,
    /// Sub-models beside Hertz's.
    pub(super) law: &'a str,
    /// `[run]`.
    pub(super) run: &'a str,
    /// Gravity \[m/s²\].
    pub(super) gravity: Three,
}

impl Stage<'_> {
    /// The scene.
    pub(super) fn scene(&self) -> Arc<Scene> {
        let each = |[at, velocity, spin]: &[Three; 3]| {
            format!(
                "{{ position = {at:?}, velocity = {velocity:?}, angular_velocity = {spin:?}, radius = {RADIUS:?} }}"
            )
        };
        let list: Vec<String> = self.spheres.iter().map(each).collect();
        let [restitution, friction, rolling] = self.properties;
        let text = format!(
            r#"
gravity = {gravity:?}
[run]
max_overlap = 0.5
{run}
[material.stone]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[pair.stone.stone]
restitution = {restitution:?}
friction = {friction:?}
rolling_friction = {rolling:?}
[contact.touch.normal.hertz]
{law}
[particles.all]
material = "stone"
list = [{list}]
[boundary.sheet]
material = "stone"
mesh = {{ file = "sheet.obj", sides = 2 }}
{motion}
"#,
            gravity = self.gravity,
            run = self.run,
            law = self.law,
            list = list.join(", "),
            motion = self.motion,
        );
        let files = BTreeMap::from([("sheet.obj".to_owned(), obj(&self.mesh))]);
        scene_with(&text, files)
    }

    /// The scene at time 0.
    pub(super) fn start(&self) -> Simulation {
        Simulation::new(self.scene()).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Friction and rolling resistance.
pub(super) const ROUGH: &str = "[contact.touch.tangential.history]\n[contact.touch.rolling.cdt]\n";

impl Default for Stage<'_> {
    fn default() -> Self {
        Self {
            spheres: Vec::new(),
            mesh: Vec::new(),
            motion: DRIVEN,
            properties: [0.5, 0.4, 0.1],
            law: ROUGH,
            run: "step = 1e-6\nthreads = 1",
            gravity: [0.0; 3],
        }
    }
}

/// The nodes of the sheet.
pub(super) fn nodes(simulation: &Simulation) -> &Nodes {
    &simulation.state().nodes[0]
}

/// Where its nodes stood at time 0 \[m\].
pub(super) fn places(simulation: &Simulation) -> Vec<Three> {
    simulation.scene().boundaries[0].shape.vertices().iter().map(|place| place.to_array()).collect()
}

/// Moves every node to its place at time 0 plus this function of it.
pub(super) fn drive(simulation: &mut Simulation, way: impl Fn(Three) -> Three) {
    for (node, place) in places(simulation).into_iter().enumerate() {
        for (axis, value) in way(place).into_iter().enumerate() {
            simulation.set_node(SHEET, (node, axis), value);
        }
    }
}

/// Advances, or fails with the message.
#[track_caller]
pub(super) fn advance(simulation: &mut Simulation, interval: f64) {
    simulation.advance(interval).unwrap_or_else(|error| panic!("{error}"));
}

/// Sum of two vectors, the second this often.
pub(super) fn sum(a: Three, b: Three, times: f64) -> Three {
    [0, 1, 2].map(|axis| a[axis] + times * b[axis])
}

/// A vector by a number.
pub(super) fn by(a: Three, times: f64) -> Three {
    a.map(|part| part * times)
}

/// Vector product.
pub(super) fn cross([a, b, c]: Three, [x, y, z]: Three) -> Three {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Scalar product.
pub(super) fn dot(a: Three, b: Three) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

/// Length.
pub(super) fn length(a: Three) -> f64 {
    dot(a, a).sqrt()
}

/// First three numbers of a row.
pub(super) fn three(row: [f64; 4]) -> Three {
    [row[0], row[1], row[2]]
}

/// A number from −1 to 1.
pub(super) fn random(rng: &mut ChaCha8Rng) -> f64 {
    2.0 * f64::from(rng.next_u32()) / f64::from(u32::MAX) - 1.0
}

/// A square about the origin of so many cells a side, heights at random up to this; corners inside shifted at random.
pub(super) fn sheet(cells: usize, half: f64, height: f64, rng: &mut ChaCha8Rng) -> Vec<Triangle> {
    let cell = 2.0 * half / cells as f64;
    let mut points = Vec::new();
    for i in 0..=cells {
        for j in 0..=cells {
            let mut inside = |k: usize| {
                let shift = if k == 0 || k == cells { 0.0 } else { 0.2 * random(rng) };
                cell * (k as f64 + shift) - half
            };
            points.push([inside(i), inside(j), height * random(rng)]);
        }
    }
    let at = |i: usize, j: usize| points[i * (cells + 1) + j];
    let cut = |number: usize| {
        let (i, j) = (number / cells, number % cells);
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    (0..cells * cells).flat_map(cut).collect()
}

/// Spheres that slide and roll over a sheet with friction, at random places a little above its highest point.
pub(super) fn over(count: usize, half: f64, height: f64, rng: &mut ChaCha8Rng) -> Vec<[Three; 3]> {
    let side = (count as f64).sqrt().ceil() as usize;
    let pitch = 2.0 * half / side as f64;
    let place = |k: usize| pitch * (k as f64 + 0.5) - half;
    (0..count)
        .map(|number| {
            let at = [place(number / side), place(number % side), RADIUS + height * random(rng)];
            let three = |scale: f64, rng: &mut ChaCha8Rng| [0, 1, 2].map(|_| scale * random(rng));
            [at, three(0.5, rng), three(60.0, rng)]
        })
        .collect()
}

/// Forces of the nodes at the start of one sphere that slides at (0.3, 0.2, 0) m/s over a mesh, its foot at this place, and the
/// force on it.
#[track_caller]
pub(super) fn pressed(mesh: &[Triangle], foot: Three) -> (Vec<Three>, Three) {
    let at = sum(foot, [0.0, 0.0, RADIUS - OVERLAP], 1.0);
    let spheres = vec![[at, [0.3, 0.2, 0.0], [0.0; 3]]];
    let simulation =
        Stage { spheres, mesh: mesh.to_vec(), law: "[contact.touch.tangential.history]", ..Stage::default() }.start();
    let force = three(simulation.state().particles.force[0]);
    assert!(force[0] < 0.0 && force[1] < 0.0 && force[2] > 0.0, "{force:?}");
    (nodes(&simulation).force.iter().map(|row| three(*row)).collect(), force)
}

/// A sheet and spheres at random.
pub(super) fn rough_stage(seed: u64) -> Stage<'static> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mesh = sheet(8, 0.03, 6e-4, &mut rng);
    let mut spheres = over(16, 0.024, 1e-4, &mut rng);
    spheres.iter_mut().for_each(|[at, ..]| at[2] += 5e-4);
    Stage { spheres, mesh, gravity: [0.0, 0.0, -100.0], ..Stage::default() }
}

/// New targets of all nodes, up to this far from where they stood at time 0 \[m\].
pub(super) fn shake(simulation: &mut Simulation, way: f64, rng: &mut ChaCha8Rng) {
    for node in 0..nodes(simulation).target.len() {
        for axis in 0..3 {
            simulation.set_node(SHEET, (node, axis), way * random(rng));
        }
    }
}
