//! Force and moments as the gradient of one stored energy of positions and orientations.

use super::{Formulation, FormulationNeeds, TakeFormulation, relaxation_loss};
use crate::base::number::{Number, Vector};
use crate::laws::bond::angle::{arctangent_ratio, arctangent_series, continued, is_flat, tangent_ratio, twice_angle};
use crate::laws::bond::elasticity::Parts;
use crate::laws::bond::{Coefficients, Elastic, Intermediate, Motion, Pair, Quaternion, Rates, Rows};

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
/// | a_i, a_j | the axis at creation, carried by body i, by body j                       | 1    | state, orientations |
/// | φ        | rotation vector of the shortest turn from a to e; across e               | rad  | a, e         |
/// | s        | R/(R_i + R_j): share of the arm                                          | 1    | the pair     |
/// | γ        | mean turn of the axis against the bodies: shear is L γ                   | rad  | φ            |
/// | κ        | bending                                                                  | rad  | φ            |
/// | Ψ        | turn of j against i about e once both are brought to e by their shortest turns, followed over any number of turns | rad | orientations |
/// | L        | distance at creation                                                     | m    | state        |
/// | d0, Ψ0   | length and twist without force (relaxation shifts them, and the a)       | m, rad | state      |
///
/// φ_i, φ_j, ψ and r are six coordinates of the relative placement of two bodies, so U is a function of that placement
/// alone. Turning the pair as a whole changes nothing, and closed loops do no work. Momentum and angular momentum are kept.
/// Exchanging i and j changes the sign of e and of the a, hence no strain. To first order in the strains force and moments
/// are those of the document. In a plane motion γ and κ are exactly linear in the angles. Against the rate form the shear
/// differs in the second order of the strains (arm L, not the present r).
///
/// With m = a × e/(1 + a·e) = tan(|φ|/2) φ/|φ|, φ = 2 arctan(|m|) m/|m|, f = arctan(|m|)/|m|, g = ∂U/∂φ, the torque on a
/// body that follows from the variation of m and Ψ with its orientation is
/// f (1 − m²) g + [1 − f (1 − m²)] (m·g) m/m² − 2 f (a·g) e/(1 + a·e), and of the torsion M ± M (a + e)/(1 + a·e). The force
/// across the axis follows from both torques, as U does not change when the pair turns as a whole. It is e × (T_i + T_j)/r.
/// The angle functions are polynomials that are right to rounding (`angle.rs`).
///
/// Holds while each body is turned by less than π against the axis and |κ| < π; beyond, `overbent`.
///
/// Source: own derivation; the decomposition follows the idea of Y. Wang, *Acta Geotech.* 4 (2009) 117–127, made
/// symmetric in the two bodies.
#[derive(Clone, Copy, Debug)]
pub struct FiniteRotation<const RELAXING: bool, const RATES: bool = false>;

/// Goes from what is asked to the type: it needs no rates itself.
pub(super) fn visit<V: TakeFormulation>(asked: FormulationNeeds, visitor: V) -> V::Output {
    match (asked.relaxation, asked.rates) {
        (false, false) => visitor.take::<FiniteRotation<false, false>>(),
        (false, true) => visitor.take::<FiniteRotation<false, true>>(),
        (true, false) => visitor.take::<FiniteRotation<true, false>>(),
        (true, true) => visitor.take::<FiniteRotation<true, true>>(),
    }
}

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
        self.tangent * (self.ratio * N::splat(2.0))
    }

    /// Torque on the body from ∂U/∂φ and from the torsion, with which a turn about the axis is resisted \[N m\].
    ///
    /// The part of the gradient g along φ passes as it is, that across φ times |φ|/tan|φ| = f (1 − m²); what comes along the
    /// axis is −2 f (a·g)/(1 + a·e).
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

/// Both ends and the twist between them up to the division.
#[derive(Clone, Copy)]
struct Ends<N: Number> {
    /// a of both bodies.
    carried: [Vector<N>; 2],
    /// a × d of both \[m\].
    beside: [Vector<N>; 2],
    /// a·d of both \[m\].
    ahead: [N; 2],
    /// Cosine of half the twist, times a positive number.
    along: N,
    /// Sine of it, times the same.
    across: N,
    /// 1 over r + a·d of both bodies and, where the twist is small, over `along`.
    shared: N,
}

