//! The numbers that laws are written in: one `f64`, or several side by side in a vector register.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// The larger of two numbers, or the second if it is not a number.
#[inline(always)]
pub fn larger(most: f64, one: f64) -> f64 {
    if one > most || one.is_nan() { one } else { most }
}

/// A row of four numbers, 32 bytes.
pub type Row = [f64; 4];

/// Adds a row to another.
#[inline(always)]
pub(crate) fn add(sum: &mut Row, row: &Row) {
    *sum = [sum[0] + row[0], sum[1] + row[1], sum[2] + row[2], sum[3] + row[3]];
}

/// Takes a row from another.
#[inline(always)]
pub(crate) fn subtract(sum: &mut Row, row: &Row) {
    *sum = [sum[0] - row[0], sum[1] - row[1], sum[2] - row[2], sum[3] - row[3]];
}

/// A real number, or a lane vector of real numbers, in IEEE 754 double precision.
///
/// Every operation is exactly rounded and none is fused, so a law written over this trait gives the
/// same bits in every lane width. Decisions are masks: both sides of a [`Number::select`] are evaluated.
pub trait Number:
    Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The answer of a comparison, one truth value a lane.
    type Mask: Copy;
    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// `self` where it is larger, otherwise `other` (also where either is not a number).
    fn max(self, other: Self) -> Self;
    /// `self` where it is smaller, otherwise `other` (also where either is not a number).
    fn min(self, other: Self) -> Self;
    /// Where `self > other`; false where either is not a number.
    fn greater(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, otherwise `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Where both masks hold.
    fn both(one: Self::Mask, other: Self::Mask) -> Self::Mask;
    /// Where at least one mask holds.
    fn either(one: Self::Mask, other: Self::Mask) -> Self::Mask;
    /// Whether the mask holds in any lane.
    fn any(mask: Self::Mask) -> bool;
    /// The nearest whole number, of one below 2⁵¹: adding and taking away 1.5 · 2⁵² rounds to it.
    #[inline(always)]
    fn whole(self) -> Self {
        let rounder = Self::splat(6_755_399_441_055_744.0);
        (self + rounder) - rounder
    }
    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }
    /// A polynomial with these coefficients, from that of the zeroth power up.
    #[inline(always)]
    fn polynomial<const COUNT: usize>(self, coefficients: &[f64; COUNT]) -> Self {
        let mut sum = Self::splat(coefficients[COUNT - 1]);
        let mut index = COUNT - 1;
        while index > 0 {
            index -= 1;
            sum = sum * self + Self::splat(coefficients[index]);
        }
        sum
    }
    /// Cube root of a number of 0 or above, to some units in the last place. Square roots give x^(85/256), from which
    /// four of Halley's steps, y ← y (y³ + 2x)/(2y³ + x), go to x^(1/3) whatever the size of x.
    #[inline(always)]
    fn cube_root(self) -> Self {
        let fourth = self.sqrt().sqrt();
        let sixteenth = fourth.sqrt().sqrt();
        let next = sixteenth.sqrt().sqrt();
        let mut root = fourth * sixteenth * next * next.sqrt().sqrt();
        let mut turn = 0;
        while turn < 4 {
            let cube = root * root * root;
            root = root * ((cube + self + self) / (cube + cube + self));
            turn += 1;
        }
        Self::select(self.greater(Self::zero()), root, Self::zero())
    }
}

/// The power of two at or below the magnitude of a number; 1 where it is 0, subnormal or not finite. What is divided by it keeps its bits.
pub(crate) fn binade(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7FF0_0000_0000_0000;
    if x.is_normal() { f64::from_bits(x.to_bits() & EXPONENT) } else { 1.0 }
}

impl Number for f64 {
    type Mask = bool;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn greater(self, other: Self) -> bool {
        self > other
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
}

/// A vector in space whose components are [`Number`]s.
///
/// nalgebra's vectors need operations that lane vectors do not have; this one has what laws use.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector<N = f64> {
    /// Component along x.
    pub x: N,
    /// Component along y.
    pub y: N,
    /// Component along z.
    pub z: N,
}

impl<N: Number> Vector<N> {
    /// The vector with these components.
    #[inline(always)]
    pub fn new(x: N, y: N, z: N) -> Self {
        Self { x, y, z }
    }
    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(N::zero(), N::zero(), N::zero())
    }
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }
    /// Euclidean length.
    #[inline(always)]
    pub fn length(self) -> N {
        self.dot(self).sqrt()
    }
    /// The first three of four numbers.
    #[inline(always)]
    pub fn of_row([x, y, z, _]: [N; 4]) -> Self {
        Self::new(x, y, z)
    }
    /// The components and a fourth number.
    #[inline(always)]
    pub fn row_with(self, rest: N) -> [N; 4] {
        [self.x, self.y, self.z, rest]
    }
    /// `yes` where the mask holds, otherwise `no`.
    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        Self::new(N::select(mask, yes.x, no.x), N::select(mask, yes.y, no.y), N::select(mask, yes.z, no.z))
    }
}

impl Vector<f64> {
    /// The components in order.
    pub fn to_array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }
}

impl From<[f64; 3]> for Vector<f64> {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

impl From<[f64; 4]> for Vector<f64> {
    /// The first three of a row; what the fourth holds is the row's business.
    fn from([x, y, z, _]: [f64; 4]) -> Self {
        Self { x, y, z }
    }
}

impl<N: Number> Add for Vector<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<N: Number> AddAssign for Vector<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<N: Number> Sub for Vector<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<N: Number> Mul<N> for Vector<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<N: Number> Neg for Vector<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cube_roots_hold_to_some_units_in_the_last_place_at_any_size() {
        for exponent in -290..=290 {
            for digits in [1.0, 1.7, 2.0, 3.2, 8.0, 9.99] {
                let cube = digits * libm::pow(10.0, f64::from(exponent));
                let (found, expected) = (Number::cube_root(cube), libm::cbrt(cube));
                assert!((found - expected).abs() <= 4.0 * f64::EPSILON * expected, "{found:e} of {cube:e}");
            }
        }
        assert_eq!(Number::cube_root(0.0), 0.0);
    }
}
