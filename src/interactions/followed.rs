//! Slopes of contacts between particles, batch by batch of the time step. The values that come beside them are those of the law, to
//! the bit, so the law is not evaluated beside.

use super::slopes::{materials, needed, react_by};
use crate::batches::{Along, Batch, BatchLaw, Buffer, Left, SpherePair};
use crate::coefficients::{CoefficientTable, in_lanes};
use crate::contact::{Evaluated, MOST_HISTORY, Needs, Reaction};
use crate::dual::{Dual, Slopes};
use crate::lanes::{self, Kernel, Lane, Places, columns, rows_from};
use crate::number::{Number, Vector};
use crate::tangent::{Moving, Tangent, slopes_of, spread, with_slopes};
use std::sync::{Mutex, PoisonError};

/// Contacts between particles whose slopes are followed.
pub(super) struct Followed<'a> {
    /// Their law.
    law: &'a BatchLaw,
    /// Its coefficients.
    table: &'a CoefficientTable,
    /// Which list of the state is theirs.
    index: usize,
    /// How the particles move.
    moving: Moving<'a>,
    /// Their materials.
    material: &'a [u32],
    /// What is followed; slabs wait for each other.
    tangents: Mutex<&'a mut [Tangent]>,
    /// Whether nothing is.
    none: bool,
    /// The time step, or time itself.
    step: Dual,
    /// Whether the list is looked at alone.
    looks: bool,
}

impl<'a> Followed<'a> {
    /// Those of a list, under a law with these coefficients, over a time step.
    pub(super) fn of(
        (law, table, index): (&'a BatchLaw, &'a CoefficientTable, usize),
        (moving, material): (Moving<'a>, &'a [u32]),
        tangents: &'a mut [Tangent],
        step: Dual,
    ) -> Self {
        for tangent in &mut *tangents {
            let slopes = &mut tangent.contacts[index];
            slopes.set_odd(law.law.history().iter().map(|row| row.odd));
            slopes.go_on();
        }
        let (none, tangents) = (tangents.is_empty(), Mutex::new(tangents));
        Self { law, table, index, moving, material, none, tangents, step, looks: false }
    }

    /// The same, of a list that is looked at alone.
    pub(super) fn looking(self) -> Self {
        Self { looks: true, ..self }
    }

    /// Whether nothing is followed.
    pub(super) fn is_none(&self) -> bool {
        self.none
    }
}

impl Along for Followed<'_> {
    fn follow(&self, batch: &mut Batch) -> Left {
        let mut tangents = self.tangents.lock().unwrap_or_else(PoisonError::into_inner);
        let slots = [&batch.buffer.first[..batch.buffer.ready], &batch.buffer.second[..batch.buffer.ready]];
        let reaches = |tangent: &Tangent| slots.iter().any(|slots| tangent.particles.reaches(slots));
        let Some(last) = tangents.iter().rposition(reaches) else {
            return if self.looks { Left::Nothing } else { Left::All };
        };
        // The last one evaluates the law, too: history goes on then.
        let writes = !self.looks && !self.law.law.is_booked();
        for (place, tangent) in tangents[..=last].iter_mut().enumerate() {
            let (width, writes) = (tangent.width, writes && place == last);
            if self.law.needs.torque {
                lanes::run_seldom(width, Follow::<true> { contacts: self, tangent, batch, writes });
            } else {
                lanes::run_seldom(width, Follow::<false> { contacts: self, tangent, batch, writes });
            }
        }
        match (self.looks, writes) {
            (true, _) => Left::Nothing,
            (false, true) => Left::Spreading,
            (false, false) => Left::All,
        }
    }
}

/// Contacts of a batch with the slopes by an input. TURNING: they turn their bodies; otherwise nothing is looked at but the force.
struct Follow<'a, 'b, 'c, const TURNING: bool> {
    /// The contacts.
    contacts: &'a Followed<'c>,
    /// What is followed.
    tangent: &'a mut Tangent,
    /// The batch.
    batch: &'a mut Batch<'b>,
    /// Whether the law is evaluated.
    writes: bool,
}

