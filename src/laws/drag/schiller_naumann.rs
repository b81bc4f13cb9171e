//! One sphere at any Reynolds number.

use super::Drag;
use crate::base::powers::power;
use crate::laws::contact::NoKeys;

/// Schiller and Naumann's fit of the drag of one sphere.
///
/// ```text
/// F = 1 + 0.15 Re^0.687   (Re < 1000)        F = 0.44 Re/24   (Re ≥ 1000)
/// ```
///
/// It holds for one sphere up to Re of about 2·10⁵. The two branches differ by half a percent where they meet.
///
/// Source: Schiller and Naumann 1933; Newton's coefficient 0.44 above.
#[derive(Debug)]
pub struct SchillerNaumann;

impl SchillerNaumann {
    /// The drag of one sphere over that of Stokes.
    #[inline(always)]
    pub(super) fn of_sphere(reynolds: f64) -> f64 {
        let moderate = 1.0 + 0.15 * power(reynolds, 0.687);
        if reynolds < 1000.0 { moderate } else { 0.44 * reynolds / 24.0 }
    }
}

impl Drag for SchillerNaumann {
    const NAME: &'static str = "schiller_naumann";
    type Keys = NoKeys;
    const OF_ONE_SPHERE: bool = true;

    fn of(_keys: &NoKeys) -> Self {
        Self
    }

    #[inline(always)]
    fn factor(&self, _porosity: f64, reynolds: f64) -> f64 {
        Self::of_sphere(reynolds)
    }
}
