//! Spheres at any porosity, by a power of it.

use super::Drag;
use crate::base::powers::{exp, ln, power};
use crate::laws::contact::NoKeys;
use std::f64::consts::LOG10_E;

/// Di Felice's law: Dallavalle's drag of one sphere times a power of the porosity.
///
/// ```text
/// F = (0.63 √Re + 4.8)²/24 · ε^(−χ)        χ = 3.7 − 0.65 exp(−½ (1.5 − lg Re)²)
/// ```
///
/// It holds at any porosity and Reynolds number. One sphere at Re → 0 has F = 0.96, not 1.
///
/// Source: Di Felice 1994; Dallavalle 1948.
#[derive(Debug)]
pub struct DiFelice;

impl Drag for DiFelice {
    const NAME: &'static str = "di_felice";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = false;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn factor(&self, porosity: f64, reynolds: f64) -> f64 {
        let root = 0.63 * reynolds.sqrt() + 4.8;
        let from_middle = 1.5 - ln(reynolds) * LOG10_E;
        let exponent = 3.7 - 0.65 * exp(-0.5 * from_middle * from_middle);
        root * root / 24.0 * power(porosity, -exponent)
    }
}
