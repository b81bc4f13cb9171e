//! Messages to the host.

use crate::refusal::Refusal;
use crate::types::{Callbacks, Environment, Status};
use crate::v3::LogFunction;
use cograin::export::LOG_CATEGORIES;
use std::ffi::CString;
use std::sync::atomic::{AtomicU32, Ordering};

/// A category of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Category {
    /// Refused calls.
    Error = 1,
    /// Communication steps that failed.
    Discard = 2,
    /// What is missing though the call was done.
    Warning = 4,
    /// What happens.
    Events = 8,
}

/// Place of `logAll` in [`LOG_CATEGORIES`]; the categories after it are bits 0, 1, 2 … of the mask.
const ALL: usize = 0;

/// Who takes messages.
pub(crate) enum Host {
    /// One that speaks FMI 2.0.
    Fmi2 {
        /// A copy: the host may free its own after `fmi2Instantiate`.
        callbacks: Callbacks,
        /// Name of the instance.
        name: CString,
    },
    /// One that speaks FMI 3.0.
    Fmi3 {
        /// Takes messages.
        logger: Option<LogFunction>,
        /// Handed to it as it is.
        environment: Environment,
    },
}

/// Where messages of an instance go.
pub(crate) struct Logger {
    /// Who takes them.
    host: Host,
    /// Categories that are wanted, as bits.
    wanted: AtomicU32,
}

// SAFETY: the environment pointer is only handed back to the host's own logger; FMI has the host see to it that
// its logger may be called from whatever thread calls the instance.
unsafe impl Send for Logger {}
// SAFETY: as above; nothing is written through the pointers.
unsafe impl Sync for Logger {}

impl Logger {
    /// A logger that reports errors, and everything if `verbose` is set.
    pub(crate) fn new(host: Host, verbose: bool) -> Self {
        let wanted = AtomicU32::new(if verbose { u32::MAX } else { 0 });
        Self { host, wanted }
    }

    /// Switches categories on or off; no names mean all.
    pub(crate) fn want(&self, on: bool, names: &[String]) -> Result<(), Refusal> {
        let mut mask = if names.is_empty() { u32::MAX } else { 0 };
        for name in names {
            match LOG_CATEGORIES.iter().position(|(known, _)| known == name) {
                Some(ALL) => mask = u32::MAX,
                Some(place) => mask |= 1 << (place - 1),
                None => return Err(Refusal::Category { name: name.clone() }),
            }
        }
        if on {
            self.wanted.fetch_or(mask, Ordering::Relaxed);
        } else {
            self.wanted.fetch_and(!mask, Ordering::Relaxed);
        }
        Ok(())
    }

    /// Reports that a function refused; whether or not it is wanted.
    pub(crate) fn refused(&self, function: &str, refusal: &Refusal) {
        let status = refusal.status();
        let category = if status == Status::Discard { Category::Discard } else { Category::Error };
        self.send(status, category, &format!("{function}: {refusal}"));
    }

    /// Reports what a function that was done left undone; whether or not it is wanted.
    pub(crate) fn warned(&self, function: &str, warning: &str) {
        self.send(Status::Warning, Category::Warning, &format!("{function}: {warning}"));
    }

    /// Reports that there is no instance.
    pub(crate) fn failed(&self, function: &str, reason: &str) {
        self.send(Status::Error, Category::Error, &format!("{function}: {reason}"));
    }

    /// Reports what happened, if it is wanted.
    pub(crate) fn event(&self, message: impl FnOnce() -> String) {
        if self.wanted.load(Ordering::Relaxed) & Category::Events as u32 != 0 {
            self.send(Status::Ok, Category::Events, &message());
        }
    }

    /// Hands a finished message to the host.
    fn send(&self, status: Status, category: Category, message: &str) {
        // some hosts run printf over the message: a percent sign would read arguments that are not there
        let message = message.replace('%', " percent").replace('\0', " ");
        let Ok(message) = CString::new(message) else { return };
        let category = match category {
            Category::Error => c"logStatusError",
            Category::Discard => c"logStatusDiscard",
            Category::Warning => c"logStatusWarning",
            Category::Events => c"logEvents",
        };
        let (category, message) = (category.as_ptr(), message.as_ptr());
        match &self.host {
            Host::Fmi2 { callbacks: Callbacks { logger: Some(logger), environment, .. }, name } => {
                // SAFETY: the host vouches for its logger; all strings end in a zero and live until it returns.
                unsafe { logger(*environment, name.as_ptr(), status, category, message) };
            }
            // SAFETY: as above.
            Host::Fmi3 { logger: Some(logger), environment } => unsafe {
                logger(*environment, status, category, message);
            },
            Host::Fmi2 { .. } | Host::Fmi3 { .. } => {}
        }
    }
}
