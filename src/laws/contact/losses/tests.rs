//! Losses of one contact, by hand.

use super::*;
use crate::laws::contact::fixtures::{contact, normal_force};

/// A law of spring and dashpot along the normal, and of friction with a spring that is projected.
const BOOKED: Booked = Booked {
    friction: true,
    spring: true,
    keeps_stiffness: false,
    limits_dashpot: false,
    projects: true,
    rolling: true,
    presses: true,
    other: true,
    carries: false,
    predicts_normal_alone: false,
    least_force: 0,
    warming: [false; LossKind::COUNT],
    follows: false,
};

/// A contact of normal z whose springs and dashpots do nothing: k_n δ = 1024/16384 N, k_t = 8 N/m.
fn seen() -> Seen<f64> {
    let mut normal = normal_force();
    normal.response.normal_damping = 0.0;
    normal.force = normal.response.normal_stiffness * contact().overlap;
    Seen {
        contact: contact(),
        normal,
        pressing: contact().overlap,
        least_force: f64::NEG_INFINITY,
        acts: true,
        normal_displacement: 0.0,
        tangential_displacement: Vector::zero(),
        turn: Vector::zero(),
        force: contact().normal * normal.force,
        rolling: Vector::zero(),
        spring_before: Vector::zero(),
        spring: [0.0; 4],
        sliding: false,
        before: [[0.0; 4]; 2],
    }
}

/// What is lost of a kind \[J\].
fn lost(seen: &Seen<f64>, kind: LossKind) -> f64 {
    0.5 * seen.twice_losses(&BOOKED).0[kind as usize]
}

#[test]
fn a_dashpot_takes_its_mean_force_times_the_way() {
    let mut seen = seen();
    // It pushed by 3 N, and pushes by 5 N, while the bodies come nearer by 0.25 m.
    seen.normal.response.normal_damping = 10.0;
    seen.contact.normal_velocity = -0.5;
    seen.normal.force += 5.0;
    seen.force.z += 5.0;
    (seen.before[0], seen.normal_displacement) = ([0.0, 0.0, 0.0, 3.0], -0.25);
    assert_eq!(lost(&seen, LossKind::Normal), 1.0);
    assert_eq!(seen.twice_losses(&BOOKED).1[0], [8.0, 0.0, 0.0, 5.0]);
    assert_eq!(lost(&seen, LossKind::Other), 0.0);
}

#[test]
fn a_force_beside_spring_and_dashpot_is_booked_by_itself() {
    let mut seen = seen();
    seen.normal.force -= 2.0;
    seen.force.z -= 2.0;
    (seen.before[1], seen.normal_displacement) = ([-4.0, 0.0, 0.0, 0.0], 0.5);
    assert_eq!(lost(&seen, LossKind::Other), 1.5);
    assert_eq!(seen.twice_losses(&BOOKED).1[1], [-2.0, 0.0, 0.0, 0.0]);
}

#[test]
fn nothing_along_the_normal_is_lost_where_a_bond_suppresses_it() {
    let mut seen = seen();
    (seen.normal.force, seen.normal_displacement, seen.acts) = (7.0, 0.5, false);
    assert_eq!([lost(&seen, LossKind::Normal), lost(&seen, LossKind::Other)], [0.0; 2]);
}

#[test]
fn a_spring_that_sticks_loses_nothing() {
    let mut seen = seen();
    (seen.spring_before, seen.spring) = (Vector::new(1.0, 0.0, 0.0), [1.0, 0.5, 0.0, 0.0]);
    seen.tangential_displacement = Vector::new(0.0, 0.5, 0.0);
    seen.force += Vector::new(-8.0, -4.0, 0.0);
    seen.before[0] = [8.0, 0.0, 0.0, 0.0];
    assert_eq!(seen.twice_losses(&BOOKED).0, [0.0; LossKind::COUNT]);
}

#[test]
fn sliding_takes_the_limit_times_the_way_that_does_not_stretch_the_spring() {
    let mut seen = seen();
    // The spring stays at 8 N while the bodies slip by 0.5 m.
    (seen.spring_before, seen.spring) = (Vector::new(1.0, 0.0, 0.0), [1.0, 0.0, 0.0, 0.0]);
    (seen.tangential_displacement, seen.sliding) = (Vector::new(0.5, 0.0, 0.0), true);
    seen.force.x = -8.0;
    seen.before[0] = [8.0, 0.0, 0.0, 0.0];
    assert_eq!(lost(&seen, LossKind::Sliding), 4.0);
    assert_eq!([lost(&seen, LossKind::Stiffness), lost(&seen, LossKind::Tangential)], [0.0; 2]);
}

#[test]
fn a_spring_that_becomes_stiffer_while_it_is_loaded_gains() {
    let mut seen = seen();
    // From 2 to 8 N/m at 1 m: ½ (8 − 2) J out of nothing
    (seen.spring_before, seen.spring) = (Vector::new(1.0, 0.0, 0.0), [1.0, 0.0, 0.0, 0.0]);
    (seen.force.x, seen.before[0]) = (-8.0, [2.0, 0.0, 0.0, 0.0]);
    assert_eq!(lost(&seen, LossKind::Stiffness), -3.0);
}

#[test]
fn what_is_projected_of_a_spring_is_lost() {
    let mut seen = seen();
    (seen.spring_before, seen.spring) = (Vector::new(1.0, 0.0, 0.5), [1.0, 0.0, 0.0, 0.0]);
    (seen.force.x, seen.before[0]) = (-8.0, [8.0, 0.0, 0.0, 0.0]);
    assert_eq!([lost(&seen, LossKind::Projection), lost(&seen, LossKind::Stiffness)], [1.0, 0.0]);
}

#[test]
fn rolling_takes_the_mean_torque_times_the_angle() {
    let mut seen = seen();
    (seen.rolling, seen.turn) = (Vector::new(3.0, 0.0, 0.0), Vector::new(0.5, 7.0, 0.0));
    seen.before[1] = [0.0, 1.0, 0.0, 0.0];
    assert_eq!(lost(&seen, LossKind::Rolling), 1.0);
}

#[test]
fn what_a_spring_holds_is_lost_as_bodies_part() {
    let contact = Contact { slip: Vector::new(2.0, 0.0, 0.0), normal_velocity: 4.0, ..contact() };
    let before = [[8.0, -3.0, 0.0, -5.0], [-1.0, 0.0, 0.0, 0.0]];
    let (lost, held) = parting(&BOOKED, &contact, 0.5, Vector::new(1.0, 0.0, 0.0), before);
    let of = |kind: LossKind| 0.5 * lost[kind as usize];
    assert_eq!(0.5 * held, 0.5 * 8.0 + 8.0 * 0.5);
    assert_eq!([of(LossKind::Normal), of(LossKind::Tangential), of(LossKind::Other)], [5.0, 1.5, 1.0]);
}
