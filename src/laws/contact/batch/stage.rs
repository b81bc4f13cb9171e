//! What sub-models work on, and what one does to a register's worth of contacts.

use super::buffer::Buffer;
use super::{CoefficientRows, Entries, SLIDING};
use crate::base::lanes::{Lane, columns};
use crate::base::number::Vector;
use crate::laws::contact::{
    Booked, Carry, CoefficientPlaces, Coefficients, Contact, Foreseen, HistoryPlaces, NormalForce, NormalForm, Onset,
    Rolling, Switches, Tangential, foresee_normal,
};

/// What the sub-models of a law work on.
pub(crate) struct Stage<'a> {
    /// What the list keeps.
    pub(crate) entries: &'a Entries,
    /// Coefficients of the law.
    pub(crate) table: CoefficientRows<'a>,
    /// The coefficients of all entries, if they are the same.
    pub(crate) uniform: Option<&'a [f64]>,
    /// Where the coefficients of each sub-model stand.
    pub(crate) places: CoefficientPlaces,
    /// Whose each row of the history is.
    pub(crate) history: HistoryPlaces,
    /// Which row behind them is the offset, where bonds suppress contacts.
    pub(crate) offset: usize,
    /// Time since the history was last advanced \[s\].
    pub(crate) step: f64,
    /// Whether bodies touch where they overlap and nowhere else.
    pub(crate) touches: bool,
    /// How dashpots begin.
    pub(crate) onset: Onset,
    /// How often the normal force of each entry counts, and its share of friction, where it is not 1.
    pub(crate) weights: Option<&'a [[f64; 3]]>,
    /// What a book of losses has to know of the law.
    pub(crate) booked: &'a Booked,
    /// The batch.
    pub(crate) buffer: &'a mut Buffer,
}

/// What friction did to a register's worth of contacts.
pub(crate) struct FrictionResult<N: Lane> {
    /// Force on the first body \[N\].
    pub(crate) force: Vector<N>,
    /// What friction remembers now.
    pub(crate) spring: [N; 4],
    /// Which of them slide.
    pub(crate) sliding: N::Mask,
}

