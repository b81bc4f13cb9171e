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
//! ([`crate::engine::stability`] counts them so). With less than ½ in A no mass of a particle would do.
//!
//! −A Δ is an impulse that nothing gives: the books have it by its name. Over a change of motion it is A times that change, so it
//! vanishes with the step.

use crate::base::number::Vector;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Adds what a spring or dashpot offers to the six freedoms of a body, three translations and three rotations: along the normal, across
/// it, against twisting and bending; it acts at this arm from the point of reference \[m\].
pub(crate) fn add(block: &mut Matrix6<f64>, normal: Vector, arm: Vector, [along, across, twisting, bending]: [f64; 4]) {
    let normal = Vector3::from(normal.to_array());
    let of = |along: f64, across: f64| {
        Matrix3::from_diagonal_element(across) + normal * normal.transpose() * (along - across)
    };
    let (shift, turn) = (of(along, across), of(twisting, bending));
    // The point of action moves with v + ω × arm.
    let lever = -Vector3::from(arm.to_array()).cross_matrix();
    let mixed = shift * lever;
    let mut add = |row: usize, column: usize, part: Matrix3<f64>| {
        let mut view = block.fixed_view_mut::<3, 3>(row, column);
        view += part;
    };
    add(0, 0, shift);
    add(0, 3, mixed);
    add(3, 0, mixed.transpose());
    add(3, 3, lever.transpose() * mixed + turn);
}

/// A of a time step \[s\] between freedoms that are free; zeros elsewhere.
pub(super) fn added(stiffness: &Matrix6<f64>, damping: &Matrix6<f64>, free: [bool; 6], step: f64) -> Matrix6<f64> {
    let all = stiffness * (0.5 * step * step) + damping * step;
    all.map_with_location(|row, column, part| if free[row] && free[column] { part } else { 0.0 })
}

/// The solution of a symmetric, positive definite system; not numbers where it is none.
pub(super) fn solve(matrix: Matrix6<f64>, load: &Vector6<f64>) -> Vector6<f64> {
    matrix.cholesky().map_or(Vector6::repeat(f64::NAN), |factors| factors.solve(load))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_times_the_matrix_is_the_load() {
        let mut matrix = Matrix6::from_diagonal(&Vector6::new(2.0, 2.0, 2.0, 0.1, 0.3, 0.2));
        add(&mut matrix, Vector::new(0.6, 0.0, 0.8), Vector::new(0.3, -0.2, 0.5), [7.0, 3.0, 0.1, 0.4]);
        let load = Vector6::new(1.0, -2.0, 3.0, 0.5, -0.7, 0.2);
        let found = matrix * solve(matrix, &load);
        assert!((found - load).amax() < 1e-13, "{found}, not {load}");
    }

    #[test]
    fn a_spring_at_an_arm_resists_shift_and_turn_as_by_hand() {
        // 5 N/m along z at x = 2 m: f_z = −5 (u − 2 θ_y), m_y = −2 f_z.
        let mut block = Matrix6::zeros();
        add(&mut block, Vector::new(0.0, 0.0, 1.0), Vector::new(2.0, 0.0, 0.0), [5.0, 0.0, 0.0, 0.0]);
        assert_eq!(block.column(2), Vector6::new(0.0, 0.0, 5.0, 0.0, -10.0, 0.0));
        assert_eq!(block.column(4), Vector6::new(0.0, 0.0, -10.0, 0.0, 20.0, 0.0));
        assert_eq!(block, block.transpose());
    }
}
