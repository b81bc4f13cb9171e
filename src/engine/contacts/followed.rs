//! Impacts of particles, followed from touch to parting.

use super::batches::{Entries, Followed};
use crate::base::lanes::Shared;
use crate::engine::state::{ContactList, ImpactRecord, Particles, State};
use crate::engine::traces::{Ended, Left, Share, TracedScene};
use crate::laws::contact::Law;
use crate::scene::Scene;
use std::sync::{Mutex, PoisonError};

/// Follows the contacts of a pass between particles.
pub(crate) struct FollowedPairs {
    /// What is told.
    scene: TracedScene,
    /// Room of each slab.
    room: Mutex<Vec<(Followed, Left)>>,
}

/// The room of the slabs while they are worked on.
pub(super) type SlabRoom = Shared<(Followed, Left)>;

/// The particles of pairs that are followed.
#[derive(Clone, Copy)]
pub(super) struct Bodies<'a> {
    /// Materials.
    pub(super) material: &'a [u32],
    /// 0, or the number of the body that carries the particle and 1.
    pub(super) owner: &'a [u32],
}

impl FollowedPairs {
    /// Of a scene; none where it follows no impacts.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        scene.output.impacts.map(|_| Self { scene: TracedScene::of(scene), room: Mutex::default() })
    }

    /// Works with the room of so many slabs, then books what they left behind, in order.
    pub(super) fn with(&self, state: &mut State, slabs: usize, work: impl FnOnce(&mut State, SlabRoom)) {
        let mut room = self.room.lock().unwrap_or_else(PoisonError::into_inner);
        room.resize_with(slabs, Default::default);
        work(state, Shared::new(&mut room));
        room.iter().for_each(|(_, left)| left.book(&self.scene, state));
    }

    /// What the contacts of a slab leave behind that were evaluated in a time step of this length \[s\].
    pub(super) fn follow(
        &self,
        (law, step): (&Law, f64),
        entries: &Entries,
        bodies: Bodies,
        room: &mut (Followed, Left),
    ) {
        let (followed, left) = room;
        left.clear();
        let Some(place) = law.history_places().impact else { return };
        for trace in &followed.touching {
            // SAFETY: the entry belongs to this slab.
            let rows = unsafe { entries.history(trace.entry as usize) };
            let mut record = ImpactRecord::of_rows([rows[place], rows[place + 1]]);
            record.go_on(step, trace.force, trace.speed, trace.lost);
            rows[place..place + 2].copy_from_slice(&record.to_rows());
            self.share(bodies, [trace.first, trace.second], trace.lost, left);
        }
        for parted in &followed.parted {
            let mut record = ImpactRecord::of_rows(parted.rows);
            if record.begun {
                (0..2).for_each(|part| record.lost[part] += parted.lost[part]);
                left.ended.push(self.ended(bodies.material, [parted.first, parted.second], record));
                self.share(bodies, [parted.first, parted.second], parted.lost, left);
            }
        }
    }

    /// An impact of two particles (slots) that ended.
    fn ended(&self, material: &[u32], [first, second]: [u32; 2], record: ImpactRecord) -> Ended {
        let [one, other] = [first, second].map(|slot| material[slot as usize]);
        Ended { first, second: Some(second), between: self.scene.between(one, other), record }
    }

    /// Gives what two particles (slots) lost to the groups to which they belong.
    fn share(&self, bodies: Bodies, slots: [u32; 2], lost: [f64; 2], left: &mut Left) {
        if !self.scene.groups {
            return;
        }
        for owner in slots.map(|slot| bodies.owner[slot as usize]) {
            if (1..=self.scene.boundaries).contains(&owner) {
                left.shares.push(Share { boundary: owner - 1, facet: 0, wear: 0.0, lost });
            }
        }
    }

    /// Ends the impacts of particles (slots) that go.
    pub(super) fn let_go(&self, (law, index): (&Law, usize), state: &mut State, goes: &[bool]) {
        let Some(place) = law.history_places().impact else { return };
        let (mut left, Particles { material, .. }) = (Left::default(), &state.particles);
        let ContactList { first, second, history, .. } = &state.contacts[index];
        for (entry, slots) in first.iter().zip(second).map(|(&i, &j)| [i, j]).enumerate() {
            if slots.iter().any(|&slot| goes[slot as usize]) {
                let rows = history.get(entry);
                let record = ImpactRecord::of_rows([rows[place], rows[place + 1]]);
                if record.begun {
                    left.ended.push(self.ended(material, slots, record));
                }
            }
        }
        left.book(&self.scene, state);
    }
}
