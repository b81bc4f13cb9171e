//! Laws of convection: what heat flows between a sphere and a fluid that flows past. Each is one file and one row in the list below.
//!
//! A law is the Nusselt number of porosity ε, Reynolds number and Prandtl number Pr = c µ/k. The fluid makes of it the heat flow into a sphere
//! of diameter d which is colder than the fluid by ΔT:
//!
//! ```text
//! q = π k d Nu(ε, Re, Pr) ΔT        Re = ρ d ε |w|/µ
//! ```

pub mod gunn;
pub mod ranz_marshall;
mod row;

pub use row::{ConvectionModel, ConvectionRow, Nusselt};

use super::kept::ModelKeys;

/// The laws of the program.
pub(crate) const STANDARD: &[&ConvectionRow] =
    &[ConvectionRow::of::<ranz_marshall::RanzMarshall>(), ConvectionRow::of::<gunn::Gunn>()];

/// A law of convection, in numbers.
pub trait Convection: std::fmt::Debug + Send + Sync + 'static {
    /// Its name: that of its table `[fluid.<name>.heat.<law>]`.
    const NAME: &'static str;
    /// What the scene writes of it.
    type Keys: ModelKeys;
    /// Whether it holds for one sphere in much fluid alone. Other laws need a porosity, which a scene must then give.
    const OF_ONE_SPHERE: bool;
    /// The law that the keys mean.
    fn of(keys: &Self::Keys) -> Self;
    /// The Nusselt number, at a porosity above 0 and up to 1, a Reynolds number of 0 or above and a Prandtl number above 0. It is finite and
    /// above 0.
    fn nusselt(&self, porosity: f64, reynolds: f64, prandtl: f64) -> f64;
}

#[cfg(test)]
mod tests {
    use super::Convection;
    use super::gunn::Gunn;
    use super::ranz_marshall::RanzMarshall;

    #[test]
    fn a_sphere_in_a_fluid_at_rest_has_a_nusselt_number_of_2() {
        assert_eq!(RanzMarshall.nusselt(1.0, 0.0, 0.7), 2.0);
        assert!((Gunn.nusselt(1.0, 0.0, 0.7) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn the_laws_are_those_of_the_papers() {
        // Pr = 8 and Re = 100: Re^½ = 10, Pr^⅓ = 2.
        assert!((RanzMarshall.nusselt(1.0, 100.0, 8.0) - 14.0).abs() < 1e-12);
        // Re = 32: Re^0.2 = 2, Re^0.7 = 2^3.5.
        let [wide, dense] = [1.0, 0.5].map(|porosity| Gunn.nusselt(porosity, 32.0, 8.0));
        let power = libm::sqrt(128.0);
        assert!((wide - (2.0 * (1.0 + 2.8) + 0.13 * 2.0 * power)).abs() < 1e-12, "{wide}");
        assert!((dense - (3.25 * (1.0 + 2.8) + 0.43 * 2.0 * power)).abs() < 1e-12, "{dense}");
    }

    #[test]
    fn every_law_is_a_number_above_0_whatever_the_flow() {
        for porosity in [1e-3, 0.2, 0.4, 0.9, 1.0] {
            for reynolds in [0.0, 1e-300, 1.0, 1e9] {
                for prandtl in [1e-3, 0.7, 1e4] {
                    let found =
                        [RanzMarshall.nusselt(porosity, reynolds, prandtl), Gunn.nusselt(porosity, reynolds, prandtl)];
                    assert!(found.iter().all(|nusselt| nusselt.is_finite() && *nusselt > 0.0), "{found:?}");
                }
            }
        }
    }
}
