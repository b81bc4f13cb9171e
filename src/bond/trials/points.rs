//! Points worked out by hand: breakage, damping, the first steps of the engine's bond.

use super::placement::RADII;
use crate::bond::breakage::{distance::Distance, stress::ByStress};
use crate::bond::damping::{componentwise::Componentwise, none::Undamped, opposing::Opposing, viscous::Viscous};
use crate::bond::engine_exact::EngineExact;
use crate::bond::finite_rotation::FiniteRotation;
use crate::bond::incremental::Incremental;
use crate::bond::{Body, BondLaw, Cause, Composed, Damping, Formulation, Law, Pair, Quaternion, Reaction, Rows};
use crate::number::Vector;

/// Two bodies along x at this distance, j at the origin, with the velocity and spin of i.
fn pair(distance: f64, velocity: [f64; 3], spin: [f64; 3]) -> Pair {
    let body = |index: usize, position: [f64; 3], velocity: [f64; 3], spin: [f64; 3]| Body {
        position: position.into(),
        velocity: velocity.into(),
        spin: spin.into(),
        attitude: Quaternion::identity(),
        radius: RADII[index],
        mass: 3.0,
        inertia: 2.0,
    };
    Pair::of_spheres(&body(0, [distance, 0.0, 0.0], velocity, spin), &body(1, [0.0; 3], [0.0; 3], [0.0; 3]))
}

/// Stored forces of the rate forms: shear, twist vector, bending, at rest length 2.
fn stored(shear: [f64; 3], torsion: f64, bending: [f64; 3]) -> Rows {
    let row = |[x, y, z]: [f64; 3], last: f64| [x, y, z, last];
    [row(shear, 2.0), [torsion, 0.0, 0.0, 0.0], row(bending, 0.0)]
}

/// Bond radius 0.6, A = 0.36 π.
fn law() -> Law {
    Law::elastic(1.0, 10.0, 4.0)
}

/// A = π r_b².
const AREA: f64 = 0.36 * std::f64::consts::PI;

#[test]
fn the_engines_step_by_hand() {
    // u = −0.1; v_s = (0, 1.5, 0) + e × l_i w_i with l_i = 2.1 · 1/1.6 and w_i = (0.2, 0, 0.4): y: 1.5 − 0.4 l_i.
    let pair = pair(2.1, [0.3, 1.5, 0.0], [0.2, 0.0, 0.4]);
    let law = Law { relaxation_rate: [0.5, 1.0, 1.5, 2.0], ..law() };
    let rows = stored([0.7, 2.0, 0.0], 0.3, [0.5, 0.6, 0.8]);
    let found = Composed::<EngineExact, Undamped, Distance>::react(&law.coefficients(0.1), &pair, &rows);
    let (arm_i, arm_j) = (2.1 / 1.6, 2.1 * 0.6 / 1.6);
    let normal = -10.0 * AREA * 0.1;
    let shear = 2.0 * 0.9 - 4.0 * AREA * 0.1 * (1.5 - arm_i * 0.4);
    let torsion = 0.3 * 0.85 - 4.0 * AREA * 0.18 * 0.1 * 0.2;
    // w_t = (0, 0, 0.4): only the z part of the stored bending is left.
    let bending = 0.8 * 0.8 - 10.0 * AREA * 0.09 * 0.1 * 0.4;
    let near = |found: Vector, expected: [f64; 3]| assert!((found - expected.into()).length() < 1e-14, "{found:?}");
    near(found.force, [normal, shear, 0.0]);
    // F_t × e = (0, s, 0) × (1, 0, 0) = (0, 0, −s).
    near(found.torque_i, [torsion, 0.0, -arm_i * shear + bending]);
    near(found.torque_j, [-torsion, 0.0, -arm_j * shear - bending]);
    near(found.rows[0].into(), [0.0, shear, 0.0]);
    near(found.rows[1].into(), [torsion, 0.0, 0.0]);
    near(found.rows[2].into(), [0.0, 0.0, bending]);
    assert!((found.rows[0][3] - (2.0 + 0.1 * 0.05)).abs() < 1e-15, "the length is shifted after the force");
}

