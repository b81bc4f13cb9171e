//! What a scene and a unit say of clumps: masses, bonds, regions, derivatives, files, refusals.

use super::scenes::{ELASTIC, TOP, apart, falling_pair, three};
use crate::support::{read, read_with, start};
use cograin::interface::{Derivatives, Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::statics::stiffness;
use cograin_sparse::factorise;

#[test]
fn mass_and_inertia_of_spheres_apart_are_those_of_the_solids() {
    let simulation = start(
        r#"
[run]
step = 1.0e-3
[material.a]
density = 1000.0
[clump.pair]
spheres = [{ position = [5.0, 1.0, 2.0], radius = 0.5 }, { position = [5.0, 2.0, 2.0], radius = 0.5 }]
[particles.p]
material = "a"
clump = "pair"
list = [{ position = [0.0, 0.0, 3.0] }, { position = [2.0, 0.0, 3.0], scale = 2.0 }]
"#,
    );
    let clumps = &simulation.state().clumps;
    for (clump, scale) in [(0, 1.0_f64), (1, 2.0)] {
        let sphere = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125 * scale.powi(3);
        let square = 0.25 * scale * scale;
        let expected = [(0.4 + 1.0) * 2.0, 0.4 * 2.0, (0.4 + 1.0) * 2.0].map(|factor| factor * sphere * square);
        assert!((clumps.velocity[clump][3] / (2.0 * sphere) - 1.0).abs() < 1e-14);
        let mut found = three(clumps.moments[clump]);
        found.sort_by(f64::total_cmp);
        let mut expected = expected;
        expected.sort_by(f64::total_cmp);
        assert!(apart(found, expected) < 1e-12 * expected[2], "{found:?}, {expected:?} expected");
    }
    let particles = &simulation.state().particles;
    assert!(apart(three(particles.position[0]), [0.0, -0.5, 3.0]) < 1e-14, "placed by its mass centre");
    assert!(apart(three(particles.position[3]), [2.0, 1.0, 3.0]) < 1e-14);
}

#[test]
fn a_bond_of_a_clump_and_a_particle_carries_both_and_keeps_momentum_and_energy() {
    let mut simulation = start(
        r#"
[run]
step = 1.0e-6
[material.a]
density = 2000.0
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.015, 0.0, 0.0], radius = 0.01 }]
[particles.p]
material = "a"
clump = "pair"
list = [{ position = [0.0, 0.0, 0.0], velocity = [0.0, 0.4, 0.0], angular_velocity = [0.0, 3.0, 20.0] }]
[particles.q]
material = "a"
list = [{ position = [0.03, 0.0, 0.0], radius = 0.01 }]
[bond.glue]
between = ["p", "q"]
create_distance = 0.024
radius_multiplier = 0.8
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
formulation = "finite_rotation"
[output]
energy = true
"#,
    );
    assert_eq!(simulation.bonds().len(), 1, "none inside the clump");
    let energy = simulation.kinetic_energy();
    let momentum = |simulation: &Simulation| {
        let (clump, slot) = (simulation.state().clumps.velocity[0], simulation.state().particles.slot[2] as usize);
        let particle = simulation.state().particles.velocity[slot];
        [0, 1, 2].map(|axis| clump[3] * clump[axis] + particle[3] * particle[axis])
    };
    let before = momentum(&simulation);
    simulation.advance(0.05).expect("it runs");
    let whole = simulation.kinetic_energy() + simulation.bond_elastic_energy();
    assert!((whole / energy - 1.0).abs() < 1e-4, "{whole} J, {energy} J at the start");
    assert!(apart(momentum(&simulation), before) < 1e-12 * before[1], "{:?}", momentum(&simulation));
    let residual = simulation.energy_residual().expect("a book");
    assert!(residual.abs() < 1e-12 * simulation.state().ledger.as_ref().expect("a book").turnover, "{residual:e} J");
    // It has turned by about a radian, and the bond still joins the second sphere and the particle.
    let place = |index: usize| {
        let particles = &simulation.state().particles;
        three(particles.position[particles.slot[index] as usize])
    };
    assert!((apart(place(1), place(2)) / 0.0225 - 1.0).abs() < 1e-2, "{:?} {:?}", place(1), place(2));
    assert!((place(2)[1] - place(1)[1]).abs() > 0.005, "{:?} {:?}", place(1), place(2));
}

