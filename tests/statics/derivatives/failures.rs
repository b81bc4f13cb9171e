//! Displaced steps that fail, questions without an answer, and switches that are near.

use super::scenes::{advance, ask, loads, named, start, with_law};
use cograin::interface::{Derivatives, Interface, Value};
use cograin::simulation::Simulation;

/// A held sphere that presses on another one, in a domain that ends a little further on, with a displacement of 1 mm.
const NARROW: &str = r#"
[run]
step = 1.0e-6
max_overlap = 0.5
derivative_displacement = 1.0e7
[material.a]
density = 2500.0
[pair.a.a]
normal_stiffness = 5.0e3
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[particles.two]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 5.0e-3 }, { position = [-9.9e-3, 0.0, 0.0], radius = 5.0e-3 }]
[boundary.held]
particles = { set = "two", box = [[-1.0e-3, -1.0, -1.0], [1.0, 1.0, 1.0]] }
motion = { driven = ["x", "y"] }
[boundary.post]
particles = { set = "two", box = [[-1.0, -1.0, -1.0], [-1.0e-3, 1.0, 1.0]] }
[domain]
box = [[-0.1, -5.0e-4, -0.1], [5.0e-4, 5.0e-4, 0.1]]
"#;

#[test]
fn a_displaced_step_that_fails_gives_way_to_the_other_side_and_where_both_fail_nothing_changes() {
    for run in ["", "central_derivatives = true\nderivative_displacement = 1.0e6"] {
        let text = match run {
            "" => NARROW.to_owned(),
            _ => NARROW.replace("derivative_displacement = 1.0e7", run),
        };
        let mut simulation = start(&text);
        advance(&mut simulation, 1.0e-4);
        let force = ["held.force.x".to_owned()];
        // The spring gives way: its force falls as the sphere goes away from the post.
        let found = ask(&mut simulation, &force, "held.displacement.x")[0];
        assert!((found / -5.0e3 - 1.0).abs() < 1e-6, "{found} N/m");
        let before = simulation.state().clone();
        let interface = Interface::of(simulation.scene());
        let [output, input] = ["held.force.x", "held.displacement.y"].map(|name| interface.find(name).unwrap());
        let refused = interface
            .derivatives(&mut simulation, &mut Derivatives::default(), (&[output], &[(input, 1.0)]))
            .expect_err("it leaves the domain on either side")
            .to_string();
        assert!(refused.contains("ends early on either side") && refused.contains("particle 1"), "{refused}");
        assert!(before == *simulation.state(), "the state is another one");
        advance(&mut simulation, 1.0e-4);
        assert!(ask(&mut simulation, &force, "held.displacement.x")[0] < 0.0);
    }
}

#[test]
fn questions_that_have_no_answer_are_refused() {
    let mut simulation = start(&with_law("[contact.touch.normal.hertz]", ""));
    let interface = Interface::of(simulation.scene());
    let mut refused = |output: &str, input: &str, share: f64| {
        let [output, input] = [output, input].map(|name| interface.find(name).expect("it is there"));
        interface
            .derivatives(&mut simulation, &mut Derivatives::default(), (&[output], &[(input, share)]))
            .expect_err("it has no answer")
            .to_string()
    };
    assert!(refused("lid.force.z", "lid.displacement.z", 1.0).contains("found none since"));
    assert!(refused("contacts.count", "lid.displacement.z", 1.0).contains("an output that changes continuously"));
    assert!(refused("lid.displacement.z", "lid.displacement.z", 1.0).contains("an output that changes continuously"));
    assert!(refused("lid.force.z", "lid.force.x", 1.0).contains("expected an input"));
    assert!(refused("lid.force.z", "lid.displacement.z", f64::NAN).contains("NaN"));
    let rate = interface.rate(&simulation, interface.find("contacts.count").expect("it is there"));
    assert!(rate.expect_err("a count has no rate").to_string().contains("contacts.count"));
}

/// Spheres that fall on a plate.
const RAIN: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-5
[material.a]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.5
friction = 0.4
[contact.all.normal.hertz]
[contact.all.tangential.history]
[boundary.floor]
material = "a"
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
motion = { driven = ["x", "z"] }
[region.cloud]
box = [[-0.01, -0.01, 0.005], [0.01, 0.01, 0.03]]
[insertion.feed]
region = "cloud"
material = "a"
sizes = { uniform = [0.001, 0.002] }
count_rate = 4000.0
velocity = [0.0, 0.0, -1.0]
scatter = 0.1
"#;

#[test]
fn who_asks_while_particles_come_goes_the_same_way_as_who_does_not() {
    let (mut asked, mut plain) = (start(RAIN), start(RAIN));
    let outputs = loads(&["floor"])[0].clone();
    for _ in 0..40 {
        advance(&mut asked, 5.0e-4);
        advance(&mut plain, 5.0e-4);
        let found = ask(&mut asked, &outputs, "floor.displacement.z");
        assert!(found.iter().all(|part| part.is_finite()));
        assert!(ask(&mut asked, &outputs, "feed.rate").iter().all(|part| part.is_finite()));
        assert!(asked.state() == plain.state());
    }
    assert!(asked.state().particles.len() > 50, "they came");
    let pressed = ask(&mut asked, &outputs, "floor.displacement.z");
    assert!(pressed.iter().any(|part| *part != 0.0), "they press on the floor");
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
