//! A number and its slopes: how it changes with each of a few inputs.
//!
//! Laws are written over [`Number`]; over this one they give their values, bit for bit those of the numbers alone, and beside
//! them the exact derivatives of what was computed. Decisions are made by values: which branch is taken does not change.
//!
//! Where one input is followed, a register holds the same number of several contacts or bonds, and another one their slopes.
//! Where more are followed together, a register holds the slopes of one number of a single contact or bond by all of them.

mod slopes;

pub use slopes::Slopes;

use crate::number::{Number, Vector};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number and its slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<V = f64, S = [V; 1]> {
    /// The number.
    pub value: V,
    /// How it changes.
    pub slopes: S,
}

impl<V: Number, S: Slopes<V>> Dual<V, S> {
    /// A number with these slopes.
    #[inline(always)]
    pub fn new(value: V, slopes: S) -> Self {
        Self { value, slopes }
    }

    /// A number that stays as it is.
    #[inline(always)]
    pub fn constant(value: V) -> Self {
        Self { value, slopes: S::none() }
    }

    /// A function of this number, from its value and its derivative there.
    #[inline(always)]
    pub fn chain(self, value: V, derivative: V) -> Self {
        Self { value, slopes: self.slopes.times(derivative) }
    }

    /// The values of a row.
    #[inline(always)]
    pub fn values_of([x, y, z, rest]: [Self; 4]) -> [V; 4] {
        [x.value, y.value, z.value, rest.value]
    }

    /// A row of numbers that stay as they are.
    #[inline(always)]
    pub fn constants([x, y, z, rest]: [V; 4]) -> [Self; 4] {
        [Self::constant(x), Self::constant(y), Self::constant(z), Self::constant(rest)]
    }

    /// Three numbers with their slopes.
    #[inline(always)]
    pub fn vector(values: Vector<V>, [x, y, z]: [S; 3]) -> Vector<Self> {
        Vector::new(Self::new(values.x, x), Self::new(values.y, y), Self::new(values.z, z))
    }
}

impl<V: Number, S: Slopes<V>> Vector<Dual<V, S>> {
    /// The slopes of the components.
    #[inline(always)]
    pub fn slopes(self) -> [S; 3] {
        [self.x.slopes, self.y.slopes, self.z.slopes]
    }
}

impl<V: Number, S: Slopes<V>> Add for Dual<V, S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slopes: self.slopes.plus(other.slopes) }
    }
}

impl<V: Number, S: Slopes<V>> Sub for Dual<V, S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slopes: self.slopes.minus(other.slopes) }
    }
}

impl<V: Number, S: Slopes<V>> Mul for Dual<V, S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let slopes = self.slopes.mixed(other.value, other.slopes, self.value);
        Self { value: self.value * other.value, slopes }
    }
}

impl<V: Number, S: Slopes<V>> Div for Dual<V, S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (value, per) = (self.value / other.value, V::splat(1.0) / other.value);
        Self { value, slopes: self.slopes.mixed(per, other.slopes, -value * per) }
    }
}

impl<V: Number, S: Slopes<V>> Neg for Dual<V, S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.times(V::splat(-1.0)) }
    }
}

impl<V: Number, S: Slopes<V>> Number for Dual<V, S> {
    type Mask = V::Mask;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::constant(V::splat(value))
    }

    /// The root of 0 has no slope; it is taken to stay.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        let derivative = V::splat(0.5) / value;
        self.chain(value, V::select(value.greater(V::zero()), derivative, V::zero()))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let below = V::zero().greater(self.value);
        Self { value: self.value.abs(), slopes: S::select(below, (-self).slopes, self.slopes) }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.value.greater(other.value), self, other)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.value.greater(self.value), self, other)
    }

    #[inline(always)]
    fn greater(self, other: Self) -> V::Mask {
        self.value.greater(other.value)
    }

    #[inline(always)]
    fn select(mask: V::Mask, yes: Self, no: Self) -> Self {
        Self { value: V::select(mask, yes.value, no.value), slopes: S::select(mask, yes.slopes, no.slopes) }
    }

    #[inline(always)]
    fn both(one: V::Mask, other: V::Mask) -> V::Mask {
        V::both(one, other)
    }

    #[inline(always)]
    fn either(one: V::Mask, other: V::Mask) -> V::Mask {
        V::either(one, other)
    }

    #[inline(always)]
    fn any(mask: V::Mask) -> bool {
        V::any(mask)
    }

    #[inline(always)]
    fn whole(self) -> Self {
        Self::constant(self.value.whole())
    }

    #[inline(always)]
    fn scaled(self, factor: Self) -> Self {
        self.chain(self.value * factor.value, factor.value)
    }

    /// Value and derivative one by one, and so one product with the slopes for all powers.
    #[inline(always)]
    fn polynomial<const COUNT: usize>(self, coefficients: &[f64; COUNT]) -> Self {
        let (mut value, mut derivative) = (V::splat(coefficients[COUNT - 1]), V::zero());
        let mut index = COUNT - 1;
        while index > 0 {
            index -= 1;
            derivative = derivative * self.value + value;
            value = value * self.value + V::splat(coefficients[index]);
        }
        self.chain(value, derivative)
    }

    #[inline(always)]
    fn cube_root(self) -> Self {
        let value = self.value.cube_root();
        let derivative = V::splat(1.0) / (V::splat(3.0) * value * value);
        self.chain(value, V::select(value.greater(V::zero()), derivative, V::zero()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x with slope 1 along the second input.
    fn along(value: f64) -> Dual<f64, [f64; 2]> {
        Dual::new(value, [0.0, 1.0])
    }

    #[test]
    fn slopes_are_those_of_calculus() {
        let (x, two) = (along(3.0), Dual::splat(2.0));
        assert_eq!((x * x * x).slopes[1], 27.0);
        assert_eq!((two / x).slopes[1], -2.0 / 9.0);
        assert_eq!(along(4.0).sqrt().slopes[1], 0.25);
        assert_eq!(along(0.0).sqrt().slopes[1], 0.0);
        assert_eq!(Number::abs(-x).slopes[1], 1.0);
        assert_eq!(x.scaled(two).slopes[1], 2.0);
        assert_eq!(x.polynomial(&[5.0, -1.0, 2.0]), Dual::new(20.0, [0.0, 11.0]));
        assert!((along(8.0).cube_root().slopes[1] - 1.0 / 12.0).abs() < 1e-16);
        assert_eq!(Number::whole(x), Dual::splat(3.0));
        assert_eq!((x - two + x).slopes, [0.0, 2.0]);
    }

    #[test]
    fn the_greater_of_two_keeps_its_own_slope() {
        let (x, four) = (along(3.0), Dual::splat(4.0));
        assert_eq!([Number::max(x, four).slopes[1], Number::min(x, four).slopes[1]], [0.0, 1.0]);
        assert_eq!(Dual::select(x.greater(four), x, four), four);
    }
}
