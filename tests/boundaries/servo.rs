//! Servos reach a force: as fast as waves allow, without overshoot, gently at an impact, and they keep it.

use crate::support::{scene, start};
use cograin::quantity::BoundaryIndex;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::f64::consts::PI;

/// The plate with the servo: boundaries stand in the order of the text.
const PLATE: BoundaryIndex = BoundaryIndex(0);

/// Radius of the spheres of a block \[m\].
const RADIUS: f64 = 1e-3;

/// Layers of a block.
const LAYERS: f64 = 12.0;

/// Columns of a block.
const COLUMNS: f64 = 9.0;

/// Stiffness of a bond along its axis \[N/m\].
const BOND: f64 = 1e12 * PI * RADIUS * RADIUS;

/// Mass of a sphere \[kg\].
fn mass() -> f64 {
    4.0 / 3.0 * PI * RADIUS.powi(3) * 2500.0
}

/// The time that a wave takes through a block \[s\], and its impedance \[kg/s\]: of chains of masses and springs.
fn wave() -> (f64, f64) {
    (LAYERS * (mass() / BOND).sqrt(), COLUMNS * (BOND * mass()).sqrt())
}

/// A bonded block of three by three columns, glued to the floor, under a plate.
fn block(plate: &str, floor: &str, more: &str) -> String {
    format!(
        r#"
[run]
step = "auto"
threads = 1
[material.a]
youngs_modulus = 1.0e9
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
normal_stiffness = 3.0e6
normal_damping = 0.0
[contact.touch.normal.hooke_stiffness]
[particles.block]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.001, 0.001, 0.001], counts = [3, 3, 12], spacing = 2.0e-3, radius = 1.0e-3 }}
[bond.inside]
between = ["block", "block"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[bond.below]
between = ["block", "floor"]
create_distance = 2.1e-3
normal_stiffness = 1.0e12
tangential_stiffness = 4.0e11
[boundary.a_plate]
material = "a"
{plate}
[boundary.floor]
material = "a"
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
{floor}
{more}
"#
    )
}

/// Glues the plate to the block.
const GLUED: &str = "[bond.above]\nbetween = [\"block\", \"a_plate\"]\ncreate_distance = 2.1e-3\n\
                     normal_stiffness = 1.0e12\ntangential_stiffness = 4.0e11\n";

/// A plate at a height \[m\] with this servo.
fn plate(height: f64, target: f64, speed: f64) -> String {
    format!(
        "plane = {{ point = [0.0, 0.0, {height:?}], normal = [0.0, 0.0, -1.0] }}\n\
         motion = {{ servo = {{ z = {{ target = {target:?}, speed = {speed:?} }} }} }}"
    )
}

/// Force on the plate \[N\].
fn force(simulation: &Simulation) -> f64 {
    simulation.state().boundaries[0].force[2]
}

#[test]
fn a_bonded_block_has_its_force_in_ten_wave_times_without_overshoot() {
    let (time, _) = wave();
    for speed in [1.0, 2e-3] {
        let mut simulation = start(&block(&plate(0.024, 1.0, speed), "", GLUED));
        let (mut most, mut free) = (0.0_f64, None);
        for number in 0.. {
            simulation.advance(0.05 * time).expect("it runs");
            most = most.max(force(&simulation));
            let limited = simulation.state().boundaries[0].velocity[2].abs() >= speed * (1.0 - 1e-12);
            free = if limited { None } else { free.or(Some(number)) };
            if free.is_some_and(|since| number - since == 200) {
                break;
            }
            assert!(number < 4000, "the limit never lets go: {} N", force(&simulation));
        }
        let found = force(&simulation);
        assert!((found - 1.0).abs() < 0.01, "{found} N, not 1 N, with {speed} m/s at most");
        assert!(most < 1.05, "up to {most} N with {speed} m/s at most");
    }
}

