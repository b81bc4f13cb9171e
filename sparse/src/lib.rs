//! Factors of a sparse symmetric matrix, and what its zero pivots tell.
//!
//! ```text
//! S A S / a = Pᵀ L D Lᵀ P
//! ```
//!
//! a is the power of two of the largest entry of the diagonal, S are powers of two that bring the others near to 1, P an order of little fill, D the pivots. Where a pivot is as good as zero the
//! row can be moved without a load: it is held, so that all others have a solution.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side};

/// Rows that are held, each with how everything goes with it; the number of negative pivots; what puts solutions in the place of right-hand
/// sides, which stand one behind the other.
pub type Answers = (Vec<(usize, Vec<f64>)>, usize, Box<dyn Fn(&mut [f64])>);

/// [`Factors::of`], in types that whoever uses them need not know.
pub fn factorise(rows: usize, entries: &[(usize, usize, f64)], least: f64) -> Option<Answers> {
    let factors = Factors::of(rows, entries, least)?;
    let motions = factors.held.iter().map(|&held| (held, factors.motion(held))).collect();
    Some((motions, factors.negative, Box::new(move |sides| factors.solve(sides))))
}

/// What a pivot that is as good as zero becomes: its row does not move.
const HOLDS: f64 = 1e24;

/// Most numbers in the factors: 512 MiB.
const MOST: usize = 1 << 26;

/// The factors of a matrix.
pub struct Factors {
    /// Where they have entries.
    symbolic: SymbolicCholesky<usize>,
    /// The entries.
    values: Vec<f64>,
    /// S.
    scale: Vec<f64>,
    /// 1/a.
    unit: f64,
    /// Rows that are held, ascending.
    held: Vec<usize>,
    /// How many pivots are negative.
    negative: usize,
}

impl Factors {
    /// Those of a matrix of so many rows, from `(row, column, entry)` of its lower triangle with the diagonal; entries of one place are added.
    /// Pivots below the `least` share of the diagonal are zero. None without rows, where an entry is not finite, or where the factors would
    /// take more than 512 MiB.
    pub fn of(rows: usize, entries: &[(usize, usize, f64)], least: f64) -> Option<Self> {
        if rows == 0 || entries.iter().any(|(_, _, entry)| !entry.is_finite()) {
            return None;
        }
        let mut diagonal = vec![0.0; rows];
        for (row, _, entry) in entries.iter().filter(|(row, column, _)| row == column) {
            diagonal[*row] += entry;
        }
        let (scale, unit) = scales(&diagonal);
        let scaled: Vec<_> = entries
            .iter()
            .map(|&(row, column, entry)| Triplet::new(row, column, scale[row] * (entry * unit) * scale[column]))
            .collect();
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(rows, rows, &scaled).ok()?;
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0), // always: a diagonal matrix has a ratio of 0
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, SymmetricOrdering::Amd, parameters).ok()?;
        if symbolic.len_val() > MOST {
            return None;
        }
        let mut values = Vec::new();
        values.try_reserve_exact(symbolic.len_val()).ok()?;
        values.resize(symbolic.len_val(), 0.0);
        let space = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(space).ok()?;
        let zero = LdltRegularization {
            dynamic_regularization_signs: None,
            dynamic_regularization_delta: HOLDS,
            dynamic_regularization_epsilon: least,
        };
        let stack = MemStack::new(&mut memory);
        symbolic
            .factorize_numeric_ldlt(
                &mut values,
                matrix.as_ref(),
                Side::Lower,
                zero,
                Par::Seq,
                stack,
                Default::default(),
            )
            .ok()?;
        let pivots = pivots(&symbolic, &values)?;
        let held = (0..rows).filter(|&row| pivots[row].abs() >= 0.5 * HOLDS).collect();
        let negative = pivots.iter().filter(|pivot| **pivot < 0.0 && pivot.abs() < 0.5 * HOLDS).count();
        Some(Self { symbolic, values, scale, unit, held, negative })
    }

    /// Rows whose pivots are zero, ascending. They stay where they are in every solution.
    pub fn held(&self) -> &[usize] {
        &self.held
    }

    /// How many pivots are negative: none where the matrix is definite but for what is held.
    pub fn negative(&self) -> usize {
        self.negative
    }

    /// How everything goes with a held row that moves by 1 while other held rows stay, without a load.
    pub fn motion(&self, held: usize) -> Vec<f64> {
        let mut motion = vec![0.0; self.scale.len()];
        motion[held] = HOLDS / self.scale[held] / self.scale[held] / self.unit;
        self.solve(&mut motion);
        motion
    }

    /// Puts solutions in the place of right-hand sides, which stand one behind the other.
    pub fn solve(&self, sides: &mut [f64]) {
        let rows = self.scale.len();
        self.scale(sides, self.unit);
        let columns = sides.len() / rows;
        let space = self.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq);
        let mut memory = MemBuffer::new(space);
        let factors = LdltRef::<usize, f64>::new(&self.symbolic, &self.values);
        factors.solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(sides, rows, columns),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        self.scale(sides, 1.0);
    }

    /// Multiplies by S and a number.
    fn scale(&self, sides: &mut [f64], factor: f64) {
        for (side, scale) in sides.iter_mut().zip(self.scale.iter().cycle()) {
            *side *= scale * factor;
        }
    }
}

