//! From strains to the deformation of a cell, and its change in a time step.
//!
//! The deformation gradient F is U D: D is diagonal with the stretches e^ε, U has ones on its diagonal and the engineering shears
//! above it. A time step leads from F₀ to F₁ = A F₀, A = U₁ Λ U₀⁻¹ with Λ = D₁ D₀⁻¹. A − 1 and 1 − A⁻¹ are linear in the changes of
//! the strains, with one matrix for each; hence the work of the step is a sum over the components, to rounding.

use crate::base::geometry::lattice::STRAIN_PLACES;
use crate::engine::state::cell::{Square, Strains};
use nalgebra::Matrix3;

/// U: ones and shears.
fn sheared(strain: &Strains) -> Matrix3<f64> {
    let [_, _, _, xy, xz, yz] = *strain;
    Matrix3::new(1.0, xy, xz, 0.0, 1.0, yz, 0.0, 0.0, 1.0)
}

/// U⁻¹.
fn upright(strain: &Strains) -> Matrix3<f64> {
    let [_, _, _, xy, xz, yz] = *strain;
    Matrix3::new(1.0, -xy, xy * yz - xz, 0.0, 1.0, -yz, 0.0, 0.0, 1.0)
}

/// A diagonal matrix of three numbers.
fn diagonal(numbers: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&numbers.into())
}

/// (e^x − 1) / x.
fn growth(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::expm1(x) / x }
}

/// Edges that have these strains.
pub(crate) fn edges(reference: &Square, strain: &Strains) -> Square {
    let deformation = rows(&(sheared(strain) * diagonal([0, 1, 2].map(|axis| libm::exp(strain[axis])))));
    reference.map(|edge| times(&deformation, edge))
}

/// Rows of a matrix.
pub(crate) fn rows(matrix: &Matrix3<f64>) -> Square {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)]))
}

/// The deformation of one time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Change {
    /// Changes of the strains.
    pub(crate) strain: Strains,
    /// A: where what was at rest in the cell goes.
    pub(crate) forward: Square,
    /// A⁻¹.
    pub(crate) backward: Square,
    /// A − 1 for each unit of the changes.
    pub(crate) of_start: [Square; 6],
    /// 1 − A⁻¹ for each unit of the changes.
    pub(crate) of_end: [Square; 6],
}

impl Change {
    /// From strains to others.
    pub(crate) fn between(before: &Strains, after: &Strains) -> Self {
        let strain = std::array::from_fn(|component| after[component] - before[component]);
        let (from, to) = ((sheared(before), upright(before)), (sheared(after), upright(after)));
        let stretch = [0, 1, 2].map(|axis| libm::exp(strain[axis]));
        let [wider, narrower] = [diagonal(stretch), diagonal(stretch.map(|stretch| 1.0 / stretch))];
        // Of each component, with what comes before and behind it.
        let parts = |sign: f64, [before, behind]: [Matrix3<f64>; 2], across: Matrix3<f64>| {
            std::array::from_fn(|component| {
                let [row, column] = STRAIN_PLACES[component];
                let mut unit = Matrix3::zeros();
                unit[(row, column)] = 1.0;
                rows(&match row == column {
                    true => before * unit * behind * growth(sign * strain[component]),
                    false => unit * across,
                })
            })
        };
        Self {
            strain,
            forward: rows(&(to.0 * wider * from.1)),
            backward: rows(&(from.0 * narrower * to.1)),
            of_start: parts(1.0, [from.0, from.1], wider * from.1),
            of_end: parts(-1.0, [to.0, to.1], narrower * to.1),
        }
    }

    /// Whether nothing is deformed.
    pub(crate) fn is_none(&self) -> bool {
        self.strain == Strains::default()
    }

