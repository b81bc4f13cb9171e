//! The table that a scene gives.

use super::*;
use crate::base::quantity::{MaterialIndex, ParticleId, SetIndex};
use crate::engine::state::BoundaryState;
use crate::laws::contact::{Material, Properties};
use crate::laws::surface::{Group, Plane};
use crate::scene::{
    AxisMotion, Body, Boundary, InputCourse, NodeMotion, Output, Outside, Particle, ParticleShape, SceneDraft, Shape,
};

/// A scene of one sphere, a driven plane, a plane that moves by itself, and the sphere as a group that stands.
fn scene() -> Scene {
    draft().build().unwrap()
}

/// The same, to be changed.
fn draft() -> SceneDraft {
    let plane = Shape::of(Plane { material: MaterialIndex(0), point: [0.0; 3], normal: [0.0, 0.0, 1.0] });
    let boundary = |name: &str, shape: &Shape, axes| Boundary {
        name: name.to_owned(),
        shape: shape.clone(),
        axes,
        moves_with: None,
        nodes: NodeMotion::Rigid,
        input: InputCourse::Ramp,
        reference: [0.0; 3],
        body: Body::default(),
        outside: Outside::default(),
        temperature: Default::default(),
        wear: Vec::new(),
    };
    let sphere = Particle {
        id: ParticleId(7),
        set: SetIndex(0),
        material: MaterialIndex(0),
        shape: ParticleShape::Sphere,
        radius: 0.5,
        density: 6.0,
        position: [0.0, 0.0, 1.0],
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    };
    let stone = Material {
        name: "stone".to_owned(),
        density: 6.0,
        youngs_modulus: None,
        poissons_ratio: None,
        thermal: Default::default(),
        properties: Default::default(),
    };
    use AxisMotion::{Driven, Fixed, Prescribed};
    SceneDraft {
        materials: vec![stone],
        pairs: vec![Properties::default()],
        sets: vec!["stones".to_owned()],
        particles: vec![sphere],
        boundaries: vec![
            boundary("floor", &plane, [Fixed, Fixed, Driven, Fixed, Fixed, Fixed]),
            boundary("lid", &plane, [Prescribed(0.1), Fixed, Fixed, Fixed, Fixed, Fixed]),
            boundary("grip", &Shape::of(Group { members: vec![0] }), [const { Fixed }; 6]),
        ],
        ..SceneDraft::default()
    }
}

#[test]
fn what_is_no_number_is_an_empty_field() {
    let told = [Value::Real(f64::NAN), Value::Real(f64::INFINITY), Value::Real(0.5), Value::Integer(3)];
    assert_eq!(told.map(|value| value.to_string()), ["", "", "0.5", "3"]);
}

#[test]
fn inputs_are_the_driven_axes_and_nothing_else() {
    let interface = Interface::of(&scene());
    let inputs: Vec<&str> = interface.inputs().map(|(_, variable)| variable.name.as_str()).collect();
    assert_eq!(inputs, ["floor.displacement.z"]);
}

#[test]
fn a_boundary_that_moves_by_itself_shows_where_it_is() {
    let interface = Interface::of(&scene());
    let index = interface.find("lid.displacement.x").expect("the lid moves along x");
    assert_eq!(interface.variables()[index].causality, Causality::Output);
    assert_eq!(interface.find("lid.displacement.y"), None);
    assert_eq!(interface.find("grip.displacement.x"), None);
}

#[test]
fn every_boundary_has_loads_mean_loads_and_work() {
    let interface = Interface::of(&scene());
    for boundary in ["floor", "lid", "grip"] {
        for load in ["force", "moment", "mean_force", "mean_moment"] {
            for axis in ["x", "y", "z"] {
                let name = format!("{boundary}.{load}.{axis}");
                assert!(interface.find(&name).is_some(), "{name} is missing");
            }
        }
        assert!(interface.find(&format!("{boundary}.work")).is_some());
    }
}

