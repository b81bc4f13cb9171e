//! Sticky elastic spheres, hard and small: they pull while they touch.

use super::sticky::{self, Damping, Keys};
use crate::base::number::{Number, Row};
use crate::laws::contact::{
    Adhesion, Contact, FrictionNeeds, MaterialPair, Missing, Normal, NormalForce, NormalForm, Response, Roots,
    Switches, coefficients,
};
use std::f64::consts::PI;

coefficients! {
    /// Derjaguin, Muller and Toporov's spheres with surface energy.
    ///
    /// ```text
    /// a    = √(R* δ)
    /// F_e  = 4/3 E* a δ − F_po        F_po = 4 π γ R*
    /// F_n  = F_e − γ_n v_n            N = |F_e + 2 F_po|
    /// γ_n  = η m* a, η m* or η        γ_t = x_t γ_n
    /// k_n  = 4/3 E* a                 k_t = 8 G* a       for the other sub-models
    /// ```
    ///
    /// | symbol | meaning                                   | unit | comes from                 |
    /// |--------|-------------------------------------------|------|----------------------------|
    /// | δ      | overlap                                   | m    | the contact                |
    /// | R*, m* | effective radius and mass                 | m, kg| the contact                |
    /// | E*, G* | effective moduli                          | Pa   | two materials              |
    /// | γ      | surface energy; work of adhesion is 2 γ   | J/m² | `surface_energy`           |
    /// | η      | damping                                   | as `damping` says | `damping_coefficient` |
    /// | x_t    | tangential over normal damping            | 1    | `tangential_damping_ratio` |
    /// | N      | normal force that friction and rolling see| N    |                            |
    ///
    /// Hertz's force less a constant pull, which begins and ends with touch. For hard, small spheres of little surface
    /// energy (Tabor's number below 0.1); for soft, large ones see `jkr`.
    ///
    /// With `engine_exact` the slip velocity has arms R instead of R − δ/2, and the torque at a wall too, as in the
    /// engine.
    ///
    /// Source: B. V. Derjaguin, V. M. Muller & Y. P. Toporov, *J. Colloid Interface Sci.* 53 (1975) 314–326; LAMMPS
    /// manual, `pair_style granular`.
    pub struct Dmt {
        /// E* \[Pa\].
        youngs_modulus,
        /// γ \[J/m²\].
        surface_energy,
        /// k_t over the contact radius \[Pa\].
        tangential_modulus,
        /// η of γ_n = η m* a \[1/(m s)\].
        viscoelastic_damping,
        /// η of γ_n = η m* \[1/s\].
        mass_damping,
        /// η of γ_n = η \[kg/s\].
        plain_damping,
        /// x_t.
        tangential_damping_ratio,
    }
}

impl Normal for Dmt {
    const NAME: &'static str = "dmt";
    type Keys = Keys;
    type Form = Self;
    const ELASTIC_SPHERES: bool = true;

    fn between(pair: &MaterialPair, keys: &Keys, friction: FrictionNeeds) -> Result<Self, Missing> {
        let [modulus, energy, tangential, viscoelastic, mass, plain, ratio] = keys.coefficients(pair, friction)?;
        Ok(Self::new(modulus, energy, tangential, viscoelastic, mass, plain, ratio))
    }

    fn has_undeformed_arms(keys: &Keys) -> bool {
        keys.engine_exact
    }
}

impl NormalForm for Dmt {
    const ADHESION: Adhesion = Adhesion::InTouch;

    #[inline(always)]
    fn response_at<N: Number>(law: Dmt<N>, contact: &Contact<N>, _roots: Roots<N>) -> Response<N> {
        let damping = Damping {
            viscoelastic: law.viscoelastic_damping,
            mass: law.mass_damping,
            plain: law.plain_damping,
            tangential_ratio: law.tangential_damping_ratio,
        };
        let contact_radius = (contact.radius * contact.overlap).sqrt();
        sticky::response(law.youngs_modulus, law.tangential_modulus, damping, contact.mass, contact_radius)
    }

    #[inline(always)]
    fn force<N: Number>(
        law: Dmt<N>,
        switches: Switches<N>,
        contact: &Contact<N>,
        roots: Roots<N>,
        history: [N; 4],
        _step: N,
    ) -> (NormalForce<N>, [N; 4]) {
        let response = Self::response_at(law, contact, roots);
        let pull_off = N::splat(4.0 * PI) * law.surface_energy * contact.radius;
        let elastic = response.normal_stiffness * contact.overlap - pull_off;
        (sticky::force(response, switches, contact, elastic, pull_off), history)
    }

    fn elastic_energy(&self, contact: &Contact, _offset: f64, _history: Row) -> f64 {
        let hertz = 8.0 / 15.0 * self.youngs_modulus * (contact.radius * contact.overlap).sqrt() * contact.overlap;
        (hertz - 4.0 * PI * self.surface_energy * contact.radius) * contact.overlap
    }

    fn tangent_stiffness(&self, contact: &Contact) -> f64 {
        2.0 * self.youngs_modulus * (contact.radius * contact.overlap).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::contact::fixtures::{ALL, assert_close, contact, properties, with_pair};

    /// E* = 1 Pa, γ = 1e-6 J/m², η = 2, x_t = ½; R* = ¼ m, √(R* δ) = 1/256 m, m* = 4 kg, v_n = −½ m/s.
    fn found(keys: Keys) -> NormalForce {
        let law = with_pair(&properties(), |pair| Dmt::between(pair, &keys, ALL)).unwrap();
        Dmt::force(law, Switches::of(false, true), &contact(), [0.0; 2], [0.0; 4], 0.0).0
    }

    /// 4 π γ R*.
    const PULL_OFF: f64 = 4.0 * PI * 1e-6 * 0.25;
    /// Hertz's force.
    const HERTZ: f64 = 4.0 / 3.0 / 256.0 / 16384.0;

    #[test]
    fn pulls_by_a_constant_force_beside_hertz() {
        let keys = Keys { damping: sticky::DampingKind::Velocity, ..Keys::default() };
        assert_close(found(keys).force, HERTZ - PULL_OFF + 2.0 * 0.5, 1e-15);
        assert_close(found(keys).seen, HERTZ + PULL_OFF, 1e-15);
    }

    #[test]
    fn damps_as_asked() {
        let of = |damping| found(Keys { damping, ..Keys::default() }).response;
        assert_eq!(of(sticky::DampingKind::Viscoelastic).normal_damping, 2.0 * 4.0 / 256.0);
        assert_eq!(of(sticky::DampingKind::MassVelocity).normal_damping, 2.0 * 4.0);
        assert_eq!(of(sticky::DampingKind::Velocity).normal_damping, 2.0);
        assert_eq!(of(sticky::DampingKind::Velocity).tangential_damping, 1.0);
    }

    #[test]
    fn is_as_stiff_tangentially_as_mindlin_says_or_as_given() {
        // 8 G* a, G* = ¼ Pa; 50 Pa given
        assert_close(found(Keys::default()).response.tangential_stiffness, 2.0 / 256.0, 1e-15);
        let given = Keys { given_tangential_modulus: true, ..Keys::default() };
        assert_eq!(found(given).response.tangential_stiffness, 50.0 / 256.0);
    }
}
