//! Breakage by Mohr and Coulomb's limit on the principal stresses at the rim, with a limit of tension.

use super::{Breakage, BreakageChoice, Loaded, Strength};
use crate::base::document::keys;
use crate::base::number::Number;
use crate::base::quantity::{NonNegative, Positive};
use crate::laws::bond::formulation::FormulationChoice;
use crate::laws::bond::key_error::KeyError;

keys! {
    /// `[bond.<name>.breakage.mohr_coulomb]`
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Keys {
        /// c, with which (σ₁ − σ₃) + (σ₁ + σ₃) sin φ > 2 c cos φ breaks the bond by `shear` \[Pa\].
        pub cohesion: Positive = "required",
        /// Angle of internal friction φ, below π/2 \[rad\].
        pub friction_angle: NonNegative = "required",
        /// Limit T of σ₁, above which the bond breaks by `tension`; at most c cot φ \[Pa\].
        pub tensile_strength: Positive = "required",
    }
}

/// Breaks where the material of the bond would, by the principal stresses on the two sides of its rim.
///
/// ```text
/// σ = σ_m ± |T_t| r_b/I,  σ_m = −sgn(u) |N|/A       τ = |F_t|/A + |T_n| r_b/J
/// σ₁, σ₃ = σ/2 ± √(σ²/4 + τ²)
/// shear:   (σ₁ − σ₃) + (σ₁ + σ₃) sin φ > 2 c cos φ
/// tension: σ₁ > T
/// ```
///
/// | symbol | meaning                                      | unit | comes from                       |
/// |--------|----------------------------------------------|------|----------------------------------|
/// | σ      | normal stress, above 0 in tension, on the stretched and on the compressed side | Pa | the bond |
/// | τ      | largest shear stress at the rim              | Pa   | the bond                         |
/// | c, φ   | cohesion, angle of internal friction         | Pa, rad | `cohesion`, `friction_angle`  |
/// | T      | limit of tension, at most c cot φ            | Pa   | `tensile_strength`               |
///
/// Normal and shear stress act together, where the limits of `stress` each look at one of them. Uniaxial compression breaks at
/// 2 c cos φ/(1 − sin φ), shear without normal force at the smaller of c cos φ and T. Shear and torsion are added as if they
/// had their largest values where bending has its own. The limit is thus on the safe side.
///
/// Source: the limit of tension on Coulomb's law is that of B. Paul, *J. Appl. Mech.* 28 (1961) 259–268; that bonds break by
/// the principal stress at their rim (σ₁ there, without friction), D. André, I. Iordanoff, J.-L. Charles & J. Néauport,
/// *Comput. Methods Appl. Mech. Eng.* 213–216 (2012) 113–125.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MohrCoulomb {
    /// 2 c cos φ \[Pa\].
    pub shear_limit: f64,
    /// sin φ.
    pub friction: f64,
    /// T \[Pa\].
    pub tensile_strength: f64,
}

/// Place of `tension` among [`MohrCoulomb::CAUSES`], from 1.
const TENSION: f64 = 1.0;
/// Place of `shear`.
const SHEAR: f64 = 2.0;

