//! Servos of a cell reach and hold their stresses.

use super::scenes::{ROUGH, SMOOTH, cube, dense, gas, lattice, scene};
use crate::support::{assert_all_near, cell, spheres, start};
use cograin::simulation::Simulation;

#[test]
fn the_automatic_step_follows_the_largest_rates_of_servos() {
    // In a step in which nothing goes farther than a tenth of a radius strains would change by 0.08.
    let each = ["xx", "yy", "zz"].map(|axis| format!("{axis} = {{ stress = -1e4, max_rate = 500.0 }}")).join(", ");
    let text = lattice("sc", [3, 3, 3], 2.1e-3, 1e-3, &format!("motion = {{ servo = {{ {each} }} }}"));
    let mut simulation = start(&text.replace("step = 1e-5", "step = \"auto\""));
    simulation.advance(2e-4).unwrap();
    assert!(simulation.state().clock.last_step <= 0.05 / 1500.0, "{}", simulation.state().clock.last_step);
}

#[test]
fn a_servo_reaches_its_stress() {
    let more = "motion = { servo = { xx = { stress = -2e4, max_rate = 5.0 }, yy = { stress = -2e4, max_rate = 5.0 }, \
                zz = { stress = -4e4, max_rate = 5.0 } } }";
    let mut simulation = start(&damped(&dense(ROUGH, more)));
    simulation.advance(0.15).unwrap();
    let stress = simulation.cell_stress();
    assert_all_near(&stress[..3], &[-2e4, -2e4, -4e4], 0.02, "stress");
}

fn damped(text: &str) -> String {
    let damping =
        "[damping.all]\nlinear = 0.3\nangular = 0.3\ngravity_damped = false\napplied_forces_damped = false\n[run]";
    text.replace("[run]", damping)
}

#[test]
fn a_stress_of_zero_is_reached_where_it_is_small_beside_the_others() {
    let each = ["xx", "yy", "zz"].map(|axis| format!("{axis} = {{ stress = -2e4, max_rate = 5.0 }}")).join(", ");
    let more = format!("motion = {{ servo = {{ {each}, xz = {{ stress = 0.0, max_rate = 5.0 }} }} }}");
    let mut simulation = start(&damped(&dense(ROUGH, &more)));
    simulation.advance(0.3).unwrap();
    simulation.advance(1e-2).unwrap();
    assert!(simulation.state().cell.as_ref().unwrap().mean_stress[4] != 0.0, "rounding is left");
    let told = cograin::run::remarks(simulation.scene(), &simulation);
    assert!(!told.iter().any(|remark| remark.starts_with("[cell] servo: ")), "{told:?}");
}

/// Grains in a cell that moves so.
fn sand(more: &str, motion: &str) -> String {
    let text = scene(ROUGH[0], "restitution = 0.5\nfriction = 0.5", &cell(cube(0.0116), ""));
    let text = text.replace("step = 1e-5\n", more).replace("youngs_modulus = 1e7", "youngs_modulus = 3e8");
    let sand =
        "[particles.sand]\nmaterial = \"glass\"\npacking = { solid_fraction = 0.58, radius = [0.8e-3, 1.2e-3] }\n";
    format!("{text}{motion}\n{sand}")
}

/// Grains between sides that are held at 100 kPa, in a cell that is driven along z.
fn triaxial(more: &str) -> Simulation {
    let side = "{ stress = -1e5, max_rate = 20.0 }";
    start(&sand(more, &format!("motion = {{ driven = [\"zz\"], servo = {{ xx = {side}, yy = {side} }} }}")))
}

#[test]
fn a_servo_holds_its_stress_while_the_cell_is_driven() {
    // An inertial number γ̇ d √(ρ/p) of 1e-3.
    let rate = 1e-3 / 2e-3 * (1e5_f64 / 2500.0).sqrt();
    let (mut simulation, interval) = (triaxial(""), 0.002 / rate);
    let mut sum = [0.0; 2];
    for step in 1..=40 {
        simulation.set_strain(2, -0.002 * f64::from(step));
        simulation.advance(interval).unwrap();
        let cell = simulation.state().cell.as_ref().unwrap();
        if step > 20 {
            (0..2).for_each(|k| sum[k] += cell.mean_stress[k] / 20.0);
        }
    }
    assert_all_near(&sum, &[-1e5; 2], 2e-3, "stress");
    let interface = cograin::interface::Interface::of(simulation.scene());
    let found = interface.value(&simulation, interface.find("cell.servo_error.yy").unwrap());
    let expected = -1e5 - simulation.cell_stress()[1];
    assert_eq!(found, cograin::interface::Value::Real(expected));
}

