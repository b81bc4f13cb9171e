//! How what bonds do changes with a few inputs: the law over numbers with slopes, on a register's worth of bonds at a time.

use super::breakage::{Breakage, Loaded, TakeRule};
use super::damping::{Damping, DampingLoad, TakeDamping};
use super::formulation::{Formulation, TakeFormulation};
use super::{Coefficients, Elastic, Law, MOST_ROWS, Motion, Pair, RateRows, Rates, Rows, Section, motion::Turn};
use crate::dual::{Dual, Slopes};
use crate::lanes::{Lane, Work};
use crate::number::{Number, Vector};
use std::marker::PhantomData;

/// Loads of some bonds, with slopes.
#[derive(Clone, Copy)]
pub struct Sloped<V: Lane, S: Slopes<V>> {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<Dual<V, S>>,
    /// Torque on i \[N m\].
    pub torque_i: Vector<Dual<V, S>>,
    /// Torque on j \[N m\].
    pub torque_j: Vector<Dual<V, S>>,
    /// Which break, a bit for each: of these there is no load.
    pub broken: u32,
}

/// What some bonds remember.
#[derive(Clone, Copy)]
pub struct Remembered<N: Number> {
    /// The rows of their law.
    pub rows: Rows<N>,
    /// Their rates at the middle of the last step, if dashpots see those of the end of the step.
    pub rates: RateRows<N>,
}

impl<N: Number> Remembered<N> {
    /// Room for it.
    #[inline(always)]
    pub fn room() -> Self {
        Self { rows: [[N::zero(); 4]; MOST_ROWS], rates: [[N::zero(); 4]; 2] }
    }
}

/// What a formulation answers for some bonds: how they move, forces and torques. Energies and new rows are not found.
#[derive(Clone, Copy)]
pub struct Answer<N: Number> {
    /// How they move.
    motion: Motion<N>,
    /// Forces and torques.
    elastic: Elastic<N>,
}

impl<N: Number> Answer<N> {
    /// Room for it.
    #[inline(always)]
    pub fn room() -> Self {
        let (zero, none) = (N::zero(), Vector::zero());
        let motion = Motion {
            axis: none,
            distance: zero,
            per_distance: zero,
            normal_velocity: zero,
            slip: none,
            twist_rate: zero,
            bending_rate: none,
            turn: Turn::none(),
            section: Section { radius: zero, area: zero, polar: zero, axial: zero },
        };
        Self { motion, elastic: Elastic::none() }
    }

    /// This answer, without energies and new rows.
    #[inline(always)]
    fn put(&mut self, motion: &Motion<N>, elastic: &Elastic<N>) {
        self.motion = *motion;
        let to = &mut self.elastic;
        (to.compression, to.normal, to.torsion, to.overbent) =
            (elastic.compression, elastic.normal, elastic.torsion, elastic.overbent);
        (to.shear, to.bending, to.force) = (elastic.shear, elastic.bending, elastic.force);
        (to.torque_i, to.torque_j) = (elastic.torque_i, elastic.torque_j);
    }
}

impl Law {
    /// Loads of some bonds, with slopes. What they remember goes on; `answer` is room. Called where the features of the registers
    /// are there.
    #[inline(always)]
    pub fn react_with_slopes<V: Lane, S: Slopes<V>>(
        &self,
        law: &Coefficients<Dual<V, S>>,
        pair: &Pair<Dual<V, S>>,
        remembered: &mut Remembered<Dual<V, S>>,
        answer: &mut Answer<Dual<V, S>>,
    ) -> Sloped<V, S> {
        // One type of a formulation for all laws, which gives each the same bits as its own: the slopes of each type take
        // seconds to be compiled.
        let respond = self.formulation.visit_whole(TakeSloped(PhantomData));
        let seen = self.one_bond().rates;
        let Remembered { rows, rates } = remembered;
        respond(law, pair, seen, rows, answer);
        let Answer { motion, elastic } = answer;
        let mut found =
            Sloped { force: elastic.force, torque_i: elastic.torque_i, torque_j: elastic.torque_j, broken: 0 };
        if let Some(damping) = &self.damping {
            let rates = self.foresees.then_some(rates);
            let load = damping.visit(Damp { law, pair, motion, elastic, rates });
            found.force += load.force;
            found.torque_i += load.torque_i;
            found.torque_j += load.torque_j;
        }
        if self.breakage.is_empty() {
            return found;
        }
        // Values alone decide whether a bond breaks.
        let (loaded, mut broken) = (elastic.loaded(motion), V::zero().greater(V::zero()));
        for rule in &self.breakage {
            broken = V::either(broken, rule.visit(Judge(&loaded)));
        }
        let none = Vector::zero();
        Sloped {
            force: Vector::select(broken, none, found.force),
            torque_i: Vector::select(broken, none, found.torque_i),
            torque_j: Vector::select(broken, none, found.torque_j),
            broken: V::bits(broken),
        }
    }
}