#[test]
fn a_group_shows_its_mass_and_a_plane_has_none() {
    let interface = Interface::of(&scene());
    let mass = &interface.variables()[interface.find("grip.mass").expect("a group has a mass")];
    assert_eq!(mass.start, Some(4.0 / 3.0 * std::f64::consts::PI * 0.125 * 6.0));
    assert_eq!(mass.variability, Variability::Constant);
    assert_eq!(interface.find("floor.mass"), None);
}

#[test]
fn the_energy_residual_is_there_when_the_book_is_kept() {
    assert_eq!(Interface::of(&scene()).find("energy.residual"), None);
    let kept = SceneDraft { output: Output { energy: true, ..Output::default() }, ..draft() };
    assert!(Interface::of(&kept.build().unwrap()).find("energy.residual").is_some());
}

#[test]
fn names_are_unique_and_every_variable_is_described() {
    let interface = Interface::of(&scene());
    let names: std::collections::BTreeSet<&str> = interface.variables().iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names.len(), interface.variables().len());
    for variable in interface.variables() {
        assert!(!variable.description.is_empty(), "{}", variable.name);
    }
}

#[test]
fn a_start_from_a_state_takes_its_displacements() {
    let scene = scene();
    let mut state = Simulation::new(std::sync::Arc::new(scene.clone())).unwrap().state().clone();
    state.boundaries[0] = BoundaryState { target: [0.0, 0.0, 2.5e-3, 0.0, 0.0, 0.0], ..state.boundaries[0] };
    let interface = Interface::of(&scene).starting_in(&state);
    let index = interface.find("floor.displacement.z").expect("the floor is driven");
    assert_eq!(interface.variables()[index].start, Some(2.5e-3));
}

#[test]
fn setting_an_output_or_no_number_is_refused_by_name() {
    let interface = Interface::of(&scene());
    let force = interface.find("floor.force.z").expect("the floor has a force");
    let message = interface.check(force, 1.0).unwrap_err().to_string();
    assert_eq!(message, "floor.force.z is an output; only inputs and parameters may be set");
    let message = interface.check(0, f64::NAN).unwrap_err().to_string();
    assert_eq!(message, "floor.displacement.z: expected a finite number, found NaN");
    let count = interface.variables().len();
    let message = interface.check(count, 1.0).unwrap_err().to_string();
    assert_eq!(message, format!("{count} is not a variable; the variables are 0 to {}", count - 1));
}

#[test]
fn the_page_of_the_unit_lists_every_kind_of_variable_with_its_unit() {
    let page = include_str!("../../docs/fmu.md");
    for row in rows::all() {
        let unit = row.quantity.unit().unwrap_or("");
        let lines: Vec<&str> = page.lines().filter(|line| line.starts_with('|') && line.contains(row.name)).collect();
        let listed = lines.iter().any(|line| line.split('|').any(|cell| cell.trim() == unit));
        assert!(listed, "{} with the unit {unit:?} is missing: {lines:?}", row.name);
    }
}

#[test]
fn what_was_found_for_one_value_serves_the_others() {
    let output = Output { energy: true, ..Output::default() };
    let mut draft = SceneDraft { gravity: [0.0, 0.0, -9.81], output, ..draft() };
    draft.boundaries.retain(|boundary| boundary.name != "grip");
    let mut simulation = Simulation::new(std::sync::Arc::new(draft.build().unwrap())).unwrap();
    let (interface, findings) = (Interface::of(simulation.scene()), Findings::default());
    let is_number = |index: &usize| interface.type_of(*index) != Some(Type::String);
    for index in (0..interface.variables().len()).filter(is_number) {
        let alone = interface.value(&simulation, index);
        assert_eq!(interface.value_with(&simulation, &findings, index), alone, "{index}");
    }
    // The sphere falls. Who does not forget what was found is told the same energy: nobody goes through the particles again.
    simulation.advance(1e-3).unwrap();
    let kinetic = interface.find("energy.kinetic").unwrap();
    assert_ne!(interface.value(&simulation, kinetic), Value::Real(0.0));
    assert_eq!(interface.value_with(&simulation, &findings, kinetic), Value::Real(0.0));
}
