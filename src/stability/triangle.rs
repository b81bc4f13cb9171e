//! Symmetric 6 × 6 matrices: the blocks of bodies, and what elements add to them.

use super::network::{Element, Group};

/// Lower triangle of a symmetric 6 × 6 matrix, row by row, scaled by mass and moment of inertia.
pub(super) type Triangle = [f32; 21];

/// Where the diagonal entry of a row stands in a triangle.
pub(super) const fn diagonal(row: usize) -> usize {
    row * (row + 3) / 2
}

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
    pub(super) fn add(&self, block: &mut Triangle, parts: [f32; 4]) {
        let [along, across, twisting, bending] = parts.map(f64::from);
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
    parts: [f32; 4],
    group: &Group,
    share: f64,
) {
    let [along, across, twisting, bending] = parts.map(|part| share * f64::from(part));
    let n = normal.map(f64::from);
    // The point of action moves with v + w × arm: what unit freedoms give along three axes.
    let a = arm;
    let turned = [[0.0, a[2], -a[1]], [-a[2], 0.0, a[0]], [a[1], -a[0], 0.0]];
    // Motions of the point and turns of the body that the scaled freedoms make.
    let freedom = |k: usize| {
        let unscaled: [f64; 6] = std::array::from_fn(|row| group.root[row][k]);
        let point: [f64; 3] = std::array::from_fn(|axis| {
            unscaled[axis] + (0..3).map(|turn| turned[axis][turn] * unscaled[3 + turn]).sum::<f64>()
        });
        (point, [unscaled[3], unscaled[4], unscaled[5]])
    };
    let freedoms: [_; 6] = std::array::from_fn(freedom);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    for row in 0..6 {
        for column in 0..=row {
            let ((p, u), (q, w)) = (&freedoms[row], &freedoms[column]);
            let shift = across * dot(p, q) + (along - across) * dot(p, &n) * dot(q, &n);
            let turn = bending * dot(u, w) + (twisting - bending) * dot(u, &n) * dot(w, &n);
            block[row * (row + 1) / 2 + column] += (shift + turn) as f32;
        }
    }
}

/// Sum of the squares of all entries of a symmetric matrix, given by its triangle.
pub(super) fn squares(triangle: &[f64; 21]) -> f64 {
    let all: f64 = triangle.iter().map(|part| part * part).sum();
    let on_diagonal: f64 = (0..6).map(|k| triangle[diagonal(k)] * triangle[diagonal(k)]).sum();
    2.0 * all - on_diagonal
}

/// The product of a matrix, given by its triangle, with a vector.
#[inline]
pub(super) fn times(triangle: &[f64; 21], vector: &[f64; 6]) -> [f64; 6] {
    let mut image = [0.0; 6];
    let mut place = 0;
    for a in 0..6 {
        for b in 0..a {
            image[a] += triangle[place] * vector[b];
            image[b] += triangle[place] * vector[a];
            place += 1;
        }
        image[a] += triangle[place] * vector[a];
        place += 1;
    }
    image
}

/// Whether a symmetric matrix is positive definite (L D Lᵀ, in place).
pub(super) fn is_positive(matrix: &mut [f64; 21]) -> bool {
    for k in 0..6 {
        let pivot = matrix[diagonal(k)];
        if pivot <= 0.0 || pivot.is_nan() {
            return false;
        }
        let per_pivot = 1.0 / pivot;
        for a in k + 1..6 {
            let factor = matrix[a * (a + 1) / 2 + k] * per_pivot;
            for b in k + 1..=a {
                matrix[a * (a + 1) / 2 + b] -= factor * matrix[b * (b + 1) / 2 + k];
            }
        }
    }
    true
}
