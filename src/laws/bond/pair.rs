//! Two bonded bodies and the cross-section between them.

use super::Quaternion;
use crate::base::number::{Number, Vector};

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
