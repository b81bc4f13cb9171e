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
    /// A value reference that no variable of FMI 3.0 has.
    #[error("{reference} is no value reference; they are 0 to {last}")]
    Reference {
        /// The reference.
        reference: u32,
        /// The last one there is.
        last: usize,
    },
    /// The time where a variable of the table is needed.
    #[error(
        "time: expected another variable of type {expected}, found the independent one, which fmi3GetFloat64 reads"
    )]
    Independent {
        /// The type of the function.
        expected: &'static str,
    },
    /// Arrays that do not fit the variables.
    #[error("{argument}: expected {needed} elements, as many as the variables have, found {given}")]
    Count {
        /// The argument.
        argument: &'static str,
        /// How many the variables have.
        needed: usize,
        /// How many there are.
        given: usize,
    },
    /// A function for what the unit does not have.
    #[error("expected a unit with {what}; this one has none")]
    Absent {
        /// What it lacks.
        what: &'static str,
    },
    /// A variable of another type.
    #[error("{name}: expected a variable of type {expected}, found {found}")]
    Type {
        /// Its name.
        name: String,
        /// Its type.
        found: &'static str,
        /// The type of the function.
        expected: &'static str,
    },
    /// A result that is not a number.
    #[error("{name} is {value}; its last finite value was before this time")]
    NoNumber {
        /// Its name.
        name: String,
        /// Its value.
        value: f64,
    },
    /// A derivative of an order that is not taken.
    #[error("{name}: expected {expected}, found order {order}")]
    Order {
        /// The order.
        order: i32,
        /// What was expected.
        expected: &'static str,
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
    #[error("expected a step up to the stop time, {stop} s, found one to {end} s")]
    Stop {
        /// End of the step \[s\].
        end: f64,
        /// Stop time \[s\].
        stop: f64,
    },
    /// A communication step of so many time steps that they would take days.
    #[error(
        "expected at most {most:.1e} time steps in one communication step, found {count:.1e}, days of computing in which \
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
    #[error("expected a state that this instance gave out, found another")]
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
    #[error("internal error: {message}; reset or free the instance")]
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
