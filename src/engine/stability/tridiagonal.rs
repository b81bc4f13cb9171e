//! Eigenvalues of a symmetric tridiagonal matrix.

/// The largest eigenvalue of a symmetric tridiagonal matrix, by bisection with Sturm's sequence, from above.
pub(super) fn largest_eigenvalue(diagonal: &[f64], beside: &[f64]) -> f64 {
    let reach = |row: usize| {
        let before = row.checked_sub(1).map_or(0.0, |row| beside[row]);
        diagonal[row] + before + beside.get(row).copied().unwrap_or(0.0)
    };
    let mut above = (0..diagonal.len()).map(reach).fold(0.0, f64::max) * (1.0 + f64::EPSILON);
    let mut below = diagonal.iter().copied().fold(0.0, f64::max);
    // Halving until the ends are neighbours would take 53 turns; what is left is far below every allowance.
    for _ in 0..46 {
        let middle = 0.5 * (below + above);
        if all_below(diagonal, beside, middle) {
            above = middle;
        } else {
            below = middle;
        }
    }
    above
}

/// Whether all eigenvalues of a tridiagonal matrix are below a number: whether every pivot of their difference is positive.
pub(super) fn all_below(diagonal: &[f64], beside: &[f64], number: f64) -> bool {
    let mut pivot = 1.0;
    for (row, entry) in diagonal.iter().enumerate() {
        let before = row.checked_sub(1).map_or(0.0, |row| beside[row] * beside[row]);
        pivot = number - entry - before / pivot;
        if pivot <= 0.0 || pivot.is_nan() {
            return false;
        }
    }
    true
}

/// The eigenvector of a tridiagonal matrix that belongs to its largest eigenvalue: two turns of inverse iteration from just
/// above it.
pub(super) fn eigenvector(diagonal: &[f64], beside: &[f64], value: f64) -> Vec<f64> {
    let count = diagonal.len();
    let shift = value * (1.0 + 1e-9) + f64::MIN_POSITIVE;
    let mut vector = vec![1.0; count];
    for _ in 0..3 {
        // value − T is positive definite: no pivoting.
        let mut pivots = vec![0.0; count];
        for row in 0..count {
            let before = row.checked_sub(1).map_or(0.0, |before| beside[before] * beside[before] / pivots[before]);
            pivots[row] = shift - diagonal[row] - before;
            if row > 0 {
                vector[row] += beside[row - 1] / pivots[row - 1] * vector[row - 1];
            }
        }
        for row in (0..count).rev() {
            let after = if row + 1 < count { beside[row] * vector[row + 1] } else { 0.0 };
            vector[row] = (vector[row] + after) / pivots[row];
        }
        let length = vector.iter().map(|part| part * part).sum::<f64>().sqrt();
        vector.iter_mut().for_each(|part| *part /= length);
    }
    vector
}
