//! The books of what a half kick exchanges between the fluid and the bodies in it.

use super::half_kick::{Exchanged, Gained, HalfKick};
use super::sums::Given;
use super::{Here, Medium, Stream};
use crate::base::number::{Vector, add};
use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::clumps;
use crate::engine::state::fluid::Booked;
use crate::engine::state::{FluidState, Loss, Row, State};
use crate::laws::region::Weights;
use std::ops::Range;

/// Which half kick of a time step is about to be made.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kick {
    /// That which begins it, with the loads of the step before.
    First,
    /// That which ends it.
    Second,
}

/// Books what the fluid does in the half kick that is about to be made. Of particles that is known where their loads told it: of the half kick
/// that ends a step and, if the next one is as long, of that which begins it.
pub(crate) fn book(medium: &mut Medium, state: &mut State, kick: Kick, context: &Context) {
    let Some(mut fluid) = state.fluid.take() else { return };
    let is_known = fluid.coming.step == context.step;
    if is_known && kick == Kick::First {
        fluid.exchanged.iter_mut().zip(&fluid.coming.rows).for_each(|(row, coming)| add(row, coming));
        let booked = fluid.coming.booked;
        enter(&mut fluid, state, booked);
    }
    let behind = (kick == Kick::First).then_some(0.5 * fluid.step);
    let half_kick = HalfKick { half: 0.5 * context.step, behind };
    for bodies in [Bodies::Particles, Bodies::Clumps] {
        let is_booked = is_known && bodies == Bodies::Particles;
        if !is_booked && bodies.count(state) > 0 {
            let sum = exchange(medium, &mut fluid, state, (&half_kick, bodies), context);
            let booked = sum.booked();
            enter(&mut fluid, state, Booked { on_free: booked.on_free + sum.others, ..booked });
        }
    }
    state.fluid = Some(fluid);
}

/// Enters what the fluid does in a half kick in the books.
pub(super) fn enter(fluid: &mut FluidState, state: &mut State, booked: Booked) {
    let Booked { work, taken, on_free, moved } = booked;
    fluid.work += work;
    fluid.impulse = (Vector::from(fluid.impulse) + moved.into()).to_array();
    if let Some(losses) = &mut state.losses {
        losses.add(Loss::Drag, taken);
    }
    if let Some(ledger) = &mut state.ledger {
        ledger.book_fluid(on_free);
    }
}

/// What bodies exchange with the fluid in a half kick: its cells have it then.
fn exchange(
    medium: &mut Medium,
    fluid: &mut FluidState,
    state: &State,
    (kick, bodies): (&HalfKick, Bodies),
    context: &Context,
) -> Exchanged {
    // What is written is lent out meanwhile.
    let mut sums = std::mem::take(&mut medium.sums);
    let (count, rows, stream) = (bodies.count(state), fluid.exchanged.len(), Stream::of(medium, fluid));
    let (volume, each) = (medium.grid.map_or(1.0, |grid| grid.cell_volume()), fluid.rows());
    let of_some = |some: Range<usize>, given: &mut Given| {
        some.filter_map(|body| bodies.exchanged(kick, &stream, state, body)).fold(
            Exchanged::default(),
            |sum, (weights, one)| {
                match (given.0.len(), each) {
                    (0, _) => {}
                    (_, 1) => given.share(&weights, [one.on_fluid(volume)[0]]),
                    _ => given.share(&weights, one.on_fluid(volume)),
                }
                sum.plus(one)
            },
        )
    };
    let join = (Exchanged::default(), Exchanged::plus as fn(_, _) -> _);
    let sum = if medium.grid.is_some() {
        let sum = sums.over((count, rows), context, of_some, join);
        fluid.exchanged.iter_mut().zip(sums.whole()).for_each(|(cell, row)| add(cell, row));
        sum
    } else {
        let of_piece = |piece: usize| of_some(piece * CHUNK..((piece + 1) * CHUNK).min(count), &mut Given(&mut []));
        let sum = context.fold(count.div_ceil(CHUNK), of_piece, join.0, join.1);
        add(&mut fluid.exchanged[0], &sum.on_fluid(volume)[0]);
        sum
    };
    medium.sums = sums;
    sum
}

/// What is in the fluid.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bodies {
    /// Particles but images and spheres of clumps.
    Particles,
    /// Clumps.
    Clumps,
}

