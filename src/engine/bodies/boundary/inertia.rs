//! Moments and products of inertia.

use crate::base::geometry::Quaternion;
use crate::base::number::Vector;
use nalgebra::{Matrix3, Vector3};

/// Adds that of a particle with this mass \[kg\] and moment of inertia \[kg m²\] at an arm \[m\].
pub(super) fn add_particle(sum: &mut Matrix3<f64>, mass: f64, inertia: f64, arm: Vector) {
    *sum += Matrix3::from_diagonal_element(inertia + mass * arm.dot(arm));
    let arm = Vector3::from(arm.to_array());
    *sum -= arm * mass * arm.transpose();
}

/// The product with a vector.
pub(super) fn times(matrix: &Matrix3<f64>, vector: Vector) -> Vector {
    let product: [f64; 3] = (matrix * Vector3::from(vector.to_array())).into();
    product.into()
}

/// What a matrix of a body is in global axes, where the body has this orientation.
pub(super) fn turned(matrix: &Matrix3<f64>, orientation: Quaternion) -> Matrix3<f64> {
    let turn = Matrix3::from_columns(&[0, 1, 2].map(|axis| {
        let unit = Vector::from([0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 }));
        Vector3::from(orientation.turn(unit).to_array())
    }));
    turn * matrix * turn.transpose()
}
