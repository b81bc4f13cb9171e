//! Pairs of particles with slopes.

use super::followed::{Register, Sides};
use crate::batches::{Buffer, ContactGeometry, FOUND, SpherePair};
use crate::contact::{Needs, Reaction};
use crate::dual::Dual;
use crate::lanes::{Lane, Places, numbers_at};
use crate::number::Number;
use crate::tangent::{ListSlopes, Moving, Tangent};

/// Pairs of particles whose slopes are followed.
#[derive(Clone, Copy)]
pub(super) struct PairSlopes<'a> {
    /// Which list of the state is theirs.
    pub(super) index: usize,
    /// How the particles move.
    pub(super) moving: Moving<'a>,
    /// Their materials.
    pub(super) material: &'a [u32],
}

/// The distance of the centres of two spheres and its inverse with their slopes, where these values are known. No root and no quotient is
/// found for them: d|x| = x·dx/|x|.
#[inline(always)]
fn with_roots<N: Lane>([x, y, z, ..]: [Dual<N>; 5], [distance, per_distance]: [N; 2]) -> [Dual<N>; 2] {
    let product = x.value * x.slopes[0] + y.value * y.slopes[0] + z.value * z.slopes[0];
    let slope = product * per_distance;
    [Dual::new(distance, [slope]), Dual::new(per_distance, [-(per_distance * per_distance) * slope])]
}

impl Sides for PairSlopes<'_> {
    const AT_BOUNDARY: bool = false;

    #[inline(always)]
    fn list<'a>(&self, tangent: &'a mut Tangent) -> &'a mut ListSlopes {
        &mut tangent.contacts[self.index]
    }

    fn reaches(&self, tangent: &Tangent, buffer: &Buffer) -> bool {
        let Buffer { first, second, ready, .. } = buffer;
        [&first[..*ready], &second[..*ready]].iter().any(|slots| tangent.particles.reaches(slots))
    }

    #[inline(always)]
    fn reached(&self, tangent: &Tangent, [first, second]: &[Places; 2], count: usize) -> u32 {
        let particles = &tangent.particles;
        particles.reached(first.first(count)) | particles.reached(second.first(count))
    }

    #[inline(always)]
    fn roots<N: Lane>(&self, found: &[N; FOUND]) -> [N; 2] {
        SpherePair::from_found(*found).roots()
    }

    #[inline(always)]
    fn meet<N: Lane, const TURNING: bool>(
        &self,
        tangent: &Tangent,
        contacts: &Register<N>,
        needs: Needs,
    ) -> ContactGeometry<Dual<N>> {
        let (particles, moving) = (&tangent.particles, &self.moving);
        let Register { slots: [i, j], found, roots, constant, .. } = contacts;
        let pair = particles.pair(*found, i, j);
        let (spheres, roots) = (SpherePair::from_found(pair), with_roots(pair, *roots));
        let mut spins = [[Dual::zero(); 4]; 2];
        if TURNING {
            spins = [particles.spins(moving, i), particles.spins(moving, j)];
        }
        let velocities = particles.velocities::<N>(moving, i, j);
        let mut geometry = spheres.meet_at(roots, velocities, spins, Dual::constant(*constant));
        if needs.section {
            geometry.contact.section_area = spheres.section(roots, geometry.contact.overlap);
        }
        geometry
    }

    fn materials(&self, slots: &[Places; 2]) -> [[u32; 8]; 2] {
        slots.map(|slots| numbers_at(self.material, &slots))
    }

    #[inline(always)]
    fn load<N: Lane, const TURNING: bool>(
        &self,
        tangent: &mut Tangent,
        (contacts, reached): (&Register<N>, u32),
        geometry: &ContactGeometry<Dual<N>>,
        reaction: &Reaction<Dual<N>>,
    ) {
        let Register { slots: [i, j], count, .. } = contacts;
        let Reaction { force, couple, rolling, .. } = *reaction;
        tangent.particles.press_pairs([i, j], (*count, reached), force);
        if TURNING {
            let on_i = -(couple * geometry.first_arm) - rolling;
            tangent.particles.twist_pairs([i, j], *count, [on_i, rolling - couple * geometry.second_arm]);
        }
    }
}
