//! Damping of bonds: force and torque added to the elastic ones. Each model is one file and one row in the list below.
//!
//! Damping changes neither the state of the bond nor its breakage.

pub mod componentwise;
pub mod opposing;
pub mod viscous;

use super::elasticity::Parts;
use super::{Coefficients, Elastic, Motion, Pair, RateRows};
use crate::base::number::{Number, Vector};
use serde::Deserialize;

/// Declares the list of damping models: yields `[bond.<name>.damping.<model>]` as the scene writes it, and the way from
/// a row to its type. A new model is one row.
macro_rules! damping_models {
    ($($row:ident: $file:ident::$model:ident,)+) => {
        /// `[bond.<name>.damping.<model>]`
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum DampingChoice {
            $(
                #[doc = concat!("[`", stringify!($file), "::", stringify!($model), "`]")]
                $row(<$file::$model as Model>::Keys),
            )+
        }

        impl DampingChoice {
            /// Why the model needs a given time step, if it does.
            pub fn needs_given_step(&self) -> Option<&'static str> {
                match self { $(Self::$row(_) => <$file::$model as Model>::NEEDS_GIVEN_STEP,)+ }
            }

            /// Whether it is made of dashpots, which a scheme can let see the rates at the end of the step.
            pub fn is_dashpots(&self) -> bool {
                match self { $(Self::$row(_) => <$file::$model as Model>::IS_DASHPOTS,)+ }
            }

            /// Whether the engine has it.
            pub fn is_the_engines(&self) -> bool {
                match self { $(Self::$row(_) => <$file::$model as Model>::IS_THE_ENGINES,)+ }
            }

            /// Goes from the row of the list to the type of what it computes.
            #[inline(always)]
            pub fn visit<V: TakeDamping>(&self, visitor: V) -> V::Output {
                match self { $(Self::$row(keys) => visitor.take(<$file::$model as Model>::of(keys)),)+ }
            }
        }
    };
}

damping_models! {
    Opposing: opposing::Opposing,
    Viscous: viscous::Viscous,
    Sign: componentwise::Sign,
    Smooth: componentwise::Smooth,
}

/// The keys of a damping model in a scene.
pub trait Model {
    /// The type of the values in its table.
    type Keys: Copy + std::fmt::Debug + PartialEq + for<'de> Deserialize<'de>;
    /// The type that computes it. Models that differ in their numbers alone share one.
    type Form: Damping;
    /// Why it needs a given time step, if it does.
    const NEEDS_GIVEN_STEP: Option<&'static str> = None;
    /// Whether it is made of dashpots: loads that grow with the rates.
    const IS_DASHPOTS: bool = false;
    /// Whether LIGGGHTS-INL has it.
    const IS_THE_ENGINES: bool = false;
    /// The model that its keys mean.
    fn of(keys: &Self::Keys) -> Self::Form;
}

/// A damping model, in numbers.
pub trait Damping: Copy + std::fmt::Debug + Send + Sync + 'static {
    /// Whether it uses masses and moments of inertia.
    const NEEDS_MASSES: bool;
    /// The damping of a bond with this motion.
    fn damp<N: Number>(
        &self,
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        elastic: &Elastic<N>,
    ) -> Damped<N>;
    /// Its part in the stable time step: stiffness of each part with the most that damping adds to it \[N/m, N m\], and
    /// dashpots \[kg/s, N m s\].
    fn linear(&self, pair: &Pair, stiffness: Parts) -> [Parts; 2];
}

/// A damping that opposes the motion by a share of each part. In the mode that grows first, the motion changes its sign in
/// every step, and the load on the way out is larger by that share.
fn by_share(shares: &Parts, stiffness: Parts) -> [Parts; 2] {
    [std::array::from_fn(|part| stiffness[part] * (1.0 + shares[part])), [0.0; 4]]
}