impl<const TURNING: bool> Kernel for Follow<'_, '_, '_, TURNING> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { contacts: Followed { law, table, index, moving, material, step, .. }, tangent, batch, writes } =
            self;
        let (law, needs) = (&law.law, law.needs);
        let (moved, slopes) = (&mut tangent.particles, &mut tangent.contacts[*index]);
        let (step, remembered) = (spread::<N>(*step), law.history().len());
        let uniform = table.uniform().map(in_lanes::<N>);
        let acting = Evaluated::acting(law);
        let mut rows = [[Dual::zero(); 4]; MOST_HISTORY];
        for at in (0..batch.buffer.ready).step_by(N::WIDTH) {
            let Buffer { first, second, entry, ready, .. } = &*batch.buffer;
            let (i, j, entries) =
                (Places::from::<N>(first, at), Places::from::<N>(second, at), Places::from::<N>(entry, at));
            let count = usize::min(ready - at, N::WIDTH);
            let reached = moved.reached(i.first(count)) | moved.reached(j.first(count));
            if reached == 0 && !writes {
                continue;
            }
            let found = batch.found::<N>(at);
            let spheres = moved.pair(found, &i, &j);
            let velocities = moved.velocities::<N>(moving, &i, &j);
            let mut spins = [[Dual::zero(); 4]; 2];
            if TURNING {
                spins = [moved.spins(moving, &i), moved.spins(moving, &j)];
            }
            let constant = batch.constants::<N>(at);
            let spheres = SpherePair::from_found(spheres);
            let geometry = spheres.meet(velocities, spins, Dual::constant(constant));
            let [velocity_i, velocity_j] = velocities;
            let known = [Dual::values_of(velocity_i), Dual::values_of(velocity_j)];
            let values = SpherePair::from_found(found).meet(known, [[Number::zero(); 4]; 2], constant).contact;
            let mut geometry = needed::<N, TURNING>(geometry, &values, needs);
            if needs.section {
                geometry.contact.section_area = spheres.section(spheres.roots(), geometry.contact.overlap);
            }
            let gathered;
            let row = match &uniform {
                Some(row) => row,
                None => {
                    gathered = table.lanes(materials(material, &i), materials(material, &j));
                    &gathered
                }
            };
            for (place, row) in rows[..remembered].iter_mut().enumerate() {
                let slopes = slopes.begin::<N>(place, &entries, count);
                *row = with_slopes::<N>(batch.remembered(place, at), slopes);
            }
            let reaction =
                react_by::<N, TURNING>(law, &acting, row, &mut geometry.contact, &mut rows[..remembered], step);
            if writes {
                for (place, row) in rows[..remembered].iter().enumerate() {
                    batch.remember(place, at, Dual::values_of(*row));
                }
                let arms = [geometry.first_arm.value, geometry.second_arm.value];
                put(batch, at, &values_of(&reaction), (arms, needs));
            }
            if reached == 0 {
                continue;
            }
            for (place, row) in rows[..remembered].iter().enumerate() {
                slopes.put::<N>(place, &entries, slopes_of::<N>(*row));
            }
            let Reaction { force, couple, rolling, .. } = reaction;
            moved.press_pairs([&i, &j], (count, reached), force);
            if TURNING {
                let on_i = -(couple * geometry.first_arm) - rolling;
                moved.twist_pairs([&i, &j], count, [on_i, rolling - couple * geometry.second_arm]);
            }
        }
    }
}

/// Writes what the law does to a register's worth of contacts, and the arms of the bodies \[m\]; the last contact of the batch is repeated.
#[inline(always)]
fn put<N: Lane>(batch: &mut Batch, at: usize, reaction: &Reaction<N>, (arms, needs): ([N; 2], Needs)) {
    rows_from(columns(reaction.force), &mut batch.buffer.force, at);
    if !needs.torque {
        return;
    }
    rows_from(columns(reaction.couple), &mut batch.buffer.couple, at);
    batch.buffer.put_arms(at, arms);
    if needs.spin {
        rows_from(columns(reaction.rolling), &mut batch.buffer.rolling, at);
    }
    batch.slide(at, N::bits(reaction.sliding));
}

/// The values of what a law does.
#[inline(always)]
fn values_of<V: Number, S: Slopes<V>>(reaction: &Reaction<Dual<V, S>>) -> Reaction<V> {
    let Reaction { force, couple, rolling, sliding } = *reaction;
    Reaction {
        force: Vector::new(force.x.value, force.y.value, force.z.value),
        couple: Vector::new(couple.x.value, couple.y.value, couple.z.value),
        rolling: Vector::new(rolling.x.value, rolling.y.value, rolling.z.value),
        sliding,
    }
}
