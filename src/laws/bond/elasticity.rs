//! What every formulation takes from the scene: section, stiffnesses, relaxation.

use super::Section;
use crate::base::number::Number;

/// One number for each of the four parts of a bond: normal force, shear force, torsion, bending torque.
pub type Parts<N = f64> = [N; 4];

/// Section, stiffnesses and relaxation of a bond law. A part that the bond does not bear has stiffness 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity<N = f64> {
    /// λ: bond radius over the smaller radius.
    pub radius_multiplier: N,
    /// k_n where the bond is stretched \[Pa/m\].
    pub tension: N,
    /// k_n where it is compressed \[Pa/m\].
    pub compression: N,
    /// k_t of the shear force \[Pa/m\].
    pub shear: N,
    /// k_t of the torsion \[Pa/m\].
    pub torsion: N,
    /// k_n of the bending torque \[Pa/m\].
    pub bending: N,
    /// |u| up to which there is no normal force \[m\].
    pub dead_band: N,
    /// 1/τ of each part; 0 without relaxation \[1/s\].
    pub relaxation_rate: Parts<N>,
}

impl Elasticity {
    /// Stiffness in all four parts, no relaxation.
    pub fn of(radius_multiplier: f64, normal_stiffness: f64, tangential_stiffness: f64) -> Self {
        Self {
            radius_multiplier,
            tension: normal_stiffness,
            compression: normal_stiffness,
            shear: tangential_stiffness,
            torsion: tangential_stiffness,
            bending: normal_stiffness,
            dead_band: 0.0,
            relaxation_rate: [0.0; 4],
        }
    }

    /// k_n A, k_t A, k_t J, k_n I of a bond between bodies whose smaller radius is this \[m\], for the stable
    /// time step \[N/m, N m\].
    pub fn stiffness(&self, least_radius: f64) -> Parts {
        let section = Section::of(self.radius_multiplier, least_radius);
        let normal = self.tension.max(self.compression);
        [normal * section.area, self.shear * section.area, self.torsion * section.polar, self.bending * section.axial]
    }

    /// Whether any part relaxes.
    pub fn relaxes(&self) -> bool {
        self.relaxation_rate != [0.0; 4]
    }

    /// The same in every lane, for a time step of this length \[s\], which may be 0.
    #[inline(always)]
    pub fn at_step<N: Number>(&self, step: f64) -> Coefficients<N> {
        Coefficients {
            step: N::splat(step),
            elastic: Elasticity {
                radius_multiplier: N::splat(self.radius_multiplier),
                tension: N::splat(self.tension),
                compression: N::splat(self.compression),
                shear: N::splat(self.shear),
                torsion: N::splat(self.torsion),
                bending: N::splat(self.bending),
                dead_band: N::splat(self.dead_band),
                relaxation_rate: self.relaxation_rate.map(N::splat),
            },
            relaxed: self.relaxation_rate.map(|rate| N::splat((step * rate).min(1.0))),
            relaxes: self.relaxes(),
        }
    }
}

/// [`Elasticity`] for one time step.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients<N: Number = f64> {
    /// Length of the time step that led to the present positions; 0 before the first \[s\].
    pub step: N,
    /// Section and stiffnesses.
    pub elastic: Elasticity<N>,
    /// min(Δt/τ, 1) of each part.
    pub relaxed: Parts<N>,
    /// Whether any of them is not 0 at every step.
    pub relaxes: bool,
}

impl<N: Number> Coefficients<N> {
    /// What relaxation leaves of each part.
    #[inline(always)]
    pub fn left(&self) -> Parts<N> {
        let one = N::splat(1.0);
        let [normal, shear, torsion, bending] = self.relaxed;
        [one - normal, one - shear, one - torsion, one - bending]
    }

    /// Normal stiffness per unit area at this compression u (0 inside the dead band) \[Pa/m\]. Without a dead band a bond of its
    /// free length has that of compression: its dashpot acts there, too.
    #[inline(always)]
    pub fn normal_stiffness(&self, compression: N) -> N {
        let Elasticity { tension, compression: pushing, dead_band, .. } = self.elastic;
        let stretched = (-compression).greater(dead_band);
        let inside = dead_band.greater(compression);
        N::select(stretched, tension, N::select(inside, N::zero(), pushing))
    }

    /// The cross-section of a bond between bodies whose smaller radius is this \[m\].
    #[inline(always)]
    pub fn section(&self, least_radius: N) -> Section<N> {
        Section::of(self.elastic.radius_multiplier, least_radius)
    }
}