impl<N: Number> Ends<N> {
    /// Of a pair at this distance.
    #[inline(always)]
    fn of(pair: &Pair<N>, distance: N, rows: &Rows<N>) -> Self {
        let [[ox, oy, oz, _], other, _] = *rows;
        let own = Vector::new(ox, oy, oz);
        let connection = pair.connection;
        let frame_j = pair.orientation_j * Quaternion::from_row(other);
        let [carried_i, carried_j] = [pair.orientation_i.turn(own), frame_j.turn(own)];
        let [ahead_i, ahead_j] = [carried_i.dot(connection), carried_j.dot(connection)];
        let [sum_i, sum_j] = [distance + ahead_i, distance + ahead_j];
        let [beside_i, beside_j] = [carried_i.cross(connection), carried_j.cross(connection)];

        // The turn that remains between the bodies once each is brought to e: (1, m_j) p (1, −m_i), with m = a × d/(r + a·d).
        // It is about e; here its scalar part and that along e, both times the two sums. The latter is (w·(d + r a_i)) with
        // w, the vector part of (1, m_j) p times the sum of j, since e·(w × m_i) is a sum of products of two of d, a_i, w.
        let relative = frame_j * pair.orientation_i.conjugate();
        let vector = relative.vector * sum_j + beside_j * relative.scalar + beside_j.cross(relative.vector);
        let scalar = relative.scalar * sum_j - beside_j.dot(relative.vector);
        let along = scalar * sum_i + vector.dot(beside_i);
        let across = vector.dot(connection + carried_i * distance);
        let one = N::splat(1.0);
        let shared = one / (sum_i * sum_j * N::select(is_flat(along, across), along, one));
        Self {
            carried: [carried_i, carried_j],
            beside: [beside_i, beside_j],
            ahead: [ahead_i, ahead_j],
            along,
            across,
            shared,
        }
    }

    /// Both ends, and the tangent of half the twist where it is small.
    #[inline(always)]
    fn divided(&self, distance: N) -> ([End<N>; 2], N) {
        let [sum_i, sum_j] = [distance + self.ahead[0], distance + self.ahead[1]];
        let flat = is_flat(self.along, self.across);
        let per_sums = N::select(flat, self.along, N::splat(1.0)) * self.shared;
        let ([carried_i, carried_j], [ahead_i, ahead_j], [beside_i, beside_j]) =
            (self.carried, self.ahead, self.beside);
        let end_i = End::of(carried_i, ahead_i, beside_i, distance, sum_j * per_sums);
        let end_j = End::of(carried_j, ahead_j, beside_j, distance, sum_i * per_sums);
        ([end_i, end_j], self.across * (sum_i * sum_j * self.shared))
    }

    /// One number behind the other.
    #[inline(always)]
    fn to_numbers(self) -> Intermediate<N> {
        let ([a, b], [c, d], [e, f]) = (self.carried, self.beside, self.ahead);
        [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z, e, f, self.along, self.across, self.shared]
    }

    /// The inverse of `to_numbers`.
    #[inline(always)]
    fn from_numbers(numbers: &Intermediate<N>) -> Self {
        let vector = |first: usize| Vector::new(numbers[first], numbers[first + 1], numbers[first + 2]);
        Self {
            carried: [vector(0), vector(3)],
            beside: [vector(6), vector(9)],
            ahead: [numbers[12], numbers[13]],
            along: numbers[14],
            across: numbers[15],
            shared: numbers[16],
        }
    }
}

/// Strains of a bond.
struct Strains<N: Number> {
    /// Both ends.
    ends: [End<N>; 2],
    /// Ψ \[rad\].
    twist: N,
    /// ψ \[rad\].
    twisted: N,
    /// γ \[rad\].
    sheared: Vector<N>,
    /// κ \[rad\].
    bent: Vector<N>,
}

impl<N: Number> Strains<N> {
    /// Of a bond that is twisted by this without force, and was by that at the last step \[rad\].
    #[inline(always)]
    fn of(pair: &Pair<N>, motion: &Motion<N>, ends: &Ends<N>, [last_twist, free_twist]: [N; 2]) -> Self {
        let ([i, j], tangent) = ends.divided(motion.distance);
        let flat = is_flat(ends.along, ends.across);
        let twist = continued(twice_angle(ends.along, ends.across, flat, tangent), last_twist);
        let (rotation_i, rotation_j) = (i.rotation(), j.rotation());
        Self {
            ends: [i, j],
            twist,
            twisted: twist - free_twist,
            sheared: rotation_i * pair.share_i + rotation_j * pair.share_j,
            bent: rotation_i - rotation_j,
        }
    }

    /// Where it is bent further than can be followed. Who goes past π within one step, too fast to be met near it, leaves
    /// the twist a whole turn off.
    #[inline(always)]
    fn overbent(&self, last_twist: N) -> N::Mask {
        let half_turn = N::splat(std::f64::consts::PI);
        let [i, j] = &self.ends;
        let shallow = N::both(
            N::splat(STEEPEST).greater(i.square.abs().max(j.square.abs())),
            (half_turn * half_turn).greater(self.bent.dot(self.bent)),
        );
        let shallow = N::both(shallow, half_turn.greater((self.twist - last_twist).abs()));
        N::select(shallow, N::zero(), N::splat(1.0)).greater(N::zero())
    }
}

