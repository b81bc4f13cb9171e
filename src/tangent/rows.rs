//! Rows of numbers with their slopes, as columns of registers and one by one.

use crate::dual::Dual;
use crate::lanes::{Lane, Places, columns_at, rows_of};
use crate::number::{Number, Row, Vector};

/// Rows of values with slopes.
#[inline(always)]
pub(crate) fn with_slopes<N: Lane>([x, y, z, w]: [N; 4], [dx, dy, dz, dw]: [N; 4]) -> [Dual<N>; 4] {
    [Dual::new(x, [dx]), Dual::new(y, [dy]), Dual::new(z, [dz]), Dual::new(w, [dw])]
}

/// Vectors of values with slopes, and behind them a number that does not change.
#[inline(always)]
pub(crate) fn vectors_with_slopes<N: Lane>([x, y, z, w]: [N; 4], [dx, dy, dz, _]: [N; 4]) -> [Dual<N>; 4] {
    [Dual::new(x, [dx]), Dual::new(y, [dy]), Dual::new(z, [dz]), Dual::constant(w)]
}

/// The rows at these places with their slopes.
#[inline(always)]
pub(crate) fn rows_at<N: Lane>(values: &[Row], slopes: &[Row], places: &Places) -> [Dual<N>; 4] {
    with_slopes(columns_at(values, places), columns_at(slopes, places))
}

/// The slopes of some rows.
#[inline(always)]
pub(crate) fn slopes_of<N: Lane>([x, y, z, w]: [Dual<N>; 4]) -> [N; 4] {
    let ([dx], [dy], [dz], [dw]) = (x.slopes, y.slopes, z.slopes, w.slopes);
    [dx, dy, dz, dw]
}

/// The slopes of some vectors, and nothing behind them.
#[inline(always)]
pub(crate) fn vector_slopes<N: Lane>(vector: Vector<Dual<N>>) -> [N; 4] {
    let ([dx], [dy], [dz]) = (vector.x.slopes, vector.y.slopes, vector.z.slopes);
    [dx, dy, dz, N::zero()]
}

/// Adds the first so many of some vectors, one after another.
#[inline(always)]
pub(crate) fn sum<N: Lane>(columns: [N; 4], sums: &mut [[f64; 1]; 3], count: usize) {
    for row in rows_of(columns).iter().take(count) {
        for (sum, part) in sums.iter_mut().zip(row) {
            sum[0] += part;
        }
    }
}

/// Adds multiples of rows where an input has reached the particle: nothing has ever been written of the others.
#[inline(always)]
pub(super) fn add_times(sums: &mut [Row], parts: &[Row], reached: &[bool], factors: impl Iterator<Item = f64>) {
    for (((sums, parts), _), factor) in sums.iter_mut().zip(parts).zip(reached).zip(factors).filter(|it| *it.0.1) {
        for (sum, part) in sums.iter_mut().zip(parts) {
            *sum += factor * part;
        }
    }
}

/// A number with its slope, the same in all lanes.
#[inline(always)]
pub(crate) fn spread<N: Lane>(number: Dual) -> Dual<N> {
    Dual::new(Number::splat(number.value), [N::splat(number.slopes[0])])
}

/// One row with its slopes.
pub(crate) fn alone([x, y, z, w]: Row, [dx, dy, dz, dw]: &Row) -> [Dual; 4] {
    [Dual::new(x, [*dx]), Dual::new(y, [*dy]), Dual::new(z, [*dz]), Dual::new(w, [*dw])]
}

/// The slopes of a row.
pub(crate) fn row_of(row: [Dual; 4]) -> Row {
    row.map(|number| number.slopes[0])
}

/// The slopes of a vector, and nothing behind them.
pub(crate) fn vector_of(vector: Vector<Dual>) -> Row {
    row_of(vector.row_with(Dual::constant(0.0)))
}
