//! Bonds that break where tension and shear together are too much.

use cograin::bond::breakage::{Breakage, Loaded, Strength};
use cograin::bond::keys::FormulationChoice;
use cograin::number::Number;
use cograin::quantity::Positive;
use serde::Deserialize;

/// Breaks where the squares of normal and shear stress over their strengths add up to more than 1.
///
/// ```text
/// (max(σ, 0)/S)² + (τ/T)² > 1      σ = ±|N|/A + |T_t| r_b/I      τ = |F_t|/A + |T_n| r_b/J
/// ```
///
/// | symbol | meaning                                                        | unit | comes from         |
/// |--------|----------------------------------------------------------------|------|--------------------|
/// | σ      | largest normal stress at the rim, above 0 in tension           | Pa   | the bond           |
/// | τ      | largest shear stress at the rim                                | Pa   | the bond           |
/// | S, T   | strength where the other stress is 0                           | Pa   | `normal_strength`, `shear_strength` |
///
/// Pressure neither breaks a bond nor makes it stronger.
///
/// Source: P. P. Camanho & C. G. Dávila, NASA/TM-2002-211737 (2002), the criterion for the onset of delamination.
#[derive(Clone, Copy, Debug)]
pub struct QuadraticStress {
    /// 1/S \[1/Pa\].
    per_normal_strength: f64,
    /// 1/T \[1/Pa\].
    per_shear_strength: f64,
}

/// `[bond.<name>.breakage.quadratic_stress]`
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys {
    /// S \[Pa\].
    pub normal_strength: Positive,
    /// T \[Pa\].
    pub shear_strength: Positive,
}

impl Breakage for QuadraticStress {
    const NAME: &'static str = "quadratic_stress";
    type Keys = Keys;
    const CAUSES: &'static [&'static str] = &["quadratic_stress"];

    fn of(keys: &Keys, _formulation: FormulationChoice) -> Self {
        let [per_normal_strength, per_shear_strength] =
            [keys.normal_strength, keys.shear_strength].map(|strength| 1.0 / strength.get());
        Self { per_normal_strength, per_shear_strength }
    }

    fn strengths(keys: &mut Keys) -> Vec<Strength<'_>> {
        let all = [("normal_strength", &mut keys.normal_strength), ("shear_strength", &mut keys.shear_strength)];
        all.into_iter().map(|(key, value)| Strength { key, unit: "Pa", value }).collect()
    }

    #[inline(always)]
    fn judge<N: Number>(&self, loaded: &Loaded<N>) -> N {
        let stress = loaded.stress();
        let normal = (stress.bending - stress.pressure).max(N::zero()) * N::splat(self.per_normal_strength);
        let shear = stress.shear * N::splat(self.per_shear_strength);
        let breaks = (normal * normal + shear * shear).greater(N::splat(1.0));
        N::select(breaks, N::splat(1.0), N::zero())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{Coupled, SCENE, assert_close, told};
    use cograin::bond::Section;
    use cograin::number::Vector;
    use std::f64::consts::PI;

    /// S = 10 Pa, T = 5 Pa.
    const RULE: QuadraticStress = QuadraticStress { per_normal_strength: 0.1, per_shear_strength: 0.2 };

    /// Whether a bond of area and rim 1 breaks under this push, shear force and bending stress.
    fn breaks([push, shear, bending]: [f64; 3]) -> bool {
        let loaded: Loaded = Loaded {
            distance: 1.0,
            section: Section { radius: 1.0, area: 1.0, polar: 0.5, axial: 0.25 },
            compression: push,
            normal: push,
            shear: Vector::new(0.0, shear, 0.0),
            torsion: 0.0,
            bending: Vector::new(0.0, 0.0, 0.25 * bending),
        };
        RULE.judge(&loaded) == 1.0
    }

    #[test]
    fn each_stress_alone_breaks_at_its_strength_and_pressure_does_not() {
        assert_eq!([[-9.99, 0.0, 0.0], [-10.01, 0.0, 0.0]].map(breaks), [false, true]);
        assert_eq!([[0.0, 4.99, 0.0], [0.0, 5.01, 0.0]].map(breaks), [false, true]);
        assert_eq!([[0.0, 0.0, 9.99], [0.0, 0.0, 10.01]].map(breaks), [false, true]);
        assert_eq!([[1e3, 4.99, 0.0], [1e3, 5.01, 0.0]].map(breaks), [false, true]);
    }

    #[test]
    fn together_they_break_on_the_ellipse() {
        // 0.6² + 0.8² = 1, the normal stress from stretching and bending.
        assert_eq!([[-6.0, 3.99, 0.0], [-6.0, 4.01, 0.0]].map(breaks), [false, true]);
        assert_eq!([[-4.0, 3.99, 2.0], [-4.0, 4.01, 2.0]].map(breaks), [false, true]);
    }

    #[test]
    fn a_bond_of_a_scene_breaks_where_its_stress_reaches_the_strength() {
        // σ = k_n u reaches S = 1e5 Pa at u = 1e-5 m; the force before is k_n A u.
        let mut bond = Coupled::new("pull");
        assert_close(bond.at(0.99e-5), -1e10 * PI * 1e-6 * 0.99e-5, 1e-9);
        assert_eq!(bond.at(1.01e-5), 0.0);
        let broken = bond.simulation.state().breaks[0];
        let law = bond.simulation.scene().bond_law(0);
        assert_eq!(law.cause_name(broken.cause), Some("quadratic_stress"));
    }

    #[test]
    fn its_strengths_are_tunable_parameters() {
        let mut bond = Coupled::new("pull");
        let strength = "bond.neck.breakage.quadratic_stress.normal_strength";
        let place = bond.simulation.scene().tunables().position(|parameter| parameter.name == strength);
        bond.simulation.tune(&[(place.unwrap(), 2e5)]).unwrap();
        assert!(bond.at(1.99e-5) < 0.0, "twice the strength, twice the stretch");
        assert_eq!(bond.at(2.01e-5), 0.0);
    }

    #[test]
    fn what_a_scene_says_wrong_is_refused_in_its_words() {
        let key = told(&SCENE.replace("shear_strength", "shear_strenght"));
        assert!(
            key.contains("[bond.neck] breakage.quadratic_stress.shear_strenght") && key.contains("shear_strength"),
            "{key}"
        );
        let rule = told(&SCENE.replace("breakage.quadratic_stress", "breakage.quadratic"));
        assert!(rule.contains("quadratic_stress"), "the nearest name: {rule}");
        let exact = told(&SCENE.replace("[bond.neck]", "[bond.neck]\nformulation = \"engine_exact\""));
        assert!(exact.contains("expected a limit of the engine"), "{exact}");
    }
}
