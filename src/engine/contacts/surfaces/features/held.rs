//! What contacts hold of losses that warm the bodies, where a particle goes from feature to feature.

use super::FeatureContacts;
use crate::engine::contacts::surfaces::history::PreviousContacts;
use crate::engine::contacts::surfaces::sphere::{Load, ParticleLoads};

/// Hands on what contacts held that are no more, in this row of what is remembered: to a new contact of their particle, or to its
/// first; where it has none it is heat of the particle. All others have what they had.
#[inline(never)]
pub(super) fn hand_on(row: usize, past: &PreviousContacts, contacts: &mut FeatureContacts, particles: &ParticleLoads) {
    let mut entries = 0..0;
    while let Some(&slot) = past.particle.get(entries.end) {
        entries = past.of(slot, entries.end);
        let from = contacts.particle.partition_point(|&other| other < slot);
        let present = from..contacts.particle.partition_point(|&other| other <= slot);
        let features = &contacts.feature[present.clone()];
        let ended = entries.clone().filter(|&entry| !features.contains(&past.feature[entry]));
        let ended = ended.map(|entry| past.row(entry, row)).fold([0.0; 2], |[a, b], [c, d, ..]| [a + c, b + d]);
        let mut heir = None;
        for contact in present.clone().rev() {
            if past.entry(&entries, contacts.feature[contact]).is_none() {
                contacts.history.get_mut(contact)[row] = [0.0; 4];
                heir = Some(contact);
            }
        }
        match heir.or(present.clone().next()) {
            Some(contact) => {
                let [along, about, ..] = &mut contacts.history.get_mut(contact)[row];
                (*along, *about) = (*along + ended[0], *about + ended[1]);
            }
            // SAFETY: each particle is in one piece, and each piece is worked on by one thread.
            None => unsafe { particles.warm(slot, ended[0] + ended[1], 0.0, &mut Load::default()) },
        }
    }
}
