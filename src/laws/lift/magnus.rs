//! A sphere that spins in the fluid.

use super::{Lift, Rotation};
use crate::laws::contact::NoKeys;
use std::f64::consts::PI;

/// Magnus' lift on a sphere that spins, by Rubinow and Keller.
///
/// ```text
/// f_l = π/8 d³ ρ w × (ω − ½ ∇ × u)        F = π/8 Re_Ω
/// ```
///
/// It holds for small Re. Beyond Re of about 5 spheres are lifted less.
///
/// Source: Rubinow and Keller 1961.
#[derive(Debug)]
pub struct Magnus;

impl Lift for Magnus {
    const NAME: &'static str = "magnus";
    type Keys = NoKeys;
    const ROTATION: Rotation = Rotation::Spin;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline]
    fn factor(&self, _reynolds: f64, rotation: f64) -> f64 {
        PI / 8.0 * rotation
    }
}
