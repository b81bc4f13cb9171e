//! Logarithm, exponential and power without a branch and without a table: loops over them become vector instructions, with the same bits
//! in every width.

use super::number::Number;
use std::f64::consts::LOG2_E;

/// The natural logarithm of 2, in two parts: products of the first with whole numbers below 2²¹ are exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// Bits of the square root of ½: mantissas are taken from there to √2.
const ROOT_OF_HALF: u64 = 0x3FE6_A09E_667F_3BCD;

/// The bits of a number behind its exponent.
const MANTISSA: u64 = (1 << 52) - 1;

/// Bits of 1.
const ONE: u64 = 0x3FF0_0000_0000_0000;

/// Bits of 2⁵², behind which whole numbers stand as they are.
const TWO_TO_52: u64 = 0x4330_0000_0000_0000;

/// 1/3, 1/5, ..: the series of the inverse hyperbolic tangent behind its first term, whose next term is below the rounding. Every second
/// coefficient stands in the second list: two short chains of products take less time than a long one.
const INVERSE_TANGENT: ([f64; 5], [f64; 4]) =
    ([1.0 / 3.0, 1.0 / 7.0, 1.0 / 11.0, 1.0 / 15.0, 1.0 / 19.0], [1.0 / 5.0, 1.0 / 9.0, 1.0 / 13.0, 1.0 / 17.0]);

/// 1/2!, 1/3!, ..: the series of the exponential behind its first two terms, in the same way.
const EXPONENTIAL: ([f64; 6], [f64; 6]) = (
    [1.0 / 2.0, 1.0 / 24.0, 1.0 / 720.0, 1.0 / 40_320.0, 1.0 / 3_628_800.0, 1.0 / 479_001_600.0],
    [1.0 / 6.0, 1.0 / 120.0, 1.0 / 5_040.0, 1.0 / 362_880.0, 1.0 / 39_916_800.0, 1.0 / 6_227_020_800.0],
);

/// The polynomial with these coefficients, those of even powers and those of odd ones.
#[inline(always)]
fn series<const EVEN: usize, const ODD: usize>(x: f64, (even, odd): &([f64; EVEN], [f64; ODD])) -> f64 {
    let square = x * x;
    square.polynomial(even) + x * square.polynomial(odd)
}

/// Natural logarithm of a number above 0, to two units in the last place. Numbers below 2⁻¹⁰²², 0 among them, have one of some −709.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    let bits = x.to_bits().wrapping_add(ONE - ROOT_OF_HALF);
    let exponent = f64::from_bits((bits >> 52) | TWO_TO_52) - (4_503_599_627_370_496.0 + 1023.0);
    let mantissa = f64::from_bits((bits & MANTISSA) + ROOT_OF_HALF);
    // ln m = 2 artanh((m − 1)/(m + 1))
    let above = mantissa - 1.0;
    let tangent = above / (2.0 + above);
    let square = tangent * tangent;
    let twice = tangent + tangent;
    exponent * LN_2[0] + (twice + (twice * (square * series(square, &INVERSE_TANGENT)) + exponent * LN_2[1]))
}

/// Exponential of a number, to two units in the last place; of one below −708 or above 709 that of these.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    let x = Number::min(Number::max(x, -708.0), 709.0);
    let exponent = (x * LOG2_E).whole();
    let rest = (x - exponent * LN_2[0]) - exponent * LN_2[1];
    let power = 1.0 + (rest + rest * rest * series(rest, &EXPONENTIAL));
    // The exponent stands in the last bits of this sum, from where it is moved to its place.
    power * f64::from_bits((exponent + (6_755_399_441_055_744.0 + 1023.0)).to_bits() << 52)
}

/// A power of a number above 0. Its relative error is that of the exponent's product with the logarithm.
#[inline(always)]
pub fn power(base: f64, exponent: f64) -> f64 {
    exp(exponent * ln(base))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::SQRT_2;

    /// Numbers of all sizes.
    fn samples() -> impl Iterator<Item = f64> {
        (-1020..=1020).flat_map(|exponent| {
            [1.0, 1.000_001, 1.3, SQRT_2.next_down(), SQRT_2.next_up(), 1.7, 1.999_999]
                .map(|digits| digits * 2.0_f64.powi(exponent))
        })
    }

    #[test]
    fn logarithms_hold_to_two_units_in_the_last_place() {
        for x in samples().chain((1..2000).map(|step| 0.5 + 1e-3 * f64::from(step))) {
            let (found, expected) = (ln(x), libm::log(x));
            assert!(
                (found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs(),
                "ln {x:e}: {found}, expected {expected}"
            );
        }
        assert_eq!([ln(1.0), power(1.0, -3.7)], [0.0, 1.0]);
        assert!([0.0, 1e-310].map(ln).iter().all(|logarithm| (*logarithm + 709.0).abs() < 1.0));
    }

    #[test]
    fn exponentials_hold_to_two_units_in_the_last_place() {
        for x in (-70_800..=70_900).map(|step| 1.000_1e-2 * f64::from(step)).filter(|x| (-708.0..709.0).contains(x)) {
            let (found, expected) = (exp(x), libm::exp(x));
            assert!(
                (found - expected).abs() <= 2.0 * f64::EPSILON * expected,
                "exp {x}: {found:e}, expected {expected:e}"
            );
        }
        assert_eq!(exp(0.0), 1.0);
        assert!(exp(-1e300) > 0.0 && exp(1e300).is_finite());
    }

    #[test]
    fn powers_undo_each_other() {
        for x in samples().filter(|x| (1e-30..1e30).contains(x)) {
            assert!((power(power(x, 0.687), 1.0 / 0.687) / x - 1.0).abs() < 1e-13, "{x}");
        }
    }
}
