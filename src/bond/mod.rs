//! What bonded bodies do to each other: pure functions of one bond and its own state.
//!
//! A bond law is composed of a formulation (elastic force and moments from the motion), damping and
//! breakage; each is one file. Laws are written over [`Number`], so the same source runs one bond at a time
//! or several in a vector register: masks and selects, no branch that changes a value.
//!
//! What a pass does, for each living bond and in this order (`docs/bonds.md` has the whole step):
//!
//! 1. loads the two bodies ([`Body`]) and [`BondLaw::ROWS`] rows of state, makes a [`Pair`] of them;
//! 2. calls [`BondLaw::react`] with the [`Coefficients`] of this step;
//! 3. adds force and torque to i, takes force from j, adds the torque of j;
//! 4. stores rows [`BondLaw::FIXED_ROWS`] to [`BondLaw::ROWS`] (none in the evaluation before the first step);
//! 5. where [`Reaction::cause`] is not 0, removes the bond and books what it carried as released; where
//!    [`Reaction::overbent`] holds, stops with an error that names the pair.
//!
//! Coefficients are the same for all bonds of one law; what differs from bond to bond (radius, arms,
//! effective masses) follows from the bodies. State rows a bond: 2 in `incremental`, 3 in the others.
//!
//! Signs: the axis points from j to i; force and torques are those on i, the force on j is the opposite.
//! The velocities are those of half a time step before the positions (velocity Verlet).

pub mod angle;
pub mod breakage;
pub mod coefficients;
pub mod creation;
pub mod damping;
pub mod engine_exact;
pub mod finite_rotation;
pub mod incremental;
pub mod keys;
pub mod list;
pub mod motion;
#[cfg(test)]
mod trials;

pub use crate::geometry::Quaternion;
pub use breakage::{Breakage, Cause};
pub use coefficients::{Coefficients, Law};
pub use damping::Damping;
pub use motion::{Body, Lengths, Motion, Opening, Pair, Rates, Section};

use crate::number::{Number, Vector};
use std::marker::PhantomData;

/// The largest number of state rows that a formulation has.
pub const MOST_ROWS: usize = 3;

/// State of one bond, or of a lane vector of bonds; rows beyond [`Formulation::ROWS`] are not looked at.
pub type Rows<N = f64> = [[N; 4]; MOST_ROWS];

/// The most numbers that [`Formulation::halfway`] gives.
pub const MOST_HALFWAY: usize = 17;

/// What a formulation keeps from the first half of its evaluation for the second.
pub type Halfway<N = f64> = [N; MOST_HALFWAY];

/// What the elastic part of a bond answers to the motion of its bodies.
#[derive(Clone, Copy, Debug)]
pub struct Elastic<N: Number> {
    /// u: above 0 compressed, below stretched \[m\].
    pub compression: N,
    /// Normal force along the axis, above 0 when it pushes \[N\].
    pub normal: N,
    /// Shear force on i \[N\].
    pub shear: Vector<N>,
    /// Torsion on i along the axis \[N m\].
    pub torsion: N,
    /// Bending torque on i \[N m\].
    pub bending: Vector<N>,
    /// Elastic force on i \[N\].
    pub force: Vector<N>,
    /// Elastic torque on i \[N m\].
    pub torque_i: Vector<N>,
    /// Elastic torque on j \[N m\].
    pub torque_j: Vector<N>,
    /// Elastic energy, after relaxation \[J\].
    pub energy: N,
    /// Elastic energy that relaxation took in this evaluation \[J\].
    pub relaxed: N,
    /// Where the bond is bent further than the formulation can follow (π).
    pub overbent: N::Mask,
    /// The state to remember.
    pub rows: Rows<N>,
}

