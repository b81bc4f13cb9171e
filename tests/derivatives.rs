//! Directional derivatives against central differences of the same simulation, from the same state.

use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::step::Simulation;
use std::sync::Arc;

/// A scene at time 0.
fn start(text: &str) -> Simulation {
    let source = Source { name: "scene.toml".into(), text: text.into(), files: Default::default() };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
    Simulation::new(Arc::new(scene)).unwrap_or_else(|error| panic!("{error}"))
}

/// The boundary of this name.
fn named(simulation: &Simulation, name: &str) -> BoundaryIndex {
    let place = simulation.scene().boundaries.iter().position(|boundary| boundary.name == name);
    BoundaryIndex(place.expect("the scene has it") as u32)
}

/// Force, moment, mean force and mean moment of all boundaries, one behind the other.
fn loads(simulation: &Simulation) -> Vec<f64> {
    let all = simulation.state().boundaries.iter();
    all.flat_map(|it| [it.force, it.moment, it.mean_force, it.mean_moment]).flatten().collect()
}

/// Largest distance of derivative and central difference, over the length of the latter, of forces and of moments.
fn distance(simulation: &mut Simulation, (name, axis): (&str, usize), length: f64, change: f64) -> f64 {
    let boundary = named(simulation, name);
    let given = simulation.state().boundaries[boundary.index()].target[axis];
    let begin = simulation.state().clone();
    let mut at = |value: f64| {
        simulation.restore(&begin).unwrap_or_else(|fault| panic!("{fault}"));
        simulation.set_input(boundary, axis, value);
        simulation.advance_or_return(length).unwrap_or_else(|error| panic!("{error}"));
        loads(simulation)
    };
    let (there, back) = (at(given + change), at(given - change));
    let reached = at(given);
    let bytes = simulation.state().clone();
    simulation.set_input(boundary, axis, given + 1.0);
    let found = simulation.derivatives(&[(boundary, axis)]).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_eq!(simulation.state().boundaries[boundary.index()].target[axis], given + 1.0, "an input was forgotten");
    simulation.set_input(boundary, axis, given);
    assert_eq!(reached, loads(simulation));
    assert!(bytes == *simulation.state(), "the state is another one");
    let found: Vec<f64> = found
        .iter()
        .flat_map(|it| [it.force, it.moment, it.mean_force, it.mean_moment])
        .flatten()
        .map(|slopes| slopes[0])
        .collect();
    let expected: Vec<f64> = there.iter().zip(&back).map(|(there, back)| (there - back) / (2.0 * change)).collect();
    let of = |values: &[f64], moments: bool| -> Vec<f64> {
        values.chunks(3).skip(usize::from(moments)).step_by(2).flatten().copied().collect()
    };
    [false, true].map(|moments| away(&of(&found, moments), &of(&expected, moments))).into_iter().fold(0.0, f64::max)
}

/// Length of the difference of two vectors over the length of the second.
fn away(found: &[f64], expected: &[f64]) -> f64 {
    let length = |parts: &mut dyn Iterator<Item = f64>| parts.map(|part| part * part).sum::<f64>().sqrt();
    let whole = length(&mut expected.iter().copied());
    assert!(whole > 0.0, "nothing changes");
    length(&mut found.iter().zip(expected).map(|(found, expected)| found - expected)) / whole
}

/// Spheres between six planes of which the lid is driven, under a contact law.
fn box_of_spheres(law: &str, more: &str) -> String {
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
cohesion_energy_density = 3.0e4
{law}
[particles.bed]
material = "a"
lattice = {{ kind = "face_centred_cubic", origin = [0.005, 0.005, 0.005], counts = [2, 2, 2], spacing = 1.0e-2, radius = 5.01e-3 }}
{walls}
{more}
"#
    )
}

/// A loaded, sheared box: the lid comes down, then goes aside.
fn loaded(law: &str, more: &str) -> Simulation {
    let mut simulation = start(&box_of_spheres(law, more));
    let lid = named(&simulation, "lid");
    for number in 1..=20 {
        simulation.set_input(lid, 2, -1.0e-4 * f64::from(number.min(10)) / 10.0);
        simulation.set_input(lid, 0, 3.0e-4 * f64::from((number - 5).max(0)) / 15.0);
        simulation.advance(2.0e-4).unwrap_or_else(|error| panic!("{error}"));
    }
    simulation
}

#[test]
fn linear_contacts_have_the_derivatives_of_their_differences() {
    let mut simulation = loaded("[contact.touch.normal.hooke]\ncharacteristic_velocity = 1.0", "");
    let found = distance(&mut simulation, ("lid", 2), 1.0e-4, 1.0e-9);
    assert!(found < 1e-8, "{found:e}");
}

#[test]
fn hertz_contacts_with_friction_have_the_derivatives_of_their_differences() {
    let mut simulation = loaded("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]", "");
    for axis in [0, 2] {
        let found = distance(&mut simulation, ("lid", axis), 1.0e-4, 1.0e-10);
        assert!(found < 1e-6, "{found:e}");
    }
}
