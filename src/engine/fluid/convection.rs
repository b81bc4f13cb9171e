//! Heat that flows between the fluid and what stands in it.

use super::sums::Given;
use super::{Medium, Stream};
use crate::base::lanes::Shared;
use crate::base::number::{Vector, add, larger};
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::State;
use crate::engine::state::heat::difference;
use crate::laws::region::Weights;
use std::ops::Range;

/// The slot with the temperature of a body: its own, or that of the first sphere of a clump. Bodies are the particles but images and spheres
/// of clumps and, counted on behind these, clumps.
fn slot_of(state: &State, body: usize) -> Option<usize> {
    let (particles, boundaries) = (&state.particles, state.boundaries.len());
    match body.checked_sub(particles.len()) {
        None => (particles.owner[body] as usize <= boundaries).then_some(body),
        Some(clump) => {
            let first = *state.clumps.spheres_of(clump).first()?;
            Some(particles.slot[first as usize] as usize)
        }
    }
}

impl Stream<'_> {
    /// Conductance to a body \[W/K\], the temperature of the fluid there \[K\] and the cells that are around it.
    fn convects(&self, state: &State, body: usize) -> Option<(f64, f64, Weights)> {
        let particles = &state.particles;
        let (place, velocity, diameter) = match body.checked_sub(particles.len()) {
            None => (particles.position[body], particles.velocity[body], 2.0 * particles.position[body][3]),
            Some(clump) => {
                let clumps = &state.clumps;
                (clumps.position[clump], clumps.velocity[clump], self.diameter(clumps, clump))
            }
        };
        let (here, weights) = self.at(place.into())?;
        Some((here.conductance(diameter, Vector::from(velocity)), self.temperature(&weights), weights))
    }
}

/// Lets heat flow for a time step: into what is noted for the slots, and from the cells of the fluid.
pub(crate) fn convect(medium: &mut Medium, state: &mut State, context: &Context) {
    let (Some(mut heat), Some(mut fluid)) = (state.heat.take(), state.fluid.take()) else { return };
    // What is written is lent out meanwhile.
    let mut sums = std::mem::take(&mut medium.sums);
    let (mut cells, mut slots) = (std::mem::take(&mut fluid.heat), std::mem::take(&mut heat.slots));
    let (stream, rows, step) = (Stream::of(medium, &fluid), Shared::new(&mut slots), context.step);
    let count = state.particles.len() + state.clumps.len();
    let of_body = |body: usize, given: &mut Given| {
        let Some(slot) = slot_of(state, body) else { return 0.0 };
        let Some((conductance, temperature, weights)) = stream.convects(state, body) else { return 0.0 };
        // SAFETY: each body has a slot of its own, and is worked on by one thread.
        let row = unsafe { rows.at(slot) };
        let flow = conductance * difference([temperature, 0.0], [row[0], row[1]]);
        (row[2], row[3]) = (row[2] + flow, row[3] + conductance);
        let row = [-flow * step, conductance * step, 0.0, 0.0];
        given.share(&weights, [row]);
        flow
    };
    let of_bodies = |bodies: Range<usize>, given: &mut Given| bodies.fold(0.0, |sum, body| sum + of_body(body, given));
    let flow = sums.over((count, cells.len()), context, of_bodies, (0.0, |sum, part| sum + part));
    cells.iter_mut().zip(sums.whole()).for_each(|(cell, row)| add(cell, row));
    heat.given += step * flow;
    (medium.sums, fluid.heat, heat.slots) = (sums, cells, slots);
    (state.heat, state.fluid) = (Some(heat), Some(fluid));
}

/// Largest conductance to a body over its heat capacity at the present time \[1/s\].
pub(crate) fn rate(medium: &Medium, state: &State, context: &Context) -> f64 {
    let (Some(heat), Some(fluid), Some(_)) = (&state.heat, &state.fluid, &medium.heat) else { return 0.0 };
    let stream = Stream::of(medium, fluid);
    let count = state.particles.len() + state.clumps.len();
    let of_body = |body: usize| {
        let capacity = heat.capacity[state.particles.id[slot_of(state, body)?] as usize];
        let (conductance, ..) = stream.convects(state, body)?;
        (capacity > 0.0).then_some(conductance / capacity)
    };
    let of_piece = |piece: usize| {
        let bodies = piece * CHUNK..((piece + 1) * CHUNK).min(count);
        bodies.filter_map(of_body).fold(0.0, larger)
    };
    context.fold(count.div_ceil(CHUNK), of_piece, 0.0, larger)
}
