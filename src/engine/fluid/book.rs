//! What a half kick exchanges between the fluid and the bodies in it.
//!
//! A load F with the dashpot β to the ground, on a mass m, gives in half a kick of a step Δt
//!
//! ```text
//! Δ = ½ Δt F/(m + ½ Δt β)        impulse of the drag j = ½ Δt β w − ½ Δt β Δ        its work on the body j · (v + ½ Δ)
//! ```
//!
//! w is the slip of the load: that of the velocity half a step earlier, where the kick begins a step.

use super::sums::Given;
use super::{Here, Medium, Stream, volume};
use crate::base::number::{Vector, add};
use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::clumps;
use crate::engine::integration::mobility;
use crate::engine::state::fluid::EXCHANGED;
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
    /// Drag over the velocity, times the length of the half kick \[kg\].
    resistance: f64,
    /// Impulse of the force of the pressure gradient on the bodies \[N s\].
    pushed: Vector,
    /// Volume of the bodies times their way \[m⁴\].
    swept: Vector,
    /// Work of the fluid \[J\].
    work: f64,
    /// What drag takes \[J\].
    taken: f64,
    /// Work on the bodies that forces move \[J\].
    on_free: f64,
    /// Impulse on them \[N s\].
    moved: Vector,
    /// What all other forces do to these more in a half kick of another length than the last one's, of what the energy book tells
    /// from that one \[J\].
    others: f64,
}

impl Exchanged {
    /// What the fluid gets in cells of this volume \[m³\]: the impulses, which are not those of the bodies, with the resistance behind the
    /// first; and the superficial way of the bodies.
    fn on_fluid(&self, volume: f64) -> [Row; EXCHANGED] {
        let way = self.swept * (1.0 / volume);
        [(-self.impulse).row_with(self.resistance), (-self.pushed).row_with(0.0), way.row_with(0.0)]
    }

    /// Both together.
    fn plus(self, other: Self) -> Self {
        Self {
            impulse: self.impulse + other.impulse,
            resistance: self.resistance + other.resistance,
            pushed: self.pushed + other.pushed,
            swept: self.swept + other.swept,
            work: self.work + other.work,
            taken: self.taken + other.taken,
            on_free: self.on_free + other.on_free,
            moved: self.moved + other.moved,
            others: self.others + other.others,
        }
    }
}

/// A half kick.
#[derive(Clone, Copy)]
struct HalfKick {
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

impl HalfKick {
    /// What a load with its dashpot gives to the motion of a particle: velocity and mass, or angular velocity and moment of inertia.
    #[inline(always)]
    fn gained(&self, motion: &Row, load: &Row) -> Gained {
        let push = Vector::from(*load);
        let now = push * (self.half * mobility(motion, load, self.half));
        let Some(behind) = self.behind else { return Gained { now, ..Gained::default() } };
        let last = mobility(motion, load, behind);
        Gained { now, before: push * (behind * last), more: now - push * (self.half * last) }
    }