#[test]
fn a_region_counts_what_spheres_of_a_clump_overlap_once() {
    let simulation = start(
        r#"
[run]
step = 1.0e-6
[material.a]
density = 2000.0
[clump.pair]
spheres = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.01, 0.0, 0.0], radius = 0.01 }]
[particles.p]
material = "a"
clump = "pair"
list = [{ position = [0.0, 0.0, 0.0], velocity = [0.0, 0.4, 0.0], orientation = [1.0, 2.0, 3.0, 4.0] }]
[region.all]
box = [[-0.1, -0.1, -0.1], [0.1, 0.1, 0.1]]
"#,
    );
    let content = cograin::averages::contents(&simulation)[0];
    // Two spheres less the lens: two caps of height r/2.
    let (r, pi): (f64, f64) = (0.01, std::f64::consts::PI);
    let volume = 8.0 / 3.0 * pi * r.powi(3) - 2.0 * pi * (0.5 * r).powi(2) * (r - 0.5 * r / 3.0);
    assert!((content.solid / volume - 1.0).abs() < 1e-12, "{} m³, {volume} expected", content.solid);
    assert!((content.mass / (2000.0 * volume) - 1.0).abs() < 1e-12, "{} kg", content.mass);
    assert!(apart(content.velocity, [0.0, 0.4, 0.0]) < 1e-15, "{:?}", content.velocity);
}

#[test]
fn a_derivative_is_the_difference_of_two_steps_and_leaves_no_trace() {
    let mut simulation = falling_pair(0.8, 1e-3);
    // To the middle of the impact; the derivative is that of the last step.
    for _ in 0..12 {
        simulation.advance_or_roll_back(1e-5).expect("it runs");
    }
    let before = simulation.state().clone();
    simulation.advance_or_roll_back(1e-5).expect("it runs");
    assert_eq!(simulation.contact_count(), 1);
    let interface = Interface::of(simulation.scene());
    let [force, input] =
        ["floor.mean_force.z", "floor.displacement.z"].map(|name| interface.find(name).expect("it is there"));
    let state = simulation.state().clone();
    let found = interface
        .derivatives(&mut simulation, &mut Derivatives::default(), (&[force], &[(input, 1.0)]))
        .expect("there is a derivative")[0];
    assert_eq!(simulation.state().fingerprint(), state.fingerprint());
    let mut at = |way: f64| {
        simulation.restore(&before).expect("its own state");
        interface.set(&mut simulation, input, Value::Real(way)).expect("an input");
        simulation.advance_or_roll_back(1e-5).expect("it runs");
        interface.value(&simulation, force).number()
    };
    let way = 1e-11;
    let expected = (at(way) - at(-way)) / (2.0 * way);
    assert!(expected < -1.0, "{expected} N/m: the floor is pressed");
    // The displacement of a derivative is 1e-13 m here, and places of 0.01 m are rounded to 2e-18 m.
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} N/m, {expected} N/m by differences");
}

#[test]
fn a_clump_between_two_plates_is_as_stiff_as_its_two_contacts() {
    for spheres in [1, 3] {
        let list: Vec<_> = (0..spheres)
            .map(|k| format!("{{ position = [0.0, 0.0, {:?}], radius = 0.01 }}", 0.015 * f64::from(k)))
            .collect();
        let (middle, top) = (0.0075 * f64::from(spheres - 1), 0.015 * f64::from(spheres - 1) + 0.01 - 1e-5);
        let simulation = start(&format!(
            r#"
[run]
step = 1.0e-7
{}
[contact.touch.tangential.history]
[clump.post]
spheres = [{}]
[particles.p]
material = "a"
clump = "post"
list = [{{ position = [0.0, 0.0, {middle:?}] }}]
[boundary.lid]
plane = {{ point = [0.0, 0.0, {top:?}], normal = [0.0, 0.0, -1.0] }}
material = "a"
[boundary.floor]
plane = {{ point = [0.0, 0.0, -0.00999], normal = [0.0, 0.0, 1.0] }}
material = "a"
motion = {{ driven = ["z"] }}
"#,
            ELASTIC.replace("restitution = 1.0", "restitution = 1.0\nfriction = 0.5"),
            list.join(", ")
        ));
        let found = stiffness(&simulation, &[BoundaryIndex(1)], Some(factorise)).expect("a stiffness");
        // Each contact has dF/dδ = 2 E* √(R δ), and both are in a row.
        let contact = 2.0 * 1.0e9 / (2.0 * (1.0 - 0.09)) * (0.01_f64 * 1e-5).sqrt();
        let stiff = found.boundaries[0].matrix[2][2];
        assert!((stiff / (0.5 * contact) - 1.0).abs() < 1e-6, "{stiff} N/m, {} expected", 0.5 * contact);
        assert_eq!((found.freedoms, found.rattlers.len()), (6, 0));
    }
}

