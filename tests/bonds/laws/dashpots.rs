//! Dashpots in a bond that turns: their rates are those of mid-step, and so is the axis about which they are taken.

use crate::bonds::laws::placement::{RADII, turn};
use cograin::bond::damping::LastDamping;
use cograin::bond::formulation::FormulationChoice;
use cograin::bond::keys::{DampingChoice, PartKeys};
use cograin::bond::{Body, Elasticity, Law, Pair};
use cograin::number::Vector;
use cograin::quantity::NonNegative;

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
        orientation: turn(spin * time),
        radius: RADII[index],
        mass: 3.0,
        inertia: 2.0,
    };
    let velocity = (at(time) - at(time - step)) * (1.0 / step);
    Pair::of_spheres(&body(0, at(time), velocity), &body(1, Vector::zero(), Vector::zero()))
}

/// By how much dashpots miss the force along the bond that its drawing alone gives, and by how much what is across the
/// bond misses 0, with this step \[N\].
fn error(formulation: FormulationChoice, step: f64) -> f64 {
    let [normal_force, tangential_force, normal_torque, tangential_torque] = [0.1, 0.2, 0.3, 0.4].map(NonNegative::new);
    let ratios = PartKeys { normal_force, tangential_force, normal_torque, tangential_torque };
    let elasticity = Elasticity::of(1.0, 10.0, 4.0);
    let bare = Law::elastic(formulation, elasticity);
    let damped = Law { damping: Some(DampingChoice::Viscous(ratios.into())), ..bare.clone() };
    let rows = (damped.one_bond().create)(&elasticity.at_step(0.0), &pair(0.0, step));
    let now = pair(1.0, step);
    let force = |law: &Law| law.react(&elasticity.at_step(step), &now, &rows, &LastDamping::default()).force;
    let axis = now.connection * (1.0 / now.connection.length());
    // 2 ζ √(k_n A M) with r_b = 0.6 and M = 3/2.
    let dashpot = 0.2 * (10.0 * 0.36 * std::f64::consts::PI * 1.5_f64).sqrt();
    (force(&damped) - force(&bare) + axis * (dashpot * DRAWN)).length()
}

/// Error of a step over that of half of it, and the former.
fn falls(formulation: FormulationChoice) -> (f64, f64) {
    (error(formulation, 0.04) / error(formulation, 0.02), error(formulation, 0.04))
}

#[test]
fn dashpots_of_a_turning_bond_are_right_to_the_second_order() {
    for (ratio, coarse) in [falls(FormulationChoice::FiniteRotation), falls(FormulationChoice::Incremental)] {
        assert!((ratio - 4.0).abs() < 0.1, "{ratio} {coarse:e}");
        assert!(coarse < 1e-3, "{coarse:e}");
    }
    // On the axis of the step's end, as the engine takes its rates, the turn itself counts as a motion along the bond.
    let (ratio, coarse) = falls(FormulationChoice::EngineExact);
    assert!((ratio - 2.0).abs() < 0.1, "{ratio} {coarse:e}");
    assert!(coarse > 1e-2, "{coarse:e}");
}
