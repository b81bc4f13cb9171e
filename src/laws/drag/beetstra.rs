//! Spheres at any porosity, by flow through random arrays, up to higher Reynolds numbers.

use super::Drag;
use crate::base::powers::{exp, ln};
use crate::laws::contact::NoKeys;
use std::f64::consts::LN_10;

/// Beetstra, van der Hoef and Kuipers' law, a fit of lattice-Boltzmann simulations of random arrays of spheres.
///
/// ```text
/// F = 10 φ/ε² + ε² (1 + 1.5 √φ) + 0.413 Re/(24 ε²) · (1/ε + 3 ε φ + 8.4 Re^(−0.343))/(1 + 10^(3φ) Re^(−(1 + 4φ)/2))
/// ```
///
/// φ = 1 − ε. It holds for Re up to 1000.
///
/// Source: Beetstra, van der Hoef and Kuipers 2007.
#[derive(Debug)]
pub struct Beetstra;

impl Drag for Beetstra {
    const NAME: &'static str = "beetstra";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = false;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn factor(&self, porosity: f64, reynolds: f64) -> f64 {
        let solid = 1.0 - porosity;
        let square = porosity * porosity;
        let creeping = 10.0 * solid / square + square * (1.0 + 1.5 * solid.sqrt());
        // Both sides of the fraction times Re^((1 + 4 φ)/2): finite at Re = 0.
        let logarithm = ln(reynolds);
        let power = exp((0.5 + 2.0 * solid) * logarithm);
        let above = (1.0 / porosity + 3.0 * porosity * solid) * reynolds + 8.4 * exp(0.657 * logarithm);
        creeping + 0.413 / (24.0 * square) * above * power / (power + exp(3.0 * LN_10 * solid))
    }
}