/// The state of a bond of which relaxation leaves these shares of the strains.
#[inline(always)]
fn relaxed<N: Number>(
    law: &Coefficients<N>,
    pair: &Pair<N>,
    motion: &Motion<N>,
    ends: &Ends<N>,
    strains: &Strains<N>,
    rows: &Rows<N>,
) -> Rows<N> {
    let (one, axis, left) = (N::splat(1.0), motion.axis, law.left());
    let [[_, _, _, reference], _, [_, free_twist, length, spare]] = *rows;
    let sheared = strains.sheared * left[1];
    let bent = strains.bent * left[3];
    let (carried_i, tangent_i) = End::at(sheared + bent * pair.share_j, axis);
    let (_, tangent_j) = End::at(sheared - bent * pair.share_i, axis);
    let own = pair.orientation_i.conjugate().turn(carried_i);
    let about = Quaternion { scalar: ends.along, vector: axis * ends.across };
    let frame = Quaternion { scalar: one, vector: -tangent_j } * about;
    let relative = frame * Quaternion { scalar: one, vector: tangent_i };
    let other = (pair.orientation_j.conjugate() * relative * pair.orientation_i).normalised();
    let shifted = reference + (motion.distance - reference) * law.relaxed[0];
    [
        [own.x, own.y, own.z, shifted],
        other.to_row(),
        [strains.twist, free_twist + strains.twisted * law.relaxed[2], length, spare],
    ]
}

/// The energy of which these shares of the forces are left, from that of the parts \[J\].
#[inline(always)]
fn energy_left<N: Number>(parts: Parts<N>, left: Parts<N>) -> N {
    let mut energy = N::zero();
    for part in 0..4 {
        energy = energy + parts[part] * left[part] * left[part];
    }
    energy
}

impl<const RELAXING: bool, const WITH_RATES: bool> Formulation for FiniteRotation<RELAXING, WITH_RATES> {
    const ROWS: usize = 3;
    const REMEMBERED: &'static str = "axis in the first body x y z, length at creation; second body in the first w x y z; twist, free twist, free length";
    const FIXED_ROWS: usize = if RELAXING { 0 } else { 2 };
    const NEEDS_ORIENTATIONS: bool = true;
    const RELAXES: bool = RELAXING;
    const RATES: Rates = if WITH_RATES { Rates::Midway } else { Rates::Unseen };

    /// The reference is that of the beginning of the time step, but for the distance: the step's shear, twist and
    /// bending count, as in the other formulations.
    #[inline(always)]
    fn create<N: Number>(law: &Coefficients<N>, pair: &Pair<N>) -> Rows<N> {
        let before = pair.connection - pair.velocity * law.step;
        let axis = before * (N::splat(1.0) / before.length());
        let orientation_i = pair.orientation_i.turned(pair.spin_i, -law.step);
        let orientation_j = pair.orientation_j.turned(pair.spin_j, -law.step);
        let length = pair.connection.length();
        let own = orientation_i.conjugate().turn(axis);
        let other = (orientation_j.conjugate() * orientation_i).normalised();
        [[own.x, own.y, own.z, length], other.to_row(), [N::zero(), N::zero(), length, N::zero()]]
    }

    const HALFWAY: usize = 17;

    #[inline(always)]
    fn halfway<N: Number>(pair: &Pair<N>, distance: N, rows: &Rows<N>) -> Intermediate<N> {
        Ends::of(pair, distance, rows).to_numbers()
    }

    #[inline(always)]
    fn finish<N: Number>(
        law: &Coefficients<N>,
        pair: &Pair<N>,
        motion: &Motion<N>,
        halfway: &Intermediate<N>,
        rows: &Rows<N>,
    ) -> Elastic<N> {
        let half = N::splat(0.5);
        let (axis, section) = (motion.axis, &motion.section);
        let [[_, _, _, reference], _, [last_twist, free_twist, length, spare]] = *rows;
        let ends = Ends::from_numbers(halfway);
        let strains = Strains::of(pair, motion, &ends, [last_twist, free_twist]);
        let Strains { ends: [i, j], twisted, sheared, bent, .. } = &strains;

        let compression = reference - motion.distance;
        let normal = compression * (law.normal_stiffness(compression) * section.area);
        let shear_stiffness = law.elastic.shear * section.area * length * length;
        let bending_stiffness = law.elastic.bending * section.axial;
        let torsion = *twisted * (law.elastic.torsion * section.polar);
        let bending = *bent * bending_stiffness;
        let shearing = *sheared * shear_stiffness;

        let torque_i = i.torque(shearing * pair.share_i + bending, torsion, axis);
        let torque_j = j.torque(shearing * pair.share_j - bending, -torsion, axis);
        // U does not change when the pair is turned as a whole: d × F + T_i + T_j = 0.
        let force = axis * normal + axis.cross(torque_i + torque_j) * motion.per_distance;

        let left = law.left();
        let parts = [
            half * normal * compression,
            half * shearing.dot(*sheared),
            half * torsion * *twisted,
            half * bending.dot(*bent),
        ];
        Elastic {
            compression,
            normal,
            shear: axis.cross(*sheared) * (law.elastic.shear * section.area * length),
            torsion,
            bending,
            force,
            torque_i,
            torque_j,
            energy: energy_left(parts, left),
            relaxed: if RELAXING { relaxation_loss(left, parts) } else { N::zero() },
            overbent: strains.overbent(last_twist),
            rows: if RELAXING && law.relaxes {
                relaxed(law, pair, motion, &ends, &strains, rows)
            } else {
                [rows[0], rows[1], [strains.twist, free_twist, length, spare]]
            },
        }
    }
}
