//! `finite_rotation`: force and moments against central differences of the energy.

use crate::bonds::laws::placement::{Placement, Random, answer, created, law, turn};
use cograin::bond::Formulation;
use cograin::bond::formulation::finite_rotation::FiniteRotation;
use cograin::number::Vector;

/// The formulation under trial.
type Finite = FiniteRotation<false>;

/// Moves or turns one body by a small amount along one axis.
fn nudged(placement: &Placement, body: usize, axis: usize, by: f64, turning: bool) -> Placement {
    let mut nudged = *placement;
    let mut vector = [0.0; 3];
    vector[axis] = by;
    if turning {
        nudged.orientation[body] = turn(vector.into()) * nudged.orientation[body];
    } else {
        nudged.position[body] += Vector::from(vector);
    }
    nudged
}

#[test]
fn force_and_moments_are_the_gradient_of_the_energy() {
    let mut random = Random(1);
    let law = law();
    let mut bent = 0.0_f64;
    for trial in 0..400 {
        let start = Placement::random(&mut random);
        let rows = created::<Finite>(&law, &start);
        let size = [1e-3, 0.1, 0.4, 1.2][trial % 4];
        let placement = start.disturbed(&mut random, 0.5 * size, size);
        let found = answer::<Finite>(&law, &placement, &rows);
        bent = bent.max(found.bending.length() / (law.bending * 0.25 * std::f64::consts::PI * 0.54_f64.powi(4)));
        let (force, torques) = (found.force.to_array(), [found.torque_i.to_array(), found.torque_j.to_array()]);
        for body in 0..2 {
            for axis in 0..3 {
                for turning in [false, true] {
                    let by = 1e-5;
                    let energy =
                        |by| answer::<Finite>(&law, &nudged(&placement, body, axis, by, turning), &rows).energy;
                    // Fourth-order central difference.
                    let slope =
                        (8.0 * (energy(by) - energy(-by)) - (energy(2.0 * by) - energy(-2.0 * by))) / (12.0 * by);
                    let expected = match (turning, body) {
                        (true, body) => torques[body][axis],
                        (false, 0) => force[axis],
                        (false, _) => -force[axis],
                    };
                    // Rounding of the energy over the step: 1e-16/1e-5 of an energy of order 1.
                    let bound = 2e-10 * (1.0 + found.energy);
                    assert!(
                        (slope + expected).abs() < bound,
                        "trial {trial}, body {body}, axis {axis}, turning {turning}: {expected} for {}",
                        -slope
                    );
                }
            }
        }
    }
    assert!(bent > 2.0, "trials reach large bending: {bent} rad");
}

#[test]
fn nothing_acts_where_the_bond_was_made_and_wherever_it_is_carried() {
    let mut random = Random(2);
    let law = law();
    for _ in 0..100 {
        let start = Placement::random(&mut random);
        let rows = created::<Finite>(&law, &start);
        let found = answer::<Finite>(&law, &start.turned(random.turn(6.0)), &rows);
        let largest = found.force.length().max(found.torque_i.length()).max(found.torque_j.length());
        assert!(largest < 1e-14, "{largest:e}");
    }
}

#[test]
fn turning_the_pair_turns_force_and_moments() {
    let mut random = Random(3);
    let law = law();
    for _ in 0..100 {
        let start = Placement::random(&mut random);
        let rows = created::<Finite>(&law, &start);
        let placement = start.disturbed(&mut random, 0.3, 0.8);
        let whole = random.turn(3.0);
        let before = answer::<Finite>(&law, &placement, &rows);
        let after = answer::<Finite>(&law, &placement.turned(whole), &rows);
        assert!((after.energy - before.energy).abs() < 1e-13);
        assert!((after.force - whole.turn(before.force)).length() < 1e-13);
        assert!((after.torque_i - whole.turn(before.torque_i)).length() < 1e-13);
        assert!((after.torque_j - whole.turn(before.torque_j)).length() < 1e-13);
    }
}

#[test]
fn exchanging_the_bodies_changes_nothing() {
    let mut random = Random(4);
    let law = law();
    let radii = crate::bonds::laws::placement::RADII;
    for _ in 0..100 {
        let start = Placement::random(&mut random);
        let placement = start.disturbed(&mut random, 0.3, 0.8);
        let found = answer::<Finite>(&law, &placement, &created::<Finite>(&law, &start));
        let swap = |placement: &Placement| {
            let mut pair = Placement {
                position: [placement.position[1], placement.position[0]],
                orientation: [placement.orientation[1], placement.orientation[0]],
            }
            .pair();
            (pair.share_i, pair.share_j) = (radii[1] / (radii[0] + radii[1]), radii[0] / (radii[0] + radii[1]));
            pair
        };
        let law = law.at_step(0.0);
        let rows = <Finite as Formulation>::create(&law, &swap(&start));
        let (_, other) = <Finite as Formulation>::respond(&law, &swap(&placement), &rows);
        assert!((other.energy - found.energy).abs() < 1e-13);
        assert!((other.force + found.force).length() < 1e-13);
        assert!((other.torque_i - found.torque_j).length() < 1e-13);
        assert!((other.torque_j - found.torque_i).length() < 1e-13);
        assert!((other.torsion - found.torsion).abs() < 1e-13);
    }
}

#[test]
fn twist_is_counted_over_many_turns() {
    let law = law();
    let mut random = Random(5);
    let start = Placement::random(&mut random);
    let axis = (start.position[0] - start.position[1]) * (1.0 / 1.65);
    let mut rows = created::<Finite>(&law, &start);
    let polar = 0.5 * std::f64::consts::PI * 0.54_f64.powi(4);
    for step in 1..=200 {
        let angle = 0.1 * f64::from(step);
        let mut placement = start;
        placement.orientation[1] = turn(axis * angle) * placement.orientation[1];
        let found = answer::<Finite>(&law, &placement, &rows);
        rows = found.rows;
        let expected = law.torsion * polar * angle;
        assert!(
            (found.torsion - expected).abs() < 1e-13 * (1.0 + expected),
            "{angle}: {} for {expected}",
            found.torsion
        );
        assert!((found.torque_i - axis * expected).length() < 1e-12 * (1.0 + expected));
    }
}

#[test]
fn bending_is_linear_in_the_angle_up_to_pi_and_an_error_beyond() {
    let law = law();
    let mut random = Random(6);
    let start = Placement::random(&mut random);
    let axis = start.position[0] - start.position[1];
    let across = axis.cross(Vector::new(0.3, -0.5, 0.7));
    let across = across * (1.0 / across.length());
    let rows = created::<Finite>(&law, &start);
    let section = 0.25 * std::f64::consts::PI * 0.54_f64.powi(4);
    for (angle, over) in [(0.01, false), (0.5, false), (2.0, false), (3.1, false), (3.2, true), (4.0, true)] {
        let mut placement = start;
        // Each body takes half, so that none is turned by π against the axis.
        placement.orientation[0] = turn(across * (0.5 * angle)) * placement.orientation[0];
        placement.orientation[1] = turn(across * (-0.5 * angle)) * placement.orientation[1];
        let found = answer::<Finite>(&law, &placement, &rows);
        assert_eq!(found.overbent, over, "{angle}");
        let expected = across * (-law.bending * section * angle);
        assert!((found.bending - expected).length() < 1e-13, "{angle}: {:?} for {expected:?}", found.bending);
    }
}