impl Bodies {
    /// How many rows there are of them.
    fn count(self, state: &State) -> usize {
        match self {
            Self::Particles => state.particles.len(),
            Self::Clumps => state.clumps.len(),
        }
    }

    /// What one of them exchanges with the fluid, and where.
    #[inline(always)]
    fn exchanged(self, kick: &HalfKick, stream: &Stream, state: &State, body: usize) -> Option<(Weights, Exchanged)> {
        match self {
            Self::Particles => of_particle(kick, stream, state, body),
            Self::Clumps => of_clump(kick, stream, state, body),
        }
    }
}

/// That of a particle, if it is neither image nor of a clump.
#[inline(always)]
fn of_particle(kick: &HalfKick, stream: &Stream, state: &State, slot: usize) -> Option<(Weights, Exchanged)> {
    let particles = &state.particles;
    // Images and spheres of clumps are counted on behind the boundaries.
    if particles.owner[slot] as usize > state.boundaries.len() {
        return None;
    }
    let place = particles.position[slot];
    let (here, weights) = stream.at(place.into())?;
    let (velocity, force) = (&particles.velocity[slot], &particles.force[slot]);
    let (spin, torque) = (&particles.angular_velocity[slot], &particles.torque[slot]);
    let is_free = particles.owner[slot] == 0;
    let gained = |motion: &Row, load: &Row| if is_free { kick.gained(motion, load) } else { Gained::default() };
    let shift = Shift { kick, stream, at: (place.into(), &here, &weights), diameter: 2.0 * place[3], body: slot };
    let mut exchanged = shift.exchanged((velocity, force), is_free, gained);
    if stream.has_torque() {
        exchanged = exchanged.plus(kick.turn(spin, torque, gained(spin, torque)));
    }
    Some((weights, exchanged))
}

/// The translation of a sphere in a half kick.
struct Shift<'a, 'b> {
    /// The half kick.
    kick: &'a HalfKick,
    /// How the fluid flows.
    stream: &'a Stream<'b>,
    /// Where the sphere is \[m\], how the fluid flows there, and the cells around it.
    at: (Vector, &'a Here<'b>, &'a Weights),
    /// Its diameter \[m\].
    diameter: f64,
    /// Its number among particles and, counted on behind these, clumps.
    body: usize,
}

impl Shift<'_, '_> {
    /// What the sphere exchanges with the fluid, where it moves so by this load and gains of it what is told.
    #[inline(always)]
    fn exchanged(
        &self,
        (velocity, force): (&Row, &Row),
        is_free: bool,
        gained: impl Fn(&Row, &Row) -> Gained,
    ) -> Exchanged {
        let (Self { kick, stream, diameter, .. }, (point, here, weights)) = (self, self.at);
        if !stream.acts_beside() {
            return kick.shift((here, *diameter), velocity, force, gained(velocity, force));
        }
        let around = stream.around(point, here.velocity, weights);
        let beside = stream.beside(&around, *diameter, (velocity[3], is_free), stream.lift(self.body));
        let here = here.with(&around, &beside, *diameter);
        let [motion, load] = beside.whole(velocity, force);
        let gained = gained(&motion, &load);
        kick.beside(kick.shift((&here, *diameter), &motion, &load, gained), &motion, gained, &beside)
    }
}

/// That of a clump.
#[inline(always)]
fn of_clump(kick: &HalfKick, stream: &Stream, state: &State, clump: usize) -> Option<(Weights, Exchanged)> {
    let rows = &state.clumps;
    let (here, weights) = stream.at(rows.position[clump].into())?;
    let (velocity, force) = (&rows.velocity[clump], &rows.force[clump]);
    // The book of bodies takes every half kick as it is.
    let exactly = |gained| Gained { more: Vector::zero(), ..gained };
    let diameter = stream.diameter(rows, clump);
    let shift = Shift {
        kick,
        stream,
        at: (rows.position[clump].into(), &here, &weights),
        diameter,
        body: state.particles.len() + clump,
    };
    let shift = shift.exchanged((velocity, force), true, |motion, load| exactly(kick.gained(motion, load)));
    let [now, before] = clumps::turns(rows, clump, [kick.half, kick.behind.unwrap_or(0.0)]);
    let gained = Gained { is_free: true, now, before, more: Vector::zero() };
    let turn = kick.turn(&rows.angular_velocity[clump], &rows.moment[clump], gained);
    Some((weights, shift.plus(turn)))
}