/// How elastic force and moments follow from the motion of two bonded bodies.
pub trait Formulation: Send + Sync + 'static {
    /// Rows of state.
    const ROWS: usize;
    /// How many of them, from the first, no evaluation changes.
    const FIXED_ROWS: usize;
    /// Whether bodies need an attitude.
    const NEEDS_ATTITUDES: bool;
    /// Whether [`Elastic::relaxed`] says anything.
    const RELAXES: bool;
    /// State of a bond that is made now. The increment of the present time step (of length
    /// [`Coefficients::step`], 0 before the first) still counts: the evaluation that follows has it.
    fn create<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N>;
    /// Whether force and torques depend on rates.
    const NEEDS_RATES: bool;
    /// The rates as the formulation sees them, for itself or for damping.
    const RATES: Rates = Rates::Midway;
    /// Axis, distance and rates as the formulation sees them.
    #[inline(always)]
    fn motion<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Motion<N> {
        Motion::of(Self::RATES, law, pair)
    }
    /// How many numbers [`Formulation::halfway`] gives.
    const HALFWAY: usize = 0;
    /// What comes before a division that the rest waits for, and the quotient.
    #[inline(always)]
    fn halfway<N: Number>(_pair: &Pair<N>, _distance: N, _rows: &Rows<N>) -> Halfway<N> {
        [N::zero(); MOST_HALFWAY]
    }
    /// Force, torques and new state, after that.
    fn finish<N: Number>(
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        halfway: &Halfway<N>,
        rows: &Rows<N>,
    ) -> Elastic<N>;
    /// Force, torques and new state.
    #[inline(always)]
    fn respond<N: Number>(law: &Coefficients<N>, pair: &Pair<N>, motion: &Motion<N>, rows: &Rows<N>) -> Elastic<N> {
        Self::finish(law, pair, motion, &Self::halfway(pair, motion.distance, rows), rows)
    }
}

/// What one bond does to its two bodies.
#[derive(Clone, Copy, Debug)]
pub struct Reaction<N: Number> {
    /// Force on i; j gets the opposite. 0 where the bond broke \[N\].
    pub force: Vector<N>,
    /// Torque on i \[N m\].
    pub torque_i: Vector<N>,
    /// Torque on j \[N m\].
    pub torque_j: Vector<N>,
    /// The part of `force` that damping made, for the energy book \[N\].
    pub damping_force: Vector<N>,
    /// The part of `torque_i` that damping made \[N m\].
    pub damping_torque_i: Vector<N>,
    /// The part of `torque_j` that damping made \[N m\].
    pub damping_torque_j: Vector<N>,
    /// Elastic energy that relaxation took in this evaluation \[J\].
    pub relaxed: N,
    /// Energy that damping took in this time step, by the rates of half a step earlier \[J\].
    pub damped: N,
    /// 0, or why the bond broke: [`Cause::code`].
    pub cause: N,
    /// Where the bond is bent beyond π.
    pub overbent: N::Mask,
    /// The state to remember.
    pub rows: Rows<N>,
}

impl<N: Number> Reaction<N> {
    /// Takes away what acts, where the mask holds.
    #[inline(always)]
    fn rest(&mut self, broken: N::Mask) {
        let acting = [
            &mut self.force,
            &mut self.torque_i,
            &mut self.torque_j,
            &mut self.damping_force,
            &mut self.damping_torque_i,
            &mut self.damping_torque_j,
        ];
        for vector in acting {
            *vector = Vector::select(broken, Vector::zero(), *vector);
        }
        self.damped = N::select(broken, N::zero(), self.damped);
    }
}

/// A bond law, whole: what the pass in the time step is generic over.
pub trait BondLaw: Send + Sync + 'static {
    /// Rows of state.
    const ROWS: usize;
    /// How many of them, from the first, no evaluation changes.
    const FIXED_ROWS: usize;
    /// Whether [`Body::attitude`] is looked at.
    const NEEDS_ATTITUDES: bool;
    /// Whether [`Body::mass`] and [`Body::inertia`] are looked at.
    const NEEDS_MASSES: bool;
    /// Whether [`Reaction::relaxed`] says anything.
    const RELAXES: bool;
    /// Whether [`Reaction::damped`] says anything.
    const DAMPS: bool;
    /// The rates that [`BondLaw::act`] looks at.
    const RATES: Rates;
    /// State of a bond that is made now; evaluate it in the same step with [`BondLaw::react`].
    fn create<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N>;
    /// How many numbers [`BondLaw::halfway`] gives.
    const HALFWAY: usize;
    /// What comes before a division that the rest waits for, and the quotient.
    fn halfway<N: Number>(pair: &Pair<N>, distance: N, rows: &Rows<N>) -> Halfway<N>;
    /// Force, torque, breakage and new state of one bond that moves like this.
    fn act<N: Number>(
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        halfway: &Halfway<N>,
        rows: &Rows<N>,
    ) -> Reaction<N>;
    /// Force, torque, breakage and new state of one bond, its motion found on the way.
    #[inline(always)]
    fn react<N: Number>(law: &Coefficients<N>, pair: &Pair<N>, rows: &Rows<N>) -> Reaction<N> {
        let motion = Motion::of(Self::RATES, law, pair);
        Self::act(law, pair, &motion, &Self::halfway(pair, motion.distance, rows), rows)
    }
    /// What the bond carries at this moment, for outputs: nothing advances, nothing breaks.
    fn carried(law: &Law, pair: &Pair, rows: &Rows) -> Carried;
}

