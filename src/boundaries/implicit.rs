//! How stiff contacts move a light body without a shorter time step.
//!
//! A half kick gives a body that is not a group of particles the change of motion Δ for which
//!
//! ```text
//! (M + A) Δ = Δt/2 · load,      A = Δt²/2 K + Δt C
//! ```
//!
//! M has its mass and inertia, K and C all stiffness and damping that contacts, springs and dashpots offer to its six
//! freedoms, as they may get until they are looked for again. The scheme is stable while 4 (M + A) − 2 Δt C − Δt² K of the whole network
//! is positive definite. A contact's share between two bodies is at most twice the sum of what each would feel alone; with
//! that, A leaves 4 M of the body, whatever the step, and its particles feel its contacts twice
//! ([`crate::stability`] counts them so). With less than ½ in A no mass of a particle would do.
//!
//! −A Δ is an impulse that nothing gives: the books have it by its name. Over a change of motion it is A times that change, so it
//! vanishes with the step.

use crate::number::Vector;

/// Lower triangle of a symmetric 6 × 6 matrix over three translations and three rotations, row by row.
pub(crate) type Triangle = [f64; 21];

/// Where an entry stands in a triangle.
const fn place(row: usize, column: usize) -> usize {
    if row >= column { row * (row + 1) / 2 + column } else { column * (column + 1) / 2 + row }
}

/// Adds what a spring or dashpot offers to a body: along the normal, across it, against twisting and bending; it acts at
/// this arm from the point of reference \[m\].
pub(crate) fn add(block: &mut Triangle, normal: Vector, arm: Vector, [along, across, twisting, bending]: [f64; 4]) {
    let n = normal.to_array();
    let unit = |axis: usize| Vector::from([0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 }));
    // How a unit of each freedom moves the point of action, and turns the body there.
    let freedoms: [[Vector; 2]; 6] = std::array::from_fn(|k| match k {
        0..3 => [unit(k), Vector::zero()],
        _ => [unit(k - 3).cross(arm), unit(k - 3)],
    });
    for row in 0..6 {
        for column in 0..=row {
            let ([p, u], [q, w]) = (freedoms[row], freedoms[column]);
            let n = Vector::from(n);
            block[place(row, column)] += across * p.dot(q)
                + (along - across) * p.dot(n) * q.dot(n)
                + bending * u.dot(w)
                + (twisting - bending) * u.dot(n) * w.dot(n);
        }
    }
}

/// Adds to the diagonal.
pub(crate) fn add_diagonal(block: &mut Triangle, parts: [f64; 6]) {
    for (row, part) in parts.into_iter().enumerate() {
        block[place(row, row)] += part;
    }
}

/// A of a time step \[s\] between freedoms that are free; zeros elsewhere.
pub(super) fn added(stiffness: &Triangle, damping: &Triangle, free: [bool; 6], step: f64) -> Triangle {
    let mut sum = [0.0; 21];
    for row in (0..6).filter(|&row| free[row]) {
        for column in (0..=row).filter(|&column| free[column]) {
            let at = place(row, column);
            sum[at] = 0.5 * step * step * stiffness[at] + step * damping[at];
        }
    }
    sum
}

/// The solution of a symmetric, positive definite system (L D Lᵀ).
pub(super) fn solve(mut matrix: Triangle, mut vector: [f64; 6]) -> [f64; 6] {
    for k in 0..6 {
        for row in k + 1..6 {
            let factor = matrix[place(row, k)] / matrix[place(k, k)];
            for column in k + 1..=row {
                matrix[place(row, column)] -= factor * matrix[place(column, k)];
            }
            vector[row] -= factor * vector[k];
        }
    }
    for row in (0..6).rev() {
        let known: f64 = (row + 1..6).map(|column| matrix[place(column, row)] * vector[column]).sum();
        vector[row] = (vector[row] - known) / matrix[place(row, row)];
    }
    vector
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The product of a matrix with a vector.
    fn times(triangle: &Triangle, vector: [f64; 6]) -> [f64; 6] {
        std::array::from_fn(|row| (0..6).map(|column| triangle[place(row, column)] * vector[column]).sum())
    }

    #[test]
    fn the_solution_times_the_matrix_is_the_load() {
        let mut matrix = [0.0; 21];
        add_diagonal(&mut matrix, [2.0, 2.0, 2.0, 0.1, 0.3, 0.2]);
        add(&mut matrix, Vector::new(0.6, 0.0, 0.8), Vector::new(0.3, -0.2, 0.5), [7.0, 3.0, 0.1, 0.4]);
        let load = [1.0, -2.0, 3.0, 0.5, -0.7, 0.2];
        let found = times(&matrix, solve(matrix, load));
        for (found, load) in found.into_iter().zip(load) {
            assert!((found - load).abs() < 1e-13, "{found}, not {load}");
        }
    }

    #[test]
    fn a_spring_at_an_arm_resists_shift_and_turn_as_by_hand() {
        // 5 N/m along z at x = 2 m: f_z = −5 (u − 2 θ_y), m_y = −2 f_z.
        let mut block = [0.0; 21];
        add(&mut block, Vector::new(0.0, 0.0, 1.0), Vector::new(2.0, 0.0, 0.0), [5.0, 0.0, 0.0, 0.0]);
        assert_eq!(times(&block, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), [0.0, 0.0, 5.0, 0.0, -10.0, 0.0]);
        assert_eq!(times(&block, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]), [0.0, 0.0, -10.0, 0.0, 20.0, 0.0]);
    }
}
