//! Lift: what a fluid does to a sphere across its flow. Each law is one file and one row in the list below.
//!
//! A law is a factor F of two Reynolds numbers. The fluid makes of it the force on a sphere of diameter d whose velocity the velocity of
//! the fluid exceeds by w, about a rotation Ω:
//!
//! ```text
//! f_l = µ d F(Re, Re_Ω) w × Ω/|Ω|        Re = ρ d ε |w|/µ        Re_Ω = ρ d² |Ω|/µ
//! ```
//!
//! It does no work against the slip w. The rotation is the vorticity of the fluid, Ω = ∇ × u, or the spin of the sphere in the fluid,
//! Ω = ω − ½ ∇ × u.

pub mod magnus;
mod row;
pub mod saffman_mei;

pub(crate) use row::Across;
pub use row::{LiftModel, LiftRow};

use super::kept::ModelKeys;

/// The laws of lift of the program.
pub(crate) const STANDARD: &[&LiftRow] = &[LiftRow::of::<saffman_mei::SaffmanMei>(), LiftRow::of::<magnus::Magnus>()];

/// About what a lift acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotation {
    /// The vorticity of the fluid: that of a fluid with one velocity for all places is 0.
    Vorticity,
    /// The angular velocity of the sphere beyond that of the fluid, which is half its vorticity.
    Spin,
}

/// A law of lift, in numbers.
pub trait Lift: std::fmt::Debug + Send + Sync + 'static {
    /// Its name: that of its table `[fluid.<name>.lift.<law>]`.
    const NAME: &'static str;
    /// What the scene writes of it.
    type Keys: ModelKeys;
    /// About what it acts.
    const ROTATION: Rotation;
    /// The law that the keys mean.
    fn of(keys: &Self::Keys) -> Self;
    /// Lift over µ d |w| where slip and rotation are at right angles, at Reynolds numbers of 0 or above of the slip and of the rotation. It
    /// is finite.
    fn factor(&self, reynolds: f64, rotation: f64) -> f64;
}

#[cfg(test)]
mod tests {
    use super::Lift;
    use super::magnus::Magnus;
    use super::saffman_mei::SaffmanMei;
    use std::f64::consts::PI;

    #[test]
    fn in_a_slow_shear_lift_is_that_of_saffman() {
        // Saffman 1968: 6.46 µ a² w √(γ/ν), by the radius a.
        let (mu, rho, a, w, shear) = (1e-3, 1000.0, 5e-5, 1e-9, 1e-3_f64);
        let expected = 6.46 * mu * a * a * w * (shear * rho / mu).sqrt();
        let [reynolds, rotation] = [rho * w * 2.0 * a / mu, rho * shear * 4.0 * a * a / mu];
        let found = mu * 2.0 * a * w * SaffmanMei.factor(reynolds, rotation);
        assert!((found / expected - 1.0).abs() < 1e-5, "{found:e} N, Saffman {expected:e} N");
    }

    #[test]
    fn faster_flow_lifts_as_mei_says() {
        // α = ½ Re_Ω/Re. At Re = 10 and α = 0.25: J = (1 − 0.1657) e⁻¹ + 0.1657.
        let found = SaffmanMei.factor(10.0, 5.0);
        let expected = 1.615 * 5.0_f64.sqrt() * ((1.0 - 0.1657) * (-1.0_f64).exp() + 0.1657);
        assert!((found / expected - 1.0).abs() < 1e-14, "{found}, expected {expected}");
        // At Re = 100 and α = 0.16: J = 0.0524 · 4.
        let found = SaffmanMei.factor(100.0, 32.0);
        let expected = 1.615 * 32.0_f64.sqrt() * 0.0524 * 4.0;
        assert!((found / expected - 1.0).abs() < 1e-14, "{found}, expected {expected}");
    }

    #[test]
    fn a_sphere_that_spins_is_lifted_as_rubinow_and_keller_say() {
        // π a³ ρ ω w, by the radius a.
        let (mu, rho, a, w, spin) = (1e-3, 1000.0, 2e-4, 1e-3, 7.0);
        let found = mu * 2.0 * a * w * Magnus.factor(rho * w * 2.0 * a / mu, rho * spin * 4.0 * a * a / mu);
        let expected = PI * a * a * a * rho * spin * w;
        assert!((found / expected - 1.0).abs() < 1e-14, "{found:e} N, expected {expected:e} N");
    }

    #[test]
    fn every_law_is_a_number_whatever_the_flow() {
        for reynolds in [0.0, 1e-300, 1e-9, 1.0, 39.99, 40.0, 1e9] {
            for rotation in [0.0, 1e-300, 1e-9, 1.0, 1e9] {
                for factor in [SaffmanMei.factor(reynolds, rotation), Magnus.factor(reynolds, rotation)] {
                    assert!(factor.is_finite() && factor >= 0.0, "{factor} at {reynolds}, {rotation}");
                }
            }
        }
    }
}
