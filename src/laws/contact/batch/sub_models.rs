//! The sub-models of a law, one after another on the columns of a batch.

use super::gathered::Gathered;
use super::stage::Stage;
use super::{Run, SLIDING};
use crate::base::lanes::{self, Kernel, Lane, Width};
use crate::laws::contact::{
    Carry, Coefficients, CohesionForm, Contact, NormalForm, Rolling, Scheme, Switches, Tangential, pressing_force,
};
use std::marker::PhantomData;

/// Slip and arms of undeformed bodies, for laws that take them.
pub(crate) fn undeform_arms(width: Width, stage: &mut Stage) {
    lanes::run(width, ArmsRun(stage));
}

/// What a scheme does before the sub-models, if anything.
pub(crate) fn before_sub_models(scheme: Scheme) -> Option<Run> {
    match scheme {
        Scheme::Engine => None,
        Scheme::PredictedNormal => Some(|width, stage| lanes::run(width, ForeseeNormalRun(stage))),
        Scheme::Midway | Scheme::Predicted => Some(|width, stage| lanes::run(width, CarryRun(stage))),
    }
}

/// A normal model over a batch. OFFSET: the force is taken from the overlap beyond an offset, with the stiffness and the damping of the
/// whole overlap.
pub(crate) fn normal<A: NormalForm, const OFFSET: bool>(width: Width, stage: &mut Stage) {
    lanes::run(width, NormalRun::<A, OFFSET>(stage, PhantomData));
}

/// A cohesion model over a batch. OFFSET: less what it holds at the offset already.
pub(crate) fn cohesion<D: CohesionForm, const OFFSET: bool>(width: Width, stage: &mut Stage) {
    lanes::run(width, CohesionRun::<D, OFFSET>(stage, PhantomData));
}

/// A tangential model over a batch; it writes the whole force. CARRIES: springs are carried at mid-step; so below.
pub(crate) fn tangential<B: Tangential, const CARRIES: bool>(width: Width, stage: &mut Stage) {
    lanes::run(width, TangentialRun::<B, CARRIES>(stage, PhantomData));
}

/// A rolling model over a batch.
pub(crate) fn rolling<C: Rolling, const CARRIES: bool>(width: Width, stage: &mut Stage) {
    lanes::run(width, RollingRun::<C, CARRIES>(stage, PhantomData));
}

/// Leaves of contacts whose bodies are apart what a cohesion model does beyond touch: other forces and what is remembered of them end
/// at touch.
pub(crate) fn part(_width: Width, stage: &mut Stage) {
    let (entries, of_touch) = (stage.entries, stage.history);
    for place in 0..stage.buffer.ready {
        if stage.buffer.part(place) {
            let entry = stage.buffer.entry[place] as usize;
            // SAFETY: the entries belong to this piece of the list; there is a flag and a row for each.
            unsafe {
                *entries.flags.pointer().add(entry) &= !SLIDING;
                let history = entries.history(entry);
                of_touch.of_touch().for_each(|row| history[row] = [0.0; 4]);
            }
        }
    }
}

/// [`undeform_arms`]
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

/// How contacts were carried, and the velocities that dashpots see.
struct CarryRun<'a, 'b>(&'a mut Stage<'b>);

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
                let mut along = [contact.normal_velocity, N::zero()];
                if rates.is_some() {
                    let before = stage.remembered(true, rates, done);
                    let row = carry.foresee(&mut contact, before, step);
                    along = [row[0], before[0]];
                    stage.remember(true, rates, row, done);
                }
                carry.weigh(&mut contact, stage.onset, step, along);
                let seen = [contact.normal_velocity, contact.slip.x, contact.slip.y, contact.slip.z];
                stage.remember(true, stage.history.seen, seen, done);
                stage.buffer.put_carry(done, &carry, &contact);
            }
            done += N::WIDTH;
        }
    }
}

/// The velocities along the normal that dashpots see.
struct ForeseeNormalRun<'a, 'b>(&'a mut Stage<'b>);

impl Kernel for ForeseeNormalRun<'_, '_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let mut contact: Contact<N> = stage.contact(done, false);
                let weight = stage.foresee_normal(done, false, &mut contact, &mut [N::zero(); 4]);
                stage.buffer.put_foreseen(done, contact.normal_velocity, weight);
            }
            done += N::WIDTH;
        }
    }
}

/// [`normal`]
struct NormalRun<'a, 'b, A, const OFFSET: bool>(&'a mut Stage<'b>, PhantomData<fn() -> A>);

impl<A: NormalForm, const OFFSET: bool> Kernel for NormalRun<'_, '_, A, OFFSET> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, 0, A::COUNT + Switches::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: the batch is filled up to a whole register, for which there is room; its entries belong to this
            // piece of the list, which keeps offsets where they are asked for; so in the other loops.
            unsafe {
                let row = coefficients.at(stage, done);
                let contact = stage.contact(done, A::HAS_PAIR_CONSTANT);
                let roots = A::roots(contact.overlap, contact.radius, contact.mass);
                let normal = if OFFSET {
                    let [.., offset] = stage.kept_offset::<N>(done);
                    let offset = offset.min(contact.overlap);
                    let pressing = contact.overlap - offset;
                    stage.buffer.put_offset(done, [offset, pressing]);
                    let response = A::response_at(A::lanes(row), &contact, roots);
                    pressing_force(response, Switches::lanes(&row[A::COUNT..]), pressing, contact.normal_velocity)
                } else {
                    stage.press::<N, A>(done, row, &contact, roots)
                };
                stage.buffer.put_normal(done, &normal);
            }
            done += N::WIDTH;
        }
    }
}

/// [`cohesion`]
struct CohesionRun<'a, 'b, D, const OFFSET: bool>(&'a mut Stage<'b>, PhantomData<fn() -> D>);

impl<D: CohesionForm, const OFFSET: bool> Kernel for CohesionRun<'_, '_, D, OFFSET> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let (remembers, own) = (D::HISTORY.is_some(), stage.history.cohesion);
        let mut coefficients = Gathered::<N>::of(stage, stage.places.cohesion, D::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let law = D::lanes(coefficients.at(stage, done));
                let contact = stage.contact(done, D::BEYOND_TOUCH);
                let mut normal = stage.buffer.normal(done);
                if OFFSET {
                    let before = stage.buffer.contact_at_offset(done);
                    D::add(law, D::force(law, &contact) - D::force(law, &before), &mut normal);
                } else {
                    let history = stage.remembered(remembers, own, done);
                    if D::BEYOND_TOUCH {
                        normal = normal.in_touch(contact.overlap);
                        stage.buffer.put_normal(done, &normal);
                    }
                    let (pull, history) = D::pull(law, &contact, history, N::splat(stage.step));
                    stage.remember(remembers, own, history, done);
                    D::add(law, pull, &mut normal);
                }
                stage.buffer.put_force(done, &normal);
            }
            done += N::WIDTH;
        }
    }
}

/// [`tangential`]
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
                let (contact, normal) = (stage.contact(done, false), stage.normal(done));
                let before = stage.tangential_history::<N, B>(done);
                stage.rub::<N, B, CARRIES>(done, row, &contact, &normal, before);
                if !B::ACTIVE {
                    stage.leave_couple::<N>(done);
                }
            }
            done += N::WIDTH;
        }
    }
}

/// [`rolling`]
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
