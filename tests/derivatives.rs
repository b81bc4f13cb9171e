//! Directional derivatives against central differences of the same simulation, from the same state.

use cograin::contact::cohesion::CohesionChoice;
use cograin::contact::normal::NormalChoice;
use cograin::contact::rolling::RollingChoice;
use cograin::contact::tangential::TangentialChoice;
use cograin::interface::{Interface, Value};
use cograin::lanes::Width;
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::state::{BoundaryState, State};
use cograin::step::{BoundaryDerivatives, Simulation};
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

/// Displacements, velocities, forces with mean forces, moments with mean moments of all boundaries.
fn seen(simulation: &Simulation) -> [Vec<f64>; 4] {
    let all = &simulation.state().boundaries;
    let of = |parts: fn(&BoundaryState) -> [[f64; 3]; 2]| all.iter().flat_map(parts).flatten().collect();
    [
        of(|it| [it.displacement, [0.0; 3]]),
        of(|it| [it.velocity, [0.0; 3]]),
        of(|it| [it.force, it.mean_force]),
        of(|it| [it.moment, it.mean_moment]),
    ]
}

/// The same of derivatives by the first input.
fn slopes(all: &[BoundaryDerivatives]) -> [Vec<f64>; 4] {
    let of = |parts: fn(&BoundaryDerivatives) -> [[f64; 3]; 2]| all.iter().flat_map(parts).flatten().collect();
    [
        of(|it| [it.displacement, [0.0; 3]]),
        of(|it| [it.velocity, [0.0; 3]]),
        of(|it| [it.force, it.mean_force]),
        of(|it| [it.moment, it.mean_moment]),
    ]
}

/// Largest distance of derivative and central difference, over the length of the latter, of places, velocities, forces and moments.
fn distance(simulation: &mut Simulation, (name, axis): (&str, usize), length: f64, change: f64) -> f64 {
    let boundary = named(simulation, name);
    let given = simulation.state().boundaries[boundary.index()].target[axis];
    let begin = simulation.state().clone();
    let mut at = |value: f64| {
        simulation.restore(&begin).unwrap_or_else(|fault| panic!("{fault}"));
        simulation.set_input(boundary, axis, value);
        simulation.advance_or_return(length).unwrap_or_else(|error| panic!("{error}"));
        seen(simulation)
    };
    let (there, back) = (at(given + change), at(given - change));
    let reached = at(given);
    let bytes = simulation.state().clone();
    simulation.set_input(boundary, axis, given + 1.0);
    // The last of several inputs is followed where the law is evaluated, the others beside it.
    let mut by = |count: usize| {
        let inputs = vec![(boundary, axis); count];
        simulation.derivatives(&inputs).unwrap_or_else(|refusal| panic!("{refusal}"))
    };
    let found = by(1).swap_remove(0);
    assert!(by(3).iter().all(|other| *other == found));
    assert_eq!(simulation.state().boundaries[boundary.index()].target[axis], given + 1.0, "an input was forgotten");
    simulation.set_input(boundary, axis, given);
    assert_eq!(reached, seen(simulation));
    assert!(bytes == *simulation.state(), "the state is another one");
    assert_eq!(carried(simulation, &begin, ((boundary, axis), given), length), found);
    assert!(bytes == *simulation.state(), "the state is another one where slopes go along");
    let (found, mut most) = (slopes(&found), 0.0_f64);
    for kind in 0..found.len() {
        let expected = there[kind].iter().zip(&back[kind]).map(|(there, back)| (there - back) / (2.0 * change));
        let expected: Vec<f64> = expected.collect();
        most = most.max(away(&found[kind], &expected));
    }
    most
}

/// The derivatives by an input with this value after a step that is made again and again from the same state, with a question after
/// each: from some time on the slopes go along in the step.
fn carried(
    simulation: &mut Simulation,
    begin: &State,
    (input, value): ((BoundaryIndex, usize), f64),
    length: f64,
) -> Vec<BoundaryDerivatives> {
    let mut found = Vec::new();
    for _ in 0..4 {
        simulation.restore(begin).unwrap_or_else(|fault| panic!("{fault}"));
        simulation.set_input(input.0, input.1, value);
        simulation.advance_or_return(length).unwrap_or_else(|error| panic!("{error}"));
        found = simulation.derivatives(&[input]).unwrap_or_else(|refusal| panic!("{refusal}"));
    }
    found.swap_remove(0)
}

