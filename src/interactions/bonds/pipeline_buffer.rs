//! What the stages of the bond pass hand to each other.

use crate::bond::{BondLaw, Halfway, Lengths, MOST_HALFWAY, Opening, Pair, Quaternion, Rates};
use crate::lanes::Lane;
use crate::number::Vector;
use crate::state::Row;
use std::marker::PhantomData;

/// Where columns of pairs stand: the first of each. What a law does not look at has none, so that what is under way lies
/// close: a processor takes places that are 4096 bytes apart for the same until it knows better, and waits.
struct Columns<L>(PhantomData<L>);

impl<L: BondLaw> Columns<L> {
    /// d: three.
    const CONNECTION: usize = 0;
    /// Share of i, share of j, smaller radius.
    const SHARES: usize = 3;
    /// Lengths: two.
    const LENGTHS: usize = 6;
    /// Relative velocity, spin of i, spin of j: nine.
    const VELOCITY: usize = 8;
    /// Masses and moments of inertia: four.
    const MASSES: usize = Self::VELOCITY + if Self::HAS_RATES { 9 } else { 0 };
    /// Both attitudes: eight.
    const ATTITUDES: usize = Self::MASSES + if L::NEEDS_MASSES { 4 } else { 0 };
    /// How many there are.
    const PAIR: usize = Self::ATTITUDES + if L::NEEDS_ATTITUDES { 8 } else { 0 };
    /// Opening: its quotient, and six where the pair turns.
    const OPENING: usize = 0;
    /// What the formulation has halfway.
    const HALFWAY: usize = if matches!(L::RATES, Rates::Midway) { 7 } else { 1 };
    /// How many there are of these.
    const OPENED: usize = Self::HALFWAY + L::HALFWAY;
    /// Whether the law looks at rates.
    const HAS_RATES: bool = !matches!(L::RATES, Rates::Unseen);
}

/// The most columns of a pair.
const MOST_PAIR: usize = 29;

/// The most columns of what comes next.
const MOST_OPENED: usize = 7 + MOST_HALFWAY;

/// Loads of a register's worth of bonds.
#[derive(Clone, Copy)]
pub(crate) struct Loads {
    /// Force on i.
    pub(crate) force: [Row; 8],
    /// Torque on i.
    pub(crate) first_torque: [Row; 8],
    /// Torque on j.
    pub(crate) second_torque: [Row; 8],
}

/// What is under way: three registers' worth of pairs, and two of what comes of them.
#[repr(align(64))]
pub(crate) struct PipelineBuffer {
    /// Pairs.
    pairs: [[f64; 8]; 3 * MOST_PAIR],
    /// What comes before the divisions.
    opened: [[f64; 8]; 2 * MOST_OPENED],
    /// Loads.
    loads: [Loads; 2],
}

/// Writes columns.
#[inline(always)]
fn put<N: Lane, const COUNT: usize>(columns: &mut [[f64; 8]], first: usize, values: [N; COUNT]) {
    let columns = &mut columns[first..first + COUNT];
    let mut column = 0;
    while column < COUNT {
        // SAFETY: a column has room for a register.
        unsafe { values[column].store(columns[column].as_mut_ptr()) };
        column += 1;
    }
}

/// Reads columns.
#[inline(always)]
fn take<N: Lane, const COUNT: usize>(columns: &[[f64; 8]], first: usize) -> [N; COUNT] {
    let columns = &columns[first..first + COUNT];
    let mut values = [N::zero(); COUNT];
    let mut column = 0;
    while column < COUNT {
        // SAFETY: a column holds a register.
        values[column] = unsafe { N::load(columns[column].as_ptr()) };
        column += 1;
    }
    values
}

impl PipelineBuffer {
    /// An empty one.
    pub(crate) fn new() -> Self {
        let rows = [[0.0; 4]; 8];
        let loads = Loads { force: rows, first_torque: rows, second_torque: rows };
        Self { pairs: [[0.0; 8]; 3 * MOST_PAIR], opened: [[0.0; 8]; 2 * MOST_OPENED], loads: [loads; 2] }
    }

    /// Columns of the pairs of this turn.
    #[inline(always)]
    fn of_pairs<L: BondLaw>(&self, turn: usize) -> &[[f64; 8]] {
        const { assert!(Columns::<L>::PAIR <= MOST_PAIR) };
        let start = turn % 3 * Columns::<L>::PAIR;
        &self.pairs[start..start + Columns::<L>::PAIR]
    }

    /// Columns of what came next of this turn.
    #[inline(always)]
    fn of_opened<L: BondLaw>(&self, turn: usize) -> &[[f64; 8]] {
        let start = turn % 2 * Columns::<L>::OPENED;
        &self.opened[start..start + Columns::<L>::OPENED]
    }

    /// Loads of this turn.
    #[inline(always)]
    pub(crate) fn loads(&self, turn: usize) -> &Loads {
        &self.loads[turn % 2]
    }

    /// Loads of this turn, to be written.
    #[inline(always)]
    pub(crate) fn loads_mut(&mut self, turn: usize) -> &mut Loads {
        &mut self.loads[turn % 2]
    }

