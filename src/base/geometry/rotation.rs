//! Rotation vectors and the orientations they stand for.

use super::Quaternion;
use crate::base::number::Vector;

/// Below this length a vector part has no direction worth following.
const NOTHING: f64 = 1e-150;

/// The orientation that a rotation vector \[rad\] turns to. It changes continuously over any number of turns.
pub(crate) fn orientation(rotation: Vector) -> Quaternion {
    let angle = rotation.length();
    if angle < NOTHING {
        return Quaternion { scalar: 1.0, vector: rotation * 0.5 };
    }
    let (sine, cosine) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
    Quaternion { scalar: cosine, vector: rotation * (sine / angle) }
}

/// The rotation vector of an orientation that is nearest to `before`: full turns are counted on \[rad\].
pub(crate) fn vector_near(orientation: Quaternion, before: Vector) -> Vector {
    use std::f64::consts::TAU;
    let sine = orientation.vector.length();
    if sine < NOTHING {
        let length = before.length();
        return if length < NOTHING { before } else { before * (TAU * (length / TAU).round() / length) };
    }
    let direction = orientation.vector * (1.0 / sine);
    let angle = 2.0 * libm::atan2(sine, orientation.scalar);
    let turns = ((before.dot(direction) - angle) / TAU).round();
    direction * (angle + TAU * turns)
}

/// The rotation vector from one orientation to another, in global axes, up to a full turn: which way round it goes, the
/// signs of the quaternions say \[rad\].
pub(crate) fn between(from: Quaternion, to: Quaternion) -> Vector {
    let turn = to * from.conjugate();
    let sine = turn.vector.length();
    if sine < NOTHING { Vector::zero() } else { turn.vector * (2.0 * libm::atan2(sine, turn.scalar) / sine) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vector_comes_back_from_its_orientation_after_any_number_of_turns() {
        for (length, before) in [(0.3, 0.0), (3.5, 3.4), (7.0, 6.9), (-20.0, -19.5)] {
            let axis = Vector::new(0.6, -0.48, 0.64);
            let found = vector_near(orientation(axis * length), axis * before);
            assert!((found - axis * length).length() < 1e-13, "{found:?} for a length of {length}");
        }
    }

    #[test]
    fn a_full_turn_is_followed_through() {
        let z = Vector::new(0.0, 0.0, 1.0);
        let full = Quaternion { scalar: -1.0, vector: Vector::zero() };
        let found = vector_near(full, z * 6.2);
        assert!((found - z * std::f64::consts::TAU).length() < 2e-15, "{found:?}");
    }

    #[test]
    fn between_two_orientations_it_goes_the_way_of_their_vectors() {
        let z = Vector::new(0.0, 0.0, 1.0);
        for (from, to) in [(-1.5, 2.0), (7.0, 7.5), (0.4, 0.1)] {
            let found = between(orientation(z * from), orientation(z * to)).z;
            let expected: f64 = to - from;
            assert!((found - expected).abs() < 1e-14, "{found}, not {expected}");
        }
    }
}