#[test]
fn spheres_from_a_file_are_those_of_the_table() {
    let scene = |clump: &str, file: &str| {
        let text = format!(
            "[material.a]\ndensity = 1.0\n[clump.b]\n{clump}\n[particles.p]\nmaterial = \"a\"\nclump = \"b\"\nlist = [{{ position = [0.0, 0.0, 0.0] }}]"
        );
        read_with(&text, [("b.csv".to_owned(), file.as_bytes().to_vec())].into())
    };
    let file = "x, y, z, radius\n0.0, 0.0, 0.0, 0.1\n0.3, 0.1, 0.0, 0.08\n0.0, 0.5, 0.2, 0.12\n";
    let filed = scene("file = \"b.csv\"", file).expect("a scene");
    let written = scene(TOP.trim().trim_start_matches("[clump.top]"), "").expect("a scene");
    assert_eq!(filed.clump_shapes, written.clump_shapes);
    assert_eq!(filed.particles, written.particles);
    for (clump, file, expected) in [
        ("file = \"c.csv\"", file, "c.csv"),
        ("", file, "[clump.b] spheres: missing"),
        ("file = \"b.csv\"", "x, y, z\n0.0, 0.0, 0.0\n", "radius"),
        ("file = \"b.csv\"", "x, y, z, radius\n0.0, 0.0, 0.0, -0.1\n", "b.csv, line 2"),
        ("file = \"b.csv\"", "x, y, z, radius, vx\n0.0, 0.0, 0.0, 0.1, 1.0\n", "a clump moves as a whole"),
        ("file = \"b.csv\"", "x, y, z, radius\n", "expected 1 to 256 spheres, found 0"),
        ("file = \"b.csv\"\nspheres = [{ position = [0.0, 0.0, 0.0], radius = 1.0 }]", file, "found spheres and file"),
    ] {
        let found = scene(clump, file).expect_err(expected);
        assert!(found.contains(expected), "{found}\n{expected} expected");
    }
}

#[test]
fn what_clumps_cannot_be_is_refused_in_words() {
    let scene = |clump: &str, set: &str, more: &str| {
        let text = format!(
            "[material.a]\ndensity = 1.0\n[clump.b]\n{clump}\n[particles.p]\nmaterial = \"a\"\nclump = \"b\"\n{set}\n{more}"
        );
        read(&text).expect_err("a mistake")
    };
    let two = "spheres = [{ position = [0.0, 0.0, 0.0], radius = 1.0 }, { position = [1.0, 0.0, 0.0], radius = 1.0 }]";
    let one = "list = [{ position = [0.0, 0.0, 0.0] }]";
    for (found, expected) in [
        (scene("spheres = []", one, ""), "[clump.b] spheres: expected 1 to 256 spheres, found 0"),
        (
            scene(&format!("{two}\ninertia = [1.0, 1.0, 1.0]"), one, ""),
            "[clump.b] mass: missing; an inertia is that of a mass",
        ),
        (
            scene(&format!("{two}\nmass = 1.0\ninertia = [1.0, 1.0, 3.0]"), one, ""),
            "expected moments above 0, none above the sum of the others",
        ),
        (
            scene(two, "list = [{ position = [0.0, 0.0, 0.0], id = 3 }]", ""),
            "list.1.id: spheres of clumps get their numbers",
        ),
        (
            scene(two, "list = [{ position = [0.0, 0.0, 0.0], orientation = [0.0, 0.0, 0.0, 0.0] }]", ""),
            "expected a quaternion [w, x, y, z] that is not zero",
        ),
        (scene(two, "orientation = \"any\"\nlist = []", ""), "\"random\" or \"principal_axes\", found \"any\""),
        (scene(&format!("{two}\nmass = 1.0"), &format!("density = 2.0\n{one}"), ""), "[clump.b] has a mass"),
        (scene(two, one, "[boundary.g]\nparticles = { set = \"p\" }\nmotion = \"fixed\""), "cannot move as a group"),
    ] {
        assert!(found.contains(expected), "{found}\n{expected} expected");
    }
    let unknown = "[material.a]\ndensity = 1.0\n[particles.p]\nmaterial = \"a\"\nclump = \"c\"\nlist = []";
    let found = read(unknown).expect_err("a mistake");
    assert!(found.contains("clump"), "{found}");
}
