//! What a half kick exchanges between the fluid and the bodies in it.
//!
//! A load F with the dashpot β to the ground, on a mass m, gives in half a kick of a step Δt
//!
//! ```text
//! Δ = ½ Δt F/(m + ½ Δt β)        impulse of the drag j = ½ Δt β w − ½ Δt β Δ        its work on the body j · (v + ½ Δ)
//! ```
//!
//! w is the slip of the load: that of the velocity half a step earlier, where the kick begins a step.

use super::{Medium, Stream};
use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::clumps;
use crate::engine::integration::mobility;
use crate::engine::state::{Loss, Row, State};

/// Which half kick of a time step is about to be made.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kick {
    /// That which begins it, with the loads of the step before.
    First,
    /// That which ends it.
    Second,
}

/// What is exchanged.
#[derive(Clone, Copy, Default)]
struct Exchanged {
    /// Impulse of the drag on the bodies \[N s\].
    impulse: Vector,
    /// Work of the fluid \[J\].
    work: f64,
    /// What drag takes \[J\].
    taken: f64,
    /// Work on the bodies that forces move \[J\].
    on_free: f64,
    /// What all other forces do to these more in a half kick of another length than the last one's, of what the energy book tells
    /// from that one \[J\].
    others: f64,
}

impl Exchanged {
    /// Both together.
    fn plus(self, other: Self) -> Self {
        Self {
            impulse: self.impulse + other.impulse,
            work: self.work + other.work,
            taken: self.taken + other.taken,
            on_free: self.on_free + other.on_free,
            others: self.others + other.others,
        }
    }
}

/// A half kick.
#[derive(Clone, Copy)]
struct HalfKick<'a> {
    /// The fluid.
    stream: Stream<'a>,
    /// Half the length of the step \[s\].
    half: f64,
    /// Half the length of the step at whose end the loads were found \[s\]; none where that is this one.
    behind: Option<f64>,
}

/// What a load with its dashpot gives to a motion.
#[derive(Clone, Copy, Default)]
struct Gained {
    /// In the half kick that is about to be made.
    now: Vector,
    /// In the other half kick with the same load, if it has been made.
    before: Vector,
    /// How much more now than the energy book takes it for, whose powers are those of the other one.
    more: Vector,
}

impl HalfKick<'_> {
    /// What a load with its dashpot gives to the motion of a particle: velocity and mass, or angular velocity and moment of inertia.
    #[inline(always)]
    fn gained(&self, motion: &Row, load: &Row) -> Gained {
        let push = Vector::from(*load);
        let now = push * (self.half * mobility(motion, load, self.half));
        let Some(behind) = self.behind else { return Gained { now, ..Gained::default() } };
        let last = mobility(motion, load, behind);
        Gained { now, before: push * (behind * last), more: now - push * (self.half * last) }
    }

    /// What the fluid exchanges with the translation of a sphere that moves so, by a force with its dashpot. It is held where it gains
    /// nothing.
    #[inline(always)]
    fn shift(&self, diameter: f64, velocity: &Row, force: &Row, gained: Option<Gained>) -> Exchanged {
        let Self { stream, half, .. } = *self;
        let is_free = gained.is_some();
        let none = Gained::default();
        let (velocity, Gained { now, before, more }) = (Vector::from(*velocity), gained.unwrap_or(none));
        let (slip, buoyancy) = (stream.velocity - velocity + before, stream.medium.buoyancy(diameter));
        let (drag, mean) = ((slip - now) * (half * force[3]), velocity + now * 0.5);
        let others = Vector::from(*force) - slip * force[3] - buoyancy;
        Exchanged {
            impulse: drag,
            work: drag.dot(stream.velocity) + half * buoyancy.dot(mean),
            taken: drag.dot(stream.velocity - mean),
            on_free: if is_free { drag.dot(mean) + half * buoyancy.dot(mean) } else { 0.0 },
            others: 0.5 * half * others.dot(more),
        }
    }

    /// What it exchanges with the rotation, by a torque with its dashpot.
    #[inline(always)]
    fn turn(&self, spin: &Row, torque: &Row, gained: Option<Gained>) -> Exchanged {
        let is_free = gained.is_some();
        let none = Gained::default();
        let (spin, Gained { now, before, more }) = (Vector::from(*spin), gained.unwrap_or(none));
        let earlier = spin - before;
        let work = (earlier + now).dot(spin + now * 0.5) * -(self.half * torque[3]);
        let others = Vector::from(*torque) + earlier * torque[3];
        Exchanged {
            taken: -work,
            on_free: if is_free { work } else { 0.0 },
            others: 0.5 * self.half * others.dot(more),
            ..Exchanged::default()
        }
    }
}

