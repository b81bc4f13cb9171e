//! Closed loops, rigid rotation, relaxation: what is kept and what is booked.

use crate::bonds::laws::placement::{Placement, Random, answer, created, law, turn};
use cograin::bond::Formulation;
use cograin::bond::formulation::finite_rotation::FiniteRotation;
use cograin::geometry::Quaternion;
use cograin::number::Vector;

/// The formulation under trial.
type Finite = FiniteRotation<false>;

#[test]
fn a_closed_loop_does_no_work() {
    // Work is integrated over a smooth random loop of relative motion and rotation. The trapezoidal rule is exact to
    // rounding for a periodic path once it resolves it.
    let law = law();
    let mut random = Random(7);
    for _ in 0..10 {
        let start = Placement::random(&mut random);
        let mut rows = created::<Finite>(&law, &start);
        let waves: Vec<[Vector; 2]> = (0..8).map(|_| [random.vector(), random.vector()]).collect();
        let steps = 2000;
        let (mut work, mut path) = (0.0, 0.0);
        for step in 0..steps {
            let phase = std::f64::consts::TAU * f64::from(step) / f64::from(steps);
            // Position and rotation of each body as Fourier sums, with their rates by phase.
            let wave = |index: usize, size: f64| {
                let [a, b] = waves[index];
                let [c, d] = waves[index + 1];
                let (s, k) = (libm::sin(phase), libm::cos(phase));
                let (s2, k2) = (libm::sin(2.0 * phase), libm::cos(2.0 * phase));
                let value = (a * s + b * (1.0 - k) + c * s2 + d * (1.0 - k2)) * size;
                let rate = (a * k + b * s + c * (2.0 * k2) + d * (2.0 * s2)) * size;
                (value, rate)
            };
            let mut placement = start;
            let (shift_i, velocity_i) = wave(0, 0.1);
            let (shift_j, velocity_j) = wave(2, 0.1);
            placement.position[0] += shift_i;
            placement.position[1] += shift_j;
            let (angle_i, rate_i) = wave(4, 0.2);
            let (angle_j, rate_j) = wave(6, 0.2);
            let spin_i = spin(angle_i, rate_i);
            let spin_j = spin(angle_j, rate_j);
            placement.orientation[0] = turn(angle_i) * placement.orientation[0];
            placement.orientation[1] = turn(angle_j) * placement.orientation[1];
            let found = answer::<Finite>(&law, &placement, &rows);
            rows = found.rows;
            let power =
                found.force.dot(velocity_i - velocity_j) + found.torque_i.dot(spin_i) + found.torque_j.dot(spin_j);
            work += power * std::f64::consts::TAU / f64::from(steps);
            path += power.abs() * std::f64::consts::TAU / f64::from(steps);
        }
        assert!(path > 0.1, "{path}");
        assert!(work.abs() < 1e-13 * path, "{work:e} of {path}");
    }
}

/// Angular velocity of the turn by a rotation vector that changes at this rate.
fn spin(rotation: Vector, rate: Vector) -> Vector {
    let square = rotation.dot(rotation);
    let angle = square.sqrt();
    if angle < 1e-9 {
        return rate;
    }
    let first = (1.0 - libm::cos(angle)) / square;
    let second = (angle - libm::sin(angle)) / (square * angle);
    rate + rotation.cross(rate) * first + rotation.cross(rotation.cross(rate)) * second
}

#[test]
fn a_loaded_pair_keeps_force_and_energy_through_a_thousand_turns() {
    let law = law();
    let mut random = Random(8);
    let start = Placement::random(&mut random);
    let mut rows = created::<Finite>(&law, &start);
    let loaded = start.disturbed(&mut random, 0.05, 0.1);
    let first = answer::<Finite>(&law, &loaded, &rows);
    let axis = Vector::new(0.48, 0.6, -0.64);
    let steps = 60;
    let step = std::f64::consts::TAU / f64::from(steps);
    let mut placement = loaded;
    let one = turn(axis * step);
    for _ in 0..1000 {
        let mut whole = Quaternion::identity();
        for _ in 0..steps {
            whole = one * whole;
            placement.orientation = placement.orientation.map(|orientation| orientation.turned(axis, step));
            placement.position = loaded.position.map(|position| whole.turn(position));
            let found = answer::<Finite>(&law, &placement, &rows);
            rows = found.rows;
            assert!((found.energy / first.energy - 1.0).abs() < 1e-9);
            assert!((found.force.length() / first.force.length() - 1.0).abs() < 1e-9);
        }
    }
    let last = answer::<Finite>(&law, &placement, &rows);
    assert!((last.force - first.force).length() < 1e-9 * first.force.length());
    assert!((last.torque_i - first.torque_i).length() < 1e-9 * first.torque_i.length());
    assert!((last.energy / first.energy - 1.0).abs() < 1e-9);
}

#[test]
fn relaxation_takes_what_it_books_and_leaves_the_shares_it_should() {
    let mut law = law();
    law.relaxation_rate = [0.1, 0.2, 0.3, 0.4];
    let mut random = Random(9);
    for trial in 0..100 {
        let size = [0.01, 0.2, 1.0][trial % 3];
        let start = Placement::random(&mut random);
        let rows = created::<FiniteRotation<true>>(&law, &start);
        let placement = start.disturbed(&mut random, 0.3 * size, size);
        let (_, relaxing) = <FiniteRotation<true> as Formulation>::respond(&law.at_step(1.0), &placement.pair(), &rows);
        let before = answer::<Finite>(&law, &placement, &rows);
        let after = answer::<Finite>(&law, &placement, &relaxing.rows);
        let scale = before.energy;
        assert!((relaxing.force - before.force).length() < 1e-13, "the force is that before relaxation");
        assert!((after.energy - relaxing.energy).abs() < 1e-11 * scale, "{} {}", after.energy, relaxing.energy);
        assert!((relaxing.energy + relaxing.relaxed - before.energy).abs() < 1e-12 * scale);
        assert!((after.normal - 0.9 * before.normal).abs() < 1e-12);
        assert!((after.shear - before.shear * 0.8).length() < 1e-11);
        assert!((after.torsion - 0.7 * before.torsion).abs() < 1e-11);
        assert!((after.bending - before.bending * 0.6).length() < 1e-11);
    }
}