    /// What the fluid exchanges here with the translation of a sphere that moves so, by a force with its dashpot. It is held where it
    /// gains nothing.
    #[inline(always)]
    fn shift(&self, (here, diameter): (&Here, f64), velocity: &Row, force: &Row, gained: Option<Gained>) -> Exchanged {
        let half = self.half;
        let is_free = gained.is_some();
        let none = Gained::default();
        let (velocity, Gained { now, before, more }) = (Vector::from(*velocity), gained.unwrap_or(none));
        let (slip, push) = (here.velocity - velocity + before, here.push(diameter));
        // The drift lies between both half kicks: its velocity is that behind the first and before the second.
        let drifts = if self.behind.is_some() { velocity + now } else { velocity };
        let resistance = half * force[3];
        let (drag, mean) = ((slip - now) * resistance, velocity + now * 0.5);
        let others = Vector::from(*force) - slip * force[3] - push;
        Exchanged {
            impulse: drag,
            resistance,
            pushed: push * half,
            swept: drifts * (half * volume(diameter)),
            work: drag.dot(here.velocity) + half * push.dot(mean),
            taken: drag.dot(here.velocity - mean),
            on_free: if is_free { drag.dot(mean) + half * push.dot(mean) } else { 0.0 },
            moved: if is_free { drag + push * half } else { Vector::zero() },
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
pub(crate) fn book(medium: &mut Medium, state: &mut State, kick: Kick, context: &Context) {
    let Some(mut fluid) = state.fluid.take() else { return };
    let behind = (kick == Kick::First).then_some(0.5 * fluid.step);
    let half_kick = HalfKick { half: 0.5 * context.step, behind };
    // What is written is lent out meanwhile.
    let (mut sums, mut cells) = (std::mem::take(&mut medium.sums), std::mem::take(&mut fluid.exchanged));
    let stream = Stream::of(medium, &fluid);
    let mut sum = Exchanged::default();
    for bodies in [Bodies::Particles, Bodies::Clumps] {
        let count = bodies.count(state);
        if count == 0 {
            continue;
        }
        let exchanged = |body: usize| bodies.exchanged(&half_kick, &stream, state, body);
        let all = match medium.grid {
            None => over(count, context, exchanged),
            Some(grid) => {
                let volume = grid.cell_volume();
                let join = (Exchanged::default(), Exchanged::plus as fn(_, _) -> _);
                let whole = |body: usize, given: &mut Given| shared::<EXCHANGED>(exchanged(body), volume, given);
                let drag = |body: usize, given: &mut Given| shared::<1>(exchanged(body), volume, given);
                match fluid.rows() {
                    1 => sums.over((count, &mut cells), context, drag, join),
                    _ => sums.over((count, &mut cells), context, whole, join),
                }
            }
        };
        sum = sum.plus(all);
    }
    if medium.grid.is_none() {
        let [drag, ..] = sum.on_fluid(1.0);
        add(&mut cells[0], &drag);
    }
    (medium.sums, fluid.exchanged) = (sums, cells);
    fluid.work += sum.work;
    fluid.impulse = (Vector::from(fluid.impulse) + sum.moved).to_array();
    state.fluid = Some(fluid);
    if let Some(losses) = &mut state.losses {
        losses.add(Loss::Drag, sum.taken);
    }
    if let Some(ledger) = &mut state.ledger {
        ledger.book_fluid(sum.on_free + sum.others);
    }
}

/// What so many bodies exchange, each where it is.
fn over<'a>(
    count: usize,
    context: &Context,
    exchanged: impl Fn(usize) -> Option<(Here<'a>, Exchanged)> + Sync + Send,
) -> Exchanged {
    let of_piece = |piece: usize| {
        let bodies = piece * CHUNK..((piece + 1) * CHUNK).min(count);
        bodies.filter_map(&exchanged).fold(Exchanged::default(), |sum, (_, one)| sum.plus(one))
    };
    context.fold(count.div_ceil(CHUNK), of_piece, Exchanged::default(), Exchanged::plus)
}

/// Gives the cells of this volume \[m³\] around a body what it does to the fluid there. Returns what is exchanged.
#[inline(always)]
fn shared<const ROWS: usize>(one: Option<(Here, Exchanged)>, volume: f64, given: &mut Given) -> Exchanged {
    let Some((here, exchanged)) = one else { return Exchanged::default() };
    if let Some(weights) = &here.weights {
        let rows = exchanged.on_fluid(volume);
        given.share::<ROWS>(weights, std::array::from_fn(|row| rows[row]));
    }
    exchanged
}

/// What is in the fluid.
#[derive(Clone, Copy)]
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
    fn exchanged<'a>(
        self,
        kick: &HalfKick,
        stream: &Stream<'a>,
        state: &State,
        body: usize,
    ) -> Option<(Here<'a>, Exchanged)> {
        match self {
            Self::Particles => of_particle(kick, stream, state, body),
            Self::Clumps => of_clump(kick, stream, state, body),
        }
    }
}

/// That of a particle, if it is neither image nor of a clump.
#[inline(always)]
fn of_particle<'a>(kick: &HalfKick, stream: &Stream<'a>, state: &State, slot: usize) -> Option<(Here<'a>, Exchanged)> {
    let particles = &state.particles;
    // Images and spheres of clumps are counted on behind the boundaries.
    if particles.owner[slot] as usize > state.boundaries.len() {
        return None;
    }
    let place = particles.position[slot];
    let here = stream.at(place.into())?;
    let (velocity, force) = (&particles.velocity[slot], &particles.force[slot]);
    let (spin, torque) = (&particles.angular_velocity[slot], &particles.torque[slot]);
    let gained = |motion, load| (particles.owner[slot] == 0).then(|| kick.gained(motion, load));
    let mut exchanged = kick.shift((&here, 2.0 * place[3]), velocity, force, gained(velocity, force));
    if stream.has_torque() {
        exchanged = exchanged.plus(kick.turn(spin, torque, gained(spin, torque)));
    }
    Some((here, exchanged))
}

/// That of a clump.
#[inline(always)]
fn of_clump<'a>(kick: &HalfKick, stream: &Stream<'a>, state: &State, clump: usize) -> Option<(Here<'a>, Exchanged)> {
    let rows = &state.clumps;
    let here = stream.at(rows.position[clump].into())?;
    let (velocity, force) = (&rows.velocity[clump], &rows.force[clump]);
    // The book of bodies takes every half kick as it is.
    let exactly = |gained| Some(Gained { more: Vector::zero(), ..gained });
    let diameter = stream.diameter(rows, clump);
    let shift = kick.shift((&here, diameter), velocity, force, exactly(kick.gained(velocity, force)));
    let [now, before] = clumps::turns(rows, clump, [kick.half, kick.behind.unwrap_or(0.0)]);
    let gained = Gained { now, before, more: Vector::zero() };
    let turn = kick.turn(&rows.angular_velocity[clump], &rows.moment[clump], Some(gained));
    Some((here, shift.plus(turn)))
}
