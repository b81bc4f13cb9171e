//! Ergun's bed and Wen and Yu's suspension.

use super::Drag;
use super::schiller_naumann::SchillerNaumann;
use crate::base::powers::power;
use crate::laws::contact::NoKeys;

/// Below this porosity the law is Ergun's.
const DENSE: f64 = 0.8;

/// Gidaspow's law: Ergun's in dense beds, Wen and Yu's in dilute ones.
///
/// ```text
/// F = (150 φ + 1.75 Re)/(18 ε²)   (ε < 0.8)        F = F_SN(Re) ε^(−2.65)   (ε ≥ 0.8)
/// ```
///
/// φ = 1 − ε; F_SN is that of `schiller_naumann`. **F jumps at ε = 0.8**, at low Re from 2.6 to 1.8: where the porosity changes in space
/// or time, grains chatter about it. Take another law there.
///
/// Source: Gidaspow 1994; Ergun 1952; Wen and Yu 1966.
#[derive(Debug)]
pub struct Gidaspow;

impl Drag for Gidaspow {
    const NAME: &'static str = "gidaspow";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = false;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn factor(&self, porosity: f64, reynolds: f64) -> f64 {
        let dense = (150.0 * (1.0 - porosity) + 1.75 * reynolds) / (18.0 * porosity * porosity);
        let dilute = SchillerNaumann::of_sphere(reynolds) * power(porosity, -2.65);
        if porosity < DENSE { dense } else { dilute }
    }
}
