//! Liquid bridges between wet spheres.

use cograin::contact::{Cohesion, CohesionForm, Contact, MaterialPair, Missing, Needs};
use cograin::number::Number;
use cograin::quantity::Positive;
use serde::Deserialize;
use std::f64::consts::{FRAC_PI_2, PI};

cograin::coefficients! {
    /// The pull of a bridge of fixed volume.
    pub struct Bridge {
        /// 4π γ cos θ \[N/m\].
        tension,
        /// V/π \[m³\].
        volume,
        /// H_r \[m\].
        rupture_distance,
    }
}

/// A liquid bridge of fixed volume between two wet spheres, or a sphere and a wall.
///
/// ```text
/// F   = −4π R* γ cos θ (1 − H/√(H² + V/(π R*)))      H = max(−δ, 0)
/// H_r = (1 + θ/2) V^(1/3)
/// ```
///
/// | symbol | meaning                              | unit | comes from                                    |
/// |--------|--------------------------------------|------|-----------------------------------------------|
/// | δ, H   | overlap, and how far bodies are apart | m   | the contact                                   |
/// | R*     | effective radius, R/2 of equal spheres | m  | the contact                                   |
/// | γ      | surface tension of the liquid        | N/m  | `surface_tension`                             |
/// | θ      | contact angle                        | rad  | `contact_angle`, below π/2                    |
/// | V      | volume of a bridge                   | m³   | `liquid_volume`                               |
///
/// A bridge forms when the bodies touch and breaks when they are H_r apart: those that approach feel nothing before touch. For
/// bridges that are small beside the spheres; the pull of the liquid's edge and viscous forces are left out.
///
/// Source: Y. I. Rabinovich, M. S. Esayanur & B. M. Moudgil, *Langmuir* 21 (2005) 10992–10997 (force, with 2 R* for the radius);
/// G. Lian, C. Thornton & M. J. Adams, *J. Colloid Interface Sci.* 161 (1993) 138–147 (rupture).
#[derive(Clone, Copy, Debug)]
pub struct LiquidBridge;

/// `[contact.<law>.cohesion.liquid_bridge]`
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys {
    /// Volume of a bridge \[m³\].
    pub liquid_volume: Positive,
    /// Surface tension \[N/m\].
    pub surface_tension: Positive,
    /// Contact angle \[rad\].
    #[serde(default)]
    pub contact_angle: Angle,
}

/// An angle from 0 to below π/2 \[rad\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub struct Angle(f64);

impl TryFrom<f64> for Angle {
    type Error = String;

    fn try_from(angle: f64) -> Result<Self, String> {
        let wets = (0.0..FRAC_PI_2).contains(&angle);
        if wets { Ok(Self(angle)) } else { Err(format!("expected an angle from 0 to below π/2, found {angle}")) }
    }
}

impl Cohesion for LiquidBridge {
    const NAME: &'static str = "liquid_bridge";
    type Keys = Keys;
    type Form = Bridge;

    fn between(_pair: &MaterialPair, keys: &Keys) -> Result<Bridge, Missing> {
        let (volume, Angle(angle)) = (keys.liquid_volume.get(), keys.contact_angle);
        let tension = 4.0 * PI * keys.surface_tension.get() * cosine(angle);
        Ok(Bridge::new(tension, volume / PI, (1.0 + 0.5 * angle) * volume.cube_root()))
    }
}

/// The cosine of an angle from 0 to π/2 by its series: `f64::cos` has other bits on other machines.
fn cosine(angle: f64) -> f64 {
    let square = angle * angle;
    let mut sum = 1.0;
    for number in (1..=12).rev() {
        let number = f64::from(2 * number);
        sum = 1.0 - square / (number * (number - 1.0)) * sum;
    }
    sum
}

impl CohesionForm for Bridge {
    const NEEDS: Needs = Needs::NONE;
    const BEYOND_TOUCH: bool = true;

    fn reach(&self, _radius: f64) -> f64 {
        self.rupture_distance
    }

