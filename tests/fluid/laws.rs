//! Drag laws and the scheme that steps them, against closed forms.

use super::scenes::{DENSITY, DIAMETER, RELAXATION, VISCOSITY, grain};
use crate::support::{assert_near, read, start, velocity_of_first};
use cograin::simulation::Simulation;
use cograin::state::Loss;
use std::f64::consts::PI;

#[test]
fn grains_fall_at_the_terminal_velocity_of_the_law() {
    for (law, small, large) in [
        ("schiller_naumann", 7.2941e-3, 0.145946),
        ("di_felice", 6.92152e-3, 0.134104),
        ("koch_hill", 7.89307e-3, 0.123815),
        ("beetstra", 7.69037e-3, 0.129735),
    ] {
        for (diameter, expected) in [(1e-4, small), (1e-3, large)] {
            let fluid = format!("porosity = 1.0\n[fluid.water.drag.{law}]");
            let mut simulation = grain(diameter, (VISCOSITY, diameter), &fluid, "");
            simulation.advance(20.0 * DENSITY * diameter * diameter / (18.0 * VISCOSITY)).unwrap();
            assert_near(-velocity_of_first(&simulation)[2], expected, 1e-5);
        }
    }
}

#[test]
fn the_terminal_velocity_of_stokes_is_exact_whatever_the_step() {
    // In honey, where a grain goes a small part of its radius in a relaxation time.
    let (viscosity, relaxation) = (10.0, 1e-4 * RELAXATION);
    let expected = DIAMETER * DIAMETER * 1500.0 * 9.81 / (18.0 * viscosity);
    for steps in [0.1, 1.0, 10.0, 100.0] {
        let fluid = "[fluid.water.drag.stokes]";
        let mut simulation = grain(DIAMETER, (viscosity, steps * relaxation), fluid, "");
        // What is left of the start falls by (x − 2)/(x + 2) in a step of x relaxation times.
        simulation.advance(1000.0 * steps.max(1.0) * relaxation).unwrap();
        assert_near(-velocity_of_first(&simulation)[2], expected, 4e-15);
    }
}

#[test]
fn a_grain_approaches_its_terminal_velocity_as_an_exponential() {
    let expected = 1500.0 / 2500.0 * 9.81 * RELAXATION * (1.0 - (-2.0_f64).exp());
    let errors = [0.1, 0.05].map(|steps| {
        let mut simulation = grain(DIAMETER, (VISCOSITY, steps * RELAXATION), "[fluid.water.drag.stokes]", "");
        simulation.advance(2.0 * RELAXATION).unwrap();
        -velocity_of_first(&simulation)[2] - expected
    });
    assert!(errors[0].abs() < 1e-3 * expected, "{errors:?} m/s");
    assert_near(errors[0] / errors[1], 4.0, 0.1);
}

#[test]
fn the_scheme_is_of_second_order_whatever_the_law() {
    for law in ["schiller_naumann", "beetstra"] {
        let after = |step: f64| {
            let fluid = format!("porosity = 0.9\n[fluid.water.drag.{law}]");
            let mut simulation = grain(1e-3, (VISCOSITY, step), &fluid, "");
            simulation.advance(0.032).unwrap();
            velocity_of_first(&simulation)[2]
        };
        let exact = after(1e-5);
        let errors = [2e-3, 1e-3, 5e-4].map(|step| (after(step) - exact).abs());
        assert!(errors[0] / errors[1] > 3.5 && errors[1] / errors[2] > 3.5, "{law}: {errors:?} m/s");
    }
}

