//! Mass, inertia and support of a boundary, as the scene writes them.

use crate::base::quantity::{NonNegative, Triple};
use crate::laws::motion::Axis;
use nalgebra::Matrix3;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;

/// Springs or dashpots to the ground: one for each axis that is named.
pub(in crate::scene::file) type Supports = BTreeMap<Axis, NonNegative>;

/// A symmetric, positive definite matrix: three moments of inertia, or the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scene) struct Inertia(pub(in crate::scene) [[f64; 3]; 3]);

impl<'de> Deserialize<'de> for Inertia {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Three numbers, or three rows of them.
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            /// Moments about x, y and z; no products.
            Moments(Triple),
            /// Row by row.
            Rows([Triple; 3]),
        }
        /// What is expected.
        const EXPECTED: &str = "[xx, yy, zz] or three rows of a symmetric, positive definite matrix [kg m²]";
        let other = |_| D::Error::custom(format!("expected {EXPECTED}, found something else"));
        let rows = match Written::deserialize(deserializer).map_err(other)? {
            Written::Moments(Triple([x, y, z])) => [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]],
            Written::Rows(rows) => rows.map(|row| row.0),
        };
        if is_positive_definite(&rows) {
            Ok(Self(rows))
        } else {
            Err(D::Error::custom(format!("expected {EXPECTED}, found {rows:?}")))
        }
    }
}

/// Whether a matrix is symmetric and positive definite.
pub(in crate::scene::file) fn is_positive_definite(rows: &[[f64; 3]; 3]) -> bool {
    let matrix = Matrix3::from(*rows);
    matrix == matrix.transpose() && matrix.cholesky().is_some()
}
