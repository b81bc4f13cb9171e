//! How what a bond does changes with a few inputs: the law over numbers with slopes.

use super::breakage::{Breakage, Loaded, TakeRule};
use super::damping::{Damping, DampingLoad, TakeDamping};
use super::formulation::{Formulation, TakeFormulation};
use super::law::Respond;
use super::{Coefficients, Elastic, Law, Motion, Pair, Rows};
use crate::dual::Dual;
use crate::lanes::{Lane, Work};
use crate::number::Vector;
use std::marker::PhantomData;

/// What one bond does, with slopes.
#[derive(Clone, Copy, Debug)]
pub struct Sloped<N: Lane> {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<Dual<N>>,
    /// Torque on i \[N m\].
    pub torque_i: Vector<Dual<N>>,
    /// Torque on j \[N m\].
    pub torque_j: Vector<Dual<N>>,
    /// The state to remember.
    pub rows: Rows<Dual<N>>,
}

impl Law {
    /// What one bond does, with slopes; nothing where it breaks. Called where the features of the registers are there.
    #[inline(always)]
    pub fn react_with_slopes<N: Lane>(
        &self,
        law: &Coefficients<Dual<N>>,
        pair: &Pair<Dual<N>>,
        rows: &Rows<Dual<N>>,
    ) -> Option<Sloped<N>> {
        let respond = self.formulation.visit(self.asked(), TakeSloped(PhantomData));
        let (motion, elastic) = respond(law, pair, rows);
        let loaded = elastic.loaded(&motion);
        if self.breakage.iter().any(|rule| rule.visit(Judge(&loaded))) {
            return None;
        }
        let mut found =
            Sloped { force: elastic.force, torque_i: elastic.torque_i, torque_j: elastic.torque_j, rows: elastic.rows };
        if let Some(damping) = &self.damping {
            let load = damping.visit(Damp { law, pair, motion: &motion.settled(), elastic: &elastic });
            found.force += load.force;
            found.torque_i += load.torque_i;
            found.torque_j += load.torque_j;
        }
        Some(found)
    }
}

/// Takes what a formulation does, with slopes.
struct TakeSloped<N>(PhantomData<N>);

impl<N: Lane> TakeFormulation for TakeSloped<N> {
    type Output = Respond<Dual<N>>;
    fn take<F: Formulation>(self) -> Self::Output {
        |law, pair, rows| N::within(Response::<F, N> { law, pair, rows, formulation: PhantomData })
    }
}

/// What a formulation does to one bond.
struct Response<'a, F, N: Lane> {
    /// The law at this step.
    law: &'a Coefficients<Dual<N>>,
    /// Its bodies.
    pair: &'a Pair<Dual<N>>,
    /// What it remembers.
    rows: &'a Rows<Dual<N>>,
    /// The formulation.
    formulation: PhantomData<F>,
}

impl<F: Formulation, N: Lane> Work for Response<'_, F, N> {
    type Output = (Motion<Dual<N>>, Elastic<Dual<N>>);
    #[inline(always)]
    fn run(self) -> Self::Output {
        F::respond(self.law, self.pair, self.rows)
    }
}

/// One bond to be damped.
struct Damp<'a, N: Lane> {
    /// The law at this step.
    law: &'a Coefficients<Dual<N>>,
    /// Its bodies.
    pair: &'a Pair<Dual<N>>,
    /// How they move.
    motion: &'a Motion<Dual<N>>,
    /// What the formulation answers.
    elastic: &'a Elastic<Dual<N>>,
}

impl<N: Lane> TakeDamping for Damp<'_, N> {
    type Output = DampingLoad<Dual<N>>;
    fn take<D: Damping>(self, damping: D) -> DampingLoad<Dual<N>> {
        N::within(Damped { bond: self, damping })
    }
}

/// A damping at work on one bond.
struct Damped<'a, D, N: Lane> {
    /// The bond.
    bond: Damp<'a, N>,
    /// The damping.
    damping: D,
}

impl<D: Damping, N: Lane> Work for Damped<'_, D, N> {
    type Output = DampingLoad<Dual<N>>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Damp { law, pair, motion, elastic } = self.bond;
        self.damping.damp(law, pair, motion, elastic).load(pair, motion)
    }
}

/// One bond that a rule looks at.
struct Judge<'a, N: Lane>(&'a Loaded<Dual<N>>);

impl<N: Lane> TakeRule for Judge<'_, N> {
    type Output = bool;
    fn take<B: Breakage>(self, rule: B, _before: f64) -> bool {
        N::within(Judged(self, rule))
    }
}

/// A rule at work on one bond.
struct Judged<'a, B, N: Lane>(Judge<'a, N>, B);

impl<B: Breakage, N: Lane> Work for Judged<'_, B, N> {
    type Output = bool;
    #[inline(always)]
    fn run(self) -> bool {
        self.1.judge(self.0.0).value > 0.0
    }
}
