//! Heat of what bonds lose: half to each of their bodies, only where a scene asks for it.

use super::Done;
use crate::engine::state::heat::Heat;
use crate::engine::state::{BondList, State};
use crate::engine::transfer;
use crate::scene::{BondWarming, Scene};
use std::sync::{Mutex, PoisonError};

/// What of the losses of a bond law warms its bodies.
pub(super) struct BondHeat {
    /// Which losses.
    warms: BondWarming,
    /// The boundary of its bonds, where they are at one, and whether it takes heat.
    boundary: Option<(usize, bool)>,
    /// What each bond had lost before the present evaluation \[J\].
    before: Mutex<Vec<f64>>,
}

impl BondHeat {
    /// That of the bonds of a scene, between particles or at a boundary of this index.
    pub(super) fn of(scene: &Scene, boundary: Option<usize>) -> Self {
        let warms = scene.heat.from_bonds;
        let boundary = boundary.map(|boundary| (boundary, transfer::takes_heat(&scene.boundaries[boundary])));
        Self { warms, boundary, before: Mutex::default() }
    }

    /// Whether any loss warms.
    fn is_any(&self) -> bool {
        self.warms != BondWarming::default()
    }

    /// Begins an evaluation: from here on each bond counts what it loses in it.
    pub(super) fn begin(&self, list: &mut BondList) {
        if !self.is_any() {
            return;
        }
        let mut before = self.before.lock().unwrap_or_else(PoisonError::into_inner);
        before.clear();
        before.extend_from_slice(&list.lost);
        list.lost.fill(0.0);
    }

    /// Ends it before bonds that broke leave their list.
    pub(super) fn end<'a>(
        &self,
        list: &mut BondList,
        heat: Option<&mut Heat>,
        results: impl Iterator<Item = &'a Done>,
    ) {
        if !self.is_any() {
            return;
        }
        let before = self.before.lock().unwrap_or_else(PoisonError::into_inner);
        let heat = heat.filter(|heat| !heat.of_losses.is_empty());
        let warm = |list: &BondList, bond: usize, energy: f64, heat: &mut Heat| {
            let mut give = |slot: u32, energy: f64| heat.of_losses[slot as usize] += energy;
            match (list.second.get(bond), self.boundary) {
                (Some(&second), _) => [list.first[bond], second].into_iter().for_each(|slot| give(slot, 0.5 * energy)),
                (None, Some((boundary, true))) => {
                    give(list.first[bond], 0.5 * energy);
                    heat.boundaries[boundary].of_losses += 0.5 * energy;
                }
                (None, _) => give(list.first[bond], energy),
            }
        };
        if let Some(heat) = heat {
            if self.warms.damping {
                (0..list.lost.len()).for_each(|bond| warm(list, bond, list.lost[bond], heat));
            }
            if self.warms.release {
                let broken = results.flat_map(|done| &done.broken);
                broken.for_each(|broken| warm(list, broken.bond as usize, broken.energy, heat));
            }
        }
        list.lost.iter_mut().zip(&*before).for_each(|(lost, before)| *lost += before);
    }

    /// Warms what remains (slot) of bonds whose bodies go by what damping takes in this time \[s\], of their [`super::powers`].
    pub(super) fn let_go(&self, state: &mut State, gone: &[(u32, [f64; 2])], time: f64) {
        if self.warms.damping {
            gone.iter().for_each(|&(slot, [_, power])| transfer::warm_at_once(state, slot, time * power));
        }
    }
}