/// What a bond carries, for outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// Distance of the centres at which it bears no normal force \[m\].
    pub rest: f64,
    /// Unit vector from j to i.
    pub axis: [f64; 3],
    /// Normal force, above 0 when it pushes \[N\].
    pub normal: f64,
    /// Shear force on i \[N\].
    pub shear: [f64; 3],
    /// Torsion on i along the axis \[N m\].
    pub torsion: f64,
    /// Bending torque on i \[N m\].
    pub bending: [f64; 3],
    /// Normal stress with the law's rule for compression \[Pa\].
    pub normal_stress: f64,
    /// Shear stress \[Pa\].
    pub shear_stress: f64,
    /// Elastic energy \[J\].
    pub energy: f64,
    /// Rate at which its elastic force and torques work on the bodies \[W\].
    pub power: f64,
}

/// The law that the scene composed of a formulation, damping and breakage.
#[derive(Clone, Copy, Debug)]
pub struct Composed<F, D, B>(PhantomData<(F, D, B)>);

impl<F: Formulation, D: Damping, B: Breakage> BondLaw for Composed<F, D, B> {
    const ROWS: usize = F::ROWS;
    const FIXED_ROWS: usize = F::FIXED_ROWS;
    const NEEDS_ATTITUDES: bool = F::NEEDS_ATTITUDES;
    const NEEDS_MASSES: bool = D::NEEDS_MASSES;
    const RELAXES: bool = F::RELAXES;
    const DAMPS: bool = D::ACTIVE;
    const HALFWAY: usize = F::HALFWAY;
    const RATES: Rates = if F::NEEDS_RATES || D::ACTIVE { F::RATES } else { Rates::Unseen };

    #[inline(always)]
    fn create<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N> {
        F::create(law, pair)
    }

    #[inline(always)]
    fn halfway<N: Number>(pair: &Pair<N>, distance: N, rows: &Rows<N>) -> Halfway<N> {
        F::halfway(pair, distance, rows)
    }

    #[inline(always)]
    fn act<N: Number>(
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        halfway: &Halfway<N>,
        rows: &Rows<N>,
    ) -> Reaction<N> {
        let elastic = F::finish(law, pair, motion, halfway, rows);
        let cause = B::judge(law, motion, &elastic);
        let lost = D::damp(law, pair, &motion.settled(), &elastic);

        let damping_force = lost.normal + lost.shear;
        let couple = lost.shear.cross(motion.axis) * motion.distance;
        let twist = lost.torsion + lost.bending;
        let damping_torque_i = couple * pair.share_i + twist;
        let damping_torque_j = couple * pair.share_j - twist;

        let mut damped = N::zero();
        if D::ACTIVE {
            let turning = damping_torque_i.dot(pair.spin_i) + damping_torque_j.dot(pair.spin_j);
            damped = -(damping_force.dot(pair.velocity) + turning) * law.step;
        }
        let mut reaction = Reaction {
            force: elastic.force + damping_force,
            torque_i: elastic.torque_i + damping_torque_i,
            torque_j: elastic.torque_j + damping_torque_j,
            damping_force,
            damping_torque_i,
            damping_torque_j,
            relaxed: elastic.relaxed,
            damped,
            cause,
            overbent: elastic.overbent,
            rows: elastic.rows,
        };
        // Seldom, and nine selections less in every other step.
        let broken = cause.greater(N::zero());
        if N::any(broken) {
            reaction.rest(broken);
        }
        reaction
    }

    fn carried(law: &Law, pair: &Pair, rows: &Rows) -> Carried {
        let law = law.coefficients::<f64>(0.0);
        let motion = F::motion(&law, pair);
        let elastic = F::respond(&law, pair, &motion, rows);
        let stress = breakage::Stress::of(&law, &motion.section, &elastic);
        Carried {
            rest: elastic.compression + motion.distance,
            axis: motion.axis.to_array(),
            normal: elastic.normal,
            shear: elastic.shear.to_array(),
            torsion: elastic.torsion,
            bending: elastic.bending.to_array(),
            normal_stress: stress.normal,
            shear_stress: stress.shear,
            energy: elastic.energy,
            power: elastic.force.dot(pair.velocity)
                + elastic.torque_i.dot(pair.spin_i)
                + elastic.torque_j.dot(pair.spin_j),
        }
    }
}