/// Columns of spheres of radius 5 mm between four walls, under a plate at a height \[m\] with this servo.
fn bed(law: &str, plate: &str) -> String {
    let sides = [("x_low", [0.0, 0.0], [1, 0]), ("x_high", [0.04, 0.0], [-1, 0])];
    let sides = sides.into_iter().chain([("y_low", [0.0, 0.0], [0, 1]), ("y_high", [0.0, 0.04], [0, -1])]);
    let walls: String = sides
        .map(|(name, [x, y], [a, b])| {
            format!(
                "[boundary.{name}]\nmaterial = \"a\"\nplane = {{ point = [{x:?}, {y:?}, 0.0], normal = [{a}.0, {b}.0, 0.0] }}\n"
            )
        })
        .collect();
    format!(
        r#"
[run]
step = "auto"
threads = 1
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
normal_stiffness = 1.0e5
normal_damping = 0.0
{law}
[particles.bed]
material = "a"
lattice = {{ kind = "simple_cubic", origin = [0.005, 0.005, 0.005], counts = [4, 4, 6], spacing = 1.0e-2, radius = 5.0e-3 }}
[boundary.a_plate]
material = "a"
{plate}
[boundary.floor]
material = "a"
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
{walls}
"#
    )
}

/// Hertz's law with friction.
const HERTZ: &str = "[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n";

#[test]
fn a_dense_bed_has_its_force_in_ten_wave_times_without_overshoot() {
    let mut simulation = start(&bed(HERTZ, &plate(0.06, 20.0, 0.05)));
    let (mut most, mut free, part) = (0.0_f64, None, 1e-4);
    // Contacts at the final force: 20 N on 16 columns.
    let modulus = 1.0e7 / (2.0 * (1.0 - 0.3 * 0.3));
    let overlap = (0.75 * 20.0 / 16.0 / (modulus * 2.5e-3_f64.sqrt())).powf(2.0 / 3.0);
    let stiffness = 2.0 * modulus * (2.5e-3 * overlap).sqrt();
    let sphere = 4.0 / 3.0 * PI * 5e-3_f64.powi(3) * 2500.0;
    let time = 6.0 * (sphere / stiffness).sqrt();
    let count = (10.0 * time / part).ceil() as u32;
    for number in 0.. {
        simulation.advance(part).expect("it runs");
        most = most.max(force(&simulation));
        let limited = simulation.state().boundaries[0].velocity[2].abs() >= 0.05 * (1.0 - 1e-12);
        free = if limited { None } else { free.or(Some(number)) };
        if free.is_some_and(|since| number - since >= count) {
            break;
        }
        assert!(number < 20_000, "the limit never lets go: {} N", force(&simulation));
    }
    let found = force(&simulation);
    assert!((found / 20.0 - 1.0).abs() < 0.01, "{found} N, not 20 N, after ten times {time:e} s");
    assert!(most < 21.0, "up to {most} N");
}

#[test]
fn an_impact_from_a_gap_gives_no_more_than_the_impedance_times_the_speed_limit() {
    let (time, impedance) = wave();
    let speed = 0.01;
    // A target far below what the impact gives: the servo is to let go.
    let target = 0.01 * impedance * speed;
    let mut simulation = start(&block(&plate(0.024 + 1e-6, target, speed), "", ""));
    let mut most = 0.0_f64;
    for _ in 0..2000 {
        simulation.advance(0.02 * time).expect("it runs");
        most = most.max(force(&simulation));
    }
    assert!(most > target, "they met");
    assert!(most < 1.2 * impedance * speed, "{most} N, {} N by impedance and speed", impedance * speed);
}

#[test]
fn an_impact_on_a_dense_bed_gives_no_more_than_the_impedance_times_the_speed_limit() {
    // Linear springs: those of Hertz have no impedance until they are pressed.
    let (stiffness, sphere, speed) = (1.0e5, 4.0 / 3.0 * PI * 5e-3_f64.powi(3) * 2500.0, 0.01);
    let impedance = 16.0 * (stiffness * sphere).sqrt();
    let time = 6.0 * (sphere / stiffness).sqrt();
    let target = 0.01 * impedance * speed;
    let plate = plate(0.06 + 1e-6, target, speed);
    let mut simulation = start(&bed("[contact.touch.normal.hooke_stiffness]\n", &plate));
    let mut most = 0.0_f64;
    for _ in 0..1000 {
        simulation.advance(0.02 * time).expect("it runs");
        most = most.max(force(&simulation));
    }
    assert!(most > target, "they met: {most} N");
    assert!(most < 1.2 * impedance * speed, "{most} N, {} N by impedance and speed", impedance * speed);
}

