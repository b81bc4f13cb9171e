//! Spheres at any porosity.

use super::Convection;
use crate::base::powers::{exp, ln};
use crate::laws::contact::NoKeys;

/// Gunn's law.
///
/// ```text
/// Nu = (7 − 10 ε + 5 ε²)(1 + 0.7 Re^0.2 Pr^⅓) + (1.33 − 2.4 ε + 1.2 ε²) Re^0.7 Pr^⅓
/// ```
///
/// It holds at porosities of 0.35 to 1 and Re ≤ 10⁵.
///
/// Source: Gunn 1978.
#[derive(Debug)]
pub struct Gunn;

impl Convection for Gunn {
    const NAME: &'static str = "gunn";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = false;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn nusselt(&self, porosity: f64, reynolds: f64, prandtl: f64) -> f64 {
        let root = libm::cbrt(prandtl);
        let logarithm = ln(reynolds);
        let (low, high) = (exp(0.2 * logarithm), exp(0.7 * logarithm));
        let of_layer = 7.0 + porosity * (5.0 * porosity - 10.0);
        let of_wake = 1.33 + porosity * (1.2 * porosity - 2.4);
        of_layer * (1.0 + 0.7 * low * root) + of_wake * high * root
    }
}
