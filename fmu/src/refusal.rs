//! Why a call was refused.

use crate::calls::Phase;
use crate::types::Status;
use cograin::interface::InterfaceError;
use cograin::simulation::RunError;

/// Why a call was refused. Nothing has changed then, but by [`Refusal::Panic`].
#[derive(Debug, thiserror::Error)]
pub(crate) enum Refusal {
    /// Not now.
    #[error("expected a call {}, found one {phase}", list(allowed))]
    Phase {
        /// Where the instance stands.
        phase: Phase,
        /// Where it may stand.
        allowed: &'static [Phase],
    },
    /// A call within a call, or from two threads at once.
    #[error("expected one call of this instance at a time, found another one that runs")]
    Busy,
    /// A null pointer.
    #[error("{argument}: expected an address, found null")]
    Null {
        /// The argument.
        argument: &'static str,
    },
    /// A text in another encoding.
    #[error("{argument}: expected UTF-8, found {text:?}")]
    Utf8 {
        /// The argument.
        argument: &'static str,
        /// What can be read of it.
        text: String,
    },
    /// An array that no memory holds.
    #[error("{argument}: expected an array that memory can hold, found {length} elements")]
    Length {
        /// The argument.
        argument: &'static str,
        /// Its length.
        length: usize,
    },
    /// The variable cannot be set so.
    #[error(transparent)]
    Interface(#[from] InterfaceError),
    /// A variable of another type.
    #[error("{reference} ({name}): expected a variable of type {expected}, found {found}")]
    Type {
        /// Its value reference.
        reference: u32,
        /// Its name.
        name: String,
        /// Its type.
        found: &'static str,
        /// The type of the function.
        expected: &'static str,
    },
    /// A result that is not a number.
    #[error("{reference} ({name}) is {value}; its last finite value was before this time")]
    NoNumber {
        /// Its value reference.
        reference: u32,
        /// Its name.
        name: String,
        /// Its value.
        value: f64,
    },
    /// A derivative of an order that is not taken.
    #[error("{reference} ({name}): expected {expected}, found order {order}")]
    Order {
        /// The order.
        order: i32,
        /// What was expected.
        expected: &'static str,
        /// The variable's value reference.
        reference: u32,
        /// Its name.
        name: String,
    },
    /// A time that is not a finite number.
    #[error("{argument}: expected {expected}, found {value} s")]
    Time {
        /// The argument.
        argument: &'static str,
        /// Its value \[s\].
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A tolerance that is not a finite number of 0 or above.
    #[error("tolerance: expected a finite number of 0 or above, found {value}")]
    Tolerance {
        /// Its value.
        value: f64,
    },
    /// A communication step from another time.
    #[error("communication point: expected the present time, {present} s, found {given} s")]
    Point {
        /// What was given \[s\].
        given: f64,
        /// The present time \[s\].
        present: f64,
    },
    /// A communication step beyond the experiment.
    #[error("expected a step up to the stop time of fmi2SetupExperiment, {stop} s, found one to {end} s")]
    Stop {
        /// End of the step \[s\].
        end: f64,
        /// Stop time \[s\].
        stop: f64,
    },
    /// A communication step of so many time steps that they would take days.
    #[error(
        "expected at most {most:.1e} time steps in one fmi2DoStep, found {count:.1e}, days of computing in which \
         the host cannot stop: {length} s in time steps of {step:.2e} s"
    )]
    TooMany {
        /// Length of the communication step \[s\].
        length: f64,
        /// Its number of time steps.
        count: f64,
        /// The time step \[s\].
        step: f64,
        /// The largest number.
        most: f64,
    },
    /// A handle that is not of this instance.
    #[error(
        "expected a state that fmi2GetFMUstate or fmi2DeSerializeFMUstate of this instance gave out, found another"
    )]
    Handle,
    /// A buffer of a wrong size.
    #[error("expected {needed} bytes, found {given}")]
    Size {
        /// Its size.
        given: usize,
        /// The right size.
        needed: usize,
    },
    /// Bytes that are not a state of this unit.
    #[error(transparent)]
    Blob(#[from] crate::saved::BlobError),
    /// A category of messages that is not declared.
    #[error("expected a category among {}, found {name:?}", categories())]
    Category {
        /// The name given.
        name: String,
    },
    /// A kind of status that is not there.
    #[error("status kind {kind} is not of this type")]
    Kind {
        /// The kind.
        kind: i32,
    },
    /// `fmi2CancelStep`
    #[error(
        "no communication step is under way: fmi2DoStep returns when it is done; call from another thread while it \
         runs"
    )]
    NothingToCancel,
    /// The scene cannot start so.
    #[error(transparent)]
    Start(RunError),
    /// The parameters make no scene.
    #[error("{error}")]
    Parameters {
        /// Why, in the words of the scene's mistakes.
        error: String,
    },
    /// The folder of the frames.
    #[error("run.frames: {0}")]
    Frames(cograin::results::Failure),
    /// The unit does not begin anew.
    #[error("{error}")]
    Reset {
        /// Why.
        error: String,
    },
    /// A communication step failed.
    #[error("{cause}; the state is that of {time} s")]
    Discarded {
        /// Why.
        cause: RunError,
        /// The beginning of the step \[s\].
        time: f64,
    },
    /// A panic.
    #[error("internal error: {message}; call fmi2Reset or fmi2FreeInstance")]
    Panic {
        /// Its message.
        message: String,
    },
}

impl Refusal {
    /// What the caller gets.
    pub(crate) fn status(&self) -> Status {
        match self {
            Self::Discarded { .. } => Status::Discard,
            _ => Status::Error,
        }
    }
}

/// Phases, one after the other.
fn list(phases: &[Phase]) -> String {
    phases.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ")
}

/// Names of the categories of messages.
fn categories() -> String {
    cograin::export::LOG_CATEGORIES.map(|(name, _)| name).join(", ")
}
