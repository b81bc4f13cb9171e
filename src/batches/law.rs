//! Phase 3: the sub-models of a law, one after another on the columns of a batch.
//!
//! Each sub-model is compiled once for each lane width, whatever it is combined with: sub-models add, they do not
//! multiply. What one hands to the next stands in columns of the buffer, which the first-level cache holds. The few laws
//! that are met most are compiled whole beside that ([`FUSED`]), from the same functions in the same order: they keep in
//! registers what the others write and read, and their bits are the same.

use super::buffer::Buffer;
use super::suppressed::Suppressed;
use super::{Entries, Manner};
use crate::batches::coefficients::{CoefficientTable, MOST_COEFFICIENTS};
use crate::contact::cohesion::{self, TakeCohesion, attraction::Attraction};
use crate::contact::normal::{TakeNormal, hertzian::Hertzian, hooke_stiffness::HookeStiffness};
use crate::contact::rolling::{self, TakeRolling, cdt::Cdt};
use crate::contact::tangential::{self, TakeTangential, history::History};
use crate::contact::{
    Carry, CoefficientPlaces, Coefficients, Cohesion, CohesionForm, Contact, HistoryPlaces, Law, LawChoice, Needs,
    Normal, NormalForce, NormalForm, Onset, Rolling, Switches, Tangential,
};
use crate::lanes::{self, Kernel, Lane, Width, columns};
use crate::state::contacts::SLIDING;
use std::any::TypeId;
use std::marker::PhantomData;

/// A contact law and its functions over batches.
pub(crate) struct BatchLaw {
    /// The law of one contact.
    pub law: Law,
    /// What of a contact its sub-models look at.
    pub needs: Needs,
    /// Its sub-models over a batch, in the order in which they work.
    runs: Vec<Run>,
    /// The same where bonds suppress contacts.
    suppressed: Suppressed,
}

/// A sub-model, or several as one, over a batch.
pub(super) type Run = fn(Width, &mut Stage);

impl BatchLaw {
    /// The law that a scene composed.
    pub(crate) fn of(choice: &LawChoice) -> Self {
        let mut law = Self::sub_models(choice);
        let forms = [
            choice.normal.visit(FormOf),
            choice.tangential.visit(FormOf),
            choice.rolling.visit(FormOf),
            choice.cohesion.visit(FormOf),
        ];
        if let Some(fused) = FUSED.iter().map(|fused| fused()).find(|fused| fused.forms == forms)
            && !choice.scheme.carries()
        {
            law.runs = vec![fused.run];
        }
        law
    }

    /// The same, sub-model by sub-model even where the law is compiled whole.
    pub(crate) fn sub_models(choice: &LawChoice) -> Self {
        let law = Law::of(choice);
        assert!(law.places().count <= MOST_COEFFICIENTS, "a law has at most {MOST_COEFFICIENTS} coefficients");
        let needs = law.needs();
        let (mut runs, run_of): (Vec<Run>, _) = (Vec::new(), RunOf { carries: choice.scheme.carries() });
        if law.undeformed_arms() {
            runs.push(|width, stage| lanes::run(width, ArmsRun(stage)));
        }
        if choice.scheme.carries() {
            runs.push(|width, stage| lanes::run(width, CarryRun(stage)));
        }
        runs.push(choice.normal.visit(run_of));
        if law.has_cohesion() {
            runs.push(choice.cohesion.visit(run_of));
        }
        runs.push(choice.tangential.visit(run_of));
        if law.has_rolling() {
            runs.push(choice.rolling.visit(run_of));
        }
        Self { suppressed: Suppressed::of(choice, &law), law, needs, runs }
    }

    /// Whether it is compiled whole.
    #[cfg(test)]
    pub(super) fn is_fused(&self) -> bool {
        self.runs.len() == 1
    }

