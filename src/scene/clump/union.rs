//! Volume, mass centre and inertia of the union of some spheres.
//!
//! ```text
//! ∫ f dV = ∮ f (x · n) dS / (k + 3)        f homogeneous of degree k
//! ```
//!
//! The surface of the union is what no other sphere covers of each sphere. On a circle of latitude another sphere covers one arc, so
//! what is left of a circle is known exactly. Along the latitude the integrand has the singularity of a square root where another
//! sphere begins or ends to cover: between these latitudes the quadrature takes the sine of an angle as its variable, which removes
//! it. Where spheres do not overlap, sums over the spheres are exact.

use std::f64::consts::{PI, TAU};

/// Volume \[m³\] and moments of it: first \[m⁴\], second (xx, yy, zz, xy, xz, yz) \[m⁵\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Volume {
    /// Volume.
    pub(super) volume: f64,
    /// First moments.
    pub(super) first: [f64; 3],
    /// Second moments.
    pub(super) second: [f64; 6],
}

/// Rows and columns of second moments.
const PLACES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Points of the rule of Gauss and Legendre.
const POINTS: usize = 16;

/// Pieces of all latitudes together, and between two of them at most, of the result; its error is estimated by half as many.
const PIECES: [usize; 2] = [128, 16];

/// A sphere: its centre and radius \[m\].
type Sphere = ([f64; 3], f64);

/// Those of the union about the origin, and the estimated relative error of volume and second moments.
pub(super) fn moments(spheres: &[Sphere]) -> (Volume, f64) {
    let apart = |(a, r): &Sphere, (b, s): &Sphere| {
        (0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis])).sum::<f64>() >= (r + s) * (r + s)
    };
    let disjoint = |(place, one): (usize, &Sphere)| spheres[..place].iter().all(|other| apart(one, other));
    if spheres.iter().enumerate().all(disjoint) {
        return (spheres.iter().fold(Volume::default(), whole), 0.0);
    }
    let rule = gauss();
    let [fine, coarse] = [1, 2].map(|coarser| {
        let mut sum = Volume::default();
        for (place, _) in spheres.iter().enumerate() {
            exposed(spheres, place, coarser, &rule, &mut sum);
        }
        sum
    });
    let size = |it: &Volume| it.second[0] + it.second[1] + it.second[2];
    let apart = fine.second.iter().zip(coarse.second).map(|(a, b)| (a - b).abs() / size(&fine));
    (fine, apart.fold((fine.volume - coarse.volume).abs() / fine.volume, f64::max))
}

/// Adds a whole sphere.
fn whole(mut sum: Volume, (centre, radius): &Sphere) -> Volume {
    let volume = 4.0 / 3.0 * PI * radius * radius * radius;
    sum.volume += volume;
    for axis in 0..3 {
        sum.first[axis] += volume * centre[axis];
    }
    for (place, [row, column]) in PLACES.into_iter().enumerate() {
        let own = if row == column { 0.2 * radius * radius } else { 0.0 };
        sum.second[place] += volume * (centre[row] * centre[column] + own);
    }
    sum
}

/// Points and weights on −1 to 1, by Newton's method for the polynomial of Legendre.
fn gauss() -> Vec<[f64; 2]> {
    let count = POINTS as f64;
    let point = |place: usize| {
        let mut x = libm::cos(PI * (place as f64 + 0.75) / (count + 0.5));
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut before, mut now) = (1.0, x);
            for degree in 2..=POINTS {
                let n = degree as f64;
                (before, now) = (now, ((2.0 * n - 1.0) * x * now - (n - 1.0) * before) / n);
            }
            slope = count * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        [x, 2.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..POINTS).map(point).collect()
}

