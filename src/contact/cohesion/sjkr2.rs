//! Attraction in proportion to the overlap.

use super::sjkr::Keys;
use crate::contact::{Cohesion, Contact, MaterialPair, Missing, coefficients};
use crate::number::Number;
use std::f64::consts::PI;

coefficients! {
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
    pub struct Sjkr2 {
        /// 2π c \[J/m³\].
        pull,
        /// How much of the force friction sees: 1 with `tangential_reduce`, otherwise 0.
        seen_by_friction,
    }
}

impl Cohesion for Sjkr2 {
    type Keys = Keys;
    const ACTIVE: bool = true;

    fn between(pair: &MaterialPair, keys: &Keys) -> Result<Self, Missing> {
        Ok(Self::new(2.0 * PI * pair.cohesion_energy_density()?, keys.seen_by_friction()))
    }

    fn reduces_friction(keys: &Keys) -> bool {
        keys.tangential_reduce
    }

    #[inline(always)]
    fn force<N: Number>(law: Sjkr2<N>, contact: &Contact<N>) -> N {
        -(law.pull * contact.section_radius * contact.overlap)
    }

    #[inline(always)]
    fn seen_by_friction<N: Number>(law: Sjkr2<N>, force: N) -> N {
        law.seen_by_friction * force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::specimen::{contact, properties, with_pair};

    /// c = 7 J/m³; the contact's section radius is ½ m, its overlap 2⁻¹⁴ m.
    fn law(tangential_reduce: bool) -> Sjkr2 {
        with_pair(&properties(), |pair| Sjkr2::between(pair, &Keys { tangential_reduce })).unwrap()
    }

    #[test]
    fn pulls_in_proportion_to_the_overlap() {
        assert_eq!(Sjkr2::force(law(false), &contact()), -(2.0 * PI * 7.0) * 0.5 / 16384.0);
        let twice = Contact { overlap: 2.0 * contact().overlap, ..contact() };
        assert_eq!(Sjkr2::force(law(false), &twice), 2.0 * Sjkr2::force(law(false), &contact()));
    }

    #[test]
    fn hides_from_friction_unless_told() {
        assert_eq!(Sjkr2::seen_by_friction(law(false), -21.0), 0.0);
        assert_eq!(Sjkr2::seen_by_friction(law(true), -21.0), -21.0);
    }
}
