//! Boxes, beds and lids, and their derivatives.

use cograin::interface::{Derivatives, Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A scene with its files.
pub(super) fn scene(text: &str, files: &[(&str, &str)]) -> Arc<Scene> {
    let files = files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec()));
    let source = Source { name: "scene.toml".into(), text: text.into(), files: files.collect::<BTreeMap<_, _>>() };
    Arc::new(Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}")))
}

/// A scene at time 0.
pub(super) fn start(text: &str) -> Simulation {
    Simulation::new(scene(text, &[])).unwrap_or_else(|error| panic!("{error}"))
}

/// The boundary of this name.
pub(super) fn named(simulation: &Simulation, name: &str) -> BoundaryIndex {
    let place = simulation.scene().boundaries.iter().position(|boundary| boundary.name == name);
    BoundaryIndex(place.expect("the scene has it") as u32)
}

/// Makes a communication step.
pub(super) fn advance(simulation: &mut Simulation, length: f64) {
    simulation.advance_or_roll_back(length).unwrap_or_else(|error| panic!("{error}"));
}

/// Outputs of a boundary in which the derivatives of each kind stand side by side: forces, then moments.
pub(super) fn loads(names: &[&str]) -> [Vec<String>; 2] {
    let of = |kinds: [&str; 2]| {
        let each = names.iter().flat_map(|name| kinds.map(|kind| format!("{name}.{kind}")));
        each.flat_map(|name| ["x", "y", "z"].map(|axis| format!("{name}.{axis}"))).collect()
    };
    [of(["force", "mean_force"]), of(["moment", "mean_moment"])]
}

/// Indices of variables.
pub(super) fn indices(interface: &Interface, names: &[String]) -> Vec<usize> {
    names.iter().map(|name| interface.find(name).unwrap_or_else(|| panic!("{name} is not there"))).collect()
}

/// Derivatives of outputs by an input.
pub(super) fn ask(simulation: &mut Simulation, outputs: &[String], input: &str) -> Vec<f64> {
    let interface = Interface::of(simulation.scene());
    let (outputs, input) = (indices(&interface, outputs), indices(&interface, &[input.to_owned()])[0]);
    interface
        .derivatives(simulation, &mut Derivatives::default(), (&outputs, &[(input, 1.0)]))
        .unwrap_or_else(|refusal| panic!("{refusal}"))
}

/// Largest distance of two rows of numbers over the largest of the second.
pub(super) fn away(found: &[f64], expected: &[f64]) -> f64 {
    let most = expected.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    let apart = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs());
    let apart = apart.fold(0.0, |most: f64, part| if part > most || part.is_nan() { part } else { most });
    // What nothing moves has no derivative.
    if most == 0.0 && apart == 0.0 { 0.0 } else { apart / most }
}

/// Values of outputs.
pub(super) fn read(simulation: &Simulation, outputs: &[String]) -> Vec<f64> {
    let interface = Interface::of(simulation.scene());
    indices(&interface, outputs).iter().map(|&index| interface.value(simulation, index).number()).collect()
}

/// Largest distance of the derivatives of outputs of one kind by an input from a central difference by hand: of a step of this length
/// \[s\], over the largest of them. Asking leaves the state as it is, to the bit.
pub(super) fn distance(
    simulation: &mut Simulation,
    outputs: &[Vec<String>],
    input: &str,
    (length, change): (f64, f64),
) -> f64 {
    let interface = Interface::of(simulation.scene());
    let index = indices(&interface, &[input.to_owned()])[0];
    let begin = simulation.state().clone();
    let given = interface.value(simulation, index).number();
    let mut at = |value: f64| {
        simulation.restore(&begin).unwrap_or_else(|fault| panic!("{fault}"));
        interface.set(simulation, index, Value::Real(value)).unwrap_or_else(|refusal| panic!("{refusal}"));
        advance(simulation, length);
        outputs.iter().map(|names| read(simulation, names)).collect::<Vec<_>>()
    };
    let (there, back) = (at(given + change), at(given - change));
    at(given);
    let before = simulation.state().clone();
    let mut most = 0.0_f64;
    for (names, (there, back)) in outputs.iter().zip(there.iter().zip(&back)) {
        let expected: Vec<f64> = there.iter().zip(back).map(|(there, back)| (there - back) / (2.0 * change)).collect();
        assert!(expected.iter().any(|part| *part != 0.0), "{input} changes none of {names:?}");
        let found = ask(simulation, names, input);
        assert!(before == *simulation.state(), "asking for {input} changed the state");
        most = most.max(away(&found, &expected));
    }
    most
}

