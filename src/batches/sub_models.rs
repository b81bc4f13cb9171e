//! The sub-models of a law, one after another on the columns of a batch.
//!
//! Each sub-model is compiled once for each lane width, whatever it is combined with: sub-models add, they do not
//! multiply. What one hands to the next stands in columns of the buffer, which the first-level cache holds.

use super::gathered::Gathered;
use super::stage::Stage;
use crate::contact::cohesion::TakeCohesion;
use crate::contact::normal::TakeNormal;
use crate::contact::rolling::TakeRolling;
use crate::contact::tangential::TakeTangential;
use crate::contact::{
    Carry, Coefficients, Cohesion, CohesionForm, Contact, Normal, NormalForm, Rolling, Scheme, Switches, Tangential,
};
use crate::lanes::{self, Kernel, Lane, Width};
use std::marker::PhantomData;

/// A sub-model, or several as one, over a batch.
pub(super) type Run = fn(Width, &mut Stage);

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

/// Slip and arms of undeformed bodies, for laws that take them.
pub(super) struct ArmsRun<'a, 'b>(pub(super) &'a mut Stage<'b>);

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

/// What a scheme does before the sub-models, if anything.
pub(super) fn before_sub_models(scheme: Scheme) -> Option<Run> {
    match scheme {
        Scheme::Engine => None,
        Scheme::PredictedNormal => Some(|width, stage| lanes::run(width, ForeseeNormalRun(stage))),
        Scheme::Midway | Scheme::Predicted => Some(|width, stage| lanes::run(width, CarryRun(stage))),
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
