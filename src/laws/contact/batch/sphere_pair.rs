//! Two spheres and how they lie to each other: the geometry of their contact.

use super::{ContactGeometry, FOUND};
use crate::base::lanes::vector;
use crate::base::number::{Number, Vector};
use crate::laws::contact::Contact;

/// How two spheres i and j lie to each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpherePair<N = f64> {
    /// From the centre of j to that of i \[m\].
    apart: Vector<N>,
    /// Radius of i \[m\].
    radius_i: N,
    /// Radius of j \[m\].
    radius_j: N,
}

impl<N: Number> SpherePair<N> {
    /// Between these positions and radii.
    #[inline(always)]
    pub(crate) fn of([i, j]: [[N; 4]; 2]) -> Self {
        Self { apart: vector(i) - vector(j), radius_i: i[3], radius_j: j[3] }
    }

    /// Where the spheres overlap, or are no further apart than `beyond` \[m\].
    #[inline(always)]
    pub(crate) fn overlap(&self, beyond: Option<N>) -> N::Mask {
        let mut reach = self.radius_i + self.radius_j;
        if let Some(beyond) = beyond {
            reach = reach + beyond;
        }
        (reach * reach).greater(self.apart.dot(self.apart))
    }

    /// Area of the circle in which two spheres of these radii \[m\] intersect at this overlap \[m\], in m².
    #[inline(always)]
    pub(crate) fn section_area([radius_i, radius_j]: [N; 2], overlap: N) -> N {
        let (reach, difference) = (radius_i + radius_j, radius_i - radius_j);
        let distance = reach - overlap;
        let product = (distance + difference) * (distance - difference) * (distance + reach);
        N::splat(std::f64::consts::FRAC_PI_4) * overlap * product / (distance * distance)
    }

    /// The distance of the centres \[m\] and its inverse \[1/m\].
    #[inline(always)]
    pub(crate) fn roots(&self) -> [N; 2] {
        let distance = self.apart.length();
        [distance, N::splat(1.0) / distance]
    }

    /// Area of the circle in which the spheres intersect at this overlap \[m\], in m².
    #[inline(always)]
    pub(crate) fn section(&self, [distance, per_distance]: [N; 2], overlap: N) -> N {
        let (reach, difference) = (self.radius_i + self.radius_j, self.radius_i - self.radius_j);
        N::splat(std::f64::consts::FRAC_PI_4)
            * overlap
            * (distance + difference)
            * (distance - difference)
            * (distance + reach)
            * (per_distance * per_distance)
    }

    /// Geometry and relative motion of the overlapping spheres: velocities and masses, angular velocities.
    #[inline(always)]
    pub(crate) fn meet(&self, velocities: [[N; 4]; 2], spins: [[N; 4]; 2], pair_constant: N) -> ContactGeometry<N> {
        self.meet_at(self.roots(), velocities, spins, pair_constant)
    }

    /// The same when the distance and its inverse are known.
    #[inline(always)]
    pub(crate) fn meet_at(
        &self,
        [distance, per_distance]: [N; 2],
        [velocity_i, velocity_j]: [[N; 4]; 2],
        [spin_i, spin_j]: [[N; 4]; 2],
        pair_constant: N,
    ) -> ContactGeometry<N> {
        let Self { apart, radius_i, radius_j } = *self;
        let one = N::splat(1.0);
        let normal = apart * per_distance;
        let reach = radius_i + radius_j;
        let overlap = reach - distance;
        let (mass_i, mass_j) = (velocity_i[3], velocity_j[3]);
        let mass = mass_i + mass_j;
        // Effective radius and mass share their division, which is dear.
        let shared = one / (reach * mass);
        let half = overlap * N::splat(0.5);
        let (arm_i, arm_j) = (radius_i - half, radius_j - half);
        let relative = vector(velocity_i) - vector(velocity_j);
        let normal_velocity = relative.dot(normal);
        let turning = vector(spin_i) * arm_i + vector(spin_j) * arm_j;
        let slip = relative - normal * normal_velocity - turning.cross(normal);
        let (first_inertia, second_inertia) = (mass_i * radius_i * radius_i, mass_j * radius_j * radius_j);
        let radius = radius_i * radius_j * (mass * shared);
        let contact = Contact {
            overlap,
            radius,
            mass: mass_i * mass_j * (reach * shared),
            section_area: self.section([distance, per_distance], overlap),
            section_radius: radius + radius,
            normal,
            normal_velocity,
            slip,
            relative_spin: vector(spin_i) - vector(spin_j),
            spin_sum: vector(spin_i) + vector(spin_j),
            turning,
            per_distance,
            per_reach: mass * shared,
            rolling_inertia: first_inertia * second_inertia / (first_inertia + second_inertia),
            pair_constant,
        };
        ContactGeometry { contact, first_arm: arm_i, second_arm: arm_j }
    }

    /// As numbers.
    #[inline(always)]
    pub(crate) fn to_found(self) -> [N; FOUND] {
        [self.apart.x, self.apart.y, self.apart.z, self.radius_i, self.radius_j]
    }

    /// The inverse of `to_found`.
    #[inline(always)]
    pub(crate) fn from_found([x, y, z, radius_i, radius_j]: [N; FOUND]) -> Self {
        Self { apart: Vector::new(x, y, z), radius_i, radius_j }
    }
}