#[test]
fn the_engine_keeps_but_does_not_apply_bending_at_rest() {
    let rows = stored([0.0; 3], 0.0, [0.0, 0.6, 0.8]);
    let pair = pair(2.0, [0.0; 3], [0.0; 3]);
    let found = Composed::<EngineExact, Undamped, Distance>::react(&law().coefficients(0.1), &pair, &rows);
    assert_eq!(found.torque_i, Vector::zero());
    assert_eq!(found.rows, rows);
    // Laid out as the other rate form keeps it, the same load acts.
    let rows = [[0.0, 0.0, 0.0, 2.0], [0.0, 0.6, 0.8, 0.0], [0.0; 4]];
    let found = Composed::<Incremental<false>, Undamped, Distance>::react(&law().coefficients(0.1), &pair, &rows);
    assert!((found.torque_i - Vector::new(0.0, 0.6, 0.8)).length() < 1e-15);
}

#[test]
fn the_evaluation_before_the_first_step_changes_nothing() {
    let pair = pair(2.1, [0.3, 1.5, 0.0], [0.2, 0.0, 0.4]);
    let law = Law { relaxation_rate: [0.5; 4], ..law() }.coefficients(0.0);
    let rows = stored([0.0, 2.0, 0.0], 0.3, [0.0, 0.6, 0.8]);
    assert_eq!(Composed::<EngineExact, Undamped, Distance>::react(&law, &pair, &rows).rows, rows);
    let rows = [[0.0, 2.0, 0.0, 2.0], [0.0, 0.6, 0.8, 0.3], [0.0; 4]];
    assert_eq!(Composed::<Incremental<false>, Undamped, Distance>::react(&law, &pair, &rows).rows, rows);
    let rows = <FiniteRotation<false> as Formulation>::create(&law, &pair);
    assert_eq!(Composed::<FiniteRotation<false>, Undamped, Distance>::react(&law, &pair, &rows).rows, rows);
}

/// Why the engine's bond at rest length 2 breaks at a distance with stored shear and bending along y, if it does.
fn broken(law: &Law, distance: f64, shear: f64, bending: f64) -> Option<Cause> {
    broken_with(law, distance, shear, 0.0, bending)
}

/// The same with stored torsion.
fn broken_with(law: &Law, distance: f64, shear: f64, torsion: f64, bending: f64) -> Option<Cause> {
    let rows = stored([0.0, shear, 0.0], torsion, [0.0, bending, 0.0]);
    let pair = pair(distance, [0.0; 3], [0.0; 3]);
    let found: Reaction<f64> = Composed::<EngineExact, Undamped, ByStress>::react(&law.coefficients(0.0), &pair, &rows);
    let cause = Cause::from_code(found.cause);
    assert_eq!(cause.is_some(), found.cause != 0.0);
    if cause.is_some() {
        assert_eq!(found.force, Vector::zero());
        assert_eq!((found.torque_i, found.torque_j), (Vector::zero(), Vector::zero()));
    }
    cause
}

#[test]
fn each_stress_breaks_beyond_its_limit_and_names_itself() {
    let law = Law { tension_strength: 1.0, compression_strength: 2.0, shear_strength: 0.5, ..law() };
    // σ = k_n |u|.
    assert_eq!(broken(&law, 2.09, 0.0, 0.0), None);
    assert_eq!(broken(&law, 2.11, 0.0, 0.0), Some(Cause::Tension));
    let breaks = Law { compression_share: 1.0, ..law };
    assert_eq!(broken(&breaks, 1.81, 0.0, 0.0), None);
    assert_eq!(broken(&breaks, 1.79, 0.0, 0.0), Some(Cause::Compression));
    assert_eq!(broken(&law, 1.0, 0.0, 0.0), None, "compression relieves");
    // τ = F/A.
    assert_eq!(broken(&law, 2.0, 0.499 * AREA, 0.0), None);
    assert_eq!(broken(&law, 2.0, 0.501 * AREA, 0.0), Some(Cause::Shear));
    // σ = 4 M/(A r_b), of a bond neither stretched nor compressed, against the strength in tension.
    assert_eq!(broken(&law, 2.0, 0.0, 0.249 * AREA * 0.6), None);
    assert_eq!(broken(&law, 2.0, 0.0, 0.251 * AREA * 0.6), Some(Cause::Bending));
    // Compressed by 0.05: −0.5 + bending against 2.
    assert_eq!(broken(&law, 1.95, 0.0, 2.49 / 4.0 * AREA * 0.6), None);
    assert_eq!(broken(&law, 1.95, 0.0, 2.51 / 4.0 * AREA * 0.6), Some(Cause::Bending));
    let apart = Law { max_distance: 2.05, ..law };
    assert_eq!(broken(&apart, 2.06, 0.0, 0.0), Some(Cause::Distance));
}

