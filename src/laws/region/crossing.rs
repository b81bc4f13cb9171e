//! Where a line goes through triangles. Two triangles at an edge decide alike on which side of the edge the line passes, and those around
//! a vertex do, too: no line slips through between them, and none goes through both.

use crate::base::number::Vector;

/// A line, seen along itself.
pub(super) struct Line {
    /// Where it begins \[m\].
    from: [f64; 3],
    /// Its way \[m\].
    way: [f64; 3],
    /// The axis along which it goes farthest, and the next two.
    axes: [usize; 3],
}

/// A place where a line goes through a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// Where, over the way of the line.
    pub(super) at: f64,
    /// Whether it goes from behind the triangle to its front.
    pub(super) out: bool,
}

/// A corner: two coordinates across the line and one along it, over its way.
type Seen = ([f64; 2], f64);

impl Line {
    /// The line between two points \[m\]; nothing if they are the same.
    pub(super) fn between(from: Vector, to: Vector) -> Option<Self> {
        let (from, way) = (from.to_array(), (to - from).to_array());
        let longest = (1..3).fold(0, |most, axis| if way[axis].abs() > way[most].abs() { axis } else { most });
        let axes = [longest, (longest + 1) % 3, (longest + 2) % 3];
        (way[longest] != 0.0).then_some(Self { from, way, axes })
    }

    /// A point as it is seen along the line.
    fn see(&self, point: Vector) -> Seen {
        let point = point.to_array();
        let [z, x, y] = self.axes;
        let along = (point[z] - self.from[z]) / self.way[z];
        ([x, y].map(|axis| point[axis] - self.from[axis] - self.way[axis] * along), along)
    }

    /// Where it goes through a triangle.
    pub(super) fn through(&self, corners: [Vector; 3]) -> Option<Crossing> {
        let [a, b, c] = corners.map(|corner| self.see(corner));
        let sides = [(b, c), (c, a), (a, b)].map(|(one, other)| side(one.0, other.0));
        let left = sides[0];
        if left == 0 || sides.iter().any(|side| *side != left) {
            return None;
        }
        let weights =
            [(b, c), (c, a), (a, b)].map(|(one, other)| (one.0[0] * other.0[1] - one.0[1] * other.0[0]).abs());
        let sum: f64 = weights.iter().sum();
        let places = [a.1, b.1, c.1];
        let mean = match sum > 0.0 {
            true => (0..3).map(|corner| weights[corner] / sum * places[corner]).sum(),
            false => places[0],
        };
        let (low, high) = (places.iter().copied().fold(mean, f64::min), places.iter().copied().fold(mean, f64::max));
        Some(Crossing { at: f64::clamp(mean, low, high), out: (left > 0) == (self.way[self.axes[0]] > 0.0) })
    }
}

/// On which side of the way from one point to another the origin is: 1 left, −1 right. An origin on the way counts as one that is moved by
/// nearly nothing along the first axis, and by still less along the second; 0 where both points are the same.
fn side(one: [f64; 2], other: [f64; 2]) -> i8 {
    let sign = |value: f64| i8::from(value > 0.0) - i8::from(value < 0.0);
    match compare_products([one[0], other[1]], [one[1], other[0]]) {
        0 => match sign(one[1] - other[1]) {
            0 => sign(other[0] - one[0]),
            side => side,
        },
        side => side,
    }
}

/// The sign of a b − c d, without rounding.
fn compare_products([a, b]: [f64; 2], [c, d]: [f64; 2]) -> i8 {
    let sign = |value: f64| i8::from(value > 0.0) - i8::from(value < 0.0);
    let (first, second) = (a * b, c * d);
    match sign(first - second) {
        0 => sign(rest(a, b, first) - rest(c, d, second)),
        side => side,
    }
}

/// What rounding took from a product (Dekker, Numer. Math. 18, 1971, 224).
fn rest(a: f64, b: f64, product: f64) -> f64 {
    let halves = |value: f64| {
        let large = value * 134_217_729.0;
        let high = large - (large - value);
        [high, value - high]
    };
    let ([a, c], [b, d]) = (halves(a), halves(b));
    ((a * b - product) + a * d + c * b) + c * d
}
