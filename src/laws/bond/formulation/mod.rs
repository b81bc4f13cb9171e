//! How elastic force and moments follow from the motion of two bonded bodies. Each formulation is one file and one row in
//! the list below.

pub mod engine_exact;
pub mod finite_rotation;
pub mod incremental;

use super::elasticity::Parts;
use super::{Coefficients, Elastic, Intermediate, MOST_HALFWAY, Motion, Pair, Rates, Rows};
use crate::base::number::Number;
use serde::Deserialize;

/// Declares the list of formulations: yields the choice as the scene writes it (`formulation = "<name>"`), and the way
/// from a row to its type. A new formulation is one row.
macro_rules! formulations {
    ($($(#[$default:meta])* $name:ident: $row:ident,)+) => {
        /// `formulation = "<name>"`
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum FormulationChoice {
            $($(#[$default])* #[doc = concat!("[`", stringify!($name), "`]")] $row,)+
        }

        impl FormulationChoice {
            /// Every formulation.
            pub const ALL: &'static [Self] = &[$(Self::$row),+];

            /// Its name in a scene.
            pub fn name(self) -> &'static str {
                match self { $(Self::$row => stringify!($name),)+ }
            }

            /// Goes from the row of the list to the type that does what is asked and no more.
            pub fn visit<V: TakeFormulation>(self, asked: FormulationNeeds, visitor: V) -> V::Output {
                match self { $(Self::$row => $name::visit(asked, visitor),)+ }
            }
        }
    };
}

formulations! {
    #[default]
    finite_rotation: FiniteRotation,
    incremental: Incremental,
    engine_exact: EngineExact,
}

impl FormulationChoice {
    /// The formulation that the scene file calls this.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|choice| choice.name() == name)
    }

    /// Whether it repeats LIGGGHTS-INL, which has dampings and limits of its own.
    pub fn is_engine(self) -> bool {
        self == Self::EngineExact
    }
}

/// What a law needs of a formulation beyond force and moments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormulationNeeds {
    /// Relaxation.
    pub relaxation: bool,
    /// The rates, which damping uses.
    pub rates: bool,
}

impl FormulationNeeds {
    /// All that can be asked.
    pub const ALL: Self = Self { relaxation: true, rates: true };
}

/// What is to be done with a formulation once its type is known.
pub trait TakeFormulation {
    /// The type of the result.
    type Output;
    /// Called once.
    fn take<F: Formulation>(self) -> Self::Output;
}

/// A formulation.
pub trait Formulation: Send + Sync + 'static {
    /// Rows of state.
    const ROWS: usize;
    /// What each row holds, place by place. It identifies saved states, so it must change with the meaning of a row.
    const REMEMBERED: &'static str;
    /// How many of the first rows stay constant.
    const FIXED_ROWS: usize;
    /// Whether bodies need an orientation.
    const NEEDS_ORIENTATIONS: bool;
    /// Whether [`Elastic::relaxed`] can differ from 0.
    const RELAXES: bool;
    /// The rates that it computes, for itself or for damping.
    const RATES: Rates;
    /// How many numbers [`Formulation::halfway`] gives.
    const HALFWAY: usize = 0;

    /// State of a bond that is made now. The increment of the present time step (of length
    /// [`Coefficients::step`], 0 before the first) still counts: the evaluation that follows has it.
    fn create<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N>;

    /// The part of the evaluation before a division for which the rest waits, and the quotient.
    #[inline(always)]
    fn halfway<N: Number>(_pair: &Pair<N>, _distance: N, _rows: &Rows<N>) -> Intermediate<N> {
        [N::zero(); MOST_HALFWAY]
    }

    /// The rest of the evaluation: force, torques and new state.
    fn finish<N: Number>(
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        halfway: &Intermediate<N>,
        rows: &Rows<N>,
    ) -> Elastic<N>;

    /// Motion, and with it force, torques and new state, of one bond.
    #[inline(always)]
    fn respond<N: Number>(law: &Coefficients<N>, pair: &Pair<N>, rows: &Rows<N>) -> (Motion<N>, Elastic<N>) {
        let motion = Motion::of(Self::RATES, law, pair);
        let elastic = Self::finish(law, pair, &motion, &Self::halfway(pair, motion.distance, rows), rows);
        (motion, elastic)
    }
}

/// Energy that relaxation takes from the four parts, if these shares of their forces are left.
#[inline(always)]
fn relaxation_loss<N: Number>(left: Parts<N>, before: Parts<N>) -> N {
    let mut lost = N::zero();
    for part in 0..4 {
        lost = lost + before[part] * (N::splat(1.0) - left[part] * left[part]);
    }
    lost
}
