//! Boundaries driven by velocity and along tables of files.

use crate::support::{assert_near, start, start_with};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;

/// The first boundary.
const FIRST: BoundaryIndex = BoundaryIndex(0);

/// A scene at time 0, with files.
fn start_beside(text: &str, files: &[(&str, &str)]) -> Simulation {
    let files = files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect();
    start_with(text, files)
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
    let mut simulation = start_beside(&lying(&format!("{DISC}{motion}")), &[("way.csv", file)]);
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

/// A belt's speed \[m/s\].
const BELT: f64 = 0.2;

/// Place and velocity of the spheres, and what the floor did to them \[J\], after a time \[s\].
fn carried(motion: &str, shape: &str, time: f64) -> (Vec<[f64; 4]>, f64) {
    let mut simulation = start(&lying(&format!("{shape}motion = {{ {motion} }}")));
    simulation.advance(time).expect("it runs");
    let state = simulation.state();
    let particles = &state.particles;
    let rows = [&particles.position, &particles.velocity, &particles.angular_velocity];
    (rows.into_iter().flatten().copied().collect(), state.boundaries[0].work)
}

#[test]
fn a_belt_carries_as_a_plane_does_that_moves_along_itself() {
    let (moving, work) = carried("prescribed = { x = 0.2, y = -0.1 }", PLANE, 0.01);
    for shape in [PLANE, DISC] {
        // What lies across the surface counts for nothing.
        for belt in ["conveying = { x = 0.2, y = -0.1 }", "conveying = { x = 0.2, y = -0.1, z = 0.7 }"] {
            let (carried, given) = carried(belt, shape, 0.01);
            assert_eq!(carried, moving, "{belt} on {shape}");
            assert_near(given, work, 1e-12);
        }
    }
}

#[test]
fn a_tilted_belt_of_features_is_the_belt_of_a_plane() {
    let at = |shape: &str, where_is: &str, more: &str, motion: &str| {
        let shape = format!("{shape} = {{ {where_is} = [0.0, 0.0, 0.0], normal = [-0.6, 0.0, 0.8]{more} }}\n");
        let text = lying(&format!("{shape}motion = {{ {motion} }}"));
        let list =
            "{ position = [0.0, 0.0, 0.0062], radius = 0.005 }, { position = [0.02, 0.0, 0.0212], radius = 0.005 }";
        let (before, after) = (text.find("list = [").expect("a list"), text.find("\n[boundary").expect("a boundary"));
        let mut simulation = start(&format!("{}list = [{list}]{}", &text[..before], &text[after..]));
        simulation.advance(0.02).expect("it runs");
        (simulation.state().particles.velocity.clone(), simulation.state().boundaries[0].work)
    };
    // The belt's direction is that of the surface: (0.3, 0.2, 0.1) less its part along the normal, −0.1 n.
    let (moving, expected) = at("plane", "point", "", "prescribed = { x = 0.24, y = 0.2, z = 0.18 }");
    for (shape, place, more) in [("plane", "point", ""), ("disc", "centre", ", radius = 0.5")] {
        let (carried, work) = at(shape, place, more, "conveying = { x = 0.3, y = 0.2, z = 0.1 }");
        for (one, other) in carried.iter().zip(&moving) {
            assert!((0..3).all(|axis| (one[axis] - other[axis]).abs() < 1e-10), "{shape}: {carried:?}, not {moving:?}");
        }
        assert_near(work, expected, 1e-9);
    }
}

#[test]
fn a_block_on_a_belt_slides_under_its_friction_until_it_has_the_speed_of_the_belt() {
    let block = "[boundary.block]\nparticles = { set = \"two\" }\nmotion = { free = [\"x\", \"z\"] }\n";
    let mut simulation = start(&lying(&format!("{PLANE}motion = {{ conveying = {{ x = {BELT} }} }}\n{block}")));
    let mass = simulation.state().particles.velocity.iter().map(|row| row[3]).sum::<f64>();
    let (friction, weight) = (0.5, 9.81 * mass);
    for _ in 0..3 {
        simulation.advance(0.01).expect("it runs");
        let [[along, _, up], time] = [simulation.state().boundaries[1].velocity, [simulation.time(); 3]];
        // The floor gave the impulse m (g t + v_z) upwards, and µ times that along the belt but for the first step.
        let expected = friction * (9.81 * time[0] + up);
        assert!((along - expected).abs() < friction * 9.81 * 1e-5, "{along} m/s, not {expected} m/s");
    }
    simulation.advance(0.27).expect("it runs");
    assert_near(simulation.state().boundaries[1].velocity[0], BELT, 1e-6);
    // Power: the motor gives force times speed, m v² in all, and half of it is lost in sliding.
    let work = simulation.state().boundaries[0].work;
    assert_near(work, mass * BELT * simulation.state().boundaries[1].velocity[0], 1e-12);
    // Each sphere fell by its overlap, and Hertz's spring holds two fifths of what its weight did.
    let modulus = 1.0e7 / (1.0 - 0.3 * 0.3) / 2.0;
    let overlap = (0.5 * weight / (4.0 / 3.0 * modulus * 0.005_f64.sqrt())).powf(2.0 / 3.0);
    let lost = 0.5 * mass * BELT * BELT + weight * overlap * 3.0 / 5.0;
    assert_near(simulation.dissipated_energy().expect("a book"), lost, 1e-6);
    let residual = simulation.energy_residual().expect("a book");
    assert!(residual.abs() <= 1e-12 * work, "{residual:e} J of {work:e} J");
}

#[test]
fn a_ball_on_a_belt_rolls_backwards_with_two_sevenths_of_its_speed() {
    // m v = J, 2/5 m R² ω = J a with the arm a = R − δ/2, and no slip once v + ω a is the belt's speed; δ/R = 1.70e-3.
    let (balls, _) = carried(&format!("conveying = {{ x = {BELT} }}"), PLANE, 0.2);
    let arm = 1.0 - 0.5 * 1.70e-3;
    let parts = [1.0, 2.5 * arm * arm].map(|part| part / (1.0 + 2.5 * arm * arm));
    assert_near(balls[2][0], BELT * parts[0], 1e-4);
    assert_near(-balls[4][1] * 0.005 * arm, BELT * parts[1], 1e-4);
}

/// A sphere that is held on a boundary of this shape and motion, with linear springs that never slide.
fn held(scheme: &str, boundary: &str) -> String {
    format!(
        r#"
[run]
step = 1e-4
scheme = "{scheme}"
max_overlap = 0.2
threads = 1
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
friction = 1e4
normal_stiffness = 1.0e3
tangential_stiffness = 500.0
normal_damping = 0.0
tangential_damping = 0.0
[contact.touch]
tangential_damping = false
[contact.touch.normal.hooke_stiffness]
[contact.touch.tangential.history]
[particles.one]
material = "a"
list = [{{ position = [0.1, 0.0, 0.0099], radius = 0.01 }}]
[boundary.a_floor]
material = "a"
{boundary}
[boundary.held]
particles = {{ ids = [1] }}
"#
    )
}

#[test]
fn a_tangential_spring_is_the_displacement_of_an_accelerated_boundary() {
    let trapezoid = "{ trapezoid = { distance = 1e-3, speed = 0.01, acceleration = 10.0 } }";
    let sine = "{ sine = { amplitude = 1e-3, frequency = 30.0, phase = 1.0 } }";
    let table = "{ table = { file = \"way.csv\", time = \"t\", column = \"u\" } }";
    let smooth = "{ table = { file = \"way.csv\", time = \"t\", column = \"u\", interpolation = \"smooth\" } }";
    for scheme in ["engine", "predicted_normal", "midway", "predicted"] {
        for (shape, motion) in
            [PLANE, DISC].into_iter().flat_map(|shape| [trapezoid, sine, table, smooth, "0.03"].map(|it| (shape, it)))
        {
            let text = held(scheme, &format!("{shape}motion = {{ prescribed = {{ x = {motion} }} }}"));
            let mut simulation =
                start_beside(&text, &[("way.csv", "t,u\n0,0\n0.0031,1e-4\n0.0072,-2e-4\n0.02,3e-4\n")]);
            for _ in 0..10 {
                simulation.advance(1.05e-3).expect("it runs");
                let moved = simulation.state().boundaries[0];
                // The spring pulls the surface back.
                let (way, spring) = (moved.displacement[0], -moved.force[0] / 500.0);
                assert!((spring - way).abs() < 1e-12, "{scheme}, {motion}: {spring:e} m, not {way:e} m");
            }
        }
    }
}

#[test]
fn a_tangential_spring_is_the_way_of_a_boundary_that_turns_faster_and_faster() {
    for scheme in ["engine", "predicted_normal", "midway", "predicted"] {
        for motion in [
            "prescribed = { rotation.z = { trapezoid = { distance = 1e-2, speed = 0.1, acceleration = 100.0 } } }",
            "prescribed = { rotation.z = { sine = { amplitude = 1e-2, frequency = 30.0 } } }",
            "prescribed = { rotation.z = 0.3 }",
        ] {
            let motion = motion.replace("rotation.z", "\"rotation.z\"");
            let mut simulation = start(&held(scheme, &format!("{DISC}motion = {{ {motion} }}")));
            simulation.advance(8.5e-3).expect("it runs");
            let moved = simulation.state().boundaries[0];
            // The point of contact stays at x = 0.1 m.
            let (way, spring) = (0.1 * moved.rotation[2], -moved.force[1] / 500.0);
            assert!(
                way.abs() > 1e-5 && (spring - way).abs() < 1e-7 * way.abs(),
                "{scheme}, {motion}: {spring:e} m, not {way:e} m"
            );
        }
    }
}

#[test]
fn a_ramped_velocity_moves_the_spring_as_it_moves_the_boundary() {
    let mut simulation = start(&held("midway", &format!("{PLANE}motion = {{ driven = [\"x\"], by = \"velocity\" }}")));
    for number in 0..20 {
        simulation.set_input(FIRST, 0, 0.01 * f64::from(number % 5) - 0.02);
        simulation.set_input_rate(FIRST, 0, 15.0);
        simulation.advance(6.7e-4).expect("it runs");
        let moved = simulation.state().boundaries[0];
        let (way, spring) = (moved.displacement[0], -moved.force[0] / 500.0);
        assert!((spring - way).abs() < 1e-15, "{spring:e} m, not {way:e} m");
    }
}
