//! What the stages of the bond pass hand to each other.

use crate::base::lanes::{Column, Lane, put, take, vector_of, vector_parts};
use crate::base::number::Vector;
use crate::engine::state::Row;
use crate::laws::bond::breakage::LoadedBonds;
use crate::laws::bond::damping::DampingLoad;
use crate::laws::bond::{
    Coefficients, Elastic, Formulation, Intermediate, Lengths, MOST_HALFWAY, Motion, Opening, Pair, Quaternion, Rates,
};
use std::marker::PhantomData;

/// Where columns of pairs stand: the first of each. What a formulation does not look at has none, so that what is under way
/// lies close: a processor takes places that are 4096 bytes apart for the same until it knows better, and waits.
struct Columns<F>(PhantomData<F>);

impl<F: Formulation> Columns<F> {
    /// Both orientations: eight.
    const ORIENTATIONS: usize = VELOCITY + if Self::HAS_RATES { 9 } else { 0 };
    /// How many there are.
    const PAIR: usize = Self::ORIENTATIONS + if F::NEEDS_ORIENTATIONS { 8 } else { 0 };
    /// What the formulation has halfway; before it the opening: its quotient, and six where the pair turns.
    const HALFWAY: usize = if matches!(F::RATES, Rates::Midway) { 7 } else { 1 };
    /// How many there are of these.
    const OPENED: usize = Self::HALFWAY + F::HALFWAY;
    /// Whether the formulation finds rates.
    const HAS_RATES: bool = !matches!(F::RATES, Rates::Unseen);
}

/// d: three.
const CONNECTION: usize = 0;

/// Share of i, share of j, smaller radius.
const SHARES: usize = 3;

/// Lengths: two.
const LENGTHS: usize = 6;

/// Relative velocity, spin of i, spin of j: nine.
const VELOCITY: usize = 8;

/// The most columns of a pair.
const MOST_PAIR: usize = 25;

/// The most columns of what comes next.
const MOST_OPENED: usize = 7 + MOST_HALFWAY;

/// Loads of a register's worth of bonds.
#[derive(Clone, Copy)]
pub(super) struct Loads {
    /// Force on i.
    pub(super) force: [Row; 8],
    /// Torque on i.
    pub(super) first_torque: [Row; 8],
    /// Torque on j.
    pub(super) second_torque: [Row; 8],
}

impl Loads {
    /// Writes a register's worth.
    #[inline(always)]
    fn put<N: Lane>(&mut self, [force, torque_i, torque_j]: [Vector<N>; 3]) {
        use crate::base::lanes::columns;
        // SAFETY: there is room for a register.
        unsafe {
            N::store_block(columns(force), self.force.as_mut_ptr());
            N::store_block(columns(torque_i), self.first_torque.as_mut_ptr());
            N::store_block(columns(torque_j), self.second_torque.as_mut_ptr());
        }
    }

    /// Takes away those of one bond.
    pub(super) fn clear(&mut self, lane: usize) {
        (self.force[lane], self.first_torque[lane], self.second_torque[lane]) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    }
}

/// What the formulation answered for a register's worth of bonds, for damping and breakage.
pub(super) struct Answer {
    /// What rules of breakage look at, and why bonds broke.
    pub(super) loaded: LoadedBonds,
    /// Axis, normal velocity, slip, twist rate, bending rate.
    motion: [Column; 11],
    /// Force on i, torque on i, torque on j, where damping is still to be added.
    loads: [Column; 9],
    /// Elastic energy that relaxation took \[J\].
    pub(super) relaxed: [Column; 1],
    /// Load of damping in the last evaluation, then in this one: force on i, torque on i, torque on j.
    damping: [Column; 9],
    /// Energy that damping took since the last evaluation \[J\], and the part of it that the last load took.
    damped: [Column; 2],
}

