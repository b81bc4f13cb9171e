//! Spheres at any porosity, by flow through random arrays.

use super::Drag;
use crate::base::powers::ln;
use crate::laws::contact::NoKeys;

/// Solid fraction from which the Stokes limit is that of a dense bed.
const DENSE: f64 = 0.4;

/// Koch and Hill's law, a fit of lattice-Boltzmann simulations of random arrays of spheres.
///
/// ```text
/// F = ε (F₀ + ½ F₃ Re)        F₃ = 0.0673 + 0.212 φ + 0.0232/ε⁵
/// F₀ = (1 + 3 √(φ/2) + 135/64 φ ln φ + 16.14 φ)/(1 + 0.681 φ − 8.48 φ² + 8.16 φ³)   (φ < 0.4)        F₀ = 10 φ/ε³   (φ ≥ 0.4)
/// ```
///
/// φ = 1 − ε. It holds for moderate Re: one sphere of 5 mm falls in air at 11 m/s by it, at 17.6 m/s by `schiller_naumann`.
///
/// Source: Hill, Koch and Ladd 2001; Koch and Hill 2001; the same in CFDEMcoupling.
#[derive(Debug)]
pub struct KochHill;

impl Drag for KochHill {
    const NAME: &'static str = "koch_hill";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = false;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn factor(&self, porosity: f64, reynolds: f64) -> f64 {
        let solid = 1.0 - porosity;
        let cube = porosity * porosity * porosity;
        // φ ln φ vanishes with φ, as this logarithm is finite.
        let above = 1.0 + 3.0 * (0.5 * solid).sqrt() + 135.0 / 64.0 * solid * ln(solid) + 16.14 * solid;
        let dilute = above / (1.0 + solid * (0.681 + solid * (-8.48 + solid * 8.16)));
        let creeping = if solid < DENSE { dilute } else { 10.0 * solid / cube };
        let inertial = 0.0673 + 0.212 * solid + 0.0232 / (cube * porosity * porosity);
        porosity * (creeping + 0.5 * inertial * reynolds)
    }
}
