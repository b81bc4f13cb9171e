//! Force and moments as the gradient of one stored energy of positions and attitudes.

use super::angle::{arctangent_ratio, arctangent_series, continued, is_flat, tangent_ratio, twice_angle};
use super::engine_exact::relaxation_loss;
use super::{Coefficients, Elastic, Formulation, Motion, Pair, Quaternion, Rows};
use crate::number::{Number, Vector};

/// A bond with one stored energy, exact for rotations of any size.
///
/// ```text
/// U = ½ k_n A (d0 − r)² + ½ k_t A L² |γ|² + ½ k_t J ψ² + ½ k_n I |κ|²
/// γ = s_i φ_i + s_j φ_j        κ = φ_i − φ_j        ψ = Ψ − Ψ0
/// F_i = −∂U/∂x_i,   T_i = −∂U/∂θ_i,   T_j = −∂U/∂θ_j
/// ```
///
/// | symbol   | meaning                                                                  | unit | comes from   |
/// |----------|--------------------------------------------------------------------------|------|--------------|
/// | a_i, a_j | the axis at creation, carried by body i, by body j                       | 1    | state, attitudes |
/// | φ        | rotation vector of the shortest turn from a to e; across e               | rad  | a, e         |
/// | s        | R/(R_i + R_j): share of the arm                                          | 1    | the pair     |
/// | γ        | mean turn of the axis against the bodies: shear is L γ                   | rad  | φ            |
/// | κ        | bending                                                                  | rad  | φ            |
/// | Ψ        | turn of j against i about e once both are brought to e by their shortest turns, followed over any number of turns | rad | attitudes |
/// | L        | distance at creation                                                     | m    | state        |
/// | d0, Ψ0   | length and twist without force (relaxation shifts them, and the a)       | m, rad | state      |
///
/// φ_i, φ_j, ψ and r are six coordinates of the relative placement of two bodies, so U is a function of that
/// placement alone: turning the pair as a whole changes nothing, closed loops do no work, momentum and angular
/// momentum are kept. Exchanging i and j changes the sign of e and of the a, hence no strain. To first order in
/// the strains force and moments are those of the document; in a plane motion γ and κ are exactly linear in the angles.
/// Against the rate form the shear differs in the second order of the strains (arm L, not the present r).
///
/// With m = a × e/(1 + a·e) = tan(|φ|/2) φ/|φ|, φ = 2 arctan(|m|) m/|m|, and the variations
/// δm = [δa × e + a × δe − m (δa·e + a·δe)]/(1 + a·e), δΨ = (a_j + e)·δθ_j/(1 + a_j·e) − (a_i + e)·δθ_i/(1 + a_i·e) + (m_i − m_j)·δe.
/// The angle functions are polynomials that are right to rounding (`angle.rs`).
///
/// Holds while each body is turned by less than π against the axis and |κ| < π; beyond, `overbent`.
///
/// Source: own derivation; the decomposition follows the idea of Y. Wang, *Acta Geotech.* 4 (2009) 117–127, made
/// symmetric in the two bodies.
#[derive(Clone, Copy, Debug)]
pub struct FiniteRotation<const RELAXING: bool>;

/// Largest square of tan(|φ|/2) that is followed: |φ| up to π − 2e-4.
const STEEPEST: f64 = 1e8;

/// One body's end of the bond.
#[derive(Clone, Copy)]
struct End<N: Number> {
    /// a: the axis at creation, carried by the body.
    carried: Vector<N>,
    /// 1/(1 + a·e).
    share: N,
    /// m = tan(|φ|/2) φ/|φ|.
    tangent: Vector<N>,
    /// |m|².
    square: N,
    /// arctan(|m|)/|m|.
    ratio: N,
    /// (arctan(|m|)/|m| − 1)/|m|².
    slope: N,
}

impl<N: Number> End<N> {
    /// Of the body that carries this axis, whose product a·d and M = a × d are given, and 1/(r + a·d) for this distance.
    #[inline(always)]
    fn of(carried: Vector<N>, along: N, across: Vector<N>, distance: N, per_sum: N) -> Self {
        // |m|² = (1 − a·e)/(1 + a·e): what it loses to cancellation is lost beside 1.
        let square = (distance - along) * per_sum;
        let [ratio, slope] = arctangent_series(square);
        Self { carried, share: distance * per_sum, tangent: across * per_sum, square, ratio, slope }
    }

