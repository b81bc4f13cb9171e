//! Follows single contacts, one by one: only where a scene asks for what they leave behind.

use super::{Batches, Bodies, Buffer, Trace};
use crate::base::number::Vector;

impl<B: Bodies> Batches<'_, B> {
    /// Notes what the contacts of a batch do, when the law has acted on them.
    #[inline(never)]
    pub(super) fn trace(&self, buffer: &mut Buffer) {
        let weights = self.bodies.weights();
        for place in 0..buffer.ready {
            let (entry, first, second) = (buffer.entry[place], buffer.first[place], buffer.second[place]);
            // SAFETY: these are bodies of the list, and what was found of them is still there.
            let contact = unsafe {
                let found = buffer.found::<f64>(place, B::FOUND);
                self.bodies.meet::<f64, true>(&first, &second, found, B::roots(&found)).contact
            };
            let weight = weights.and_then(|weights| weights.get(entry as usize)).map_or(1.0, |[weight, ..]| *weight);
            let force = Vector::from(buffer.force[place]).dot(contact.normal).max(0.0) * weight;
            let speed = [-contact.normal_velocity, contact.slip.length()];
            let lost = if self.law.booked.follows && self.law.law.is_booked() { buffer.lost(place) } else { [0.0; 2] };
            let mass = contact.mass;
            buffer.losses.followed.touching.push(Trace { entry, first, second, force, mass, speed, lost });
        }
    }
}
