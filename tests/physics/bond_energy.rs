//! Kinetic energy, what bonds store and what broken ones released add up to the work of the boundary, to the square of the step.

use crate::physics::chain::{AXIAL, MASS, Motion, chain};
use crate::physics::stage::assert_near;
use crate::support::start;

/// The most by which energy is missing or over in the course of a chain that one end draws and swings \[J\].
///
/// Its time step is a share of √(m/(k_n A)); its bonds break where they are longer than `max_distance` \[m\].
fn residual(formulation: &str, share: f64, max_distance: f64, broken: u64) -> f64 {
    let motion = |sphere: usize| -> Motion {
        let spin = if sphere == 0 { 0.0 } else { 20.0 };
        [[0.0, 0.1 * (sphere as f64).sin(), 0.0], [0.0, 0.0, spin]]
    };
    let motions: Vec<Motion> = (0..8).map(motion).collect();
    let more = format!(
        r#"
breakage = {{ max_distance = {max_distance:?} }}
[boundary.hand]
particles = {{ set = "beam", ids = [1] }}
motion = {{ prescribed = {{ x = -0.6, y = 0.3 }} }}
"#
    );
    let unit = (MASS / AXIAL).sqrt();
    let mut simulation = start(&chain(formulation, share * unit, &motions, &more));
    let start = simulation.kinetic_energy();
    let mut worst: f64 = 0.0;
    for _ in 0..40 {
        simulation.advance(3.2 * unit).unwrap();
        let (bonds, work) = (&simulation.state().bonds[0], simulation.state().boundaries[0].work);
        let residual = simulation.kinetic_energy() + simulation.bond_elastic_energy() + bonds.released - start - work;
        worst = worst.max(residual.abs());
    }
    assert_eq!(simulation.state().bonds[0].broken, broken, "broken bonds");
    worst
}

#[test]
fn energy_adds_up_to_the_square_of_the_step() {
    for formulation in ["finite_rotation", "incremental"] {
        let [coarse, middle, fine] = [0.2, 0.1, 0.05].map(|share| residual(formulation, share, 1.0, 0));
        assert_near(coarse / middle, 4.0, 0.1, formulation);
        assert_near(middle / fine, 4.0, 0.1, formulation);
    }
}

#[test]
fn energy_adds_up_to_the_square_of_the_step_where_a_bond_breaks() {
    // What is told as released is the energy of the middle of the step in which the bond ceases to act.
    for formulation in ["finite_rotation", "incremental"] {
        let [coarse, middle, fine] = [0.1, 0.05, 0.025].map(|share| residual(formulation, share, 2.0006e-3, 1));
        assert_near(coarse / middle, 4.0, 0.25, formulation);
        assert_near(middle / fine, 4.0, 0.25, formulation);
    }
}
