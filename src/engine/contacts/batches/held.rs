//! What contacts hold of losses that warm the bodies: only where a model is a spring or plastic, and a scene asks for its heat.

use super::{Batches, Bodies, Buffer};

impl<B: Bodies> Batches<'_, B> {
    /// Takes from the heat of a batch what its contacts hold now and did not hold before: the book of losses has the work.
    #[inline(never)]
    pub(super) fn hold(&self, buffer: &mut Buffer) {
        let law = &self.law.law;
        let Some(row_of_held) = law.history_places().held else { return };
        let (weights, table) = (self.bodies.weights(), self.table.rows());
        for place in 0..buffer.ready {
            let (entry, first, second) = (buffer.entry[place] as usize, buffer.first[place], buffer.second[place]);
            // SAFETY: these are bodies of the list, and what was found of them is still there; the entry belongs to this piece.
            let (mut contact, kept) = unsafe {
                let found = buffer.found::<f64>(place, B::FOUND);
                let contact = self.bodies.meet::<f64, true>(&first, &second, found, B::roots(&found)).contact;
                (contact, self.entries.history(entry))
            };
            if law.has_pair_constant() {
                // SAFETY: there is one for each entry.
                contact.pair_constant = unsafe { *self.entries.pair_constant.at(entry) };
            }
            let row = self.uniform.unwrap_or_else(|| {
                let row = buffer.row[place] as usize;
                &table.numbers[row * table.count..(row + 1) * table.count]
            });
            let [_, share, weight] = weights.and_then(|weights| weights.get(entry)).copied().unwrap_or([1.0; 3]);
            let [plastic, rolling] = law.held(row, &contact, kept);
            let held = [plastic * weight, rolling * share, 0.0, 0.0];
            let before = std::mem::replace(&mut kept[row_of_held], held);
            if self.step > 0.0 {
                buffer.heat_mut()[place] += (before[0] - held[0]) + (before[1] - held[1]);
            }
        }
    }

    /// What an entry held whose bodies have parted \[J\].
    ///
    /// # Safety
    /// The entry belongs to this piece of the list.
    pub(super) unsafe fn held(&self, entry: usize) -> f64 {
        // SAFETY: the caller's promise.
        self.law.law.history_places().held.map_or(0.0, |place| unsafe {
            let [along, about, ..] = self.entries.history(entry)[place];
            along + about
        })
    }
}
