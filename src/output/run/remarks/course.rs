//! On how a simulation went.

use super::servos::missed;
use crate::engine::simulation::Simulation;
use crate::engine::state::{Separated, TouchedThrough};
use crate::output::run::summary::DeepestContact;
use crate::scene::Scene;
use crate::scene::exchange::Amount;

/// Overlap over radius above which contact laws are hardly valid.
const DEEP_OVERLAP: f64 = 0.05;

/// The remarks that follow from how a simulation went, not from its scene alone.
pub fn course(simulation: &Simulation) -> Vec<String> {
    let scene = simulation.scene();
    let mut remarks = Vec::new();
    remarks.extend(overlap(simulation));
    remarks.extend(through(simulation));
    remarks.extend(full(scene, simulation));
    remarks.extend(missed(scene, simulation));
    remarks
}

/// On overlaps that contact laws are not made for.
fn overlap(simulation: &Simulation) -> Option<String> {
    let overlap = simulation.state().deepest.overlap;
    let DeepestContact { time, between: [one, other] } =
        DeepestContact::of(simulation).filter(|_| overlap > DEEP_OVERLAP)?;
    Some(format!(
        "the largest overlap is {overlap:.3} of a radius, of {one} and {other} at t = {time:e} s; contact laws hold for small ones"
    ))
}

/// On particles that touch each other through a surface, or soon may.
fn through(simulation: &Simulation) -> Option<String> {
    let (scene, state) = (simulation.scene(), simulation.state());
    let name = |boundary: u32| &scene.boundaries[boundary as usize].name;
    let advice = "contacts of particles do not know surfaces: let what is on each side be of a material of its own, without a [contact] law for both";
    if let Some(TouchedThrough { particles, boundary, time }) = state.through.first {
        let [one, other] = particles.map(|named| named.number.unwrap_or_else(|| simulation.number(named.index)));
        return Some(format!(
            "[boundary.{}]: particles {one} and {other} touched each other through it at t = {time:e} s; {advice}",
            name(boundary)
        ));
    }
    let Separated { list, entry, boundary } = *state.through.pairs.first()?;
    let (list, entry) = (&state.contacts[list as usize], entry as usize);
    let number = |slot: u32| {
        let index = state.particles.id[slot as usize];
        state.particles.number_of_inserted(index).unwrap_or_else(|| simulation.number(index))
    };
    let [one, other] = [list.first[entry], list.second[entry]].map(number);
    Some(format!(
        "[boundary.{}]: particles {one} and {other} are near each other on both sides of it and may touch through it; {advice}",
        name(boundary)
    ))
}

/// On what insertions did not let come for want of room.
fn full(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let feeds = simulation.state().exchange.iter().flat_map(|exchange| &exchange.feeds);
    let told = scene.insertions.iter().zip(feeds).filter(|(_, feed)| feed.dropped > 0.0);
    told.map(|(insertion, feed)| {
        let what = match insertion.amount {
            Amount::CountRate(_) if insertion.has_clumps() => "clumps",
            Amount::CountRate(_) => "particles",
            Amount::MassRate(_) | Amount::Mass(_) => "kg",
        };
        format!(
            "[insertion.{}]: {:.4e} {what} found no room; a larger region, or one from which spheres move away faster, lets more come",
            insertion.name, feed.dropped
        )
    })
    .collect()
}
