//! What contacts conduct, over a batch: the circle of contact by the normal model, then the conductance by the heat model.

use super::gathered::Gathered;
use super::stage::Stage;
use super::{CoefficientRows, Run};
use crate::base::lanes::{self, Kernel, Lane, Width};
use crate::laws::contact::{Heat, NormalForm};
use std::marker::PhantomData;

/// A heat model beside the normal model of its law.
#[derive(Clone, Copy)]
pub(crate) struct Conducting<'a> {
    /// Finds the circles of contact, then the conductances.
    pub(crate) runs: [Run; 2],
    /// Coefficients of the heat model.
    pub(crate) table: CoefficientRows<'a>,
    /// Those of all entries, if they are the same.
    pub(crate) uniform: Option<&'a [f64]>,
    /// Whether bodies that have touched conduct as long as they hold together.
    pub(crate) beyond_touch: bool,
}

impl Conducting<'_> {
    /// Finds the conductances of a batch, as it was met.
    pub(crate) fn find(&self, width: Width, mut stage: Stage) {
        let [radius, conductance] = self.runs;
        radius(width, &mut stage);
        let (table, uniform) = (self.table, self.uniform);
        conductance(width, &mut Stage { table, uniform, touches: !self.beyond_touch, ..stage });
    }
}

/// The circles of contact by a normal model.
pub(crate) fn contact_radius<A: NormalForm>(width: Width, stage: &mut Stage) {
    lanes::run(width, RadiusRun::<A>(stage, PhantomData));
}

/// Conductances by a heat model, from the circles of contact.
pub(crate) fn conductance<H: Heat>(width: Width, stage: &mut Stage) {
    lanes::run(width, ConductanceRun::<H>(stage, PhantomData));
}

/// [`contact_radius`]
struct RadiusRun<'a, 'b, A>(&'a mut Stage<'b>, PhantomData<A>);

impl<A: NormalForm> Kernel for RadiusRun<'_, '_, A> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, 0, A::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: the batch is filled up to a whole register, for which there is room.
            unsafe {
                let law = A::lanes(coefficients.at(stage, done));
                let [overlap, radius] = stage.buffer.depths(done);
                stage.buffer.put_conductance(done, A::contact_radius(law, overlap, radius));
            }
            done += N::WIDTH;
        }
    }
}

/// [`conductance`]
struct ConductanceRun<'a, 'b, H>(&'a mut Stage<'b>, PhantomData<H>);

impl<H: Heat> Kernel for ConductanceRun<'_, '_, H> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let mut coefficients = Gathered::<N>::of(stage, 0, H::COUNT);
        let mut done = 0;
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let law = H::lanes(coefficients.at(stage, done));
                let spot = stage.buffer.spot(done, H::NEEDS.section);
                let mut conductance: N = H::conductance(law, &spot);
                if stage.touches {
                    conductance = N::select(spot.overlap.greater(N::zero()), conductance, N::zero());
                }
                stage.buffer.put_conductance(done, conductance);
            }
            done += N::WIDTH;
        }
    }
}
