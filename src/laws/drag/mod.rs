//! Drag laws: what a fluid that flows past does to a sphere. Each is one file and one row in the list below.
//!
//! A law is a factor F of porosity ε and Reynolds number. The fluid makes of it the drag on a sphere of diameter d whose velocity the
//! velocity of the fluid exceeds by w:
//!
//! ```text
//! f_d = 3π µ d ε w F(ε, Re)        Re = ρ d ε |w|/µ
//! ```
//!
//! This is the drag beside the force of the pressure gradient (set II of Zhou et al. 2010, "model A"). Laws that are published by the
//! drag coefficient β \[kg/(m³ s)\] become F = β d²/(18 µ φ ε), φ = 1 − ε; laws of the whole force lose a factor ε.

pub mod beetstra;
pub mod di_felice;
pub mod gidaspow;
pub mod koch_hill;
mod row;
pub mod schiller_naumann;
pub mod stokes;

pub(crate) use row::Factor;
pub use row::{DragModel, DragRow};

use super::kept::ModelKeys;

/// The drag laws of the program.
pub(crate) const STANDARD: &[&DragRow] = &[
    DragRow::of::<stokes::Stokes>(),
    DragRow::of::<schiller_naumann::SchillerNaumann>(),
    DragRow::of::<di_felice::DiFelice>(),
    DragRow::of::<gidaspow::Gidaspow>(),
    DragRow::of::<beetstra::Beetstra>(),
    DragRow::of::<koch_hill::KochHill>(),
];

