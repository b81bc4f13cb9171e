//! Conduction in proportion to the area of contact.

use super::Spot;
use crate::base::number::Number;
use crate::laws::contact::{Heat, MaterialPair, Missing, NoKeys, coefficients, property};
use std::f64::consts::PI;

coefficients! {
    /// A given heat transfer coefficient on the circle of contact.
    ///
    /// ```text
    /// H = h π a²
    /// ```
    ///
    /// | symbol | meaning                                    | unit     | comes from                  |
    /// |--------|--------------------------------------------|----------|-----------------------------|
    /// | a      | contact radius, √(R* δ) unless normal model `jkr` | m  | the contact                 |
    /// | h      | heat transfer coefficient                  | W/(m² K) | `heat_transfer_coefficient` |
    ///
    /// For surfaces whose roughness or coating resists more than the bodies do. a is multiplied by (E\*/E\*₀)^(1/3) as in `constriction`.
    ///
    /// Source: LAMMPS manual, `pair_style granular`, `heat area`.
    pub struct Transfer {
        /// Conductance over the square of the contact radius \[W/(m² K)\].
        per_square,
    }
}

impl Heat for Transfer {
    const NAME: &'static str = "transfer";
    type Keys = NoKeys;

    fn between(pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        let radius = pair.real_contact_radius()?;
        Ok(Self::new(PI * pair.get(&property::HEAT_TRANSFER_COEFFICIENT)? * (radius * radius)))
    }

    #[inline(always)]
    fn conductance<N: Number>(law: Transfer<N>, spot: &Spot<N>) -> N {
        law.per_square * (spot.contact_radius * spot.contact_radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::laws::contact::fixtures::{assert_close, properties, with_pair};

    #[test]
    fn conducts_its_coefficient_times_the_area_of_contact() {
        let properties = properties().with(&property::HEAT_TRANSFER_COEFFICIENT, 2000.0);
        let law = with_pair(&properties, |pair| Transfer::between(pair, &NoKeys {})).unwrap();
        let spot = Spot::of_spheres([5.0, 12.0], 4.0, 3.0);
        assert_close(Transfer::conductance(law, &spot), 2000.0 * PI * 9.0, 1e-15);
    }
}
