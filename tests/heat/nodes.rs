//! Temperatures of the nodes of a mesh.

use super::{GRAINS, assert_close, row};
use crate::support::{scene, scene_with};
use cograin::interface::{Derivatives, Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use std::collections::BTreeMap;

/// The sheet.
const SHEET: BoundaryIndex = BoundaryIndex(0);

/// Its corners \[m\].
const CORNERS: [[f64; 3]; 4] = [[-5e-3, -4e-3, 1e-5], [6e-3, -4e-3, 1e-5], [6e-3, 5e-3, 1e-5], [-5e-3, 5e-3, 1e-5]];

/// Three spheres of 1 mm at 300 K on a sheet of two triangles, one of them at its edge inside, one at the rim, with these keys of the sheet.
fn text(keys: &str) -> String {
    let list = row([(0.2e-3, 300.0), (2.7e-3, 300.0), (6.1e-3, 300.0)]);
    // A time step in which the spheres do not leave the sheet.
    let grains = GRAINS.replace("step = 1.0e-4", "step = 1.0e-6");
    format!(
        "{grains}[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n[boundary.sheet]\nmaterial = \"stone\"\n\
         mesh = {{ file = \"sheet.obj\", sides = 2 }}\nnodes = \"driven\"\n{keys}\n"
    )
}

/// That scene at time 0.
fn begin(keys: &str) -> Simulation {
    Simulation::new(scene_with(&text(keys), sheet())).unwrap_or_else(|error| panic!("{error}"))
}

/// The sheet as a file.
fn sheet() -> BTreeMap<String, Vec<u8>> {
    let corners: String = CORNERS.iter().map(|[x, y, z]| format!("v {x:e} {y:e} {z:e}\n")).collect();
    BTreeMap::from([("sheet.obj".to_owned(), (corners + "f 1 2 3\nf 1 3 4\n").into_bytes())])
}

/// Temperatures that go up along both axes of the sheet \[K\].
fn field([x, y, _]: [f64; 3]) -> f64 {
    310.0 + 2000.0 * x - 1500.0 * y
}

/// Gives each node the temperature of the field.
fn warm(simulation: &mut Simulation) {
    let places = simulation.scene().boundaries[0].shape.vertices().to_vec();
    for (node, place) in places.iter().enumerate() {
        simulation.set_node_temperature(SHEET, node, field(place.to_array()));
    }
}

#[test]
fn a_linear_field_of_nodes_has_its_own_temperature_at_each_point_of_contact() {
    let mut simulation = begin("temperature = { driven = 300.0 }");
    warm(&mut simulation);
    (0..2).for_each(|_| simulation.advance(1e-6).unwrap());
    let found = simulation.state().heat.as_ref().unwrap().flow.clone();
    let at_rim = [6e-3, 0.0, 0.0];
    for (sphere, place) in [[0.2e-3, 0.0, 0.0], [2.7e-3, 0.0, 0.0], at_rim].into_iter().enumerate() {
        let mut same = begin("temperature = 300.0");
        let mut warmed = begin(&format!("temperature = {:?}", field(place)));
        for simulation in [&mut same, &mut warmed] {
            (0..2).for_each(|_| simulation.advance(1e-6).unwrap());
        }
        // The conductance of the second step, by that of a sheet of one temperature in the first and the second.
        let flow = |simulation: &Simulation| simulation.state().heat.as_ref().unwrap().flow[sphere];
        let gained = |simulation: &Simulation| simulation.state().heat.as_ref().unwrap().rise(sphere);
        assert_eq!(flow(&same), 0.0);
        let before =
            gained(&warmed) - 1e-6 * flow(&warmed) / simulation.state().heat.as_ref().unwrap().capacity[sphere];
        let conductance = flow(&warmed) / (field(place) - 300.0 - before);
        assert_close(found[sphere], conductance * (field(place) - 300.0), 1e-9);
    }
}

#[test]
fn what_nodes_take_adds_up_to_what_the_mesh_takes() {
    let mut simulation =
        begin("temperature = { driven = 300.0 }\n[heat]\nfrom_losses = [\"normal_damping\", \"sliding\"]");
    for _ in 0..5 {
        warm(&mut simulation);
        simulation.advance(5e-6).unwrap();
        let heat = simulation.state().heat.as_ref().unwrap();
        let (nodes, whole) = (heat.nodes_of(0).unwrap(), heat.boundaries[0]);
        assert!(whole.heat() != 0.0);
        assert_close(nodes.iter().map(|node| node.flow).sum(), whole.flow, 1e-13);
        assert_close(nodes.iter().map(|node| node.mean_flow).sum(), whole.mean_flow, 1e-13);
        assert_close(nodes.iter().map(|node| node.heat()).sum(), whole.heat(), 1e-13);
        assert_close(heat.energy() + whole.heat(), heat.by_losses, 1e-11);
    }
}

#[test]
fn the_unit_has_a_temperature_and_heat_flows_of_each_node_in_place_of_one_temperature() {
    let mut simulation = begin("temperature = { driven = 300.0 }");
    let interface = Interface::of(simulation.scene());
    assert!(interface.find("sheet.temperature").is_none());
    let [input, flow] =
        ["sheet.node[2].temperature", "sheet.node[2].mean_heat_flow"].map(|name| interface.find(name).unwrap());
    interface.set(&mut simulation, input, Value::Real(350.0)).unwrap();
    (0..3).for_each(|_| simulation.advance_or_roll_back(5e-6).unwrap());
    let taken = interface.value(&simulation, flow).number();
    assert!(taken < 0.0, "{taken:e} W into a warm node");
    let asked: (&[usize], &[(usize, f64)]) = (&[flow], &[(input, 1.0)]);
    let found = interface.derivatives(&mut simulation, &mut Derivatives::default(), asked).unwrap()[0];
    // In the last step the ramp went on from 350 K: half of what is added acts.
    let run = |last: f64| {
        let mut simulation = begin("temperature = { driven = 300.0 }");
        for end in [350.0, 350.0, last] {
            interface.set(&mut simulation, input, Value::Real(end)).unwrap();
            simulation.advance(5e-6).unwrap();
        }
        interface.value(&simulation, flow).number()
    };
    assert_close(found, (run(352.0) - run(348.0)) / 4.0, 1e-7);
}

/// Nothing moves.
const FROZEN: &str = "[heat]\nfrozen = true\n";

#[test]
fn while_nothing_moves_a_linear_field_of_nodes_acts_as_one_temperature_at_each_point_of_contact() {
    let mut simulation = begin(&format!("temperature = {{ driven = 300.0 }}\n{FROZEN}"));
    warm(&mut simulation);
    // At the beginning of the first step the nodes are as warm as the spheres.
    (0..2).for_each(|_| simulation.advance(1e-6).unwrap());
    let heat = simulation.state().heat.as_ref().unwrap();
    for (sphere, place) in [[0.2e-3, 0.0, 0.0], [2.7e-3, 0.0, 0.0], [6e-3, 0.0, 0.0]].into_iter().enumerate() {
        let mut warmed = begin(&format!("temperature = {:?}\n{FROZEN}", field(place)));
        warmed.advance(1e-6).unwrap();
        assert_close(heat.flow[sphere], warmed.state().heat.as_ref().unwrap().flow[sphere], 1e-12);
    }
    assert_close(heat.nodes_of(0).unwrap().iter().map(|node| node.flow).sum(), heat.boundaries[0].flow, 1e-13);
}

#[test]
fn while_nothing_moves_spheres_come_to_the_temperature_of_the_field_and_nodes_give_what_they_gain() {
    let text = text(&format!("temperature = {{ driven = 300.0 }}\n{FROZEN}"));
    let text = text.replace("step = 1.0e-6\nallow_unstable = true", "safety = 0.5");
    let mut simulation = Simulation::new(scene_with(&text, sheet())).unwrap();
    warm(&mut simulation);
    for interval in [0.3, 1.0, 20.0, 100.0] {
        simulation.advance(interval).unwrap();
        let heat = simulation.state().heat.as_ref().unwrap();
        let (nodes, whole) = (heat.nodes_of(0).unwrap(), heat.boundaries[0]);
        assert_close(nodes.iter().map(|node| node.heat()).sum(), whole.heat(), 1e-12);
        assert_close(nodes.iter().map(|node| node.mean_flow).sum(), whole.mean_flow, 1e-12);
        assert_close(heat.energy(), -whole.heat(), 1e-12);
    }
    for (sphere, place) in [[0.2e-3, 0.0, 0.0], [2.7e-3, 0.0, 0.0], [6e-3, 0.0, 0.0]].into_iter().enumerate() {
        // A step may be wrong by 1e-6 of the differences of temperature.
        assert!((super::temperature(&simulation, sphere) - field(place)).abs() < 3e-5);
    }
    simulation.set_node(SHEET, (1, 2), 1e-6);
    let refused = simulation.advance(1.0).unwrap_err().to_string();
    assert!(refused.contains("expected no motion in a scene with [heat] frozen = true"), "{refused}");
}

#[test]
fn a_mesh_of_one_temperature_has_none_of_its_nodes() {
    let simulation = begin("temperature = 350.0");
    let interface = Interface::of(simulation.scene());
    assert!(interface.find("sheet.node[1].temperature").is_none());
    assert!(interface.find("sheet.heat_flow").is_some());
}

#[test]
fn thermal_inputs_of_earlier_steps_are_given_again_when_a_step_is_made_again() {
    let list = row([(0.0, 300.0)]);
    let text = format!(
        "{GRAINS}[heat]\nfrozen = true\n[particles.all]\nmaterial = \"stone\"\nlist = [\n{list}]\n\
         [boundary.floor]\nplane = {{ point = [0, 0, 1.0e-5], normal = [0, 0, 1] }}\nmaterial = \"stone\"\n\
         temperature = {{ driven = 310.0 }}\n"
    );
    let interface = Interface::of(&scene(&text));
    let [input, flow] = ["floor.temperature", "floor.mean_heat_flow"].map(|name| interface.find(name).unwrap());
    let run = |ends: &[f64]| {
        let mut simulation = Simulation::new(scene(&text)).unwrap();
        for &end in ends {
            interface.set(&mut simulation, input, Value::Real(end)).unwrap();
            simulation.advance_or_roll_back(0.02).unwrap();
        }
        simulation
    };
    let number = |simulation: &Simulation| interface.value(simulation, flow).number();
    let expected = (number(&run(&[400.0, 350.0, 322.0])) - number(&run(&[400.0, 350.0, 318.0]))) / 4.0;
    let mut simulation = run(&[400.0, 350.0, 320.0]);
    let asked: (&[usize], &[(usize, f64)]) = (&[flow], &[(input, 1.0)]);
    let found = interface.derivatives(&mut simulation, &mut Derivatives::default(), asked).unwrap()[0];
    assert_close(found, expected, 1e-7);
}
