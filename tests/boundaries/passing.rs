//! Nothing passes through a boundary unseen: whatever the shape, whoever moves, at whatever speed, a grain is turned back, or the
//! time step is refused. With `outside = "remove"` it is taken away and counted.

use crate::support::{Files, read, read_with, start_with};
use cograin::interface::{Interface, Value};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::{RunError, Simulation};

/// Shapes with a surface at x = 0, the front to positive x, by the key under which a scene writes each.
const WALLS: [(&str, &str); 13] = [
    ("plane", "plane = { point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }"),
    ("disc", "disc = { centre = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0], radius = 0.05 }"),
    ("disc", "disc = { centre = [0.0, 0.0, 0.0], normal = [-1.0, 0.0, 0.0], radius = 0.05, hole = 0.0004 }"),
    ("rectangle", "rectangle = { corner = [0.0, -0.05, -0.05], edges = [[0.0, 0.1, 0.0], [0.0, 0.0, 0.1]] }"),
    ("cylinder", "cylinder = { from = [-0.05, -0.05, 0.0], to = [-0.05, 0.05, 0.0], radius = 0.05 }"),
    ("cylinder", "cylinder = { from = [-0.05, 0.0, 0.0], to = [0.0, 0.0, 0.0], radius = 0.05, caps = \"to\" }"),
    ("cylinder", "cylinder = { from = [-0.05, -0.05, 0.0], to = [-0.05, 0.05, 0.0], radius = 0.05, infinite = true }"),
    ("cone", "cone = { from = [-0.05, 0.0, 0.0], to = [0.0, 0.0, 0.0], radii = [0.01, 0.05], caps = \"to\" }"),
    (
        "revolution",
        "revolution = { origin = [0.0, 0.0, 0.0], axis = [1.0, 0.0, 0.0], profile = [[0.0, 0.0], [0.002, 0.0], [0.0031, 0.0], [0.05, 0.0]] }",
    ),
    ("mesh", "mesh = { file = \"wall.obj\" }"),
    ("mesh", "mesh = { file = \"wall.obj\", sides = 1 }"),
    ("mesh", "mesh = { file = \"box.obj\" }"),
    ("particles", "particles = { set = \"sheet\" }"),
];

/// A square of 0.1 m at x = 0 of four triangles that meet in its middle; as one that `closes`, five others behind it.
fn obj(closes: bool) -> Vec<u8> {
    let mut text = String::new();
    for x in [0.0, -0.05] {
        text += &format!("v {x} -0.05 -0.05\nv {x} 0.05 -0.05\nv {x} 0.05 0.05\nv {x} -0.05 0.05\nv {x} 0.0 0.0\n");
    }
    for (a, b) in [(1, 2), (2, 3), (3, 4), (4, 1)] {
        text += &format!("f {a} {b} 5\n");
        if closes {
            text += &format!("f {} {} 10\nf {b} {a} {}\nf {b} {} {}\n", b + 5, a + 5, a + 5, a + 5, b + 5);
        }
    }
    text.into_bytes()
}

/// The files that walls name.
fn files() -> Files {
    Files::from([("wall.obj".to_owned(), obj(false)), ("box.obj".to_owned(), obj(true))])
}

/// A sheet of spheres that touch each other.
fn sheet() -> String {
    let places = (0..15).flat_map(|i| (0..15).map(move |j| (f64::from(i) - 7.0, f64::from(j) - 7.0)));
    let spheres: Vec<String> =
        places.map(|(i, j)| format!("{{ position = [0.0, {:?}, {:?}], radius = 1e-3 }}", 2e-3 * i, 2e-3 * j)).collect();
    format!("[particles.sheet]\nmaterial = \"g\"\nlist = [{}]\n", spheres.join(", "))
}

/// A grain in front of a wall.
fn scene((key, wall): (&str, &str), [x, y]: [f64; 2], velocity: f64, motion: &str, step: &str) -> String {
    let strict = if step == "\"auto\"" { "" } else { "strict_step = true\n" };
    let (sheet, material) = if key == "particles" { (sheet(), "") } else { (String::new(), "material = \"g\"\n") };
    format!(
        r#"
[run]
step = {step}
{strict}threads = 1
[material.g]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.g.g]
restitution = 0.9
friction = 0.3
[contact.c.normal.hertz]
[contact.c.tangential.history]
[particles.grain]
material = "g"
list = [{{ position = [{x:?}, {y:?}, 0.0007], radius = 1e-3, velocity = [{velocity:?}, 0.0, 0.0] }}]
{sheet}
[boundary.w]
{material}{wall}
{motion}
[output]
energy = true
losses = true
"#
    )
}

/// How the motion of a wall towards the grain is written.
const MOTIONS: [&str; 4] = [
    "",
    "motion = { prescribed = { x = SPEED } }",
    "motion = { driven = [\"x\"] }",
    "motion = { driven = [\"x\"] }\ninput = \"hold\"",
];

