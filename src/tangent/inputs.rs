//! How many inputs are followed together, and how the slopes by them stand in memory and in registers.

use crate::dual::{Dual, Slopes};
use crate::lanes::{self, Kernel, Lane, Places, Width, columns_at, differences_at, rows_of};
use crate::number::{Number, Row, Vector};
use std::ops::IndexMut;

/// Some inputs that are followed together.
///
/// With one input, a register holds the same number of several contacts or bonds, and another one their slopes. With more, a
/// register holds the slopes of one number of a single contact or bond by all of them. What is the same for both is written over
/// the numbers [`InLanes`].
pub(crate) trait Inputs: Send + Sync + 'static {
    /// How many there are.
    const COUNT: usize;

    /// How a number changes with each of them.
    type Each: Slopes<f64> + IndexMut<usize, Output = f64> + std::fmt::Debug;

    /// How a row of four numbers changes with each of them, in memory.
    type Row: Copy + Send + Sync + 'static;

    /// A row that does not change.
    const NONE: Self::Row;

    /// Numbers that are worked on at a time.
    type Values<N: Lane>: Lane;

    /// The slopes of these numbers.
    type Slopes<N: Lane>: Slopes<Self::Values<N>>;

    /// Runs a kernel in this lane width, which slopes by so many inputs are worked on in.
    fn run<K: Kernel>(width: Width, kernel: K);

    /// The slopes of the rows at these places, a column each.
    fn rows_at<N: Lane>(rows: &[Self::Row], places: &Places) -> [Self::Slopes<N>; 4];

    /// The slopes of consecutive rows from one on, a column each.
    fn rows_from<N: Lane>(rows: &[Self::Row], first: usize) -> [Self::Slopes<N>; 4];

    /// Writes slopes to consecutive rows from one on.
    fn put_from<N: Lane>(columns: [Self::Slopes<N>; 4], rows: &mut [Self::Row], first: usize);

    /// The slopes of the rows at the first places less those at the others, a column each.
    fn differences_at<N: Lane>(rows: &[Self::Row], first: &Places, others: &Places) -> [Self::Slopes<N>; 4];

    /// Slopes that are the same for all contacts or bonds that are worked on at a time.
    fn spread<N: Lane>(each: Self::Each) -> Self::Slopes<N>;

    /// Writes slopes to the rows at these places.
    fn put<N: Lane>(columns: [Self::Slopes<N>; 4], rows: &mut [Self::Row], places: &Places);

    /// Adds the slopes of vectors to those of the rows at the first so many places.
    fn add<N: Lane>(columns: [Self::Slopes<N>; 3], rows: &mut [Self::Row], places: &Places, count: usize);

    /// The same for pairs of rows, one pair after another: the first vectors to the first rows, the others to the second ones.
    fn add_pairs<N: Lane>(
        columns: [[Self::Slopes<N>; 3]; 2],
        rows: &mut [Self::Row],
        places: [&Places; 2],
        count: usize,
    );

    /// The same where the others are opposite to the first vectors.
    fn add_opposite<N: Lane>(columns: [Self::Slopes<N>; 3], rows: &mut [Self::Row], places: [&Places; 2], count: usize);

    /// Adds the slopes of the first so many vectors, one after another.
    fn sum<N: Lane>(columns: [Self::Slopes<N>; 3], sums: &mut [Self::Each; 3], count: usize);

    /// Adds multiples of the slopes of a row.
    fn add_times(sums: &mut Self::Row, parts: &Self::Row, factor: f64);

    /// The slopes of a number of the row.
    fn each(row: &Self::Row, place: usize) -> Self::Each;

    /// A row with these slopes of its numbers.
    fn row(each: [Self::Each; 4]) -> Self::Row;
}

/// The numbers with slopes that are worked on at a time.
pub(crate) type InLanes<I, N> = Dual<<I as Inputs>::Values<N>, <I as Inputs>::Slopes<N>>;

/// One number with its slopes.
pub(crate) type Alone<I> = Dual<f64, <I as Inputs>::Each>;

/// Rows with their slopes.
#[inline(always)]
pub(crate) fn rows_at<I: Inputs, N: Lane>(values: &[Row], rows: &[I::Row], places: &Places) -> [InLanes<I, N>; 4] {
    let ([x, y, z, w], [dx, dy, dz, dw]) = (columns_at(values, places), I::rows_at(rows, places));
    [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::new(w, dw)]
}

/// Rows of values with slopes.
#[inline(always)]
pub(crate) fn with_slopes<I: Inputs, N: Lane>(
    [x, y, z, w]: [I::Values<N>; 4],
    [dx, dy, dz, dw]: [I::Slopes<N>; 4],
) -> [InLanes<I, N>; 4] {
    [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::new(w, dw)]
}

/// Vectors with their slopes, and behind them a number that does not change.
#[inline(always)]
pub(crate) fn vectors_at<I: Inputs, N: Lane>(values: &[Row], rows: &[I::Row], places: &Places) -> [InLanes<I, N>; 4] {
    let ([x, y, z, w], [dx, dy, dz, _]) = (columns_at(values, places), I::rows_at(rows, places));
    [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::constant(w)]
}

