//! Attraction in proportion to the section of the overlapping bodies.

use super::attraction::Attraction;
use crate::base::document::keys;
use crate::laws::contact::{Cohesion, MaterialPair, Missing, property};

/// A simplified JKR attraction: energy density times the area in which the bodies intersect.
///
/// ```text
/// F_c = −c A
/// A = −π/4 (r−R_i−R_j)(r+R_i−R_j)(r−R_i+R_j)(r+R_i+R_j)/r²      two spheres
/// A = π (R² − r²)                                                 a wall
/// ```
///
/// | symbol | meaning                                          | unit | comes from                |
/// |--------|--------------------------------------------------|------|---------------------------|
/// | A      | area of the circle in which the bodies intersect | m²   | the contact               |
/// | r      | distance of the centres, or of centre and wall   | m    | the contact               |
/// | c      | cohesion energy density                          | J/m³ | `cohesion_energy_density` |
///
/// Acts while the bodies overlap and not at a distance. Friction sees it with `tangential_reduce` alone;
/// rolling never does. For small overlap A is 2π R* δ between spheres, and 2π R δ at a wall.
///
/// Source: LIGGGHTS manual, `gran_cohesion_sjkr`; the minus sign of A stands in the program alone.
#[derive(Clone, Copy, Debug)]
pub struct Sjkr;

keys! {
    /// `[contact.<law>.cohesion.<model>]` of both SJKR models.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// Whether the attraction lowers the limit of friction.
        #[serde(default)]
        pub tangential_reduce: bool = "`false`",
    }
}

impl Keys {
    /// How much of the force friction sees.
    pub(super) fn seen_by_friction(self) -> f64 {
        if self.tangential_reduce { 1.0 } else { 0.0 }
    }
}

impl Cohesion for Sjkr {
    const NAME: &'static str = "sjkr";
    type Keys = Keys;
    type Form = Attraction;

    fn between(pair: &MaterialPair, keys: &Keys) -> Result<Attraction, Missing> {
        Ok(Attraction::new(pair.get(&property::COHESION_ENERGY_DENSITY)?, 0.0, keys.seen_by_friction()))
    }

    fn reduces_friction(keys: &Keys) -> bool {
        keys.tangential_reduce
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::CohesionForm;
    use crate::laws::contact::fixtures::{contact, properties, with_pair};

    /// c = 7 J/m³; the contact's section is 3 m².
    fn law(tangential_reduce: bool) -> Attraction {
        with_pair(&properties(), |pair| Sjkr::between(pair, &Keys { tangential_reduce })).unwrap()
    }

    #[test]
    fn pulls_with_the_energy_density_on_the_section() {
        assert_eq!(Attraction::force(law(false), &contact()), -7.0 * 3.0);
    }

    #[test]
    fn hides_from_friction_unless_told() {
        assert_eq!(Attraction::seen_by_friction(law(false), -21.0), 0.0);
        assert_eq!(Attraction::seen_by_friction(law(true), -21.0), -21.0);
        assert!(!Sjkr::reduces_friction(&Keys::default()));
    }
}
