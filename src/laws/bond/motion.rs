//! Geometry and relative motion of two bonded bodies.

use super::{Coefficients, Pair, Section};
use crate::base::number::{Number, Vector};

impl<N: Number> Pair<N> {
    /// d at the last step \[m\].
    #[inline(always)]
    fn last(&self, law: &Coefficients<N>) -> Vector<N> {
        self.connection - self.velocity * law.step
    }
}

/// How the axis of a pair turned over the step that led to its positions, and the pair with it.
#[derive(Clone, Copy, Debug)]
pub struct Turn<N: Number = f64> {
    /// (e₀ + e)/(1 + e₀·e), with the axis e₀ of the last step and e of this one: along the mean axis, longer than 1 by the
    /// second order of the turn.
    pub bisector: Vector<N>,
    /// Cosine of the mean spin's turn about the axis.
    pub cosine: N,
    /// Its sine.
    pub sine: N,
}

impl<N: Number> Turn<N> {
    /// No turn.
    #[inline(always)]
    pub fn none() -> Self {
        Self { bisector: Vector::zero(), cosine: N::splat(1.0), sine: N::zero() }
    }

    /// The shortest turn from the axis of the last step to that of this one, of a vector across the former. Any vector
    /// loses what it has along the mean axis; what is across that comes to lie across the axis of this step, right to
    /// the second order.
    #[inline(always)]
    pub fn onwards(&self, vector: Vector<N>, axis: Vector<N>) -> Vector<N> {
        vector - self.bisector * vector.dot(axis)
    }

    /// What was kept across the axis of the last step, and an increment of mid-step: both turned with the bond. The
    /// increment turns about the axis by half, right to the second order.
    #[inline(always)]
    pub fn advance(&self, kept: Vector<N>, increment: Vector<N>, axis: Vector<N>) -> Vector<N> {
        let sum = self.onwards(kept + increment, axis);
        let about = sum - increment * N::splat(0.5);
        sum * self.cosine + (axis * self.sine).cross(about)
    }
}

/// Axis, distance and rates of a pair at the positions of the step.
#[derive(Clone, Copy, Debug)]
pub struct Motion<N: Number = f64> {
    /// e = d/r, from j to i.
    pub axis: Vector<N>,
    /// r \[m\].
    pub distance: N,
    /// 1/r \[1/m\].
    pub per_distance: N,
    /// v_n: velocity along the axis, negative while approaching \[m/s\].
    pub normal_velocity: N,
    /// v_s: shear velocity \[m/s\].
    pub slip: Vector<N>,
    /// w_n: relative angular velocity along the axis \[rad/s\].
    pub twist_rate: N,
    /// w_t: relative angular velocity across the axis \[rad/s\].
    pub bending_rate: Vector<N>,
    /// How the pair turned, where the rates are those about the mean axis of the step.
    pub turn: Turn<N>,
    /// The cross-section.
    pub section: Section<N>,
}

/// The rates of a bond at the middle of a time step, as it remembers them: v_s and v_n \[m/s\], w_t and w_n \[rad/s\].
pub type RateRows<N = f64> = [[N; 4]; 2];

/// About which axis a law takes its rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rates {
    /// It looks at none.
    Unseen,
    /// That of this step, half a step behind the velocities, as the engine does.
    AtEnd,
    /// The mean axis of the step, at whose middle the velocities are: a bond that turns as a whole has no rates.
    Midway,
}

/// The first of three parts in which a motion is found: what takes roots. Each part ends with what the processor takes long
/// for, so that it need not wait for it where there are many bonds.
#[derive(Clone, Copy, Debug)]
pub struct Lengths<N: Number = f64> {
    /// r \[m\].
    pub distance: N,
    /// r at the last step, for rates at [`Rates::Midway`] \[m\].
    pub last_distance: N,
}

impl<N: Number> Lengths<N> {
    /// Of this pair.
    #[inline(always)]
    pub fn of(rates: Rates, law: &Coefficients<N>, pair: &Pair<N>) -> Self {
        let distance = pair.connection.length();
        let last_distance = match rates {
            Rates::Midway => pair.last(law).length(),
            Rates::Unseen | Rates::AtEnd => distance,
        };
        Self { distance, last_distance }
    }
}

/// The second part: what takes a division.
#[derive(Clone, Copy, Debug)]
pub struct Opening<N: Number = f64> {
    /// d₀ r + d r₀: along e₀ + e \[m²\].
    pub sum: Vector<N>,
    /// r₀ r (1 + e₀·e) \[m²\].
    pub size: N,
    /// Tangent of half of the mean spin's turn about the axis: what stands above.
    pub above: N,
    /// What stands below.
    pub below: N,
    /// 1 over r, and where rates are those at [`Rates::Midway`] over `size` and `above`² + `below`², too.
    pub shared: N,
}

impl<N: Number> Opening<N> {
    /// Of this pair. tan x/x = (15 − x²)/(15 − 6 x²), x half of the turn's angle; off by x⁷/1575.
    #[inline(always)]
    pub fn of(rates: Rates, law: &Coefficients<N>, pair: &Pair<N>, lengths: &Lengths<N>) -> Self {
        let one = N::splat(1.0);
        let Lengths { distance, last_distance } = *lengths;
        if rates != Rates::Midway {
            let zero = N::zero();
            return Self { sum: Vector::zero(), size: zero, above: zero, below: zero, shared: one / distance };
        }
        let (connection, last) = (pair.connection, pair.last(law));
        let sum = last * distance + connection * last_distance;
        let size = distance * last_distance + connection.dot(last);
        let angle = (pair.spin_i + pair.spin_j).dot(sum) * (law.step * N::splat(0.25));
        let (square, whole) = (angle * angle, N::splat(15.0) * (size * size));
        let (above, below) = (angle * (whole - square), size * (whole - N::splat(6.0) * square));
        let shared = one / (distance * size * (above * above + below * below));
        Self { sum, size, above, below, shared }
    }
}

