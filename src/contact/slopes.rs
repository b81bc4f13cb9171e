//! Sub-models over numbers with slopes, one contact at a time.

use super::cohesion::TakeCohesion;
use super::functions::{
    Acting, CohesionFunction, NormalFunction, RollingFunction, TangentialFunction, cohesion, normal, rolling,
    tangential,
};
use super::normal::TakeNormal;
use super::rolling::TakeRolling;
use super::tangential::TakeTangential;
use super::{
    Cohesion, CohesionForm, Contact, Friction, LawChoice, Normal, NormalForce, NormalForm, Rolling, Tangential,
};
use crate::dual::Dual;
use crate::lanes::{Lane, Work};
use crate::number::Vector;
use std::marker::PhantomData;

/// What a sub-model `M` is given of one contact, with slopes in registers of `N`.
struct Given<'a, M, N: Lane> {
    /// Its coefficients.
    row: &'a [f64],
    /// The contact.
    contact: &'a Contact<Dual<N>>,
    /// What it remembers.
    history: [Dual<N>; 4],
    /// The time step.
    step: Dual<N>,
    /// The sub-model.
    model: PhantomData<M>,
}

/// A normal model at work: coefficients, contact, what it remembers, time step.
struct Press<'a, M, N: Lane>(&'a [f64], &'a Contact<Dual<N>>, &'a mut [Dual<N>; 4], Dual<N>, PhantomData<M>);

impl<M: NormalForm, N: Lane> Work for Press<'_, M, N> {
    type Output = NormalForce<Dual<N>>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        normal::<M, _>(self.0, self.1, self.2, self.3)
    }
}

/// A tangential model at work, beside a normal force.
struct Rub<'a, M, N: Lane>(Given<'a, M, N>, &'a NormalForce<Dual<N>>);

impl<M: Tangential, N: Lane> Work for Rub<'_, M, N> {
    type Output = Friction<Dual<N>>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Given { row, contact, history, step, .. } = self.0;
        tangential::<M, _>(row, contact, self.1, history, step)
    }
}

/// A rolling model at work, beside a normal force.
struct Roll<'a, M, N: Lane>(Given<'a, M, N>, &'a NormalForce<Dual<N>>);

impl<M: Rolling, N: Lane> Work for Roll<'_, M, N> {
    type Output = (Vector<Dual<N>>, [Dual<N>; 4]);
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Given { row, contact, history, step, .. } = self.0;
        rolling::<M, _>(row, contact, self.1, history, step)
    }
}

/// A cohesion model at work on a normal force.
struct Pull<'a, M, N: Lane>(&'a [f64], &'a Contact<Dual<N>>, &'a mut NormalForce<Dual<N>>, PhantomData<M>);

impl<M: CohesionForm, N: Lane> Work for Pull<'_, M, N> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        cohesion::<M, _>(self.0, self.1, self.2);
    }
}

/// The functions of sub-models over numbers with slopes, with the processor features of their registers.
#[derive(Clone, Copy)]
struct Sloped<N>(PhantomData<N>);

impl<N: Lane> TakeNormal for Sloped<N> {
    type Output = NormalFunction<Dual<N>>;
    fn take<M: Normal>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, history, step| N::within(Press::<M::Form, N>(row, contact, history, step, PhantomData))
    }
}

impl<N: Lane> TakeTangential for Sloped<N> {
    type Output = TangentialFunction<Dual<N>>;
    fn take<M: Tangential>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, force, history, step| {
            N::within(Rub::<M, N>(Given { row, contact, history, step, model: PhantomData }, force))
        }
    }
}

impl<N: Lane> TakeRolling for Sloped<N> {
    type Output = RollingFunction<Dual<N>>;
    fn take<M: Rolling>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, force, history, step| {
            N::within(Roll::<M, N>(Given { row, contact, history, step, model: PhantomData }, force))
        }
    }
}

impl<N: Lane> TakeCohesion for Sloped<N> {
    type Output = CohesionFunction<Dual<N>>;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, force| N::within(Pull::<M::Form, N>(row, contact, force, PhantomData))
    }
}

impl<N: Lane> Acting<Dual<N>> {
    /// What the sub-models of a choice do, with slopes.
    pub(super) fn with_slopes(choice: &LawChoice) -> Self {
        let sloped = Sloped(PhantomData);
        Self {
            normal: choice.normal.visit(sloped),
            tangential: choice.tangential.visit(sloped),
            rolling: choice.rolling.visit(sloped),
            cohesion: choice.cohesion.visit(sloped),
        }
    }
}
