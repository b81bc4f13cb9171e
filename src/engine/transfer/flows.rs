//! What flows between bodies in a time step: by slots of particles, then by bodies.
//!
//! Contacts that are open let heat flow where their forces are evaluated (`engine/contacts`); what else conducts is told here.

use super::conduction::Conductances;
use crate::base::lanes::Shared;
use crate::base::number::{add, larger};
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::heat::{BoundaryHeat, difference, exchange};
use crate::engine::state::{GONE, Heat, IMAGE, Particles, Row, State};
use crate::laws::surface::NodeWeights;

/// What has the temperature of a particle.
pub(super) enum Body {
    /// A particle by its index: itself, or the first sphere of its clump.
    Particle(usize),
    /// The boundary to whose group it belongs.
    Boundary(usize),
}

/// What has the temperature of the particle in a slot.
#[inline(always)]
pub(super) fn body(state: &State, slot: usize) -> Body {
    let particles = &state.particles;
    if particles.owner[slot] == 0 {
        return Body::Particle(particles.id[slot] as usize);
    }
    let original = particles.original(slot as u32) as usize;
    match particles.group(original) {
        None => Body::Particle(particles.id[original] as usize),
        Some(group) => match group.checked_sub(state.boundaries.len()) {
            None => Body::Boundary(group),
            Some(clump) => Body::Particle(state.clumps.spheres_of(clump)[0] as usize),
        },
    }
}

/// Begins a time step with the present temperatures; nothing flows yet.
pub(super) fn begin(state: &State, heat: &mut Heat, warms: bool, context: &Context) {
    let count = state.particles.len();
    heat.forget_step();
    if warms {
        heat.of_losses.resize(count, 0.0);
    }
    let mut slots = std::mem::take(&mut heat.slots);
    slots.resize(count, [0.0; 4]);
    let (places, heat_so_far) = (Shared::new(&mut slots), &*heat);
    context.each(count.div_ceil(CHUNK), |piece| {
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            let [t, rise] = match body(state, slot) {
                Body::Particle(index) => [heat_so_far.initial[index], heat_so_far.rise(index)],
                Body::Boundary(boundary) => heat_so_far.boundaries[boundary].level(),
            };
            // SAFETY: pieces do not overlap.
            unsafe { *places.at(slot) = [t, rise, 0.0, 0.0] };
        }
    });
    heat.slots = slots;
}

impl Conductances for Heat {
    fn between(&mut self, first: u32, second: u32, conductance: f64) {
        if let Ok([first, second]) = self.slots.get_disjoint_mut([first as usize, second as usize]) {
            exchange([first, second], conductance);
        }
    }

    // What is told here are bonds, and contacts that they suppress: none is with a mesh.
    fn at_boundary(&mut self, slot: u32, boundary: u32, _nodes: &[NodeWeights], conductance: f64) {
        let boundary = &mut self.boundaries[boundary as usize];
        let mut surface = [boundary.initial, boundary.rise, 0.0, 0.0];
        exchange([&mut self.slots[slot as usize], &mut surface], conductance);
        boundary.takes([surface[2], surface[3]]);
    }
}

/// How far the temperature of a particle (slot) is below another \[K\].
pub(super) fn below(heat: &Heat, slot: u32, temperature: f64) -> f64 {
    let [t, rise, ..] = heat.slots[slot as usize];
    difference([temperature, 0.0], [t, rise])
}

/// Adds what losses gave in a time step of this length \[s\].
pub(super) fn take_losses(heat: &mut Heat, step: f64) {
    let (mut sum, mut given) = (0.0, 0.0);
    for (row, of_losses) in heat.slots.iter_mut().zip(&heat.of_losses) {
        row[2] += of_losses / step;
        sum += of_losses;
    }
    heat.boundaries.iter().for_each(|boundary| given += boundary.of_losses);
    heat.surfaces_mut().for_each(|it| it.into[0] += it.of_losses / step);
    heat.by_losses += sum + given;
}

/// Gives heat of a loss \[J\] to what has the temperature of the particle in a slot, between time steps.
pub(crate) fn warm_at_once(state: &mut State, slot: u32, energy: f64) {
    let body = body(state, slot as usize);
    let Some(heat) = &mut state.heat else { return };
    heat.by_losses += energy;
    match body {
        Body::Particle(index) => heat.gained[index] += energy,
        Body::Boundary(boundary) => heat.boundaries[boundary].present += energy,
    }
}

/// Adds what flows into images to their particles, then what flows into spheres of clumps and particles of groups to what has their
/// temperature.
pub(super) fn gather(state: &State, heat: &mut Heat) {
    let particles = &state.particles;
    let slots = &mut heat.slots;
    for (&image, &original) in state.cell.iter().flat_map(|cell| cell.images.iter().zip(&cell.originals)) {
        let flow = taken(&mut slots[image as usize]);
        add(&mut slots[original as usize], &flow);
    }
    let is_owned = |slot: &usize| ![0, IMAGE].contains(&particles.owner[*slot]);
    for slot in (0..particles.len()).filter(is_owned) {
        match body(state, slot) {
            Body::Boundary(boundary) => {
                let [_, _, flow, sum] = taken(&mut slots[slot]);
                heat.boundaries[boundary].takes([flow, sum]);
            }
            Body::Particle(index) => {
                let first = particles.slot[index] as usize;
                if first != slot {
                    let flow = taken(&mut slots[slot]);
                    add(&mut slots[first], &flow);
                }
            }
        }
    }
}

/// Takes the flow and the conductance of a row away.
fn taken(row: &mut Row) -> Row {
    let [_, _, flow, sum] = *row;
    (row[2], row[3]) = (0.0, 0.0);
    [0.0, 0.0, flow, sum]
}

/// Gives a time step of heat to all bodies, and notes the largest sum of conductances over a heat capacity.
pub(super) fn integrate(particles: &Particles, heat: &mut Heat, step: f64, context: &Context) {
    let Heat { capacity, gained, flow, slots, .. } = heat;
    let (count, capacity) = (capacity.len(), &*capacity);
    let (gained, flow) = (Shared::new(gained), Shared::new(flow));
    let piece = |piece: usize| {
        let mut rate = 0.0_f64;
        for index in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            let slot = particles.slot[index];
            if slot == GONE || capacity[index] == 0.0 {
                continue;
            }
            let [_, _, into, sum] = slots[slot as usize];
            // SAFETY: pieces do not overlap.
            unsafe {
                *flow.at(index) = into;
                *gained.at(index) += step * into;
            }
            rate = larger(rate, sum / capacity[index]);
        }
        rate
    };
    let mut rate = context.fold(count.div_ceil(CHUNK), piece, 0.0, larger);
    for it in heat.surfaces_mut() {
        let BoundaryHeat { into: [into, sum], capacity, .. } = *it;
        it.flow = into;
        it.present += step * into;
        if capacity > 0.0 {
            rate = larger(rate, sum / capacity);
        }
    }
    heat.rate = rate;
}
