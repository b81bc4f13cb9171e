//! What a half kick exchanges between the fluid and a body in it.
//!
//! A load F with the dashpot β to the ground, on a mass m, gives in half a kick of a step Δt
//!
//! ```text
//! Δ = ½ Δt F/(m + ½ Δt β)        impulse of the drag j = ½ Δt β w − ½ Δt β Δ        its work on the body j · (v + ½ Δ)
//! ```
//!
//! w is the slip of the load: that of the velocity half a step earlier, where the kick begins a step.

use super::beside::Beside;
use super::{Here, volume};
use crate::base::number::Vector;
use crate::engine::integration::mobility;
use crate::engine::state::Row;
use crate::engine::state::fluid::{Booked, EXCHANGED};

/// What is exchanged.
#[derive(Clone, Copy, Default)]
pub(super) struct Exchanged {
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
    pub(super) others: f64,
}

impl Exchanged {
    /// What acts by this impulse \[N s\] on a sphere that is held.
    pub(super) fn of_held(impulse: Vector) -> Self {
        Self { impulse, ..Self::default() }
    }

    /// What acts by an impulse of drag and one of added mass, and all together by a third one \[N s\], on a sphere that forces move, where the
    /// fluid has one velocity and the sphere the other one \[m/s\].
    pub(super) fn of_free((drag, added): (Vector, Vector), all: Vector, [flow, mean]: [Vector; 2]) -> Self {
        let (taken, on_free) = (drag.dot(flow - mean), all.dot(mean));
        Self { impulse: drag + added, work: on_free + taken, taken, on_free, moved: all, ..Self::default() }
    }

    /// The same with a volume that goes a way \[m⁴\].
    pub(super) fn with_way(self, swept: Vector) -> Self {
        Self { swept, ..self }
    }

    /// What the fluid gets in cells of this volume \[m³\]: the impulses, which are not those of the bodies, with the resistance behind the
    /// first; and the superficial way of the bodies.
    #[inline(always)]
    pub(super) fn on_fluid(&self, volume: f64) -> [Row; EXCHANGED] {
        let way = self.swept * (1.0 / volume);
        [(-self.impulse).row_with(self.resistance), (-self.pushed).row_with(0.0), way.row_with(0.0)]
    }

    /// What is booked of it.
    #[inline(always)]
    pub(super) fn booked(&self) -> Booked {
        let Self { work, taken, on_free, moved, .. } = *self;
        Booked { work, taken, on_free, moved: moved.to_array() }
    }

    /// The same: work, what drag takes and work on what is free, and impulse on it.
    #[inline(always)]
    pub(super) fn columns(self) -> (Vector, Vector) {
        (Vector::new(self.work, self.taken, self.on_free), self.moved)
    }

    /// Both together.
    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
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
pub(super) struct HalfKick {
    /// Half the length of the step \[s\].
    pub(super) half: f64,
    /// Half the length of the step at whose end the loads were found \[s\]; none where that is this one.
    pub(super) behind: Option<f64>,
}

/// What a load with its dashpot gives to a motion: nothing, where that is held.
#[derive(Clone, Copy, Default)]
pub(super) struct Gained {
    /// Whether forces move it.
    pub(super) is_free: bool,
    /// In the half kick that is about to be made.
    pub(super) now: Vector,
    /// In the other half kick with the same load, if it has been made.
    pub(super) before: Vector,
    /// How much more now than the energy book takes it for, whose powers are those of the other one.
    pub(super) more: Vector,
}

impl HalfKick {
    /// What a load with its dashpot gives to the motion of a particle: velocity and mass, or angular velocity and moment of inertia.
    #[inline(always)]
    pub(super) fn gained(&self, motion: &Row, load: &Row) -> Gained {
        let push = Vector::from(*load);
        let now = push * (self.half * mobility(motion, load, self.half));
        let Some(behind) = self.behind else { return Gained { is_free: true, now, ..Gained::default() } };
        let last = mobility(motion, load, behind);
        Gained { is_free: true, now, before: push * (behind * last), more: now - push * (self.half * last) }
    }

    /// What the fluid exchanges here with the translation of a sphere that moves so, by a force with its dashpot.
    #[inline(always)]
    pub(super) fn shift(
        &self,
        (here, diameter): (&Here, f64),
        velocity: &Row,
        force: &Row,
        gained: Gained,
    ) -> Exchanged {
        let (half, velocity, Gained { is_free, now, before, more }) = (self.half, Vector::from(*velocity), gained);
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
            moved: Vector::select(is_free, drag + push * half, Vector::zero()),
            others: 0.5 * half * others.dot(more),
        }
    }

    /// What it exchanges with the translation of a sphere, where what acts beside drag was taken for a part of the pressure and the added mass
    /// for one of the sphere.
    #[inline(always)]
    pub(super) fn beside(&self, whole: Exchanged, velocity: &Row, gained: Gained, beside: &Beside) -> Exchanged {
        let (impulse, carried) = (beside.force * self.half, gained.now * beside.mass);
        let work = carried.dot(Vector::from(*velocity) + gained.now * 0.5);
        Exchanged {
            impulse: whole.impulse + impulse - carried,
            pushed: whole.pushed - impulse,
            work: whole.work - work,
            on_free: whole.on_free - work,
            moved: whole.moved - carried,
            ..whole
        }
    }

    /// What it exchanges with the rotation, by a torque with its dashpot.
    #[inline(always)]
    pub(super) fn turn(&self, spin: &Row, torque: &Row, gained: Gained) -> Exchanged {
        let (spin, Gained { is_free, now, before, more }) = (Vector::from(*spin), gained);
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
