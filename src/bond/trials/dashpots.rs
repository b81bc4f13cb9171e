//! Dashpots in a bond that turns: their rates are those of mid-step, and so is the axis about which they are taken.

use super::placement::{RADII, turn};
use crate::bond::breakage::distance::Distance;
use crate::bond::damping::viscous::Viscous;
use crate::bond::engine_exact::EngineExact;
use crate::bond::finite_rotation::FiniteRotation;
use crate::bond::incremental::Incremental;
use crate::bond::{Body, BondLaw, Composed, Formulation, Law, Pair};
use crate::number::Vector;

/// Speed at which the bond is drawn \[m/s\].
const DRAWN: f64 = 0.05;

/// Angular velocity with which it turns as a whole about an axis across it \[rad/s\].
const SPIN: f64 = 1.5;

/// The pair at this time, one step after the last: bond along (cos ωt, sin ωt, 0) in its own plane.
fn pair(time: f64, step: f64) -> Pair {
    let spin = Vector::new(0.0, 0.6, -0.8) * SPIN;
    let at = |time: f64| turn(spin * time).turn(Vector::new(1.6 + DRAWN * time, 0.0, 0.0));
    let body = |index: usize, position: Vector, velocity: Vector| Body {
        position,
        velocity,
        spin,
        attitude: turn(spin * time),
        radius: RADII[index],
        mass: 3.0,
        inertia: 2.0,
    };
    let velocity = (at(time) - at(time - step)) * (1.0 / step);
    Pair::of_spheres(&body(0, at(time), velocity), &body(1, Vector::zero(), Vector::zero()))
}

/// By how much dashpots miss the force along the bond that its drawing alone gives, and by how much what is across the
/// bond misses 0, with this step \[N\].
fn error<F: Formulation>(step: f64) -> f64 {
    type Damped<F> = Composed<F, Viscous, Distance>;
    let law = Law { damping: [0.1, 0.2, 0.3, 0.4], ..Law::elastic(1.0, 10.0, 4.0) };
    let rows = Damped::<F>::create(&law.coefficients(0.0), &pair(0.0, step));
    let now = pair(1.0, step);
    let found = Damped::<F>::react(&law.coefficients(step), &now, &rows);
    let axis = now.connection * (1.0 / now.connection.length());
    // 2 ζ √(k_n A M) with r_b = 0.6 and M = 3/2.
    let dashpot = 0.2 * (10.0 * 0.36 * std::f64::consts::PI * 1.5_f64).sqrt();
    (found.damping_force + axis * (dashpot * DRAWN)).length()
}

/// Error of a step over that of half of it, and the former.
fn falls<F: Formulation>() -> (f64, f64) {
    (error::<F>(0.04) / error::<F>(0.02), error::<F>(0.04))
}

#[test]
fn dashpots_of_a_turning_bond_are_right_to_the_second_order() {
    for (ratio, coarse) in [falls::<FiniteRotation<false>>(), falls::<Incremental<false>>()] {
        assert!((ratio - 4.0).abs() < 0.1, "{ratio} {coarse:e}");
        assert!(coarse < 1e-3, "{coarse:e}");
    }
    // On the axis of the step's end, as the engine takes its rates, the turn itself counts as a motion along the bond.
    let (ratio, coarse) = falls::<EngineExact>();
    assert!((ratio - 2.0).abs() < 0.1, "{ratio} {coarse:e}");
    assert!(coarse > 1e-2, "{coarse:e}");
}
