//! Regions: their stress is that of the walls and of the inertia, whatever moves; their porosity is that of geometry; nothing
//! is paid for them before it is asked for.
//!
//! Balance of a bed. Each particle has m a = Σ f + m g, with forces f at its contacts. Times its place x and summed, with the way l
//! to its centre from the other one or, at a wall, from the point of contact c:
//!
//! ```text
//! −Σ l ⊗ f = Σ_walls c ⊗ f + Σ m x ⊗ (g − a)
//! ```
//!
//! The left side is what the contacts carry (times the volume, tension positive). Its part that is not symmetric is what makes the
//! particles turn faster, less the couples of the walls: −Σ l × f = Σ T − Σ_walls C.

use crate::support::{start, start_with};
use cograin::averages::{self, Tensor};
use cograin::interface::{Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A vector.
pub(crate) type Vector = [f64; 3];

/// The present value of an output.
#[track_caller]
pub(crate) fn value(simulation: &Simulation, name: &str) -> f64 {
    let interface = Interface::of(simulation.scene());
    let index = interface.find(name).unwrap_or_else(|| panic!("no output {name}"));
    interface.value(simulation, index).number()
}

/// a × b.
fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a − b.
fn less(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The axial vector of what is not symmetric in Σ a ⊗ b: Σ a × b.
fn axial(t: &Tensor) -> Vector {
    [t[1][2] - t[2][1], t[2][0] - t[0][2], t[0][1] - t[1][0]]
}

/// A sum of products a ⊗ b, and of their magnitudes.
#[derive(Default)]
struct Sum {
    /// Σ a ⊗ b.
    tensor: Tensor,
    /// Σ |a| |b|.
    turnover: f64,
}

impl Sum {
    /// Adds a ⊗ b.
    fn add(&mut self, a: Vector, b: Vector) {
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
struct Touch {
    /// The boundary.
    boundary: usize,
    /// Where \[m\].
    point: Vector,
    /// Force on the particle \[N\].
    force: Vector,
}

/// Contacts at walls.
fn touches(simulation: &Simulation) -> Vec<Touch> {
    let at_walls = simulation.contacts().into_iter().filter_map(|contact| {
        let force = |axis: usize| contact.normal_force * contact.normal[axis] + contact.tangential_force[axis];
        Some(Touch { boundary: contact.boundary? as usize, point: contact.point, force: [0, 1, 2].map(force) })
    });
    at_walls.collect()
}

/// Σ_walls c ⊗ f + Σ m x ⊗ (g − a), with places as `seen` sees them.
fn walls_and_inertia(simulation: &Simulation, seen: impl Fn(Vector) -> Vector) -> Sum {
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
const MESH: &str = r#"
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
fn bed_text(threads: usize, radii: &str, walls: &str, more: &str) -> String {
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
const ALL: &str = "[region.all]\nbox = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]\n";

/// Lets a bed move and checks the balance of the region that holds all of it.
fn balances(simulation: &mut Simulation, rounds: usize) {
    let mut slid = false;
    for round in 0..rounds {
        simulation.advance(1e-3).expect("it runs");
        slid |= simulation.contacts().iter().any(|contact| contact.sliding);
        let found = averages::carried(simulation)[0];
        let expected = walls_and_inertia(simulation, |place| place);
        let error = apart(&found, &expected.tensor, expected.turnover);
        assert!(error < 1e-12, "round {round}: {error:e}: {found:?}, {:?} expected", expected.tensor);
        let size = apart(&found, &Tensor::default(), expected.turnover);
        assert!(size > 1e-3, "round {round}: only {size:e} of the turnover is carried");
        at_walls(simulation);
        turning(simulation, &found, expected.turnover);
    }
    assert!(slid, "no contact slides");
}

/// The contacts at the walls are all that the walls feel.
fn at_walls(simulation: &Simulation) {
    for (index, boundary) in simulation.state().boundaries.iter().enumerate() {
        let (mut felt, mut turnover) = ([0.0; 3], 0.0);
        for touch in touches(simulation).iter().filter(|touch| touch.boundary == index) {
            for axis in 0..3 {
                felt[axis] -= touch.force[axis];
                turnover += touch.force[axis].abs();
            }
        }
        for axis in 0..3 {
            let error = (felt[axis] - boundary.force[axis]).abs();
            assert!(error <= 1e-12 * turnover, "boundary {index}, axis {axis}: {error:e} of {turnover:e} N");
        }
    }
}

/// What is not symmetric makes the particles turn.
fn turning(simulation: &Simulation, found: &Tensor, turnover: f64) {
    let mut couple = [0.0; 3];
    for torque in &simulation.state().particles.torque {
        (0..3).for_each(|axis| couple[axis] += torque[axis]);
    }
    // The moment on a wall is −Σ (c − pivot) × f − Σ C.
    for boundary in &simulation.state().boundaries {
        (0..3).for_each(|axis| couple[axis] += boundary.moment[axis]);
    }
    for touch in touches(simulation) {
        let pivot = simulation.state().boundaries[touch.boundary].pivot;
        let moment = cross(less(touch.point, pivot), touch.force);
        (0..3).for_each(|axis| couple[axis] += moment[axis]);
    }
    let error = less(axial(found), couple).iter().fold(0.0, |most: f64, part| most.max(part.abs())) / turnover;
    assert!(error < 1e-12, "{error:e}: {:?}, {couple:?} expected", axial(found));
}

#[test]
fn a_moving_bed_between_planes_carries_what_walls_and_inertia_say() {
    balances(&mut bed(PLANES, ALL), 12);
}

#[test]
fn a_moving_bed_in_a_mesh_carries_what_walls_and_inertia_say() {
    balances(&mut bed(MESH, ALL), 12);
}

/// How far the balance of a bed is from closing after 4 ms, over the turnover, where its scene has these words in the place of others.
fn imbalance(walls: &str, changes: &[[&str; 2]]) -> f64 {
    let mut text = bed_text(1, "[0.0015, 0.0035]", walls, ALL);
    for [old, new] in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    let mut simulation = start_with(&text, box_file());
    simulation.advance(4e-3).expect("it runs");
    let found = averages::carried(&simulation)[0];
    let expected = walls_and_inertia(&simulation, |place| place);
    apart(&found, &expected.tensor, expected.turnover)
}

#[test]
fn every_kind_of_law_balances() {
    let sticky = "friction = 0.4\ncohesion_energy_density = 2.0e4";
    let sjkr = "[contact.grains.rolling.cdt]\n[contact.grains.cohesion.sjkr]";
    let adhesive = "friction = 0.4\nsurface_energy = 0.05\ndamping_coefficient = 2.0e4\ntangential_damping_ratio = 0.5";
    let plastic = "friction = 0.4\nsurface_energy = 0.5\nunloading_stiffness_ratio = 3.0\npull_off_force = 1.0e-3";
    let eepa = "normal.eepa]\noverlap_exponent = 1.5\nadhesion_exponent = 2";
    let laws: [&[[&str; 2]]; 8] = [
        &[["tangential.history", "tangential.rescaled"]],
        &[["tangential.history", "tangential.turned_history"]],
        &[["tangential.history", "tangential.no_history"]],
        &[["rolling.cdt", "rolling.epsd2"]],
        &[["friction = 0.4", sticky], ["[contact.grains.rolling.cdt]", sjkr]],
        &[["friction = 0.4", adhesive], ["normal.hertz", "normal.dmt"]],
        &[["friction = 0.4", adhesive], ["normal.hertz", "normal.jkr"], ["rolling.cdt", "rolling.epsd2"]],
        &[["friction = 0.4", plastic], ["normal.hertz]", eepa]],
    ];
    for law in laws {
        for walls in [PLANES, MESH] {
            let error = imbalance(walls, law);
            assert!(error < 1e-12, "{law:?}: {error:e}");
        }
    }
}

#[test]
fn every_scheme_balances_as_far_as_its_dashpots_are_told() {
    let with = |scheme: &str| imbalance(PLANES, &[["step = ", &format!("scheme = {scheme:?}\nstep = ")]]);
    for scheme in ["engine", "predicted_normal", "midway"] {
        let error = with(scheme);
        assert!(error < 1e-12, "{scheme}: {error:e}");
    }
    // What a dashpot foresaw is not stored; records take the present velocity for it.
    let error = with("predicted");
    assert!(error < 1e-5, "predicted: {error:e}");
}

#[test]
fn a_slab_carries_what_is_beyond_it() {
    // The part s of a branch in a slab of z is what the branch gains of the depth in the slab: the balance holds with the
    // depth in place of z, whatever the slab cuts through.
    let (low, high) = (0.0113, 0.0247);
    let slab = format!("[region.slab]\nbox = [[-1.0, -1.0, {low:?}], [1.0, 1.0, {high:?}]]\n");
    let mut simulation = bed(PLANES, &slab);
    for _ in 0..6 {
        simulation.advance(1e-3).expect("it runs");
        let found = averages::carried(&simulation)[0];
        let expected = walls_and_inertia(&simulation, |[_, _, z]| [0.0, 0.0, z.clamp(low, high) - low]);
        let error = apart(&[[0.0; 3], [0.0; 3], found[2]], &expected.tensor, expected.turnover);
        assert!(error < 1e-12, "{error:e}: {:?}, {:?} expected", found[2], expected.tensor[2]);
    }
}

#[test]
fn regions_side_by_side_add_up() {
    let cells = "
[region.all]
box = [[0.004, 0.006, 0.005], [0.03, 0.035, 0.033]]
[region.lower]
box = [[0.004, 0.006, 0.005], [0.017, 0.035, 0.033]]
[region.upper]
box = [[0.017, 0.006, 0.005], [0.03, 0.035, 0.033]]
";
    let mut simulation = bed(PLANES, cells);
    simulation.advance(3e-3).expect("it runs");
    let [all, lower, upper] = averages::carried(&simulation)[..] else { panic!("three regions") };
    let sum: Tensor =
        [0, 1, 2].map(|row: usize| [0, 1, 2].map(|column: usize| lower[row][column] + upper[row][column]));
    let size = all.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    assert!(apart(&sum, &all, size) < 1e-12, "{sum:?}, {all:?} expected");
    let [all, lower, upper] = averages::contents(&simulation)[..] else { panic!("three regions") };
    assert!((lower.solid + upper.solid - all.solid).abs() < 1e-13 * all.solid);
    assert!((lower.mass + upper.mass - all.mass).abs() < 1e-13 * all.mass);
}

#[test]
fn a_bonded_block_that_tumbles_and_breaks_carries_its_inertia() {
    let damped = |model: &str| format!("[bond.glue.damping.{model}]\nnormal_force = 0.2\ntangential_force = 0.1\n");
    for (formulation, damping) in [
        ("incremental", String::new()),
        ("incremental", damped("opposing")),
        ("incremental", damped("viscous")),
        ("finite_rotation", String::new()),
        ("finite_rotation", damped("viscous")),
    ] {
        let text = format!(
            r#"
[run]
step = 1.0e-6
threads = 1
[material.rock]
density = 2500.0
[particles.block]
material = "rock"
lattice = {{ kind = "face_centred_cubic", radius = 0.005, box = [[0.0, 0.0, 0.0], [0.05, 0.04, 0.04]] }}
[bond.glue]
formulation = {formulation:?}
between = ["block", "block"]
create_distance = 0.0101
radius_multiplier = 0.8
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
{damping}
[force.pull]
particles = {{ box = [[0.0, 0.0, 0.0], [0.012, 0.04, 0.04]] }}
force = [-2.0, 3.0, 1.0]
{ALL}
"#
        );
        let mut simulation = start(&text);
        for _ in 0..5 {
            simulation.advance(2e-4).expect("it runs");
            let found = averages::carried(&simulation)[0];
            let mut expected = walls_and_inertia(&simulation, |place| place);
            let force = &simulation.scene().forces[0];
            let particles = &simulation.state().particles;
            for &member in &force.members {
                let [x, y, z, _] = particles.position[particles.slot[member as usize] as usize];
                expected.add([x, y, z], force.force);
            }
            let error = apart(&found, &expected.tensor, expected.turnover);
            assert!(error < 1e-12, "{formulation} {damping}{error:e}: {found:?}, {:?} expected", expected.tensor);
        }
    }
}

#[test]
fn a_bonded_block_that_hits_a_floor_carries_what_the_floor_says_whatever_its_bonds_do_to_contacts() {
    for formulation in ["incremental", "finite_rotation"] {
        for contact in ["parallel", "without_normal", "none"] {
            let text = format!(
                r#"
[run]
step = 1.0e-6
threads = 1
[material.rock]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25
[pair.rock.rock]
restitution = 0.6
friction = 0.4
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.block]
material = "rock"
lattice = {{ kind = "face_centred_cubic", radius = 0.005, spacing = 0.00995, box = [[0.0, 0.0, 0.0], [0.04, 0.04, 0.03]] }}
velocity = [0.3, 0.1, -1.0]
[bond.glue]
formulation = {formulation:?}
contact = {contact:?}
between = ["block", "block"]
create_distance = 0.0101
radius_multiplier = 0.8
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
[bond.glue.breakage]
max_normal_stress = 1.0e4
max_shear_stress = 1.0e4
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "rock"
{ALL}
"#
            );
            let mut simulation = start(&text);
            let made: u64 = simulation.state().bonds.iter().map(|list| list.made).sum();
            for _ in 0..5 {
                simulation.advance(1e-4).expect("it runs");
                let found = averages::carried(&simulation)[0];
                let expected = walls_and_inertia(&simulation, |place| place);
                let error = apart(&found, &expected.tensor, expected.turnover);
                assert!(error < 1e-12, "{formulation}, {contact}: {error:e}: {found:?}, {:?}", expected.tensor);
            }
            let broken: u64 = simulation.state().bonds.iter().map(|list| list.broken).sum();
            assert!(0 < broken && broken < made, "{formulation}, {contact}: {broken} of {made} bonds broke");
        }
    }
}

/// Spheres that do not feel each other, with velocities, and regions.
fn spheres(list: &[(Vector, f64, Vector)], regions: &str) -> Simulation {
    let entry = |(position, radius, velocity): &(Vector, f64, Vector)| {
        format!("{{ position = {position:?}, radius = {radius:?}, velocity = {velocity:?} }}")
    };
    let list: Vec<String> = list.iter().map(entry).collect();
    start(&format!(
        "[run]\nstep = 1e-4\nthreads = 1\n[material.a]\ndensity = 1000.0\n[particles.all]\nmaterial = \"a\"\nlist = [{}]\n{regions}",
        list.join(", ")
    ))
}

#[test]
fn porosity_of_a_sphere_cut_by_a_plane_an_edge_and_a_corner_is_that_of_closed_forms() {
    let radius = 0.2_f64;
    let corner = |a: f64, b: f64, c: f64| {
        let box_to = |from: f64| 0.3 + radius * from;
        format!("[region.r]\nbox = [[{:?}, {:?}, {:?}], [1.3, 1.3, 1.3]]\n", box_to(a), box_to(b), box_to(c))
    };
    let cap = |c: f64| PI * (1.0 - c).powi(2) * (2.0 + c) / 3.0;
    // Parts of the unit sphere beyond x = a, y = b, z = c. An edge through the centre halves a cap, a corner with one face off
    // the centre quarters it; the others are integrals with 30 digits.
    let cases = [
        ([-1.4, -1.2, 0.35], cap(0.35)),
        ([-0.6, -1.5, -1.5], cap(-0.6)),
        ([0.0, -1.5, 0.35], cap(0.35) / 2.0),
        ([0.3, 0.5, -1.5], 0.152_345_774_168_150_46),
        ([-0.3, -0.5, -1.5], 2.506_445_869_258_102),
        ([0.0, 0.0, 0.35], cap(0.35) / 4.0),
        ([0.2, 0.3, 0.4], 0.069_436_398_976_012_31),
        ([-0.6, 0.3, -0.7], 1.042_725_348_087_817_1),
    ];
    for ([a, b, c], part) in cases {
        let simulation = spheres(&[([0.3; 3], radius, [0.0; 3])], &corner(a, b, c));
        let volume = [a, b, c].iter().map(|from| 1.0 - radius * from).product::<f64>();
        let found = (1.0 - value(&simulation, "r.porosity")) * volume / radius.powi(3);
        assert!((found - part).abs() < 1e-13, "{:?}: {found:?}, {part:?} expected", [a, b, c]);
        let mass = 1000.0 * part * radius.powi(3);
        assert!((value(&simulation, "r.mass") - mass).abs() < 1e-12 * mass.max(1.0));
    }
}

#[test]
fn porosity_of_a_bed_of_many_sizes_is_that_of_chance() {
    let regions = "
[region.block]
box = [[0.0031, 0.0057, 0.0083], [0.0289, 0.0331, 0.0277]]
[region.core]
cylinder = { from = [0.01, 0.012, 0.006], to = [0.03, 0.025, 0.035], radius = 0.011 }
";
    let mut simulation = bed(PLANES, regions);
    simulation.advance(2e-3).expect("it runs");
    let spheres = simulation.state().particles.position.clone();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut uniform = || random.next_u64() as f64 / u64::MAX as f64;
    const SAMPLES: u32 = 300_000;
    for (region, name) in simulation.scene().regions.iter().zip(["block", "core"]) {
        let (mut inside, mut sum, mut squares) = (0_u32, 0.0, 0.0);
        for _ in 0..SAMPLES {
            let place = [0.04 * uniform(), 0.04 * uniform(), 0.04 * uniform()];
            if !region.shape.holds(place.into()) {
                continue;
            }
            inside += 1;
            let holds = |[x, y, z, radius]: &&[f64; 4]| {
                less(place, [*x, *y, *z]).iter().map(|part| part * part).sum::<f64>() < radius * radius
            };
            let count = spheres.iter().filter(holds).count() as f64;
            (sum, squares) = (sum + count, squares + count * count);
        }
        let number = f64::from(inside);
        let (mean, deviation) = (sum / number, ((squares / number - (sum / number).powi(2)) / number).sqrt());
        let found = 1.0 - value(&simulation, &format!("{name}.porosity"));
        assert!((found - mean).abs() < 4.0 * deviation, "{name}: {found}, {mean} ± {deviation} expected");
        assert!(deviation < 2e-3 && (0.3..0.8).contains(&found), "{name}: {found} ± {deviation}");
        let volume = number / f64::from(SAMPLES) * 0.04_f64.powi(3);
        assert!((region.shape.volume() / volume - 1.0).abs() < 0.03, "{name}");
    }
}

#[test]
fn two_grains_have_the_temperature_and_the_stress_of_their_motion() {
    let mass = 1000.0 * 4.0 / 3.0 * PI * 1e-3;
    let list = [([0.5, 0.5, 0.5], 0.1, [1.0, 0.0, 3.0]), ([1.5, 0.5, 0.5], 0.1, [-1.0, 2.0, 3.0])];
    let simulation = spheres(&list, "[region.r]\nbox = [[0.0, 0.0, 0.0], [2.0, 1.0, 1.0]]\n");
    // Mean (0, 1, 3), differences ±(1, −1, 0).
    let expected = [
        ("r.mass", 2.0 * mass),
        ("r.velocity.x", 0.0),
        ("r.velocity.y", 1.0),
        ("r.velocity.z", 3.0),
        ("r.granular_temperature", 2.0 / 3.0),
        ("r.stress.xx", -mass),
        ("r.stress.yy", -mass),
        ("r.stress.zz", 0.0),
        ("r.stress.xy", mass),
        ("r.stress.xz", 0.0),
        ("r.stress.yz", 0.0),
        ("r.coordination", 0.0),
        ("r.porosity", 1.0 - 4.0 / 3.0 * PI * 1e-3),
    ];
    for (name, expected) in expected {
        let found = value(&simulation, name);
        assert!((found - expected).abs() < 1e-14 * mass, "{name}: {found:?}, {expected:?} expected");
    }
}

#[test]
fn an_empty_region_has_no_stress_and_no_motion() {
    let simulation = spheres(&[([0.5; 3], 0.1, [1.0; 3])], "[region.r]\nbox = [[2.0, 2.0, 2.0], [3.0, 3.0, 3.0]]\n");
    let interface = Interface::of(simulation.scene());
    for (index, variable) in interface.outputs().filter(|(_, variable)| variable.name.starts_with("r.")) {
        let expected = match variable.name.as_str() {
            "r.porosity" => Value::Real(1.0),
            name if name.starts_with("r.count") => Value::Integer(0),
            _ => Value::Real(0.0),
        };
        assert_eq!(interface.value(&simulation, index), expected, "{}", variable.name);
    }
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

#[test]
fn what_presses_is_below_zero_and_the_force_of_the_particles_on_a_wall_is_stress_times_its_normal() {
    let simulation = start(&format!("{PRESSED}[region.r]\nbox = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]\n"));
    let (floor, lid) = (value(&simulation, "floor.force.z"), value(&simulation, "lid.force.z"));
    assert!(floor < 0.0 && (floor + lid).abs() < 1e-15 * lid);
    // From one point of contact to the other, half an overlap behind each wall: 0.01998 + 0.00001 m.
    let (found, expected) = (value(&simulation, "r.stress.zz"), floor * 0.01999 / 8.0);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found}, {expected} expected");
    assert_eq!(value(&simulation, "r.coordination"), 2.0);
}

#[test]
fn a_region_goes_with_the_boundary_that_it_follows() {
    let regions = "
[region.still]
box = [[0.0, -1.0, -1.0], [1.0, 1.0, 1.0]]
[region.moving]
box = [[0.0, -1.0, -1.0], [1.0, 1.0, 1.0]]
follows = \"lid\"
";
    let mut simulation = start(&format!("{PRESSED}{regions}"));
    let part = |simulation: &Simulation, name: &str| {
        (1.0 - value(simulation, &format!("{name}.porosity"))) * 4.0 / (0.01_f64).powi(3)
    };
    let half = 2.0 / 3.0 * PI;
    for name in ["still", "moving"] {
        assert!((part(&simulation, name) - half).abs() < 1e-9);
    }
    simulation.set_input(BoundaryIndex(1), 0, 0.004);
    simulation.advance(1e-4).expect("it runs");
    // 4 mm are 0.4 of the radius. The porosity is rounded to 1e-16, 1e-10 of the volume of the sphere.
    let cap = PI * 0.6_f64.powi(2) * 2.4 / 3.0;
    let [still, moving] = ["still", "moving"].map(|name| part(&simulation, name));
    assert!((still - half).abs() < 1e-9 && (moving - cap).abs() < 1e-9, "{still}, {moving}; {half}, {cap} expected");
}

#[test]
fn looking_changes_nothing_and_any_number_of_threads_sees_the_same() {
    let more = format!(
        "{ALL}[region.core]\ncylinder = {{ from = [0.02, 0.02, 0.0], to = [0.02, 0.02, 0.03], radius = 0.01 }}\n"
    );
    let outputs = |threads: usize, more: &str| {
        let mut simulation = bed_with(threads, "[0.0012, 0.0014]", PLANES, more);
        simulation.advance(2e-3).expect("it runs");
        let interface = Interface::of(simulation.scene());
        let values: Vec<u64> =
            interface.outputs().map(|(index, _)| interface.value(&simulation, index).number().to_bits()).collect();
        simulation.advance(1e-3).expect("it runs");
        assert_eq!(simulation.threads(), threads);
        (values, simulation.state().particles.position.clone())
    };
    let (one, three) = (outputs(1, &more), outputs(3, &more));
    assert_eq!(one, three);
    assert_eq!(one.1, outputs(1, "").1);
}

#[test]
fn the_variables_of_a_region_stand_between_those_of_the_boundaries_and_of_the_scene() {
    let names = |more: &str| -> Vec<String> {
        let simulation = bed(PLANES, more);
        Interface::of(simulation.scene()).variables().iter().map(|variable| variable.name.clone()).collect()
    };
    let (with, without) = (names(ALL), names(""));
    let own = [
        "stress.xx",
        "stress.yy",
        "stress.zz",
        "stress.xy",
        "stress.xz",
        "stress.yz",
        "porosity",
        "coordination",
        "granular_temperature",
        "mass",
        "velocity.x",
        "velocity.y",
        "velocity.z",
        "count",
        "count_by_set.grains",
    ];
    let first = with.iter().position(|name| name.starts_with("all.")).expect("the region has variables");
    assert_eq!(with[first..first + own.len()], own.map(|name| format!("all.{name}")));
    assert_eq!(with[first + own.len()], "energy.kinetic");
    let others: Vec<&String> = with.iter().filter(|name| !name.starts_with("all.")).collect();
    assert_eq!(others, without.iter().collect::<Vec<_>>());
}