/// Adds the integrals over what no other sphere covers of one, by so many times fewer pieces.
fn exposed(spheres: &[Sphere], own: usize, coarser: usize, rule: &[[f64; 2]], sum: &mut Volume) {
    let (centre, radius) = spheres[own];
    let mut caps: Vec<Cap> = Vec::new();
    for (place, (other, reach)) in spheres.iter().enumerate().filter(|(place, _)| *place != own) {
        let way = [0, 1, 2].map(|axis| other[axis] - centre[axis]);
        let distance = way.iter().map(|part| part * part).sum::<f64>().sqrt();
        // One that lies inside another has no surface; of equal ones the first has it.
        let is_same = distance == 0.0 && *reach == radius;
        if distance + radius <= *reach && (!is_same || place < own) {
            return;
        }
        if distance >= radius + reach || distance + reach <= radius {
            continue;
        }
        let cosine = (distance * distance + radius * radius - reach * reach) / (2.0 * distance * radius);
        caps.push(Cap { axis: way.map(|part| part / distance), cosine });
    }
    let mut latitudes = vec![-1.0, 1.0];
    for Cap { axis, cosine } in &caps {
        let (flat, sine) = ((1.0 - axis[2] * axis[2]).max(0.0).sqrt(), (1.0 - cosine * cosine).sqrt());
        for sign in [-1.0, 1.0] {
            latitudes.push((axis[2] * cosine + sign * flat * sine).clamp(-1.0, 1.0));
        }
    }
    latitudes.sort_by(f64::total_cmp);
    let pieces = (PIECES[0] / latitudes.len()).clamp(2, PIECES[1]) / coarser;
    for pair in latitudes.windows(2).filter(|pair| pair[1] > pair[0]) {
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        let width = PI / pieces as f64;
        for piece in 0..pieces {
            for [x, weight] in rule {
                let angle = -0.5 * PI + width * (piece as f64 + 0.5 * (1.0 + x));
                let height = (middle + half * libm::sin(angle)).clamp(-1.0, 1.0);
                let weight = 0.5 * width * weight * half * libm::cos(angle);
                for [from, to] in left_of_circle(&caps, height) {
                    along((centre, radius), height, [from, to], weight, rule, sum);
                }
            }
        }
    }
}

/// What another sphere covers: the part of a sphere about an axis whose directions have at least this cosine with it.
struct Cap {
    /// Its axis.
    axis: [f64; 3],
    /// Cosine of its angular radius.
    cosine: f64,
}

/// The arcs of the circle at this height, over the radius, that no cap covers: angles about z.
fn left_of_circle(caps: &[Cap], height: f64) -> Vec<[f64; 2]> {
    let flat = (1.0 - height * height).sqrt();
    let mut covered: Vec<[f64; 2]> = Vec::new();
    for Cap { axis, cosine } in caps {
        let (across, along) = (flat * (axis[0] * axis[0] + axis[1] * axis[1]).sqrt(), height * axis[2]);
        if along - across >= *cosine {
            return Vec::new();
        }
        if along + across <= *cosine {
            continue;
        }
        let half = libm::acos(((cosine - along) / across).clamp(-1.0, 1.0));
        let from = (libm::atan2(axis[1], axis[0]) - half).rem_euclid(TAU);
        let to = from + 2.0 * half;
        covered.push([from, to.min(TAU)]);
        if to > TAU {
            covered.push([0.0, to - TAU]);
        }
    }
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut left, mut reached) = (Vec::new(), 0.0);
    for [from, to] in covered {
        if from > reached {
            left.push([reached, from]);
        }
        reached = f64::max(reached, to);
    }
    if reached < TAU {
        left.push([reached, TAU]);
    }
    left
}

