//! What is lost with a contact whose bodies have parted.

use super::{Batches, Bodies, FOUND, Parted};
use crate::engine::state::Row;
use crate::laws::contact::batch::Sums;
use crate::laws::contact::{Contact, parting};

/// Bodies that part: who is told of it.
pub(super) struct Parting<'a, 'b, B: Bodies> {
    /// The list.
    pub(super) work: &'a Batches<'b, B>,
    /// The book of what is lost with their contacts.
    pub(super) losses: &'a mut Sums,
    /// What is summed up.
    pub(super) sum: &'a mut B::Sum,
}

impl<B: Bodies> Parting<'_, '_, B> {
    /// Tells of an entry that touches no more: the last loads have acted for another half step, and what the tangential spring still
    /// held is gone. This stands apart, so that it takes no registers from the search for touching entries.
    ///
    /// # Safety
    /// The entry belongs to this piece of the list.
    #[cold]
    #[inline(never)]
    pub(super) unsafe fn tell(&mut self, entry: usize) {
        if self.work.law.law.is_booked() {
            // SAFETY: the caller's promise.
            let (contact, [spring, loads, other]) = unsafe { self.ended(entry) };
            let (booked, step) = (&self.work.law.booked, self.work.step);
            let (lost, held) = parting(booked, &contact, step, spring.into(), [loads, other]);
            if booked.warms() {
                let bodies = &self.work.bodies;
                // SAFETY: the caller's promise.
                let heat = 0.5 * booked.heat(&lost) + unsafe { self.work.held(entry) };
                bodies.warm(bodies.first()[entry], bodies.second()[entry], heat, self.sum);
            }
            if self.work.follows
                && let Some(place) = self.work.law.law.history_places().impact
            {
                let bodies = &self.work.bodies;
                let [along, across] = booked.by_direction(&lost).map(|energy| 0.5 * energy);
                // SAFETY: the caller's promise.
                let kept = unsafe { self.work.entries.history(entry) };
                self.losses.followed.parted.push(Parted {
                    first: bodies.first()[entry],
                    second: bodies.second()[entry],
                    rows: [kept[place], kept[place + 1]],
                    lost: [along, across + 0.5 * held],
                });
            }
            self.losses.add_parted((lost, held));
        }
    }

    /// The contact of an entry where its bodies are, and its rows: spring, and what the book remembers.
    ///
    /// # Safety
    /// As for [`Parting::tell`].
    unsafe fn ended(&self, entry: usize) -> (Contact, [Row; 3]) {
        let Batches { bodies, entries, law, .. } = self.work;
        let (first, second) = (&bodies.first()[entry], &bodies.second()[entry]);
        let places = law.law.history_places();
        let spring = places.tangential.filter(|_| law.booked.spring);
        // SAFETY: the caller's promise: these are slots of the list, and there is a row for each entry.
        unsafe {
            let (_, found): (u32, [f64; FOUND]) = bodies.touch(first, second, None, &mut B::Sum::default());
            let contact = bodies.meet::<f64, true>(first, second, found, B::roots(&found)).contact;
            let kept = entries.history(entry);
            let row = |place: Option<usize>| place.map_or([0.0; 4], |place| kept[place]);
            (contact, [row(spring), row(places.loads), row(places.other_loads)])
        }
    }
}
