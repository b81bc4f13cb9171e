//! Moments and products of inertia.

use crate::geometry::Quaternion;
use crate::number::Vector;

/// A symmetric 3 × 3 matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Matrix(pub(super) [[f64; 3]; 3]);

impl Matrix {
    /// Adds that of a particle with this mass \[kg\] and moment of inertia \[kg m²\] at an arm \[m\].
    pub(super) fn add_particle(&mut self, mass: f64, inertia: f64, arm: Vector) {
        let square = arm.dot(arm);
        for axis in 0..3 {
            self.0[axis][axis] += inertia + mass * square;
        }
        self.take_products(mass, arm);
    }

    /// Adds that of a mass \[kg\] at an arm \[m\].
    pub(super) fn add_point(&mut self, mass: f64, arm: Vector) {
        for axis in 0..3 {
            self.0[axis][axis] += mass * arm.dot(arm);
        }
        self.take_products(mass, arm);
    }

    /// Takes away m a aᵀ.
    fn take_products(&mut self, mass: f64, arm: Vector) {
        let parts = arm.to_array();
        for a in 0..3 {
            for b in 0..3 {
                self.0[a][b] -= mass * parts[a] * parts[b];
            }
        }
    }

    /// Its product with a vector.
    pub(super) fn times(&self, vector: Vector) -> Vector {
        Vector::from(self.0.map(|row| Vector::from(row).dot(vector)))
    }

    /// What it is to a body of this orientation, in global axes.
    pub(super) fn turned(&self, orientation: Quaternion) -> Self {
        let column = |axis: usize| {
            let unit = Vector::from([0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 }));
            orientation.turn(self.times(orientation.conjugate().turn(unit))).to_array()
        };
        // Symmetric: its columns are its rows.
        Self([0, 1, 2].map(column))
    }

    /// The inverse of a positive definite one.
    pub(super) fn inverse(&self) -> Self {
        let rows = self.0.map(Vector::from);
        // Each row of the inverse is normal to two rows of the matrix.
        let across = [rows[1].cross(rows[2]), rows[2].cross(rows[0]), rows[0].cross(rows[1])];
        let determinant = rows[0].dot(across[0]);
        Self(across.map(|row| (row * (1.0 / determinant)).to_array()))
    }
}
