//! Conduction by the area in which bodies overlap.

use super::Spot;
use crate::base::document::{Forms, keys, several_forms};
use crate::base::number::Number;
use crate::base::quantity::Positive;
use crate::laws::contact::{Heat, MaterialPair, Missing, Needs, coefficients};
use serde::de::{Error, Unexpected};
use std::f64::consts::PI;

coefficients! {
    /// Conductance in proportion to the root of an area.
    ///
    /// ```text
    /// H = 4 k₁ k₂/(k₁ + k₂) √A
    /// A = π/4 (R₁+R₂−r)(r+R₁−R₂)(r−R₁+R₂)(r+R₁+R₂)/r²   two spheres; π min(R)² once r < max(R)
    /// A = π (R² − (R−δ)²)                               a wall
    /// A = area                                          with area = 1e-7
    /// A = π max(R)²                                     with area = "projection"
    /// ```
    ///
    /// | symbol | meaning                       | unit    | comes from                                       |
    /// |--------|-------------------------------|---------|--------------------------------------------------|
    /// | r, δ   | distance of the centres, overlap | m    | the contact                                      |
    /// | k      | conductivity                  | W/(m K) | `conductivity` of both materials, or of the pair |
    ///
    /// For small overlaps √A is √(2π) a: this conducts 2.5 times what `constriction` does. δ is multiplied by (E\*/E\*₀)^(2/3) where
    /// materials have a `real_youngs_modulus`, which bodies of E\*₀ have at the same force.
    ///
    /// Source: LIGGGHTS-PUBLIC 3.8, `fix heat/gran/conduction` (projection takes the larger radius there); B. Chaudhuri,
    /// F. J. Muzzio & M. S. Tomassone, *Chem. Eng. Sci.* 61 (2006) 6348–6360.
    pub struct OverlapArea {
        /// Conductance over the root of the area \[W/(m K)\].
        per_length,
        /// Overlap of bodies of the real modulus over that of these.
        overlap_factor,
        /// 1 where the area is that in which the bodies intersect, otherwise 0.
        by_section,
        /// 1 where it is that of the larger body, otherwise 0.
        by_projection,
        /// The given area, or 0 \[m²\].
        given,
    }
}

/// The area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Area {
    /// In which the bodies intersect.
    #[default]
    Section,
    /// Of the larger body.
    Projection,
    /// As given \[m²\].
    Given(f64),
}

impl Forms for Area {
    const EXPECTED: &'static str = "an area above 0 [m²] or \"projection\"";

    fn number<E: Error>(value: f64, _written: Unexpected) -> Result<Self, E> {
        Positive::new(value).map(|area| Self::Given(area.get())).ok_or_else(|| Self::refused(value))
    }

    fn word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "projection" => Ok(Self::Projection),
            _ => Err(Self::refused(word)),
        }
    }
}
several_forms!(Area);

keys! {
    /// `[contact.<law>.heat.overlap_area]`
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// A given area \[m²\], > 0, or `"projection"`.
        #[serde(default)]
        pub area: Area = "that in which the bodies intersect",
    }
}

impl Heat for OverlapArea {
    const NAME: &'static str = "overlap_area";
    type Keys = Keys;
    const NEEDS: Needs = Needs { section: true, ..Needs::NONE };

    fn between(pair: &MaterialPair, keys: &Keys) -> Result<Self, Missing> {
        let radius = pair.real_contact_radius()?;
        let [section, projection, given] = match keys.area {
            Area::Section => [1.0, 0.0, 0.0],
            Area::Projection => [0.0, 1.0, 0.0],
            Area::Given(area) => [0.0, 0.0, area],
        };
        Ok(Self::new(pair.conductance_per_length()?, radius * radius, section, projection, given))
    }

    #[inline(always)]
    fn conductance<N: Number>(law: OverlapArea<N>, spot: &Spot<N>) -> N {
        let largest = spot.radii[0].max(spot.radii[1]);
        let section = spot.section(law.overlap_factor * spot.overlap.max(N::zero()));
        let projection = N::splat(PI) * largest * largest;
        let area = law.by_section * section + law.by_projection * projection + law.given;
        law.per_length * area.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{assert_close, material, properties};
    use crate::laws::contact::{Material, Thermal};

    /// The conductance of two spheres of 5 and 12 m that are 13 m apart, of conductivities 5 and 20 W/(m K) \[W/K\].
    fn conductance(area: Area, real_youngs_modulus: Option<f64>) -> f64 {
        let thermal = |conductivity| Thermal { conductivity, real_youngs_modulus, ..Thermal::default() };
        let [a, b] = [5.0, 20.0].map(|k| Material { thermal: thermal(Some(k)), ..material() });
        let pair = MaterialPair { a: &a, b: &b, properties: &properties() };
        let law = OverlapArea::between(&pair, &Keys { area }).unwrap();
        OverlapArea::conductance(law, &Spot::of_spheres([5.0, 12.0], 4.0, 3.0))
    }

    #[test]
    fn conducts_by_the_root_of_the_area_of_intersection() {
        assert_close(conductance(Area::Section, None), 16.0 * PI.sqrt() * 60.0 / 13.0, 1e-14);
    }

    #[test]
    fn takes_a_given_area_and_that_of_the_larger_sphere() {
        assert_close(conductance(Area::Given(9.0), None), 16.0 * 3.0, 1e-15);
        assert_close(conductance(Area::Projection, None), 16.0 * PI.sqrt() * 12.0, 1e-15);
    }

    #[test]
    fn harder_bodies_overlap_less_at_the_same_force() {
        let spot = Spot::of_spheres([5.0, 12.0], 4.0, 3.0);
        let hard = conductance(Area::Section, Some(2.0 * 64.0));
        assert_close(hard, 16.0 * spot.section(4.0 / 16.0).sqrt(), 1e-14);
    }

    #[test]
    fn small_overlaps_conduct_the_root_of_two_pi_times_a_circle_of_contact() {
        let (radius, overlap) = (1.0, 1e-9);
        let spot = Spot::of_spheres([radius; 2], overlap, (0.5 * radius * overlap).sqrt());
        let law = OverlapArea::new(1.0, 1.0, 1.0, 0.0, 0.0);
        let ratio = OverlapArea::conductance(law, &spot) / spot.contact_radius;
        assert_close(ratio, (2.0 * PI).sqrt(), 1e-8);
    }
}