/// The pivots in the order of the rows.
fn pivots(symbolic: &SymbolicCholesky<usize>, values: &[f64]) -> Option<Vec<f64>> {
    let SymbolicCholeskyRaw::Supernodal(inner) = symbolic.raw() else { return None };
    let factors = SupernodalLdltRef::<usize, f64>::new(inner, values);
    let order = symbolic.perm()?.arrays().0;
    let mut pivots = vec![0.0; order.len()];
    for index in 0..inner.n_supernodes() {
        let supernode = factors.supernode(index);
        let part = supernode.val();
        for column in 0..part.ncols() {
            pivots[order[supernode.start() + column]] = part[(column, column)];
        }
    }
    Some(pivots)
}

/// S and 1/a of a diagonal.
fn scales(diagonal: &[f64]) -> (Vec<f64>, f64) {
    let largest = diagonal.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
    let common = exponent(largest);
    let scale = |entry: &f64| if *entry > 0.0 { power((common - exponent(*entry)) / 2) } else { 1.0 };
    (diagonal.iter().map(scale).collect(), power(-common))
}

/// The exponent of the power of two at or below a number; 0 of zero.
fn exponent(number: f64) -> i32 {
    if number.is_normal() { ((number.to_bits() >> 52) & 0x7ff) as i32 - 1023 } else { 0 }
}

/// A power of two, as far as numbers go.
fn power(exponent: i32) -> f64 {
    f64::from_bits(((exponent.clamp(-1022, 1023) + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::Factors;

    /// Springs between neighbours in a row of so many, the first of which is tied to the ground by a spring.
    fn row(rows: usize, ground: f64) -> Vec<(usize, usize, f64)> {
        let mut entries = vec![(0, 0, ground)];
        for next in 1..rows {
            entries.extend([(next - 1, next - 1, 1.0), (next, next, 1.0), (next, next - 1, -1.0)]);
        }
        entries
    }

    fn near(found: f64, expected: f64) -> bool {
        (found - expected).abs() <= 1e-12 * expected.abs().max(1.0)
    }

    #[test]
    fn a_row_of_springs_that_is_drawn_at_its_end_follows_by_equal_parts() {
        let factors = Factors::of(50, &row(50, 1.0), 1e-10).unwrap();
        assert!(factors.held().is_empty() && factors.negative() == 0);
        let mut sides = vec![0.0; 100];
        (sides[49], sides[50]) = (2.0, 1.0);
        factors.solve(&mut sides);
        for place in 0..50 {
            assert!(near(sides[place], 2.0 * (place + 1) as f64), "{place}: {}", sides[place]);
            assert!(near(sides[50 + place], 1.0), "{place}: {}", sides[50 + place]);
        }
    }

    #[test]
    fn what_is_tied_to_nothing_has_one_held_row_and_moves_as_a_whole() {
        for unit in [1.0, 2.0_f64.powi(-301), 2.0_f64.powi(211)] {
            let mut entries = row(20, 0.0);
            entries.iter_mut().for_each(|(_, _, entry)| *entry *= unit);
            let factors = Factors::of(20, &entries, 1e-10).unwrap();
            let &[held] = factors.held() else { panic!("{:?}", factors.held()) };
            assert!(factors.motion(held).iter().all(|way| near(*way, 1.0)), "{:?}", factors.motion(held));
            // Loads that balance: the ways between are those of the springs.
            let mut sides = vec![0.0; 20];
            (sides[3], sides[7]) = (-unit, unit);
            factors.solve(&mut sides);
            assert!(near(sides[7] - sides[3], 4.0) && sides[held] == 0.0, "{sides:?}");
        }
    }

    #[test]
    fn rows_of_very_different_stiffness_are_told_from_rows_without() {
        let entries = [(0, 0, 1e-8), (1, 1, 1e8), (1, 0, 0.1), (2, 2, 1.0), (3, 2, 1.0), (3, 3, 1.0)];
        let factors = Factors::of(4, &entries, 1e-10).unwrap();
        assert_eq!((factors.held().len(), factors.negative()), (1, 0));
        assert!(factors.held()[0] >= 2);
    }

    #[test]
    fn negative_pivots_are_counted_and_solved_with() {
        let factors = Factors::of(2, &[(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)], 1e-10).unwrap();
        assert_eq!(factors.negative(), 1);
        let mut sides = [5.0, 4.0];
        factors.solve(&mut sides);
        assert!(near(sides[0], 1.0) && near(sides[1], 2.0), "{sides:?}");
    }

    #[test]
    fn no_rows_and_what_is_not_finite_have_no_factors() {
        assert!(Factors::of(0, &[], 1e-10).is_none());
        assert!(Factors::of(1, &[(0, 0, f64::NAN)], 1e-10).is_none());
        assert_eq!(Factors::of(1, &[(0, 0, 0.0)], 1e-10).unwrap().held(), [0]);
    }
}