    /// What is done with a batch of contacts in this manner, one after another, and what of the contacts that looks at.
    pub(super) fn runs(&self, manner: Option<Manner>) -> (Needs, &[Run]) {
        match manner {
            None | Some(Manner::Open) => (self.needs, &self.runs),
            Some(Manner::Bonded) => (Needs { spin: false, ..self.needs }, &self.suppressed.bonded),
            Some(Manner::Released) => (self.needs, &self.suppressed.released),
            Some(Manner::Followed) => (Needs::NONE, &self.suppressed.followed),
        }
    }
}

/// Goes from the name of a sub-model to what it does to a batch.
#[derive(Clone, Copy)]
pub(super) struct RunOf {
    /// Whether springs are carried at mid-step.
    pub(super) carries: bool,
}

impl TakeNormal for RunOf {
    type Output = Run;
    fn take<M: Normal>(self, _keys: &M::Keys) -> Run {
        |width, stage| lanes::run(width, NormalRun::<M::Form>(stage, PhantomData))
    }
}

impl TakeCohesion for RunOf {
    type Output = Run;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> Run {
        |width, stage| lanes::run(width, CohesionRun::<M::Form>(stage, PhantomData))
    }
}

impl TakeTangential for RunOf {
    type Output = Run;
    fn take<M: Tangential>(self, _keys: &M::Keys) -> Run {
        match self.carries && M::HAS_SPRING {
            false => |width, stage| lanes::run(width, TangentialRun::<M, false>(stage, PhantomData)),
            true => |width, stage| lanes::run(width, TangentialRun::<M, true>(stage, PhantomData)),
        }
    }
}

impl TakeRolling for RunOf {
    type Output = Run;
    fn take<M: Rolling>(self, _keys: &M::Keys) -> Run {
        match self.carries && M::HISTORY.is_some() {
            false => |width, stage| lanes::run(width, RollingRun::<M, false>(stage, PhantomData)),
            true => |width, stage| lanes::run(width, RollingRun::<M, true>(stage, PhantomData)),
        }
    }
}

/// Goes from the name of a sub-model to the type of what it computes.
struct FormOf;

impl TakeNormal for FormOf {
    type Output = TypeId;
    fn take<M: Normal>(self, _keys: &M::Keys) -> TypeId {
        TypeId::of::<M::Form>()
    }
}

impl TakeTangential for FormOf {
    type Output = TypeId;
    fn take<M: Tangential>(self, _keys: &M::Keys) -> TypeId {
        TypeId::of::<M>()
    }
}

impl TakeRolling for FormOf {
    type Output = TypeId;
    fn take<M: Rolling>(self, _keys: &M::Keys) -> TypeId {
        TypeId::of::<M>()
    }
}

impl TakeCohesion for FormOf {
    type Output = TypeId;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> TypeId {
        TypeId::of::<M::Form>()
    }
}

/// A law that is compiled whole.
struct Fused {
    /// What its normal, tangential, rolling and cohesion models compute.
    forms: [TypeId; 4],
    /// The law on a batch.
    run: Run,
}

/// The law of these four.
fn fused<A: NormalForm, B: Tangential, C: Rolling, D: CohesionForm>() -> Fused {
    Fused {
        forms: [TypeId::of::<A>(), TypeId::of::<B>(), TypeId::of::<C>(), TypeId::of::<D>()],
        run: |width, stage| lanes::run(width, WholeRun::<A, B, C, D>(stage, PhantomData)),
    }
}

