//! How contacts are carried, and what dashpots see.

use super::*;
use crate::laws::contact::fixtures::{assert_close, contact, normal_force};

/// A step \[s\].
const STEP: f64 = 1e-3;

/// Two spheres with arms of 1 m that turn as one body with this angular velocity \[rad/s\] about the point where they touch,
/// seen at the end of a step: the normal is z there.
fn as_one(spin: Vector) -> Contact {
    let normal = Vector::new(0.0, 0.0, 1.0);
    // Velocities are those of mid-step, where the line of centres was half a step behind.
    let middle = normal - spin.cross(normal) * (0.5 * STEP);
    let across = spin.cross(middle) * 2.0;
    let normal_velocity = across.dot(normal);
    let turning = spin * 2.0;
    let slip = across - normal * normal_velocity - turning.cross(normal);
    Contact { normal, normal_velocity, slip, spin_sum: turning, turning, per_distance: 0.5, overlap: 0.5, ..contact() }
}

/// A vector turned with an angular velocity \[rad/s\] over a step, to the third order of the angle.
fn turned(spin: Vector, vector: Vector, step: f64) -> Vector {
    let once = spin.cross(vector) * step;
    let twice = spin.cross(once) * step;
    vector + once + twice * 0.5
}

#[test]
fn a_spring_turns_with_bodies_that_turn_as_one() {
    for spin in [Vector::new(0.0, 0.0, 5.0), Vector::new(3.0, 0.0, 0.0), Vector::new(2.0, -1.0, 4.0)] {
        let contact = as_one(spin);
        let carry = Carry::of(&contact, STEP, true);
        assert!(carry.stretch.length() < 1e-4 * spin.length() * STEP, "{:?}", carry.stretch);
        let before_normal = turned(spin, contact.normal, -STEP);
        let before = before_normal.cross(Vector::new(0.0, 1.0, 0.25));
        let carried =
            Vector::of_row(Carry { stretch: Vector::zero(), ..carry }.spring(contact.normal, before.row_with(7.0)));
        let expected = turned(spin, before, STEP);
        assert!((carried - expected).length() < 5e-6, "{carried:?}, {expected:?} expected");
        assert_eq!(carried.dot(contact.normal), 0.0);
    }
}

#[test]
fn a_torque_turns_with_the_part_along_the_normal_and_keeps_its_length() {
    let spin = Vector::new(2.0, -1.0, 4.0);
    let contact = as_one(spin);
    let before = Vector::new(0.5, -2.0, 3.0);
    let row = Carry::of(&contact, STEP, true).torque(contact.normal, before.row_with(7.0));
    let (carried, expected) = (Vector::of_row(row), turned(spin, before, STEP));
    assert!((carried - expected).length() < 3e-5, "{carried:?}, {expected:?} expected");
    assert_close(carried.length(), before.length(), 1e-15);
    assert_eq!(row[3], 7.0);
}

#[test]
fn a_contact_that_begins_slipped_for_the_part_of_the_step_in_which_it_touched() {
    // Approaches at ½ m/s: 2 s for an overlap of 1 m; the step has 4 s.
    let approaching =
        Contact { overlap: 1.0, per_distance: 0.0, spin_sum: Vector::zero(), turning: Vector::zero(), ..contact() };
    let carry = Carry::of(&approaching, 4.0, true);
    assert_eq!((carry.share, carry.stretch), (0.5, approaching.slip * 2.0));
    assert_eq!(Carry::of(&approaching, 4.0, false).share, 1.0, "where bodies hold together beyond touch");
    assert_eq!(Carry::of(&approaching, 1.0, true).share, 1.0, "it touched before");
}

