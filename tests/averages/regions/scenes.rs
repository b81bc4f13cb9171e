//! Beds between walls, and what touches in them.

use crate::support::{start, start_with};
use cograin::averages::Tensor;
use cograin::simulation::Simulation;
use std::collections::BTreeMap;

/// A vector.
pub(crate) type Vector = [f64; 3];

/// a × b.
pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a − b.
pub(super) fn less(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The axial vector of what is not symmetric in Σ a ⊗ b: Σ a × b.
pub(super) fn axial(t: &Tensor) -> Vector {
    [t[1][2] - t[2][1], t[2][0] - t[0][2], t[0][1] - t[1][0]]
}

/// A sum of products a ⊗ b, and of their magnitudes.
#[derive(Default)]
pub(super) struct Sum {
    /// Σ a ⊗ b.
    pub(super) tensor: Tensor,
    /// Σ |a| |b|.
    pub(super) turnover: f64,
}

impl Sum {
    /// Adds a ⊗ b.
    pub(super) fn add(&mut self, a: Vector, b: Vector) {
        for (row, a) in self.tensor.iter_mut().zip(a) {
            for (entry, b) in row.iter_mut().zip(b) {
                *entry += a * b;
            }
        }
        let length = |v: Vector| v.iter().map(|part| part * part).sum::<f64>().sqrt();
        self.turnover += length(a) * length(b);
    }
}

/// A contact at a wall.
pub(super) struct Touch {
    /// The boundary.
    pub(super) boundary: usize,
    /// Where \[m\].
    pub(super) point: Vector,
    /// Force on the particle \[N\].
    pub(super) force: Vector,
}

/// Contacts at walls.
pub(super) fn touches(simulation: &Simulation) -> Vec<Touch> {
    let at_walls = simulation.contacts().into_iter().filter_map(|contact| {
        let force = |axis: usize| contact.normal_force * contact.normal[axis] + contact.tangential_force[axis];
        Some(Touch { boundary: contact.boundary? as usize, point: contact.point, force: [0, 1, 2].map(force) })
    });
    at_walls.collect()
}

/// Σ_walls c ⊗ f + Σ m x ⊗ (g − a), with places as `seen` sees them.
pub(super) fn walls_and_inertia(simulation: &Simulation, seen: impl Fn(Vector) -> Vector) -> Sum {
    let mut sum = Sum::default();
    for touch in touches(simulation) {
        sum.add(seen(touch.point), touch.force);
    }
    let particles = &simulation.state().particles;
    for (slot, [x, y, z, _]) in particles.position.iter().copied().enumerate() {
        let (mass, force, gravity) = (particles.velocity[slot][3], particles.force[slot], simulation.scene().gravity);
        sum.add(seen([x, y, z]), [0, 1, 2].map(|axis| mass * gravity[axis] - force[axis]));
    }
    sum
}

/// Largest difference of two tensors, over a turnover.
pub(crate) fn apart(a: &Tensor, b: &Tensor, turnover: f64) -> f64 {
    let differences = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / turnover
}

/// The walls of a box of 40 mm: planes, of which the lid comes down, or one mesh.
pub(crate) const PLANES: &str = r#"
[boundary]
left = { plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }, material = "glass" }
right = { plane = { point = [0.04, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }, material = "glass" }
front = { plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }, material = "glass" }
back = { plane = { point = [0.0, 0.04, 0.0], normal = [0.0, -1.0, 0.0] }, material = "glass" }
bottom = { plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }, material = "glass" }
lid = { plane = { point = [0.0, 0.0, 0.04], normal = [0.0, 0.0, -1.0] }, material = "glass", motion = { prescribed = { z = -0.3, x = 0.2 } } }
"#;

/// The same box as a mesh that shakes.
pub(super) const MESH: &str = r#"
[boundary.box]
mesh = { file = "box.obj", sides = 2 }
material = "glass"
motion = { prescribed = { x = { sine = { amplitude = 1.0e-4, frequency = 200.0 } }, z = 0.1 } }
"#;

/// The box of the mesh.
pub(crate) fn box_file() -> BTreeMap<String, Vec<u8>> {
    let mut text = String::new();
    for corner in 0..8 {
        let at = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { "0" } else { "0.04" });
        text += &format!("v {} {} {}\n", at[0], at[1], at[2]);
    }
    for [a, b, c, d] in [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]] {
        text += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
    }
    BTreeMap::from([("box.obj".to_owned(), text.into_bytes())])
}

/// Grains of many sizes that fly about in a box, with friction, rolling resistance and dashpots; more tables.
pub(crate) fn bed(walls: &str, more: &str) -> Simulation {
    bed_with(1, "[0.0015, 0.0035]", walls, more)
}

/// The same with so many threads and these radii.
pub(crate) fn bed_with(threads: usize, radii: &str, walls: &str, more: &str) -> Simulation {
    start_with(&bed_text(threads, radii, walls, more), box_file())
}

/// Its scene.
pub(super) fn bed_text(threads: usize, radii: &str, walls: &str, more: &str) -> String {
    format!(
        r#"
gravity = [1.0, -2.0, -9.81]
[run]
step = 2.0e-6
threads = {threads}
[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.6
friction = 0.4
rolling_friction = 0.05
[contact.grains.normal.hertz]
[contact.grains.tangential.history]
[contact.grains.rolling.cdt]
[particles.grains]
material = "glass"
packing = {{ box = [[0.0, 0.0, 0.0], [0.04, 0.04, 0.04]], solid_fraction = 0.5, radius = {radii} }}
velocity = [0.2, -0.3, -0.5]
{walls}
{more}
"#
    )
}

/// A region that holds everything.
pub(super) const ALL: &str = "[region.all]\nbox = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]\n";

/// Spheres that do not feel each other, with velocities, and regions.
pub(super) fn spheres(list: &[(Vector, f64, Vector)], regions: &str) -> Simulation {
    let entry = |(position, radius, velocity): &(Vector, f64, Vector)| {
        format!("{{ position = {position:?}, radius = {radius:?}, velocity = {velocity:?} }}")
    };
    let list: Vec<String> = list.iter().map(entry).collect();
    start(&format!(
        "[run]\nstep = 1e-4\nthreads = 1\n[material.a]\ndensity = 1000.0\n[particles.all]\nmaterial = \"a\"\nlist = [{}]\n{regions}",
        list.join(", ")
    ))
}

/// A sphere between a floor and a lid that presses it, both 0.01 mm deep.
pub(crate) const PRESSED: &str = r#"
[run]
step = 1.0e-6
threads = 1
[material.a]
density = 1000.0
youngs_modulus = 1.0e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 1.0
[contact.c.normal.hertz]
[particles.all]
material = "a"
list = [{ position = [0.0, 0.0, 0.00999], radius = 0.01 }]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[boundary.lid]
plane = { point = [0.0, 0.0, 0.01998], normal = [0.0, 0.0, -1.0] }
material = "a"
motion = { driven = ["x"] }
"#;
