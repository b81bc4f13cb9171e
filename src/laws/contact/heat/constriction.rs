//! Conduction through a circle of contact.

use super::Spot;
use crate::base::number::Number;
use crate::laws::contact::{Heat, MaterialPair, Missing, NoKeys, coefficients};

coefficients! {
    /// Steady conduction of two half spaces through the circle in which they touch.
    ///
    /// ```text
    /// H = 4 a k₁ k₂/(k₁ + k₂)          2 k a of one material
    /// ```
    ///
    /// | symbol | meaning                                    | unit    | comes from                       |
    /// |--------|--------------------------------------------|---------|----------------------------------|
    /// | a      | contact radius, √(R* δ) unless normal model `jkr` | m | the contact                     |
    /// | k      | conductivity                               | W/(m K) | `conductivity` of both materials, or of the pair |
    ///
    /// a is multiplied by (E\*/E\*₀)^(1/3) where materials have a `real_youngs_modulus`: bodies of E\*₀ touch in this circle at the same
    /// force. Holds for circles that are small beside the bodies, and for contacts that last longer than heat takes through one.
    ///
    /// Source: R. Holm, *Electric Contacts*; G. K. Batchelor & R. W. O'Brien, *Proc. R. Soc. Lond. A* 355 (1977) 313–333; W. L.
    /// Vargas & J. J. McCarthy, *AIChE J.* 47 (2001) 1052–1059.
    pub struct Constriction {
        /// Conductance over the contact radius \[W/(m K)\].
        per_radius,
    }
}

impl Heat for Constriction {
    const NAME: &'static str = "constriction";
    type Keys = NoKeys;

    fn between(pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new(pair.conductance_per_length()? * pair.real_contact_radius()?))
    }

    #[inline(always)]
    fn conductance<N: Number>(law: Constriction<N>, spot: &Spot<N>) -> N {
        law.per_radius * spot.contact_radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{assert_close, material, properties};
    use crate::laws::contact::{Material, Thermal};

    /// A material of this conductivity \[W/(m K)\].
    fn of(conductivity: f64) -> Material {
        Material { thermal: Thermal { conductivity: Some(conductivity), ..Thermal::default() }, ..material() }
    }

    /// The conductance of two materials at a contact radius of 3 m \[W/K\].
    fn conductance([a, b]: [Material; 2]) -> f64 {
        let law = Constriction::between(&MaterialPair { a: &a, b: &b, properties: &properties() }, &NoKeys {}).unwrap();
        Constriction::conductance(law, &Spot::of_spheres([5.0, 12.0], 4.0, 3.0))
    }

    #[test]
    fn conducts_twice_the_conductivity_times_the_radius_of_one_material() {
        assert_close(conductance([of(5.0), of(5.0)]), 2.0 * 5.0 * 3.0, 1e-15);
    }

    #[test]
    fn two_materials_conduct_one_after_the_other() {
        assert_close(conductance([of(5.0), of(20.0)]), 4.0 * 3.0 * 5.0 * 20.0 / 25.0, 1e-15);
    }

    #[test]
    fn harder_bodies_touch_in_a_smaller_circle_at_the_same_force() {
        let thermal = Thermal { conductivity: Some(5.0), real_youngs_modulus: Some(2.0 * 64.0), ..Thermal::default() };
        let hard = Material { thermal, ..material() };
        assert_close(conductance([hard.clone(), hard]), 2.0 * 5.0 * 3.0 / 4.0, 1e-15);
    }
}
