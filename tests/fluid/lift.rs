//! Lift against closed forms.

use super::scenes::{SIX, give, sum};
use crate::support::{assert_near, read, start, value, velocity_of_first};
use cograin::simulation::Simulation;
use std::f64::consts::PI;

/// Velocity of the fluid past it \[m/s\]: in no step a sphere goes far.
const FLOW: f64 = 1.0e-4;

/// A sphere that spins about z in a flow along x without viscosity, almost.
fn spinning(density: f64, step: f64, keys: &str) -> Simulation {
    start(&format!(
        r#"
[run]
step = {step:?}
[material.a]
density = {density:?}
[particles.sphere]
material = "a"
list = [{{ position = [0.0, 0.0, 0.0], radius = 1.0e-3, angular_velocity = [0.0, 0.0, 40.0] }}]
[fluid.water]
density = 1000.0
viscosity = 1.0e-16
velocity = [{FLOW:?}, 0.0, 0.0]
{keys}
[fluid.water.lift.magnus]
[fluid.water.drag.stokes]
[output]
energy = true
losses = true
"#
    ))
}

#[test]
fn a_sphere_that_spins_is_lifted_by_rubinow_and_keller() {
    let mut simulation = spinning(1e9, 1e-4, "");
    simulation.advance(1e-3).unwrap();
    // π/8 d³ ρ w × ω: along −y.
    let lift = PI / 8.0 * 8e-9 * 1000.0 * FLOW * 40.0;
    assert_near(value(&simulation, "water.mean_drag.y"), lift, 1e-6);
    assert!(value(&simulation, "water.mean_drag.x").abs() < 1e-6 * lift);
}

#[test]
fn lift_turns_the_slip_and_leaves_its_length_whatever_the_step() {
    for (density, keys, whole) in [(500.0, "", 500.0), (100.0, "added_mass = 0.5", 600.0)] {
        // The slip turns at π/8 d³ ρ ω over the mass: 3/4 ρ ω over the density.
        let rate = 0.75 * 1000.0 * 40.0 / whole;
        for part in [0.02, 1.0, 10.0] {
            let step = part / rate;
            let mut simulation = spinning(density, step, keys);
            let turn = 2.0 * (0.5_f64 * part).atan();
            let mut slips = Vec::new();
            for _ in 0..12 {
                simulation.advance(step).unwrap();
                let [x, y, _] = velocity_of_first(&simulation);
                slips.push([FLOW - x, -y]);
            }
            for pair in slips.windows(2) {
                let [[a, b], [c, d]] = [pair[0], pair[1]];
                assert_near(a.hypot(b), c.hypot(d), 1e-12);
                let angle = (a * d - b * c).atan2(a * c + b * d);
                assert_near(angle.abs(), turn, 1e-6);
            }
            // Of rotation, whose rounding is in the balance: the slip has a hundred-thousandth of it.
            let energy = 0.2 * density * 4.0 / 3.0 * PI * 1e-15 * 40.0 * 40.0;
            assert!(
                simulation.energy_residual().unwrap().abs() < 1e-13 * energy,
                "{:?} J",
                simulation.energy_residual()
            );
        }
    }
}

#[test]
fn a_sphere_in_a_shear_is_lifted_by_saffman_and_mei() {
    // u = (γ (y − y₀) + 0.02, 0, 0) past a sphere that is held.
    let (shear, mu, d) = (30.0_f64, 1e-3, 1e-3);
    let mut simulation = start(&format!(
        r#"
[run]
step = 1.0e-4
[material.a]
density = 2500.0
[particles.sphere]
material = "a"
list = [{{ position = [0.0213, 0.0171, 0.0088], radius = {:?} }}]
[boundary.hand]
particles = {{ set = "sphere" }}
motion = "fixed"
[grid.column]
{SIX}
[fluid.water]
density = 1000.0
viscosity = {mu:?}
grid = "column"
velocity = "driven"
[fluid.water.lift.saffman_mei]
[fluid.water.drag.stokes]
"#,
        0.5 * d
    ));
    let grid = simulation.scene().grids[0].shape;
    give(&mut simulation, "velocity", |cell| [shear * (grid.centre(cell)[1] - 0.0171) + 0.02, 0.0, 0.0]);
    simulation.place(None).unwrap();
    simulation.advance(1e-3).unwrap();
    let porosity = 1.0 - PI / 6.0 * d * d * d / 1e-6;
    let (slip, alpha) = (0.02, 0.5 * shear * d / 0.02);
    // The porosity at the sphere lies between that of its cell and 1.
    let lift = |porosity: f64| {
        let fall = (-0.1 * 1000.0 * slip * d * porosity / mu).exp();
        let alpha = alpha / porosity;
        let j = (1.0 - 0.3314 * alpha.sqrt()) * fall + 0.3314 * alpha.sqrt();
        1.615 * j * d * d * (1000.0 * mu / shear).sqrt() * slip * shear
    };
    let found = simulation.state().boundaries[0].mean_force[1];
    assert!(
        found > 0.0 && (found - lift(1.0)).abs() <= (lift(porosity) - lift(1.0)).abs() + 1e-12 * found,
        "{found:e} N"
    );
    assert_near(-sum(&simulation, "mean_drag.y"), found, 1e-12);
}

#[test]
fn a_law_of_lift_of_another_crate_is_a_row() {
    use cograin::lift::{Lift, Rotation};
    use cograin::scene::{Models, Source};
    /// Twice that of Rubinow and Keller.
    #[derive(Debug)]
    struct Twice;
    impl Lift for Twice {
        const NAME: &'static str = "twice";
        type Keys = cograin::contact::NoKeys;
        const ROTATION: Rotation = Rotation::Spin;
        fn of(_keys: &Self::Keys) -> Self {
            Self
        }
        fn factor(&self, _reynolds: f64, rotation: f64) -> f64 {
            PI / 4.0 * rotation
        }
    }
    let text = r#"
[run]
step = 1e-4
[material.a]
density = 1e9
[particles.grain]
material = "a"
list = [{ position = [0.0, 0.0, 0.0], radius = 1.0e-3, angular_velocity = [0.0, 0.0, 40.0] }]
[fluid.water]
density = 1000.0
viscosity = 1.0e-12
velocity = [0.2, 0.0, 0.0]
[fluid.water.lift.twice]
[fluid.water.drag.stokes]
"#;
    assert!(read(text).unwrap_err().contains("twice"));
    let source = Source { name: "scene.toml".to_owned(), text: text.to_owned(), files: Default::default() };
    let scene =
        Models::standard().with_lift::<Twice>().scene(&source, &[]).map_err(|errors| errors.to_string()).unwrap();
    let mut simulation = Simulation::new(std::sync::Arc::new(scene)).unwrap();
    simulation.advance(1e-3).unwrap();
    assert_near(value(&simulation, "water.mean_drag.y"), PI / 4.0 * 8e-9 * 1000.0 * 0.2 * 40.0, 1e-6);
}