#[test]
fn the_larger_part_of_a_stress_names_the_cause() {
    let law = Law { tension_strength: 1.0, compression_strength: 1.0, shear_strength: 0.5, ..law() };
    let bending = |stress: f64| stress / 4.0 * AREA * 0.6;
    let torsion = |stress: f64| stress / 2.0 * AREA * 0.6;
    // 0.6 from stretching against 0.5 from bending, and the other way round; both at 0.05 and 0.06 m.
    assert_eq!(broken(&law, 2.06, 0.0, bending(0.5)), Some(Cause::Tension));
    assert_eq!(broken(&law, 2.05, 0.0, bending(0.6)), Some(Cause::Bending));
    let breaks = Law { compression_share: 1.0, ..law };
    assert_eq!(broken(&breaks, 1.94, 0.0, bending(0.5)), Some(Cause::Compression));
    assert_eq!(broken(&breaks, 1.95, 0.0, bending(0.6)), Some(Cause::Bending));
    assert_eq!(broken_with(&law, 2.0, 0.3 * AREA, torsion(0.25), 0.0), Some(Cause::Shear));
    assert_eq!(broken_with(&law, 2.0, 0.25 * AREA, torsion(0.3), 0.0), Some(Cause::Torsion));
    // The normal stress is looked at first.
    assert_eq!(broken_with(&law, 2.0, 0.0, torsion(0.6), bending(1.1)), Some(Cause::Bending));
}

#[test]
fn every_cause_has_a_code_and_a_name_of_its_own() {
    let causes: Vec<Cause> = (1..10).filter_map(|code| Cause::from_code(f64::from(code))).collect();
    let mut names: Vec<&str> = causes.iter().map(|cause| cause.name()).collect();
    names.sort_unstable();
    assert_eq!(names, ["bending", "compression", "distance", "shear", "tension", "torsion"]);
    assert_eq!(Cause::from_code(0.0), None);
}

#[test]
fn friction_raises_the_shear_strength_under_compression_and_lowers_it_under_tension() {
    let law = Law { shear_strength: 0.5, friction: 0.5, ..law() };
    // |N|/A = 0.4.
    assert_eq!(broken(&law, 1.96, 0.69 * AREA, 0.0), None);
    assert_eq!(broken(&law, 1.96, 0.71 * AREA, 0.0), Some(Cause::Shear));
    assert_eq!(broken(&law, 2.04, 0.29 * AREA, 0.0), None);
    assert_eq!(broken(&law, 2.04, 0.31 * AREA, 0.0), Some(Cause::Shear));
    assert_eq!(broken(&law, 2.11, 0.0, 0.0), Some(Cause::Shear), "a negative strength breaks at once");
}

/// What damping alone adds to force and torque on i, of a bond stretched by 0.1 with shear 2 along y and bending 0.5 along y.
fn damped<D: Damping>(law: &Law, velocity: [f64; 3], spin: [f64; 3]) -> (Vector, Vector) {
    let rows = stored([0.0, 2.0, 0.0], 0.0, [0.0, 0.5, 0.0]);
    let pair = pair(2.1, velocity, spin);
    let found = Composed::<EngineExact, D, Distance>::react(&law.coefficients(0.0), &pair, &rows);
    let bare = Composed::<EngineExact, Undamped, Distance>::react(&law.coefficients(0.0), &pair, &rows);
    assert!((found.force - bare.force - found.damping_force).length() < 1e-14);
    assert!((found.torque_i - bare.torque_i - found.damping_torque_i).length() < 1e-14);
    assert!((found.torque_j - bare.torque_j - found.damping_torque_j).length() < 1e-14);
    (found.damping_force, found.damping_torque_i)
}

