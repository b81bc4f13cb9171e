//! Phase 3 for contacts that a bond suppresses or has suppressed: the force is taken from the overlap beyond an offset, and
//! friction sees it even where it does not act. Stiffness and damping are those of the whole overlap.
//!
//! While bonded, the overlap becomes the offset. Afterwards what goes beyond the offset presses, and the offset shrinks with
//! the overlap: nothing jumps when a bond breaks.

use super::buffer::Buffer;
use super::gathered::Gathered;
use super::losses;
use super::stage::Stage;
use super::sub_models::{Run, RunOf, before_sub_models};
use crate::contact::cohesion::TakeCohesion;
use crate::contact::normal::TakeNormal;
use crate::contact::{
    Booked, Coefficients, Cohesion, CohesionForm, Law, LawChoice, Normal, NormalForm, Switches, pressing_force,
};
use crate::lanes::{self, Kernel, Lane};
use std::marker::PhantomData;

/// Sub-models over a batch of suppressed contacts, in the order in which they work.
#[derive(Default)]
pub(super) struct Suppressed {
    /// While a bond suppresses the normal force.
    pub(super) bonded: Vec<Run>,
    /// When the bond is gone, and the normal force is taken from an offset.
    pub(super) released: Vec<Run>,
    /// Where nothing acts, and the offset is followed.
    pub(super) followed: Vec<Run>,
}

impl Suppressed {
    /// Those of a law.
    pub(super) fn of(choice: &LawChoice, law: &Law) -> Self {
        if !law.takes_offset() {
            return Self::default();
        }
        let (mut begin, run_of): (Vec<Run>, _) = (Vec::new(), RunOf { carries: choice.scheme.carries() });
        begin.extend(before_sub_models(choice.scheme));
        begin.push(choice.normal.visit(RunBeyond));
        if law.has_cohesion() {
            begin.push(choice.cohesion.visit(RunBeyond));
        }
        let friction = choice.tangential.visit(run_of);
        let bonded = [&begin[..], &[|_, stage| stage.buffer.mute(), friction, |_, stage| keep(stage, true)]].concat();
        let mut released = [&begin[..], &[friction]].concat();
        if law.has_rolling() {
            released.push(|_, stage| stage.buffer.press());
            released.push(choice.rolling.visit(run_of));
        }
        released.push(|_, stage| keep(stage, false));
        Self { bonded, released, followed: vec![|_, stage| follow(stage)] }
    }
}

impl Suppressed {
    /// Books what contacts lose, too.
    pub(super) fn book(&mut self, booked: &Booked) {
        let keep = booked.keeps_before().then_some(losses::keep_before as Run);
        for (runs, book) in
            [(&mut self.bonded, losses::book_bonded as Run), (&mut self.released, losses::book_released)]
        {
            if !runs.is_empty() {
                runs.splice(0..0, keep);
                runs.push(book);
            }
        }
    }
}

/// Goes from the name of a sub-model to what it does to a batch of suppressed contacts.
struct RunBeyond;

impl TakeNormal for RunBeyond {
    type Output = Run;
    fn take<M: Normal>(self, _keys: &M::Keys) -> Run {
        |width, stage| lanes::run(width, NormalBeyond::<M::Form>(stage, PhantomData))
    }
}

impl TakeCohesion for RunBeyond {
    type Output = Run;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> Run {
        |width, stage| lanes::run(width, CohesionBeyond::<M::Form>(stage, PhantomData))
    }
}

/// A normal model from an offset.
struct NormalBeyond<'a, 'b, A>(&'a mut Stage<'b>, PhantomData<fn() -> A>);

impl<A: NormalForm> Kernel for NormalBeyond<'_, '_, A> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, 0, A::COUNT + Switches::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: the batch is filled up to a whole register, for which there is room; its entries belong to this
            // piece of the list, which keeps offsets.
            unsafe {
                let row = coefficients.at(stage, done);
                let (law, switches) = (A::lanes(row), Switches::lanes(&row[A::COUNT..]));
                let contact = stage.contact(done, A::HAS_PAIR_CONSTANT);
                let [.., offset] = stage.kept_offset::<N>(done);
                let offset = offset.min(contact.overlap);
                let pressing = contact.overlap - offset;
                let response = A::response(law, &contact);
                stage.buffer.put_normal(done, &pressing_force(response, switches, pressing, contact.normal_velocity));
                stage.buffer.put_offset(done, [offset, pressing]);
            }
            done += N::WIDTH;
        }
    }
}

/// An attraction, less what it holds at the offset already.
struct CohesionBeyond<'a, 'b, D>(&'a mut Stage<'b>, PhantomData<fn() -> D>);

impl<D: CohesionForm> Kernel for CohesionBeyond<'_, '_, D> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, stage.places.cohesion, D::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let law = D::lanes(coefficients.at(stage, done));
                let (contact, before) = (stage.contact(done, false), stage.buffer.contact_at_offset(done));
                let mut normal = stage.buffer.normal(done);
                D::add(law, D::force(law, &contact) - D::force(law, &before), &mut normal);
                stage.buffer.put_force(done, &normal);
            }
            done += N::WIDTH;
        }
    }
}

/// Keeps the force on the first body and, as time goes on, the offset.
fn keep(stage: &mut Stage, bonded: bool) {
    let Stage { buffer, step, .. } = stage;
    let buffer: &Buffer = buffer;
    for place in 0..buffer.ready {
        // SAFETY: the entries belong to this piece of the list, which keeps offsets.
        let row = unsafe { &mut stage.entries.history(buffer.entry[place] as usize)[stage.offset] };
        let [x, y, z, _] = buffer.force[place];
        let [overlap, offset] = buffer.overlap_and_offset(place);
        let next = if bonded { overlap } else { offset };
        *row = [x, y, z, if *step > 0.0 { next } else { row[3] }];
    }
}

/// Keeps the overlap as the offset, where nothing acts.
fn follow(stage: &mut Stage) {
    for place in 0..stage.buffer.ready {
        let [overlap, _] = stage.buffer.overlap_and_offset(place);
        if stage.step > 0.0 {
            // SAFETY: as above.
            let row = unsafe { &mut stage.entries.history(stage.buffer.entry[place] as usize)[stage.offset] };
            *row = [0.0, 0.0, 0.0, overlap];
        }
    }
}
