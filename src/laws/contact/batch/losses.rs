//! What contacts lose, over a batch. One kernel for all laws reads what their sub-models left in the columns; laws that are compiled
//! whole call [`book`] with what stands in their registers.
//!
//! Losses are summed in eight columns, by the place of the contact in the batch: the same bits in every lane width.

use super::stage::Stage;
use super::{EntryEvaluation, SLIDING};
use crate::base::lanes::{self, Kernel, Lane, Width, vector};
use crate::base::number::Vector;
use crate::laws::contact::{Booked, Contact, LossKind, Seen};

/// Most entries of a batch, with the register that fills it.
const PLACES: usize = 80;

/// The places of a batch, as numbers.
const RAMP: [f64; PLACES] = {
    let mut ramp = [0.0; PLACES];
    let mut place = 0;
    while place < PLACES {
        ramp[place] = place as f64;
        place += 1;
    }
    ramp
};

/// Keeps what sub-models change and a book wants to know.
pub(crate) fn keep_before(width: Width, stage: &mut Stage) {
    lanes::run(width, KeepBefore(stage));
}

/// Books what contacts lose on which the whole law acts.
pub(crate) fn book_open(width: Width, stage: &mut Stage) {
    lanes::run(width, Book { stage, manner: EntryEvaluation::Open });
}

/// The same of those whose normal force a bond suppresses.
pub(crate) fn book_bonded(width: Width, stage: &mut Stage) {
    lanes::run(width, Book { stage, manner: EntryEvaluation::Bonded });
}

/// The same of those whose normal force is taken from an offset.
pub(crate) fn book_released(width: Width, stage: &mut Stage) {
    lanes::run(width, Book { stage, manner: EntryEvaluation::Released });
}

/// Springs and normal velocities before sub-models work.
struct KeepBefore<'a, 'b>(&'a mut Stage<'b>);

impl Kernel for KeepBefore<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let Booked { spring, carries, predicts_normal_alone, .. } = *stage.booked;
        let half = N::splat(0.5 * stage.step);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: the batch is filled up to a whole register, for which there is room; its entries belong to this
            // piece of the list.
            unsafe {
                let row = stage.remembered(spring, stage.history.tangential, done);
                let mut velocity = N::zero();
                if predicts_normal_alone {
                    let contact: Contact<N> = stage.contact(done, false);
                    velocity = contact.normal_velocity;
                } else if carries {
                    let contact: Contact<N> = stage.contact(done, false);
                    let across = contact.slip + contact.turning.cross(contact.normal);
                    // Along the normal of mid-step.
                    velocity = contact.normal_velocity - across.dot(across) * (half * contact.per_distance);
                }
                stage.buffer.put_before(done, Vector::of_row(row), velocity);
            }
            done += N::WIDTH;
        }
    }
}

/// What contacts lose.
struct Book<'a, 'b> {
    /// What sub-models left.
    stage: &'a mut Stage<'b>,
    /// What was done with the contacts.
    manner: EntryEvaluation,
}

impl Kernel for Book<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { stage, manner } = self;
        let booked = *stage.booked;
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: the batch is filled up to a whole register, for which there is room; its entries belong to this
            // piece of the list.
            unsafe {
                let seen = seen::<N>(stage, manner, done);
                book(stage, done, &seen, &booked);
            }
            done += N::WIDTH;
        }
    }
}