#[test]
fn the_first_and_the_last_force_of_a_dashpot_stand_for_the_time_in_which_bodies_touch() {
    let at = |normal_velocity| Contact { overlap: 1.0, normal_velocity, per_distance: 0.0, ..contact() };
    let weight = |velocity, onset| {
        let mut contact = at(velocity);
        Carry::of(&contact, 4.0, true).weigh(&mut contact, onset, 4.0, [velocity, 0.0]);
        contact.normal_velocity / velocity
    };
    // Half a step of touch before or after, and half a step beyond: as long as a whole one.
    for velocity in [-0.5, 0.5] {
        assert_eq!(weight(velocity, Onset::Constant), 1.0);
        assert_eq!(weight(velocity, Onset::Unweighed), 1.0);
        // (θ + ½)^(1 + p)/((1 + p) θ^p) with θ = ½
        assert_close(weight(velocity, Onset::SquareRoot), 2.0_f64.sqrt() / 1.5, 1e-15);
        assert_close(weight(velocity, Onset::FourthRoot), 2.0_f64.sqrt().sqrt() / 1.25, 1e-15);
    }
    assert_eq!(weight(-1.0, Onset::Constant), 0.75);
    assert_eq!(weight(-0.25, Onset::Constant), 1.5, "it touched a step ago, and did not press");
    assert_eq!(weight(-0.125, Onset::Constant), 1.0, "it pressed a step ago");
    let mut flat = Contact { overlap: 0.0, ..at(-1.0) };
    Carry::of(&flat, 4.0, true).weigh(&mut flat, Onset::Constant, 4.0, [-1.0, 0.0]);
    assert_eq!(flat.normal_velocity, 0.0, "it does not press yet");
    assert_eq!(weight(0.125, Onset::Constant), 1.0, "it touches in the next step, too");
}

#[test]
fn a_contact_that_seemed_to_end_is_weighed_for_what_is_left_of_its_time() {
    let weight = |velocity: f64, before: f64| {
        let mut contact = Contact { overlap: 1.0, normal_velocity: velocity, per_distance: 0.0, ..contact() };
        Carry::of(&contact, 4.0, true).weigh(&mut contact, Onset::Constant, 4.0, [velocity, before]);
        contact.normal_velocity / velocity
    };
    // A step ago the overlap was 1.5 m: at 0.5 m/s it would have ended after ¾ of the step, for which it was weighed.
    assert_close(weight(0.125, 0.5), 0.25 + 0.5, 1e-15);
    // It was 2 m, and now it does end, after half of the step.
    assert_close(weight(0.25, 1.0), 0.5 + 0.5, 1e-15);
    assert_close(weight(0.5, 1.0), 0.25 + 0.5, 1e-15);
    assert_eq!(weight(0.125, 0.25), 1.0, "a step ago nothing said that it would end");
}

#[test]
fn dashpots_see_velocities_of_the_end_of_the_step() {
    let now = Contact { per_distance: 0.0, spin_sum: Vector::zero(), turning: Vector::zero(), ..contact() };
    let carry = Carry::of(&now, 1e-6, true);
    let mut seen = now;
    let first = carry.foresee(&mut seen, [0.0; 4], 1e-6);
    assert_eq!(seen.normal_velocity, now.normal_velocity, "a contact that begins keeps what it has");
    assert_close(first[1], now.slip.x, 1e-15);
    let mut seen = now;
    carry.foresee(&mut seen, [-0.25, 1.0, 4.0, 0.0], 1e-6);
    assert_eq!(seen.normal_velocity, -0.625);
    assert_close(seen.slip.x, 4.0, 1e-15);
    assert_close(seen.slip.y, 4.0, 1e-15);
    let mut still = now;
    assert_eq!(
        Carry::of(&now, 0.0, true).foresee(&mut still, first, 0.0),
        first,
        "where time stands nothing is remembered"
    );
    assert_eq!(still.slip, now.slip);
}

#[test]
fn rolling_springs_grow_by_the_mean_of_the_stiffnesses() {
    let carry = Carry::of(&contact(), 0.0, true);
    let mean = |before| carry.mean_stiffness(&normal_force(), before).response;
    assert_eq!(mean(512.0).normal_stiffness, 768.0);
    assert_eq!(mean(512.0).tangential_stiffness, 6.0);
    assert_eq!(mean(0.0).normal_stiffness, 1024.0, "a contact that begins");
}