impl<N: Number> Motion<N> {
    /// Of this pair, in one go.
    #[inline(always)]
    pub fn of(rates: Rates, law: &Coefficients<N>, pair: &Pair<N>) -> Self {
        let lengths = Lengths::of(rates, law, pair);
        Self::after(rates, law, pair, &lengths, &Opening::of(rates, law, pair, &lengths))
    }

    /// The third part. With rates at [`Rates::Midway`], slip and bending rate are those of both ends as they are, along the
    /// axis included, until [`Motion::settled`].
    #[inline(always)]
    pub fn after(
        rates: Rates,
        law: &Coefficients<N>,
        pair: &Pair<N>,
        lengths: &Lengths<N>,
        opening: &Opening<N>,
    ) -> Self {
        match rates {
            Rates::Unseen => Self::at_rest(law, pair, lengths.distance, opening.shared),
            Rates::AtEnd => Self::at_end(law, pair, lengths.distance, opening.shared),
            Rates::Midway => Self::midway(law, pair, lengths.distance, opening),
        }
    }

    /// Without rates.
    #[inline(always)]
    fn at_rest(law: &Coefficients<N>, pair: &Pair<N>, distance: N, per_distance: N) -> Self {
        let axis = pair.connection * per_distance;
        Self { per_distance, ..Self::still(axis, distance, law.section(pair.least_radius)) }
    }

    /// No motion along this axis and at this distance; the distance's inverse is not found.
    #[inline(always)]
    pub fn still(axis: Vector<N>, distance: N, section: Section<N>) -> Self {
        Self {
            axis,
            distance,
            per_distance: N::zero(),
            normal_velocity: N::zero(),
            slip: Vector::zero(),
            twist_rate: N::zero(),
            bending_rate: Vector::zero(),
            turn: Turn::none(),
            section,
        }
    }

    /// Rates about the axis of this step.
    #[inline(always)]
    fn at_end(law: &Coefficients<N>, pair: &Pair<N>, distance: N, per_distance: N) -> Self {
        let standing = Self::at_rest(law, pair, distance, per_distance);
        let axis = standing.axis;
        let normal_velocity = pair.velocity.dot(axis);
        let turning = pair.spin_i * pair.slip_share_i + pair.spin_j * pair.share_j;
        let relative_spin = pair.spin_i - pair.spin_j;
        let twist_rate = relative_spin.dot(axis);
        Self {
            normal_velocity,
            slip: pair.velocity - axis * normal_velocity + pair.connection.cross(turning),
            twist_rate,
            bending_rate: relative_spin - axis * twist_rate,
            ..standing
        }
    }

    /// Rates about the mean axis of the step.
    #[inline(always)]
    fn midway(law: &Coefficients<N>, pair: &Pair<N>, distance: N, opening: &Opening<N>) -> Self {
        let Opening { sum, size, above, below, shared } = *opening;
        let above_square = above * above;
        let squares = above_square + below * below;
        let per_product = squares * shared;
        let per_squares = N::splat(2.0) * (distance * size) * shared;
        let turn = Turn {
            bisector: sum * (distance * per_product),
            // 1 where nothing turns, to the last bit.
            cosine: N::splat(1.0) - above_square * per_squares,
            sine: above * below * per_squares,
        };
        let middle = pair.connection - pair.velocity * (law.step * N::splat(0.5));
        let relative_spin = pair.spin_i - pair.spin_j;
        Self {
            normal_velocity: pair.velocity.dot(turn.bisector),
            slip: pair.velocity + middle.cross(pair.spin_j + relative_spin * pair.share_i),
            twist_rate: relative_spin.dot(turn.bisector),
            bending_rate: relative_spin,
            turn,
            ..Self::at_rest(law, pair, distance, size * per_product)
        }
    }

    /// The same with slip and bending rate across the axis of this step.
    #[inline(always)]
    pub fn settled(&self) -> Self {
        Self {
            slip: self.turn.onwards(self.slip, self.axis),
            bending_rate: self.turn.onwards(self.bending_rate, self.axis),
            ..*self
        }
    }

    /// The rates of a settled motion, to be remembered.
    #[inline(always)]
    pub fn rates(&self) -> RateRows<N> {
        [self.slip.row_with(self.normal_velocity), self.bending_rate.row_with(self.twist_rate)]
    }

    /// A settled motion with the rates at the end of the step: those at its middle and half of what they gained since the
    /// middle of the step before, which turned with the axis. They do not turn about it: half of that turn for this step's and
    /// one and a half for those before would cancel, to the second order.
    #[inline(always)]
    pub fn foreseen(&self, [across, about]: RateRows<N>) -> Self {
        let (half, axis) = (N::splat(0.5), self.axis);
        let slip = self.turn.onwards(Vector::of_row(across), axis);
        let bending_rate = self.turn.onwards(Vector::of_row(about), axis);
        Self {
            normal_velocity: self.normal_velocity + (self.normal_velocity - across[3]) * half,
            slip: self.slip + (self.slip - slip) * half,
            twist_rate: self.twist_rate + (self.twist_rate - about[3]) * half,
            bending_rate: self.bending_rate + (self.bending_rate - bending_rate) * half,
            ..*self
        }
    }
}
