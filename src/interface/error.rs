//! Why a variable was not set.

use crate::engine::simulation::{NoDerivative, TuneError};

/// Why a variable was not set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InterfaceError {
    /// There is no such variable.
    #[error("{index} is not a variable; the variables are 0 to {last}")]
    Unknown {
        /// The index asked for.
        index: usize,
        /// The last index there is.
        last: usize,
    },
    /// It is neither input nor parameter.
    #[error("{name} is an output; only inputs and parameters may be set")]
    Output {
        /// Its name.
        name: String,
    },
    /// A parameter does not take the value.
    #[error("{name}: {refusal}")]
    Range {
        /// Its name.
        name: String,
        /// What was found and what was expected, as the scene says it.
        refusal: String,
    },
    /// A parameter is not an input.
    #[error("{name} is a parameter; only inputs have rates")]
    NoRate {
        /// Its name.
        name: String,
    },
    /// An input that has no second derivative.
    #[error(
        "{name}: expected order 1, or the displacement along an axis of a boundary with input = \
         \"quadratic\", found order 2"
    )]
    NoAcceleration {
        /// Its name.
        name: String,
    },
    /// A parameter that can no longer be changed.
    #[error("{name} is a fixed parameter; it may be set until the initialisation mode ends")]
    Fixed {
        /// Its name.
        name: String,
    },
    /// A derivative of what is not a continuous output.
    #[error("expected an output that changes continuously, found {name}, which has no derivative")]
    NoDerivative {
        /// Its name.
        name: String,
    },
    /// A derivative with respect to what is not an input.
    #[error("expected an input to take derivatives by, found {name}")]
    NoInput {
        /// Its name.
        name: String,
    },
    /// A derivative that is no number.
    #[error("{name}: expected a number with and without displaced inputs, found none")]
    NotKnown {
        /// Its name.
        name: String,
    },
    /// The rate of an output that has none.
    #[error(
        "expected force, moment, mean_force, mean_moment or displacement of a boundary, found {name}, which has no rate"
    )]
    NoOutputRate {
        /// Its name.
        name: String,
    },
    /// The moment has no derivatives.
    #[error(transparent)]
    Difference(#[from] NoDerivative),
    /// Values of tunable parameters that contradict each other.
    #[error(transparent)]
    Tune(#[from] TuneError),
    /// The value is not a finite number.
    #[error("{name}: expected a finite number, found {value}")]
    NotFinite {
        /// Its name.
        name: String,
        /// The value given.
        value: f64,
    },
}
