//! The document's rate equations, with stored vectors that turn with the bond.

use super::angle::tangent_fraction;
use super::engine_exact::relaxation_loss;
use super::{Coefficients, Elastic, Formulation, Motion, Pair, Rows};
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
pub struct Incremental;

/// What turns stored vectors over one time step.
#[derive(Clone, Copy)]
struct Turn<N: Number> {
    /// Axis of the last step plus that of mid-step, over 1 + their cosine.
    first: Vector<N>,
    /// Axis of mid-step.
    middle: Vector<N>,
    /// Axis of mid-step plus that of this step, over 1 + their cosine.
    second: Vector<N>,
    /// Axis of this step.
    axis: Vector<N>,
    /// Cosine of half of the spin's turn about the axis.
    cosine: N,
    /// Sine of it.
    sine: N,
}

impl<N: Number> Turn<N> {
    /// Between the axes of the last step and of this one. Divisions are shared, as they are dear.
    #[inline(always)]
    fn of(law: &Coefficients<N>, pair: &Pair<N>, axis: Vector<N>) -> Self {
        let one = N::splat(1.0);
        let last = pair.connection - pair.velocity * law.step;
        let middle = pair.connection - pair.velocity * (law.step * N::splat(0.5));
        let (last_length, middle_length) = (last.length(), middle.length());
        let shared = one / (last_length * middle_length);
        let last = last * (middle_length * shared);
        let middle = middle * (last_length * shared);
        // A quarter of the spins' sum times Δt is half of the mean spin's turn; its half tangent takes half of that.
        let quarter = (pair.spin_i + pair.spin_j).dot(middle) * (law.step * N::splat(0.125));
        let [above, below] = tangent_fraction(quarter * quarter);
        let above = quarter * above;
        let (above_square, below_square) = (above * above, below * below);
        let [inwards, onwards, whole] = [one + last.dot(middle), one + middle.dot(axis), below_square + above_square];
        let shared = one / (inwards * onwards * whole);
        let share = inwards * onwards * shared;
        Self {
            first: (last + middle) * (onwards * whole * shared),
            middle,
            second: (middle + axis) * (inwards * whole * shared),
            axis,
            cosine: (below_square - above_square) * share,
            sine: N::splat(2.0) * above * below * share,
        }
    }

    /// About the axis of mid-step, by half of the spin.
    #[inline(always)]
    fn about(&self, vector: Vector<N>) -> Vector<N> {
        vector * self.cosine + self.middle.cross(vector) * self.sine
    }

    /// R₁: of a vector across the axis of the last step.
    #[inline(always)]
    fn inwards(&self, vector: Vector<N>) -> Vector<N> {
        self.about(vector - self.first * vector.dot(self.middle))
    }

    /// R₂: of a vector across the axis of mid-step. What rounding leaves along the axis is taken away.
    #[inline(always)]
    fn onwards(&self, vector: Vector<N>) -> Vector<N> {
        let about = self.about(vector);
        let turned = about - self.second * about.dot(self.axis);
        turned - self.axis * turned.dot(self.axis)
    }
}

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

impl Formulation for Incremental {
    const ROWS: usize = 2;
    const FIXED_ROWS: usize = 0;
    const NEEDS_ATTITUDES: bool = false;

    #[inline(always)]
    fn create<N: Number>(_law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N> {
        let mut rows = [[N::zero(); 4]; 3];
        rows[0][3] = pair.connection.length();
        rows
    }

    #[inline(always)]
    fn respond<N: Number>(law: &Coefficients<N>, pair: &Pair<N>, motion: &Motion<N>, rows: &Rows<N>) -> Elastic<N> {
        let half = N::splat(0.5);
        let (axis, section) = (motion.axis, &motion.section);
        let [[fx, fy, fz, reference], [tx, ty, tz, torsion], _] = *rows;
        let left = law.left();
        let turn = Turn::of(law, pair, axis);

        let compression = reference - motion.distance;
        let normal = law.normal_stiffness(compression) * section.area * compression;
        let axial_before = half * normal * compression;

        let connection = pair.connection - pair.velocity * (law.step * half);
        let turning = pair.spin_i * pair.share_i + pair.spin_j * pair.share_j;
        let across = pair.velocity - turn.middle * pair.velocity.dot(turn.middle);
        let slip = across + connection.cross(turning);
        let relative_spin = pair.spin_i - pair.spin_j;
        let twist_rate = relative_spin.dot(turn.middle);
        let bending_rate = relative_spin - turn.middle * twist_rate;

        let shear = Vector::new(fx, fy, fz);
        let shear_stiffness = law.shear * section.area;
        let shear_before = shear.dot(shear);
        let grown = turn.inwards(shear) * left[1] - slip * (shear_stiffness * law.step);
        let shear = turn.onwards(grown);

        let twist_stiffness = law.torsion * section.polar;
        let torsion_before = torsion * torsion;
        let torsion = torsion * left[2] - twist_rate * (twist_stiffness * law.step);

        let bending = Vector::new(tx, ty, tz);
        let bending_stiffness = law.bending * section.axial;
        let bending_before = bending.dot(bending);
        let grown = turn.inwards(bending) * left[3] - bending_rate * (bending_stiffness * law.step);
        let bending = turn.onwards(grown);

        let shifted = reference + (motion.distance - reference) * law.relaxed[0];
        let [per_shear, per_twist, per_bending] = halves(shear_stiffness, twist_stiffness, bending_stiffness);
        let energy = axial_before * left[0] * left[0]
            + shear.dot(shear) * per_shear
            + torsion * torsion * per_twist
            + bending.dot(bending) * per_bending;
        let before = [axial_before, shear_before * per_shear, torsion_before * per_twist, bending_before * per_bending];
        let couple = shear.cross(axis) * motion.distance;
        let moment = axis * torsion + bending;
        Elastic {
            compression,
            normal,
            shear,
            torsion,
            bending,
            force: axis * normal + shear,
            torque_i: couple * pair.share_i + moment,
            torque_j: couple * pair.share_j - moment,
            energy,
            relaxed: relaxation_loss(left, before),
            overbent: N::zero().greater(N::zero()),
            rows: [[shear.x, shear.y, shear.z, shifted], [bending.x, bending.y, bending.z, torsion], rows[2]],
        }
    }
}
