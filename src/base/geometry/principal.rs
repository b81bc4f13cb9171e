//! Principal axes of a symmetric 3 × 3 matrix.

use super::Quaternion;
use crate::base::number::Vector;

/// Sweeps after which every matrix is diagonal to rounding.
const SWEEPS: usize = 12;

/// The eigenvalues, and the turn of the axes into the eigenvectors (Jacobi's rotations). A diagonal matrix keeps its axes.
pub(crate) fn principal(matrix: [[f64; 3]; 3]) -> ([f64; 3], Quaternion) {
    let (mut a, mut axes) = (matrix, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let ratio = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let tangent = 1.0_f64.copysign(ratio) / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sine = tangent * cosine;
            for row in &mut a {
                (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (cosine * a[p][k] - sine * a[q][k], sine * a[p][k] + cosine * a[q][k]);
                (axes[k][p], axes[k][q]) =
                    (cosine * axes[k][p] - sine * axes[k][q], sine * axes[k][p] + cosine * axes[k][q]);
            }
            (a[p][q], a[q][p]) = (0.0, 0.0);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], turn(axes))
}

/// The turn that takes the axes to the columns of a rotation matrix.
fn turn(m: [[f64; 3]; 3]) -> Quaternion {
    // The largest of four components is found first, so that none is divided by nothing.
    let squares = [
        1.0 + m[0][0] + m[1][1] + m[2][2],
        1.0 + m[0][0] - m[1][1] - m[2][2],
        1.0 - m[0][0] + m[1][1] - m[2][2],
        1.0 - m[0][0] - m[1][1] + m[2][2],
    ];
    let largest = (1..4).fold(0, |most, next| if squares[next] > squares[most] { next } else { most });
    let four = squares[largest];
    let [w, x, y, z] = match largest {
        0 => [four, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]],
        1 => [m[2][1] - m[1][2], four, m[0][1] + m[1][0], m[0][2] + m[2][0]],
        2 => [m[0][2] - m[2][0], m[0][1] + m[1][0], four, m[1][2] + m[2][1]],
        _ => [m[1][0] - m[0][1], m[0][2] + m[2][0], m[1][2] + m[2][1], four],
    };
    Quaternion { scalar: w, vector: Vector::new(x, y, z) }.normalised()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_make_the_matrix_again() {
        for matrix in [
            [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.0]],
            [[2.0, 0.5, -0.3], [0.5, 3.0, 0.7], [-0.3, 0.7, 1.0]],
            [[1.0, 0.9, 0.9], [0.9, 1.0, 0.9], [0.9, 0.9, 1.0]],
            [[2.0, 0.0, 0.0], [0.0, 1.0, 0.8], [0.0, 0.8, 1.0]],
        ] {
            let (values, axes) = principal(matrix);
            for column in 0..3 {
                let unit = Vector::from([0, 1, 2].map(|k| if k == column { 1.0 } else { 0.0 }));
                let inside = axes.conjugate().turn(unit).to_array();
                let scaled = Vector::from([0, 1, 2].map(|k| values[k] * inside[k]));
                let found = axes.turn(scaled).to_array();
                for row in 0..3 {
                    let expected = matrix[row][column];
                    assert!((found[row] - expected).abs() < 1e-14, "{found:?}, column {column} of {matrix:?} expected");
                }
            }
        }
    }

    #[test]
    fn a_diagonal_matrix_keeps_its_axes() {
        let (values, axes) = principal([[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!((values, axes), ([2.0, 3.0, 1.0], Quaternion::identity()));
    }
}
