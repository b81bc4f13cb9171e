//! Derivatives are differences of two steps, for lids and groups of every kind.

use super::scenes::{BONDED, advance, ask, away, distance, indices, loaded_by, loads, named, scene, start, with_law};
use cograin::interface::{Derivatives, Interface, Value};
use cograin::lanes::Width;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::sync::Arc;

/// A scene whose inputs have gone to these values little by little.
fn led(scene: &Arc<Scene>, inputs: &[(&str, f64)], length: f64) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(scene)).unwrap_or_else(|error| panic!("{error}"));
    let interface = Interface::of(scene);
    for number in 1..=20 {
        for (name, value) in inputs {
            let input = indices(&interface, &[(*name).to_owned()])[0];
            let value = Value::Real(value * f64::from(number.min(10)) / 10.0);
            interface.set(&mut simulation, input, value).unwrap_or_else(|refusal| panic!("{refusal}"));
        }
        advance(&mut simulation, length);
    }
    simulation
}

/// The lid as a mesh of two triangles.
const SHEET: &str =
    "v -0.01 -0.01 0.0312\nv 0.05 -0.01 0.0312\nv 0.05 0.05 0.0312\nv -0.01 0.05 0.0312\nf 1 3 2\nf 1 4 3\n";

/// The box under a lid of this shape and motion.
fn under_lid(shape: &str) -> Arc<Scene> {
    let law = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";
    let text = with_law(law, "").replace("[run]", "[run]\nmax_overlap = 0.5");
    let plane = "plane = { point = [0.0, 0.0, 0.0312], normal = [0.0, 0.0, -1.0] }";
    let changed =
        text.replace(&format!("{plane}\nmotion = {{ driven = [\"x\", \"z\"] }}"), &shape.replace("PLANE", plane));
    assert!(changed != text, "the lid is there");
    scene(&changed, &[("lid.obj", SHEET)])
}

