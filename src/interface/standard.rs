//! The editions of the standard that units speak.

use super::Type;

/// An edition of the Functional Mock-up Interface, FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standard {
    /// FMI 2.0: every variable is one number or text.
    Fmi2,
    /// FMI 3.0: variables may be arrays.
    Fmi3,
}

impl Type {
    /// Its name in an edition of the standard.
    pub fn name(self, standard: Standard) -> &'static str {
        match (self, standard) {
            (Self::Real, Standard::Fmi2) => "Real",
            (Self::Real, Standard::Fmi3) => "Float64",
            (Self::Integer, Standard::Fmi2) => "Integer",
            (Self::Integer, Standard::Fmi3) => "Int32",
            (Self::String, _) => "String",
        }
    }
}
