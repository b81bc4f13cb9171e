//! Numbers that a scene gives for each part of a bond.

use crate::base::quantity::{Checked, Range};
use serde::Deserialize;

/// One number for each part of a bond; what is absent is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartKeys<T> {
    /// Normal force.
    pub normal_force: Option<T>,
    /// Shear force.
    pub tangential_force: Option<T>,
    /// Torsion.
    pub normal_torque: Option<T>,
    /// Bending torque.
    pub tangential_torque: Option<T>,
}

impl<T: Copy> PartKeys<T> {
    /// In order, 0 where absent.
    pub fn parts(&self, number: impl Fn(T) -> f64) -> [f64; 4] {
        [self.normal_force, self.tangential_force, self.normal_torque, self.tangential_torque]
            .map(|part| part.map_or(0.0, &number))
    }
}

impl<T: Checked> PartKeys<T> {
    /// The numbers that each part takes.
    pub(crate) const RANGE: Range = T::RANGE;
}
