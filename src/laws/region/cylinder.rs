//! A cylinder between two points.

use super::quadrature::integral;
use super::sphere::{UNIT, between};
use super::{EVERYWHERE, NOWHERE, between_planes, in_both};
use crate::base::number::Vector;
use std::f64::consts::PI;

/// Error of the volume of a part of a sphere, over the volume of the sphere, at which a piece of the integral is good enough.
const ERROR: f64 = 1e-14;

/// Angle below which a series takes the place of t − sin t.
const SMALL: f64 = 0.5;

/// A cylinder between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Centre of the end where it begins \[m\].
    from: Vector,
    /// Unit vector along its axis.
    along: Vector,
    /// Its length \[m\].
    length: f64,
    /// Its radius \[m\].
    radius: f64,
}

impl Cylinder {
    /// The cylinder between the centres of its ends \[m\], of this radius \[m\]; none where its ends are one point.
    pub fn new(from: [f64; 3], to: [f64; 3], radius: f64) -> Option<Self> {
        let way = Vector::from(to) - from.into();
        let length = way.length();
        (length > 0.0).then(|| Self { from: from.into(), along: way * (1.0 / length), length, radius })
    }

    /// Its volume \[m³\].
    pub(super) fn volume(&self) -> f64 {
        PI * self.radius * self.radius * self.length
    }

    /// The smallest box around it: lower and upper corner \[m\].
    pub(super) fn bounds(&self) -> [[f64; 3]; 2] {
        let ends = [self.from, self.from + self.along * self.length].map(Vector::to_array);
        let along = self.along.to_array();
        let wide = along.map(|part| self.radius * (1.0 - part * part).max(0.0).sqrt());
        let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max];
        let corner = |of: fn(f64, f64) -> f64, sign: f64| {
            [0, 1, 2].map(|axis| of(ends[0][axis], ends[1][axis]) + sign * wide[axis])
        };
        [corner(low, -1.0), corner(high, 1.0)]
    }

    /// The centre of a sphere that lies whole inside, all places equally likely \[m\].
    pub(super) fn place_of(&self, radius: f64, uniform: &mut dyn FnMut() -> f64) -> Option<Vector> {
        let (room, wide) = (self.length - 2.0 * radius, self.radius - radius);
        if room < 0.0 || wide < 0.0 {
            return None;
        }
        let along = self.along.to_array();
        // The axis of the scene that is least along the cylinder begins the directions across it.
        let least = (0..3).fold(0, |least, axis| if along[axis].abs() < along[least].abs() { axis } else { least });
        let mut start = [0.0; 3];
        start[least] = 1.0;
        let across = self.along.cross(start.into());
        let across = across * (1.0 / across.length());
        let (x, y) = loop {
            let (x, y) = (2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0);
            if x * x + y * y <= 1.0 {
                break (x, y);
            }
        };
        let height = radius + room * uniform();
        Some(self.from + self.along * height + (across * x + self.along.cross(across) * y) * wide)
    }

    /// How far a point is along the axis from where it begins \[m\], and the way to it from the axis \[m\].
    fn place(&self, point: Vector) -> (f64, Vector) {
        let way = point - self.from;
        let height = way.dot(self.along);
        (height, way - self.along * height)
    }

    /// Whether a point is inside.
    pub(super) fn holds(&self, point: Vector) -> bool {
        let (height, away) = self.place(point);
        (0.0..self.length).contains(&height) && away.dot(away) <= self.radius * self.radius
    }

    /// Volume of the part of a sphere that is inside \[m³\]: the integral along the axis of the areas that discs of the sphere have
    /// in common with that of the cylinder.
    pub(super) fn volume_of_sphere(&self, centre: Vector, radius: f64) -> f64 {
        let (height, away) = self.place(centre);
        let (low, high) = (-height / radius, (self.length - height) / radius);
        let (own, distance) = (self.radius / radius, away.length() / radius);
        if low >= 1.0 || high <= -1.0 || distance - own >= 1.0 {
            return 0.0;
        }
        let cube = radius * radius * radius;
        let part = if own - distance >= 1.0 {
            between(low, high)
        } else {
            cut_by_mantle([low.max(-1.0), high.min(1.0)], own, distance)
        };
        (part * cube).clamp(0.0, self.volume())
    }

    /// Where a line is inside, over its way.
    pub(super) fn passage(&self, from: Vector, way: Vector) -> [f64; 2] {
        let (height, away) = self.place(from);
        let rise = way.dot(self.along);
        let across = way - self.along * rise;
        let ends = between_planes(height, rise, self.length);
        // |away + t across|² = radius²
        let (square, product) = (across.dot(across), across.dot(away));
        let excess = away.dot(away) - self.radius * self.radius;
        if square == 0.0 {
            return in_both(ends, if excess <= 0.0 { EVERYWHERE } else { NOWHERE });
        }
        let root = product * product - square * excess;
        if root < 0.0 {
            return NOWHERE;
        }
        // The root that does not cancel, and the other by the product of both.
        let sum = -(product + root.sqrt().copysign(product));
        let (one, other) = (sum / square, if sum == 0.0 { 0.0 } else { excess / sum });
        in_both(ends, [one.min(other), one.max(other)])
    }
}

