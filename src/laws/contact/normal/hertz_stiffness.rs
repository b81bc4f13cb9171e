//! Hertz's force with a given stiffness.

use super::hertzian::Hertzian;
use crate::laws::contact::{FrictionNeeds, MaterialPair, Missing, NoKeys, Normal, Onset, property};

/// A spring and dashpot that grow with the radius of the contact, scaled as the scene gives them.
///
/// ```text
/// k_n = √(R* δ) κ_n          k_t = √(R* δ) κ_t
/// γ_n = √(R* δ) m* g_n       γ_t = √(R* δ) m* g_t
/// ```
///
/// | symbol   | meaning                         | unit     | comes from                                 |
/// |----------|---------------------------------|----------|--------------------------------------------|
/// | δ        | overlap                         | m        | the contact                                |
/// | R*, m*   | effective radius and mass       | m, kg    | the contact                                |
/// | κ_n, κ_t | stiffnesses                     | Pa       | `normal_stiffness`, `tangential_stiffness` |
/// | g_n, g_t | damping for each mass and length| 1/(m s)  | `normal_damping`, `tangential_damping`     |
///
/// κ_n = 4/3 E* is Hertz's force. Damping by √(R* δ) leaves a restitution that rises with speed. The force
/// may pull near the end of a contact.
///
/// Source: L. E. Silbert et al., *Phys. Rev. E* 64 (2001) 051302.
#[derive(Clone, Copy, Debug)]
pub struct HertzStiffness;

impl Normal for HertzStiffness {
    const NAME: &'static str = "hertz_stiffness";
    type Keys = NoKeys;
    type Form = Hertzian;

    fn onset(_keys: &NoKeys) -> Onset {
        Onset::SquareRoot
    }

    fn between(pair: &MaterialPair, _keys: &NoKeys, friction: FrictionNeeds) -> Result<Hertzian, Missing> {
        Ok(Hertzian::new(
            pair.get(&property::NORMAL_STIFFNESS)?,
            if friction.stiffness { pair.get(&property::TANGENTIAL_STIFFNESS)? } else { 0.0 },
            0.0,
            0.0,
            pair.get(&property::NORMAL_DAMPING)?,
            if friction.damping { pair.get(&property::TANGENTIAL_DAMPING)? } else { 0.0 },
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{ALL, NOTHING, assert_close, contact, properties, with_pair};
    use crate::laws::contact::{Contact, NormalForm};

    /// κ_n = 100 Pa, κ_t = 50 Pa, g_n = 6/(m s), g_t = 3/(m s).
    fn law() -> Hertzian {
        with_pair(&properties(), |pair| HertzStiffness::between(pair, &NoKeys {}, ALL)).unwrap()
    }

    #[test]
    fn stiffness_grows_with_the_radius_of_the_contact() {
        let response = Hertzian::response(law(), &contact());
        assert_eq!([response.normal_stiffness, response.tangential_stiffness], [100.0 / 256.0, 50.0 / 256.0]);
    }

    #[test]
    fn damping_grows_with_the_radius_of_the_contact_and_the_mass() {
        let response = Hertzian::response(law(), &contact());
        assert_eq!([response.normal_damping, response.tangential_damping], [4.0 * 6.0 / 256.0, 4.0 * 3.0 / 256.0]);
    }

    #[test]
    fn is_slack_at_first_touch() {
        let response = Hertzian::response(law(), &Contact { overlap: 0.0, ..contact() });
        assert_eq!([response.normal_stiffness, response.normal_damping, response.tangential_damping], [0.0; 3]);
    }

    #[test]
    fn asks_for_nothing_tangential_where_nothing_uses_it() {
        let bare = properties().without(&property::TANGENTIAL_STIFFNESS).without(&property::TANGENTIAL_DAMPING);
        assert!(with_pair(&bare, |pair| HertzStiffness::between(pair, &NoKeys {}, NOTHING)).is_ok());
        assert!(with_pair(&bare, |pair| HertzStiffness::between(pair, &NoKeys {}, ALL)).is_err());
    }

    #[test]
    fn tangent_stiffness_is_the_slope_of_the_force() {
        let force = |overlap| {
            let contact = Contact { overlap, ..contact() };
            Hertzian::response(law(), &contact).normal_stiffness * overlap
        };
        let (here, by) = (contact().overlap, 1e-4 * contact().overlap);
        // central difference: relative error (1e-4)²/24
        assert_close(law().tangent_stiffness(&contact()), (force(here + by) - force(here - by)) / (2.0 * by), 1e-9);
    }
}
