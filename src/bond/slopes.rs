//! How what a bond does changes with a few inputs: the law over numbers with slopes.

use super::breakage::Loaded;
use super::damping::{Damping, DampingLoad, TakeDamping};
use super::formulation::{Formulation, TakeFormulation};
use super::{Coefficients, Elastic, Law, MOST_ROWS, Motion, Pair, Rows, Section};
use crate::dual::Dual;
use crate::lanes::{Lane, Work};
use crate::number::{Number, Vector};
use std::marker::PhantomData;

/// Loads of one bond, with slopes.
#[derive(Clone, Copy, Debug)]
pub struct Sloped<N: Lane> {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<Dual<N>>,
    /// Torque on i \[N m\].
    pub torque_i: Vector<Dual<N>>,
    /// Torque on j \[N m\].
    pub torque_j: Vector<Dual<N>>,
}

impl Law {
    /// Loads of one bond, with slopes; nothing where it breaks. `rows`, what it remembers, go on. Called where the features of the
    /// registers are there.
    #[inline(always)]
    pub fn react_with_slopes<N: Lane>(
        &self,
        law: &Coefficients<Dual<N>>,
        pair: &Pair<Dual<N>>,
        rows: &mut Rows<Dual<N>>,
    ) -> Option<Sloped<N>> {
        let respond = self.formulation.visit(self.asked(), TakeSloped(PhantomData));
        let (motion, elastic) = respond(law, pair, rows);
        // Values alone decide whether a bond breaks.
        if !self.breakage.is_empty() && self.judge(&values(&elastic.loaded(&motion))) != 0.0 {
            return None;
        }
        let mut found = Sloped { force: elastic.force, torque_i: elastic.torque_i, torque_j: elastic.torque_j };
        if let Some(damping) = &self.damping {
            let load = damping.visit(Damp { law, pair, motion: &motion, elastic: &elastic });
            found.force += load.force;
            found.torque_i += load.torque_i;
            found.torque_j += load.torque_j;
        }
        Some(found)
    }
}

/// A load without its slopes.
fn values<N: Lane>(loaded: &Loaded<Dual<N>>) -> Loaded {
    let vector = |vector: Vector<Dual<N>>| Vector::new(vector.x.value, vector.y.value, vector.z.value);
    let Section { radius, area, polar, axial } = loaded.section;
    Loaded {
        distance: loaded.distance.value,
        section: Section { radius: radius.value, area: area.value, polar: polar.value, axial: axial.value },
        compression: loaded.compression.value,
        normal: loaded.normal.value,
        shear: vector(loaded.shear),
        torsion: loaded.torsion.value,
        bending: vector(loaded.bending),
    }
}

/// What a formulation does to a bond, whose rows go on, with slopes: energies are not found.
type Respond<N> = fn(&Coefficients<Dual<N>>, &Pair<Dual<N>>, &mut Rows<Dual<N>>) -> (Motion<Dual<N>>, Elastic<Dual<N>>);

/// Takes what a formulation does, with slopes.
struct TakeSloped<N>(PhantomData<N>);

impl<N: Lane> TakeFormulation for TakeSloped<N> {
    type Output = Respond<N>;
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
    rows: &'a mut Rows<Dual<N>>,
    /// The formulation.
    formulation: PhantomData<F>,
}

impl<F: Formulation, N: Lane> Work for Response<'_, F, N> {
    type Output = (Motion<Dual<N>>, Elastic<Dual<N>>);
    #[inline(always)]
    fn run(self) -> Self::Output {
        let (motion, elastic) = F::respond(self.law, self.pair, self.rows);
        self.rows[F::FIXED_ROWS..F::ROWS].copy_from_slice(&elastic.rows[F::FIXED_ROWS..F::ROWS]);
        (
            motion,
            Elastic { energy: Dual::zero(), relaxed: Dual::zero(), rows: [[Dual::zero(); 4]; MOST_ROWS], ..elastic },
        )
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
        let motion = &motion.settled();
        self.damping.damp(law, pair, motion, elastic).load(pair, motion)
    }
}
