//! A sphere that a shear flow overtakes or that goes ahead of it.

use super::{Lift, Rotation};
use crate::laws::contact::NoKeys;

/// Reynolds number from which the limit of fast flow holds.
const FAST: f64 = 40.0;

/// Saffman's lift in a shear flow, with Mei's factor for finite Reynolds numbers.
///
/// ```text
/// f_l = 1.615 J d² √(ρ µ/|∇ × u|) w × (∇ × u)        F = 1.615 J √Re_Ω
/// J = (1 − 0.3314 √α) e^(−Re/10) + 0.3314 √α   (Re < 40)        J = 0.0524 √(α Re)   (Re ≥ 40)        α = ½ Re_Ω/Re
/// ```
///
/// J → 1 for Re → 0: 6.46 µ a² w √(γ/ν) by the radius a, in a shear of the rate γ. A sphere that lags behind is lifted to where the fluid is
/// faster. Mei's fit is of α from 0.005 to 0.4 and Re up to 100.
///
/// Source: Saffman 1965 and 1968; Mei 1992.
#[derive(Debug)]
pub struct SaffmanMei;

impl Lift for SaffmanMei {
    const NAME: &'static str = "saffman_mei";
    type Keys = NoKeys;
    const ROTATION: Rotation = Rotation::Vorticity;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline]
    fn factor(&self, reynolds: f64, rotation: f64) -> f64 {
        // √α (1 − e^(−Re/10)) vanishes with Re.
        let root = (0.5 * rotation / reynolds.max(f64::MIN_POSITIVE)).sqrt();
        let slow = libm::exp(-0.1 * reynolds) - 0.3314 * root * libm::expm1(-0.1 * reynolds);
        let fast = 0.0524 * (0.5 * rotation).sqrt();
        1.615 * (if reynolds < FAST { slow } else { fast }) * rotation.sqrt()
    }
}
