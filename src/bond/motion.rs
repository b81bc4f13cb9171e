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

/// Axis, distance and rates of a pair at the positions of the step.
#[derive(Clone, Copy, Debug)]
pub struct Motion<N: Number = f64> {
    /// e = d/r, from j to i.
    pub axis: Vector<N>,
    /// r \[m\].
    pub distance: N,
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
        let axis = pair.connection * (N::splat(1.0) / distance);
        let normal_velocity = pair.velocity.dot(axis);
        let turning = pair.spin_i * slip_share_i + pair.spin_j * pair.share_j;
        let slip = pair.velocity - axis * normal_velocity + pair.connection.cross(turning);
        let relative_spin = pair.spin_i - pair.spin_j;
        let twist_rate = relative_spin.dot(axis);
        Self {
            axis,
            distance,
            normal_velocity,
            slip,
            twist_rate,
            bending_rate: relative_spin - axis * twist_rate,
            section: Section::of(law.radius_multiplier, pair.least_radius),
        }
    }
}
