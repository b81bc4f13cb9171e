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
/// The larger of the two parts of the stress that is too large names the cause: tension or compression, or bending;
/// shear, or torsion. Where compression relieves, a compressed bond hence breaks by bending.
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
        let code = |cause: Cause| N::splat(cause.code());
        let axial_cause = N::select(stretched, code(Cause::Tension), code(Cause::Compression));
        let bent = stress.bending.greater(stress.normal - stress.bending);
        let normal_cause = N::select(bent, code(Cause::Bending), axial_cause);
        let twisted = stress.torsion.greater(stress.shear - stress.torsion);
        let shear_cause = N::select(twisted, code(Cause::Torsion), code(Cause::Shear));
        let shear_strength = law.shear_strength + stress.pressure * law.friction;
        let by_shear = N::select(stress.shear.greater(shear_strength), shear_cause, N::zero());
        let by_stress = N::select(stress.normal.greater(strength), normal_cause, by_shear);
        let by_distance = distance::Distance::judge(law, motion, elastic);
        N::select(by_distance.greater(N::zero()), by_distance, by_stress)
    }
}