/// Pressure of the plates on loose spheres \[Pa\].
const PRESSURE: f64 = 5.0e4;

/// Spheres of many sizes at random in a cube of 12 mm between four plates with servos, a floor and a lid that is driven by its velocity.
fn sand() -> String {
    let servo = |axis: &str, side: &str, point: f64, normal: [f64; 3]| {
        let target = if side == "low" { -1.0 } else { 1.0 } * PRESSURE * 0.012 * 0.012;
        format!(
            "[boundary.{axis}_{side}]\nmaterial = \"sand\"\nplane = {{ point = {:?}, normal = {normal:?} }}\n\
             motion = {{ servo = {{ {axis} = {{ target = {target:?}, speed = 0.03 }} }} }}\n",
            normal.map(|part| part.abs() * point)
        )
    };
    let plates = [
        servo("x", "low", 0.0, [1.0, 0.0, 0.0]),
        servo("x", "high", 0.012, [-1.0, 0.0, 0.0]),
        servo("y", "low", 0.0, [0.0, 1.0, 0.0]),
        servo("y", "high", 0.012, [0.0, -1.0, 0.0]),
    ];
    format!(
        r#"
[run]
step = 5e-6
seed = 3
threads = 1
[material.sand]
youngs_modulus = 2.0e7
poissons_ratio = 0.2
density = 2650.0
[pair.sand.sand]
restitution = 0.5
friction = 0.5
{HERTZ}
[particles.sand]
material = "sand"
[particles.sand.packing]
box = [[0.0, 0.0, 0.0], [0.012, 0.012, 0.012]]
solid_fraction = 0.56
radius = [0.8e-3, 1.2e-3]
{}
[boundary.z_low]
material = "sand"
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
[boundary.z_high]
material = "sand"
plane = {{ point = [0.0, 0.0, 0.012], normal = [0.0, 0.0, -1.0] }}
motion = {{ driven = ["z"], by = "velocity" }}
"#,
        plates.concat()
    )
}

#[test]
fn slow_shear_of_a_dense_bed_leaves_the_forces_within_half_a_percent() {
    let mut simulation = start(&sand());
    simulation.advance(0.04).expect("it runs");
    // A strain rate of 0.2 per second, with which inertia is of no account: ε̇ d √(ρ/p) = 1e-4.
    simulation.set_input(BoundaryIndex(5), 2, -0.2 * 0.012);
    let target = PRESSURE * 0.012 * 0.012;
    let (mut sums, count) = ([0.0; 4], 200);
    for _ in 0..count {
        simulation.advance(1e-3).expect("it runs");
        for (sum, moved) in sums.iter_mut().zip(&simulation.state().boundaries) {
            let [x, y, ..] = moved.force.map(f64::abs);
            *sum += (x.max(y) / target - 1.0).powi(2);
        }
    }
    let errors = sums.map(|sum| (sum / f64::from(count)).sqrt());
    let axial = simulation.state().boundaries[5].force[2] / target;
    assert!(axial > 1.3, "it is sheared: {axial}");
    assert!(errors.iter().all(|error| *error < 5e-3), "{errors:?}");
}

#[test]
fn slow_shear_leaves_the_force_within_half_a_percent() {
    let (time, _) = wave();
    let floor = "motion = { prescribed = { x = 1e-3 } }";
    let mut simulation = start(&block(&plate(0.024, 1.0, 0.1), floor, GLUED));
    simulation.advance(30.0 * time).expect("it runs");
    let (mut sum, count) = (0.0, 400);
    for _ in 0..count {
        simulation.advance(0.5 * time).expect("it runs");
        sum += (force(&simulation) - 1.0).powi(2);
    }
    let error = (sum / f64::from(count)).sqrt();
    assert!(error < 5e-3, "{error} N of 1 N");
}

