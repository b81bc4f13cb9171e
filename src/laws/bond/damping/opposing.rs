//! Damping of constant share against the rate.

use super::{Damped, Damping, Model, by_share};
use crate::base::number::{Number, Vector};
use crate::base::quantity::Fraction;
use crate::laws::bond::elasticity::Parts;
use crate::laws::bond::part_keys::PartKeys;
use crate::laws::bond::{Coefficients, Elastic, Motion, Pair};

/// Smallest divisor of a rate, so that no motion gives no damping.
const LEAST_RATE: f64 = 1e-300;

/// Each part is opposed to its rate by a share of its own magnitude.
///
/// ```text
/// X_damping = −α |X| v/|v|        0 where v = 0
/// ```
///
/// | symbol | meaning                                       | unit       | comes from        |
/// |--------|-----------------------------------------------|------------|-------------------|
/// | X      | normal, shear force, torsion, bending torque  | N, N m     | the formulation   |
/// | v      | its rate: v_n, v_s, w_n, w_t                  | m/s, rad/s | the motion        |
/// | α      | share of each part                            | 1          | `damping.opposing` |
///
/// Rates are those in the bond's own frame: nothing depends on the axes of the scene, angular momentum is
/// kept. As with every damping by a share of the force, a bond under load comes to rest only within ±α |X|.
#[derive(Clone, Copy, Debug)]
pub struct Opposing {
    /// α of each part.
    pub shares: Parts,
}

impl Model for Opposing {
    type Keys = PartKeys<Fraction>;
    type Form = Self;

    fn of(keys: &Self::Keys) -> Self {
        Self { shares: keys.parts(Fraction::get) }
    }
}

/// −α |X| v/|v|.
#[inline(always)]
fn against<N: Number>(share: N, part: N, rate: Vector<N>) -> Vector<N> {
    rate * -(share * part / rate.length().max(N::splat(LEAST_RATE)))
}

impl Damping for Opposing {
    const NEEDS_MASSES: bool = false;

    #[inline(always)]
    fn damp<N: Number>(
        &self,
        _law: &Coefficients<N>,
        _pair: &Pair<N>,
        motion: &Motion<N>,
        elastic: &Elastic<N>,
    ) -> Damped<N> {
        let [normal, shear, torsion, bending] = self.shares.map(N::splat);
        let approach = motion.axis * motion.normal_velocity;
        let twist = motion.axis * motion.twist_rate;
        Damped {
            normal: against(normal, elastic.normal.abs(), approach),
            shear: against(shear, elastic.shear.length(), motion.slip),
            torsion: against(torsion, elastic.torsion.abs(), twist),
            bending: against(bending, elastic.bending.length(), motion.bending_rate),
        }
    }

    fn linear(&self, _: &Pair, stiffness: Parts) -> [Parts; 2] {
        by_share(&self.shares, stiffness)
    }
}
