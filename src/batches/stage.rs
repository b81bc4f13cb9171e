//! What sub-models work on, and what one does to a register's worth of contacts.

use super::Entries;
use super::buffer::Buffer;
use super::coefficients::{CoefficientTable, MOST_COEFFICIENTS};
use crate::contact::{
    Booked, Carry, CoefficientPlaces, Coefficients, Contact, HistoryPlaces, NormalForce, NormalForm, Onset, Rolling,
    Switches, Tangential,
};
use crate::lanes::{Lane, columns};
use crate::state::contacts::SLIDING;

/// What the sub-models of a law work on.
pub(super) struct Stage<'a> {
    /// What the list keeps.
    pub(super) entries: &'a Entries,
    /// Coefficients of the law.
    pub(super) table: &'a CoefficientTable,
    /// The coefficients of all entries, if they are the same.
    pub(super) uniform: Option<&'a [f64]>,
    /// Where the coefficients of each sub-model stand.
    pub(super) places: CoefficientPlaces,
    /// Whose each row of the history is.
    pub(super) history: HistoryPlaces,
    /// Which row behind them is the offset, where bonds suppress contacts.
    pub(super) offset: usize,
    /// Time since the history was last advanced \[s\].
    pub(super) step: f64,
    /// Whether bodies touch where they overlap and nowhere else.
    pub(super) touches: bool,
    /// How dashpots begin.
    pub(super) onset: Onset,
    /// How often the normal force of each entry counts, and its share of friction, where it is not 1.
    pub(super) weights: Option<&'a [[f64; 2]]>,
    /// What a book of losses has to know of the law.
    pub(super) booked: &'a Booked,
    /// The batch.
    pub(super) buffer: &'a mut Buffer,
}

/// Coefficients in lanes: some that stand side by side in the rows of the law.
pub(super) struct Gathered<N> {
    /// The numbers.
    numbers: [N; MOST_COEFFICIENTS],
    /// Where the first of them stands in a row.
    from: usize,
    /// How many there are.
    count: usize,
}

impl<N: Lane> Gathered<N> {
    /// Those of a stage, if they are the same for all entries; otherwise room for them.
    #[inline(always)]
    pub(super) fn of(stage: &Stage, from: usize, count: usize) -> Self {
        let mut numbers = [N::zero(); MOST_COEFFICIENTS];
        if let Some(row) = stage.uniform {
            let mut k = 0;
            while k < count {
                numbers[k] = N::splat(row[from + k]);
                k += 1;
            }
        }
        Self { numbers, from, count }
    }

    /// Those of a register's worth of entries; behind them zeros, so that the compiler knows how many numbers there are.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most the room of the buffer, and the rows there are of the table.
    #[inline(always)]
    pub(super) unsafe fn at(&mut self, stage: &Stage, place: usize) -> &[N; MOST_COEFFICIENTS] {
        if stage.uniform.is_none() {
            let mut k = 0;
            while k < self.count {
                // SAFETY: the caller's promise; a row has the coefficients of all sub-models.
                self.numbers[k] = unsafe { stage.table.gather(self.from + k, stage.buffer.row.as_ptr().add(place)) };
                k += 1;
            }
        }
        &self.numbers
    }
}