#[test]
fn opposing_damping_is_a_share_of_the_force_against_the_rate() {
    let law = Law { damping: [0.1, 0.2, 0.3, 0.4], ..law() };
    let (force, torque) = damped::<Opposing>(&law, [0.5, 3.0, 4.0], [0.0; 3]);
    let expected = Vector::new(-0.1 * AREA, -0.4 * 0.6, -0.4 * 0.8);
    assert!((force - expected).length() < 1e-14, "{force:?}");
    // (F × e) l_i with e along x.
    let arm = 2.1 / 1.6;
    assert!((torque - Vector::new(0.0, expected.z * arm, -expected.y * arm)).length() < 1e-14, "{torque:?}");
    let (force, torque) = damped::<Opposing>(&law, [0.0; 3], [0.0; 3]);
    assert_eq!((force, torque), (Vector::zero(), Vector::zero()), "nothing moves, nothing is damped");
}

#[test]
fn the_engines_damping_goes_axis_by_axis() {
    let law = Law { damping: [0.1, 0.2, 0.3, 0.4], ..law() };
    let (force, _) = damped::<Componentwise>(&law, [0.5, 3.0, 4.0], [0.0; 3]);
    assert!((force - Vector::new(-0.1 * AREA, -0.4, 0.0)).length() < 1e-14, "{force:?}");
    let (force, torque) = damped::<Componentwise>(&law, [0.0; 3], [0.0; 3]);
    assert_eq!((force, torque), (Vector::zero(), Vector::zero()));
}

#[test]
fn the_smooth_threshold_is_that_of_the_engine() {
    let law = Law { damping: [0.1; 4], threshold: 1e-5, threshold_by_force: 0.01, ..law() };
    let step = 1e-3;
    let rows = stored([0.0; 3], 0.0, [0.0; 3]);
    let force = |speed: f64, distance: f64| {
        let found = Composed::<EngineExact, Componentwise, Distance>::react(
            &law.coefficients(step),
            &pair(distance, [speed, 0.0, 0.0], [0.0; 3]),
            &rows,
        );
        found.damping_force.x
    };
    // Stretched: N < 0 along x, so 1e-5 R_min/Δt = 6e-3 m/s decides.
    let full = 0.1 * 10.0 * AREA * 0.1;
    assert!((force(3e-3, 2.1) + 0.5 * full).abs() < 1e-14);
    assert!((force(6e-2, 2.1) + full).abs() < 1e-14);
    // Compressed: 0.01 N Δt = 0.01 · 1000 · …: a softer law would not reach it; here N Δt/100 = 1.13e-5 stays below.
    assert!((force(3e-3, 1.9) + 0.5 * full).abs() < 1e-14);
}

#[test]
fn dashpots_damp_each_motion_by_their_ratio() {
    let law = Law { damping: [0.1, 0.2, 0.3, 0.4], ..law() };
    // Masses 3, inertias 2: M = 3/2 along, 1 for rotation.
    let (force, _) = damped::<Viscous>(&law, [0.5, 0.0, 0.0], [0.0; 3]);
    assert!((force.x + 0.2 * (10.0 * AREA * 1.5_f64).sqrt() * 0.5).abs() < 1e-14, "{force:?}");
    let (force, _) = damped::<Viscous>(&law, [0.0, 0.5, 0.0], [0.0; 3]);
    let (arm_i, arm_j) = (2.1 / 1.6, 2.1 * 0.6 / 1.6);
    let mass = 1.0 / (2.0 / 3.0 + (arm_i * arm_i + arm_j * arm_j) / 2.0);
    assert!((force.y + 0.4 * (4.0 * AREA * mass).sqrt() * 0.5).abs() < 1e-14, "{force:?}");
    let (_, torque) = damped::<Viscous>(&law, [0.0; 3], [0.7, 0.0, 0.0]);
    assert!((torque.x + 0.6 * (4.0 * AREA * 0.18_f64).sqrt() * 0.7).abs() < 1e-14, "{torque:?}");
}