#[test]
fn no_relaxation_time_limits_the_step() {
    // Light grains: they follow the water at Re = 1 while they go a small part of their radius in many relaxation times.
    let (density, wind) = (2.5, 0.01);
    let relaxation = density * DIAMETER * DIAMETER / (18.0 * VISCOSITY);
    for law in ["stokes", "schiller_naumann", "koch_hill"] {
        for steps in [10.0, 100.0] {
            let mut simulation = start(&format!(
                r#"
[run]
step = {:?}
[material.foam]
density = {density:?}
[particles.grain]
material = "foam"
list = [{{ position = [0.0, 0.0, 0.0], radius = {:?}, velocity = [0.0, {wind:?}, 0.0] }}]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
velocity = [{wind:?}, 0.0, 0.0]
porosity = 1.0
[fluid.water.drag.{law}]
[output]
losses = true
"#,
                steps * relaxation,
                0.5 * DIAMETER
            ));
            simulation.advance(800.0 * steps * relaxation).unwrap();
            let [x, y, _] = velocity_of_first(&simulation);
            assert!((x / wind - 1.0).abs() < 1e-12 && (y / wind).abs() < 1e-12, "{law}, {steps}: {x}, {y} m/s");
            let taken = simulation.losses().unwrap()[Loss::Drag as usize];
            // Both components of the slip, and the wind brings as much as it takes along.
            let mass = density * PI / 6.0 * DIAMETER.powi(3);
            assert_near(taken, mass * wind * wind, 1e-9);
        }
    }
}

#[test]
fn an_impact_in_a_fluid_is_that_of_a_spring_and_a_dashpot_to_the_ground() {
    // Without weight and buoyancy: m ẍ + β ẋ + k x = 0, until the spring is released.
    let (k, speed) = (0.5_f64, 0.01);
    let mass = DENSITY * PI / 6.0 * DIAMETER.powi(3);
    let beta = 3.0 * PI * VISCOSITY * DIAMETER;
    let out = |steps: f64| {
        let step = (mass / k).sqrt() / steps;
        let mut simulation = start(&format!(
            r#"
[run]
step = {step:?}
[material.glass]
density = 2500.0
[pair.glass.glass]
normal_stiffness = {k:?}
normal_damping = 0.0
tangential_stiffness = 0.0
tangential_damping = 0.0
[contact.all.normal.hooke_stiffness]
[particles.grain]
material = "glass"
list = [{{ position = [0.0, 0.0, 5.0e-5], radius = 5.0e-5, velocity = [0.0, 0.0, -{speed:?}] }}]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "glass"
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
[fluid.water.drag.stokes]
"#
        ));
        // Past the contact, whatever the step; drag then goes on by itself.
        let time = 1.5 * PI * (mass / k).sqrt();
        simulation.advance(time).unwrap();
        velocity_of_first(&simulation)[2]
    };
    let rate = 0.5 * beta / mass;
    let frequency = (k / mass - rate * rate).sqrt();
    let contact = PI / frequency;
    let left = 1.5 * PI * (mass / k).sqrt() - contact;
    let expected = speed * (-rate * contact).exp() * (-beta / mass * left).exp();
    let errors = [out(50.0) - expected, out(100.0) - expected];
    assert!(errors[1].abs() < 1e-3 * expected, "{errors:?} m/s of {expected} m/s");
    assert!(errors[0].abs() > 2.0 * errors[1].abs(), "{errors:?} m/s");
}

#[test]
fn a_law_of_another_crate_is_a_row() {
    use cograin::drag::Drag;
    use cograin::scene::{Models, Source};
    /// Twice Stokes' drag.
    #[derive(Debug)]
    struct Twice;
    impl Drag for Twice {
        const NAME: &'static str = "twice";
        type Keys = cograin::contact::NoKeys;
        const OF_ONE_SPHERE: bool = true;
        fn of(_keys: &Self::Keys) -> Self {
            Self
        }
        fn factor(&self, _porosity: f64, _reynolds: f64) -> f64 {
            2.0
        }
    }
    let text = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1e-4
[material.glass]
density = 2500.0
[particles.grain]
material = "glass"
list = [{ position = [0.0, 0.0, 0.0], radius = 5.0e-5 }]
[fluid.water]
density = 1000.0
viscosity = 1.0e-3
[fluid.water.drag.twice]
"#;
    assert!(read(text).unwrap_err().contains("twice"));
    let models = Models::standard().with_drag::<Twice>();
    let source = Source { name: "scene.toml".to_owned(), text: text.to_owned(), files: Default::default() };
    let scene = models.scene(&source, &[]).map_err(|errors| errors.to_string()).unwrap();
    let mut simulation = Simulation::new(std::sync::Arc::new(scene)).unwrap();
    simulation.advance(0.05).unwrap();
    assert_near(-velocity_of_first(&simulation)[2], DIAMETER * DIAMETER * 1500.0 * 9.81 / (36.0 * VISCOSITY), 1e-13);
}
