//! What models of sticky elastic spheres have in common.

use crate::base::document::keys;
use crate::base::number::Number;
use crate::laws::contact::{Contact, FrictionNeeds, MaterialPair, Missing, NormalForce, Response, Switches, property};
use serde::Deserialize;

/// What the damping of a sticky contact follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampingKind {
    /// γ_n = η m* a.
    #[default]
    Viscoelastic,
    /// γ_n = η m*.
    MassVelocity,
    /// γ_n = η.
    Velocity,
}

keys! {
    /// `[contact.<law>.normal.dmt]`; `jkr` has these keys, too.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Keys {
        /// γ_n follows mass and contact radius (`"viscoelastic"`), mass (`"mass_velocity"`), or neither (`"velocity"`).
        #[serde(default)]
        pub damping: DampingKind = "`\"viscoelastic\"`",
        /// Whether k_t is `tangential_stiffness` \[Pa\] times the contact radius, not 8 G* times it.
        #[serde(default)]
        pub given_tangential_modulus: bool = "`false`",
        /// Whether slip is that of the undeformed spheres, and torques at walls have their arms, as in the engine.
        #[serde(default)]
        pub engine_exact: bool = "`false`",
    }
}

impl Keys {
    /// The coefficients for two materials: E*, γ, k_t over the contact radius, η of the three kinds, x_t.
    pub(super) fn coefficients(&self, pair: &MaterialPair, friction: FrictionNeeds) -> Result<[f64; 7], Missing> {
        let tangential = match (friction.stiffness, self.given_tangential_modulus) {
            (false, _) => 0.0,
            (true, true) => pair.get(&property::TANGENTIAL_STIFFNESS)?,
            (true, false) => 8.0 * pair.effective_shear_modulus()?,
        };
        let damping = pair.get(&property::DAMPING_COEFFICIENT)?;
        let [viscoelastic, mass, plain] = [DampingKind::Viscoelastic, DampingKind::MassVelocity, DampingKind::Velocity]
            .map(|kind| if kind == self.damping { damping } else { 0.0 });
        let ratio = if friction.damping { pair.get(&property::TANGENTIAL_DAMPING_RATIO)? } else { 0.0 };
        let (modulus, energy) = (pair.effective_youngs_modulus()?, pair.get(&property::SURFACE_ENERGY)?);
        Ok([modulus, energy, tangential, viscoelastic, mass, plain, ratio])
    }
}

/// What damps a sticky contact.
#[derive(Clone, Copy)]
pub(super) struct Damping<N> {
    /// η of γ_n = η m* a \[1/(m s)\].
    pub(super) viscoelastic: N,
    /// η of γ_n = η m* \[1/s\].
    pub(super) mass: N,
    /// η of γ_n = η \[kg/s\].
    pub(super) plain: N,
    /// x_t.
    pub(super) tangential_ratio: N,
}

/// Stiffness and damping of a sticky contact: E* and k_t over the contact radius \[Pa\], mass \[kg\], contact radius
/// \[m\].
#[inline(always)]
pub(super) fn response<N: Number>(
    modulus: N,
    tangential_modulus: N,
    damping: Damping<N>,
    mass: N,
    contact_radius: N,
) -> Response<N> {
    let normal_damping = damping.viscoelastic * mass * contact_radius + damping.mass * mass + damping.plain;
    Response {
        normal_stiffness: N::splat(4.0 / 3.0) * modulus * contact_radius,
        normal_damping,
        tangential_stiffness: tangential_modulus * contact_radius,
        tangential_damping: damping.tangential_ratio * normal_damping,
    }
}

/// The normal force of a sticky contact from its elastic part and its largest pull \[N\].
#[inline(always)]
pub(super) fn force<N: Number>(
    mut response: Response<N>,
    switches: Switches<N>,
    contact: &Contact<N>,
    elastic: N,
    pull_off: N,
) -> NormalForce<N> {
    response.tangential_damping = response.tangential_damping * switches.tangential_damping_factor;
    NormalForce {
        response,
        force: elastic - response.normal_damping * contact.normal_velocity,
        seen: elastic + pull_off + pull_off,
    }
}