    /// Writes pairs and lengths, as far as the law looks at them.
    #[inline(always)]
    pub(crate) fn put_pairs<L: BondLaw, N: Lane>(&mut self, turn: usize, pair: &Pair<N>, lengths: &Lengths<N>) {
        let start = turn % 3 * Columns::<L>::PAIR;
        let columns = &mut self.pairs[start..start + Columns::<L>::PAIR];
        put(columns, Columns::<L>::CONNECTION, parts(pair.connection));
        put(columns, Columns::<L>::SHARES, [pair.share_i, pair.share_j, pair.least_radius]);
        put(columns, Columns::<L>::LENGTHS, [lengths.distance, lengths.last_distance]);
        if Columns::<L>::HAS_RATES {
            put(columns, Columns::<L>::VELOCITY, parts(pair.velocity));
            put(columns, Columns::<L>::VELOCITY + 3, parts(pair.spin_i));
            put(columns, Columns::<L>::VELOCITY + 6, parts(pair.spin_j));
        }
        if L::NEEDS_MASSES {
            let masses = [pair.mass_i, pair.mass_j, pair.inertia_i, pair.inertia_j];
            put(columns, Columns::<L>::MASSES, masses);
        }
        if L::NEEDS_ATTITUDES {
            put(columns, Columns::<L>::ATTITUDES, pair.attitude_i.to_row());
            put(columns, Columns::<L>::ATTITUDES + 4, pair.attitude_j.to_row());
        }
    }

    /// Reads pairs and lengths; what the law does not look at is 0.
    #[inline(always)]
    pub(crate) fn pairs<L: BondLaw, N: Lane>(&self, turn: usize) -> (Pair<N>, Lengths<N>) {
        let columns = self.of_pairs::<L>(turn);
        let [share_i, share_j, least_radius] = take(columns, Columns::<L>::SHARES);
        let [distance, last_distance] = take(columns, Columns::<L>::LENGTHS);
        let (zero, none, still) = (N::zero(), Vector::zero(), Quaternion::identity());
        let mut pair = Pair {
            connection: whole(take(columns, Columns::<L>::CONNECTION)),
            velocity: none,
            spin_i: none,
            spin_j: none,
            attitude_i: still,
            attitude_j: still,
            share_i,
            share_j,
            slip_share_i: share_i,
            least_radius,
            mass_i: zero,
            mass_j: zero,
            inertia_i: zero,
            inertia_j: zero,
        };
        if Columns::<L>::HAS_RATES {
            pair.velocity = whole(take(columns, Columns::<L>::VELOCITY));
            pair.spin_i = whole(take(columns, Columns::<L>::VELOCITY + 3));
            pair.spin_j = whole(take(columns, Columns::<L>::VELOCITY + 6));
        }
        if L::NEEDS_MASSES {
            [pair.mass_i, pair.mass_j, pair.inertia_i, pair.inertia_j] = take(columns, Columns::<L>::MASSES);
        }
        if L::NEEDS_ATTITUDES {
            pair.attitude_i = Quaternion::from_row(take(columns, Columns::<L>::ATTITUDES));
            pair.attitude_j = Quaternion::from_row(take(columns, Columns::<L>::ATTITUDES + 4));
        }
        (pair, Lengths { distance, last_distance })
    }

    /// Writes what came next, and what the formulation has halfway.
    #[inline(always)]
    pub(crate) fn put_opened<L: BondLaw, N: Lane>(&mut self, turn: usize, opening: &Opening<N>, halfway: &Halfway<N>) {
        const { assert!(Columns::<L>::OPENED <= MOST_OPENED) };
        let start = turn % 2 * Columns::<L>::OPENED;
        let columns = &mut self.opened[start..start + Columns::<L>::OPENED];
        put(columns, Columns::<L>::OPENING, [opening.shared]);
        if matches!(L::RATES, Rates::Midway) {
            put(columns, Columns::<L>::OPENING + 1, parts(opening.sum));
            put(columns, Columns::<L>::OPENING + 4, [opening.size, opening.above, opening.below]);
        }
        let mut number = 0;
        while number < L::HALFWAY {
            put(columns, Columns::<L>::HALFWAY + number, [halfway[number]]);
            number += 1;
        }
    }

    /// Reads what came next, and what the formulation has halfway; the rest is 0.
    #[inline(always)]
    pub(crate) fn opened<L: BondLaw, N: Lane>(&self, turn: usize) -> (Opening<N>, Halfway<N>) {
        let columns = self.of_opened::<L>(turn);
        let [shared] = take(columns, Columns::<L>::OPENING);
        let zero = N::zero();
        let mut opening = Opening { sum: Vector::zero(), size: zero, above: zero, below: zero, shared };
        if matches!(L::RATES, Rates::Midway) {
            opening.sum = whole(take(columns, Columns::<L>::OPENING + 1));
            [opening.size, opening.above, opening.below] = take(columns, Columns::<L>::OPENING + 4);
        }
        let mut halfway = [zero; MOST_HALFWAY];
        let mut number = 0;
        while number < L::HALFWAY {
            [halfway[number]] = take(columns, Columns::<L>::HALFWAY + number);
            number += 1;
        }
        (opening, halfway)
    }
}

/// A vector as three columns.
#[inline(always)]
fn parts<N: Lane>(vector: Vector<N>) -> [N; 3] {
    [vector.x, vector.y, vector.z]
}

/// Three columns as a vector.
#[inline(always)]
fn whole<N: Lane>([x, y, z]: [N; 3]) -> Vector<N> {
    Vector::new(x, y, z)
}
