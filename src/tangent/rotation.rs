//! Orientations and rotation vectors with slopes.

use crate::dual::{Dual, Slopes};
use crate::geometry::Quaternion;
use crate::number::{Number, Vector};

/// Below this length a vector has no direction worth following.
const NOTHING: f64 = 1e-150;

/// The orientation that a rotation vector turns to.
pub(crate) fn orientation<S: Slopes<f64>>(rotation: Vector<Dual<f64, S>>) -> Quaternion<Dual<f64, S>> {
    let angle = rotation.length();
    let half = angle * Dual::splat(0.5);
    let (sine, cosine) = (libm::sin(half.value), libm::cos(half.value));
    if angle.value < NOTHING {
        return Quaternion { scalar: Dual::splat(1.0), vector: rotation * Dual::splat(0.5) };
    }
    Quaternion { scalar: half.chain(cosine, -sine), vector: rotation * (half.chain(sine, cosine) / angle) }
}

/// The rotation vector from one orientation to another, by less than half a turn.
pub(crate) fn between<S: Slopes<f64>>(
    from: Quaternion<Dual<f64, S>>,
    to: Quaternion<Dual<f64, S>>,
) -> Vector<Dual<f64, S>> {
    let turn = to * from.conjugate();
    let sine = turn.vector.length();
    if sine.value < NOTHING {
        return turn.vector * (Dual::splat(2.0) / turn.scalar);
    }
    let square = sine.value * sine.value + turn.scalar.value * turn.scalar.value;
    let slopes = sine.slopes.mixed(turn.scalar.value / square, turn.scalar.slopes, -sine.value / square);
    let angle = Dual::new(libm::atan2(sine.value, turn.scalar.value), slopes);
    turn.vector * (Dual::splat(2.0) * angle / sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_vector_comes_back_with_its_slopes() {
        let slopes =
            [[1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, -0.25], [0.0, 0.0, 1.0, 2.0]].map(|[a, b, c, d]| [a, b, c, d, -d]);
        for values in [Vector::new(0.3, -0.4, 0.2), Vector::new(0.0, 0.0, 0.0)] {
            let found = between(Quaternion::identity(), orientation(Dual::vector(values, slopes)));
            for (found, expected) in found.slopes().iter().flatten().zip(slopes.iter().flatten()) {
                assert!((found - expected).abs() < 1e-14, "{found} and {expected}");
            }
        }
    }
}
