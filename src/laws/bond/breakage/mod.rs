//! When a bond breaks. Each rule is one file and one row in the list below.
//!
//! A scene may name several rules. Each is applied to every bond, and the first of the list that is fulfilled names the
//! cause. The file of a rule has its keys with their check, its numbers, its condition, and the causes that it reports; its
//! row makes it part of `[bond.<name>.breakage]`. No other code knows the rule.

pub mod distance;
mod keys;
pub mod mohr_coulomb;
pub mod stress;

pub use keys::{KeysOf, Strength};
pub(in crate::laws::bond) use keys::{breakage_rules, flat_keys, named_keys};

use super::Section;
use super::formulation::FormulationChoice;
use super::key_error::KeyError;
use crate::base::number::{Number, Vector};

breakage_rules! {
    distance: distance::Distance,
    stress: stress::StressLimits,
    mohr_coulomb: mohr_coulomb::MohrCoulomb,
}

/// A rule of breakage, in numbers.
pub trait Breakage: Copy + std::fmt::Debug + PartialEq + Send + Sync + 'static {
    /// What the scene writes of it.
    type Keys: KeysOf;
    /// The keys of which at least one must be given for the rule to act.
    const LIMITS: &'static [&'static str];
    /// The causes that it reports, by their names in `breakage.csv`.
    const CAUSES: &'static [&'static str];
    /// The rule that the keys mean for a bond of this formulation, if they name this one at all.
    fn of(own: &Self::Keys, formulation: FormulationChoice) -> Option<Self>;
    /// Reports contradictions among the keys, or with those of the other rules, each with its key below `breakage`.
    fn check(own: &Self::Keys, all: &BreakageKeys, formulation: FormulationChoice, wrong: &mut Vec<KeyError>);
    /// 0 if the bond holds, else the place of its cause in [`Breakage::CAUSES`], from 1.
    fn judge<N: Number>(&self, loaded: &Loaded<N>) -> N;
}

/// A bond under its load, without damping, at the end of a time step: the input of a rule.
#[derive(Clone, Copy, Debug)]
pub struct Loaded<N: Number = f64> {
    /// Distance of the centres, at a plane that of the centre from the foot \[m\].
    pub distance: N,
    /// The cross-section.
    pub section: Section<N>,
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
}

/// Stresses at the rim of a bond.
///
/// ```text
/// |N|/A      |T_t| r_b/I      |F_t|/A      |T_n| r_b/J
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Stress<N: Number = f64> {
    /// |N|/A \[Pa\].
    pub mean: N,
    /// Mean compressive stress sgn(u) |N|/A \[Pa\].
    pub pressure: N,
    /// Normal stress that bending makes, |T_t| r_b/I \[Pa\].
    pub bending: N,
    /// Shear stress of the shear force and of torsion, |F_t|/A + |T_n| r_b/J \[Pa\].
    pub shear: N,
    /// The part of it that torsion makes, |T_n| r_b/J \[Pa\].
    pub torsion: N,
}

impl<N: Number> Loaded<N> {
    /// Its stresses.
    #[inline(always)]
    pub fn stress(&self) -> Stress<N> {
        let per_area = N::splat(1.0) / self.section.area;
        let per_rim = per_area / self.section.radius;
        let mean = self.normal.abs() * per_area;
        let compressed = self.compression.greater(N::zero());
        let stretched = N::zero().greater(self.compression);
        let sign = N::select(compressed, N::splat(1.0), N::select(stretched, N::splat(-1.0), N::zero()));
        // r_b/I = 4/(A r_b) and r_b/J = 2/(A r_b) of a full circle.
        let bending = self.bending.length() * N::splat(4.0) * per_rim;
        let torsion = self.torsion.abs() * N::splat(2.0) * per_rim;
        Stress { mean, pressure: mean * sign, bending, shear: self.shear.length() * per_area + torsion, torsion }
    }

    /// Normal stress at the rim: mean and bending, the mean of a compressed bond times this share (1 if compression
    /// breaks, −1 if it relieves) \[Pa\].
    #[inline(always)]
    pub fn normal_stress(&self, stress: &Stress<N>, compression_share: N) -> N {
        let compressed = self.compression.greater(N::zero());
        stress.mean * N::select(compressed, compression_share, N::splat(1.0)) + stress.bending
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_causes_are_counted_through_the_list() {
        let names: Vec<&str> = (1..20).map_while(|code| cause_name(f64::from(code))).collect();
        assert_eq!(names[..6], ["distance", "tension", "compression", "shear", "bending", "torsion"]);
        assert_eq!(names.len(), CAUSES.iter().map(|causes| causes.len()).sum::<usize>());
        assert_eq!((cause_name(0.0), cause_name(-1.0), cause_name(1e9)), (None, None, None));
    }
}
