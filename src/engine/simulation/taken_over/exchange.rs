//! Particles that came or went in the other scene.

use super::{Description, Numbers};
use crate::engine::bodies::clumps;
use crate::engine::columns;
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
    // Where the other scene has no such column, particles begin as those of the first insertion do.
    let declared = if scene.insertions.is_empty() { Vec::new() } else { columns::of_insertion(scene, 0) };
    let other = &reached.particles;
    let (last, own) = (scene.particles.last().map_or(0, |last| last.id.0), numbers.here.len());
    let mut here = vec![None; other.slot.len() - own];
    for there in own as u32..other.slot.len() as u32 {
        let loose = other.slot_of(there).filter(|&slot| reached.clump(slot).is_none());
        let newcomer = loose.and_then(|slot| {
            let came = newcomer(scene, reached, (from, &declared), (there, slot))?;
            let (radius, mass) = (came.position[3], came.velocity[3]);
            let fits = came.number > last && flow::is_made(scene, radius, mass, came.material);
            let inertia = ParticleShape::Sphere.inertia(mass, radius);
            (fits && state.exchange.is_some()).then_some(InsertedParticle { inertia, ..came })
        });
        // No particle has an orientation yet.
        here[there as usize - own] = newcomer.map(|newcomer| state.add_particle(&newcomer, 0, false));
    }
    put_clumps(scene, state, reached, (from, &declared), (own, &mut here));
    let there = |place: usize| other.slot_of((own + place) as u32).is_some();
    let behind = (0..here.len()).filter(|&place| here[place].is_none() && there(place)).count();
    numbers.here.extend(here);
    if let (Some(here), Some(there)) = (&mut state.exchange, &reached.exchange) {
        here.next = here.next.max(there.next);
        here.next_clump = here.next_clump.max(there.next_clump);
        for (feed, insertion) in here.feeds.iter_mut().zip(&scene.insertions) {
            if let Some(known) = from.insertion(insertion).and_then(|place| there.feeds.get(place)) {
                *feed = InsertionProgress { rate: feed.rate, rate_of_rate: 0.0, present: 0.0, ..*known };
                // What has been drawn but is not let come here is drawn anew.
                if (feed.kind as usize) >= insertion.kinds.len() {
                    (feed.kind, feed.radius) = (0, 0.0);
                }
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

/// A particle that came in the other scene, with its index and slot there, as one that comes here, if this scene has its material.
fn newcomer<'a>(
    scene: &Scene,
    reached: &State,
    (from, declared): (&Description, &'a [f64]),
    (there, slot): (u32, usize),
) -> Option<InsertedParticle<'a>> {
    let other = &reached.particles;
    Some(InsertedParticle {
        position: other.position[slot],
        velocity: other.velocity[slot],
        inertia: other.angular_velocity[slot][3],
        material: from.material_here(scene, other.material[slot])?,
        number: other.number_of_inserted(there)?,
        declared,
    })
}

/// Adds the clumps that came in the other scene, whose own particles are so many, and that an insertion of this one could let come. Notes
/// the indices of their spheres.
fn put_clumps(
    scene: &Scene,
    state: &mut State,
    reached: &State,
    (from, declared): (&Description, &[f64]),
    (own, here): (usize, &mut [Option<u32>]),
) {
    let (clumps, other) = (&reached.clumps, &reached.particles);
    for (clump, &number) in clumps.number.iter().enumerate() {
        let there = clumps.spheres_of(clump);
        let came = there.iter().all(|&sphere| sphere as usize >= own);
        let fits = came && number as usize >= scene.clumps.len() && state.exchange.is_some();
        if !fits || !clumps::is_made(scene, reached, clump, |material| from.material_here(scene, material)) {
            continue;
        }
        let sphere = |&there: &u32| newcomer(scene, reached, (from, declared), (there, other.slot_of(there)?));
        let Some(spheres) = there.iter().map(sphere).collect::<Option<Vec<_>>>() else { continue };
        state.add_clump(&clumps.rows(clump), number, &spheres, false);
        for (&there, &index) in there.iter().zip(state.clumps.spheres_of(state.clumps.len() - 1)) {
            here[there as usize - own] = Some(index);
        }
    }
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