/// Laws that are compiled whole: those that scenes use most, where that saves 0.3 to 1.6 ns a contact of the 1 to 12 ns that
/// sub-models take one after another (this phase alone, 64 contacts in the cache, least of nine runs in each lane width).
/// `hooke` with `history` is not among them: it saves nothing.
const FUSED: &[fn() -> Fused] = &[
    fused::<Hertzian, History, rolling::none::None, cohesion::none::None>,
    fused::<Hertzian, History, Cdt, cohesion::none::None>,
    fused::<Hertzian, History, Cdt, Attraction>,
    fused::<Hertzian, tangential::none::None, rolling::none::None, cohesion::none::None>,
    fused::<HookeStiffness, History, rolling::none::None, cohesion::none::None>,
    fused::<HookeStiffness, tangential::none::None, rolling::none::None, cohesion::none::None>,
];

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

    /// Those of a register's worth of entries.
    ///
    /// # Safety
    /// `place` + [`Lane::WIDTH`] is at most the room of the buffer, and the rows there are of the table.
    #[inline(always)]
    pub(super) unsafe fn at(&mut self, stage: &Stage, place: usize) -> &[N] {
        if stage.uniform.is_none() {
            let mut k = 0;
            while k < self.count {
                // SAFETY: the caller's promise; a row has the coefficients of all sub-models.
                self.numbers[k] = unsafe { stage.table.gather(self.from + k, stage.buffer.row.as_ptr().add(place)) };
                k += 1;
            }
        }
        &self.numbers[..self.count]
    }
}

impl Stage<'_> {
    /// What a sub-model remembers of a register's worth of entries; zeros where it remembers nothing.
    ///
    /// # Safety
    /// The entries are of the list; `place` is that of the sub-model.
    #[inline(always)]
    unsafe fn remembered<N: Lane>(&self, remembers: bool, place: Option<usize>, entries: *const u32) -> [N; 4] {
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
    unsafe fn remember<N: Lane>(&self, remembers: bool, place: Option<usize>, row: [N; 4], entries: *const u32) {
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
    unsafe fn press<N: Lane, A: NormalForm>(
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
    unsafe fn rub<N: Lane, B: Tangential, const CARRIES: bool>(
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
    unsafe fn roll<N: Lane, C: Rolling, const CARRIES: bool>(
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

    /// Writes that there is no friction, for a law that has torque all the same.
    ///
    /// # Safety
    /// As for [`Stage::contact`].
    #[inline(always)]
    unsafe fn leave_couple<N: Lane>(&mut self, place: usize) {
        // SAFETY: the caller's promise.
        unsafe { N::store_block([N::zero(); 4], self.buffer.couple.as_mut_ptr().add(place)) };
    }
}

/// Slip and arms of undeformed bodies, for laws that take them.
struct ArmsRun<'a, 'b>(&'a mut Stage<'b>);

impl Kernel for ArmsRun<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let mut done = 0;
        while done < self.0.buffer.ready {
            // SAFETY: there is room for a register behind the batch.
            unsafe { self.0.buffer.undeform_arms::<N>(done) };
            done += N::WIDTH;
        }
    }
}

/// What a scheme does before the sub-models: how contacts were carried, and the velocities that dashpots see.
pub(super) struct CarryRun<'a, 'b>(pub(super) &'a mut Stage<'b>);

impl Kernel for CarryRun<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let (step, rates) = (N::splat(stage.step), stage.history.rates);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: the batch is filled up to a whole register, for which there is room; its entries belong to this
            // piece of the list.
            unsafe {
                let mut contact = stage.contact(done, false);
                let carry = Carry::of(&contact, step, stage.touches);
                if rates.is_some() {
                    let entries = stage.buffer.entry.as_ptr().add(done);
                    let row = stage.remembered(true, rates, entries);
                    let row = carry.foresee(&mut contact, row, step);
                    stage.remember(true, rates, row, entries);
                }
                carry.weigh(&mut contact, stage.onset, step);
                stage.buffer.put_carry(done, &carry, &contact);
            }
            done += N::WIDTH;
        }
    }
}

/// A normal model over a batch.
struct NormalRun<'a, 'b, A>(&'a mut Stage<'b>, PhantomData<fn() -> A>);

impl<A: NormalForm> Kernel for NormalRun<'_, '_, A> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, 0, A::COUNT + Switches::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: the batch is filled up to a whole register, for which there is room; its entries belong to this
            // piece of the list; so in the other loops.
            unsafe {
                let row = coefficients.at(stage, done);
                let contact = stage.contact(done, A::HAS_PAIR_CONSTANT);
                let roots = A::roots(contact.overlap, contact.radius, contact.mass);
                let normal = stage.press::<N, A>(done, row, &contact, roots);
                stage.buffer.put_normal(done, &normal);
            }
            done += N::WIDTH;
        }
    }
}

