//! Particles that came or went in the other scene.

use super::{Description, Numbers};
use crate::engine::flow;
use crate::engine::state::exchange::InsertionProgress;
use crate::engine::state::{InsertedParticle, State};
use crate::scene::{ParticleShape, Scene};

/// Adds the particles that came in the other scene and that an insertion of this one could let come, behind the scene's own, and
/// lets insertions of the same name and amount go on where they were. Returns what stays behind, in words.
pub(super) fn put_newcomers(
    scene: &Scene,
    state: &mut State,
    reached: &State,
    (from, numbers): (&Description, &mut Numbers),
) -> Option<String> {
    let other = &reached.particles;
    let (last, own) = (scene.particles.last().map_or(0, |last| last.id.0), numbers.here.len());
    let mut behind = 0;
    for there in own as u32..other.slot.len() as u32 {
        let newcomer = other.slot_of(there).and_then(|slot| {
            let (position, velocity) = (other.position[slot], other.velocity[slot]);
            let material = from.material_here(scene, other.material[slot])?;
            let number = other.number_of_inserted(there)?;
            let fits = number > last && flow::is_made(scene, position[3], velocity[3], material);
            let inertia = ParticleShape::Sphere.inertia(velocity[3], position[3]);
            (fits && state.exchange.is_some()).then_some(InsertedParticle {
                position,
                velocity,
                inertia,
                material,
                number,
            })
        });
        numbers.here.push(newcomer.as_ref().map(|newcomer| {
            // No particle has an orientation yet.
            state.particles.add(newcomer, false);
            state.particles.slot.len() as u32 - 1
        }));
        behind += usize::from(newcomer.is_none() && other.slot_of(there).is_some());
    }
    if let (Some(here), Some(there)) = (&mut state.exchange, &reached.exchange) {
        here.next = here.next.max(there.next);
        for (feed, insertion) in here.feeds.iter_mut().zip(&scene.insertions) {
            if let Some(known) = from.insertion(insertion).and_then(|place| there.feeds.get(place)) {
                *feed = InsertionProgress { rate: feed.rate, rate_of_rate: 0.0, present: 0.0, ..*known };
            }
        }
    }
    (behind > 0).then(|| {
        format!(
            "{behind} particles that came by insertions of {} are such as no [insertion] here lets come, and stay behind",
            from.scene
        )
    })
}

/// Takes away the scene's own particles that went in the other scene. Where the number of particles stays, they begin again.
pub(super) fn take_gone(state: &mut State, reached: &State, numbers: &Numbers) {
    let mut goes = vec![false; state.particles.len()];
    let there = numbers.here.iter().enumerate();
    for here in
        there.filter(|(there, _)| reached.particles.slot_of(*there as u32).is_none()).filter_map(|(_, here)| *here)
    {
        if let Some(slot) = state.particles.slot_of(here) {
            goes[slot] = true;
        }
    }
    if state.exchange.is_some() && goes.contains(&true) {
        state.remove(&goes);
    }
}
