//! Angles in lanes: arcus tangent, tangent, continued angle, from exactly rounded operations alone.

use crate::base::number::Number;

/// Where the polynomial of [`arctangent_ratio`] ends: tan² of 14 degrees.
const NEAR: f64 = 1.0 / 16.0;

/// Its root.
const NEAR_TANGENT: f64 = 0.25;

/// Coefficients of (arctan √y/√y − 1)/y on 0 … 1/16, from y⁰ up: Chebyshev interpolation of the ninth order.
const SERIES: [f64; 9] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_989_33,
    -0.142_857_142_852_585_1,
    0.111_111_110_359_868_47,
    -0.090_909_028_749_694_16,
    0.076_920_178_772_373_86,
    -0.066_586_874_146_977_43,
    0.057_529_943_904_780_285,
    -0.041_034_266_985_419_496,
];

/// arctan(√y)/√y for y ≥ 0; 1 at 0.
#[inline(always)]
pub fn arctangent_ratio<N: Number>(square: N) -> N {
    arctangent_series(square)[0]
}

/// The ratio f = arctan(√y)/√y for y ≥ 0, 1 at 0, and (f − 1)/y, −1/3 at 0.
///
/// Off by less than 3e-16 everywhere. Above 1/16 the angle is halved three times, which takes all of the
/// half line below tan²(π/16) < 1/16; lanes below are not touched by that.
#[inline(always)]
pub fn arctangent_series<N: Number>(square: N) -> [N; 2] {
    let one = N::splat(1.0);
    let far = square.greater(N::splat(NEAR));
    let mut sum = square.polynomial(&SERIES);
    let mut ratio = one + square * sum;
    // Seldom: a bond bent by more than 28 degrees. Lanes that are near keep their values whether or not it is taken.
    if N::any(far) {
        let (mut reduced, mut shrunk) = (square, one);
        for _ in 0..3 {
            let below = one + (one + reduced).sqrt();
            reduced = reduced / (below * below);
            shrunk = shrunk * (N::splat(2.0) / below);
        }
        ratio = N::select(far, (one + reduced * reduced.polynomial(&SERIES)) * shrunk, ratio);
        sum = N::select(far, (ratio - one) / square, sum);
    }
    [ratio, sum]
}

/// tan(√x)/√x from x: the Padé fraction of [`super::Quaternion::turned`].
///
/// Off by less than 1e-16 up to √x = 0.1, 1e-9 up to ½, 3e-7 up to 1.
#[inline(always)]
pub fn tangent_ratio<N: Number>(square: N) -> N {
    let above = N::splat(945.0) - square * (N::splat(105.0) - square);
    let below = N::splat(945.0) - square * (N::splat(420.0) - N::splat(15.0) * square);
    above / below
}

/// Where the vector (x, y) lies within 14 degrees of the x axis.
#[inline(always)]
pub fn is_flat<N: Number>(x: N, y: N) -> N::Mask {
    N::both(x.greater(N::zero()), (x * N::splat(NEAR_TANGENT)).greater(y.abs()))
}

/// Twice the angle of the vector (x, y) from the x axis, in −2π … 2π. `tangent` is y/x where it [`is_flat`].
#[inline(always)]
pub fn twice_angle<N: Number>(x: N, y: N, flat: N::Mask, tangent: N) -> N {
    let zero = N::zero();
    let near = N::splat(2.0) * tangent * (N::splat(1.0) + tangent * tangent * (tangent * tangent).polynomial(&SERIES));
    let steep = N::select(flat, zero, N::splat(1.0)).greater(zero);
    // Seldom: a bond twisted by more than 28 degrees. By the half angle, which needs a root.
    if !N::any(steep) {
        return near;
    }
    let tangent = y / ((x * x + y * y).sqrt() + x.abs());
    let acute = N::splat(4.0) * tangent * arctangent_ratio(tangent * tangent);
    let turn = N::splat(std::f64::consts::TAU);
    let behind = N::select(zero.greater(y), -turn, turn) - acute;
    N::select(flat, near, N::select(zero.greater(x), behind, acute))
}

/// The angle that differs from `angle` by whole double turns (4π) and is nearest to `last`.
#[inline(always)]
pub fn continued<N: Number>(angle: N, last: N) -> N {
    let double_turn = 2.0 * std::f64::consts::TAU;
    let turns = ((last - angle) * N::splat(1.0 / double_turn)).whole();
    angle + turns * N::splat(double_turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcus_tangent_to_rounding() {
        for step in 0..4000 {
            let tangent = libm::exp(f64::from(step) * 0.01 - 20.0);
            let expected = libm::atan(tangent) / tangent;
            let found = arctangent_ratio(tangent * tangent);
            assert!((found / expected - 1.0).abs() < 1e-15, "{tangent}: {found} for {expected}");
        }
        assert_eq!(arctangent_ratio(0.0), 1.0);
    }

    #[test]
    fn tangent_of_small_angles_to_rounding() {
        for (angle, bound) in [(0.01, 3e-16), (0.1, 3e-16), (0.5, 1e-9), (1.0, 3e-7)] {
            let expected: f64 = libm::tan(angle) / angle;
            let found: f64 = tangent_ratio(angle * angle);
            assert!((found / expected - 1.0).abs() < bound, "{angle}: {found} for {expected}");
        }
    }

    /// Twice the angle of a vector.
    fn twice(x: f64, y: f64) -> f64 {
        twice_angle(x, y, is_flat(x, y), y / x)
    }

    #[test]
    fn twice_the_angle_in_all_quarters() {
        for step in -62..=62 {
            let angle = f64::from(step) * 0.05;
            let found = twice(3.0 * libm::cos(angle), 3.0 * libm::sin(angle));
            assert!((found - 2.0 * angle).abs() < 2e-15, "{angle}: {found}");
        }
    }

    #[test]
    fn the_angle_is_followed_over_many_turns() {
        let mut last = 0.0;
        for step in 0..1000 {
            let angle = f64::from(step) * 0.3;
            last = continued(twice(libm::cos(angle / 2.0), libm::sin(angle / 2.0)), last);
            assert!((last - angle).abs() < 1e-12, "{angle}: {last}");
        }
    }
}