/// Spheres between six planes of which the lid is driven, under a contact law.
pub(super) fn box_of_spheres(law: &str, more: &str) -> String {
    let plane = |name: &str, point: [f64; 3], normal: [f64; 3], rest: &str| {
        format!("[boundary.{name}]\nmaterial = \"a\"\nplane = {{ point = {point:?}, normal = {normal:?} }}\n{rest}\n")
    };
    let walls = [
        plane("x_low", [0.0; 3], [1.0, 0.0, 0.0], ""),
        plane("x_high", [0.03122, 0.0, 0.0], [-1.0, 0.0, 0.0], ""),
        plane("y_low", [0.0; 3], [0.0, 1.0, 0.0], ""),
        plane("y_high", [0.0, 0.03121, 0.0], [0.0, -1.0, 0.0], ""),
        plane("floor", [0.0; 3], [0.0, 0.0, 1.0], ""),
        plane("lid", [0.0, 0.0, 0.0312], [0.0, 0.0, -1.0], "motion = { driven = [\"x\", \"z\"] }"),
    ]
    .concat();
    format!(
        r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2.0e-6
threads = 1
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.4
rolling_friction = 0.1
rolling_viscous_damping = 0.3
cohesion_energy_density = 3.0e3
fluid_viscosity = 1.0e-3
critical_stokes_number = 10.0
maximum_restitution = 0.9
surface_energy = 0.05
damping_coefficient = 1.0e4
tangential_damping_ratio = 0.5
unloading_stiffness_ratio = 3.0
pull_off_force = 1.0e-3
STIFFNESS
{law}
[particles.bed]
material = "a"
lattice = {{ kind = "face_centred_cubic", origin = [0.005, 0.005, 0.005], counts = [2, 2, 2], spacing = 1.0e-2, radius = 5.01e-3 }}
{walls}
{more}
"#
    )
}

/// The box with the numbers that a normal model takes for stiffness and damping.
pub(super) fn with_law(law: &str, more: &str) -> String {
    let (stiffness, damping) = if law.contains("hertz_stiffness") { ("1.0e7", "1.0e5") } else { ("5.0e3", "0.1") };
    let numbers = format!(
        "normal_stiffness = {stiffness}\ntangential_stiffness = {stiffness}\nnormal_damping = {damping}\n\
         tangential_damping = {damping}"
    );
    box_of_spheres(law, more).replace("STIFFNESS", &numbers)
}

/// A loaded, sheared box: the lid comes down, then goes aside.
pub(super) fn loaded_by(text: &str) -> Simulation {
    let mut simulation = start(text);
    let lid = named(&simulation, "lid");
    for number in 1..=20 {
        simulation.set_input(lid, 2, -1.0e-4 * f64::from(number.min(10)) / 10.0);
        simulation.set_input(lid, 0, 3.0e-4 * f64::from((number - 5).max(0)) / 15.0);
        simulation.advance(2.0e-4).unwrap_or_else(|error| panic!("{error}"));
    }
    simulation
}

/// A block of bonded spheres between a glued floor and a driven grip.
pub(super) const BONDED: &str = r#"
[run]
step = 2.0e-7
threads = 1
[material.ice]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.block]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [4, 3, 4], spacing = 2.02e-3, radius = 1.0e-3 }
[boundary.floor]
plane = { point = [0.0, 0.0, -1.0e-3], normal = [0.0, 0.0, 1.0] }
material = "ice"
[boundary.grip]
particles = { set = "block", box = [[-1.0, -1.0, 5.5e-3], [1.0, 1.0, 1.0]] }
motion = { driven = ["x", "z"] }
[bond.block]
LAW
between = ["block", "block"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.block.breakage]
max_normal_stress = 4.0e8
max_shear_stress = 4.0e8
[bond.glue]
LAW
between = ["block", "floor"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
"#;

/// Dashpots of a bond law.
pub(super) const DASHPOTS: &str =
    "damping.viscous = { normal_force = 0.1, tangential_force = 0.1, normal_torque = 0.1, tangential_torque = 0.1 }";

/// Pulls and shears a block.
pub(super) fn pull(simulation: &mut Simulation) {
    let grip = named(simulation, "grip");
    for number in 1..=10 {
        simulation.set_input(grip, 2, 1.0e-6 * f64::from(number));
        simulation.set_input(grip, 0, 2.0e-6 * f64::from(number));
        simulation.advance(1.0e-5).unwrap_or_else(|error| panic!("{error}"));
    }
}
