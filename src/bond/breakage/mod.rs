//! When a bond breaks. One criterion a file; the distance is looked at by each.

pub mod distance;
pub mod stress;

use super::{Coefficients, Elastic, Motion, Section};
use crate::number::Number;

/// Why a bond broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Cause {
    /// The centres are further apart than `max_distance`.
    Distance,
    /// The normal stress, and no less of it from stretching than from bending.
    Tension,
    /// The normal stress, and no less of it from compression than from bending.
    Compression,
    /// The shear stress, and no less of it from the shear force than from torsion.
    Shear,
    /// The normal stress, most of it from bending.
    Bending,
    /// The shear stress, most of it from torsion.
    Torsion,
}

impl Cause {
    /// All causes.
    const ALL: [Self; 6] =
        [Self::Distance, Self::Tension, Self::Compression, Self::Shear, Self::Bending, Self::Torsion];

    /// The cause that a lane's code stands for; `None` for a living bond (0).
    pub fn from_code(code: f64) -> Option<Self> {
        Self::ALL.into_iter().find(|cause| cause.code() == code)
    }

    /// The number that stands for it in a lane, above 0.
    pub fn code(self) -> f64 {
        match self {
            Self::Distance => 1.0,
            Self::Tension => 2.0,
            Self::Compression => 3.0,
            Self::Shear => 4.0,
            Self::Bending => 5.0,
            Self::Torsion => 6.0,
        }
    }

    /// Its name in `breakage.csv`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Tension => "tension",
            Self::Compression => "compression",
            Self::Shear => "shear",
            Self::Bending => "bending",
            Self::Torsion => "torsion",
        }
    }
}

/// A criterion of breakage.
pub trait Breakage: Send + Sync + 'static {
    /// 0, or the [`Cause::code`]. Where several hold: distance before normal before shear stress.
    fn judge<N: Number>(law: &Coefficients<N>, motion: &Motion<N>, elastic: &Elastic<N>) -> N;
}

/// Stresses at the rim of the bond, without damping.
///
/// ```text
/// σ = ±|N|/A + |T_t| r_b/I        τ = |F_t|/A + |T_n| r_b/J
/// ```
///
/// + where the bond is stretched, or where compression breaks; − where compression relieves.
#[derive(Clone, Copy, Debug)]
pub struct Stress<N: Number = f64> {
    /// σ \[Pa\].
    pub normal: N,
    /// The part of σ that bending makes, |T_t| r_b/I \[Pa\].
    pub bending: N,
    /// τ \[Pa\].
    pub shear: N,
    /// The part of τ that torsion makes, |T_n| r_b/J \[Pa\].
    pub torsion: N,
    /// Mean compressive stress sgn(u) |N|/A \[Pa\].
    pub pressure: N,
}

impl<N: Number> Stress<N> {
    /// Of this bond.
    #[inline(always)]
    pub fn of(law: &Coefficients<N>, section: &Section<N>, elastic: &Elastic<N>) -> Self {
        let per_area = N::splat(1.0) / section.area;
        let per_rim = per_area / section.radius;
        let mean = elastic.normal.abs() * per_area;
        let compressed = elastic.compression.greater(N::zero());
        let stretched = N::zero().greater(elastic.compression);
        let sign = N::select(compressed, N::splat(1.0), N::select(stretched, N::splat(-1.0), N::zero()));
        // r_b/I = 4/(A r_b) and r_b/J = 2/(A r_b) of a full circle.
        let bending = elastic.bending.length() * N::splat(4.0) * per_rim;
        let torsion = elastic.torsion.abs() * N::splat(2.0) * per_rim;
        Self {
            normal: mean * N::select(compressed, law.compression_share, N::splat(1.0)) + bending,
            bending,
            shear: elastic.shear.length() * per_area + torsion,
            torsion,
            pressure: mean * sign,
        }
    }
}
