//! Elastic spheres with viscous loss.

use super::hertzian::Hertzian;
use crate::laws::contact::{FrictionNeeds, MaterialPair, Missing, NoKeys, Normal, Onset, property};

/// Hertz's force with the damping of a constant coefficient of restitution.
///
/// ```text
/// S_n = 2 E* √(R* δ)                 S_t = 8 G* √(R* δ)
/// k_n = 4/3 E* √(R* δ)               k_t = S_t
/// γ_n = −2 √(5/6) β √(S_n m*)        γ_t = −2 √(5/6) β √(S_t m*)
/// β = ln e/√(ln² e + π²)
/// ```
///
/// | symbol | meaning                    | unit | comes from      |
/// |--------|----------------------------|------|-----------------|
/// | δ      | overlap                    | m    | the contact     |
/// | R*, m* | effective radius and mass  | m, kg| the contact     |
/// | E*     | effective Young's modulus  | Pa   | two materials   |
/// | G*     | effective shear modulus    | Pa   | two materials   |
/// | e      | coefficient of restitution | 1    | `restitution`   |
///
/// The measured restitution is e at every speed. The force may pull near the end of a contact.
///
/// Source: A. Di Renzo & F. P. Di Maio, *Chem. Eng. Sci.* 59 (2004) 525–541; damping after Y. Tsuji,
/// T. Tanaka & T. Ishida, *Powder Technol.* 71 (1992) 239–250.
#[derive(Clone, Copy, Debug)]
pub struct Hertz;

impl Normal for Hertz {
    const NAME: &'static str = "hertz";
    type Keys = NoKeys;
    type Form = Hertzian;
    const ELASTIC_SPHERES: bool = true;

    fn onset(_keys: &NoKeys) -> Onset {
        Onset::FourthRoot
    }

    fn between(pair: &MaterialPair, _keys: &NoKeys, _friction: FrictionNeeds) -> Result<Hertzian, Missing> {
        let log = libm::log(pair.get(&property::RESTITUTION)?);
        let beta = log / (log * log + std::f64::consts::PI * std::f64::consts::PI).sqrt();
        let (modulus, shear_modulus) = (pair.effective_youngs_modulus()?, pair.effective_shear_modulus()?);
        let damping = -2.0 * (5.0_f64 / 6.0).sqrt() * beta;
        Ok(Hertzian::new(
            4.0 / 3.0 * modulus,
            8.0 * shear_modulus,
            damping * (2.0 * modulus).sqrt(),
            damping * (8.0 * shear_modulus).sqrt(),
            0.0,
            0.0,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::laws::contact::fixtures::{ALL, assert_close, contact, properties, with_pair};
    use crate::laws::contact::{Contact, NormalForm};

    /// E* = 1 Pa, G* = ¼ Pa, √(R* δ) = 2⁻⁸ m, m* = 4 kg.
    fn law(restitution: f64) -> Hertzian {
        let properties = properties().with(&property::RESTITUTION, restitution);
        with_pair(&properties, |pair| Hertz::between(pair, &NoKeys {}, ALL)).unwrap()
    }

    #[test]
    fn is_as_stiff_as_hertz_and_mindlin_say() {
        let response = Hertzian::response(law(0.5), &contact());
        assert_close(response.normal_stiffness, 4.0 / 3.0 / 256.0, 1e-15);
        // 1/G* = 2 · 2 (2 − 0)(1 + 0)/2 = 4
        assert_close(response.tangential_stiffness, 8.0 * 0.25 / 256.0, 1e-15);
    }

    #[test]
    fn damps_with_the_slopes_of_both_forces() {
        let response = Hertzian::response(law(0.5), &contact());
        let log = libm::log(0.5);
        let share = -2.0 * (5.0_f64 / 6.0).sqrt() * log / (log * log + std::f64::consts::PI.powi(2)).sqrt();
        assert_close(response.normal_damping, share * (2.0 / 256.0 * 4.0_f64).sqrt(), 1e-15);
        assert_close(response.tangential_damping, share * (8.0 * 0.25 / 256.0 * 4.0_f64).sqrt(), 1e-15);
    }

    #[test]
    fn does_not_damp_an_elastic_contact() {
        let response = Hertzian::response(law(1.0), &contact());
        assert_eq!([response.normal_damping.abs(), response.tangential_damping.abs()], [0.0, 0.0]);
    }

    #[test]
    fn tangent_stiffness_is_the_slope_of_the_force() {
        let force =
            |overlap| Hertzian::response(law(0.5), &Contact { overlap, ..contact() }).normal_stiffness * overlap;
        let (here, by) = (contact().overlap, 1e-4 * contact().overlap);
        // central difference: relative error (1e-4)²/24
        let slope = (force(here + by) - force(here - by)) / (2.0 * by);
        assert_close(law(0.5).tangent_stiffness(&contact()), slope, 1e-9);
    }
}