    /// φ: rotation vector from the carried axis to the bond's \[rad\].
    #[inline(always)]
    fn rotation(&self) -> Vector<N> {
        self.tangent * (N::splat(2.0) * self.ratio)
    }

    /// Torque on the body from ∂U/∂φ and from the torsion, with which a turn about the axis is resisted \[N m\].
    ///
    /// The part of the gradient g along φ passes as it is, that across φ times |φ|/tan|φ| = f (1 − m²), f = arctan|m|/|m|;
    /// along the axis comes −φ·(a × g)/|φ| and what else it takes that the torque is one of the energy.
    #[inline(always)]
    fn torque(&self, gradient: Vector<N>, torsion: N, axis: Vector<N>) -> Vector<N> {
        let one = N::splat(1.0);
        let rest = one - self.square;
        let along = gradient.dot(self.tangent) * (one - self.slope * rest);
        let twisting = torsion * self.share;
        let about = N::splat(2.0) * self.ratio * self.share * self.carried.dot(gradient);
        gradient * (self.ratio * rest) + self.tangent * along + self.carried * twisting + axis * (twisting - about)
    }

    /// The carried axis for which φ is this \[rad\]; also its m.
    #[inline(always)]
    fn at(rotation: Vector<N>, axis: Vector<N>) -> (Vector<N>, Vector<N>) {
        let one = N::splat(1.0);
        let half = rotation * N::splat(0.5);
        let angle_square = half.dot(half);
        let first = tangent_ratio(angle_square);
        // One step of Newton's method takes away what the fraction is off for large angles.
        let square = angle_square * first * first;
        let reached = arctangent_ratio(square) * first;
        let tangent = half * (first + (one - reached) * (one + square));
        let square = tangent.dot(tangent);
        let carried = (axis * (one - square) + axis.cross(tangent) * N::splat(2.0)) * (one / (one + square));
        (carried, tangent)
    }
}

impl<const RELAXING: bool> Formulation for FiniteRotation<RELAXING> {
    const ROWS: usize = 3;
    const FIXED_ROWS: usize = if RELAXING { 0 } else { 2 };
    const NEEDS_ATTITUDES: bool = true;
    const RELAXES: bool = RELAXING;

    /// The reference is that of the beginning of the time step, but for the distance: the step's shear, twist and
    /// bending count, as in the other formulations.
    #[inline(always)]
    fn create<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N> {
        let before = pair.connection - pair.velocity * law.step;
        let axis = before * (N::splat(1.0) / before.length());
        let attitude_i = pair.attitude_i.turned(pair.spin_i, -law.step);
        let attitude_j = pair.attitude_j.turned(pair.spin_j, -law.step);
        let length = pair.connection.length();
        let own = attitude_i.conjugate().turn(axis);
        let other = (attitude_j.conjugate() * attitude_i).normalised();
        [[own.x, own.y, own.z, length], other.to_row(), [N::zero(), N::zero(), length, N::zero()]]
    }

