//! The document's rate equations, with stored vectors that turn with the bond.

use super::engine_exact::relaxation_loss;
use super::{Coefficients, Elastic, Formulation, Halfway, Motion, Pair, Rows};
use crate::number::{Number, Vector};

/// Shear force, torsion and bending torque grow by increments and turn with the bond.
///
/// ```text
/// N   = k_n A (d0 − r) e
/// F_t ← R₂ [R₁ F_t (1 − q₂) − k_t A v_s Δt]
/// T_n ← T_n (1 − q₃) − k_t J w_n Δt                 (a number: it turns with e by itself)
/// T_t ← R₂ [R₁ T_t (1 − q₄) − k_n I w_t Δt]
/// d0  ← d0 + (r − d0) q₁                            after N
/// force on i: N + F_t;   torque on i: l_i F_t × e + T_n + T_t;   on j: l_j F_t × e − T_n − T_t
/// ```
///
/// | symbol        | meaning                                                     | unit | comes from   |
/// |---------------|-------------------------------------------------------------|------|--------------|
/// | v_s, w_n, w_t | rates about the axis of mid-step, d − v Δt/2                | m/s, rad/s | the pair |
/// | R₁, R₂        | turn from the axis of the last step to that of mid-step, and on to the present one: each the shortest, then half of the mean spin about the axis | 1 | the pair |
/// | q             | min(Δt/τ, 1) of each part                                   | 1    | `relaxation` |
///
/// Velocities and positions are used at the same moment (mid-step), so the forces of a prescribed motion converge
/// with the square of the step, relaxation apart, which is the document's and of first order. The turns keep
/// lengths: a held load neither shrinks nor creeps. There is no stored energy whose gradient this is; a closed loop of
/// finite size leaves a small net force, as in every rate form.
///
/// Source: the document's equations (`docs/bonds.md`); D. O. Potyondy & P. A. Cundall, *Int. J. Rock Mech. Min. Sci.* 41
/// (2004) 1329–1364.
#[derive(Clone, Copy, Debug)]
pub struct Incremental<const RELAXING: bool>;

/// ½ over each stiffness, 0 where there is none: energies of springs by their forces. The three share a division.
#[inline(always)]
fn halves<N: Number>(shear: N, twist: N, bending: N) -> [N; 3] {
    let (zero, one) = (N::zero(), N::splat(1.0));
    let (bears_shear, bears_twist, bears_bending) = (shear.greater(zero), twist.greater(zero), bending.greater(zero));
    let shear = N::select(bears_shear, shear, one);
    let twist = N::select(bears_twist, twist, one);
    let bending = N::select(bears_bending, bending, one);
    let shared = N::splat(0.5) / (shear * twist * bending);
    [
        N::select(bears_shear, twist * bending * shared, zero),
        N::select(bears_twist, shear * bending * shared, zero),
        N::select(bears_bending, shear * twist * shared, zero),
    ]
}

impl<const RELAXING: bool> Formulation for Incremental<RELAXING> {
    const ROWS: usize = 2;
    const FIXED_ROWS: usize = 0;
    const NEEDS_ATTITUDES: bool = false;
    const RELAXES: bool = RELAXING;
    const NEEDS_RATES: bool = true;

    #[inline(always)]
    fn create<N: Number>(_law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N> {
        let mut rows = [[N::zero(); 4]; 3];
        rows[0][3] = pair.connection.length();
        rows
    }

    #[inline(always)]
    fn finish<N: Number>(
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        _halfway: &Halfway<N>,
        rows: &Rows<N>,
    ) -> Elastic<N> {
        let half = N::splat(0.5);
        let (axis, section) = (motion.axis, &motion.section);
        let [[fx, fy, fz, reference], [tx, ty, tz, torsion], _] = *rows;
        let left = law.left();

        let compression = reference - motion.distance;
        let normal = law.normal_stiffness(compression) * section.area * compression;
        let axial_before = half * normal * compression;

        let mut shear = Vector::new(fx, fy, fz);
        let shear_stiffness = law.shear * section.area;
        let shear_before = shear.dot(shear);
        let mut bending = Vector::new(tx, ty, tz);
        let bending_stiffness = law.bending * section.axial;
        let bending_before = bending.dot(bending);
        let mut torsion = torsion;
        let twist_stiffness = law.torsion * section.polar;
        let torsion_before = torsion * torsion;
        if RELAXING {
            shear = shear * left[1];
            torsion = torsion * left[2];
            bending = bending * left[3];
        }
        let turn = &motion.turn;
        let shear = turn.advance(shear, motion.slip * -(shear_stiffness * law.step), axis);
        let torsion = torsion - motion.twist_rate * (twist_stiffness * law.step);
        let bending = turn.advance(bending, motion.bending_rate * -(bending_stiffness * law.step), axis);

        let shifted = if RELAXING { reference + (motion.distance - reference) * law.relaxed[0] } else { reference };
        let [per_shear, per_twist, per_bending] = halves(shear_stiffness, twist_stiffness, bending_stiffness);
        let energy = axial_before * left[0] * left[0]
            + shear.dot(shear) * per_shear
            + torsion * torsion * per_twist
            + bending.dot(bending) * per_bending;
        let before = [axial_before, shear_before * per_shear, torsion_before * per_twist, bending_before * per_bending];
        let couple = shear.cross(pair.connection);
        let torque_i = couple * pair.share_i + axis * torsion + bending;
        Elastic {
            compression,
            normal,
            shear,
            torsion,
            bending,
            force: axis * normal + shear,
            torque_i,
            torque_j: couple - torque_i,
            energy,
            relaxed: if RELAXING { relaxation_loss(left, before) } else { N::zero() },
            overbent: N::zero().greater(N::zero()),
            rows: [[shear.x, shear.y, shear.z, shifted], [bending.x, bending.y, bending.z, torsion], rows[2]],
        }
    }
}