    #[inline(always)]
    fn force<N: Number>(law: Bridge<N>, contact: &Contact<N>) -> N {
        let apart = (-contact.overlap).max(N::zero());
        let slant = (apart * apart + law.volume / contact.radius).sqrt();
        -(law.tension * contact.radius * (N::splat(1.0) - apart / slant))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{Coupled, SCENE, assert_close, told};
    use cograin::contact::{Material, Properties};

    /// R* of two spheres of 1 mm \[m\].
    const RADIUS: f64 = 0.5e-3;

    /// The law of the scene.
    fn law() -> Bridge {
        let keys = Keys {
            liquid_volume: Positive::new(1e-11).unwrap(),
            surface_tension: Positive::new(0.072).unwrap(),
            contact_angle: Angle(0.5),
        };
        let material = Material { name: "glass".into(), density: 1.0, youngs_modulus: None, poissons_ratio: None, thermal: Default::default(), properties: Default::default() };
        let pair = MaterialPair { a: &material, b: &material, properties: &Properties::default() };
        LiquidBridge::between(&pair, &keys).unwrap()
    }

    /// F(H) as it is printed \[N\].
    fn printed(apart: f64) -> f64 {
        let slope = apart / (apart * apart + 1e-11 / (PI * RADIUS)).sqrt();
        -4.0 * PI * RADIUS * 0.072 * 0.5_f64.cos() * (1.0 - slope)
    }

    /// The force on the moved sphere once it stands this far from the other one \[N\].
    fn at(pair: &mut Coupled, apart: f64) -> f64 {
        pair.at(apart - 0.2e-3)
    }

    #[test]
    fn pulls_as_the_closed_form_says_and_at_touch_with_4_pi_r_gamma_cos_theta() {
        let contact = |overlap| Contact { overlap, radius: RADIUS, ..Contact::zero() };
        let force = |overlap| Bridge::force(law(), &contact(overlap));
        assert_close(force(0.0), -4.0 * PI * RADIUS * 0.072 * 0.5_f64.cos(), 1e-14);
        assert_eq!(force(1e-6), force(0.0), "in touch it does not grow");
        assert_close(law().reach(RADIUS), 1.25 * 1e-11_f64.cbrt(), 1e-14);
        for apart in [1e-6, 5e-5, 2e-4] {
            assert_close(force(-apart), printed(apart), 1e-13);
        }
    }

    #[test]
    fn the_cosine_is_one() {
        for angle in [0.0, 0.5, 1.0, 1.57] {
            assert!((cosine(angle) - angle.cos()).abs() < 1e-15, "{angle}");
        }
    }

    #[test]
    fn forms_at_touch_and_breaks_at_the_rupture_distance() {
        let (mut pair, rupture) = (Coupled::new("tip"), law().rupture_distance);
        assert_eq!([0.1e-3, 1e-6].map(|apart| at(&mut pair, apart)), [0.0; 2], "nothing before touch");
        // Pressed together, then apart: dashpots are gone when the sphere rests at the end of each way.
        assert!(at(&mut pair, -1e-6) > 0.0, "the contact presses harder than the bridge pulls");
        for apart in [0.02e-3, 0.1e-3, 0.99 * rupture] {
            assert_close(at(&mut pair, apart), printed(apart), 1e-6);
        }
        assert_eq!(at(&mut pair, 1.01 * rupture), 0.0, "broken");
        assert_eq!(at(&mut pair, 0.5 * rupture), 0.0, "it does not form again at a distance");
        at(&mut pair, -1e-6);
        assert_close(at(&mut pair, 0.5 * rupture), printed(0.5 * rupture), 1e-6);
    }

    #[test]
    fn breaking_it_takes_the_energy_of_the_closed_form() {
        // ∫ F dH from 0 to H_r: 4π R* γ cos θ (H_r + b − √(H_r² + b²)), b² = V/(π R*)
        let (rupture, b) = (law().rupture_distance, (1e-11 / (PI * RADIUS)).sqrt());
        let expected = 4.0 * PI * RADIUS * 0.072 * 0.5_f64.cos() * (rupture + b - rupture.hypot(b));
        let mut pair = Coupled::new("tip");
        at(&mut pair, 0.0);
        at(&mut pair, -1e-7);
        let (mut work, parts) = (0.0, 200);
        let mut before = printed(0.0);
        for part in 1..=parts {
            let force = if part < parts {
                at(&mut pair, rupture * f64::from(part) / f64::from(parts))
            } else {
                printed(rupture)
            };
            work -= 0.5 * (before + force) * rupture / f64::from(parts);
            before = force;
        }
        // Trapezia of a smooth force: H_r²/12 F'' H_r/n² over the work is 4e-5.
        assert_close(work, expected, 1e-4);
    }

    #[test]
    fn what_a_scene_says_wrong_is_refused_in_its_words() {
        let angle = told(&SCENE.replace("contact_angle = 0.5", "contact_angle = 2.0"));
        assert!(angle.contains("expected an angle from 0 to below π/2, found 2"), "{angle}");
        let near = told(&SCENE.replace("cohesion.liquid_bridge", "cohesion.liquid_bridges"));
        assert!(near.contains("liquid_bridge"), "the nearest name: {near}");
        let far = told(&SCENE.replace("cohesion.liquid_bridge", "cohesion.glue"));
        assert!(far.contains("none, sjkr, sjkr2, liquid_bridge"), "all names: {far}");
        let hooke = told(&SCENE.replace("wet.normal.hertz]", "wet.normal.hooke]\ncharacteristic_velocity = 1.0"));
        assert!(hooke.contains("beyond touch"), "{hooke}");
    }
}
