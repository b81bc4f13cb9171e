//! A number and its slopes: how it changes with each of a few inputs.
//!
//! Laws are written over [`Number`]; over this one they give their values, bit for bit those of `f64`, and beside them
//! the exact derivatives of what was computed. Decisions are made by values: which branch is taken does not change. Values
//! are found one by one, the slopes of each side by side in vector registers.

use crate::lanes::{self, Eightfold, Lane};
use crate::number::{Number, Vector};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// How many inputs are followed at a time: as many as the widest registers hold.
pub const DIRECTIONS: usize = 8;

/// How one number changes with each input that is followed.
pub type Slopes = [f64; DIRECTIONS];

/// How a row of four numbers changes.
pub type RowSlopes = [Slopes; 4];

/// A number and its slopes, in registers of `N`.
#[derive(Clone, Copy)]
pub struct Dual<N: Lane = f64> {
    /// The number.
    pub value: f64,
    /// How it changes with each input.
    pub slopes: N::Eight,
}

impl<N: Lane> Dual<N> {
    /// A number with these slopes.
    #[inline(always)]
    pub fn new(value: f64, slopes: &Slopes) -> Self {
        Self { value, slopes: lanes::load_eight::<N>(slopes) }
    }

    /// A function of this number, from its value and its derivative there.
    #[inline(always)]
    pub fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, slopes: self.slopes.times(N::splat(derivative)) }
    }

    /// Its slopes one by one.
    #[inline(always)]
    pub fn slopes(self) -> Slopes {
        lanes::store_eight::<N>(self.slopes)
    }

    /// A row of numbers with their slopes.
    #[inline(always)]
    pub fn row(values: [f64; 4], slopes: &RowSlopes) -> [Self; 4] {
        std::array::from_fn(|place| Self::new(values[place], &slopes[place]))
    }

    /// Three numbers with their slopes.
    #[inline(always)]
    pub fn vector(values: Vector, slopes: &[Slopes; 3]) -> Vector<Self> {
        let [x, y, z] = slopes;
        Vector::new(Self::new(values.x, x), Self::new(values.y, y), Self::new(values.z, z))
    }

    /// The slopes of a row.
    #[inline(always)]
    pub fn slopes_of(row: [Self; 4]) -> RowSlopes {
        row.map(Self::slopes)
    }
}

impl<N: Lane> Vector<Dual<N>> {
    /// The slopes of the components.
    #[inline(always)]
    pub fn slopes(self) -> [Slopes; 3] {
        [self.x.slopes(), self.y.slopes(), self.z.slopes()]
    }
}

/// The value and the slopes, whatever the registers.
impl<N: Lane> std::fmt::Debug for Dual<N> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{:?} with {:?}", self.value, self.slopes())
    }
}

impl<N: Lane> PartialEq for Dual<N> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value && self.slopes() == other.slopes()
    }
}

impl<N: Lane> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slopes: self.slopes.plus(other.slopes) }
    }
}

impl<N: Lane> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slopes: self.slopes.minus(other.slopes) }
    }
}

impl<N: Lane> Mul for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let slopes = self.slopes.mixed(N::splat(other.value), other.slopes, N::splat(self.value));
        Self { value: self.value * other.value, slopes }
    }
}

impl<N: Lane> Div for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (value, per) = (self.value / other.value, 1.0 / other.value);
        Self { value, slopes: self.slopes.mixed(N::splat(per), other.slopes, N::splat(-value * per)) }
    }
}

impl<N: Lane> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.times(N::splat(-1.0)) }
    }
}

impl<N: Lane> Number for Dual<N> {
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self { value, slopes: N::Eight::of(|_| N::zero()) }
    }

    /// The root of 0 has no slope; it is taken to stay.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.chain(value, if value > 0.0 { 0.5 / value } else { 0.0 })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let slopes = if self.value < 0.0 { -self } else { self };
        Self { value: self.value.abs(), ..slopes }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self.value > other.value { self } else { other }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self.value < other.value { self } else { other }
    }

    #[inline(always)]
    fn greater(self, other: Self) -> bool {
        self.value > other.value
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn both(one: bool, other: bool) -> bool {
        one && other
    }

    #[inline(always)]
    fn either(one: bool, other: bool) -> bool {
        one || other
    }

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }

    #[inline(always)]
    fn whole(self) -> Self {
        Self::splat(Number::whole(self.value))
    }

    #[inline(always)]
    fn scaled(self, factor: Self) -> Self {
        self.chain(self.value * factor.value, factor.value)
    }

    /// Value and derivative one by one, and so one product with the slopes for all powers.
    #[inline(always)]
    fn polynomial<const COUNT: usize>(self, coefficients: &[f64; COUNT]) -> Self {
        let (mut value, mut derivative) = (coefficients[COUNT - 1], 0.0);
        for index in (0..COUNT - 1).rev() {
            derivative = derivative * self.value + value;
            value = value * self.value + coefficients[index];
        }
        self.chain(value, derivative)
    }

    #[inline(always)]
    fn cube_root(self) -> Self {
        let value = Number::cube_root(self.value);
        self.chain(value, if value > 0.0 { 1.0 / (3.0 * value * value) } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x with slope 1 along the first input.
    fn along(value: f64) -> Dual {
        Dual::new(value, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    #[test]
    fn slopes_are_those_of_calculus() {
        let (x, two) = (along(3.0), Dual::splat(2.0));
        assert_eq!((x * x * x).slopes[0], 27.0);
        assert_eq!((two / x).slopes[0], -2.0 / 9.0);
        assert_eq!(along(4.0).sqrt().slopes[0], 0.25);
        assert_eq!(Number::abs(-x).slopes[0], 1.0);
        assert_eq!(x.scaled(two).slopes[0], 2.0);
        assert_eq!(x.polynomial(&[5.0, -1.0, 2.0]), Dual::new(20.0, &[11.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
        assert!((along(8.0).cube_root().slopes[0] - 1.0 / 12.0).abs() < 1e-16);
        assert_eq!(Number::whole(x), Dual::splat(3.0));
        assert_eq!((x - two + x).slopes(), [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn the_greater_of_two_keeps_its_own_slope() {
        let (x, four) = (along(3.0), Dual::splat(4.0));
        assert_eq!([Number::max(x, four).slopes[0], Number::min(x, four).slopes[0]], [0.0, 1.0]);
        assert_eq!(Dual::select(x.greater(four), x, four), four);
    }
}
