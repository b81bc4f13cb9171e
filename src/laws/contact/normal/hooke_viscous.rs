//! A linear spring whose damping follows a fluid between the bodies.

use super::hooke;
use crate::base::number::{Number, Row};
use crate::laws::contact::{
    Contact, FrictionNeeds, MaterialPair, Missing, Normal, NormalForm, Response, Roots, coefficients, property,
};
use std::f64::consts::PI;

coefficients! {
    /// A linear spring damped as a collision in a viscous fluid.
    ///
    /// ```text
    /// k_n as of `hooke`                                       k_t = k_n
    /// γ_n = √(4 m* k_n L²/(L² + π²)),  L = ln e_max + St_c/St  γ_t = γ_n
    /// St  = m* v_n/(6 π η R*²)
    /// v_n = 0:  γ_n = 2 √(m* k_n), the limit
    /// ```
    ///
    /// | symbol | meaning                                | unit  | comes from                |
    /// |--------|----------------------------------------|-------|---------------------------|
    /// | R*, m* | effective radius and mass              | m, kg | the contact               |
    /// | v_n    | normal velocity of this moment, signed | m/s   | the contact               |
    /// | e_max  | coefficient of restitution, dry        | 1     | `maximum_restitution`     |
    /// | St_c   | critical Stokes number                 | 1     | `critical_stokes_number`  |
    /// | η      | viscosity of the fluid                 | Pa s  | `fluid_viscosity`         |
    ///
    /// The restitution of the source, e = e_max exp(St_c/St), belongs to the impact velocity. Here the velocity of the
    /// moment stands for it, with its sign. Damping is stronger during approach than during rebound, and vanishes on the way
    /// out where L passes 0. It is never above critical damping.
    ///
    /// Source: D. Legendre, C. Daniel & P. Guiraud, *Phys. Fluids* 17 (2005) 097105; the moment's velocity as in
    /// the LIGGGHTS manual, `gran_model_hooke`, `viscous`.
    pub struct HookeViscous {
        /// E* \[Pa\].
        youngs_modulus,
        /// V² \[m²/s²\].
        squared_velocity,
        /// ln e_max, of 0 or below.
        dry_logarithm,
        /// 6 π η St_c \[Pa s\].
        viscosity,
    }
}

impl Normal for HookeViscous {
    const NAME: &'static str = "hooke_viscous";
    type Keys = hooke::Keys;
    type Form = Self;

    fn between(pair: &MaterialPair, keys: &hooke::Keys, _friction: FrictionNeeds) -> Result<Self, Missing> {
        let velocity = keys.characteristic_velocity.get();
        Ok(Self::new(
            pair.effective_youngs_modulus()?,
            velocity * velocity,
            libm::log(pair.get(&property::MAXIMUM_RESTITUTION)?),
            6.0 * PI * pair.get(&property::FLUID_VISCOSITY)? * pair.get(&property::CRITICAL_STOKES_NUMBER)?,
        ))
    }
}

impl NormalForm for HookeViscous {
    const HAS_PAIR_CONSTANT: bool = true;

    fn pair_constant(&self, radius: f64, mass: f64) -> f64 {
        hooke::stiffness(self.youngs_modulus, self.squared_velocity, radius, mass)
    }

    #[inline(always)]
    fn response_at<N: Number>(law: HookeViscous<N>, contact: &Contact<N>, _roots: Roots<N>) -> Response<N> {
        let stiffness = contact.pair_constant;
        // L v_n rather than L, which is infinite at rest
        let loss = law.dry_logarithm * contact.normal_velocity
            + law.viscosity * contact.radius * contact.radius / contact.mass;
        let turn = N::splat(PI) * contact.normal_velocity;
        let whole = loss * loss + turn * turn;
        let share = N::select(whole.greater(N::zero()), loss * loss / whole, N::splat(1.0));
        let damping = N::splat(2.0) * (contact.mass * stiffness * share).sqrt();
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
    use crate::base::quantity::Positive;
    use crate::laws::contact::fixtures::{ALL, assert_close, contact, properties, with_pair};

    /// At V = 2 m/s, e_max = ⅞, St_c = 30, η = ½ Pa s.
    fn law() -> HookeViscous {
        let keys = hooke::Keys { characteristic_velocity: Positive::new(2.0).unwrap() };
        with_pair(&properties(), |pair| HookeViscous::between(pair, &keys, ALL)).unwrap()
    }

    /// γ_n at this normal velocity, with k_n = 9 N/m.
    fn damping(normal_velocity: f64) -> f64 {
        HookeViscous::response(law(), &Contact { pair_constant: 9.0, normal_velocity, ..contact() }).normal_damping
    }

    /// L at this normal velocity, as the equations are written.
    fn logarithm(normal_velocity: f64) -> f64 {
        let stokes = 4.0 * normal_velocity / (6.0 * PI * 0.5 * 0.25 * 0.25);
        libm::log(0.875) + 30.0 / stokes
    }

    #[test]
    fn damps_by_the_stokes_number_of_the_moment() {
        let log = logarithm(-0.5);
        assert_close(damping(-0.5), (4.0 * 4.0 * 9.0 * log * log / (log * log + PI * PI)).sqrt(), 1e-14);
    }

    #[test]
    fn damps_approach_more_than_rebound() {
        let log = logarithm(0.5);
        assert_close(damping(0.5), (4.0 * 4.0 * 9.0 * log * log / (log * log + PI * PI)).sqrt(), 1e-13);
        assert!(damping(0.5) < damping(-0.5));
    }

    #[test]
    fn is_critical_at_rest() {
        assert_eq!(damping(0.0), 2.0 * (4.0_f64 * 9.0).sqrt());
        assert_eq!(damping(-0.0), damping(0.0));
    }

    #[test]
    fn goes_to_the_value_at_rest_without_a_jump() {
        assert_close(damping(1e-12), damping(0.0), 1e-11);
        assert_close(damping(-1e-300), damping(0.0), 1e-11);
    }

    #[test]
    fn vanishes_on_the_way_out_where_the_logarithm_passes_zero() {
        let velocity = 30.0 * 6.0 * PI * 0.5 * 0.25 * 0.25 / (4.0 * -libm::log(0.875));
        assert!(damping(velocity) < 1e-12 * damping(0.0), "{}", damping(velocity));
        assert!(damping(2.0 * velocity) > 0.0);
    }

    #[test]
    fn is_a_number_where_every_product_underflows() {
        let law = HookeViscous::new(1.0, 1.0, 0.0, 1e-300);
        let contact = Contact { pair_constant: 9.0, normal_velocity: 1e-300, ..contact() };
        assert!(HookeViscous::response(law, &contact).normal_damping.is_finite());
    }

    #[test]
    fn is_as_stiff_as_hooke_in_both_directions() {
        let keys = hooke::Keys { characteristic_velocity: Positive::new(2.0).unwrap() };
        let dry = with_pair(&properties(), |pair| hooke::Hooke::between(pair, &keys, ALL)).unwrap();
        assert_eq!(law().pair_constant(0.25, 4.0), dry.pair_constant(0.25, 4.0));
        let response = HookeViscous::response(law(), &Contact { pair_constant: 9.0, ..contact() });
        assert_eq!([response.normal_stiffness, response.tangential_stiffness], [9.0, 9.0]);
        assert_eq!(response.tangential_damping, response.normal_damping);
        assert_eq!(law().tangent_stiffness(&Contact { pair_constant: 9.0, ..contact() }), 9.0);
    }
}
