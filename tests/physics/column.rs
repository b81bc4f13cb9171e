//! A clamped bonded column under a load on its top bends as Euler's, with a force across it and beyond the load at which it buckles.
//!
//! N bonds of length a and bending stiffness c are N hinges between rigid links. Under a load P and a force Q across, both on the top sphere's centre,
//! the inclinations obey c (2 θ_i − θ_(i−1) − θ_(i+1)) = P a θ_i + Q a, with half of the right-hand side for the last. Hence with
//! 2 (1 − cos q) = P a/c the top moves by (Q a/P) (tan(q N)/(2 tan(q/2)) − N), and q N = π/2 is the critical load, 4 c/a sin²(π/(4 N)): Euler's
//! π² c/(4 a N²) but for its 1/N². Beyond it a column follows the elastica (Timoshenko & Gere, *Theory of Elastic Stability*, 2nd ed., section 2.7):
//! P/P_c = (2 K(k)/π)², and its top stands aside by 2 k/K(k) of the length, with k the sine of half the angle at the top.

use crate::physics::chain::{AXIAL, BENDING, CLAMP, LENGTH, MASS, SHEAR, chain, in_order};
use crate::physics::stage::assert_close;
use crate::support::start;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Bonds of the column.
const BONDS: usize = 12;

/// What shear and shortening add, relative: they lower the critical load by P_c/(k_t A a) and raise it by P_c/(k_n A a).
const NEGLECTED: f64 =
    PI * PI * BENDING / (4.0 * (BONDS * BONDS) as f64 * LENGTH * LENGTH) * (1.0 / SHEAR + 1.0 / AXIAL);

/// The load at which it buckles \[N\].
fn critical() -> f64 {
    4.0 * BENDING / LENGTH * (PI / (4.0 * BONDS as f64)).sin().powi(2)
}

/// Where the top is at rest, along and across the column, under a load and a force across \[N\], over the length.
fn top(formulation: &str, load: f64, across: f64) -> [f64; 2] {
    let more = format!(
        "{CLAMP}[force.top]\nparticles = {{ set = \"beam\", ids = [{}] }}\nforce = [{:?}, 0.0, {across:?}]\n\
         [damping.all]\nlinear = 0.7\nangular = 0.7\ngravity_damped = false\napplied_forces_damped = true\n",
        BONDS + 1,
        -load
    );
    let mut simulation = start(&chain(formulation, 1.2e-6, &vec![[[0.0; 3]; 2]; BONDS + 1], &more));
    let length = LENGTH * BONDS as f64;
    // Of the first bending mode of an unloaded column, nearly.
    let period = TAU * (BONDS as f64 * MASS * length.powi(3) / (3.0 * BENDING * LENGTH)).sqrt();
    let mut before = [f64::INFINITY; 2];
    for _ in 0..200 {
        simulation.advance(period).unwrap();
        let [x, _, z, _] = in_order(&simulation, &simulation.state().particles.position).last().unwrap();
        let now = [x / length, z / length];
        if (now[1] - before[1]).abs() <= 1e-7 * now[1].abs() {
            return now;
        }
        before = now;
    }
    panic!("{formulation}, {load} N: not at rest");
}

/// Complete elliptic integral of the first kind, by the arithmetic-geometric mean.
fn elliptic(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    FRAC_PI_2 / a
}

#[test]
fn a_force_across_bends_a_loaded_column_the_more_the_nearer_its_load_is_to_the_critical_one() {
    for formulation in ["finite_rotation", "incremental"] {
        for share in [0.5, 0.9] {
            let (load, count) = (share * critical(), BONDS as f64);
            let across = 1e-5 * critical();
            let turn = (1.0 - 0.5 * load * LENGTH / BENDING).acos();
            let expected = across / load / count * ((turn * count).tan() / (2.0 * (0.5 * turn).tan()) - count);
            let [_, found] = top(formulation, load, across);
            // An error of the critical load is magnified by this.
            assert_close(
                found,
                expected,
                NEGLECTED * share / (1.0 - share) + 1e-3,
                &format!("{formulation}, {share} of the critical load"),
            );
        }
    }
}

#[test]
fn beyond_the_critical_load_a_column_stands_aside_as_the_elastica() {
    for angle in [60.0_f64, 90.0] {
        let sine = (0.5 * angle.to_radians()).sin();
        let load = critical() * (elliptic(sine) / FRAC_PI_2).powi(2);
        // What leads it aside is too small to be seen at rest.
        let [_, found] = top("finite_rotation", load, 1e-5 * critical());
        // The deflection grows as the root of the load beyond the critical one.
        let tolerance = 0.5 * NEGLECTED / (load / critical() - 1.0) + 2e-3;
        assert_close(found, 2.0 * sine / elliptic(sine), tolerance, &format!("top inclined by {angle}°"));
    }
}

#[test]
fn below_the_critical_load_a_column_stays_straight() {
    let [along, aside] = top("finite_rotation", 0.97 * critical(), 1e-7 * critical());
    assert!((along - 1.0).abs() < 1e-2 && aside.abs() < 1e-4, "the top is at {along} and {aside} of the length");
}