/// Whether a wall comes to where it is by a way: a group that jumps is put there.
fn has_a_way((key, _): (&str, &str), motion: &str) -> bool {
    key != "particles" || !motion.contains("hold")
}

/// Runs it for 1 ms; a wall that is driven goes at this speed \[m/s\].
fn run(simulation: &mut Simulation, speed: f64) -> Result<(), RunError> {
    for part in 1..=10 {
        if simulation.scene().boundaries[0].axes[0].is_driven() {
            simulation.set_input(BoundaryIndex(0), 0, speed * 1e-4 * f64::from(part));
        }
        simulation.advance(1e-4)?;
    }
    Ok(())
}

/// Where the grain is before the wall \[m\].
fn before(simulation: &Simulation) -> f64 {
    let state = simulation.state();
    state.particles.position[state.particles.slot[0] as usize][0] - state.boundaries[0].displacement[0]
}

#[test]
fn every_shape_that_a_scene_can_name_has_a_wall_here() {
    let refused = read("[run]\n[boundary.w]\n").unwrap_err();
    let list = refused.split("[boundary.w]").nth(1).unwrap_or_default().split(" gives its shape").next().unwrap();
    let mut named: Vec<&str> =
        list.match_indices(" = {").map(|(at, _)| list[..at].rsplit([' ', ',']).next().unwrap()).collect();
    let mut here: Vec<&str> = WALLS.iter().map(|(key, _)| *key).collect();
    here.dedup();
    named.sort_unstable();
    here.sort_unstable();
    here.dedup();
    assert_eq!(named, here, "{refused}");
}

