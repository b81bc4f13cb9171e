//! Boundaries driven by velocity and along tables of files.

use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::step::Simulation;
use std::sync::Arc;

/// The first boundary.
const FIRST: BoundaryIndex = BoundaryIndex(0);

/// A scene at time 0, with files.
fn start_with(text: &str, files: &[(&str, &str)]) -> Simulation {
    let files = files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect();
    let source = Source { name: "scene.toml".into(), text: text.into(), files };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
    Simulation::new(Arc::new(scene)).unwrap_or_else(|error| panic!("{error}"))
}

/// The same without files.
fn start(text: &str) -> Simulation {
    start_with(text, &[])
}

/// Two spheres that lie on a boundary of this shape and motion.
fn lying(boundary: &str) -> String {
    format!(
        r#"
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
[particles.two]
material = "a"
list = [{{ position = [0.0, 0.0, 0.005], radius = 0.005 }}, {{ position = [0.02, 0.0, 0.005], radius = 0.005 }}]
[boundary.floor]
material = "a"
{boundary}
[output]
energy = true
"#
    )
}

/// A plane.
const PLANE: &str = "plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";

/// A disc.
const DISC: &str = "disc = { centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.5 }\n";

/// Fails unless two numbers agree within a share of the second.
#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e}, not {expected:e}");
}

#[test]
fn driven_by_velocity_is_driven_by_the_displacement_that_it_makes() {
    for shape in [PLANE, DISC] {
        let mut by_place = start(&lying(&format!("{shape}motion = {{ driven = [\"x\", \"z\"] }}")));
        let mut by_rate = start(&lying(&format!("{shape}motion = {{ driven = [\"x\", \"z\"], by = \"velocity\" }}")));
        let (mut place, length) = (0.0, 3.3e-4);
        for number in 0..30 {
            let velocity = 0.05 * f64::from(number % 4) - 0.06;
            let rate = if number % 3 == 0 { 20.0 } else { 0.0 };
            place += (velocity + 0.5 * rate * length) * length;
            by_rate.set_input(FIRST, 2, velocity);
            by_rate.set_input_rate(FIRST, 2, rate);
            by_place.set_input(FIRST, 2, place);
            by_rate.advance(length).expect("it runs");
            by_place.advance(length).expect("it runs");
            let [a, b] = [&by_rate, &by_place].map(|simulation| simulation.state().boundaries[0]);
            assert!((a.displacement[2] - place).abs() < 1e-16, "{:e} m, not {place:e} m", a.displacement[2]);
            assert!((a.force[2] - b.force[2]).abs() < 1e-9, "{} N and {} N", a.force[2], b.force[2]);
        }
        let [a, b] = [&by_rate, &by_place].map(|simulation| simulation.state().boundaries[0].work);
        assert_near(a, b, 1e-9);
    }
}

#[test]
fn driven_by_angular_velocity_turns_by_its_mean_and_counts_turns() {
    let mut simulation = start(&lying(&format!("{DISC}motion = {{ driven = [\"rotation.z\"], by = \"velocity\" }}")));
    for _ in 0..5 {
        simulation.set_input(FIRST, 5, 2000.0);
        simulation.set_input_rate(FIRST, 5, 1e5);
        simulation.advance(1e-3).expect("it runs");
    }
    // (2000 + ½ 1e5 · 1e-3) · 5e-3
    assert_near(simulation.state().boundaries[0].rotation[2], 10.25, 1e-13);
    let text = lying(&format!("{DISC}motion = {{ driven = [\"rotation.x\", \"rotation.y\"], by = \"velocity\" }}"));
    let mut simulation = start(&text);
    simulation.set_input(FIRST, 3, 3.0);
    simulation.set_input(FIRST, 4, -4.0);
    simulation.advance(1e-3).expect("it runs");
    let moved = simulation.state().boundaries[0];
    assert_near(moved.rotation[0], 3e-3, 1e-12);
    assert_near(moved.rotation[1], -4e-3, 1e-12);
}

#[test]
fn a_table_moves_a_boundary_as_the_file_says() {
    let motion = "motion = { prescribed = { x = { table = \"way.csv\" }, \"rotation.z\" = { table = { file = \"way.csv\", \
                  time = \"t\", column = \"angle\", interpolation = \"smooth\" } } } }";
    let file = "time, t, x, angle\n0.0, 0.0, 0.0, 0.0\n0.001, 0.001, 0.01, 0.5\n0.003, 0.002, 0.0, 0.0\n";
    let mut simulation = start_with(&lying(&format!("{DISC}{motion}")), &[("way.csv", file)]);
    simulation.advance(5e-4).expect("it runs");
    let moved = simulation.state().boundaries[0];
    assert_near(moved.displacement[0], 0.005, 1e-12);
    assert_near(moved.velocity[0], 10.0, 1e-12);
    assert_near(moved.rotation[2], 0.25, 1e-12);
    simulation.advance(1.5e-3).expect("it runs");
    assert_near(simulation.state().boundaries[0].displacement[0], 0.005, 1e-12);
    simulation.advance(2e-3).expect("it runs");
    let moved = simulation.state().boundaries[0];
    assert_eq!((moved.displacement[0], moved.velocity[0], moved.rotation[2]), (0.0, 0.0, 0.0), "it stays at its end");
}
