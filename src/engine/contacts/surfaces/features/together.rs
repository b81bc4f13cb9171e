//! Particles that are looked at together: each over a plane of parts.

use crate::base::geometry::Frame;
use crate::base::number::Vector;
use crate::engine::contacts::surfaces::history::PreviousContacts;
use crate::engine::contacts::surfaces::sphere::ParticleLoads;
use crate::laws::surface::{NO_PLANE, OnPlanes, TOGETHER};

/// Room for particles that are looked at together.
#[derive(Debug)]
pub(super) struct Together {
    /// The particles over their planes.
    pub(super) spheres: OnPlanes,
    /// The particle of each contact that was found (slot).
    pub(super) slot: [u32; TOGETHER],
}

impl Default for Together {
    fn default() -> Self {
        Self { spheres: OnPlanes::none(), slot: [0; TOGETHER] }
    }
}

impl Together {
    /// Takes the particles at some places of a list, whose last contacts begin at an entry. Returns at which those of the next
    /// particles begin.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        frame: &Frame,
        (slots, planes): (&[u32], &[u32]),
        particles: &ParticleLoads,
        (past, mut entry): (&PreviousContacts, usize),
    ) -> usize {
        let OnPlanes { sphere, feature, .. } = &mut self.spheres;
        for ((&slot, &plane), (sphere, feature)) in slots.iter().zip(planes).zip(sphere.iter_mut().zip(feature)) {
            let mut last = u32::MAX;
            while let Some(&other) = past.particle.get(entry) {
                last = other;
                if other >= slot {
                    break;
                }
                entry += 1;
            }
            let position = particles.position[slot as usize];
            *sphere = frame.inside(Vector::from(position)).row_with(position[3]);
            *feature = if last == slot && plane != NO_PLANE { past.feature[entry] } else { plane };
        }
        self.spheres.count = slots.len();
        entry
    }

    /// Puts the contact of a place behind those that were found, of which there are so many.
    #[inline(always)]
    pub(super) fn put(&mut self, frame: &Frame, place: usize, slot: u32, count: usize) {
        let Self { spheres, slot: slots } = self;
        let foot = spheres.foot[place];
        spheres.foot[count] = frame.outside(Vector::from(foot)).row_with(foot[3]);
        spheres.feature[count] = spheres.feature[place];
        slots[count] = slot;
    }
}
