//! When a bond breaks. Each rule is one file and one row in the list below.
//!
//! A scene may name several rules. Each is applied to every bond, and the first of the list that is fulfilled names the
//! cause. The file of a rule has its keys with their check, its numbers, its condition, and the causes that it reports; its
//! row makes it part of `[bond.<name>.breakage]`. No other code knows the rule.

mod columns;
pub mod distance;
pub mod mohr_coulomb;
mod row;
pub mod stress;

pub(crate) use columns::LoadedBonds;
pub(in crate::laws::bond) use row::NewStrengths;
pub use row::{BreakageChoice, BreakageRow, Rule};

pub use crate::laws::bond::key_error::KeyError;
pub use crate::laws::kept::ModelKeys;

use super::Section;
use super::formulation::FormulationChoice;
use crate::base::number::{Number, Vector};
use crate::base::quantity::Positive;

/// The rules of the program.
pub(crate) const STANDARD: &[&BreakageRow] = &[
    BreakageRow::of::<distance::Distance>(),
    BreakageRow::of::<stress::StressLimits>(),
    BreakageRow::of::<mohr_coulomb::MohrCoulomb>(),
];

/// A rule of breakage, in numbers.
pub trait Breakage: Copy + std::fmt::Debug + Send + Sync + 'static {
    /// Its name: that of its table `[bond.<name>.breakage.<rule>]`.
    const NAME: &'static str;
    /// What the scene writes of it.
    type Keys: ModelKeys;
    /// The keys of a rule that has no table of its own: they stand in `[bond.<name>.breakage]`.
    const FLAT_KEYS: &'static [&'static str] = &[];
    /// Its keys in `[bond.<name>.breakage]` of which one at least must be given for it to act.
    const LIMITS: &'static [&'static str] = &[Self::NAME];
    /// The causes that it reports, by their names in `breakage.csv`.
    const CAUSES: &'static [&'static str];
    /// Whether LIGGGHTS-INL has it.
    const IS_THE_ENGINES: bool = false;
    /// The rule that the keys mean for a bond of this formulation.
    fn of(keys: &Self::Keys, formulation: FormulationChoice) -> Self;
    /// Reports contradictions among the keys, or with the other rules of the table, each at its key, as `breakage.<key>`.
    fn check(_keys: &Self::Keys, _all: &[BreakageChoice], _formulation: FormulationChoice, _wrong: &mut Vec<KeyError>) {
    }
    /// The strengths among the keys, which a unit may change while it runs.
    fn strengths(_keys: &mut Self::Keys) -> Vec<Strength<'_>> {
        Vec::new()
    }
    /// 0 if the bond holds, else the place of its cause in [`Breakage::CAUSES`], from 1.
    fn judge<N: Number>(&self, loaded: &Loaded<N>) -> N;
}

/// A strength among the keys of a rule.
#[derive(Debug)]
pub struct Strength<'a> {
    /// Its key.
    pub key: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its value.
    pub value: &'a mut Positive,
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