#[test]
fn a_servo_follows_a_target_that_changes_and_goes_on_from_a_saved_state() {
    let text = block(&plate(0.024, 1.0, 0.1), "", GLUED);
    let (time, _) = wave();
    let go = |simulation: &mut Simulation, number: u32| {
        simulation.set_input(PLATE, 2, 1.0 + 0.1 * f64::from(number));
        simulation.set_input_rate(PLATE, 2, 0.1 / (5.0 * time));
        simulation.advance(5.0 * time).expect("it runs");
    };
    let mut first = start(&text);
    (0..6).for_each(|number| go(&mut first, number));
    let state = State::from_bytes(&first.state().to_bytes(0), 0).expect("its own bytes");
    let mut second = Simulation::resume(scene(&text), state).expect("its own state");
    (6..9).for_each(|number| {
        go(&mut first, number);
        go(&mut second, number);
    });
    assert!(first.state() == second.state(), "the same state");
    // What rises in the time of a wave to and fro, of which a servo with α = 0.7 misses about what it gains in (1 + α)/(2 α) of it.
    assert!((force(&first) - 1.9).abs() < 0.06, "{} N, not 1.9 N", force(&first));
    let moved = &first.state().boundaries[0];
    assert!(
        (moved.work - first.kinetic_energy() - first.elastic_energy()).abs() < 1e-3 * moved.work,
        "its work is in the block"
    );
}

/// A sphere on a floor, a gap below a plate with this servo.
fn sphere(modulus: f64, gap: f64, plate_law: (f64, f64), restitution: f64) -> String {
    let (target, speed) = plate_law;
    format!(
        r#"
[run]
step = "auto"
max_overlap = 0.4
threads = 1
[material.a]
youngs_modulus = {modulus:?}
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = {restitution:?}
[contact.touch.normal.hertz]
[particles.one]
material = "a"
list = [{{ position = [0.0, 0.0, 5.0e-3], radius = 5.0e-3 }}]
[boundary.a_plate]
material = "a"
{}
[boundary.floor]
material = "a"
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
"#,
        plate(0.01 + gap, target, speed)
    )
}

#[test]
fn a_servo_reaches_targets_over_six_decades_at_any_stiffness_and_speed() {
    let mass = 4.0 / 3.0 * PI * 5e-3_f64.powi(3) * 2500.0;
    for modulus in [1e5, 1e7, 1e9, 1e11] {
        let effective = modulus / (2.0 * (1.0 - 0.3 * 0.3));
        for (speed, target) in
            [1e-3, 0.1, 10.0].into_iter().flat_map(|speed| [1e-4, 1e-2, 1.0, 100.0].map(|it| (speed, it)))
        {
            let overlap = (0.75 * target / (effective * 5e-3_f64.sqrt())).powf(2.0 / 3.0);
            // Deeper than laws hold, or struck so hard that the sphere flies to and fro for long.
            if overlap > 0.05 * 5e-3 || speed > 0.2 * (modulus / 2500.0).sqrt() {
                continue;
            }
            // The gap and the way to the target, and ninety periods of the sphere there.
            let gap = 1e-4;
            let period = 2.0 * PI * (mass / (4.0 * effective * (5e-3 * overlap).sqrt())).sqrt();
            let time = 2.0 * (gap + 2.0 * overlap) / speed + 90.0 * period + 20.0 * gap / speed.min(1.0);
            let mut simulation = start(&sphere(modulus, gap, (target, speed), 0.5));
            simulation.advance(time).unwrap_or_else(|error| panic!("{error}"));
            simulation.advance(0.1 * time).unwrap_or_else(|error| panic!("{error}"));
            let moved = &simulation.state().boundaries[0];
            for found in [moved.force[2], moved.mean_force[2]] {
                assert!(
                    (found / target - 1.0).abs() < 0.01,
                    "{found} N, not {target} N, with {modulus:e} Pa and {speed} m/s after {time:e} s"
                );
            }
        }
    }
}

#[test]
fn a_servo_that_has_not_reached_its_target_is_remarked() {
    let mut simulation = start(&sphere(1e7, 1e-3, (1.0, 1e-3), 0.5));
    let remarks = |simulation: &Simulation| cograin::run::remarks(simulation.scene(), simulation).join("\n");
    assert!(!remarks(&simulation).contains("servo"), "{}", remarks(&simulation));
    simulation.advance(1e-2).expect("it runs");
    assert!(remarks(&simulation).contains("[boundary.a_plate] servo: "), "{}", remarks(&simulation));
    simulation.advance(3.0).expect("it runs");
    simulation.advance(1e-2).expect("it runs");
    assert!(!remarks(&simulation).contains("servo"), "{}", remarks(&simulation));
}