/// Adds twice what a register's worth of contacts lose, and stores what is to be known of them next time.
///
/// # Safety
/// As for [`Stage::press`]; `place` is a multiple of the width, so that the register ends in the eight columns.
#[inline(always)]
pub(crate) unsafe fn book<N: Lane>(stage: &mut Stage, place: usize, seen: &Seen<N>, booked: &Booked) {
    let (mut lost, loads) = seen.twice_losses(booked);
    // SAFETY: the caller's promise.
    unsafe {
        stage.remember(true, stage.history.loads, loads[0], place);
        stage.remember(true, stage.history.other_loads, loads[1], place);
        if let Some(weights) = stage.weights {
            let (base, entries) = (weights.as_ptr().cast::<f64>(), stage.buffer.entry.as_ptr().add(place));
            weigh(&mut lost, [N::gather(base, entries, 3), N::gather(base.add(1), entries, 3)]);
        }
        if stage.buffer.ready < place + N::WIDTH {
            // The entries that fill the last register are not counted.
            let counted = N::splat(stage.buffer.ready as f64).greater(N::load(RAMP.as_ptr().add(place)));
            for energy in &mut lost {
                *energy = N::select(counted, *energy, N::zero());
            }
        }
        if booked.warms() {
            stage.buffer.put_heat(place, booked.heat(&lost) * N::splat(0.5));
        }
        if booked.follows {
            stage.buffer.put_lost(place, booked.by_direction(&lost).map(|energy| energy * N::splat(0.5)));
        }
        let mut kind = 0;
        while kind < LossKind::COUNT {
            if booked.takes(kind) {
                let sum = stage.buffer.losses.columns[kind].as_mut_ptr().add(place % 8);
                (N::load(sum) + lost[kind]).store(sum);
            }
            kind += 1;
        }
    }
}

/// What is seen of a register's worth of contacts, as moved at mid-step where springs are carried.
///
/// # Safety
/// As for [`Stage::contact`].
#[inline(always)]
unsafe fn seen<N: Lane>(stage: &Stage, manner: EntryEvaluation, place: usize) -> Seen<N> {
    let (step, booked, buffer) = (N::splat(stage.step), *stage.booked, &*stage.buffer);
    let history = &stage.history;
    // SAFETY: the caller's promise.
    unsafe {
        let entries = buffer.entry.as_ptr().add(place);
        let contact: Contact<N> = stage.contact(place, false);
        let (mut sliding, mut lane) = ([0.0; 8], 0);
        while booked.friction && lane < N::WIDTH {
            sliding[lane] = f64::from(*stage.entries.flags.at(*entries.add(lane) as usize) & SLIDING);
            lane += 1;
        }
        let mut seen = Seen {
            normal: buffer.normal(place),
            pressing: if matches!(manner, EntryEvaluation::Open) { contact.overlap } else { buffer.pressing(place) },
            least_force: match stage.uniform {
                Some(row) => N::splat(row[booked.least_force]),
                None => stage.table.gather(booked.least_force, buffer.row.as_ptr().add(place)),
            },
            acts: !matches!(manner, EntryEvaluation::Bonded),
            normal_displacement: contact.normal_velocity * step,
            tangential_displacement: contact.slip * step,
            turn: contact.relative_spin * step,
            force: Vector::zero(),
            rolling: Vector::zero(),
            spring_before: Vector::zero(),
            spring: stage.remembered(booked.spring, history.tangential, place),
            sliding: N::load(sliding.as_ptr()).greater(N::zero()),
            before: [stage.remembered(true, history.loads, place), stage.remembered(true, history.other_loads, place)],
            contact,
        };
        if booked.friction {
            seen.force = vector(N::load_block(buffer.force.as_ptr().add(place)));
        }
        if booked.rolling {
            seen.rolling = vector(N::load_block(buffer.rolling.as_ptr().add(place)));
        }
        if booked.keeps_before() {
            let (spring, velocity) = buffer.before::<N>(place);
            seen.spring_before = spring;
            if booked.moves_otherwise() {
                seen.normal_displacement = velocity * step;
            }
            if booked.carries {
                let carry = buffer.carry::<N>(place);
                seen.tangential_displacement = carry.stretch * (N::splat(1.0) / carry.share);
            }
        }
        seen
    }
}

/// Puts weights on the losses of contacts that do not count once: of the normal force, and of friction.
#[inline(always)]
fn weigh<N: Lane>(lost: &mut [N; LossKind::COUNT], [weight, share]: [N; 2]) {
    for (kind, energy) in lost.iter_mut().enumerate() {
        let of_normal = kind == LossKind::Normal as usize || kind == LossKind::Other as usize;
        *energy = *energy * if of_normal { weight } else { share };
    }
}