impl Stage<'_> {
    /// What a sub-model remembers of a register's worth of entries, in this row; zeros where it remembers nothing.
    ///
    /// # Safety
    /// As for [`Stage::contact`]; the entries are of the list, and the row is that of the sub-model.
    #[inline(always)]
    pub(crate) unsafe fn remembered<N: Lane>(&self, remembers: bool, row: Option<usize>, place: usize) -> [N; 4] {
        match row {
            // SAFETY: the caller's promise; there is a row for each entry.
            Some(row) if remembers => unsafe {
                N::load_rows(self.entries.row(row), self.buffer.history.as_ptr().add(place))
            },
            _ => [N::zero(); 4],
        }
    }

    /// What is kept of a register's worth of suppressed contacts.
    ///
    /// # Safety
    /// As for [`Stage::contact`]; the list keeps offsets.
    #[inline(always)]
    pub(crate) unsafe fn kept_offset<N: Lane>(&self, place: usize) -> [N; 4] {
        // SAFETY: the caller's promise.
        unsafe { self.remembered(true, Some(self.offset), place) }
    }

    /// Remembers it.
    ///
    /// # Safety
    /// As for [`Stage::remembered`]; the entries belong to this piece of the list. A repeated entry is written twice,
    /// with the same.
    #[inline(always)]
    pub(crate) unsafe fn remember<N: Lane>(&self, remembers: bool, row: Option<usize>, values: [N; 4], place: usize) {
        if let (true, Some(row)) = (remembers, row) {
            // SAFETY: the caller's promise; there is a row for each entry.
            unsafe { N::store_rows(values, self.entries.row(row), self.buffer.history.as_ptr().add(place)) };
        }
    }

    /// The contacts of a register's worth of entries, with pair constants if asked for.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most the room of the buffer.
    #[inline(always)]
    pub(crate) unsafe fn contact<N: Lane>(&self, place: usize, has_pair_constant: bool) -> Contact<N> {
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
    pub(crate) unsafe fn press<N: Lane, A: NormalForm>(
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
            let history = self.remembered(remembers, own, place);
            let (normal, history) = A::force(law, switches, contact, roots, history, N::splat(self.step));
            self.remember(remembers, own, history, place);
            normal
        }
    }

    /// The normal force of a register's worth of contacts, as friction sees it.
    ///
    /// # Safety
    /// As for [`Stage::contact`].
    #[inline(always)]
    pub(crate) unsafe fn normal<N: Lane>(&self, place: usize) -> NormalForce<N> {
        // SAFETY: the caller's promise.
        unsafe {
            let mut normal: NormalForce<N> = self.buffer.normal(place);
            if self.history.normal_velocity.is_some() {
                let weight: N = self.buffer.weight(place);
                normal.response.tangential_damping = normal.response.tangential_damping * weight;
            }
            normal
        }
    }

    /// What a tangential model remembers of a register's worth of contacts.
    ///
    /// # Safety
    /// As for [`Stage::contact`].
    #[inline(always)]
    pub(crate) unsafe fn tangential_history<N: Lane, B: Tangential>(&self, place: usize) -> [N; 4] {
        let remembers = B::ACTIVE && B::HISTORY.is_some();
        // SAFETY: the caller's promise.
        unsafe { self.remembered(remembers, self.history.tangential, place) }
    }

    /// Writes force and friction of a register's worth of contacts, of which `history` is remembered. Returns what a book of losses
    /// looks at.
    ///
    /// # Safety
    /// As for [`Stage::press`].
    #[inline(always)]
    pub(crate) unsafe fn rub<N: Lane, B: Tangential, const CARRIES: bool>(
        &mut self,
        place: usize,
        row: &[N],
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        mut history: [N; 4],
    ) -> FrictionResult<N> {
        let mut rubbed = FrictionResult {
            force: contact.normal * normal.force,
            spring: history,
            sliding: N::zero().greater(N::zero()),
        };
        let (remembers, own) = (B::HISTORY.is_some(), self.history.tangential);
        // SAFETY: the caller's promise.
        unsafe {
            if B::ACTIVE {
                let entries = self.buffer.entry.as_ptr().add(place);
                let mut step = N::splat(self.step);
                if CARRIES {
                    (history, step) = (self.buffer.carry(place).spring(contact.normal, history), N::zero());
                }
                let friction = B::force(B::lanes(row), contact, normal, history, step);
                rubbed = FrictionResult {
                    force: rubbed.force + friction.force,
                    spring: friction.history,
                    sliding: friction.sliding,
                };
                let couple = contact.normal.cross(friction.force);
                N::store_block(columns(couple), self.buffer.couple.as_mut_ptr().add(place));
                let mut sliding = N::bits(friction.sliding);
                while sliding != 0 {
                    let lane = sliding.trailing_zeros() as usize;
                    *self.entries.flags.pointer().add(*entries.add(lane) as usize) |= SLIDING;
                    sliding &= sliding - 1;
                }
                self.remember(remembers, own, friction.history, place);
            }
            N::store_block(columns(rubbed.force), self.buffer.force.as_mut_ptr().add(place));
        }
        rubbed
    }

    /// Gives contacts the velocities along the normal that dashpots see, where the scheme predicts them; the weight of γ_t. What is
    /// remembered is the fourth number of `history`, the tangential model's row, if it is `shared`, or that of another row.
    ///
    /// # Safety
    /// As for [`Stage::press`].
    #[inline(always)]
    pub(crate) unsafe fn foresee_normal<N: Lane>(
        &self,
        place: usize,
        shared: bool,
        contact: &mut Contact<N>,
        history: &mut [N; 4],
    ) -> N {
        let HistoryPlaces { normal_velocity: own, seen, .. } = self.history;
        if own.is_none() {
            return N::splat(1.0);
        }
        let step = N::splat(self.step);
        // SAFETY: the caller's promise.
        unsafe {
            let mut row = if shared { *history } else { self.remembered(true, own, place) };
            let Foreseen { middle, weight } = foresee_normal(contact, row[3], self.onset, step);
            row[3] = middle;
            if shared {
                *history = row;
            } else {
                self.remember(true, own, row, place);
            }
            self.remember(true, seen, [contact.normal_velocity, weight, N::splat(1.0), N::zero()], place);
            weight
        }
    }

    /// Writes the rolling torque of a register's worth of contacts, and returns it \[N m\].
    ///
    /// # Safety
    /// As for [`Stage::press`].
    #[inline(always)]
    pub(crate) unsafe fn roll<N: Lane, C: Rolling, const CARRIES: bool>(
        &mut self,
        place: usize,
        row: &[N],
        contact: &Contact<N>,
        normal: &NormalForce<N>,
    ) -> Vector<N> {
        let (remembers, own) = (C::HISTORY.is_some(), self.history.rolling);
        // SAFETY: the caller's promise.
        unsafe {
            let (mut history, mut step) = (self.remembered(remembers, own, place), N::splat(self.step));
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
            self.remember(remembers, own, history, place);
            torque
        }
    }

    /// Writes zero friction, for a law that has torques without it.
    ///
    /// # Safety
    /// As for [`Stage::contact`].
    #[inline(always)]
    pub(crate) unsafe fn leave_couple<N: Lane>(&mut self, place: usize) {
        // SAFETY: the caller's promise.
        unsafe { N::store_block([N::zero(); 4], self.buffer.couple.as_mut_ptr().add(place)) };
    }
}
