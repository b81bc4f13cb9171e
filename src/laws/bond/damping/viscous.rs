//! Dashpots.

use super::{Damped, Damping, Model};
use crate::base::number::Number;
use crate::base::quantity::NonNegative;
use crate::laws::bond::elasticity::Parts;
use crate::laws::bond::part_keys::PartKeys;
use crate::laws::bond::{Coefficients, Elastic, Motion, Pair};
use serde::{Deserialize, Deserializer};

/// A key that scenes had.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gone {}

impl<'de> Deserialize<'de> for Gone {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(serde::de::Error::custom(
            "not a key any more: dashpots act as forces in every scheme; leave it out, and where they make the time step too short take a \
             smaller damping ratio, or damping.opposing",
        ))
    }
}

/// `[bond.<name>.damping.viscous]`
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys {
    /// ζ of the normal force.
    pub normal_force: Option<NonNegative>,
    /// ζ of the shear force.
    pub tangential_force: Option<NonNegative>,
    /// ζ of the torsion.
    pub normal_torque: Option<NonNegative>,
    /// ζ of the bending torque.
    pub tangential_torque: Option<NonNegative>,
    /// Refused.
    pub integration: Option<Gone>,
}

impl Keys {
    /// ζ of each part, 0 where absent.
    pub fn parts(&self, number: impl Fn(NonNegative) -> f64) -> Parts {
        let Self { normal_force, tangential_force, normal_torque, tangential_torque, .. } = *self;
        PartKeys { normal_force, tangential_force, normal_torque, tangential_torque }.parts(number)
    }
}

impl From<PartKeys<NonNegative>> for Keys {
    fn from(ratios: PartKeys<NonNegative>) -> Self {
        let PartKeys { normal_force, tangential_force, normal_torque, tangential_torque } = ratios;
        Self { normal_force, tangential_force, normal_torque, tangential_torque, integration: None }
    }
}

/// A dashpot beside the spring of each part, set by the share of critical damping.
///
/// ```text
/// X_damping = −2 ζ √(K M) v
/// K: k_n A, k_t A, k_t J, k_n I
/// 1/M: 1/m_i + 1/m_j;  the same + l_i²/I_i + l_j²/I_j;  1/I_i + 1/I_j;  1/I_i + 1/I_j
/// ```
///
/// | symbol   | meaning                          | unit   | comes from        |
/// |----------|----------------------------------|--------|-------------------|
/// | K        | stiffness of the part            | N/m, N m | the law         |
/// | M        | effective mass or inertia        | kg, kg m² | both bodies    |
/// | l        | torque arm                       | m      | the pair          |
/// | ζ        | damping ratio of each part       | 1      | `damping.viscous` |
/// | v        | v_n, v_s, w_n, w_t               | m/s, rad/s | the motion    |
///
/// ζ is the damping ratio of the pair alone in each of its motions, at small amplitude. The bond rests under any
/// load, and nothing depends on the axes of the scene. Between two bodies without motion of their own there
/// is not a damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viscous {
    /// ζ of each part.
    pub ratios: Parts,
}

impl Model for Viscous {
    type Keys = Keys;
    type Form = Self;
    const IS_DASHPOTS: bool = true;

    fn of(keys: &Self::Keys) -> Self {
        Self { ratios: keys.parts(NonNegative::get) }
    }
}

/// 2 ζ √(K M), from 1/M. A part without damping takes neither root nor division.
#[inline(always)]
fn dashpot<N: Number>(ratio: f64, stiffness: N, inverse_mass: N) -> N {
    if ratio == 0.0 {
        return N::zero();
    }
    let moves = inverse_mass.greater(N::zero());
    let square = stiffness / N::select(moves, inverse_mass, N::splat(1.0));
    N::select(moves, square, N::zero()).sqrt() * N::splat(2.0 * ratio)
}

/// 1/m_i, 1/m_j, 1/I_i, 1/I_j of a pair.
#[inline(always)]
fn lightness<N: Number>(pair: &Pair<N>) -> [N; 4] {
    let one = N::splat(1.0);
    [one / pair.mass_i, one / pair.mass_j, one / pair.inertia_i, one / pair.inertia_j]
}

/// 1/M of the parts of a bond between two bodies, from 1/m and 1/I of both and the arms of both.
#[inline(always)]
fn inverse_masses<N: Number>([along_i, along_j, about_i, about_j]: [N; 4], [arm_i, arm_j]: [N; 2]) -> Parts<N> {
    let along = along_i + along_j;
    let across = along + (arm_i * arm_i) * about_i + (arm_j * arm_j) * about_j;
    let turning = about_i + about_j;
    [along, across, turning, turning]
}

/// Arms of both bodies of a bond of this length \[m\].
#[inline(always)]
fn arms<N: Number>(pair: &Pair<N>, distance: N) -> [N; 2] {
    [distance * pair.share_i, distance * pair.share_j]
}

impl Damping for Viscous {
    const NEEDS_MASSES: bool = true;

    #[inline(always)]
    fn damp<N: Number>(
        &self,
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        elastic: &Elastic<N>,
    ) -> Damped<N> {
        let section = &motion.section;
        let [along, across, turning, _] = inverse_masses(lightness(pair), arms(pair, motion.distance));
        let [normal, shear, torsion, bending] = self.ratios;
        let axial = law.normal_stiffness(elastic.compression) * section.area;
        Damped {
            normal: motion.axis * -(motion.normal_velocity * dashpot(normal, axial, along)),
            shear: motion.slip * -dashpot(shear, law.elastic.shear * section.area, across),
            torsion: motion.axis
                * -(motion.twist_rate * dashpot(torsion, law.elastic.torsion * section.polar, turning)),
            bending: motion.bending_rate * -dashpot(bending, law.elastic.bending * section.axial, turning),
        }
    }

    fn linear(&self, pair: &Pair, stiffness: Parts) -> [Parts; 2] {
        let inverse_masses = inverse_masses(lightness(pair), arms(pair, pair.connection.length()));
        let dashpots = std::array::from_fn(|part| dashpot(self.ratios[part], stiffness[part], inverse_masses[part]));
        [stiffness, dashpots]
    }
}
