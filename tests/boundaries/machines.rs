//! Boundaries that move with another one, as parts of one machine.

use crate::support::{checked, read, scene, start, value};
use cograin::interface::{Interface, Value};
use cograin::simulation::{Description, Simulation};

/// Spheres in a trough that swings about y and goes along z. `LEFT` and `RIGHT` stand for how its sides move, `FLOOR` for its floor.
const TROUGH: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1e-5
threads = 1
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.few]
material = "a"
list = [
    { position = [0.0049, 0.0, 0.0049], radius = 0.005 }, { position = [0.0151, 0.0, 0.0049], radius = 0.005 },
    { position = [0.0100, 0.0, 0.0136], radius = 0.005 },
]
[boundary.right]
material = "a"
rectangle = { corner = [0.02, -0.02, 0.0], edges = [[0.0, 0.04, 0.0], [0.0, 0.0, 0.03]] }
RIGHT
[boundary.floor]
material = "a"
rectangle = { corner = [-0.001, -0.02, 0.0], edges = [[0.022, 0.0, 0.0], [0.0, 0.04, 0.0]] }
reference = [0.01, 0.0, 0.0]
FLOOR
[boundary.left]
material = "a"
plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
LEFT
[output]
energy = true
"#;

/// The trough with a floor that moves so and sides that move with it.
fn with_floor(motion: &str) -> String {
    let with = "moves_with = \"floor\"";
    TROUGH.replace("FLOOR", motion).replace("LEFT", with).replace("RIGHT", with)
}

/// The same with sides that move so by themselves.
fn apart(motion: &str) -> String {
    let own = format!("reference = [0.01, 0.0, 0.0]\n{motion}");
    TROUGH.replace("FLOOR", motion).replace("LEFT", &own).replace("RIGHT", &own)
}

/// Gives inputs of these names.
fn give(simulation: &mut Simulation, inputs: &[(String, f64)]) {
    let interface = Interface::of(simulation.scene());
    for (name, value) in inputs {
        let index = interface.find(name).unwrap_or_else(|| panic!("no input {name}"));
        interface.set(simulation, index, Value::Real(*value)).expect("it is an input");
    }
}

/// A time step of the trough, in which the floor goes there.
fn step(simulation: &mut Simulation, number: i32, of: &[&str]) {
    let (lift, swing) = (1e-5 * f64::from(number), 0.02 * libm::sin(0.3 * f64::from(number)));
    let inputs =
        of.iter().flat_map(|name| [(format!("{name}.displacement.z"), lift), (format!("{name}.rotation.y"), swing)]);
    give(simulation, &inputs.collect::<Vec<_>>());
    simulation.advance(1e-3).expect("it runs");
}

#[test]
fn parts_move_to_the_bit_as_if_each_had_the_motion_of_the_machine() {
    let prescribed =
        "motion = { prescribed = { z = 0.02, \"rotation.y\" = { sine = { amplitude = 0.05, frequency = 20.0 } } } }";
    let driven = "motion = { driven = [\"z\", \"rotation.y\"] }\ninput = \"smooth\"";
    for motion in [prescribed, driven] {
        let [mut together, mut each] = [with_floor(motion), apart(motion)].map(|text| start(&text));
        for number in 1..=20 {
            if motion == driven {
                step(&mut together, number, &["floor"]);
                step(&mut each, number, &["floor", "left", "right"]);
            } else {
                together.advance(1e-3).expect("it runs");
                each.advance(1e-3).expect("it runs");
            }
        }
        let [together, each] = [together, each].map(|simulation| simulation.state().clone());
        assert!(together.boundaries[2].displacement != [0.0; 3] && together.boundaries[0].work != 0.0);
        assert_eq!(together.boundaries, each.boundaries, "{motion}");
        assert_eq!(together.particles.position, each.particles.position, "{motion}");
    }
}

#[test]
fn each_part_has_its_own_force_and_work_and_the_books_close() {
    let mut simulation = start(&with_floor("motion = { driven = [\"z\", \"rotation.y\"] }"));
    let parts = ["floor", "left", "right"];
    let mut moved = 0.0;
    for number in 1..=40 {
        let before = simulation.state().boundaries.clone();
        step(&mut simulation, number, &["floor"]);
        for (place, now) in simulation.state().boundaries.iter().enumerate() {
            // Of what the impulses that cross it do: change of work = −F̄·Δu − M̄·Δφ.
            let way = now.displacement[2] - before[place].displacement[2];
            let turn = now.rotation[1] - before[place].rotation[1];
            let expected = -now.mean_force[2] * way - now.mean_moment[1] * turn;
            let found = now.work - before[place].work;
            assert!((found - expected).abs() < 1e-12 * now.work.abs().max(1e-6), "{found:e}, {expected:e} J");
            moved += found.abs();
        }
    }
    assert!(moved > 1e-5, "{moved:e} J");
    let residual = simulation.energy_residual().expect("a book");
    assert!(residual.abs() < 1e-12 * moved.max(1e-3), "{residual:e} J");
    let works = parts.map(|name| value(&simulation, &format!("{name}.work")));
    assert!(works.iter().all(|work| *work != 0.0) && works[0] != works[1], "{works:?}");
}

#[test]
fn a_part_shows_where_it_is_and_takes_no_input() {
    let scene = checked(&with_floor("motion = { driven = [\"z\", \"rotation.y\"] }"));
    let interface = Interface::of(&scene);
    let inputs: Vec<_> = interface.inputs().map(|(_, variable)| variable.name.as_str()).collect();
    assert_eq!(inputs, ["floor.displacement.z", "floor.rotation.y"]);
    assert!(interface.find("left.displacement.z").is_some() && interface.find("right.moment.y").is_some());
    let by_rate = checked(&with_floor("motion = { driven = [\"z\"], by = \"velocity\" }"));
    assert_eq!(Interface::of(&by_rate).inputs().count(), 1);
}

#[test]
fn a_part_that_a_later_scene_brings_stands_where_its_machine_has_come_to() {
    let motion = "motion = { prescribed = { z = 0.5 } }";
    let mut first = start(&with_floor(motion).replace("[boundary.left]", "[boundary.other]"));
    first.advance(2e-3).expect("it runs");
    let from = Description::of(first.scene(), "first.toml", first.time());
    let (second, _) = Simulation::taken_over(scene(&with_floor(motion)), first.state(), &from).expect("it goes on");
    let [right, floor, left] = &second.state().boundaries[..] else { panic!("three boundaries") };
    assert_eq!([right.displacement, left.displacement], [floor.displacement; 2]);
    assert!((floor.displacement[2] - 1e-3).abs() < 1e-15);
}

#[test]
fn a_draft_whose_part_moves_otherwise_is_refused() {
    let scene = checked(&with_floor("motion = { prescribed = { z = 0.5 } }"));
    let mut draft = cograin::scene::SceneDraft::clone(&scene);
    draft.boundaries[0].reference[0] += 1.0;
    let message = draft.build().unwrap_err().to_string();
    assert!(
        message.contains("[boundary.right] moves_with: expected its axes, input and point of reference"),
        "{message}"
    );
    assert!(read(&with_floor("motion = \"fixed\"")).is_err());
}
