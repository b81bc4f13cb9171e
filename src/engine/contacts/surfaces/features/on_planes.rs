//! Contacts of particles over planes of parts, found many at a time.

use super::columns::FeatureContacts;
use super::standing::MovingSurface;
use crate::base::lanes::Width;
use crate::engine::contacts::surfaces::AtSurface;
use crate::engine::contacts::surfaces::history::PreviousContacts;
use crate::engine::contacts::surfaces::sphere::ParticleLoads;
use crate::engine::state::WallContacts;
use crate::laws::surface::{Feet, TOGETHER};
use std::ops::Range;

impl AtSurface {
    /// Finds the contacts of particles whose places in the list are these, at most [`TOGETHER`]: where a particle is over a plane
    /// of parts, from one of them. Takes and returns the entry at which the last contacts of the particles begin.
    pub(super) fn find_together(
        &self,
        at: &MovingSurface,
        (list, places): (&WallContacts, Range<usize>),
        (particles, width): (&ParticleLoads, Width),
        (past, entry): (&PreviousContacts, usize),
        (contacts, feet): (&mut FeatureContacts, &mut Feet),
    ) -> usize {
        let (slots, planes) = (&list.near.particle[places.clone()], &list.near.plane[places.clone()]);
        let mut together = contacts.together.take().unwrap_or_default();
        let entry = together.take(&at.frame, (slots, planes), particles, (past, entry));
        let spheres = &mut together.spheres;
        (spheres.touching, spheres.away) = (0, 0);
        at.features.on_planes(spheres, width);
        let (touching, mut open, mut count) = (spheres.touching, !spheres.away, 0);
        open &= u32::MAX >> (TOGETHER - slots.len());
        while open != 0 {
            let place = open.trailing_zeros() as usize;
            if touching >> place & 1 != 0 {
                together.put(&at.frame, place, slots[place], count);
                count += 1;
            } else {
                contacts.push_together(&together, count);
                count = 0;
                self.find_at(at, (list, places.start + place), particles, past, (contacts, feet));
            }
            open &= open - 1;
        }
        contacts.push_together(&together, count);
        contacts.together = Some(together);
        entry
    }
}
