//! Breakage by the stresses at the rim.

use super::{Stress, distance};
use crate::bond::{Breakage, Cause, Coefficients, Elastic, Motion};
use crate::number::Number;

/// |u| below which the engine takes a bond for stretched \[m\].
const STRETCHED_BELOW: f64 = 1e-16;

/// Breaks where σ > S' or τ > τ' (the engine with `stressBreak`).
///
/// ```text
/// S' = tension strength where u < 1e-16 m, else compression strength
/// τ' = shear strength + sgn(u) |N|/A tan φ
/// ```
///
/// σ and τ: [`Stress`], after the evaluation of this step and without damping. With friction, compression
/// raises the shear strength and tension lowers it, below 0 if need be: Mohr and Coulomb's limit on the mean
/// normal stress. A strength that is not given is ∞. `max_distance`, where given, holds as well.
#[derive(Clone, Copy, Debug)]
pub struct ByStress;

impl Breakage for ByStress {
    #[inline(always)]
    fn judge<N: Number>(law: &Coefficients<N>, motion: &Motion<N>, elastic: &Elastic<N>) -> N {
        let stress = Stress::of(law, &motion.section, elastic);
        let stretched = N::splat(STRETCHED_BELOW).greater(elastic.compression);
        let strength = N::select(stretched, law.tension_strength, law.compression_strength);
        let normal_cause = N::select(stretched, N::splat(Cause::Tension.code()), N::splat(Cause::Compression.code()));
        let shear_strength = law.shear_strength + stress.pressure * law.friction;
        let by_shear = N::select(stress.shear.greater(shear_strength), N::splat(Cause::Shear.code()), N::zero());
        let by_stress = N::select(stress.normal.greater(strength), normal_cause, by_shear);
        let by_distance = distance::Distance::judge(law, motion, elastic);
        N::select(by_distance.greater(N::zero()), by_distance, by_stress)
    }
}