/// Work in progress: three registers' worth of pairs, and two of their results.
#[repr(align(64))]
pub(super) struct PipelineBuffer {
    /// Pairs.
    pairs: [Column; 3 * MOST_PAIR],
    /// What comes before the divisions.
    opened: [Column; 2 * MOST_OPENED],
    /// Loads.
    loads: [Loads; 2],
    /// Masses and moments of inertia of the pairs, where damping looks at them.
    masses: [Column; 3 * 4],
    /// What the formulation answered last, where damping or breakage looks at it.
    pub(super) answer: Answer,
}

impl Answer {
    /// An empty one.
    #[inline(always)]
    fn new() -> Self {
        Self {
            loaded: LoadedBonds::none(),
            motion: [[0.0; 8]; 11],
            loads: [[0.0; 8]; 9],
            relaxed: [[0.0; 8]],
            damping: [[0.0; 8]; 9],
            damped: [[0.0; 8]; 2],
        }
    }

    /// Writes what relaxation took.
    #[inline(always)]
    pub(super) fn put_relaxed<N: Lane>(&mut self, relaxed: N) {
        put(&mut self.relaxed, 0, [relaxed]);
    }

    /// Writes what damping looks at beyond that.
    #[inline(always)]
    pub(super) fn put_motion<N: Lane>(&mut self, motion: &Motion<N>, elastic: &Elastic<N>) {
        put(&mut self.motion, 0, vector_parts(motion.axis));
        put(&mut self.motion, 3, [motion.normal_velocity]);
        put(&mut self.motion, 4, vector_parts(motion.slip));
        put(&mut self.motion, 7, [motion.twist_rate]);
        put(&mut self.motion, 8, vector_parts(motion.bending_rate));
        put(&mut self.loads, 0, vector_parts(elastic.force));
        put(&mut self.loads, 3, vector_parts(elastic.torque_i));
        put(&mut self.loads, 6, vector_parts(elastic.torque_j));
    }

    /// Energy that relaxation and damping took of the bond in this lane \[J\].
    #[inline(always)]
    pub(super) fn taken(&self, lane: usize) -> [f64; 2] {
        [self.relaxed[0][lane], self.damped[0][lane]]
    }

    /// Writes a load of damping.
    #[inline(always)]
    pub(super) fn put_damping<N: Lane>(&mut self, load: &DampingLoad<N>) {
        put(&mut self.damping, 0, vector_parts(load.force));
        put(&mut self.damping, 3, vector_parts(load.torque_i));
        put(&mut self.damping, 6, vector_parts(load.torque_j));
    }

    /// Reads the load of damping that was written last.
    #[inline(always)]
    pub(super) fn damping<N: Lane>(&self) -> DampingLoad<N> {
        DampingLoad {
            force: vector_of(take(&self.damping, 0)),
            torque_i: vector_of(take(&self.damping, 3)),
            torque_j: vector_of(take(&self.damping, 6)),
        }
    }
}

impl PipelineBuffer {
    /// An empty one, made where it stands.
    #[inline(always)]
    pub(super) fn new() -> Self {
        let rows = [[0.0; 4]; 8];
        let loads = Loads { force: rows, first_torque: rows, second_torque: rows };
        Self {
            pairs: [[0.0; 8]; 3 * MOST_PAIR],
            opened: [[0.0; 8]; 2 * MOST_OPENED],
            loads: [loads; 2],
            masses: [[0.0; 8]; 3 * 4],
            answer: Answer::new(),
        }
    }

    /// Loads of this turn.
    #[inline(always)]
    pub(super) fn loads(&self, turn: usize) -> &Loads {
        &self.loads[turn % 2]
    }

    /// Writes loads of this turn.
    #[inline(always)]
    pub(super) fn put_loads<N: Lane>(&mut self, turn: usize, loads: [Vector<N>; 3]) {
        self.loads[turn % 2].put(loads);
    }

    /// Takes away the loads of one bond of this turn, and what damping took with them.
    pub(super) fn clear(&mut self, turn: usize, lane: usize) {
        self.loads[turn % 2].clear(lane);
        self.answer.damped[0][lane] = self.answer.damped[1][lane];
    }

