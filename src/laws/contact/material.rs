//! Materials and what two of them have in common: where laws take their coefficients from.

use super::property::{CONDUCTIVITY, Properties, Property};

/// One material as a law sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the scene.
    pub name: String,
    /// Density \[kg/m³\].
    pub density: f64,
    /// Young's modulus \[Pa\], if the scene gives one.
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio, if the scene gives one.
    pub poissons_ratio: Option<f64>,
    /// What heat needs.
    pub thermal: Thermal,
    /// What laws of other crates need.
    pub properties: Properties,
}

/// What heat needs of a material, as far as the scene gives it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Thermal {
    /// Conductivity k \[W/(m K)\].
    pub conductivity: Option<f64>,
    /// Specific heat c \[J/(kg K)\].
    pub specific_heat: Option<f64>,
    /// Young's modulus of the real bodies, whose area of contact at the same force conducts \[Pa\].
    pub real_youngs_modulus: Option<f64>,
}

/// A property that the chosen law needs and the scene does not give.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// The table where it belongs, as `material.glass` or `pair.glass.steel`.
    pub table: String,
    /// The key that is missing.
    pub key: &'static str,
}

/// Two materials in contact and their common properties: where laws take their coefficients from.
#[derive(Clone, Copy, Debug)]
pub struct MaterialPair<'a> {
    /// One material.
    pub a: &'a Material,
    /// The other, or the same.
    pub b: &'a Material,
    /// What the two have in common.
    pub properties: &'a Properties,
}

impl MaterialPair<'_> {
    /// The value of a property that the two have in common, or which key is missing.
    pub fn get(&self, property: &Property) -> Result<f64, Missing> {
        self.properties
            .get(property)
            .ok_or_else(|| Missing { table: format!("pair.{}.{}", self.a.name, self.b.name), key: property.name })
    }

    /// The values of a property that each of the two has, or which key is missing.
    pub fn of_each(&self, property: &Property) -> Result<[f64; 2], Missing> {
        let of = |material: &Material| {
            let missing = || Missing { table: format!("material.{}", material.name), key: property.name };
            material.properties.get(property).ok_or_else(missing)
        };
        Ok([of(self.a)?, of(self.b)?])
    }

    /// Young's moduli and Poisson's ratios of both materials.
    fn elastic(&self) -> Result<[(f64, f64); 2], Missing> {
        let of = |material: &Material| {
            let missing = |key| Missing { table: format!("material.{}", material.name), key };
            Ok((
                material.youngs_modulus.ok_or_else(|| missing("youngs_modulus"))?,
                material.poissons_ratio.ok_or_else(|| missing("poissons_ratio"))?,
            ))
        };
        Ok([of(self.a)?, of(self.b)?])
    }

    /// Effective Young's modulus: 1/E* = (1 − ν_i²)/E_i + (1 − ν_j²)/E_j \[Pa\].
    pub fn effective_youngs_modulus(&self) -> Result<f64, Missing> {
        let compliance: f64 = self.elastic()?.iter().map(|(e, nu)| (1.0 - nu * nu) / e).sum();
        Ok(1.0 / compliance)
    }

    /// Effective shear modulus: 1/G* = Σ 2 (2 − ν)(1 + ν)/E \[Pa\].
    pub fn effective_shear_modulus(&self) -> Result<f64, Missing> {
        let compliance: f64 = self.elastic()?.iter().map(|(e, nu)| 2.0 * (2.0 - nu) * (1.0 + nu) / e).sum();
        Ok(1.0 / compliance)
    }

    /// Conductance of a circle of contact over its radius: 4 k_i k_j/(k_i + k_j) \[W/(m K)\].
    pub fn conductance_per_length(&self) -> Result<f64, Missing> {
        if let Some(both) = self.properties.get(&CONDUCTIVITY) {
            return Ok(2.0 * both);
        }
        let of = |material: &Material| {
            let missing = || Missing { table: format!("material.{}", material.name), key: "conductivity" };
            material.thermal.conductivity.ok_or_else(missing)
        };
        let (k, l) = (of(self.a)?, of(self.b)?);
        Ok(4.0 * k * l / (k + l))
    }

    /// Contact radius of the real bodies over that of these, at the same force: (E*/E*₀)^(1/3), 1 where neither material says that it is
    /// really harder.
    pub fn real_contact_radius(&self) -> Result<f64, Missing> {
        let real = |material: &Material| material.thermal.real_youngs_modulus;
        if real(self.a).is_none() && real(self.b).is_none() {
            return Ok(1.0);
        }
        let as_real = |material: &Material| Material {
            youngs_modulus: real(material).or(material.youngs_modulus),
            ..material.clone()
        };
        let (a, b) = (as_real(self.a), as_real(self.b));
        let modulus = MaterialPair { a: &a, b: &b, ..*self }.effective_youngs_modulus()?;
        Ok(libm::cbrt(self.effective_youngs_modulus()? / modulus))
    }
}
