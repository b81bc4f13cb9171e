//! A linear spring of given stiffness.

use crate::base::document::keys;
use crate::base::number::{Number, Row};
use crate::laws::contact::{
    Contact, FrictionNeeds, MaterialPair, Missing, Normal, NormalForm, Onset, Response, Roots, coefficients, property,
};

coefficients! {
    /// A linear spring and dashpot as the scene gives them.
    ///
    /// ```text
    /// k_n = κ_n          k_t = κ_t
    /// γ_n = m* g_n       γ_t = m* g_t       absolute_damping = false
    /// γ_n = g_n          γ_t = g_t          absolute_damping = true
    /// ```
    ///
    /// | symbol   | meaning                  | unit | comes from                                               |
    /// |----------|--------------------------|------|----------------------------------------------------------|
    /// | m*       | effective mass           | kg   | the contact                                              |
    /// | κ_n, κ_t | stiffnesses              | N/m  | `normal_stiffness`, `tangential_stiffness`               |
    /// | g_n, g_t | damping for each mass    | 1/s  | `normal_damping`, `tangential_damping`                   |
    /// | g_n, g_t | damping, absolute        | kg/s | `absolute_normal_damping`, `absolute_tangential_damping` |
    ///
    /// Stiffness is the contact's, whatever the bodies' size. The force may pull near the end of a contact.
    ///
    /// Source: P. A. Cundall & O. D. L. Strack, *Géotechnique* 29 (1979) 47–65.
    pub struct HookeStiffness {
        /// κ_n \[N/m\].
        normal_stiffness,
        /// κ_t \[N/m\].
        tangential_stiffness,
        /// Normal damping for each mass, 0 with `absolute_damping` \[1/s\].
        normal_damping_rate,
        /// Tangential damping for each mass, 0 with `absolute_damping` \[1/s\].
        tangential_damping_rate,
        /// Normal damping whatever the mass, 0 without `absolute_damping` \[kg/s\].
        normal_damping,
        /// Tangential damping whatever the mass, 0 without `absolute_damping` \[kg/s\].
        tangential_damping,
    }
}

keys! {
    /// `[contact.<law>.normal.hooke_stiffness]`
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// Whether damping is given whatever the masses.
        #[serde(default)]
        pub absolute_damping: bool = "`false`",
    }
}

impl Normal for HookeStiffness {
    const NAME: &'static str = "hooke_stiffness";
    type Keys = Keys;
    type Form = Self;

    fn onset(_keys: &Keys) -> Onset {
        Onset::Constant
    }

    fn between(pair: &MaterialPair, keys: &Keys, friction: FrictionNeeds) -> Result<Self, Missing> {
        let normal_stiffness = pair.get(&property::NORMAL_STIFFNESS)?;
        let tangential_stiffness = if friction.stiffness { pair.get(&property::TANGENTIAL_STIFFNESS)? } else { 0.0 };
        let (mut rates, mut dampings) = ([0.0; 2], [0.0; 2]);
        if keys.absolute_damping {
            dampings[0] = pair.get(&property::ABSOLUTE_NORMAL_DAMPING)?;
            dampings[1] = if friction.damping { pair.get(&property::ABSOLUTE_TANGENTIAL_DAMPING)? } else { 0.0 };
        } else {
            rates[0] = pair.get(&property::NORMAL_DAMPING)?;
            rates[1] = if friction.damping { pair.get(&property::TANGENTIAL_DAMPING)? } else { 0.0 };
        }
        Ok(Self::new(normal_stiffness, tangential_stiffness, rates[0], rates[1], dampings[0], dampings[1]))
    }
}

impl NormalForm for HookeStiffness {
    #[inline(always)]
    fn response_at<N: Number>(law: HookeStiffness<N>, contact: &Contact<N>, _roots: Roots<N>) -> Response<N> {
        Response {
            normal_stiffness: law.normal_stiffness,
            normal_damping: contact.mass * law.normal_damping_rate + law.normal_damping,
            tangential_stiffness: law.tangential_stiffness,
            tangential_damping: contact.mass * law.tangential_damping_rate + law.tangential_damping,
        }
    }

    fn elastic_energy(&self, contact: &Contact, offset: f64, _history: Row) -> f64 {
        let pressing = contact.overlap - offset;
        0.5 * self.normal_stiffness * pressing * pressing
    }

    fn tangent_stiffness(&self, _contact: &Contact) -> f64 {
        self.normal_stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::laws::contact::fixtures::{ALL, NOTHING, contact, properties, with_pair};

    /// What the law says of the fixture's contact, m* = 4 kg.
    fn response(absolute_damping: bool, friction: FrictionNeeds) -> Response {
        let keys = Keys { absolute_damping };
        let law = with_pair(&properties(), |pair| HookeStiffness::between(pair, &keys, friction)).unwrap();
        HookeStiffness::response(law, &contact())
    }

    #[test]
    fn is_as_stiff_as_given() {
        let response = response(false, ALL);
        assert_eq!([response.normal_stiffness, response.tangential_stiffness], [100.0, 50.0]);
    }

    #[test]
    fn damps_each_mass_by_the_given_rate() {
        let response = response(false, ALL);
        assert_eq!([response.normal_damping, response.tangential_damping], [4.0 * 6.0, 4.0 * 3.0]);
    }

    #[test]
    fn damps_whatever_the_mass_when_told_so() {
        let response = response(true, ALL);
        assert_eq!([response.normal_damping, response.tangential_damping], [11.0, 9.0]);
    }

    #[test]
    fn asks_for_nothing_tangential_where_nothing_uses_it() {
        let bare = properties().without(&property::TANGENTIAL_STIFFNESS).without(&property::TANGENTIAL_DAMPING);
        let between = |friction| with_pair(&bare, |pair| HookeStiffness::between(pair, &Keys::default(), friction));
        assert!(between(NOTHING).is_ok());
        assert_eq!(between(ALL).unwrap_err().key, "tangential_stiffness");
        assert_eq!(between(FrictionNeeds { damping: true, ..NOTHING }).unwrap_err().key, "tangential_damping");
    }

    #[test]
    fn tangent_stiffness_is_the_spring() {
        let law = HookeStiffness::new(100.0, 50.0, 0.0, 0.0, 0.0, 0.0);
        assert_eq!(law.tangent_stiffness(&contact()), 100.0);
    }
}