#[test]
fn servos_hold_the_mean_stress_while_the_cell_is_pressed_at_a_constant_rate() {
    let rate = 1e-3 / 2e-3 * (1e5_f64 / 2500.0).sqrt();
    let side = "{ mean_stress = -1e5, max_rate = 20.0 }";
    let motion = format!("motion = {{ prescribed = {{ zz = {:?} }}, servo = {{ xx = {side}, yy = {side} }} }}", -rate);
    let mut simulation = start(&sand("", &motion));
    let (interval, mut sum) = (0.002 / rate, [0.0; 3]);
    for step in 1..=40 {
        simulation.advance(interval).unwrap();
        let cell = simulation.state().cell.as_ref().unwrap();
        assert_all_near(&[cell.strain[2]], &[-0.002 * f64::from(step)], 1e-12, "strain");
        if step > 20 {
            (0..3).for_each(|k| sum[k] += cell.mean_stress[k] / 20.0);
        }
    }
    let [x, y, z] = sum;
    assert!(((x + y + z) / 3.0 + 1e5).abs() < 2e-3 * 1e5, "{sum:?}");
    // Both sides have the same, and the axis bears more.
    assert!((x - y).abs() < 4e-3 * 1e5 && z < 1.2 * x, "{sum:?}");
    let interface = cograin::interface::Interface::of(simulation.scene());
    let found = interface.value(&simulation, interface.find("cell.servo_error.yy").unwrap());
    let expected = -1e5 - simulation.cell_stress()[..3].iter().sum::<f64>() / 3.0;
    assert_eq!(found, cograin::interface::Value::Real(expected));
    assert!(
        interface.find("cell.strain.zz").is_some() && interface.inputs().count() == 2,
        "a prescribed strain is an output"
    );
}

#[test]
fn a_servo_goes_on_with_the_same_bits_from_a_saved_state_and_for_any_threads() {
    let run = |threads: usize, kept: bool| {
        let more = format!("threads = {threads}\n");
        let mut simulation = triaxial(&more);
        for step in 1..=6 {
            simulation.set_strain(2, -0.002 * f64::from(step));
            simulation.advance(4e-4).unwrap();
            if kept && step == 3 {
                let state = simulation.state().clone();
                simulation = triaxial(&more);
                simulation.restore(&state).unwrap();
            }
        }
        assert!(simulation.state().cell.as_ref().unwrap().held_rate[0] != 0.0);
        simulation.state().clone()
    };
    let first = run(1, false);
    assert!(run(2, false) == first && run(1, true) == first);
}

#[test]
fn servos_hold_the_pressure_of_a_gas() {
    let each = ["xx", "yy", "zz"].map(|axis| format!("{axis} = {{ stress = -200.0, max_rate = 5.0 }}")).join(", ");
    let [law, pair] = SMOOTH;
    let text = scene(
        law,
        pair,
        &(spheres(&gas(125, 0.1, 2.0)) + &cell(cube(0.1), &format!("motion = {{ servo = {{ {each} }} }}"))),
    );
    let mut simulation = start(&text.replace("step = 1e-5\n", ""));
    simulation.advance(0.5).unwrap();
    simulation.advance(1.0).unwrap();
    let cell = simulation.state().cell.as_ref().unwrap();
    // It fluctuates with the few collisions.
    assert_all_near(&cell.mean_stress[..3], &[-200.0; 3], 0.03, "pressure");
}

#[test]
fn a_stress_that_a_servo_does_not_reach_is_remarked() {
    let remarked = |stress: &str| {
        let more = format!("motion = {{ servo = {{ yy = {{ stress = {stress}, max_rate = 5.0 }} }} }}");
        let mut simulation = start(&dense(ROUGH, &more));
        simulation.advance(1e-3).unwrap();
        simulation.advance(1e-3).unwrap();
        let told = cograin::run::remarks(simulation.scene(), &simulation);
        told.into_iter().find(|remark| remark.starts_with("[cell] servo: "))
    };
    // Grains that do not stick bear no tension.
    let told = remarked("1e4").unwrap();
    assert!(told.starts_with("[cell] servo: yy has ") && told.ends_with(", to be 1.0000e4 Pa"), "{told}");
    assert!(told.contains(" Pa in the last interval"), "{told}");
}