/// Volume of the part of the unit sphere between the planes z = `low` and z = `high` that is inside a cylinder along z of this
/// radius, whose axis is this far from the centre.
///
/// ```text
/// V = ∫ A(√(1 − z²)) dz
/// ```
///
/// A, the area that two discs have in common, behaves as |z − z*|^(3/2) where the smaller disc begins to leave the other, and where
/// the discs begin to meet: at 1 − z*² = (R ∓ d)². Between such places z = m − h cos φ makes it smooth.
fn cut_by_mantle([low, high]: [f64; 2], radius: f64, distance: f64) -> f64 {
    let mut places = vec![low, high];
    for reach in [(radius - distance).abs(), radius + distance] {
        if reach < 1.0 {
            let place = ((1.0 - reach) * (1.0 + reach)).sqrt();
            places.extend([-place, place].into_iter().filter(|place| low < *place && *place < high));
        }
    }
    places.sort_by(f64::total_cmp);
    let area = |z: f64| common_area(((1.0 - z) * (1.0 + z)).max(0.0).sqrt(), radius, distance);
    let piece = |ends: &[f64]| {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        let smooth = |angle: f64| area(middle - half * libm::cos(angle)) * half * libm::sin(angle);
        integral(&smooth, [0.0, PI], ERROR * UNIT)
    };
    places.windows(2).map(piece).sum()
}

/// The area that two discs of these radii have in common, whose centres are this far apart.
fn common_area(one: f64, other: f64, distance: f64) -> f64 {
    let (smaller, larger) = (one.min(other), one.max(other));
    if distance <= larger - smaller {
        return PI * smaller * smaller;
    }
    if distance >= one + other {
        return 0.0;
    }
    // Four times the area of the triangle of the centres and a point where the circles meet (Heron).
    let product =
        (one + other - distance) * (distance + one - other) * (distance - one + other) * (distance + one + other);
    let area = product.max(0.0).sqrt();
    // Where the centre of a disc is beyond the common chord, its segment is the larger one.
    let segment = |own: f64, its: f64| {
        let nearer = distance * distance + (own - its) * (own + its);
        0.5 * own * own * less_sine(2.0 * libm::atan2(area, nearer))
    };
    segment(one, other) + segment(other, one)
}

/// t − sin t, without cancellation where t is small.
fn less_sine(t: f64) -> f64 {
    if t > SMALL {
        return t - libm::sin(t);
    }
    // t³/3! − t⁵/5! + …: eleven terms are below rounding.
    let square = t * t;
    let terms = (1..=10).rev().fold(1.0, |sum, order| {
        let n = f64::from(2 * order);
        1.0 - sum * square / ((n + 2.0) * (n + 3.0))
    });
    t * square / 6.0 * terms
}
