//! Creeping flow past one sphere.

use super::Drag;
use crate::laws::contact::NoKeys;

/// Stokes' law.
///
/// ```text
/// F = 1
/// ```
///
/// It holds for one sphere at Re ≪ 1; at Re = 1 the drag is 15 % above it.
///
/// Source: Stokes 1851.
#[derive(Debug)]
pub struct Stokes;

impl Drag for Stokes {
    const NAME: &'static str = "stokes";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = true;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn factor(&self, _porosity: f64, _reynolds: f64) -> f64 {
        1.0
    }
}
