//! Points worked out by hand: breakage, damping, the first steps of the engine's bond.

use crate::bonds::laws::placement::RADII;
use cograin::bond::breakage::{Rule, distance::Distance, stress::StressLimits};
use cograin::bond::damping::LastDamping;
use cograin::bond::formulation::FormulationChoice;
use cograin::bond::keys::{DampingChoice, PartKeys};
use cograin::bond::{Body, Elasticity, Law, Pair, Quaternion, Reaction, Rows};
use cograin::number::Vector;
use cograin::quantity::{Fraction, NonNegative};

/// Two bodies along x at this distance, j at the origin, with the velocity and spin of i.
fn pair(distance: f64, velocity: [f64; 3], spin: [f64; 3]) -> Pair {
    let body = |index: usize, position: [f64; 3], velocity: [f64; 3], spin: [f64; 3]| Body {
        position: position.into(),
        velocity: velocity.into(),
        spin: spin.into(),
        orientation: Quaternion::identity(),
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
fn elasticity() -> Elasticity {
    Elasticity::of(1.0, 10.0, 4.0)
}

/// What a bond of this formulation without damping and breakage does.
fn react(formulation: FormulationChoice, law: Elasticity, step: f64, pair: &Pair, rows: &Rows) -> Reaction {
    Law::elastic(formulation, law).react(&law.at_step(step), pair, rows, &LastDamping::default())
}

/// The engine's.
const ENGINE: FormulationChoice = FormulationChoice::EngineExact;

/// A = π r_b².
const AREA: f64 = 0.36 * std::f64::consts::PI;

#[test]
fn the_engines_step_by_hand() {
    // u = −0.1; v_s = (0, 1.5, 0) + e × l_i w_i with l_i = 2.1 · 1/1.6 and w_i = (0.2, 0, 0.4): y: 1.5 − 0.4 l_i.
    let pair = pair(2.1, [0.3, 1.5, 0.0], [0.2, 0.0, 0.4]);
    let law = Elasticity { relaxation_rate: [0.5, 1.0, 1.5, 2.0], ..elasticity() };
    let rows = stored([0.7, 2.0, 0.0], 0.3, [0.5, 0.6, 0.8]);
    let found = react(ENGINE, law, 0.1, &pair, &rows);
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
    let found = react(ENGINE, elasticity(), 0.1, &pair, &rows);
    assert_eq!(found.torque_i, Vector::zero());
    assert_eq!(found.rows, rows);
    // Laid out as the other rate form keeps it, the same load acts.
    let rows = [[0.0, 0.0, 0.0, 2.0], [0.0, 0.6, 0.8, 0.0], [0.0; 4]];
    let found = react(FormulationChoice::Incremental, elasticity(), 0.1, &pair, &rows);
    assert!((found.torque_i - Vector::new(0.0, 0.6, 0.8)).length() < 1e-15);
}

#[test]
fn the_evaluation_before_the_first_step_changes_nothing() {
    let pair = pair(2.1, [0.3, 1.5, 0.0], [0.2, 0.0, 0.4]);
    let law = Elasticity { relaxation_rate: [0.5; 4], ..elasticity() };
    let rows = stored([0.0, 2.0, 0.0], 0.3, [0.0, 0.6, 0.8]);
    assert_eq!(react(ENGINE, law, 0.0, &pair, &rows).rows, rows);
    let rows = [[0.0, 2.0, 0.0, 2.0], [0.0, 0.6, 0.8, 0.3], [0.0; 4]];
    assert_eq!(react(FormulationChoice::Incremental, elasticity(), 0.0, &pair, &rows).rows, rows);
    let finite = FormulationChoice::FiniteRotation;
    let rows = (Law::elastic(finite, elasticity()).one_bond().create)(&elasticity().at_step(0.0), &pair);
    assert_eq!(react(finite, elasticity(), 0.0, &pair, &rows).rows, rows);
}

/// Limits that nothing reaches; compression relieves.
const UNBROKEN: StressLimits = StressLimits {
    compression_strength: f64::INFINITY,
    tension_strength: f64::INFINITY,
    shear_strength: f64::INFINITY,
    friction: 0.0,
    compression_share: -1.0,
};

/// Why the engine's bond at rest length 2 breaks at a distance with stored shear and bending along y, if it does.
fn broken(rule: StressLimits, distance: f64, shear: f64, bending: f64) -> Option<&'static str> {
    broken_by(vec![Rule::of(rule)], distance, [shear, 0.0, bending])
}

/// The same with stored torsion.
fn broken_with(rule: StressLimits, distance: f64, shear: f64, torsion: f64, bending: f64) -> Option<&'static str> {
    broken_by(vec![Rule::of(rule)], distance, [shear, torsion, bending])
}

