//! A linear spring as stiff as a Hertz contact at one chosen speed.

use crate::base::document::keys;
use crate::base::number::{Number, Row};
use crate::base::quantity::Positive;
use crate::laws::contact::{
    Contact, FrictionNeeds, MaterialPair, Missing, Normal, NormalForm, Onset, Response, Roots, coefficients, property,
};
use std::f64::consts::PI;

coefficients! {
    /// A linear spring with the damping of a constant coefficient of restitution.
    ///
    /// ```text
    /// k_n = 16/15 √R* E* (15 m* V²/(16 √R* E*))^(1/5)       k_t = k_n
    /// γ_n = √(4 m* k_n ln² e/(ln² e + π²))                   γ_t = γ_n
    /// ```
    ///
    /// | symbol | meaning                    | unit  | comes from                |
    /// |--------|----------------------------|-------|---------------------------|
    /// | R*, m* | effective radius and mass  | m, kg | the contact               |
    /// | E*     | effective Young's modulus  | Pa    | two materials             |
    /// | V      | characteristic velocity    | m/s   | `characteristic_velocity` |
    /// | e      | coefficient of restitution | 1     | `restitution`             |
    ///
    /// At an impact with speed V the spring stores at its largest overlap what a Hertz contact would. Slower impacts are too
    /// stiff, faster ones too soft. The measured restitution is e at every speed. The force may pull near the end of a
    /// contact.
    ///
    /// Source: the stiffness of equal strain energy, LIGGGHTS manual, `gran_model_hooke`.
    pub struct Hooke {
        /// E* \[Pa\].
        youngs_modulus,
        /// V² \[m²/s²\].
        squared_velocity,
        /// 2 |ln e|/√(ln² e + π²): twice the fraction of critical damping.
        damping,
    }
}

keys! {
    /// `[contact.<law>.normal.hooke]`
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Keys {
        /// Impact speed V of equal strain energy with Hertz \[m/s\].
        pub characteristic_velocity: Positive = "required",
    }
}

/// k_n of effective Young's modulus \[Pa\], squared velocity \[m²/s²\], effective radius \[m\] and mass \[kg\].
pub(super) fn stiffness(youngs_modulus: f64, squared_velocity: f64, radius: f64, mass: f64) -> f64 {
    let stiffness = 16.0 / 15.0 * radius * youngs_modulus;
    // The fifth root of a number without unit: the same bits in any system of units whose factors are powers of two.
    stiffness * libm::pow(mass * squared_velocity / (stiffness * radius * radius), 0.2)
}

impl Normal for Hooke {
    const NAME: &'static str = "hooke";
    type Keys = Keys;
    type Form = Self;

    fn onset(_keys: &Keys) -> Onset {
        Onset::Constant
    }

    fn between(pair: &MaterialPair, keys: &Keys, _friction: FrictionNeeds) -> Result<Self, Missing> {
        let velocity = keys.characteristic_velocity.get();
        let log = libm::log(pair.get(&property::RESTITUTION)?);
        let damping = 2.0 * (log * log / (log * log + PI * PI)).sqrt();
        Ok(Self::new(pair.effective_youngs_modulus()?, velocity * velocity, damping))
    }
}

impl NormalForm for Hooke {
    const HAS_PAIR_CONSTANT: bool = true;

    fn pair_constant(&self, radius: f64, mass: f64) -> f64 {
        stiffness(self.youngs_modulus, self.squared_velocity, radius, mass)
    }

    #[inline(always)]
    fn response_at<N: Number>(law: Hooke<N>, contact: &Contact<N>, _roots: Roots<N>) -> Response<N> {
        let stiffness = contact.pair_constant;
        let damping = law.damping * (contact.mass * stiffness).sqrt();
        Response {
            normal_stiffness: stiffness,
            normal_damping: damping,
            tangential_stiffness: stiffness,
            tangential_damping: damping,
        }
    }

    fn elastic_energy(&self, contact: &Contact, offset: f64, _history: Row) -> f64 {
        let pressing = contact.overlap - offset;
        0.5 * contact.pair_constant * pressing * pressing
    }

    fn tangent_stiffness(&self, contact: &Contact) -> f64 {
        contact.pair_constant
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::laws::contact::fixtures::{ALL, assert_close, contact, properties, with_pair};

    /// At V = 2 m/s; E* is 1 Pa.
    fn law(restitution: f64) -> Hooke {
        let keys = Keys { characteristic_velocity: Positive::new(2.0).unwrap() };
        let properties = properties().with(&property::RESTITUTION, restitution);
        with_pair(&properties, |pair| Hooke::between(pair, &keys, ALL)).unwrap()
    }

    #[test]
    fn stiffness_is_the_written_power_of_radius_mass_and_velocity() {
        // R* = 4 m, so √R* E* = 2 N/m^½; m* V² chosen so that the base of the power is 32
        let mass = 32.0 * 16.0 * 2.0 / (15.0 * 4.0);
        assert_close(law(0.5).pair_constant(4.0, mass), 16.0 / 15.0 * 2.0 * 2.0, 4.0 * f64::EPSILON);
    }

    #[test]
    fn stores_as_much_as_a_hertz_contact_at_the_characteristic_velocity() {
        let (radius, mass) = (0.003, 0.0002);
        let stiffness = law(0.5).pair_constant(radius, mass);
        let largest_overlap = libm::pow(15.0 * mass * 4.0 / (16.0 * radius.sqrt()), 0.4);
        // Hertz: 8/15 E* √R* δ^(5/2) = ½ m* V²; the spring: ½ k δ²
        assert_close(0.5 * stiffness * largest_overlap * largest_overlap, 0.5 * mass * 4.0, 1e-14);
    }

    #[test]
    fn damping_gives_the_restitution_of_a_linear_oscillator() {
        let contact = Contact { pair_constant: 9.0, ..contact() };
        let response = Hooke::response(law(0.5), &contact);
        // e = exp(−π ζ/√(1 − ζ²)) with γ = 2 ζ √(m k)
        let zeta = response.normal_damping / (2.0 * (4.0_f64 * 9.0).sqrt());
        assert_close(libm::exp(-PI * zeta / (1.0 - zeta * zeta).sqrt()), 0.5, 1e-14);
    }

    #[test]
    fn does_not_damp_an_elastic_contact() {
        let contact = Contact { pair_constant: 9.0, ..contact() };
        assert_eq!(Hooke::response(law(1.0), &contact).normal_damping, 0.0);
    }

    #[test]
    fn is_the_same_in_the_tangent_plane() {
        let response = Hooke::response(law(0.5), &Contact { pair_constant: 9.0, ..contact() });
        assert_eq!(response.tangential_stiffness, response.normal_stiffness);
        assert_eq!(response.tangential_damping, response.normal_damping);
    }

    #[test]
    fn tangent_stiffness_is_the_spring() {
        assert_eq!(law(0.5).tangent_stiffness(&Contact { pair_constant: 9.0, ..contact() }), 9.0);
    }
}
