//! Attraction in proportion to the overlap.

use super::attraction::Attraction;
use super::sjkr::Keys;
use crate::laws::contact::{Cohesion, MaterialPair, Missing, property};
use std::f64::consts::PI;

/// A simplified JKR attraction, linear in the overlap.
///
/// ```text
/// F_c = −c A
/// A = 2π δ (2 R*)      two spheres
/// A = 2π δ R           a wall
/// ```
///
/// | symbol | meaning                                   | unit | comes from                |
/// |--------|-------------------------------------------|------|---------------------------|
/// | δ      | overlap                                   | m    | the contact               |
/// | R*, R  | effective radius; radius, at a wall       | m    | the contact               |
/// | c      | cohesion energy density                   | J/m³ | `cohesion_energy_density` |
///
/// Twice as strong as `sjkr` between spheres and as strong at a wall: energy densities do not carry over from
/// one to the other. Acts while the bodies overlap and not at a distance. Friction sees it with
/// `tangential_reduce` alone; rolling never does.
///
/// Source: LIGGGHTS manual, `gran_cohesion_sjkr2`; R, not 2 R, at a wall as in the program.
#[derive(Clone, Copy, Debug)]
pub struct Sjkr2;

impl Cohesion for Sjkr2 {
    const NAME: &'static str = "sjkr2";
    type Keys = Keys;
    type Form = Attraction;

    fn between(pair: &MaterialPair, keys: &Keys) -> Result<Attraction, Missing> {
        Ok(Attraction::new(0.0, 2.0 * PI * pair.get(&property::COHESION_ENERGY_DENSITY)?, keys.seen_by_friction()))
    }

    fn reduces_friction(keys: &Keys) -> bool {
        keys.tangential_reduce
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{contact, properties, with_pair};
    use crate::laws::contact::{CohesionForm, Contact};

    /// c = 7 J/m³; the contact's section radius is ½ m, its overlap 2⁻¹⁴ m.
    fn law(tangential_reduce: bool) -> Attraction {
        with_pair(&properties(), |pair| Sjkr2::between(pair, &Keys { tangential_reduce })).unwrap()
    }

    #[test]
    fn pulls_in_proportion_to_the_overlap() {
        assert_eq!(Attraction::force(law(false), &contact()), -(2.0 * PI * 7.0) * 0.5 / 16384.0);
        let twice = Contact { overlap: 2.0 * contact().overlap, ..contact() };
        assert_eq!(Attraction::force(law(false), &twice), 2.0 * Attraction::force(law(false), &contact()));
    }

    #[test]
    fn hides_from_friction_unless_told() {
        assert_eq!(Attraction::seen_by_friction(law(false), -21.0), 0.0);
        assert_eq!(Attraction::seen_by_friction(law(true), -21.0), -21.0);
    }
}