/// Asks a rule which bonds break under their loads.
struct Judge<'a, V: Lane, S: Slopes<V>>(&'a Loaded<Dual<V, S>>);

impl<V: Lane, S: Slopes<V>> TakeRule for Judge<'_, V, S> {
    type Output = V::Mask;
    fn take<B: Breakage>(self, rule: B, _before: f64) -> V::Mask {
        S::within(Judged(self.0, rule))
    }
}

/// A rule at work.
struct Judged<'a, B, V: Lane, S: Slopes<V>>(&'a Loaded<Dual<V, S>>, B);

impl<B: Breakage, V: Lane, S: Slopes<V>> Work for Judged<'_, B, V, S> {
    type Output = V::Mask;
    #[inline(always)]
    fn run(self) -> V::Mask {
        self.1.judge(self.0).value.greater(V::zero())
    }
}

/// What a formulation does to bonds, whose rows go on, with slopes.
type Respond<V, S> =
    fn(&Coefficients<Dual<V, S>>, &Pair<Dual<V, S>>, Rates, &mut Rows<Dual<V, S>>, &mut Answer<Dual<V, S>>);

/// Takes what a formulation does, with slopes.
struct TakeSloped<V, S>(PhantomData<(V, S)>);

impl<V: Lane, S: Slopes<V>> TakeFormulation for TakeSloped<V, S> {
    type Output = Respond<V, S>;
    fn take<F: Formulation>(self) -> Self::Output {
        |law, pair, seen, rows, answer| {
            S::within(Response::<F, V, S> { law, pair, seen, rows, answer, formulation: PhantomData });
        }
    }
}

/// What a formulation does to bonds.
struct Response<'a, F, V: Lane, S: Slopes<V>> {
    /// The law at this step.
    law: &'a Coefficients<Dual<V, S>>,
    /// Their bodies.
    pair: &'a Pair<Dual<V, S>>,
    /// The rates that the law looks at: those of the formulation, or none.
    seen: Rates,
    /// What they remember.
    rows: &'a mut Rows<Dual<V, S>>,
    /// What it answers.
    answer: &'a mut Answer<Dual<V, S>>,
    /// The formulation.
    formulation: PhantomData<F>,
}

impl<F: Formulation, V: Lane, S: Slopes<V>> Work for Response<'_, F, V, S> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Self { law, pair, seen, .. } = self;
        let motion = match seen {
            Rates::Unseen => Motion::of(Rates::Unseen, law, pair),
            _ => Motion::of(F::RATES, law, pair),
        };
        let elastic = F::finish(law, pair, &motion, &F::halfway(pair, motion.distance, self.rows), self.rows);
        self.rows[F::FIXED_ROWS..F::ROWS].copy_from_slice(&elastic.rows[F::FIXED_ROWS..F::ROWS]);
        self.answer.put(&motion, &elastic);
    }
}

/// Bonds to be damped.
struct Damp<'a, V: Lane, S: Slopes<V>> {
    /// The law at this step.
    law: &'a Coefficients<Dual<V, S>>,
    /// Their bodies.
    pair: &'a Pair<Dual<V, S>>,
    /// How they move.
    motion: &'a Motion<Dual<V, S>>,
    /// What the formulation answers.
    elastic: &'a Elastic<Dual<V, S>>,
    /// The rates that they remember, where dashpots see those of the end of the step.
    rates: Option<&'a mut RateRows<Dual<V, S>>>,
}

impl<V: Lane, S: Slopes<V>> TakeDamping for Damp<'_, V, S> {
    type Output = DampingLoad<Dual<V, S>>;
    fn take<M: Damping>(self, damping: M) -> DampingLoad<Dual<V, S>> {
        S::within(Damped { bond: self, damping })
    }
}

/// A damping at work on bonds.
struct Damped<'a, M, V: Lane, S: Slopes<V>> {
    /// The bonds.
    bond: Damp<'a, V, S>,
    /// The damping.
    damping: M,
}

impl<M: Damping, V: Lane, S: Slopes<V>> Work for Damped<'_, M, V, S> {
    type Output = DampingLoad<Dual<V, S>>;
    #[inline(always)]
    fn run(self) -> Self::Output {
        let Damp { law, pair, motion, elastic, rates } = self.bond;
        let mut motion = motion.settled();
        if let Some(rates) = rates {
            let now = motion.rates();
            motion = motion.foreseen(std::mem::replace(rates, now));
        }
        self.damping.damp(law, pair, &motion, elastic).load(pair, &motion)
    }
}
