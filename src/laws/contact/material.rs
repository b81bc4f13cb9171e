//! Materials and what two of them have in common: where laws take their coefficients from.

use crate::base::quantity::{AtLeastOne, NonNegative, Positive, Restitution};
use serde::Deserialize;

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

/// Properties of two materials in contact: `[pair.<a>.<b>]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairProperties {
    /// Coefficient of restitution e.
    pub restitution: Option<Restitution>,
    /// Coefficient of friction µ.
    pub friction: Option<NonNegative>,
    /// Coefficient of rolling friction µ_r.
    pub rolling_friction: Option<NonNegative>,
    /// Cohesion energy density c \[J/m³\].
    pub cohesion_energy_density: Option<NonNegative>,
    /// Given normal stiffness κ_n: of `hooke_stiffness` \[N/m\], of `hertz_stiffness` \[Pa\].
    pub normal_stiffness: Option<NonNegative>,
    /// Given tangential stiffness κ_t: of `hooke_stiffness` \[N/m\], of `hertz_stiffness` \[Pa\].
    pub tangential_stiffness: Option<NonNegative>,
    /// Given normal damping for each effective mass: of `hooke_stiffness` \[1/s\], of `hertz_stiffness` \[1/(m s)\].
    pub normal_damping: Option<NonNegative>,
    /// Given tangential damping for each effective mass: of `hooke_stiffness` \[1/s\], of `hertz_stiffness` \[1/(m s)\].
    pub tangential_damping: Option<NonNegative>,
    /// Given normal damping whatever the masses, with `absolute_damping` \[kg/s\].
    pub absolute_normal_damping: Option<NonNegative>,
    /// Given tangential damping whatever the masses, with `absolute_damping` \[kg/s\].
    pub absolute_tangential_damping: Option<NonNegative>,
    /// Viscosity of the fluid between the bodies, η \[Pa s\].
    pub fluid_viscosity: Option<Positive>,
    /// Critical Stokes number of the fluid between the bodies.
    pub critical_stokes_number: Option<Positive>,
    /// Largest coefficient of restitution, without fluid.
    pub maximum_restitution: Option<Restitution>,
    /// Damping of a rolling spring over its critical damping, η_r.
    pub rolling_viscous_damping: Option<NonNegative>,
    /// Surface energy γ, half the work of adhesion of `jkr` and `dmt` \[J/m²\].
    pub surface_energy: Option<NonNegative>,
    /// Damping of `jkr` and `dmt`: \[1/(m s)\], \[1/s\] or \[kg/s\], as their key `damping` says.
    pub damping_coefficient: Option<NonNegative>,
    /// Tangential damping over normal damping of `jkr` and `dmt`, x_t.
    pub tangential_damping_ratio: Option<NonNegative>,
    /// Stiffness of unloading over that of loading of `eepa`, k₂/k₁.
    pub unloading_stiffness_ratio: Option<AtLeastOne>,
    /// Constant attraction of touching bodies of `eepa`, f₀ \[N\].
    pub pull_off_force: Option<NonNegative>,
    /// Stiffness of the adhesion branch over that of loading of `eepa` with `adhesion = "fixed"`, k_a/k₁.
    pub adhesion_stiffness_ratio: Option<NonNegative>,
    /// Conductivity of both, in place of those of the materials, k \[W/(m K)\].
    pub conductivity: Option<Positive>,
    /// Heat transfer coefficient of the area of contact of `transfer`, h \[W/(m² K)\].
    pub heat_transfer_coefficient: Option<NonNegative>,
}

/// For each property that is given: its key, and the properties without it and with another value of it.
macro_rules! variants {
    ($properties:expr, $($key:ident: $kind:ident $other:literal,)*) => {
        [$($properties.$key.map(|_| {
            let other = |value| PairProperties { $key: value, ..*$properties };
            (stringify!($key), [other(None), other($kind::new($other))])
        })),*]
    };
}

impl PairProperties {
    /// For each property that is given: its key, and these properties without it and with another value of it. What reads it can
    /// tell them apart.
    pub(crate) fn variants(&self) -> impl Iterator<Item = (&'static str, [Self; 2])> {
        let variants = variants! {
            self,
            restitution: Restitution 0.37,
            friction: NonNegative 0.37,
            rolling_friction: NonNegative 0.37,
            cohesion_energy_density: NonNegative 0.37,
            normal_stiffness: NonNegative 0.37,
            tangential_stiffness: NonNegative 0.37,
            normal_damping: NonNegative 0.37,
            tangential_damping: NonNegative 0.37,
            absolute_normal_damping: NonNegative 0.37,
            absolute_tangential_damping: NonNegative 0.37,
            fluid_viscosity: Positive 0.37,
            critical_stokes_number: Positive 0.37,
            maximum_restitution: Restitution 0.37,
            rolling_viscous_damping: NonNegative 0.37,
            surface_energy: NonNegative 0.37,
            damping_coefficient: NonNegative 0.37,
            tangential_damping_ratio: NonNegative 0.37,
            unloading_stiffness_ratio: AtLeastOne 1.37,
            pull_off_force: NonNegative 0.37,
            adhesion_stiffness_ratio: NonNegative 0.37,
            conductivity: Positive 0.37,
            heat_transfer_coefficient: NonNegative 0.37,
        };
        variants.into_iter().flatten()
    }
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
    pub properties: &'a PairProperties,
}

/// Declares accessors of [`PairProperties`] that say which key is missing.
macro_rules! needed {
    ($($(#[$doc:meta])* $name:ident),+ $(,)?) => {
        impl MaterialPair<'_> {
            $(
                $(#[$doc])*
                pub fn $name(&self) -> Result<f64, Missing> {
                    self.properties.$name.map(|value| value.get()).ok_or_else(|| Missing {
                        table: format!("pair.{}.{}", self.a.name, self.b.name),
                        key: stringify!($name),
                    })
                }
            )+
        }
    };
}

needed! {
    /// Coefficient of restitution e.
    restitution,
    /// Coefficient of friction µ.
    friction,
    /// Coefficient of rolling friction µ_r.
    rolling_friction,
    /// Cohesion energy density \[J/m³\].
    cohesion_energy_density,
    /// κ_n \[N/m\] or \[Pa\].
    normal_stiffness,
    /// κ_t \[N/m\] or \[Pa\].
    tangential_stiffness,
    /// Normal damping for each effective mass \[1/s\] or \[1/(m s)\].
    normal_damping,
    /// Tangential damping for each effective mass \[1/s\] or \[1/(m s)\].
    tangential_damping,
    /// Normal damping \[kg/s\].
    absolute_normal_damping,
    /// Tangential damping \[kg/s\].
    absolute_tangential_damping,
    /// Viscosity of the fluid \[Pa s\].
    fluid_viscosity,
    /// Critical Stokes number.
    critical_stokes_number,
    /// Largest coefficient of restitution.
    maximum_restitution,
    /// η_r.
    rolling_viscous_damping,
    /// γ \[J/m²\].
    surface_energy,
    /// η \[1/(m s)\], \[1/s\] or \[kg/s\].
    damping_coefficient,
    /// x_t.
    tangential_damping_ratio,
    /// k₂/k₁.
    unloading_stiffness_ratio,
    /// f₀ \[N\].
    pull_off_force,
    /// k_a/k₁.
    adhesion_stiffness_ratio,
    /// h \[W/(m² K)\].
    heat_transfer_coefficient,
}

impl MaterialPair<'_> {
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
        if let Some(both) = self.properties.conductivity {
            return Ok(2.0 * both.get());
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
