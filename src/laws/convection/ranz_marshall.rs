//! One sphere.

use super::Convection;
use crate::laws::contact::NoKeys;

/// Law of Ranz and Marshall.
///
/// ```text
/// Nu = 2 + 0.6 Re^½ Pr^⅓
/// ```
///
/// It holds for one sphere at Re ≤ 200 or so, and within some ten per cent to Re = 5·10⁴.
///
/// Source: Ranz and Marshall 1952.
#[derive(Debug)]
pub struct RanzMarshall;

impl Convection for RanzMarshall {
    const NAME: &'static str = "ranz_marshall";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = true;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn nusselt(&self, _porosity: f64, reynolds: f64, prandtl: f64) -> f64 {
        2.0 + 0.6 * reynolds.sqrt() * libm::cbrt(prandtl)
    }
}