    /// Writes masses and moments of inertia of the pairs of this turn: of i, of j.
    #[inline(always)]
    pub(super) fn put_masses<N: Lane>(&mut self, turn: usize, masses: [N; 4]) {
        put(&mut self.masses, turn % 3 * 4, masses);
    }

    /// Writes pairs and lengths, as far as the formulation looks at them.
    #[inline(always)]
    pub(super) fn put_pairs<F: Formulation, N: Lane>(&mut self, turn: usize, pair: &Pair<N>, lengths: &Lengths<N>) {
        const { assert!(Columns::<F>::PAIR <= MOST_PAIR) };
        let start = turn % 3 * Columns::<F>::PAIR;
        let columns = &mut self.pairs[start..start + Columns::<F>::PAIR];
        put(columns, CONNECTION, vector_parts(pair.connection));
        put(columns, SHARES, [pair.share_i, pair.share_j, pair.least_radius]);
        put(columns, LENGTHS, [lengths.distance, lengths.last_distance]);
        if Columns::<F>::HAS_RATES {
            put(columns, VELOCITY, vector_parts(pair.velocity));
            put(columns, VELOCITY + 3, vector_parts(pair.spin_i));
            put(columns, VELOCITY + 6, vector_parts(pair.spin_j));
        }
        if F::NEEDS_ORIENTATIONS {
            put(columns, Columns::<F>::ORIENTATIONS, pair.orientation_i.to_row());
            put(columns, Columns::<F>::ORIENTATIONS + 4, pair.orientation_j.to_row());
        }
    }

    /// Reads pairs and lengths; what the formulation does not look at is 0.
    #[inline(always)]
    pub(super) fn pairs<F: Formulation, N: Lane>(&self, turn: usize) -> (Pair<N>, Lengths<N>) {
        let start = turn % 3 * Columns::<F>::PAIR;
        let columns = &self.pairs[start..start + Columns::<F>::PAIR];
        let [distance, last_distance] = take(columns, LENGTHS);
        let mut pair = pair_of(columns, Columns::<F>::HAS_RATES, [N::zero(); 4]);
        pair.connection = vector_of(take(columns, CONNECTION));
        if F::NEEDS_ORIENTATIONS {
            pair.orientation_i = Quaternion::from_row(take(columns, Columns::<F>::ORIENTATIONS));
            pair.orientation_j = Quaternion::from_row(take(columns, Columns::<F>::ORIENTATIONS + 4));
        }
        (pair, Lengths { distance, last_distance })
    }

    /// Writes what came next, and what the formulation has halfway.
    #[inline(always)]
    pub(super) fn put_opened<F: Formulation, N: Lane>(
        &mut self,
        turn: usize,
        opening: &Opening<N>,
        halfway: &Intermediate<N>,
    ) {
        const { assert!(Columns::<F>::OPENED <= MOST_OPENED) };
        let start = turn % 2 * Columns::<F>::OPENED;
        let columns = &mut self.opened[start..start + Columns::<F>::OPENED];
        put(columns, 0, [opening.shared]);
        if matches!(F::RATES, Rates::Midway) {
            put(columns, 1, vector_parts(opening.sum));
            put(columns, 4, [opening.size, opening.above, opening.below]);
        }
        let mut number = 0;
        while number < F::HALFWAY {
            put(columns, Columns::<F>::HALFWAY + number, [halfway[number]]);
            number += 1;
        }
    }

    /// Reads what came next, and what the formulation has halfway; the rest is 0.
    #[inline(always)]
    pub(super) fn opened<F: Formulation, N: Lane>(&self, turn: usize) -> (Opening<N>, Intermediate<N>) {
        let start = turn % 2 * Columns::<F>::OPENED;
        let columns = &self.opened[start..start + Columns::<F>::OPENED];
        let [shared] = take(columns, 0);
        let zero = N::zero();
        let mut opening = Opening { sum: Vector::zero(), size: zero, above: zero, below: zero, shared };
        if matches!(F::RATES, Rates::Midway) {
            opening.sum = vector_of(take(columns, 1));
            [opening.size, opening.above, opening.below] = take(columns, 4);
        }
        let mut halfway = [zero; MOST_HALFWAY];
        let mut number = 0;
        while number < F::HALFWAY {
            [halfway[number]] = take(columns, Columns::<F>::HALFWAY + number);
            number += 1;
        }
        (opening, halfway)
    }

