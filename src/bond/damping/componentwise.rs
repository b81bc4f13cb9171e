//! The engine's damping, axis by axis of the scene.

use super::Lost;
use crate::bond::{Coefficients, Damping, Elastic, Motion, Pair};
use crate::number::{Number, Vector};

/// Smallest divisor of a rate: with it alone the ratio is the sign, and 0 where nothing moves.
const LEAST_RATE: f64 = 1e-300;

/// Each component in the scene's axes is opposed to its rate by a share of its own magnitude.
///
/// ```text
/// X_k damping = −α |X_k| clip(v_k/v_min, −1, 1)              k = x, y, z
/// v_min = max(threshold · R_min/Δt, 0.01 X_k Δt) for the two forces with `smooth`, else → 0 (the sign of v_k)
/// ```
///
/// As LIGGGHTS-INL does (`dampingBond`, `dampingBondSmooth`): the result depends on the axes of the scene, the
/// normal force leaves the axis of the bond, a loaded bond never quite rests and the smooth variant falls
/// back to the sign above a step that shrinks with the load. The signed second entry of v_min is the engine's, dimension and all.
#[derive(Clone, Copy, Debug)]
pub struct Componentwise;

/// −α |X| clip(v/v_min, −1, 1) of one component.
#[inline(always)]
fn component<N: Number>(share: N, part: N, rate: N, least: N) -> N {
    let one = N::splat(1.0);
    -(share * part.abs() * (rate / least).min(one).max(-one))
}

/// Of a force: v_min from radius and force.
#[inline(always)]
fn force<N: Number>(law: &Coefficients<N>, share: N, part: Vector<N>, rate: Vector<N>, least: N) -> Vector<N> {
    let slope = law.threshold_by_force;
    Vector::new(
        component(share, part.x, rate.x, least.max(part.x * slope)),
        component(share, part.y, rate.y, least.max(part.y * slope)),
        component(share, part.z, rate.z, least.max(part.z * slope)),
    )
}

/// Of a torque: the sign of the rate.
#[inline(always)]
fn torque<N: Number>(share: N, part: Vector<N>, rate: Vector<N>) -> Vector<N> {
    let least = N::splat(LEAST_RATE);
    Vector::new(
        component(share, part.x, rate.x, least),
        component(share, part.y, rate.y, least),
        component(share, part.z, rate.z, least),
    )
}

impl Damping for Componentwise {
    const ACTIVE: bool = true;
    const NEEDS_MASSES: bool = false;

    #[inline(always)]
    fn damp<N: Number>(law: &Coefficients<N>, pair: &Pair<N>, motion: &Motion<N>, elastic: &Elastic<N>) -> Lost<N> {
        let least = (law.threshold * pair.least_radius).max(N::splat(LEAST_RATE));
        let [normal, shear, torsion, bending] = law.damping;
        let axis = motion.axis;
        Lost {
            normal: force(law, normal, axis * elastic.normal, axis * motion.normal_velocity, least),
            shear: force(law, shear, elastic.shear, motion.slip, least),
            torsion: torque(torsion, axis * elastic.torsion, axis * motion.twist_rate),
            bending: torque(bending, elastic.bending, motion.bending_rate),
        }
    }
}