/// Books what the fluid does in the half kick that is about to be made, on particles and clumps.
pub(crate) fn book(medium: &Medium, state: &mut State, kick: Kick, context: &Context) {
    let Some(step) = state.fluid.as_ref().map(|fluid| fluid.step) else { return };
    let behind = (kick == Kick::First).then_some(0.5 * step);
    let half_kick = HalfKick { stream: medium.stream(state), half: 0.5 * context.step, behind };
    let mut sum = on_particles(&half_kick, state, context);
    if !state.clumps.is_empty() {
        sum = sum.plus(on_clumps(&half_kick, state, context));
    }
    if let Some(fluid) = &mut state.fluid {
        for (total, part) in fluid.impulse.iter_mut().zip(sum.impulse.to_array()) {
            *total -= part;
        }
        fluid.work += sum.work;
    }
    if let Some(losses) = &mut state.losses {
        losses.add(Loss::Drag, sum.taken);
    }
    if let Some(ledger) = &mut state.ledger {
        ledger.book_fluid(sum.on_free + sum.others);
    }
}

/// On all particles but images and spheres of clumps.
fn on_particles(kick: &HalfKick, state: &State, context: &Context) -> Exchanged {
    let (particles, boundaries) = (&state.particles, state.boundaries.len() as u32);
    let count = particles.len();
    let of_piece = |piece: usize| {
        let mut sum = Exchanged::default();
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            // Images and spheres of clumps are counted on behind the boundaries.
            if particles.owner[slot] <= boundaries {
                let (velocity, force) = (&particles.velocity[slot], &particles.force[slot]);
                let (spin, torque) = (&particles.angular_velocity[slot], &particles.torque[slot]);
                let gained = |motion, load| (particles.owner[slot] == 0).then(|| kick.gained(motion, load));
                let diameter = 2.0 * particles.position[slot][3];
                sum = sum.plus(kick.shift(diameter, velocity, force, gained(velocity, force)));
                if kick.stream.medium.torque {
                    sum = sum.plus(kick.turn(spin, torque, gained(spin, torque)));
                }
            }
        }
        sum
    };
    context.fold(count.div_ceil(CHUNK), of_piece, Exchanged::default(), Exchanged::plus)
}

/// On the clumps.
fn on_clumps(kick: &HalfKick, state: &State, context: &Context) -> Exchanged {
    let State { clumps: rows, .. } = state;
    let count = rows.len();
    let of_piece = |piece: usize| {
        let mut sum = Exchanged::default();
        for clump in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
            let diameter = kick.stream.medium.diameter(rows, clump);
            let (velocity, force) = (&rows.velocity[clump], &rows.force[clump]);
            // The book of bodies takes every half kick as it is.
            let exactly = |gained| Some(Gained { more: Vector::zero(), ..gained });
            sum = sum.plus(kick.shift(diameter, velocity, force, exactly(kick.gained(velocity, force))));
            let [now, before] = clumps::turns(rows, clump, [kick.half, kick.behind.unwrap_or(0.0)]);
            let gained = Gained { now, before, more: Vector::zero() };
            sum = sum.plus(kick.turn(&rows.angular_velocity[clump], &rows.moment[clump], Some(gained)));
        }
        sum
    };
    context.fold(count.div_ceil(CHUNK), of_piece, Exchanged::default(), Exchanged::plus)
}
