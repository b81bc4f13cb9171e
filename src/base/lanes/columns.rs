//! Columns with room for one register of any width.

use super::Lane;
use crate::base::number::Vector;

/// Numbers of a register's worth of things.
pub type Column = [f64; 8];

/// Writes columns, from this one on.
#[inline(always)]
pub fn put<N: Lane, const COUNT: usize>(columns: &mut [Column], first: usize, values: [N; COUNT]) {
    let columns = &mut columns[first..first + COUNT];
    let mut column = 0;
    while column < COUNT {
        // SAFETY: a column has room for a register.
        unsafe { values[column].store(columns[column].as_mut_ptr()) };
        column += 1;
    }
}

/// Reads columns, from this one on.
#[inline(always)]
pub fn take<N: Lane, const COUNT: usize>(columns: &[Column], first: usize) -> [N; COUNT] {
    let columns = &columns[first..first + COUNT];
    let mut values = [N::zero(); COUNT];
    let mut column = 0;
    while column < COUNT {
        // SAFETY: a column holds a register.
        values[column] = unsafe { N::load(columns[column].as_ptr()) };
        column += 1;
    }
    values
}

/// A vector as three columns.
#[inline(always)]
pub fn vector_parts<N: Lane>(vector: Vector<N>) -> [N; 3] {
    [vector.x, vector.y, vector.z]
}

/// Three columns as a vector.
#[inline(always)]
pub fn vector_of<N: Lane>([x, y, z]: [N; 3]) -> Vector<N> {
    Vector::new(x, y, z)
}
