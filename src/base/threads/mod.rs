//! Threads: which thread works on which piece of a loop. The bits of the result do not depend on it.

mod context;
mod helpers;
mod sync;
mod workers;

pub(crate) use context::{CHUNK, Context};
pub use context::{LoopEvent, LoopWatch};
pub(crate) use helpers::Threads;
pub(crate) use workers::{Workers, are_many};