    #[inline(always)]
    fn respond<N: Number>(law: &Coefficients<N>, pair: &Pair<N>, motion: &Motion<N>, rows: &Rows<N>) -> Elastic<N> {
        let (half, one) = (N::splat(0.5), N::splat(1.0));
        let (axis, section) = (motion.axis, &motion.section);
        let [[ox, oy, oz, reference], other, [last_twist, free_twist, length, spare]] = *rows;

        let own = Vector::new(ox, oy, oz);
        let frame_j = pair.attitude_j * Quaternion::from_row(other);
        let (connection, distance) = (pair.connection, motion.distance);
        let [carried_i, carried_j] = [pair.attitude_i.turn(own), frame_j.turn(own)];
        let [along_i, along_j] = [carried_i.dot(connection), carried_j.dot(connection)];
        let [sum_i, sum_j] = [distance + along_i, distance + along_j];
        let [across_i, across_j] = [carried_i.cross(connection), carried_j.cross(connection)];

        // The turn that remains between the bodies once each is brought to e: (1, m_j) p (1, −m_i). It is about e; here
        // its scalar part and that along e, both times the sums. With m = M/sum: e·(M × v) = …, so that no product of
        // three vectors is left.
        let relative = frame_j * pair.attitude_i.conjugate();
        let vector = relative.vector * sum_j + across_j * relative.scalar + across_j.cross(relative.vector);
        let scalar = relative.scalar * sum_j - across_j.dot(relative.vector);
        let along = scalar * sum_i + vector.dot(across_i);
        let across = connection.dot(vector) + distance * carried_i.dot(vector);

        // One division for all three: 1/sum_i, 1/sum_j and, where the twist is small, the tangent of half of it.
        let flat = is_flat(along, across);
        let divisor = N::select(flat, along, one);
        let shared = one / (sum_i * sum_j * divisor);
        let per_sums = divisor * shared;
        let i = End::of(carried_i, along_i, across_i, distance, sum_j * per_sums);
        let j = End::of(carried_j, along_j, across_j, distance, sum_i * per_sums);
        let tangent = across * (sum_i * sum_j * shared);
        let whole_twist = continued(twice_angle(along, across, flat, tangent), last_twist);
        let twisted = whole_twist - free_twist;
        let (rotation_i, rotation_j) = (i.rotation(), j.rotation());
        let sheared = rotation_i * pair.share_i + rotation_j * pair.share_j;
        let bent = rotation_i - rotation_j;

        let compression = reference - motion.distance;
        let normal = law.normal_stiffness(compression) * section.area * compression;
        let shear_stiffness = law.shear * section.area * length * length;
        let bending_stiffness = law.bending * section.axial;
        let torsion = law.torsion * section.polar * twisted;
        let bending = bent * bending_stiffness;
        let shearing = sheared * shear_stiffness;

        let torque_i = i.torque(shearing * pair.share_i + bending, torsion, axis);
        let torque_j = j.torque(shearing * pair.share_j - bending, -torsion, axis);
        // U does not change when the pair is turned as a whole: d × F + T_i + T_j = 0.
        let force = axis * normal + axis.cross(torque_i + torque_j) * motion.per_distance;

        let left = law.left();
        let parts = [
            half * normal * compression,
            half * shearing.dot(sheared),
            half * torsion * twisted,
            half * bending.dot(bent),
        ];
        let mut energy = N::zero();
        for part in 0..4 {
            energy = energy + parts[part] * left[part] * left[part];
        }
        let mut state = [rows[0], rows[1], [whole_twist, free_twist, length, spare]];
        if RELAXING {
            let sheared = sheared * left[1];
            let bent = bent * left[3];
            let (carried_i, tangent_i) = End::at(sheared + bent * pair.share_j, axis);
            let (_, tangent_j) = End::at(sheared - bent * pair.share_i, axis);
            let own = pair.attitude_i.conjugate().turn(carried_i);
            let about = Quaternion { scalar: along, vector: axis * across };
            let frame = Quaternion { scalar: one, vector: -tangent_j } * about;
            let relative = frame * Quaternion { scalar: one, vector: tangent_i };
            let other = (pair.attitude_j.conjugate() * relative * pair.attitude_i).normalised();
            let shifted = reference + (motion.distance - reference) * law.relaxed[0];
            state = [
                [own.x, own.y, own.z, shifted],
                other.to_row(),
                [whole_twist, free_twist + twisted * law.relaxed[2], length, spare],
            ];
        }

        let half_turn = N::splat(std::f64::consts::PI);
        let shallow = N::both(
            N::splat(STEEPEST).greater(i.square.max(j.square)),
            (half_turn * half_turn).greater(bent.dot(bent)),
        );
        // Who goes past π within one step, too fast to be met near it, leaves the twist a whole turn off.
        let shallow = N::both(shallow, half_turn.greater((whole_twist - last_twist).abs()));
        let overbent = N::select(shallow, N::zero(), one).greater(N::zero());
        Elastic {
            compression,
            normal,
            shear: axis.cross(sheared) * (law.shear * section.area * length),
            torsion,
            bending,
            force,
            torque_i,
            torque_j,
            energy,
            relaxed: if RELAXING { relaxation_loss(left, parts) } else { N::zero() },
            overbent,
            rows: state,
        }
    }
}
