//! Numbers that sub-models compute with, and their coefficients.

use crate::dual::{Dual, Slopes};
use crate::number::Number;

/// Numbers of one contact, or of a register's worth, whose coefficients are numbers of a simpler kind.
pub trait LawNumber: Number {
    /// What coefficients are given as.
    type Coefficient: Number;

    /// A coefficient as such a number.
    fn of(coefficient: Self::Coefficient) -> Self;
}

impl LawNumber for f64 {
    type Coefficient = Self;

    #[inline(always)]
    fn of(coefficient: Self) -> Self {
        coefficient
    }
}

/// Coefficients do not change.
impl<V: Number, S: Slopes<V>> LawNumber for Dual<V, S> {
    type Coefficient = V;

    #[inline(always)]
    fn of(coefficient: V) -> Self {
        Self::constant(coefficient)
    }
}