/// The same by these rules: shear, torsion and bending are stored.
fn broken_by(breakage: Vec<Rule>, distance: f64, [shear, torsion, bending]: [f64; 3]) -> Option<&'static str> {
    let rows = stored([0.0, shear, 0.0], torsion, [0.0, bending, 0.0]);
    let pair = pair(distance, [0.0; 3], [0.0; 3]);
    let law = Law { breakage, ..Law::elastic(ENGINE, elasticity()) };
    let found = law.react(&elasticity().at_step(0.0), &pair, &rows, &LastDamping::default());
    let cause = law.cause_name(found.cause);
    assert_eq!(cause.is_some(), found.cause != 0.0);
    if cause.is_some() {
        assert_eq!(found.force, Vector::zero());
        assert_eq!((found.torque_i, found.torque_j), (Vector::zero(), Vector::zero()));
    }
    cause
}

#[test]
fn each_stress_breaks_beyond_its_limit_and_names_itself() {
    let law = StressLimits { tension_strength: 1.0, compression_strength: 2.0, shear_strength: 0.5, ..UNBROKEN };
    // σ = k_n |u|.
    assert_eq!(broken(law, 2.09, 0.0, 0.0), None);
    assert_eq!(broken(law, 2.11, 0.0, 0.0), Some("tension"));
    let breaks = StressLimits { compression_share: 1.0, ..law };
    assert_eq!(broken(breaks, 1.81, 0.0, 0.0), None);
    assert_eq!(broken(breaks, 1.79, 0.0, 0.0), Some("compression"));
    assert_eq!(broken(law, 1.0, 0.0, 0.0), None, "compression relieves");
    // τ = F/A.
    assert_eq!(broken(law, 2.0, 0.499 * AREA, 0.0), None);
    assert_eq!(broken(law, 2.0, 0.501 * AREA, 0.0), Some("shear"));
    // σ = 4 M/(A r_b), of a bond neither stretched nor compressed, against the strength in tension.
    assert_eq!(broken(law, 2.0, 0.0, 0.249 * AREA * 0.6), None);
    assert_eq!(broken(law, 2.0, 0.0, 0.251 * AREA * 0.6), Some("bending"));
    // Compressed by 0.05: −0.5 + bending against 2.
    assert_eq!(broken(law, 1.95, 0.0, 2.49 / 4.0 * AREA * 0.6), None);
    assert_eq!(broken(law, 1.95, 0.0, 2.51 / 4.0 * AREA * 0.6), Some("bending"));
    let both = vec![Rule::of(Distance { most: 2.05 }), Rule::of(law)];
    assert_eq!(broken_by(both.clone(), 2.2, [0.0; 3]), Some("distance"), "the first rule of the list names the cause");
    assert_eq!(broken_by(both.clone(), 2.04, [0.501 * AREA, 0.0, 0.0]), Some("shear"));
    assert_eq!(broken_by(both, 2.04, [0.0; 3]), None);
}

#[test]
fn the_larger_part_of_a_stress_names_the_cause() {
    let law = StressLimits { tension_strength: 1.0, compression_strength: 1.0, shear_strength: 0.5, ..UNBROKEN };
    let bending = |stress: f64| stress / 4.0 * AREA * 0.6;
    let torsion = |stress: f64| stress / 2.0 * AREA * 0.6;
    // 0.6 from stretching against 0.5 from bending, and the other way round; both at 0.05 and 0.06 m.
    assert_eq!(broken(law, 2.06, 0.0, bending(0.5)), Some("tension"));
    assert_eq!(broken(law, 2.05, 0.0, bending(0.6)), Some("bending"));
    let breaks = StressLimits { compression_share: 1.0, ..law };
    assert_eq!(broken(breaks, 1.94, 0.0, bending(0.5)), Some("compression"));
    assert_eq!(broken(breaks, 1.95, 0.0, bending(0.6)), Some("bending"));
    assert_eq!(broken_with(law, 2.0, 0.3 * AREA, torsion(0.25), 0.0), Some("shear"));
    assert_eq!(broken_with(law, 2.0, 0.25 * AREA, torsion(0.3), 0.0), Some("torsion"));
    // The normal stress is looked at first.
    assert_eq!(broken_with(law, 2.0, 0.0, torsion(0.6), bending(1.1)), Some("bending"));
}

#[test]
fn friction_raises_the_shear_strength_under_compression_and_lowers_it_under_tension() {
    let law = StressLimits { shear_strength: 0.5, friction: 0.5, ..UNBROKEN };
    // |N|/A = 0.4.
    assert_eq!(broken(law, 1.96, 0.69 * AREA, 0.0), None);
    assert_eq!(broken(law, 1.96, 0.71 * AREA, 0.0), Some("shear"));
    assert_eq!(broken(law, 2.04, 0.29 * AREA, 0.0), None);
    assert_eq!(broken(law, 2.04, 0.31 * AREA, 0.0), Some("shear"));
    assert_eq!(broken(law, 2.11, 0.0, 0.0), Some("shear"), "a negative strength breaks at once");
}

