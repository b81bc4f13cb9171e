//! The numbers of a bond law: as the scene gives them, and as the loop takes them.

use crate::number::Number;

/// One number for each of the four parts of a bond: normal force, shear force, torsion, bending torque.
pub type Parts<N = f64> = [N; 4];

/// The law of a `[bond.<name>]` table in numbers.
///
/// What is off is a number that changes nothing: stiffness 0, strength ∞, relaxation rate 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// λ: bond radius over the smaller radius.
    pub radius_multiplier: f64,
    /// k_n where the bond is stretched; 0 without `tension` \[Pa/m\].
    pub tension: f64,
    /// k_n where it is compressed; 0 without `compression` \[Pa/m\].
    pub compression: f64,
    /// k_t of the shear force; 0 without `shear` \[Pa/m\].
    pub shear: f64,
    /// k_t of the torsion; 0 without `torsion` \[Pa/m\].
    pub torsion: f64,
    /// k_n of the bending torque; 0 without `bending` \[Pa/m\].
    pub bending: f64,
    /// |u| up to which there is no normal force \[m\].
    pub dead_band: f64,
    /// Distance of the centres beyond which the bond breaks, or ∞ \[m\].
    pub max_distance: f64,
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
    /// α, or damping ratio, of each part.
    pub damping: Parts,
    /// Speed below which the damping of the two forces grows linearly: this, over R_min and times the step.
    pub threshold: f64,
    /// The same from the force: this, times force \[N\] and step \[s\], as the engine has it.
    pub threshold_by_force: f64,
    /// 1/τ of each part; 0 without relaxation \[1/s\].
    pub relaxation_rate: Parts,
}

impl Law {
    /// A conservative bond that does not break.
    pub fn elastic(radius_multiplier: f64, normal_stiffness: f64, tangential_stiffness: f64) -> Self {
        Self {
            radius_multiplier,
            tension: normal_stiffness,
            compression: normal_stiffness,
            shear: tangential_stiffness,
            torsion: tangential_stiffness,
            bending: normal_stiffness,
            dead_band: 0.0,
            max_distance: f64::INFINITY,
            compression_strength: f64::INFINITY,
            tension_strength: f64::INFINITY,
            shear_strength: f64::INFINITY,
            friction: 0.0,
            compression_share: -1.0,
            damping: [0.0; 4],
            threshold: 0.0,
            threshold_by_force: 0.0,
            relaxation_rate: [0.0; 4],
        }
    }

    /// Whether a living bond loses energy.
    pub fn dissipates(&self) -> bool {
        self.damping != [0.0; 4] || self.relaxation_rate != [0.0; 4]
    }

    /// k_n A, k_t A, k_t J, k_n I of a bond between bodies whose smaller radius is this \[m\], for the stable
    /// time step \[N/m, N m\].
    pub fn stiffness(&self, least_radius: f64) -> Parts {
        let section = super::Section::of(self.radius_multiplier, least_radius);
        let normal = self.tension.max(self.compression);
        [normal * section.area, self.shear * section.area, self.torsion * section.polar, self.bending * section.axial]
    }

    /// What the loop takes for a time step of this length \[s\], which may be 0.
    #[inline(always)]
    pub fn coefficients<N: Number>(&self, step: f64) -> Coefficients<N> {
        let per_step = |threshold: f64| if threshold > 0.0 { threshold / step } else { 0.0 };
        Coefficients {
            step: N::splat(step),
            radius_multiplier: N::splat(self.radius_multiplier),
            tension: N::splat(self.tension),
            compression: N::splat(self.compression),
            shear: N::splat(self.shear),
            torsion: N::splat(self.torsion),
            bending: N::splat(self.bending),
            dead_band: N::splat(self.dead_band),
            max_distance: N::splat(self.max_distance),
            compression_strength: N::splat(self.compression_strength),
            tension_strength: N::splat(self.tension_strength),
            shear_strength: N::splat(self.shear_strength),
            friction: N::splat(self.friction),
            compression_share: N::splat(self.compression_share),
            damping: self.damping.map(N::splat),
            threshold: N::splat(per_step(self.threshold)),
            threshold_by_force: N::splat(self.threshold_by_force * step),
            relaxed: self.relaxation_rate.map(|rate| N::splat((step * rate).min(1.0))),
        }
    }
}

/// [`Law`] for one time step, the same in every lane.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients<N: Number = f64> {
    /// Length of the time step that led to the present positions; 0 before the first \[s\].
    pub step: N,
    /// [`Law::radius_multiplier`].
    pub radius_multiplier: N,
    /// [`Law::tension`] \[Pa/m\].
    pub tension: N,
    /// [`Law::compression`] \[Pa/m\].
    pub compression: N,
    /// [`Law::shear`] \[Pa/m\].
    pub shear: N,
    /// [`Law::torsion`] \[Pa/m\].
    pub torsion: N,
    /// [`Law::bending`] \[Pa/m\].
    pub bending: N,
    /// [`Law::dead_band`] \[m\].
    pub dead_band: N,
    /// [`Law::max_distance`] \[m\].
    pub max_distance: N,
    /// [`Law::compression_strength`] \[Pa\].
    pub compression_strength: N,
    /// [`Law::tension_strength`] \[Pa\].
    pub tension_strength: N,
    /// [`Law::shear_strength`] \[Pa\].
    pub shear_strength: N,
    /// [`Law::friction`].
    pub friction: N,
    /// [`Law::compression_share`].
    pub compression_share: N,
    /// [`Law::damping`].
    pub damping: Parts<N>,
    /// [`Law::threshold`] over the step \[1/s\].
    pub threshold: N,
    /// [`Law::threshold_by_force`] times the step \[s/kg, whatever the engine calls it\].
    pub threshold_by_force: N,
    /// min(Δt/τ, 1) of each part.
    pub relaxed: Parts<N>,
}

impl<N: Number> Coefficients<N> {
    /// What relaxation leaves of each part.
    #[inline(always)]
    pub fn left(&self) -> Parts<N> {
        let one = N::splat(1.0);
        let [normal, shear, torsion, bending] = self.relaxed;
        [one - normal, one - shear, one - torsion, one - bending]
    }

    /// Normal stiffness per unit area at this compression u (0 inside the dead band) \[Pa/m\].
    #[inline(always)]
    pub fn normal_stiffness(&self, compression: N) -> N {
        let stretched = (-compression).greater(self.dead_band);
        let compressed = compression.greater(self.dead_band);
        N::select(stretched, self.tension, N::select(compressed, self.compression, N::zero()))
    }
}