/// The slopes of some rows.
#[inline(always)]
pub(crate) fn slopes_of<I: Inputs, N: Lane>([x, y, z, w]: [InLanes<I, N>; 4]) -> [I::Slopes<N>; 4] {
    [x.slopes, y.slopes, z.slopes, w.slopes]
}

/// A number with its slopes, the same for all that are worked on.
#[inline(always)]
pub(crate) fn spread<I: Inputs, N: Lane>(number: Alone<I>) -> InLanes<I, N> {
    Dual::new(Number::splat(number.value), I::spread::<N>(number.slopes))
}

/// One row with its slopes.
pub(crate) fn alone<I: Inputs>([x, y, z, w]: Row, row: &I::Row) -> [Alone<I>; 4] {
    let number = |value, place| Dual::new(value, I::each(row, place));
    [number(x, 0), number(y, 1), number(z, 2), number(w, 3)]
}

/// The slopes of a row.
pub(crate) fn row_of<I: Inputs>(row: [Alone<I>; 4]) -> I::Row {
    I::row(row.map(|number| number.slopes))
}

/// The slopes of a vector, and nothing behind them.
pub(crate) fn vector_of<I: Inputs>(vector: Vector<Alone<I>>) -> I::Row {
    row_of::<I>(vector.row_with(Dual::constant(0.0)))
}

/// One input.
pub(crate) struct OneInput;

impl Inputs for OneInput {
    const COUNT: usize = 1;
    type Each = [f64; 1];
    type Row = Row;
    const NONE: Row = [0.0; 4];
    type Values<N: Lane> = N;
    type Slopes<N: Lane> = [N; 1];

    fn run<K: Kernel>(width: Width, kernel: K) {
        lanes::run_seldom(width, kernel);
    }

    #[inline(always)]
    fn rows_at<N: Lane>(rows: &[Row], places: &Places) -> [[N; 1]; 4] {
        let [x, y, z, w] = columns_at(rows, places);
        [[x], [y], [z], [w]]
    }

    #[inline(always)]
    fn rows_from<N: Lane>(rows: &[Row], first: usize) -> [[N; 1]; 4] {
        let [x, y, z, w] = lanes::columns_from(rows, first);
        [[x], [y], [z], [w]]
    }

    #[inline(always)]
    fn put_from<N: Lane>([[x], [y], [z], [w]]: [[N; 1]; 4], rows: &mut [Row], first: usize) {
        lanes::rows_from([x, y, z, w], rows, first);
    }

    #[inline(always)]
    fn differences_at<N: Lane>(rows: &[Row], first: &Places, others: &Places) -> [[N; 1]; 4] {
        let [x, y, z, w] = differences_at(rows, first, others);
        [[x], [y], [z], [w]]
    }

    #[inline(always)]
    fn spread<N: Lane>([slope]: [f64; 1]) -> [N; 1] {
        [N::splat(slope)]
    }

    #[inline(always)]
    fn put<N: Lane>([[x], [y], [z], [w]]: [[N; 1]; 4], rows: &mut [Row], places: &Places) {
        lanes::put_at([x, y, z, w], rows, places);
    }

    #[inline(always)]
    fn add<N: Lane>([[x], [y], [z]]: [[N; 1]; 3], rows: &mut [Row], places: &Places, count: usize) {
        lanes::add_at([x, y, z, N::zero()], rows, places, count);
    }

    #[inline(always)]
    fn add_pairs<N: Lane>([one, other]: [[[N; 1]; 3]; 2], rows: &mut [Row], [i, j]: [&Places; 2], count: usize) {
        let ([[a], [b], [c]], [[d], [e], [f]], none) = (one, other, N::zero());
        lanes::add_pairs_at([[a, b, c, none], [d, e, f, none]], rows, i, j, count);
    }

    #[inline(always)]
    fn add_opposite<N: Lane>([[x], [y], [z]]: [[N; 1]; 3], rows: &mut [Row], [i, j]: [&Places; 2], count: usize) {
        lanes::add_opposite_at([x, y, z, N::zero()], rows, i, j, count);
    }

    #[inline(always)]
    fn sum<N: Lane>([[x], [y], [z]]: [[N; 1]; 3], sums: &mut [[f64; 1]; 3], count: usize) {
        for row in rows_of([x, y, z, N::zero()]).iter().take(count) {
            for (sum, part) in sums.iter_mut().zip(row) {
                sum[0] += part;
            }
        }
    }

    #[inline(always)]
    fn add_times(sums: &mut Row, parts: &Row, factor: f64) {
        for (sum, part) in sums.iter_mut().zip(parts) {
            *sum += factor * part;
        }
    }

    fn each(row: &Row, place: usize) -> [f64; 1] {
        [row[place]]
    }

    fn row([[x], [y], [z], [w]]: [[f64; 1]; 4]) -> Row {
        [x, y, z, w]
    }
}
