//! Heat that flows between the fluid and what stands in it.

use super::sums::Given;
use super::{Medium, Stream};
use crate::base::lanes::{self, Kernel, Lane, Shared, Width};
use crate::base::number::{Vector, add, larger};
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::heat::difference;
use crate::engine::state::{Row, State};
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
    /// Place \[m\], velocity \[m/s\] and diameter \[m\] of the sphere that a body is.
    #[inline(always)]
    fn sphere_of(&self, state: &State, body: usize) -> (Row, Row, f64) {
        let particles = &state.particles;
        match body.checked_sub(particles.len()) {
            None => (particles.position[body], particles.velocity[body], 2.0 * particles.position[body][3]),
            Some(clump) => {
                let clumps = &state.clumps;
                (clumps.position[clump], clumps.velocity[clump], self.diameter(clumps, clump))
            }
        }
    }
}

/// What is to be done.
struct Work<'a> {
    /// What never changes of the fluid.
    medium: &'a Medium,
    /// How it flows.
    stream: Stream<'a>,
    /// The bodies.
    state: &'a State,
    /// What is noted for the slots.
    slots: Shared<Row>,
    /// The time step \[s\].
    step: f64,
    /// Lane width.
    width: Width,
}

/// How many bodies are worked on at once.
const MOST: usize = 32;

/// Some bodies, numbers of one kind side by side.
struct Columns {
    /// How many.
    count: usize,
    /// Their slots.
    slots: [u32; MOST],
    /// The cells around each.
    weights: [Weights; MOST],
    /// Diameter \[m\].
    diameter: [f64; MOST],
    /// Porosity.
    porosity: [f64; MOST],
    /// Reynolds number, and then the Nusselt number.
    number: [f64; MOST],
    /// Temperature of the fluid \[K\].
    temperature: [f64; MOST],
}

impl Columns {
    /// Fills them with the first of these bodies that are in the fluid, as many as have room. Returns the first that is left.
    #[inline(always)]
    fn gather(&mut self, work: &Work, bodies: Range<usize>) -> usize {
        let (mut count, mut body) = (0, bodies.start);
        while body < bodies.end && count < MOST {
            let (now, slot) = (body, slot_of(work.state, body));
            body += 1;
            let Some(slot) = slot else { continue };
            let (place, velocity, diameter) = work.stream.sphere_of(work.state, now);
            let Some((here, weights)) = work.stream.at(place.into()) else { continue };
            let slip = here.velocity - Vector::from(velocity);
            (self.slots[count], self.weights[count]) = (slot as u32, weights);
            (self.diameter[count], self.porosity[count]) = (diameter, here.porosity);
            self.number[count] = work.medium.reynolds(diameter, here.porosity, slip);
            self.temperature[count] = work.stream.temperature(&weights);
            count += 1;
        }
        self.count = count;
        body
    }

    /// Lets heat flow into them. Returns the sum \[W\].
    #[inline(always)]
    fn flow(&mut self, work: &Work, given: &mut Given) -> f64 {
        let (count, mut sum) = (self.count.min(MOST), 0.0);
        work.medium.find_nusselt_numbers(&self.porosity[..count], &mut self.number[..count], work.width);
        for place in 0..count {
            let conductance = work.medium.conductance_of(self.diameter[place], self.number[place]);
            // SAFETY: each body has a slot of its own, and is worked on by one thread.
            let row = unsafe { work.slots.at(self.slots[place] as usize) };
            let flow = conductance * difference([self.temperature[place], 0.0], [row[0], row[1]]);
            (row[2], row[3]) = (row[2] + flow, row[3] + conductance);
            given.share(&self.weights[place], [[-flow * work.step, conductance * work.step, 0.0, 0.0]]);
            sum += flow;
        }
        sum
    }
}

/// A part of the work.
struct Part<'a, 'b, 'c> {
    /// What is to be done.
    work: &'a Work<'b>,
    /// On which bodies.
    bodies: Range<usize>,
    /// What cells are given.
    given: &'a mut Given<'c>,
    /// Heat flow into the bodies \[W\].
    flow: &'a mut f64,
}

impl Kernel for Part<'_, '_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { work, bodies, given, flow } = self;
        let numbers = [0.0; MOST];
        let (slots, weights) = ([0; MOST], [[(0, 0.0); 8]; MOST]);
        let mut columns = Columns {
            count: 0,
            slots,
            weights,
            diameter: numbers,
            porosity: numbers,
            number: numbers,
            temperature: numbers,
        };
        let mut next = bodies.start;
        while next < bodies.end {
            next = columns.gather(work, next..bodies.end);
            *flow += columns.flow(work, given);
        }
    }
}

/// Lets heat flow for a time step: into what is noted for the slots, and from the cells of the fluid.
pub(crate) fn convect(medium: &mut Medium, state: &mut State, context: &Context) {
    let (Some(mut heat), Some(mut fluid)) = (state.heat.take(), state.fluid.take()) else { return };
    // What is written is lent out meanwhile.
    let mut sums = std::mem::take(&mut medium.sums);
    let (mut cells, mut slots) = (std::mem::take(&mut fluid.heat), std::mem::take(&mut heat.slots));
    let (stream, slots_now) = (Stream::of(medium, &fluid), Shared::new(&mut slots));
    let work = Work { medium, stream, state: &*state, slots: slots_now, step: context.step, width: context.width };
    let count = state.particles.len() + state.clumps.len();
    let of_bodies = |bodies: Range<usize>, given: &mut Given| {
        let mut flow = 0.0;
        lanes::run(context.width, Part { work: &work, bodies, given, flow: &mut flow });
        flow
    };
    let flow = sums.over((count, cells.len()), context, of_bodies, (0.0, |sum, part| sum + part));
    cells.iter_mut().zip(sums.whole()).for_each(|(cell, row)| add(cell, row));
    heat.given += context.step * flow;
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
        let (place, velocity, diameter) = stream.sphere_of(state, body);
        let conductance = stream.at(place.into())?.0.conductance(diameter, Vector::from(velocity));
        (capacity > 0.0).then_some(conductance / capacity)
    };
    let of_piece = |piece: usize| {
        let bodies = piece * CHUNK..((piece + 1) * CHUNK).min(count);
        bodies.filter_map(of_body).fold(0.0, larger)
    };
    context.fold(count.div_ceil(CHUNK), of_piece, 0.0, larger)
}
