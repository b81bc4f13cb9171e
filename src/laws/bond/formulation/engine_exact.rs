//! LIGGGHTS-INL's bond, its errors included.

use super::{Formulation, FormulationNeeds, TakeFormulation, relaxation_loss};
use crate::base::number::{Number, Vector};
use crate::laws::bond::{Coefficients, Elastic, Intermediate, Motion, Pair, Rates, Rows};

/// The bond of the engine, for comparison and for scenes that must repeat its numbers.
///
/// ```text
/// N   = k_n A (d0 − r) e                          where |d0 − r| > 1e-15 m
/// F_t ← (F_t − (F_t·e) e)(1 − q₂) − k_t A v_s Δt
/// T_n ← (T_n·e) e (1 − q₃) − k_t J w_n Δt
/// T_t ← (T_t·h) h (1 − q₄) − k_n I w_t Δt,  h = w_t/|w_t|   only where w_t ≠ 0; where w_t = 0 no bending torque acts
/// d0  ← d0 + (r − d0) q₁                          after N
/// force on i: N + F_t;   torque on i: l_i F_t × e + T_n + T_t;   on j: l_j F_t × e − T_n − T_t
/// ```
///
/// | symbol      | meaning                                   | unit   | comes from   |
/// |-------------|-------------------------------------------|--------|--------------|
/// | d0, r       | distance at creation, now                 | m      | state, pair  |
/// | e           | axis of this step, from j to i            | 1      | the motion   |
/// | v_s, w_n, w_t | rates of half a step earlier            | m/s, rad/s | the motion |
/// | l           | shares of r by radius                     | m      | the pair     |
/// | q           | min(Δt/τ, 1) of each part                 | 1      | `relaxation` |
///
/// It fails in three ways (`docs/bonds.md`). Stored vectors are projected, not turned: shear shrinks by exp(−2π²/n) in a
/// turn of n steps and does not follow a turn about the axis. The bending torque is thrown away as its axis turns, and all
/// of it while the bond rests. At a wall the spin counts with half the arm in v_s.
///
/// Source: LIGGGHTS-INL 4.0.0, manual page "gran cohesion bond", and its behaviour when run.
#[derive(Clone, Copy, Debug)]
pub struct EngineExact;

/// Goes to the type: it always relaxes, if only by 0, and needs rates.
pub(super) fn visit<V: TakeFormulation>(_asked: FormulationNeeds, visitor: V) -> V::Output {
    visitor.take::<EngineExact>()
}

/// Energy F²/(2 K) of a spring; 0 where there is none.
#[inline(always)]
fn spring_energy<N: Number>(square: N, stiffness: N) -> N {
    // Without stiffness the force is 0, and 0 over the smallest divisor is 0.
    N::splat(0.5) * square / stiffness.max(N::splat(f64::MIN_POSITIVE))
}

/// The bending torque to store and the one that acts: without relative spin across the axis none does.
#[inline(always)]
fn bend<N: Number>(stored: Vector<N>, rate: Vector<N>, left: N, stiffness: N, step: N) -> BendingIncrement<N> {
    let one = N::splat(1.0);
    let square = rate.dot(rate);
    let moving = N::both(square.greater(N::zero()), step.greater(N::zero()));
    let along = rate * (one / N::select(moving, square, one).sqrt());
    let projected = along * stored.dot(along);
    let before = spring_energy(projected.dot(projected), stiffness);
    let advanced = projected * left - rate * (stiffness * step);
    let kept = Vector::select(moving, advanced, stored);
    BendingIncrement {
        kept,
        acting: Vector::select(moving, kept, Vector::zero()),
        before: N::select(moving, before, N::zero()),
    }
}

/// Bending in one step.
struct BendingIncrement<N: Number> {
    /// What is stored \[N m\].
    kept: Vector<N>,
    /// What acts \[N m\].
    acting: Vector<N>,
    /// Elastic energy before relaxation \[J\].
    before: N,
}

impl Formulation for EngineExact {
    const ROWS: usize = 3;
    const REMEMBERED: &'static str = "shear force x y z, free length; torsion x y z; bending torque x y z";
    const FIXED_ROWS: usize = 0;
    const NEEDS_ORIENTATIONS: bool = false;
    const RELAXES: bool = true;
    const RATES: Rates = Rates::AtEnd;

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
        let [[fx, fy, fz, reference], [nx, ny, nz, _], [tx, ty, tz, _]] = *rows;
        let compression = reference - motion.distance;
        let axial = law.normal_stiffness(compression) * section.area;
        let normal = axial * compression;

        let left = law.left();

        let stored = Vector::new(fx, fy, fz);
        let shear = stored - axis * stored.dot(axis);
        let shear_stiffness = law.elastic.shear * section.area;
        let shear_before = spring_energy(shear.dot(shear), shear_stiffness);
        let shear = shear * left[1] - motion.slip * (shear_stiffness * law.step);

        let torsion = Vector::new(nx, ny, nz).dot(axis);
        let twist_stiffness = law.elastic.torsion * section.polar;
        let torsion_before = spring_energy(torsion * torsion, twist_stiffness);
        let torsion = torsion * left[2] - motion.twist_rate * (twist_stiffness * law.step);

        let bending_stiffness = law.elastic.bending * section.axial;
        let bent = bend(Vector::new(tx, ty, tz), motion.bending_rate, left[3], bending_stiffness, law.step);
        let (bending, acting) = (bent.kept, bent.acting);

        let shifted = reference + (motion.distance - reference) * law.relaxed[0];
        let axial_before = N::splat(0.5) * normal * compression;
        let energy = axial_before * left[0] * left[0]
            + spring_energy(shear.dot(shear), shear_stiffness)
            + spring_energy(torsion * torsion, twist_stiffness)
            + spring_energy(bending.dot(bending), bending_stiffness);
        let relaxed = relaxation_loss(left, [axial_before, shear_before, torsion_before, bent.before]);

        let twist = axis * torsion;
        let couple = shear.cross(axis) * motion.distance;
        Elastic {
            compression,
            normal,
            shear,
            torsion,
            bending,
            force: axis * normal + shear,
            torque_i: couple * pair.share_i + twist + acting,
            torque_j: couple * pair.share_j - twist - acting,
            energy,
            relaxed,
            overbent: N::zero().greater(N::zero()),
            rows: [
                [shear.x, shear.y, shear.z, shifted],
                [twist.x, twist.y, twist.z, N::zero()],
                [bending.x, bending.y, bending.z, N::zero()],
            ],
        }
    }
}