/// A lid: its name, its lines in the scene, where its inputs stand, the one that is displaced, and how far.
type Case<'a> = (&'a str, &'a str, &'a [(&'a str, f64)], &'a str, f64);

#[test]
fn lids_of_every_kind_have_the_derivatives_of_their_differences() {
    let mesh = "mesh = { file = \"lid.obj\", sides = 2 }\nmotion = { driven = [\"z\"] }";
    let nodes = "mesh = { file = \"lid.obj\", sides = 2 }\nnodes = \"driven\"";
    let corners = [1, 2, 3, 4].map(|node| format!("lid.node[{node}].displacement.z"));
    let corners: Vec<(&str, f64)> = corners.iter().map(|name| (name.as_str(), -1.0e-4)).collect();
    let down = [("lid.displacement.z", -1.0e-4)];
    let tilted = [("lid.displacement.z", -1.0e-4), ("lid.rotation.y", 1.0e-3)];
    let heavy = "PLANE\nmass = 1.0e-3\nstiffness = { z = 300.0 }\ndamping = { z = 0.5 }\nmotion = { loaded = [\"z\"] }";
    let cases: [Case; 7] = [
        ("mesh", mesh, &down, "lid.displacement.z", 1.0e-10),
        ("nodes", nodes, &corners, "lid.node[2].displacement.z", 1.0e-10),
        ("turning plane", "PLANE\nmotion = { driven = [\"z\", \"rotation.y\"] }", &tilted, "lid.rotation.y", 1.0e-8),
        (
            "velocity",
            "PLANE\nmotion = { driven = [\"z\"], by = \"velocity\" }",
            &[("lid.velocity.z", -0.01)],
            "lid.velocity.z",
            1.0e-6,
        ),
        ("loaded", heavy, &[("lid.applied_force.z", -2.0)], "lid.applied_force.z", 1.0e-5),
        (
            "light",
            "PLANE\nmass = 1.0e-5\nmotion = { loaded = [\"z\"] }",
            &[("lid.applied_force.z", -2.0)],
            "lid.applied_force.z",
            1.0e-5,
        ),
        (
            "servo",
            "PLANE\nmotion = { servo = { z = { speed = 0.5 } } }",
            &[("lid.target_force.z", 2.0)],
            "lid.target_force.z",
            1.0e-5,
        ),
    ];
    let mut wrong = Vec::new();
    for (name, shape, inputs, input, change) in cases {
        let mut simulation = led(&under_lid(shape), inputs, 2.0e-4);
        let found = distance(&mut simulation, &loads(&["lid", "floor"]), input, (1.0e-4, change));
        if found.is_nan() || found > 1e-6 {
            wrong.push(format!("{name}: {found:e}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn groups_that_inputs_turn_or_forces_move_have_the_derivatives_of_their_differences() {
    let mut wrong = Vec::new();
    for (motion, inputs, input, change) in [
        (
            "{ driven = [\"x\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }",
            ["grip.displacement.x", "grip.rotation.y"],
            "grip.rotation.x",
            1.0e-6,
        ),
        ("{ driven = [\"x\", \"rotation.y\"] }", ["grip.displacement.x", "grip.rotation.y"], "grip.rotation.y", 1.0e-6),
        (
            "{ driven = [\"x\"], free = [\"z\", \"rotation.y\"] }",
            ["grip.displacement.x"; 2],
            "grip.displacement.x",
            1.0e-9,
        ),
        (
            "{ loaded = [\"x\", \"rotation.y\"] }",
            ["grip.applied_force.x", "grip.applied_moment.y"],
            "grip.applied_moment.y",
            1.0e-4,
        ),
    ] {
        // Without contacts, of which some would open or close.
        let text = BONDED.replace("LAW", "").replace("{ driven = [\"x\", \"z\"] }", motion);
        let text = text.replace("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n", "");
        let mut simulation = led(&scene(&text, &[]), &inputs.map(|name| (name, 1.0e-5)), 1.0e-5);
        let found = distance(&mut simulation, &loads(&["grip", "floor"]), input, (1.0e-5, change));
        if found.is_nan() || found > 1e-6 {
            wrong.push(format!("{motion}: {found:e}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn energies_have_derivatives_and_a_direction_is_one_difference() {
    let central = |text: &str| text.replace("[run]", "[run]\ncentral_derivatives = true");
    let mut simulation = loaded_by(&central(&with_law("[contact.touch.normal.hertz]", "")));
    advance(&mut simulation, 1.0e-4);
    let energies = [vec!["energy.kinetic".to_owned(), "lid.work".to_owned()]];
    let found = distance(&mut simulation, &energies, "lid.displacement.z", (1.0e-4, 1.0e-9));
    assert!(found < 2e-6, "{found:e}");

    let interface = Interface::of(simulation.scene());
    let outputs = indices(&interface, &loads(&["lid", "floor"])[0]);
    let [x, z] = ["x", "z"].map(|axis| indices(&interface, &[format!("lid.displacement.{axis}")])[0]);
    let mut along = |direction: &[(usize, f64)]| {
        let mut known = Derivatives::default();
        let mut ask = || interface.derivatives(&mut simulation, &mut known, (&outputs, direction)).unwrap();
        let found = ask();
        assert_eq!(ask(), found, "what is known is told again");
        found
    };
    let parts = [along(&[(x, 1.0)]), along(&[(z, 1.0)])];
    let expected: Vec<f64> = parts[0].iter().zip(&parts[1]).map(|(x, z)| 0.5 * x - 2.0 * z).collect();
    let found = along(&[(x, 0.5), (z, -2.0)]);
    assert!(away(&found, &expected) < 2e-6, "{:e}", away(&found, &expected));
    assert_eq!(along(&[(x, 1.0), (z, -4.0)]), found.iter().map(|part| 2.0 * part).collect::<Vec<_>>());
    assert_eq!(along(&[(x, 0.0), (z, 0.0)]), vec![0.0; outputs.len()]);
}

#[test]
fn differences_are_the_same_in_every_lane_width_and_on_every_number_of_threads() {
    let law = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";
    let of = |threads: usize, width: Width| {
        let text = with_law(law, "").replace("threads = 1", &format!("threads = {threads}"));
        let mut simulation = start(&text);
        simulation.set_width(width);
        let lid = named(&simulation, "lid");
        for number in 1..=4 {
            simulation.set_input(lid, 2, -2.0e-5 * f64::from(number));
            advance(&mut simulation, 1.0e-4);
        }
        ask(&mut simulation, &loads(&["lid", "floor"])[0], "lid.displacement.z")
    };
    let whole = of(1, Width::Least);
    assert!(whole.iter().any(|part| *part != 0.0), "nothing changes");
    for width in Width::ALL.into_iter().filter(|width| width.offered()) {
        assert_eq!(of(1, width), whole, "{width:?}");
    }
    assert_eq!(of(2, Width::widest()), whole);
}

#[test]
fn the_rate_of_a_pressed_spring_is_stiffness_times_velocity_and_0_before_the_first_step() {
    let mut simulation = start(&with_law("[contact.touch.normal.hooke_stiffness]", ""));
    let interface = Interface::of(simulation.scene());
    let rates = |simulation: &Simulation| {
        ["lid.force.z", "lid.mean_force.z"].map(|name| {
            let index = indices(&interface, &[name.to_owned()])[0];
            interface.rate(simulation, index).unwrap_or_else(|refusal| panic!("{refusal}"))
        })
    };
    assert_eq!(rates(&simulation), [0.0; 2]);
    let lid = named(&simulation, "lid");
    simulation.set_input(lid, 2, -1.0e-6);
    simulation.advance(4.0e-6).unwrap_or_else(|error| panic!("{error}"));
    // Eight spheres of 5 kN/m under the lid, at 0.25 m/s; they have hardly begun to move themselves.
    let (found, expected) = (rates(&simulation), 8.0 * 5.0e3 * 0.25);
    assert!(found.iter().all(|rate| (rate / expected - 1.0).abs() < 2e-3), "{found:?} N/s, not {expected} N/s");
    let saved = State::from_bytes(&simulation.state().to_bytes(0), 0).unwrap_or_else(|fault| panic!("{fault}"));
    simulation.restore(&saved).unwrap_or_else(|fault| panic!("{fault}"));
    assert_eq!(rates(&simulation), found, "a state keeps the rates");
}
