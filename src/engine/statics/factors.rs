//! The equations of rest divided by sparse factors of their symmetric part.

use super::columns::Columns;
use super::solution::Bound;

/// Puts solutions in the place of right-hand sides, which stand one behind the other.
pub type Divide = Box<dyn Fn(&mut [f64])>;

/// Factors of a sparse symmetric matrix: rows that can be moved without a load and stay, each with how everything goes with it while the
/// others stay; the number of negative pivots; what puts solutions in the place of right-hand sides.
pub type Factors = (Vec<(usize, Vec<f64>)>, usize, Divide);

/// Finds factors of a matrix of so many rows from `(row, column, entry)` of its lower triangle, by pivots above a share of the diagonal; none
/// where they would be too large.
pub type Factorise = fn(usize, &[(usize, usize, f64)], f64) -> Option<Factors>;

/// A body whose part in a free motion is below this does not belong to it.
const PART: f64 = 1e-3;

/// Factors of a network.
pub(super) struct Factored {
    /// Replaces loads by the motions that bear them.
    pub(super) divide: Divide,
    /// Freedoms that can be moved without a load: they stay.
    pub(super) held: Vec<usize>,
    /// Bodies that move with one of them.
    pub(super) loose: Vec<usize>,
    /// Whether no motion gives energy away.
    pub(super) is_stable: bool,
}

/// Those of a network without what is bound.
pub(super) fn factored(factorise: Factorise, columns: &Columns, bound: &Bound, least: f64) -> Option<Factored> {
    let each = columns.each();
    let mut entries = Vec::new();
    columns.each_pair(&mut |[body, moving], block, mirrored| {
        if body < moving {
            return;
        }
        let mean = bound.within([body as usize, moving as usize], &(0.5 * (block + mirrored.transpose())));
        for row in 0..each {
            let first = moving as usize * each;
            for column in 0..if body == moving { row + 1 } else { each } {
                entries.push((body as usize * each + row, first + column, mean[(row, column)]));
            }
        }
    });
    let (motions, negative, divide) = factorise(columns.freedoms(), &entries, least)?;
    let mut is_loose = vec![false; columns.freedoms() / each.max(1)];
    for (_, motion) in &motions {
        let largest = motion.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        for (freedom, part) in motion.iter().enumerate() {
            is_loose[freedom / each] |= part.abs() > PART * largest;
        }
    }
    let loose = (0..is_loose.len()).filter(|&body| is_loose[body]).collect();
    let held = motions.into_iter().map(|(freedom, _)| freedom).collect();
    Some(Factored { divide, held, loose, is_stable: negative == 0 })
}