    /// Reads what damping looks at: pair (without connection and orientations), motion across and along the axis of this
    /// step, and forces. Pairs of this turn begin at this column.
    #[inline(always)]
    pub(super) fn moving<N: Lane>(
        &self,
        turn: usize,
        start: usize,
        law: &Coefficients<N>,
    ) -> (Pair<N>, Motion<N>, Elastic<N>) {
        let masses = take(&self.masses, turn % 3 * 4);
        let pair = pair_of(&self.pairs[start..start + VELOCITY + 9], true, masses);
        let answer = &self.answer;
        let [distance, _] = take(&answer.loaded.size, 0);
        let [normal_velocity] = take(&answer.motion, 3);
        let [twist_rate] = take(&answer.motion, 7);
        let axis = vector_of(take(&answer.motion, 0));
        let motion = Motion {
            normal_velocity,
            slip: vector_of(take(&answer.motion, 4)),
            twist_rate,
            bending_rate: vector_of(take(&answer.motion, 8)),
            ..Motion::still(axis, distance, law.section(pair.least_radius))
        };
        let [compression, normal] = take(&answer.loaded.elastic, 0);
        let [torsion] = take(&answer.loaded.elastic, 5);
        let elastic = Elastic {
            compression,
            normal,
            shear: vector_of(take(&answer.loaded.elastic, 2)),
            torsion,
            bending: vector_of(take(&answer.loaded.elastic, 6)),
            force: vector_of(take(&answer.loads, 0)),
            torque_i: vector_of(take(&answer.loads, 3)),
            torque_j: vector_of(take(&answer.loads, 6)),
            ..Elastic::none()
        };
        (pair, motion, elastic)
    }

    /// Adds damping to the loads of this turn. The last load of damping took one energy, this one takes the other.
    #[inline(always)]
    pub(super) fn put_damped<N: Lane>(
        &mut self,
        turn: usize,
        elastic: &Elastic<N>,
        damping: &DampingLoad<N>,
        [last, now]: [N; 2],
    ) {
        let DampingLoad { force, torque_i, torque_j } = *damping;
        self.put_loads(turn, [elastic.force + force, elastic.torque_i + torque_i, elastic.torque_j + torque_j]);
        self.answer.put_damping(damping);
        put(&mut self.answer.damped, 0, [last + now, last]);
    }
}

/// First column of the pairs of this turn.
pub(super) fn start_of<F: Formulation>(turn: usize) -> usize {
    turn % 3 * Columns::<F>::PAIR
}

/// A pair from its columns, without connection and orientations.
#[inline(always)]
fn pair_of<N: Lane>(columns: &[Column], has_rates: bool, [mass_i, mass_j, inertia_i, inertia_j]: [N; 4]) -> Pair<N> {
    let [share_i, share_j, least_radius] = take(columns, SHARES);
    let mut pair = Pair {
        connection: Vector::zero(),
        velocity: Vector::zero(),
        spin_i: Vector::zero(),
        spin_j: Vector::zero(),
        orientation_i: Quaternion::identity(),
        orientation_j: Quaternion::identity(),
        share_i,
        share_j,
        slip_share_i: share_i,
        least_radius,
        mass_i,
        mass_j,
        inertia_i,
        inertia_j,
    };
    if has_rates {
        pair.velocity = vector_of(take(columns, VELOCITY));
        pair.spin_i = vector_of(take(columns, VELOCITY + 3));
        pair.spin_j = vector_of(take(columns, VELOCITY + 6));
    }
    pair
}
