//! The engine's damping, axis by axis of the scene.

use super::{Damped, Damping, Model, by_share};
use crate::base::number::{Number, Vector};
use crate::base::quantity::Fraction;
use crate::laws::bond::elasticity::Parts;
use crate::laws::bond::part_keys::PartKeys;
use crate::laws::bond::{Coefficients, Elastic, Motion, Pair};

/// Smallest divisor of a rate: with it alone the ratio is the sign, and 0 where nothing moves.
const LEAST_RATE: f64 = 1e-300;

/// Threshold of the engine's smooth damping over R_min/Δt.
const SMOOTH_THRESHOLD: f64 = 1e-5;

/// Threshold of the engine's smooth damping over force times Δt.
const SMOOTH_THRESHOLD_BY_FORCE: f64 = 0.01;

/// Each component in the scene's axes is opposed to its rate by a share of its own magnitude.
///
/// ```text
/// X_k damping = −α |X_k| clip(v_k/v_min, −1, 1)              k = x, y, z
/// v_min = max(threshold · R_min/Δt, 0.01 X_k Δt) for the two forces with `smooth`, else → 0 (the sign of v_k)
/// ```
///
/// | symbol | meaning                                       | unit       | comes from        |
/// |--------|-----------------------------------------------|------------|-------------------|
/// | X_k    | component of force or torque of each part     | N, N m     | the formulation   |
/// | v_k    | its rate                                      | m/s, rad/s | the motion        |
/// | α      | share of each part                            | 1          | `damping.sign`, `damping.smooth` |
/// | R_min  | smaller radius of the two bodies              | m          | the pair          |
///
/// The result depends on the axes of the scene, and the normal force leaves the axis of the bond. A loaded bond never quite
/// rests. `smooth` falls back to the sign above a step that shrinks with the load. The signed second entry of v_min is the
/// engine's, dimension and all.
///
/// Source: LIGGGHTS-INL, `dampingBond` (`sign`) and `dampingBondSmooth` (`smooth`).
#[derive(Clone, Copy, Debug)]
pub struct Componentwise {
    /// α of each part.
    pub shares: Parts,
    /// Speed below which the damping of the two forces grows linearly: this, over R_min and times the step.
    pub threshold: f64,
    /// The same from the force: this, times force \[N\] and step \[s\], as the engine has it.
    pub threshold_by_force: f64,
}

/// By the sign of the rate: `dampingBond`.
pub struct Sign;

impl Model for Sign {
    type Keys = PartKeys<Fraction>;
    type Form = Componentwise;
    const IS_THE_ENGINES: bool = true;

    fn of(keys: &Self::Keys) -> Componentwise {
        Componentwise { shares: keys.parts(Fraction::get), threshold: 0.0, threshold_by_force: 0.0 }
    }
}

/// With a linear slope around rest: `dampingBondSmooth`.
pub struct Smooth;

impl Model for Smooth {
    type Keys = PartKeys<Fraction>;
    type Form = Componentwise;
    const NEEDS_GIVEN_STEP: Option<&'static str> = Some("the threshold of smooth damping depends on the step");
    const IS_THE_ENGINES: bool = true;

    fn of(keys: &Self::Keys) -> Componentwise {
        Componentwise {
            shares: keys.parts(Fraction::get),
            threshold: SMOOTH_THRESHOLD,
            threshold_by_force: SMOOTH_THRESHOLD_BY_FORCE,
        }
    }
}

/// −α |X| clip(v/v_min, −1, 1) of one component.
#[inline(always)]
fn component<N: Number>(share: N, part: N, rate: N, least: N) -> N {
    let one = N::splat(1.0);
    -(share * part.abs() * (rate / least).min(one).max(-one))
}

/// Of a force: v_min from radius and force.
#[inline(always)]
fn force<N: Number>(slope: N, share: N, part: Vector<N>, rate: Vector<N>, least: N) -> Vector<N> {
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
    const NEEDS_MASSES: bool = false;

    #[inline(always)]
    fn damp<N: Number>(
        &self,
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        elastic: &Elastic<N>,
    ) -> Damped<N> {
        let threshold = N::splat(self.threshold);
        let per_step = N::select(threshold.greater(N::zero()), threshold / law.step, N::zero());
        let slope = N::splat(self.threshold_by_force) * law.step;
        let least = (per_step * pair.least_radius).max(N::splat(LEAST_RATE));
        let [normal, shear, torsion, bending] = self.shares.map(N::splat);
        let axis = motion.axis;
        Damped {
            normal: force(slope, normal, axis * elastic.normal, axis * motion.normal_velocity, least),
            shear: force(slope, shear, elastic.shear, motion.slip, least),
            torsion: torque(torsion, axis * elastic.torsion, axis * motion.twist_rate),
            bending: torque(bending, elastic.bending, motion.bending_rate),
        }
    }

    fn linear(&self, _: &Pair, stiffness: Parts) -> [Parts; 2] {
        by_share(&self.shares, stiffness)
    }
}