/// A drag law, in numbers.
pub trait Drag: std::fmt::Debug + Send + Sync + 'static {
    /// Its name: that of its table `[fluid.<name>.drag.<law>]`.
    const NAME: &'static str;
    /// What the scene writes of it.
    type Keys: ModelKeys;
    /// Whether it holds for one sphere in much fluid alone. Other laws need a porosity, which a scene must then give.
    const OF_ONE_SPHERE: bool;
    /// The law that the keys mean.
    fn of(keys: &Self::Keys) -> Self;
    /// Drag over 3π µ d ε w, at a porosity above 0 and up to 1 and a Reynolds number of 0 or above. It is finite and above 0. The program asks
    /// for many at once: one that is `#[inline]`, chooses values and not ways, and takes its powers from [`powers`](crate::base::powers) is fast.
    fn factor(&self, porosity: f64, reynolds: f64) -> f64;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::lanes::Width;
    use crate::laws::contact::NoKeys;
    use std::f64::consts::PI;

    /// Drag over that of Stokes.
    fn factor<D: Drag<Keys = NoKeys>>(solid: f64, reynolds: f64) -> f64 {
        D::of(&NoKeys {}).factor(1.0 - solid, reynolds)
    }

    /// The terminal velocity of glass of this diameter in water \[m/s\].
    fn terminal<D: Drag<Keys = NoKeys>>(diameter: f64) -> f64 {
        let weight = PI / 6.0 * diameter.powi(3) * 1500.0 * 9.81;
        let above = |speed: f64| 3.0 * PI * 1e-3 * diameter * speed * factor::<D>(0.0, diameter * speed * 1e6) > weight;
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if above(middle) { high = middle } else { low = middle }
        }
        high
    }

    #[test]
    fn glass_settles_in_water_as_the_laws_say() {
        let found = [1e-4, 1e-3].map(|d| {
            [
                terminal::<schiller_naumann::SchillerNaumann>(d),
                terminal::<di_felice::DiFelice>(d),
                terminal::<koch_hill::KochHill>(d),
                terminal::<beetstra::Beetstra>(d),
            ]
        });
        let expected = [[7.2941e-3, 6.92152e-3, 7.89307e-3, 7.69037e-3], [0.145946, 0.134104, 0.123815, 0.129735]];
        for (found, expected) in found.into_iter().flatten().zip(expected.into_iter().flatten()) {
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} m/s, expected {expected}");
        }
    }

    #[test]
    fn the_dense_stokes_limits_are_those_of_the_papers() {
        let found = [
            factor::<koch_hill::KochHill>(0.4, 0.0),
            factor::<beetstra::Beetstra>(0.4, 0.0),
            factor::<gidaspow::Gidaspow>(0.4, 0.0),
            factor::<di_felice::DiFelice>(0.4, 0.0),
        ];
        for (found, expected) in found.into_iter().zip([11.11, 11.81, 9.26, 6.35]) {
            assert!((found - expected).abs() < 5e-3, "{found}, expected {expected}");
        }
        // The same at a small Reynolds number, where Di Felice is 6.52.
        assert!((factor::<di_felice::DiFelice>(0.4, 0.01) - 6.5181).abs() < 5e-5);
        assert!((factor::<koch_hill::KochHill>(0.4, 100.0) - 24.6247).abs() < 5e-5);
        assert!((factor::<beetstra::Beetstra>(0.4, 100.0) - 30.7416).abs() < 5e-5);
        assert!((factor::<gidaspow::Gidaspow>(0.4, 100.0) - 36.2654).abs() < 5e-5);
        assert!((factor::<di_felice::DiFelice>(0.4, 100.0) - 25.3523).abs() < 5e-5);
        assert!((factor::<gidaspow::Gidaspow>(0.15, 0.01) - 1.0063 * 0.85_f64.powf(-2.65)).abs() < 5e-4);
    }

    #[test]
    fn a_bed_of_ergun_has_erguns_pressure_drop() {
        // −∇p = n f_d/ε of the particles of a bed at rest.
        let (porosity, d, mu, rho, superficial) = (0.4, 1e-3, 1e-3, 1000.0, 0.01);
        let drag = 3.0 * PI * mu * d * superficial * factor::<gidaspow::Gidaspow>(0.6, rho * d * superficial / mu);
        let gradient = 0.6 / (PI / 6.0 * d * d * d) * drag / porosity;
        assert!((gradient / 10078.125 - 1.0).abs() < 1e-12, "{gradient} Pa/m");
    }

    #[test]
    fn many_spheres_at_once_have_the_bits_of_each_alone_in_every_width() {
        let porosities: Vec<f64> = (1..=101).map(|step| 0.2 + 0.8 * f64::from(step % 37) / 36.0).collect();
        let numbers: Vec<f64> = (0..101).map(|step| if step == 0 { 0.0 } else { 1e-6 * 1.3_f64.powi(step) }).collect();
        for row in STANDARD {
            let law = (row.law)(crate::laws::kept::keep(NoKeys {}));
            for width in Width::ALL.into_iter().filter(|width| width.offered()) {
                let mut found = numbers.clone();
                law.factors(&porosities, &mut found, width);
                let alone = porosities.iter().zip(&numbers).map(|(porosity, number)| law.factor(*porosity, *number));
                assert!(found.iter().copied().eq(alone), "{} in {width:?}", row.name);
            }
        }
    }

    #[test]
    fn every_law_is_a_number_above_0_whatever_the_flow() {
        type Factor = fn(f64, f64) -> f64;
        let laws: [(&str, Factor); 6] = [
            ("stokes", factor::<stokes::Stokes>),
            ("schiller_naumann", factor::<schiller_naumann::SchillerNaumann>),
            ("di_felice", factor::<di_felice::DiFelice>),
            ("gidaspow", factor::<gidaspow::Gidaspow>),
            ("beetstra", factor::<beetstra::Beetstra>),
            ("koch_hill", factor::<koch_hill::KochHill>),
        ];
        for (name, law) in laws {
            for solid in [0.0, 1e-12, 0.2, 0.2000001, 0.4, 0.64, 0.99] {
                for reynolds in [0.0, 1e-300, 1e-9, 1.0, 999.9, 1000.0, 1e9] {
                    let factor = law(solid, reynolds);
                    // Ergun's law has no limit of one sphere: its branch is that of dense beds.
                    assert!(factor.is_finite() && factor > 0.0, "{name}: {factor} at φ = {solid}, Re = {reynolds}");
                }
            }
        }
    }
}
