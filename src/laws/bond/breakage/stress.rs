//! Breakage by the largest stresses at the rim.

use super::{Breakage, BreakageChoice, Loaded, Strength, distance};
use crate::base::document::keys;
use crate::base::number::Number;
use crate::base::quantity::{NonNegative, Positive};
use crate::laws::bond::formulation::FormulationChoice;
use crate::laws::bond::key_error::KeyError;

keys! {
    /// Those of [`StressLimits`], in `[bond.<name>.breakage]`.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// Limit S of σ \[Pa\].
        pub max_normal_stress: Option<Positive> = "∞",
        /// Limit of τ \[Pa\].
        pub max_shear_stress: Option<Positive> = "∞",
        /// S of a stretched bond over that of a compressed one.
        pub tension_ratio: Option<Positive> = "1",
        /// φ, below π/2: the limit of τ rises by tan φ times the compressive stress, and falls so with tension \[rad\].
        pub friction_angle: Option<NonNegative> = "0",
        /// Whether compression adds \|N\|/A to σ, not −\|N\|/A (Potyondy & Cundall).
        pub compression_breaks: Option<bool> = "`false`; `engine_exact`: `true`",
    }
}

/// |u| below which the engine takes a bond for stretched \[m\].
const STRETCHED_BELOW: f64 = 1e-16;

/// Breaks where σ > S' or τ > τ' (the engine with `stressBreak`).
///
/// ```text
/// σ  = ±|N|/A + |T_t| r_b/I        + where stretched, or where compression breaks; − where it relieves
/// τ  = |F_t|/A + |T_n| r_b/J
/// S' = tension strength where u < 1e-16 m, else compression strength
/// τ' = shear strength + sgn(u) |N|/A tan φ
/// ```
///
/// The stress that is too large has two parts: tension or compression and bending, or shear and torsion. The larger part
/// names the cause. Where compression relieves, a compressed bond hence breaks by bending.
///
/// After the evaluation of this step and without damping. With friction, compression raises the shear strength and
/// tension lowers it, below 0 if need be: Mohr and Coulomb's limit on the mean normal stress. A strength that is not
/// given is ∞.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressLimits {
    /// Largest normal stress of a compressed bond, or ∞ \[Pa\].
    pub compression_strength: f64,
    /// Largest normal stress of a stretched bond, or ∞ \[Pa\].
    pub tension_strength: f64,
    /// Largest shear stress without normal force, or ∞ \[Pa\].
    pub shear_strength: f64,
    /// tan φ: growth of the shear strength with the compressive stress.
    pub friction: f64,
    /// What compression adds to the normal stress, over |N|/A: 1 where compression breaks, −1 where it relieves.
    pub compression_share: f64,
}

/// Place of `tension` among [`StressLimits::CAUSES`], from 1.
const TENSION: f64 = 1.0;
/// Place of `compression`.
const COMPRESSION: f64 = 2.0;
/// Place of `shear`.
const SHEAR: f64 = 3.0;
/// Place of `bending`.
const BENDING: f64 = 4.0;
/// Place of `torsion`.
const TORSION: f64 = 5.0;

impl Keys {
    /// What compression adds to the normal stress over |N|/A: 1 where compression breaks, −1 where it relieves.
    pub(in crate::laws::bond) fn compression_share(&self, formulation: FormulationChoice) -> f64 {
        if self.compression_breaks.unwrap_or(formulation.is_engine()) { 1.0 } else { -1.0 }
    }
}

impl Breakage for StressLimits {
    const NAME: &'static str = "stress";
    type Keys = Keys;
    const FLAT_KEYS: &'static [&'static str] =
        &["max_normal_stress", "max_shear_stress", "tension_ratio", "friction_angle", "compression_breaks"];
    const LIMITS: &'static [&'static str] = &["max_normal_stress", "max_shear_stress"];
    const CAUSES: &'static [&'static str] = &["tension", "compression", "shear", "bending", "torsion"];
    const IS_THE_ENGINES: bool = true;

    fn of(keys: &Keys, formulation: FormulationChoice) -> Self {
        let strength = keys.max_normal_stress.map_or(f64::INFINITY, Positive::get);
        Self {
            compression_strength: strength,
            tension_strength: strength * keys.tension_ratio.map_or(1.0, Positive::get),
            shear_strength: keys.max_shear_stress.map_or(f64::INFINITY, Positive::get),
            friction: keys.friction_angle.map_or(0.0, |angle| libm::tan(angle.get())),
            compression_share: keys.compression_share(formulation),
        }
    }

    fn strengths(keys: &mut Keys) -> Vec<Strength<'_>> {
        let all = [
            ("max_normal_stress", keys.max_normal_stress.as_mut()),
            ("max_shear_stress", keys.max_shear_stress.as_mut()),
        ];
        all.into_iter().filter_map(|(key, value)| Some(Strength { key, unit: "Pa", value: value? })).collect()
    }

    fn check(keys: &Keys, all: &[BreakageChoice], formulation: FormulationChoice, wrong: &mut Vec<KeyError>) {
        let (no_normal, no_shear) = (keys.max_normal_stress.is_none(), keys.max_shear_stress.is_none());
        let mut add = |there: bool, key: &'static str, message: &str| KeyError::add(wrong, there, key, message);
        add(
            keys.tension_ratio.is_some() && no_normal,
            "breakage.tension_ratio",
            "expected max_normal_stress beside it, which it multiplies, found none",
        );
        add(
            keys.friction_angle.is_some() && no_shear,
            "breakage.friction_angle",
            "expected max_shear_stress beside it, which it raises, found none",
        );
        add(
            keys.friction_angle.is_some_and(|angle| angle.get() >= std::f64::consts::FRAC_PI_2),
            "breakage.friction_angle",
            "expected radians from 0 to below π/2, found an angle of π/2 or more",
        );
        add(
            keys.compression_breaks.is_some() && no_normal,
            "breakage.compression_breaks",
            "expected max_normal_stress beside it, to which it belongs, found none",
        );
        let exact = formulation.is_engine();
        add(
            exact && keys.compression_breaks == Some(false),
            "breakage.compression_breaks",
            "expected true, as compression always breaks in engine_exact, found false",
        );
        add(
            exact && all.iter().any(|rule| rule.keys::<distance::Keys>().is_some()),
            "breakage.max_distance",
            "expected one limit, as engine_exact looks at one, found a largest stress beside it",
        );
    }

    #[inline(always)]
    fn judge<N: Number>(&self, loaded: &Loaded<N>) -> N {
        let stress = loaded.stress();
        let normal = loaded.normal_stress(&stress, N::splat(self.compression_share));
        let stretched = N::splat(STRETCHED_BELOW).greater(loaded.compression);
        let strength = N::select(stretched, N::splat(self.tension_strength), N::splat(self.compression_strength));
        let axial = N::select(stretched, N::splat(TENSION), N::splat(COMPRESSION));
        let bent = stress.bending.greater(normal - stress.bending);
        let normal_cause = N::select(bent, N::splat(BENDING), axial);
        let twisted = stress.torsion.greater(stress.shear - stress.torsion);
        let shear_cause = N::select(twisted, N::splat(TORSION), N::splat(SHEAR));
        let shear_strength = N::splat(self.shear_strength) + stress.pressure * N::splat(self.friction);
        let by_shear = N::select(stress.shear.greater(shear_strength), shear_cause, N::zero());
        N::select(normal.greater(strength), normal_cause, by_shear)
    }
}
