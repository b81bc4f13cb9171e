//! Symmetric 6 × 6 matrices: the blocks of bodies, and what elements add to them.

use super::network::{Element, Group};
use nalgebra::{Matrix3, Matrix6, Vector3};

/// Lower triangle of a symmetric 6 × 6 matrix, row by row, scaled by mass and moment of inertia.
pub(super) type Triangle = [f32; 21];

/// That of no interaction.
pub(super) const EMPTY: Triangle = [0.0; 21];

/// How often each entry of a triangle stands in its matrix.
const TIMES: [f64; 21] = [1., 2., 1., 2., 2., 1., 2., 2., 2., 1., 2., 2., 2., 2., 1., 2., 2., 2., 2., 2., 1.];

/// How a particle stands to an element: what its springs and its dashpots are weighed with.
pub(super) struct Place {
    /// Unit normal.
    normal: [f64; 3],
    /// n nᵀ, its lower triangle row by row.
    products: [f64; 6],
    /// What a stiffness gives to shifts, to turns by its arm, between the two and to turns by itself.
    weights: [f64; 4],
}

impl Place {
    /// Of the particle at one end of an element, which bears this share of it.
    #[inline(always)]
    pub(super) fn of(element: &Element, end: usize, [v, w]: [f64; 2], share: f64) -> Self {
        let normal = element.normal.map(f64::from);
        let [x, y, z] = normal;
        let arm = f64::from(element.arms[end]);
        let (shift, mixed, turn) = (share * v * v, share * v * w * arm, share * w * w);
        let products = [x * x, y * x, y * y, z * x, z * y, z * z];
        Self { normal, products, weights: [shift, turn * arm * arm, mixed, turn] }
    }

    /// Adds what the particle feels of the element alone. The arm lies along the normal n, so that with I the unit matrix, k
    /// along and q across the normal and s the arm, the blocks are q I + (k − q) n nᵀ, s q [n]× and s² q (I − n nᵀ) beside
    /// torsion and bending.
    #[inline(always)]
    pub(super) fn add(&self, block: &mut Triangle, parts: [f64; 4]) {
        let [along, across, twisting, bending] = parts;
        let ([x, y, z], products, [shifting, armed, between, turning]) = (self.normal, self.products, self.weights);
        let (shift, shift_more) = (shifting * across, shifting * (along - across));
        let turn = armed * across + turning * bending;
        let turn_more = turning * twisting - turn;
        let mixed = between * across;
        let mut add = |place: usize, part: f64| block[place] += part as f32;
        add(0, shift + shift_more * products[0]);
        add(1, shift_more * products[1]);
        add(2, shift + shift_more * products[2]);
        add(3, shift_more * products[3]);
        add(4, shift_more * products[4]);
        add(5, shift + shift_more * products[5]);
        add(7, -mixed * z);
        add(8, mixed * y);
        add(9, turn + turn_more * products[0]);
        add(10, mixed * z);
        add(12, -mixed * x);
        add(13, turn_more * products[1]);
        add(14, turn + turn_more * products[2]);
        add(15, -mixed * y);
        add(16, mixed * x);
        add(18, turn_more * products[3]);
        add(19, turn_more * products[4]);
        add(20, turn + turn_more * products[5]);
    }
}

/// Adds what a group feels of an element alone, whose arm has any direction.
pub(super) fn add_group(
    block: &mut Triangle,
    normal: [f32; 3],
    arm: [f64; 3],
    parts: [f64; 4],
    group: &Group,
    share: f64,
) {
    let [along, across, twisting, bending] = parts.map(|part| share * part);
    let normal = Vector3::from(normal.map(f64::from));
    let of = |along: f64, across: f64| {
        Matrix3::from_diagonal_element(across) + normal * normal.transpose() * (along - across)
    };
    // Turns of the body that the scaled freedoms make, and motions v + ω × arm of the point of action.
    let turns = group.root.fixed_rows::<3>(3);
    let shifts = group.root.fixed_rows::<3>(0) - Vector3::from(arm).cross_matrix() * turns;
    let (shift, turn) = (of(along, across) * shifts, of(twisting, bending) * turns);
    for row in 0..6 {
        for column in 0..=row {
            let part = shifts.column(row).dot(&shift.column(column)) + turns.column(row).dot(&turn.column(column));
            block[row * (row + 1) / 2 + column] += part as f32;
        }
    }
}

/// Sum of the squares of all entries of K + μ C.
#[inline]
pub(super) fn norm_squared(stiffness: &Triangle, damping: &Triangle, root: f64) -> f64 {
    let entry = |place: usize| f64::from(stiffness[place]) + root * f64::from(damping[place]);
    (0..21).map(|place| TIMES[place] * entry(place) * entry(place)).sum()
}

/// The whole matrix of a triangle.
#[inline]
pub(super) fn whole(triangle: &Triangle) -> Matrix6<f64> {
    Matrix6::from_fn(|row, column| {
        let (low, high) = (row.min(column), row.max(column));
        f64::from(triangle[high * (high + 1) / 2 + low])
    })
}
