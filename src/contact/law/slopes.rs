//! Sub-models over numbers with slopes, a register's worth of contacts at a time.

use super::functions::{
    Acting, CohesionFunction, NormalFunction, RollingFunction, TangentialFunction, cohesion, normal, rolling,
    tangential,
};
use crate::contact::cohesion::TakeCohesion;
use crate::contact::normal::TakeNormal;
use crate::contact::rolling::TakeRolling;
use crate::contact::tangential::TakeTangential;
use crate::contact::{
    Cohesion, CohesionForm, Contact, LawChoice, Normal, NormalForce, NormalForm, Rolling, Tangential,
};
use crate::dual::{Dual, Slopes};
use crate::lanes::Work;
use crate::number::{Number, Vector};
use std::marker::PhantomData;

/// What a sub-model `M` is given of a register's worth of contacts.
struct Given<'a, M, V: Number, S: Slopes<V>> {
    /// Its coefficients.
    row: &'a [V],
    /// The contacts.
    contact: &'a Contact<Dual<V, S>>,
    /// What it remembers of them.
    history: &'a mut [Dual<V, S>; 4],
    /// The time step.
    step: Dual<V, S>,
    /// The sub-model.
    model: PhantomData<M>,
}

/// A normal model at work: coefficients, contact, what it remembers, time step.
struct Press<'a, M, V: Number, S: Slopes<V>>(
    &'a [V],
    &'a Contact<Dual<V, S>>,
    &'a mut [Dual<V, S>; 4],
    Dual<V, S>,
    PhantomData<M>,
);

impl<M: NormalForm, V: Number, S: Slopes<V>> Work for Press<'_, M, V, S> {
    type Output = NormalForce<Dual<V, S>>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        normal::<M, _>(self.0, self.1, self.2, self.3)
    }
}

/// A tangential model at work, beside a normal force.
struct Rub<'a, M, V: Number, S: Slopes<V>>(Given<'a, M, V, S>, &'a NormalForce<Dual<V, S>>);

impl<M: Tangential, V: Number, S: Slopes<V>> Work for Rub<'_, M, V, S> {
    type Output = (Vector<Dual<V, S>>, V::Mask);
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Given { row, contact, history, step, .. } = self.0;
        tangential::<M, _>(row, contact, self.1, history, step)
    }
}

/// A rolling model at work, beside a normal force.
struct Roll<'a, M, V: Number, S: Slopes<V>>(Given<'a, M, V, S>, &'a NormalForce<Dual<V, S>>);

impl<M: Rolling, V: Number, S: Slopes<V>> Work for Roll<'_, M, V, S> {
    type Output = Vector<Dual<V, S>>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Given { row, contact, history, step, .. } = self.0;
        rolling::<M, _>(row, contact, self.1, history, step)
    }
}

/// A cohesion model at work on a normal force.
struct Pull<'a, M, V: Number, S: Slopes<V>>(
    &'a [V],
    &'a Contact<Dual<V, S>>,
    &'a mut NormalForce<Dual<V, S>>,
    PhantomData<M>,
);

impl<M: CohesionForm, V: Number, S: Slopes<V>> Work for Pull<'_, M, V, S> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        cohesion::<M, _>(self.0, self.1, self.2);
    }
}

/// The functions of sub-models over numbers with slopes, with the processor features of their registers.
#[derive(Clone, Copy)]
struct Sloped<V, S>(PhantomData<(V, S)>);

impl<V: Number, S: Slopes<V>> TakeNormal for Sloped<V, S> {
    type Output = NormalFunction<Dual<V, S>>;
    fn take<M: Normal>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, history, step| S::within(Press::<M::Form, V, S>(row, contact, history, step, PhantomData))
    }
}

impl<V: Number, S: Slopes<V>> TakeTangential for Sloped<V, S> {
    type Output = TangentialFunction<Dual<V, S>>;
    fn take<M: Tangential>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, force, history, step| {
            S::within(Rub::<M, V, S>(Given { row, contact, history, step, model: PhantomData }, force))
        }
    }
}

impl<V: Number, S: Slopes<V>> TakeRolling for Sloped<V, S> {
    type Output = RollingFunction<Dual<V, S>>;
    fn take<M: Rolling>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, force, history, step| {
            S::within(Roll::<M, V, S>(Given { row, contact, history, step, model: PhantomData }, force))
        }
    }
}

impl<V: Number, S: Slopes<V>> TakeCohesion for Sloped<V, S> {
    type Output = CohesionFunction<Dual<V, S>>;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> Self::Output {
        |row, contact, force| S::within(Pull::<M::Form, V, S>(row, contact, force, PhantomData))
    }
}

impl<V: Number, S: Slopes<V>> Acting<Dual<V, S>> {
    /// What the sub-models of a choice do, with slopes.
    pub(super) fn with_slopes(choice: &LawChoice) -> Self {
        let sloped = Sloped::<V, S>(PhantomData);
        Self {
            normal: choice.normal.visit(sloped),
            tangential: choice.tangential.visit(sloped),
            rolling: choice.rolling.visit(sloped),
            cohesion: choice.cohesion.visit(sloped),
        }
    }
}
