//! Geometry and relative motion of two bonded bodies.

use super::{Coefficients, Quaternion};
use crate::number::{Number, Vector};

/// One of two bonded bodies, or a point of a wall.
#[derive(Clone, Copy, Debug)]
pub struct Body<N: Number = f64> {
    /// Position of the centre \[m\].
    pub position: Vector<N>,
    /// Velocity, half a time step earlier \[m/s\].
    pub velocity: Vector<N>,
    /// Angular velocity, half a time step earlier \[rad/s\].
    pub spin: Vector<N>,
    /// Orientation; anything where [`super::Formulation::NEEDS_ORIENTATIONS`] is false.
    pub orientation: Quaternion<N>,
    /// Radius \[m\].
    pub radius: N,
    /// Mass, infinite for a wall; anything where [`super::damping::Damping::NEEDS_MASSES`] is false \[kg\].
    pub mass: N,
    /// Moment of inertia, infinite for a wall \[kg m²\].
    pub inertia: N,
}

/// Two bonded bodies.
#[derive(Clone, Copy, Debug)]
pub struct Pair<N: Number = f64> {
    /// d = x_i − x_j \[m\].
    pub connection: Vector<N>,
    /// v_i − v_j \[m/s\].
    pub velocity: Vector<N>,
    /// w_i \[rad/s\].
    pub spin_i: Vector<N>,
    /// w_j \[rad/s\].
    pub spin_j: Vector<N>,
    /// Orientation of i.
    pub orientation_i: Quaternion<N>,
    /// Orientation of j.
    pub orientation_j: Quaternion<N>,
    /// Share of the distance that is the torque arm of i: R_i/(R_i + R_j), at a wall 1.
    pub share_i: N,
    /// The rest of it: R_j/(R_i + R_j), at a wall 0.
    pub share_j: N,
    /// Share with which the spin of i enters the shear velocity in `engine_exact`: as `share_i`, at a wall ½.
    pub slip_share_i: N,
    /// R_min: the smaller radius, at a wall that of i \[m\].
    pub least_radius: N,
    /// Mass of i \[kg\].
    pub mass_i: N,
    /// Mass of j \[kg\].
    pub mass_j: N,
    /// Moment of inertia of i \[kg m²\].
    pub inertia_i: N,
    /// Moment of inertia of j \[kg m²\].
    pub inertia_j: N,
}

impl<N: Number> Pair<N> {
    /// Two spheres.
    #[inline(always)]
    pub fn of_spheres(i: &Body<N>, j: &Body<N>) -> Self {
        let per_radius = N::splat(1.0) / (i.radius + j.radius);
        let share_i = i.radius * per_radius;
        Self::of(i, j, [share_i, j.radius * per_radius, share_i], i.radius.min(j.radius))
    }

    /// A sphere and the point of a wall where its bond stands; that point moves and turns with the wall.
    #[inline(always)]
    pub fn at_wall(i: &Body<N>, foot: &Body<N>) -> Self {
        Self::of(i, foot, [N::splat(1.0), N::zero(), N::splat(0.5)], i.radius)
    }

    /// d at the last step \[m\].
    #[inline(always)]
    fn last(&self, law: &Coefficients<N>) -> Vector<N> {
        self.connection - self.velocity * law.step
    }

    /// The pair with these shares (`share_i`, `share_j`, `slip_share_i`).
    #[inline(always)]
    fn of(i: &Body<N>, j: &Body<N>, shares: [N; 3], least_radius: N) -> Self {
        Self {
            connection: i.position - j.position,
            velocity: i.velocity - j.velocity,
            spin_i: i.spin,
            spin_j: j.spin,
            orientation_i: i.orientation,
            orientation_j: j.orientation,
            share_i: shares[0],
            share_j: shares[1],
            slip_share_i: shares[2],
            least_radius,
            mass_i: i.mass,
            mass_j: j.mass,
            inertia_i: i.inertia,
            inertia_j: j.inertia,
        }
    }
}

/// The cross-section of a bond: a full circle.
#[derive(Clone, Copy, Debug)]
pub struct Section<N: Number = f64> {
    /// r_b = λ R_min \[m\].
    pub radius: N,
    /// A = π r_b² \[m²\].
    pub area: N,
    /// J = π r_b⁴/2, polar second moment of area \[m⁴\].
    pub polar: N,
    /// I = π r_b⁴/4, axial second moment of area \[m⁴\].
    pub axial: N,
}

impl<N: Number> Section<N> {
    /// Of a bond between bodies whose smaller radius is this.
    #[inline(always)]
    pub fn of(radius_multiplier: N, least_radius: N) -> Self {
        let radius = radius_multiplier * least_radius;
        let square = radius * radius;
        let area = N::splat(std::f64::consts::PI) * square;
        let polar = N::splat(0.5) * area * square;
        Self { radius, area, polar, axial: N::splat(0.5) * polar }
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
}