/// Adds the integrals along an arc of the circle at this height of a sphere.
fn along(
    (centre, radius): Sphere,
    height: f64,
    [from, to]: [f64; 2],
    weight: f64,
    rule: &[[f64; 2]],
    sum: &mut Volume,
) {
    // The integrands are sines and cosines of up to three times the angle: half a circle at a time is exact to rounding.
    let parts = if to - from > PI { 2 } else { 1 };
    let (flat, width) = ((1.0 - height * height).sqrt(), (to - from) / f64::from(parts));
    for part in 0..parts {
        for [x, share] in rule {
            let angle = from + width * (f64::from(part) + 0.5 * (1.0 + x));
            let normal = [flat * libm::cos(angle), flat * libm::sin(angle), height];
            let place = [0, 1, 2].map(|axis| centre[axis] + radius * normal[axis]);
            let outwards: f64 = (0..3).map(|axis| place[axis] * normal[axis]).sum();
            let element = weight * (0.5 * width * share) * radius * radius * outwards;
            sum.volume += element / 3.0;
            for axis in 0..3 {
                sum.first[axis] += element * place[axis] / 4.0;
            }
            for (second, [row, column]) in sum.second.iter_mut().zip(PLACES) {
                *second += element * place[row] * place[column] / 5.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume and second moment about the axis of centres of the part of a unit sphere beyond the height h, along x.
    fn beyond(h: f64) -> [f64; 2] {
        // ∫ π (1 − x²) dx and ∫ π (1 − x²) x² dx from h to 1.
        [PI * (2.0 / 3.0 - h + h * h * h / 3.0), PI * (2.0 / 15.0 - h * h * h / 3.0 + h.powi(5) / 5.0)]
    }

    #[test]
    fn two_that_overlap_are_what_the_caps_leave() {
        for (axis, d) in [(0, 0.5), (1, 0.9), (2, 0.1)] {
            let place = |sign: f64| [0, 1, 2].map(|k| if k == axis { sign * d } else { 0.0 });
            let (found, error) = moments(&[(place(1.0), 1.0), (place(-1.0), 1.0)]);
            // Each sphere on its own side of the plane between them.
            let [cap, _] = beyond(d);
            let volume = 2.0 * (4.0 / 3.0 * PI - cap);
            assert!((found.volume / volume - 1.0).abs() < 1e-12, "{} m³, {volume} expected", found.volume);
            assert!(error < 1e-12, "{error:e}");
            // ∫ x² with x from the plane between: of the right sphere x = d + s, s from −d to 1.
            let [volume_left, second_left] = [beyond(-d)[0], beyond(-d)[1]];
            let first_left = PI * (1.0 - d * d) * (1.0 - d * d) / 4.0;
            let second = 2.0 * (second_left + 2.0 * d * first_left + d * d * volume_left);
            assert!((found.second[axis] / second - 1.0).abs() < 1e-12, "{} m⁵, {second} expected", found.second[axis]);
            assert!(found.first.iter().all(|part| part.abs() < 1e-13), "{:?}", found.first);
        }
    }

    #[test]
    fn one_inside_another_and_equal_ones_count_once() {
        let one = ([0.3, -0.2, 0.1], 1.0);
        let alone = whole(Volume::default(), &one);
        for others in [vec![one, one], vec![one, ([0.5, -0.2, 0.1], 0.4)], vec![([0.5, -0.2, 0.1], 0.4), one, one]] {
            let (found, _) = moments(&others);
            assert!((found.volume / alone.volume - 1.0).abs() < 1e-13, "{found:?}, {alone:?} expected");
            assert!((found.second[3] - alone.second[3]).abs() < 1e-13, "{found:?}, {alone:?} expected");
        }
    }

    #[test]
    fn three_that_overlap_in_one_point_agree_with_any_other_order_and_turn() {
        let spheres = [([0.6, 0.0, 0.0], 1.0), ([-0.3, 0.5, 0.0], 0.9), ([-0.2, -0.4, 0.3], 0.8)];
        let turned = spheres.map(|([x, y, z], radius)| ([z, x, y], radius));
        let ((one, error), (other, _)) = (moments(&spheres), moments(&turned));
        assert!(error < 1e-5, "{error:e}");
        assert!((one.volume / other.volume - 1.0).abs() < 2.0 * error.max(1e-9), "{one:?}, {other:?}, {error:e}");
        assert!((one.second[0] - other.second[1]).abs() < 2.0 * error.max(1e-9) * one.second[0], "{one:?}, {other:?}");
    }

    #[test]
    fn spheres_apart_add_up_exactly() {
        let spheres = [([2.0, 0.0, 0.0], 1.0), ([-2.0, 0.0, 0.0], 1.0)];
        let (found, error) = moments(&spheres);
        assert_eq!(error, 0.0);
        assert!((found.volume - 8.0 / 3.0 * PI).abs() < 1e-14);
        assert!((found.second[0] - found.volume * 4.2).abs() < 1e-13, "{found:?}");
    }
}