#[test]
fn a_grain_is_turned_back_by_any_wall_at_any_speed_or_the_time_step_is_refused() {
    let (mut turned, mut refused) = (0, 0);
    for wall in WALLS {
        for motion in MOTIONS.into_iter().filter(|motion| has_a_way(wall, motion)) {
            for speed in [0.3, 3.0, 30.0, 60.0, 90.0, 150.0, 400.0, 1e3, 1e4] {
                for y in [0.0, 0.0023] {
                    let velocity = if motion.is_empty() { -speed } else { 0.0 };
                    let motion = motion.replace("SPEED", &format!("{speed:?}"));
                    let text = scene(wall, [0.0041, y], velocity, &motion, "1e-6");
                    let mut simulation = start_with(&text, files());
                    match run(&mut simulation, speed) {
                        Err(error) => {
                            let words = error.to_string();
                            assert!(
                                ["went through", "would move", "overlap by", "above the stable one"]
                                    .iter()
                                    .any(|word| words.contains(word)),
                                "{words}"
                            );
                            refused += 1;
                        }
                        Ok(()) => {
                            let left = before(&simulation);
                            assert!(left > 0.0, "it is {left} m before the wall\n{text}");
                            turned += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(turned > 200 && refused > 200, "{turned} turned back, {refused} refused");
}

#[test]
fn a_wall_that_goes_over_a_grain_in_one_time_step_is_refused_and_one_that_goes_past_it_is_not() {
    for wall in WALLS {
        for motion in MOTIONS[2..].iter().filter(|motion| has_a_way(wall, motion)) {
            // In one communication step to beyond the grain; the same with the grain out of the way.
            let text = |y: f64| scene(wall, [0.0051, y], 0.0, motion, "1e-5");
            let gone = |y: f64| {
                let mut simulation = start_with(&text(y), files());
                simulation.set_input(BoundaryIndex(0), 0, 0.0203);
                simulation.advance(1e-5)
            };
            let error = gone(0.0031).expect_err(wall.1).to_string();
            assert!(error.contains("went through boundary w"), "{error}");
            if wall.0 != "plane" && !wall.1.contains("infinite") {
                gone(0.2).unwrap_or_else(|error| panic!("{error}: {}", wall.1));
            }
        }
    }
}

#[test]
fn a_rim_that_goes_over_a_grain_beside_its_centre_is_refused() {
    // The disc ends at y = 50 mm, the sheet of spheres at 15 mm.
    for (wall, y) in [(WALLS[1], 0.0505), (WALLS[3], 0.0505), (WALLS[9], 0.0505), (WALLS[12], 0.0157)] {
        let text = |y: f64| scene(wall, [0.0051, y], 0.0, MOTIONS[2], "1e-5");
        let mut simulation = start_with(&text(y), files());
        simulation.set_input(BoundaryIndex(0), 0, 0.0203);
        let error = simulation.advance(1e-5).expect_err(wall.1).to_string();
        assert!(error.contains("went through boundary w") && error.contains("too fast for a time step"), "{error}");
    }
}

#[test]
fn what_comes_out_of_a_mesh_with_one_side_from_behind_is_refused() {
    let mut simulation = start_with(&scene(WALLS[10], [-0.0005, 0.0], 3.0, "", "1e-6"), files());
    let error = run(&mut simulation, 0.0).unwrap_err().to_string();
    assert!(error.contains("went through boundary w"), "{error}");
}

#[test]
fn a_node_that_jumps_over_a_grain_is_refused() {
    for input in ["ramp", "hold"] {
        let motion = format!("nodes = \"driven\"\ninput = \"{input}\"");
        for wall in [WALLS[9], WALLS[10]] {
            let mut simulation = start_with(&scene(wall, [0.0051, 0.0013], 0.0, &motion, "1e-5"), files());
            // The vertex in the middle.
            let middle = simulation.scene().boundaries[0].shape.vertices().iter().position(|it| it.y == 0.0).unwrap();
            simulation.set_node(BoundaryIndex(0), (middle, 0), 0.0203);
            let error = simulation.advance(1e-5).expect_err(wall.1).to_string();
            assert!(error.contains("went through boundary w"), "{error}");
        }
    }
}

#[test]
fn a_drum_that_turns_far_in_one_time_step_does_not_sweep_over_grains() {
    let blade = "rectangle = { corner = [-0.05, 0.0, -0.05], edges = [[0.1, 0.0, 0.0], [0.0, 0.0, 0.1]] }\n\
                 reference = [0.0, 0.0, 0.0]";
    let text = scene(("rectangle", blade), [0.02, 0.004], 0.0, "motion = { driven = [\"rotation.z\"] }", "1e-5");
    let mut simulation = start_with(&text, files());
    simulation.set_input(BoundaryIndex(0), 5, 0.5);
    let error = simulation.advance(1e-5).unwrap_err().to_string();
    assert!(error.contains("went through boundary w"), "{error}");
}

/// The same scene in which the wall takes away what came through.
fn removing(wall: (&str, &str), speed: f64, step: &str) -> String {
    scene(wall, [0.0041, 0.0023], -speed, "outside = \"remove\"", step)
}

#[test]
fn what_comes_through_is_taken_away_where_the_scene_says_so_and_the_books_close() {
    for wall in WALLS.into_iter().filter(|(key, _)| *key != "particles") {
        let mut simulation = start_with(&removing(wall, 60.0, "1e-7"), files());
        let kinetic = simulation.kinetic_energy();
        run(&mut simulation, 0.0).unwrap_or_else(|error| panic!("{error}: {}", wall.1));
        assert_eq!(simulation.state().particles.len(), 0, "{}", wall.1);
        let interface = Interface::of(simulation.scene());
        let read =
            |name: &str| interface.value(&simulation, interface.find(name).unwrap_or_else(|| panic!("no {name}")));
        assert_eq!(read("w.outside.count"), Value::Integer(1), "{}", wall.1);
        let Value::Real(mass) = read("w.outside.mass") else { panic!("a mass is a real number") };
        let expected = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;
        assert!((mass - expected).abs() < 1e-12 * expected, "{mass} kg");
        let algorithmic = simulation.energy_residual().expect("a book is kept").abs();
        assert!(algorithmic < 1e-12 * kinetic, "{algorithmic:e} J of {kinetic:e} J: {}", wall.1);
        // What goes has its velocity in the middle of a time step: its contact is booked to half of what it does in one. The force at
        // an overlap of the radius is 4/3 E* R² N.
        let force = 4.0 / 3.0 * 1e7 / (2.0 * (1.0 - 0.25 * 0.25)) * 1e-6;
        let physical = simulation.physical_residual().expect("a book is kept").abs();
        assert!(physical < force * 60.0 * 1e-7, "{physical:e} J of {kinetic:e} J: {}", wall.1);
    }
}

#[test]
fn without_a_word_the_run_stops_and_a_group_takes_nothing_away() {
    let stops = removing(WALLS[1], 60.0, "1e-7").replace("\"remove\"", "\"stop\"");
    assert!(run(&mut start_with(&stops, files()), 0.0).unwrap_err().to_string().contains("went through boundary w"));
    let refused = read_with(&removing(WALLS[12], 60.0, "1e-7"), files()).unwrap_err();
    let expected = "outside: expected a surface, or \"stop\", found \"remove\" at a group of particles";
    assert!(refused.contains(expected), "{refused}");
}

#[test]
fn what_a_saved_state_does_not_take_away_a_restored_one_does() {
    let text = removing(WALLS[10], 60.0, "1e-7");
    let mut simulation = start_with(&text, files());
    simulation.advance(5e-5).unwrap();
    let bytes = simulation.state().to_bytes(0);
    simulation.advance(1e-4).unwrap();
    let mut other = start_with(&text, files());
    other.restore(&cograin::state::State::from_bytes(&bytes, 0).unwrap()).unwrap();
    other.advance(1e-4).unwrap();
    assert_eq!(simulation.state().to_bytes(0), other.state().to_bytes(0));
    assert_eq!(other.state().particles.len(), 0);
}
