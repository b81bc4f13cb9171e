//! Numbers that sub-models compute with, and their coefficients.

use crate::contact::Coefficients;
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

/// Coefficients that a sub-model has at most.
const MOST: usize = 16;

/// Coefficients of a sub-model, or of all from it on.
pub(super) type CoefficientRow<N> = [<N as LawNumber>::Coefficient];

/// The coefficients that stand first in a row, in this kind of number.
#[inline(always)]
pub(super) fn numbers<A: Coefficients, N: LawNumber>(row: &CoefficientRow<N>) -> A::Lanes<N> {
    const { assert!(A::COUNT <= MOST) };
    let mut numbers = [N::zero(); MOST];
    for (number, value) in numbers[..A::COUNT].iter_mut().zip(&row[..A::COUNT]) {
        *number = N::of(*value);
    }
    A::lanes(&numbers)
}