/// What is to be done with a damping model once its type is known.
pub trait TakeDamping {
    /// The type of the result.
    type Output;
    /// Called once.
    fn take<D: Damping>(self, damping: D) -> Self::Output;
}

/// What damping adds to each part.
#[derive(Clone, Copy, Debug)]
pub struct Damped<N: Number> {
    /// To the normal force on i \[N\].
    pub normal: Vector<N>,
    /// To the shear force on i, which turns both bodies by their arms \[N\].
    pub shear: Vector<N>,
    /// To the torsion on i \[N m\].
    pub torsion: Vector<N>,
    /// To the bending torque on i \[N m\].
    pub bending: Vector<N>,
}

/// Force and torques of damping on two bodies.
#[derive(Clone, Copy, Debug)]
pub struct DampingLoad<N: Number = f64> {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<N>,
    /// Torque on i \[N m\].
    pub torque_i: Vector<N>,
    /// Torque on j \[N m\].
    pub torque_j: Vector<N>,
}

impl<N: Number> Damped<N> {
    /// The resulting loads on the two bodies.
    #[inline(always)]
    pub fn load(&self, pair: &Pair<N>, motion: &Motion<N>) -> DampingLoad<N> {
        let couple = self.shear.cross(motion.axis) * motion.distance;
        let twist = self.torsion + self.bending;
        DampingLoad {
            force: self.normal + self.shear,
            torque_i: couple * pair.share_i + twist,
            torque_j: couple * pair.share_j - twist,
        }
    }
}

impl<N: Number> DampingLoad<N> {
    /// No load.
    #[inline(always)]
    pub fn none() -> Self {
        Self { force: Vector::zero(), torque_i: Vector::zero(), torque_j: Vector::zero() }
    }

    /// Energy that it takes from bodies with this motion in half a time step of this length \[s\]: half a step with the
    /// velocities after its evaluation, or half a step with those before \[J\].
    ///
    /// A force acts half a step before its evaluation and half a step after it. What it takes is booked with the
    /// velocities of both sides, as the integrator does, so that the book holds even if damping reverses a motion.
    #[inline(always)]
    pub fn taken(&self, pair: &Pair<N>, step: N) -> N {
        let turning = self.torque_i.dot(pair.spin_i) + self.torque_j.dot(pair.spin_j);
        -(self.force.dot(pair.velocity) + turning) * (N::splat(0.5) * step)
    }

    /// As rows, for the state.
    #[inline(always)]
    pub fn to_rows(self) -> LoadRows<N> {
        [self.force, self.torque_i, self.torque_j].map(|vector| vector.row_with(N::zero()))
    }

    /// The inverse of `to_rows`.
    #[inline(always)]
    pub fn from_rows(rows: LoadRows<N>) -> Self {
        let [force, torque_i, torque_j] = rows.map(Vector::of_row);
        Self { force, torque_i, torque_j }
    }
}

/// The load of damping on a bond, as rows of the state.
pub type LoadRows<N = f64> = [[N; 4]; 3];

/// What a bond remembers of its damping: the load, and behind it the rates where dashpots see those of the end of the step.
#[derive(Clone, Copy, Debug, Default)]
pub struct LastDamping {
    /// The load of the last evaluation.
    pub load: LoadRows,
    /// The rates at the middle of the last step.
    pub rates: RateRows,
}

impl LastDamping {
    /// The most rows that it has.
    pub const MOST_ROWS: usize = 5;

    /// As rows, for the state.
    pub fn to_rows(self) -> [[f64; 4]; Self::MOST_ROWS] {
        let ([force, torque_i, torque_j], [across, about]) = (self.load, self.rates);
        [force, torque_i, torque_j, across, about]
    }

    /// The inverse of `to_rows`.
    pub fn from_rows([force, torque_i, torque_j, across, about]: [[f64; 4]; Self::MOST_ROWS]) -> Self {
        Self { load: [force, torque_i, torque_j], rates: [across, about] }
    }
}