/// A cohesion model over a batch.
struct CohesionRun<'a, 'b, D>(&'a mut Stage<'b>, PhantomData<fn() -> D>);

impl<D: CohesionForm> Kernel for CohesionRun<'_, '_, D> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, stage.places.cohesion, D::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let law = D::lanes(coefficients.at(stage, done));
                let contact = stage.contact(done, false);
                let mut normal = stage.buffer.normal(done);
                D::add(law, D::force(law, &contact), &mut normal);
                stage.buffer.put_force(done, &normal);
            }
            done += N::WIDTH;
        }
    }
}

/// A tangential model over a batch; it writes the whole force.
struct TangentialRun<'a, 'b, B, const CARRIES: bool>(&'a mut Stage<'b>, PhantomData<fn() -> B>);

impl<B: Tangential, const CARRIES: bool> Kernel for TangentialRun<'_, '_, B, CARRIES> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, stage.places.tangential, B::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let row = coefficients.at(stage, done);
                let (contact, normal) = (stage.contact(done, false), stage.buffer.normal(done));
                stage.rub::<N, B, CARRIES>(done, row, &contact, &normal);
                if !B::ACTIVE {
                    stage.leave_couple::<N>(done);
                }
            }
            done += N::WIDTH;
        }
    }
}

/// A rolling model over a batch.
struct RollingRun<'a, 'b, C, const CARRIES: bool>(&'a mut Stage<'b>, PhantomData<fn() -> C>);

impl<C: Rolling, const CARRIES: bool> Kernel for RollingRun<'_, '_, C, CARRIES> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, stage.places.rolling, C::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let row = coefficients.at(stage, done);
                let (contact, normal) = (stage.contact(done, false), stage.buffer.normal(done));
                stage.roll::<N, C, CARRIES>(done, row, &contact, &normal);
            }
            done += N::WIDTH;
        }
    }
}

/// A whole law over a batch. Roots, for which what follows would wait, are found a register ahead.
struct WholeRun<'a, 'b, A, B, C, D>(&'a mut Stage<'b>, PhantomData<(A, B, C, D)>);

impl<A: NormalForm, B: Tangential, C: Rolling, D: CohesionForm> Kernel for WholeRun<'_, '_, A, B, C, D> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let after_normal = A::COUNT + Switches::COUNT;
        let count = after_normal + B::COUNT + C::COUNT + D::COUNT;
        let mut coefficients = Gathered::<N>::of(stage, 0, count);
        let mut done = 0;
        if A::HAS_ROOTS {
            // SAFETY: there is room for a register behind the batch; so below.
            unsafe { stage.buffer.find_roots::<N, A>(0) };
        }
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let row = coefficients.at(stage, done);
                let contact = stage.contact(done, A::HAS_PAIR_CONSTANT);
                let mut roots = [N::zero(); 2];
                if A::HAS_ROOTS {
                    stage.buffer.find_roots::<N, A>(done + N::WIDTH);
                    roots = stage.buffer.roots(done);
                }
                let mut normal = stage.press::<N, A>(done, row, &contact, roots);
                if D::ACTIVE {
                    let law = D::lanes(&row[after_normal + B::COUNT + C::COUNT..]);
                    D::add(law, D::force(law, &contact), &mut normal);
                }
                stage.rub::<N, B, false>(done, &row[after_normal..], &contact, &normal);
                if C::ACTIVE && !B::ACTIVE {
                    stage.leave_couple::<N>(done);
                }
                if C::ACTIVE {
                    stage.roll::<N, C, false>(done, &row[after_normal + B::COUNT..], &contact, &normal);
                }
            }
            done += N::WIDTH;
        }
    }
}