impl Breakage for MohrCoulomb {
    const NAME: &'static str = "mohr_coulomb";
    type Keys = Keys;
    const CAUSES: &'static [&'static str] = &["tension", "shear"];

    fn of(keys: &Keys, _formulation: FormulationChoice) -> Self {
        let angle = keys.friction_angle.get();
        Self {
            shear_limit: 2.0 * keys.cohesion.get() * libm::cos(angle),
            friction: libm::sin(angle),
            tensile_strength: keys.tensile_strength.get(),
        }
    }

    fn check(keys: &Keys, _all: &[BreakageChoice], _formulation: FormulationChoice, wrong: &mut Vec<KeyError>) {
        let (cohesion, angle) = (keys.cohesion.get(), keys.friction_angle.get());
        KeyError::add(
            wrong,
            angle >= std::f64::consts::FRAC_PI_2,
            "breakage.mohr_coulomb.friction_angle",
            "expected radians from 0 to below π/2, found an angle of π/2 or more",
        );
        KeyError::add(
            wrong,
            keys.tensile_strength.get() * libm::sin(angle) > cohesion * libm::cos(angle),
            "breakage.mohr_coulomb.tensile_strength",
            "expected at most cohesion/tan(friction_angle), where the shear limit ends, found more",
        );
    }

    fn strengths(keys: &mut Keys) -> Vec<Strength<'_>> {
        let all = [("cohesion", &mut keys.cohesion), ("tensile_strength", &mut keys.tensile_strength)];
        all.into_iter().map(|(key, value)| Strength { key, unit: "Pa", value }).collect()
    }

    #[inline(always)]
    fn judge<N: Number>(&self, loaded: &Loaded<N>) -> N {
        let (half, stress) = (N::splat(0.5), loaded.stress());
        let mean = -stress.pressure;
        let radius = |normal: N| (normal * normal * N::splat(0.25) + stress.shear * stress.shear).sqrt();
        let (stretched, compressed) = (mean + stress.bending, mean - stress.bending);
        let (larger, smaller) = (radius(stretched), radius(compressed));
        let friction = N::splat(self.friction);
        let two = N::splat(2.0);
        let shearing = (two * larger + stretched * friction).max(two * smaller + compressed * friction);
        let sheared = N::select(shearing.greater(N::splat(self.shear_limit)), N::splat(SHEAR), N::zero());
        let tension = half * stretched + larger;
        N::select(tension.greater(N::splat(self.tensile_strength)), N::splat(TENSION), sheared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::number::Vector;
    use crate::laws::bond::Section;

    /// c = 3 Pa, sin φ = 0.6, cos φ = 0.8, T = 2 Pa.
    const RULE: MohrCoulomb = MohrCoulomb { shear_limit: 4.8, friction: 0.6, tensile_strength: 2.0 };

    /// The cause for a bond of area and rim 1 under this normal force (above 0 pushes), shear force and bending stress.
    fn judge(rule: MohrCoulomb, push: f64, shear: f64, bending: f64) -> f64 {
        let loaded: Loaded = Loaded {
            distance: 1.0,
            section: Section { radius: 1.0, area: 1.0, polar: 0.5, axial: 0.25 },
            compression: push,
            normal: push,
            shear: Vector::new(0.0, shear, 0.0),
            torsion: 0.0,
            bending: Vector::new(0.0, 0.0, 0.25 * bending),
        };
        rule.judge(&loaded)
    }

    #[test]
    fn uniaxial_compression_breaks_at_the_strength_of_coulomb() {
        // 2 c cos φ/(1 − sin φ) = 12 Pa.
        assert_eq!([judge(RULE, 11.99, 0.0, 0.0), judge(RULE, 12.01, 0.0, 0.0)], [0.0, SHEAR]);
    }

    #[test]
    fn tension_breaks_at_its_limit_and_without_one_at_that_of_coulomb() {
        assert_eq!([judge(RULE, -1.99, 0.0, 0.0), judge(RULE, -2.01, 0.0, 0.0)], [0.0, TENSION]);
        // 2 c cos φ/(1 + sin φ) = 3 Pa.
        let whole = MohrCoulomb { tensile_strength: 4.0, ..RULE };
        assert_eq!([judge(whole, -2.99, 0.0, 0.0), judge(whole, -3.01, 0.0, 0.0)], [0.0, SHEAR]);
    }

    #[test]
    fn shear_alone_breaks_at_the_smaller_of_both_limits() {
        // c cos φ = 2.4 Pa against T = 2 Pa, and against 4 Pa.
        assert_eq!([judge(RULE, 0.0, 1.99, 0.0), judge(RULE, 0.0, 2.01, 0.0)], [0.0, TENSION]);
        let whole = MohrCoulomb { tensile_strength: 4.0, ..RULE };
        assert_eq!([judge(whole, 0.0, 2.39, 0.0), judge(whole, 0.0, 2.41, 0.0)], [0.0, SHEAR]);
    }

    #[test]
    fn normal_and_shear_stress_act_together() {
        // σ = 1, τ = √2: σ₁ = 1/2 + 3/2 = T.
        let shear = 2.0_f64.sqrt();
        assert_eq!([judge(RULE, -1.0, shear - 0.01, 0.0), judge(RULE, -1.0, shear + 0.01, 0.0)], [0.0, TENSION]);
        // σ = −4, τ: 2 √(4 + τ²) − 2.4 = 4.8 at τ = √8.96.
        let shear = 8.96_f64.sqrt();
        assert_eq!([judge(RULE, 4.0, shear - 0.01, 0.0), judge(RULE, 4.0, shear + 0.01, 0.0)], [0.0, SHEAR]);
    }

    #[test]
    fn bending_stretches_one_side_and_compresses_the_other() {
        assert_eq!([judge(RULE, 0.0, 0.0, 1.99), judge(RULE, 0.0, 0.0, 2.01)], [0.0, TENSION]);
        assert_eq!([judge(RULE, 11.0, 0.0, 0.99), judge(RULE, 11.0, 0.0, 1.01)], [0.0, SHEAR]);
    }
}