/// Length of the difference of two vectors over the length of the second.
fn away(found: &[f64], expected: &[f64]) -> f64 {
    let length = |parts: &mut dyn Iterator<Item = f64>| parts.map(|part| part * part).sum::<f64>().sqrt();
    let whole = length(&mut expected.iter().copied());
    let apart = length(&mut found.iter().zip(expected).map(|(found, expected)| found - expected));
    // What nothing moves has no derivative.
    if whole == 0.0 && apart == 0.0 { 0.0 } else { apart / whole }
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
fn with_law(law: &str, more: &str) -> String {
    let (stiffness, damping) = if law.contains("hertz_stiffness") { ("1.0e7", "1.0e5") } else { ("5.0e3", "0.1") };
    let numbers = format!(
        "normal_stiffness = {stiffness}\ntangential_stiffness = {stiffness}\nnormal_damping = {damping}\n\
         tangential_damping = {damping}"
    );
    box_of_spheres(law, more).replace("STIFFNESS", &numbers)
}

/// A loaded, sheared box: the lid comes down, then goes aside.
fn loaded(law: &str, more: &str) -> Simulation {
    loaded_by(&with_law(law, more))
}

/// The same of a scene.
fn loaded_by(text: &str) -> Simulation {
    let mut simulation = start(text);
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

#[test]
fn every_sub_model_has_the_derivatives_of_its_differences() {
    let mut laws: Vec<(String, String)> = Vec::new();
    let law = |[normal, tangential, rolling, cohesion]: [&str; 4], scheme: &str| {
        let keys = match normal {
            "hooke" | "hooke_viscous" => "characteristic_velocity = 1.0",
            "eepa" => "overlap_exponent = 1.5\nadhesion_exponent = 2",
            "jkr" | "dmt" if scheme.ends_with("arms") => "engine_exact = true",
            _ => "",
        };
        let scheme = scheme.trim_end_matches(" with its arms");
        let text = format!(
            "[contact.touch.normal.{normal}]\n{keys}\n[contact.touch.tangential.{tangential}]\n\
             [contact.touch.rolling.{rolling}]\n[contact.touch.cohesion.{cohesion}]"
        );
        (format!("{normal} {tangential} {rolling} {cohesion} {scheme}"), format!("{text}\nSCHEME {scheme}"))
    };
    for &normal in NormalChoice::NAMES {
        laws.push(law([normal, "history", "none", "none"], "engine"));
    }
    for normal in ["jkr", "dmt"] {
        laws.push(law([normal, "history", "none", "none"], "engine with its arms"));
    }
    for &tangential in TangentialChoice::NAMES {
        laws.push(law(["hertz", tangential, "none", "none"], "engine"));
    }
    for &rolling in RollingChoice::NAMES {
        laws.push(law(["hertz", "history", rolling, "none"], "engine"));
    }
    for &cohesion in CohesionChoice::NAMES {
        laws.push(law(["hertz", "history", "none", cohesion], "engine"));
    }
    for scheme in ["midway", "predicted"] {
        laws.push(law(["hertz", "history", "epsd", "none"], scheme));
    }
    let mut wrong = Vec::new();
    for (name, text) in laws {
        let (law, scheme) = text.split_once("\nSCHEME ").expect("a scheme is named");
        let mut simulation = loaded_by(&with_law(law, "").replace("[run]", &format!("[run]\nscheme = \"{scheme}\"")));
        for axis in [0, 2] {
            let found = distance(&mut simulation, ("lid", axis), 1.0e-4, 1.0e-10);
            if found.is_nan() || found > 1e-6 {
                wrong.push(format!("{name}: {found:e}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A block of bonded spheres between a glued floor and a driven grip.
const BONDED: &str = r#"
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
const DASHPOTS: &str =
    "damping.viscous = { normal_force = 0.1, tangential_force = 0.1, normal_torque = 0.1, tangential_torque = 0.1 }";

#[test]
fn bonds_of_every_formulation_have_the_derivatives_of_their_differences() {
    let mut wrong = Vec::new();
    for formulation in ["finite_rotation", "incremental", "engine_exact"] {
        for (damping, scheme) in [("", "engine"), (DASHPOTS, "engine"), (DASHPOTS, "predicted")] {
            let law = format!("formulation = \"{formulation}\"\n{damping}");
            if formulation == "engine_exact" && !damping.is_empty() {
                continue;
            }
            let text = BONDED.replace("[run]", &format!("[run]\nscheme = \"{scheme}\""));
            let mut simulation = start(&text.replace("LAW", &law));
            let grip = named(&simulation, "grip");
            for number in 1..=10 {
                simulation.set_input(grip, 2, 1.0e-6 * f64::from(number));
                simulation.set_input(grip, 0, 2.0e-6 * f64::from(number));
                simulation.advance(1.0e-5).unwrap_or_else(|error| panic!("{error}"));
            }
            for axis in [0, 2] {
                let found = distance(&mut simulation, ("grip", axis), 1.0e-5, 1.0e-8);
                if found.is_nan() || found > 1e-8 {
                    wrong.push(format!("{formulation} {damping} {scheme}: {found:e}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn derivatives_are_the_same_in_every_lane_width_and_beside_other_inputs() {
    let mut bonded = start(&BONDED.replace("LAW", DASHPOTS).replace("[run]", "[run]\nscheme = \"predicted\""));
    let grip = named(&bonded, "grip");
    bonded.set_input(grip, 2, 1.0e-6);
    bonded.advance_or_return(1.0e-5).unwrap_or_else(|error| panic!("{error}"));
    let mut pressed = loaded(
        "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.rolling.epsd]\n\
         [contact.touch.cohesion.sjkr]",
        "",
    );
    pressed.advance_or_return(1.0e-4).unwrap_or_else(|error| panic!("{error}"));
    let lid = named(&pressed, "lid");
    for (mut simulation, [across, along]) in [(bonded, [(grip, 0), (grip, 2)]), (pressed, [(lid, 0), (lid, 2)])] {
        let inputs = [across, along, along, across, along, across, along, across, across, along, along];
        let mut follow = |inputs: &[(BoundaryIndex, usize)], width: Width| {
            simulation.set_width(width);
            simulation.derivatives(inputs).unwrap_or_else(|refusal| panic!("{refusal}"))
        };
        let whole = follow(&inputs, Width::Least);
        assert!(whole[1].iter().any(|boundary| boundary.force[2] != 0.0), "nothing changes");
        assert!(whole[0] != whole[1]);
        for width in Width::ALL.into_iter().filter(|width| width.offered()) {
            assert_eq!(follow(&inputs, width), whole, "{width:?}");
        }
        for (input, whole) in inputs.into_iter().zip(&whole) {
            for width in Width::ALL.into_iter().filter(|width| width.offered()) {
                assert_eq!(follow(&[input], width)[0], *whole, "{width:?}");
            }
        }
    }
}

#[test]
fn the_rate_of_a_pressed_spring_is_stiffness_times_velocity() {
    let mut simulation = start(&with_law("[contact.touch.normal.hooke_stiffness]", ""));
    let lid = named(&simulation, "lid");
    simulation.set_input(lid, 2, -1.0e-6);
    simulation.advance(4.0e-6).unwrap_or_else(|error| panic!("{error}"));
    let rates = simulation.rates().unwrap_or_else(|refusal| panic!("{refusal}"));
    // Eight spheres of 5 kN/m under the lid, at 0.25 m/s; they have hardly begun to move themselves.
    let (found, expected) = (rates[lid.index()].force[2], 8.0 * 5.0e3 * 0.25);
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} N/s, not {expected} N/s");
}

#[test]
fn derivatives_go_with_particles_and_contacts_into_new_lists() {
    let law = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";
    let mut simulation = loaded_by(&with_law(law, "").replace("[run]", "[run]\nskin = 2.0e-7"));
    let before = simulation.state().clock.rebuilds;
    let found = distance(&mut simulation, ("lid", 0), 2.0e-4, 1.0e-10);
    assert!(simulation.state().clock.rebuilds > before + 3, "lists are made anew on the way");
    assert!(found < 1e-6, "{found:e}");
}

/// Derivatives of a box whose lid moves like this, by the input of an axis, after some steps in which it gets these values.
fn of_lid(motion: &str, axis: usize, value: f64, change: f64) -> f64 {
    let law = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]";
    let text = with_law(law, "").replace("motion = { driven = [\"x\", \"z\"] }", motion);
    let mut simulation = start(&text);
    let lid = named(&simulation, "lid");
    for number in 1..=20 {
        simulation.set_input(lid, axis, value * f64::from(number) / 20.0);
        simulation.advance(2.0e-4).unwrap_or_else(|error| panic!("{error}"));
    }
    distance(&mut simulation, ("lid", axis), 1.0e-4, change)
}

#[test]
fn a_boundary_moved_by_velocity_or_by_a_force_has_the_derivatives_of_its_differences() {
    let mass = "mass = 1.0e-3\nstiffness = { z = 300.0 }\ndamping = { z = 0.5 }";
    for (motion, axis, value, change) in [
        ("motion = { driven = [\"x\", \"z\"], by = \"velocity\" }".to_owned(), 2, -0.01, 1.0e-6),
        (format!("{mass}\nmotion = {{ loaded = [\"z\"] }}"), 2, -2.0, 1.0e-5),
        ("mass = 1.0e-5\nmotion = { loaded = [\"z\"] }".to_owned(), 2, -2.0, 1.0e-5),
    ] {
        let found = of_lid(&motion, axis, value, change);
        assert!(found < 1e-6, "{motion}: {found:e}");
    }
}

#[test]
fn a_group_turned_by_inputs_has_the_derivatives_of_its_differences() {
    for axes in ["\"rotation.y\"", "\"x\", \"rotation.x\", \"rotation.y\", \"rotation.z\""] {
        // Without contacts, of which some would open or close.
        let text = BONDED.replace("LAW", "").replace("\"x\", \"z\"", axes);
        let text = text.replace("[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n", "");
        let mut simulation = start(&text);
        let grip = named(&simulation, "grip");
        let axes: Vec<usize> = if axes.contains("rotation.x") { vec![0, 3, 4, 5] } else { vec![4] };
        for number in 1..=10 {
            for &axis in &axes {
                simulation.set_input(grip, axis, 1.0e-3 * f64::from(number) * if axis < 3 { 1.0e-3 } else { 1.0 });
            }
            simulation.advance(1.0e-5).unwrap_or_else(|error| panic!("{error}"));
        }
        for axis in axes {
            let found = distance(&mut simulation, ("grip", axis), 1.0e-5, if axis < 3 { 1.0e-8 } else { 1.0e-5 });
            assert!(found < 1e-8, "axis {axis}: {found:e}");
        }
    }
}

#[test]
fn what_is_not_followed_is_refused_by_name() {
    let law = "[contact.touch.normal.hertz]";
    let drum =
        "[boundary.drum]\nmaterial = \"a\"\ncylinder = { from = [0.0, 0.0, -0.1], to = [0.0, 0.0, 0.2], radius = 0.2 }";
    let refused = |text: &str| Simulation::follows(start(text).scene()).expect_err("it is not followed").to_string();
    assert!(refused(&with_law(law, drum)).contains("[boundary.drum] a surface of features"));
    let turning = BONDED.replace("LAW", "").replace("driven = [\"x\", \"z\"]", "free = [\"rotation.z\"]");
    assert!(refused(&turning).contains("[boundary.grip] turned by forces"));
    let served = with_law(law, "").replace("driven = [\"x\", \"z\"]", "servo = { z = { speed = 0.5 } }");
    assert!(refused(&served).contains("[boundary.lid] moved by a servo"));
    let late = BONDED.replace("LAW", "create = { step = 3 }");
    assert!(refused(&late).contains("[bond.block] a bond made on the way"));
    let silent = BONDED.replace("LAW", "contact = \"none\"");
    assert!(refused(&silent).contains("[bond.block] a bond that suppresses contacts"));
    let mut fresh = start(&with_law(law, ""));
    let lid = named(&fresh, "lid");
    assert!(fresh.derivatives(&[(lid, 2)]).expect_err("there is no step").to_string().contains("there is none"));
}

/// A held sphere on a driven floor, and one beside it that overlaps by this [m].
fn beside(overlap: f64) -> Simulation {
    start(&format!(
        r#"
[run]
step = 1.0e-6
[material.glass]
youngs_modulus = 1.0e8
poissons_ratio = 0.3
density = 2500.0
[pair.glass.glass]
restitution = 1.0
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.two]
material = "glass"
list = [{{ position = [0.0, 0.0, 0.00999], radius = 0.01 }}, {{ position = [0.1, 0.0, {height:?}], radius = 0.01 }}]
[boundary.held]
particles = {{ set = "two", box = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]] }}
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "glass"
motion = {{ driven = ["x"] }}
[output]
near_switch = true
"#,
        height = 0.01 - overlap
    ))
}

#[test]
fn contacts_that_are_about_to_touch_or_to_slide_are_near_a_switch() {
    // A sphere sticks up to the way µ Fₙ/kₜ = µ δ (2 − ν)/(3 (1 − ν)) of the floor.
    let sticks = 0.5 * 1.0e-5 * 1.7 / (3.0 * 0.7);
    for (overlap, way, expected) in [
        (1.0e-5, 0.9 * sticks, 0),
        (1.0e-5, (1.0 - 2.0e-5) * sticks, 2),
        (1.0e-10, 0.0, 1),
        (-1.0e-10, 0.0, 1),
        (-1.0e-7, 0.0, 0),
    ] {
        let mut simulation = beside(overlap);
        let floor = named(&simulation, "floor");
        simulation.set_input(floor, 0, way);
        simulation.advance(1.0e-5).unwrap();
        simulation.advance(1.0e-5).unwrap();
        assert_eq!(simulation.contacts_near_switch(), expected, "overlap {overlap}, way {way}");
        let interface = Interface::of(simulation.scene());
        let output = interface.find("contacts.near_switch").expect("the scene asks for it");
        assert_eq!(interface.value(&simulation, output), Value::Integer(i32::try_from(expected).unwrap()));
    }
}