    /// The gradient of the streaming velocity at its end, after a step of this length \[s\] \[1/s\].
    pub(crate) fn gradient(&self, after: &Strains, step: f64) -> Square {
        let (shears, back) = (sheared(after), upright(after));
        let mut turning = Matrix3::zeros();
        let rates: Strains = self.strain.map(|change| change / step);
        for (component, [row, column]) in STRAIN_PLACES.into_iter().enumerate().skip(3) {
            turning[(row, column)] = rates[component];
        }
        rows(&(turning * back + shears * diagonal([rates[0], rates[1], rates[2]]) * back))
    }

    /// No two points at a distance of 1 come nearer to each other by more than this.
    pub(crate) fn farthest(&self) -> f64 {
        let mut sum = 0.0;
        for (row, forward) in self.forward.iter().enumerate() {
            for (column, part) in forward.iter().enumerate() {
                let part = if row == column { part - 1.0 } else { *part };
                sum += part * part;
            }
        }
        sum.sqrt()
    }
}

/// Product of a matrix and a vector.
#[inline(always)]
pub(crate) fn times(matrix: &Square, [x, y, z]: [f64; 3]) -> [f64; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

/// Sum of the products of the entries of two matrices.
pub(crate) fn product(one: &Square, other: &Square) -> f64 {
    one.as_flattened().iter().zip(other.as_flattened()).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::{Change, edges, product, rows, times};
    use crate::engine::state::cell::Square;
    use nalgebra::Matrix3;

    const BEFORE: [f64; 6] = [0.1, -0.05, 0.02, 0.3, -0.2, 0.15];
    const AFTER: [f64; 6] = [0.12, -0.09, 0.025, 0.27, -0.1, 0.18];

    fn matrix(rows: &Square) -> Matrix3<f64> {
        Matrix3::from_row_slice(rows.as_flattened())
    }

    fn assert_near(found: &Square, expected: &Square) {
        for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
    }

    #[test]
    fn the_change_leads_from_edges_to_edges() {
        let reference = [[2.0, 0.0, 0.0], [0.3, 1.5, 0.0], [-0.2, 0.4, 1.0]];
        let change = Change::between(&BEFORE, &AFTER);
        let (from, to) = (edges(&reference, &BEFORE), edges(&reference, &AFTER));
        assert_near(&from.map(|edge| times(&change.forward, edge)), &to);
        assert_near(&to.map(|edge| times(&change.backward, edge)), &from);
    }

    #[test]
    fn strains_are_logarithms_of_stretches_and_engineering_shears() {
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let [a, b, c] = edges(&unit, &AFTER);
        assert_eq!(
            [a[0].ln(), b[1].ln(), c[2].ln()].map(|strain| (strain * 1e12).round()),
            [0.12e12, -0.09e12, 0.025e12]
        );
        assert!(
            (b[0] / b[1] - 0.27).abs() < 1e-15
                && (c[0] / c[2] + 0.1).abs() < 1e-15
                && (c[1] / c[2] - 0.18).abs() < 1e-15
        );
    }

    #[test]
    fn the_parts_of_the_change_add_up_to_it() {
        let change = Change::between(&BEFORE, &AFTER);
        let sum = |parts: &[Square; 6]| {
            parts.iter().zip(change.strain).fold(Matrix3::zeros(), |sum, (part, strain)| sum + matrix(part) * strain)
        };
        assert_near(&rows(&sum(&change.of_start)), &rows(&(matrix(&change.forward) - Matrix3::identity())));
        assert_near(&rows(&sum(&change.of_end)), &rows(&(Matrix3::identity() - matrix(&change.backward))));
    }

    #[test]
    fn the_gradient_is_the_rate_of_the_deformation() {
        let step = 1e-6;
        let near: [f64; 6] = std::array::from_fn(|k| BEFORE[k] + step * (AFTER[k] - BEFORE[k]));
        let change = Change::between(&BEFORE, &near);
        let gradient = change.gradient(&near, step);
        let by_difference = rows(&((matrix(&change.forward) - Matrix3::identity()) / step));
        for (found, expected) in gradient.as_flattened().iter().zip(by_difference.as_flattened()) {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        assert!((product(&gradient, &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) + 0.015).abs() < 1e-6);
    }
}
