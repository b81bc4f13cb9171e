//! What contacts are remembered to hold of losses that warm the bodies.

use crate::engine::state::{History, State};
use crate::laws::contact::LossKind;
use crate::scene::Scene;

/// What contacts of particles (slots) that go held in the last evaluation, by the causes of [`crate::engine::energy::losses::StoredEnergy`] and where it is remembered
/// \[J\]: since then nothing of it became heat.
pub(crate) fn remembered(scene: &Scene, state: &State, goes: &[bool]) -> [Option<f64>; 3] {
    let warms = |kind: LossKind| scene.heat.from_losses[kind as usize];
    if !scene.heat.warms() {
        return [None; 3];
    }
    let (mut rolling, mut plastic) = (0.0, 0.0);
    let mut add = |history: &History, entry: usize, row: usize| {
        let [along, about, ..] = history.get(entry)[row];
        (plastic, rolling) = (plastic + along, rolling + about);
    };
    let rows: Vec<_> = (0..scene.contacts.len()).map(|law| scene.law(law).history_places().held).collect();
    for (list, row) in state.contacts.iter().zip(&rows) {
        let both = list.first.iter().zip(&list.second);
        for (entry, _) in both.enumerate().filter(|(_, (i, j))| goes[**i as usize] || goes[**j as usize]) {
            row.iter().for_each(|&row| add(&list.history, entry, row));
        }
    }
    for list in &state.walls {
        for (entry, _) in list.particle.iter().enumerate().filter(|(_, slot)| goes[**slot as usize]) {
            rows[list.law as usize].iter().for_each(|&row| add(&list.history, entry, row));
        }
    }
    [warms(LossKind::Rolling).then_some(rolling), None, warms(LossKind::Other).then_some(plastic)]
}