impl Stage<'_> {
    /// What a sub-model remembers of a register's worth of entries; zeros where it remembers nothing.
    ///
    /// # Safety
    /// The entries are of the list; `place` is that of the sub-model.
    #[inline(always)]
    pub(super) unsafe fn remembered<N: Lane>(
        &self,
        remembers: bool,
        place: Option<usize>,
        entries: *const u32,
    ) -> [N; 4] {
        match place {
            // SAFETY: the caller's promise; there is a row for each entry.
            Some(place) if remembers => unsafe { N::load_rows(self.entries.history[place].pointer(), entries) },
            _ => [N::zero(); 4],
        }
    }

    /// What is kept of a register's worth of suppressed contacts.
    ///
    /// # Safety
    /// As for [`Stage::contact`]; the list keeps offsets.
    #[inline(always)]
    pub(super) unsafe fn kept_offset<N: Lane>(&self, place: usize) -> [N; 4] {
        // SAFETY: the caller's promise; there is a row for each entry.
        unsafe { N::load_rows(self.entries.history[self.offset].pointer(), self.buffer.entry.as_ptr().add(place)) }
    }

    /// Remembers it.
    ///
    /// # Safety
    /// As for [`Stage::remembered`]; the entries belong to this piece of the list. A repeated entry is written twice,
    /// with the same.
    #[inline(always)]
    pub(super) unsafe fn remember<N: Lane>(
        &self,
        remembers: bool,
        place: Option<usize>,
        row: [N; 4],
        entries: *const u32,
    ) {
        if let (true, Some(place)) = (remembers, place) {
            // SAFETY: the caller's promise; there is a row for each entry.
            unsafe { N::store_rows(row, self.entries.history[place].pointer(), entries) };
        }
    }

    /// The contacts of a register's worth of entries, with pair constants if asked for.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most the room of the buffer.
    #[inline(always)]
    pub(super) unsafe fn contact<N: Lane>(&self, place: usize, has_pair_constant: bool) -> Contact<N> {
        // SAFETY: the caller's promise; each entry has a pair constant where the law has one.
        unsafe {
            let entries = self.buffer.entry.as_ptr().add(place);
            let constant = match has_pair_constant {
                true => N::gather(self.entries.pair_constant.pointer(), entries, 1),
                false => N::zero(),
            };
            self.buffer.contact(place, constant)
        }
    }

    /// The normal force of a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Stage::contact`]; the entries belong to this piece of the list.
    #[inline(always)]
    pub(super) unsafe fn press<N: Lane, A: NormalForm>(
        &self,
        place: usize,
        row: &[N],
        contact: &Contact<N>,
        roots: [N; 2],
    ) -> NormalForce<N> {
        let (law, switches) = (A::lanes(row), Switches::lanes(&row[A::COUNT..]));
        let (remembers, own) = (A::HISTORY.is_some(), self.history.normal);
        // SAFETY: the caller's promise.
        unsafe {
            let entries = self.buffer.entry.as_ptr().add(place);
            let history = self.remembered(remembers, own, entries);
            let (normal, history) = A::force(law, switches, contact, roots, history, N::splat(self.step));
            self.remember(remembers, own, history, entries);
            normal
        }
    }

    /// Writes force and friction of a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Stage::press`].
    #[inline(always)]
    pub(super) unsafe fn rub<N: Lane, B: Tangential, const CARRIES: bool>(
        &mut self,
        place: usize,
        row: &[N],
        contact: &Contact<N>,
        normal: &NormalForce<N>,
    ) {
        let mut force = contact.normal * normal.force;
        let (remembers, own) = (B::HISTORY.is_some(), self.history.tangential);
        // SAFETY: the caller's promise.
        unsafe {
            if B::ACTIVE {
                let entries = self.buffer.entry.as_ptr().add(place);
                let (mut history, mut step) = (self.remembered(remembers, own, entries), N::splat(self.step));
                if CARRIES {
                    (history, step) = (self.buffer.carry(place).spring(contact.normal, history), N::zero());
                }
                let friction = B::force(B::lanes(row), contact, normal, history, step);
                force += friction.force;
                let couple = contact.normal.cross(friction.force);
                N::store_block(columns(couple), self.buffer.couple.as_mut_ptr().add(place));
                let mut sliding = N::bits(friction.sliding);
                while sliding != 0 {
                    let lane = sliding.trailing_zeros() as usize;
                    *self.entries.flags.pointer().add(*entries.add(lane) as usize) |= SLIDING;
                    sliding &= sliding - 1;
                }
                self.remember(remembers, own, friction.history, entries);
            }
            N::store_block(columns(force), self.buffer.force.as_mut_ptr().add(place));
        }
    }

    /// Writes the rolling torque of a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Stage::press`].
    #[inline(always)]
    pub(super) unsafe fn roll<N: Lane, C: Rolling, const CARRIES: bool>(
        &mut self,
        place: usize,
        row: &[N],
        contact: &Contact<N>,
        normal: &NormalForce<N>,
    ) {
        let (remembers, own) = (C::HISTORY.is_some(), self.history.rolling);
        // SAFETY: the caller's promise.
        unsafe {
            let entries = self.buffer.entry.as_ptr().add(place);
            let (mut history, mut step) = (self.remembered(remembers, own, entries), N::splat(self.step));
            let (mut contact, mut pressed) = (*contact, *normal);
            if CARRIES {
                let carry: Carry<N> = self.buffer.carry(place);
                pressed = carry.mean_stiffness(normal, history[3]);
                history = carry.torque(contact.normal, history);
                (contact.relative_spin, step) =
                    (carry.to_end(contact.normal, contact.relative_spin), step * carry.share);
            }
            let (torque, mut history) = C::torque(C::lanes(row), &contact, &pressed, history, step);
            if CARRIES {
                history[3] = normal.response.normal_stiffness;
            }
            N::store_block(columns(torque), self.buffer.rolling.as_mut_ptr().add(place));
            self.remember(remembers, own, history, entries);
        }
    }

    /// Writes zero friction, for a law that has torques without it.
    ///
    /// # Safety
    /// As for [`Stage::contact`].
    #[inline(always)]
    pub(super) unsafe fn leave_couple<N: Lane>(&mut self, place: usize) {
        // SAFETY: the caller's promise.
        unsafe { N::store_block([N::zero(); 4], self.buffer.couple.as_mut_ptr().add(place)) };
    }
}
