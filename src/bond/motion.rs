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
    /// Attitude; anything where [`super::BondLaw::NEEDS_ATTITUDES`] is false.
    pub attitude: Quaternion<N>,
    /// Radius \[m\].
    pub radius: N,
    /// Mass, infinite for a wall; anything where [`super::BondLaw::NEEDS_MASSES`] is false \[kg\].
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
    /// Attitude of i.
    pub attitude_i: Quaternion<N>,
    /// Attitude of j.
    pub attitude_j: Quaternion<N>,
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

    /// The pair with these shares (`share_i`, `share_j`, `slip_share_i`).
    #[inline(always)]
    fn of(i: &Body<N>, j: &Body<N>, shares: [N; 3], least_radius: N) -> Self {
        Self {
            connection: i.position - j.position,
            velocity: i.velocity - j.velocity,
            spin_i: i.spin,
            spin_j: j.spin,
            attitude_i: i.attitude,
            attitude_j: j.attitude,
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

/// How the axis of a pair turned over the step that led to its positions.
#[derive(Clone, Copy, Debug)]
pub struct Turn<N: Number = f64> {
    /// e: axis of this step.
    pub axis: Vector<N>,
    /// r \[m\].
    pub distance: N,
    /// 1/r \[1/m\].
    pub per_distance: N,
    /// d of mid-step \[m\].
    pub middle: Vector<N>,
    /// (e₀ + e)/(1 + e₀·e), with the axis e₀ of the last step: along the mean axis, longer than 1 by the second order of
    /// the turn.
    pub bisector: Vector<N>,
    /// Tangent of half of the mean spin's turn about the mean axis over the step, as a fraction: above and below.
    half_twist: [N; 2],
    /// 2 over the sum of the squares of both.
    per_half_twist: N,
    /// That half itself \[rad\].
    half_angle: N,
}

impl<N: Number> Turn<N> {
    /// Of this pair. Two roots and one division, in homogeneous form: e₀ + e is (d₀ r + d r₀)/(r₀ r).
    #[inline(always)]
    pub fn of(law: &Coefficients<N>, pair: &Pair<N>) -> Self {
        let connection = pair.connection;
        let last = connection - pair.velocity * law.step;
        let (distance, last_distance) = (connection.length(), last.length());
        let sum = last * distance + connection * last_distance;
        // r₀ r (1 + e₀·e).
        let opening = distance * last_distance + connection.dot(last);
        // tan x/x = (15 − x²)/(15 − 6 x²), x = h/opening; off by x⁷/1575.
        let twist = (pair.spin_i + pair.spin_j).dot(sum) * (law.step * N::splat(0.25));
        let (square, opening_square) = (twist * twist, opening * opening);
        let whole = N::splat(15.0) * opening_square;
        let half_twist = [twist * (whole - square), opening * (whole - N::splat(6.0) * square)];
        let squares = half_twist[0] * half_twist[0] + half_twist[1] * half_twist[1];
        let product = distance * opening;
        let shared = N::splat(1.0) / (product * squares);
        let per_product = squares * shared;
        let per_opening = distance * per_product;
        let per_distance = opening * per_product;
        Self {
            axis: connection * per_distance,
            distance,
            per_distance,
            middle: (connection + last) * N::splat(0.5),
            bisector: sum * per_opening,
            half_twist,
            per_half_twist: N::splat(2.0) * product * shared,
            half_angle: twist * per_opening,
        }
    }

    /// The shortest turn from the axis of the last step to that of this one, of a vector across the former. Any vector
    /// loses what it has along the mean axis; what is across that comes to lie across the axis of this step, right to
    /// the second order.
    #[inline(always)]
    pub fn onwards(&self, vector: Vector<N>) -> Vector<N> {
        vector - self.bisector * vector.dot(self.axis)
    }

    /// About the axis of this step by the mean spin's turn, of a vector across it.
    #[inline(always)]
    pub fn about(&self, vector: Vector<N>) -> Vector<N> {
        let [above, below] = self.half_twist;
        let lost = above * above * self.per_half_twist;
        let sine = above * below * self.per_half_twist;
        vector * (N::splat(1.0) - lost) + (self.axis * sine).cross(vector)
    }

    /// About the mean axis back by half of that, to the first order: for increments of mid-step, which turn on by the
    /// other half alone.
    #[inline(always)]
    pub fn half_back(&self, vector: Vector<N>) -> Vector<N> {
        vector - (self.bisector * self.half_angle).cross(vector)
    }

    /// Relative velocity of the two ends of a bond at mid-step, the normal part included \[m/s\].
    #[inline(always)]
    pub fn slip(&self, pair: &Pair<N>) -> Vector<N> {
        pair.velocity + self.middle.cross(pair.spin_i * pair.share_i + pair.spin_j * pair.share_j)
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
    /// The cross-section.
    pub section: Section<N>,
}

impl<N: Number> Motion<N> {
    /// Of this pair, the spin of i entering the shear velocity with this share of the distance.
    #[inline(always)]
    pub fn with_arm(law: &Coefficients<N>, pair: &Pair<N>, slip_share_i: N) -> Self {
        let distance = pair.connection.length();
        let per_distance = N::splat(1.0) / distance;
        let axis = pair.connection * per_distance;
        let normal_velocity = pair.velocity.dot(axis);
        let turning = pair.spin_i * slip_share_i + pair.spin_j * pair.share_j;
        let slip = pair.velocity - axis * normal_velocity + pair.connection.cross(turning);
        let relative_spin = pair.spin_i - pair.spin_j;
        let twist_rate = relative_spin.dot(axis);
        Self {
            axis,
            distance,
            per_distance,
            normal_velocity,
            slip,
            twist_rate,
            bending_rate: relative_spin - axis * twist_rate,
            section: Section::of(law.radius_multiplier, pair.least_radius),
        }
    }
    /// Of this pair, with rates about the mean axis of the step, at whose middle the velocities are; slip and bending lie
    /// across the axis of this step. A bond that turns as a whole has no rates.
    #[inline(always)]
    pub fn midway(law: &Coefficients<N>, pair: &Pair<N>) -> Self {
        let turn = Turn::of(law, pair);
        let relative_spin = pair.spin_i - pair.spin_j;
        Self {
            axis: turn.axis,
            distance: turn.distance,
            per_distance: turn.per_distance,
            normal_velocity: pair.velocity.dot(turn.bisector),
            slip: turn.onwards(turn.slip(pair)),
            twist_rate: relative_spin.dot(turn.bisector),
            bending_rate: turn.onwards(relative_spin),
            section: Section::of(law.radius_multiplier, pair.least_radius),
        }
    }
}