/// Four numbers as keys.
fn parts<T>(numbers: [f64; 4], checked: impl Fn(f64) -> Option<T>) -> PartKeys<T> {
    let [normal_force, tangential_force, normal_torque, tangential_torque] = numbers.map(checked);
    PartKeys { normal_force, tangential_force, normal_torque, tangential_torque }
}

/// What damping alone adds to force and torque on i, of a bond stretched by 0.1 with shear 2 along y and bending 0.5 along y.
fn damped(damping: DampingChoice, velocity: [f64; 3], spin: [f64; 3]) -> (Vector, Vector) {
    let rows = stored([0.0, 2.0, 0.0], 0.0, [0.0, 0.5, 0.0]);
    let pair = pair(2.1, velocity, spin);
    let bare = Law::elastic(ENGINE, elasticity());
    let law = Law { damping: Some(damping), ..bare.clone() };
    let [with, without] =
        [law, bare].map(|law| law.react(&elasticity().at_step(0.0), &pair, &rows, &LastDamping::default()));
    assert_eq!(with.rows, without.rows, "the state does not see damping");
    // Force and torques on both bodies: no torque is left over about the second body.
    let torques = with.torque_i - without.torque_i + (with.torque_j - without.torque_j);
    let force = with.force - without.force;
    assert!((torques + pair.connection.cross(force)).length() < 1e-13, "{torques:?}");
    (force, with.torque_i - without.torque_i)
}

#[test]
fn opposing_damping_is_a_share_of_the_force_against_the_rate() {
    let damping = DampingChoice::Opposing(parts([0.1, 0.2, 0.3, 0.4], Fraction::new));
    let (force, torque) = damped(damping, [0.5, 3.0, 4.0], [0.0; 3]);
    let expected = Vector::new(-0.1 * AREA, -0.4 * 0.6, -0.4 * 0.8);
    assert!((force - expected).length() < 1e-14, "{force:?}");
    // (F × e) l_i with e along x.
    let arm = 2.1 / 1.6;
    assert!((torque - Vector::new(0.0, expected.z * arm, -expected.y * arm)).length() < 1e-14, "{torque:?}");
    let (force, torque) = damped(damping, [0.0; 3], [0.0; 3]);
    assert_eq!((force, torque), (Vector::zero(), Vector::zero()), "nothing moves, nothing is damped");
}

#[test]
fn the_engines_damping_goes_axis_by_axis() {
    let damping = DampingChoice::Sign(parts([0.1, 0.2, 0.3, 0.4], Fraction::new));
    let (force, _) = damped(damping, [0.5, 3.0, 4.0], [0.0; 3]);
    assert!((force - Vector::new(-0.1 * AREA, -0.4, 0.0)).length() < 1e-14, "{force:?}");
    let (force, torque) = damped(damping, [0.0; 3], [0.0; 3]);
    assert_eq!((force, torque), (Vector::zero(), Vector::zero()));
}

#[test]
fn the_smooth_threshold_is_that_of_the_engine() {
    let damping = Some(DampingChoice::Smooth(parts([0.1; 4], Fraction::new)));
    let step = 1e-3;
    let rows = stored([0.0; 3], 0.0, [0.0; 3]);
    let force = |speed: f64, distance: f64| {
        let bare = Law::elastic(ENGINE, elasticity());
        let pair = pair(distance, [speed, 0.0, 0.0], [0.0; 3]);
        let of = |law: &Law| law.react(&elasticity().at_step(step), &pair, &rows, &LastDamping::default()).force.x;
        of(&Law { damping, ..bare.clone() }) - of(&bare)
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
    let damping = DampingChoice::Viscous(parts([0.1, 0.2, 0.3, 0.4], NonNegative::new).into());
    // Masses 3, inertias 2: M = 3/2 along, 1 for rotation.
    let (force, _) = damped(damping, [0.5, 0.0, 0.0], [0.0; 3]);
    assert!((force.x + 0.2 * (10.0 * AREA * 1.5_f64).sqrt() * 0.5).abs() < 1e-14, "{force:?}");
    let (force, _) = damped(damping, [0.0, 0.5, 0.0], [0.0; 3]);
    let (arm_i, arm_j) = (2.1 / 1.6, 2.1 * 0.6 / 1.6);
    let mass = 1.0 / (2.0 / 3.0 + (arm_i * arm_i + arm_j * arm_j) / 2.0);
    assert!((force.y + 0.4 * (4.0 * AREA * mass).sqrt() * 0.5).abs() < 1e-14, "{force:?}");
    let (_, torque) = damped(damping, [0.0; 3], [0.7, 0.0, 0.0]);
    assert!((torque.x + 0.6 * (4.0 * AREA * 0.18_f64).sqrt() * 0.7).abs() < 1e-14, "{torque:?}");
}
