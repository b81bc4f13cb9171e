//! The tip of a clamped chain under a force across moves as its springs in series do: a beam's deflection, less its share
//! 1/(4 N²) of bending, plus shear.

use crate::physics::chain::{BENDING, CLAMP, LENGTH, MASS, SHEAR, chain, in_order};
use crate::physics::stage::assert_close;
use crate::support::start;
use cograin::simulation::Simulation;
use std::f64::consts::TAU;

/// Deflection of the tip over the length of the beam that the forces are chosen for: what the law neglects is its square.
const SLOPE: f64 = 5e-6;

/// Time step \[s\], two thirds of √(m/(k_n A)).
const STEP: f64 = 1.2e-6;

/// Deflection of the tip for each newton: F a² (4 N³ − N)/(12 k_n I) + F N/(k_t A) = F L³/(3 EI) (1 − 1/(4 N²)) + F L/(κ G A)
/// \[m/N\].
fn compliance(bonds: usize) -> f64 {
    let count = bonds as f64;
    LENGTH * LENGTH * (4.0 * count * count * count - count) / (12.0 * BENDING) + count / SHEAR
}

/// Deflection of the tip of a cantilever of this many bonds at rest \[m\], and the force on it \[N\].
fn bent(bonds: usize, formulation: &str) -> (f64, f64) {
    let force = SLOPE * LENGTH * bonds as f64 / compliance(bonds);
    let more = format!(
        r#"{CLAMP}
[force.tip]
particles = {{ set = "beam", ids = [{}] }}
force = [0.0, 0.0, {force:?}]
[damping.all]
linear = 0.7
angular = 0.7
gravity_damped = false
applied_forces_damped = true
"#,
        bonds + 1
    );
    let mut simulation = start(&chain(formulation, STEP, &vec![[[0.0; 3]; 2]; bonds + 1], &more));
    // The tip on the springs alone, with the mass of all: longer than any period.
    let period = TAU * (bonds as f64 * MASS * compliance(bonds)).sqrt();
    let tip = |simulation: &Simulation| {
        let position = &simulation.state().particles.position;
        in_order(simulation, position).last().unwrap()[2]
    };
    let mut before = f64::INFINITY;
    for _ in 0..60 {
        simulation.advance(period).unwrap();
        let now = tip(&simulation);
        // Across the beam: along it, rounding of positions alone is more than this share of so small a force.
        let forces = in_order(&simulation, &simulation.state().particles.force).skip(1);
        let unbalanced = forces.map(|[_, y, z, _]| y.abs().max(z.abs())).fold(0.0, f64::max);
        if (now - before).abs() <= 1e-10 * now.abs() && unbalanced <= 1e-10 * force {
            return (now, force);
        }
        before = now;
    }
    panic!("{formulation}, {bonds} bonds: not at rest");
}

#[test]
fn the_static_deflection_is_that_of_the_springs_in_series() {
    for formulation in ["finite_rotation", "incremental"] {
        for bonds in [1, 3, 5, 10, 20] {
            let (deflection, force) = bent(bonds, formulation);
            let what = format!("{formulation}, {bonds} bonds");
            assert_close(deflection, force * compliance(bonds), 1e-9, &what);
            let count = bonds as f64;
            let euler = force * (LENGTH * count).powi(3) / (3.0 * BENDING * LENGTH);
            // What is missing to a beam of the same length, over it.
            let missing = 1.0 - (deflection - force * count / SHEAR) / euler;
            assert!((missing - 0.25 / (count * count)).abs() <= 1e-9, "{what}: {missing:?}");
        }
    }
}
