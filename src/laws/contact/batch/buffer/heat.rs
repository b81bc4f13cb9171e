//! Contacts as heat sees them.

use super::{Buffer, at};
use crate::base::lanes::Lane;
use crate::laws::contact::heat::Spot;

impl Buffer {
    /// A register's worth of contacts as heat sees them, with the radii of both bodies where they are asked for.
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn spot<N: Lane>(&self, place: usize, with_radii: bool) -> Spot<N> {
        // SAFETY: the caller's promise.
        unsafe {
            let [overlap, radius] = self.depths(place);
            let at_wall = Spot::at_wall(radius, overlap, self.load(at::CONDUCTANCE, place));
            if !with_radii {
                return at_wall;
            }
            let half = N::splat(0.5) * overlap;
            let arms: [N; 2] = [self.load(at::FIRST_ARM, place), self.load(at::SECOND_ARM, place)];
            let spheres = Spot::of_spheres(arms.map(|arm| arm + half), overlap, at_wall.contact_radius);
            // A wall has no arm.
            let are_spheres = || arms[1].greater(N::zero());
            Spot {
                radii: [
                    N::select(are_spheres(), spheres.radii[0], at_wall.radii[0]),
                    N::select(are_spheres(), spheres.radii[1], at_wall.radii[1]),
                ],
                share: N::select(are_spheres(), spheres.share, at_wall.share),
                per_reach: N::select(are_spheres(), spheres.per_reach, at_wall.per_reach),
                ..at_wall
            }
        }
    }

    /// Stores the radii of the circles of contact of a register's worth of contacts \[m\], or their conductances \[W/K\].
    ///
    /// # Safety
    /// As for [`Buffer::store`].
    #[inline(always)]
    pub(crate) unsafe fn put_conductance<N: Lane>(&mut self, place: usize, conductance: N) {
        // SAFETY: the caller's promise.
        unsafe { self.store(at::CONDUCTANCE, place, conductance) };
    }

    /// The conductances of the contacts, contact by contact \[W/K\].
    pub(crate) fn conductance(&self) -> &[f64] {
        &self.columns[at::CONDUCTANCE][..self.ready]
    }
}
