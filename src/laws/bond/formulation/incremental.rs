//! The document's rate equations, with stored vectors that turn with the bond.

use super::{Formulation, FormulationNeeds, TakeFormulation, relaxation_loss};
use crate::base::number::{Number, Vector};
use crate::laws::bond::{Coefficients, Elastic, Intermediate, Motion, Pair, Rates, Rows};

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
/// Velocities and positions are used at the same moment, mid-step. The forces of a prescribed motion thus converge with the
/// square of the step. Relaxation is the document's and of first order. The turns keep lengths: a held load neither shrinks
/// nor creeps. There is no stored energy whose gradient this is; a closed loop of finite size leaves a small net force, as
/// in every rate form.
///
/// Source: the document's equations (`docs/bonds.md`); D. O. Potyondy & P. A. Cundall, *Int. J. Rock Mech. Min. Sci.* 41
/// (2004) 1329–1364.
#[derive(Clone, Copy, Debug)]
pub struct Incremental<const RELAXING: bool>;

/// Goes from what is asked to the type: it needs rates itself.
pub(super) fn visit<V: TakeFormulation>(asked: FormulationNeeds, visitor: V) -> V::Output {
    match asked.relaxation {
        false => visitor.take::<Incremental<false>>(),
        true => visitor.take::<Incremental<true>>(),
    }
}

/// ½ over each stiffness, 0 where there is none: energies of springs by their forces. The three share a division.
#[inline(always)]
fn halves<N: Number>([shear, twist, bending]: [N; 3]) -> [N; 3] {
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

/// What is stored of a bond and turns with it.
#[derive(Clone, Copy)]
struct Loads<N: Number> {
    /// Shear force \[N\].
    shear: Vector<N>,
    /// Torsion along the axis \[N m\].
    torsion: N,
    /// Bending torque \[N m\].
    bending: Vector<N>,
}

impl<N: Number> Loads<N> {
    /// As the rows have it.
    #[inline(always)]
    fn of(rows: &Rows<N>) -> Self {
        let [[fx, fy, fz, _], [tx, ty, tz, torsion], _] = *rows;
        Self { shear: Vector::new(fx, fy, fz), torsion, bending: Vector::new(tx, ty, tz) }
    }

    /// These shares of it.
    #[inline(always)]
    fn times(self, [shear, torsion, bending]: [N; 3]) -> Self {
        Self { shear: self.shear * shear, torsion: self.torsion * torsion, bending: self.bending * bending }
    }

    /// Turned with the bond, and the increments added that these stiffnesses times the step make of the rates.
    #[inline(always)]
    fn advanced(self, motion: &Motion<N>, [shear, torsion, bending]: [N; 3]) -> Self {
        let (turn, axis) = (&motion.turn, motion.axis);
        Self {
            shear: turn.advance(self.shear, motion.slip * -shear, axis),
            torsion: self.torsion - motion.twist_rate * torsion,
            bending: turn.advance(self.bending, motion.bending_rate * -bending, axis),
        }
    }

    /// Energies of springs, from ½ over their stiffnesses \[J\].
    #[inline(always)]
    fn energies(&self, [shear, torsion, bending]: [N; 3]) -> [N; 3] {
        [
            self.shear.dot(self.shear) * shear,
            self.torsion * self.torsion * torsion,
            self.bending.dot(self.bending) * bending,
        ]
    }
}

impl<const RELAXING: bool> Formulation for Incremental<RELAXING> {
    const ROWS: usize = 2;
    const REMEMBERED: &'static str = "shear force x y z, free length; bending torque x y z, torsion";
    const FIXED_ROWS: usize = 0;
    const NEEDS_ORIENTATIONS: bool = false;
    const RELAXES: bool = RELAXING;
    const RATES: Rates = Rates::Midway;

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
        _halfway: &Intermediate<N>,
        rows: &Rows<N>,
    ) -> Elastic<N> {
        let (axis, section) = (motion.axis, &motion.section);
        let reference = rows[0][3];
        let left = law.left();
        let compression = reference - motion.distance;
        let normal = law.normal_stiffness(compression) * section.area * compression;
        let axial_before = N::splat(0.5) * normal * compression;

        let stored = Loads::of(rows);
        let stiffness = [
            law.elastic.shear * section.area,
            law.elastic.torsion * section.polar,
            law.elastic.bending * section.axial,
        ];
        let kept = if RELAXING { stored.times([left[1], left[2], left[3]]) } else { stored };
        let loads = kept.advanced(motion, stiffness.map(|stiffness| stiffness * law.step));
        let Loads { shear, torsion, bending } = loads;

        let shifted = if RELAXING { reference + (motion.distance - reference) * law.relaxed[0] } else { reference };
        let halves = halves(stiffness);
        let [of_shear, of_torsion, of_bending] = loads.energies(halves);
        let energy = axial_before * left[0] * left[0] + of_shear + of_torsion + of_bending;
        let [shear_before, torsion_before, bending_before] = stored.energies(halves);
        let before = [axial_before, shear_before, torsion_before, bending_before];
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
