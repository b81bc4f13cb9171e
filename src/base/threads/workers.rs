//! The threads of one simulation.

use super::helpers::Threads;
use std::cell::Cell;
use std::marker::PhantomData;
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};

/// Fewer particles than this are not worth a second thread (`docs/decisions/361`).
const FEW: usize = 2000;

/// Whether so many particles are worth helpers.
pub(crate) fn are_many(particles: usize) -> bool {
    particles >= FEW
}

/// Threads of its own, so that two simulations in one process do not disturb each other; joined when dropped.
#[derive(Default)]
pub(crate) struct Workers {
    /// The helpers; none where one thread works.
    helpers: Option<Helpers>,
    /// They work for one thread at a time: two may not share this.
    alone: PhantomData<Cell<()>>,
}

/// The first thread's helpers.
struct Helpers {
    /// What they are called to work by.
    threads: Arc<Threads>,
    /// Their handles.
    handles: Vec<JoinHandle<()>>,
    /// The process that they run in. A child made by `fork` has a copy of everything but them.
    process: u32,
}

impl Helpers {
    /// Starts the helpers of so many threads; none where the system refuses one of them.
    fn start(count: usize) -> Option<Self> {
        let threads = Arc::new(Threads::of(count));
        let mut helpers = Self { threads, handles: Vec::new(), process: std::process::id() };
        for place in 1..count {
            let threads = Arc::clone(&helpers.threads);
            helpers.handles.push(Builder::new().name("cograin".into()).spawn(move || threads.help(place)).ok()?);
        }
        Some(helpers)
    }

    /// Whether they run in this process.
    fn are_here(&self) -> bool {
        self.process == std::process::id()
    }
}

impl Drop for Helpers {
    fn drop(&mut self) {
        let here = self.are_here();
        if here {
            self.threads.dismiss();
        }
        for handle in self.handles.drain(..) {
            if here {
                // A helper that panicked has told so already, where its work was waited for.
                drop(handle.join());
            } else {
                // Whoever waited for a thread of another process would wait for ever.
                std::mem::forget(handle);
            }
        }
    }
}

impl Workers {
    /// As many threads as asked for, or as the machine offers; one for a few particles.
    pub(crate) fn new(threads: Option<usize>, particles: usize) -> Self {
        let offered = || std::thread::available_parallelism().map_or(1, usize::from);
        if !are_many(particles) {
            return Self::default();
        }
        let threads = threads.filter(|&threads| threads > 0).unwrap_or_else(offered);
        Self { helpers: if threads < 2 { None } else { Helpers::start(threads) }, alone: PhantomData }
    }

    /// How many threads work.
    pub(crate) fn count(&self) -> usize {
        self.helpers.as_ref().map_or(1, |helpers| helpers.threads.count())
    }

    /// Does work to which helpers come, if there are any. In a child made by `fork` they are started anew, or, where
    /// that is refused, one thread does all: the same bits.
    pub(crate) fn run<T>(&mut self, work: impl FnOnce(Option<&Threads>) -> T) -> T {
        if self.helpers.as_ref().is_some_and(|helpers| !helpers.are_here()) {
            self.helpers = Helpers::start(self.count());
        }
        self.lend(work)
    }

    /// The same, where helpers that another process has are not started anew. Work calls no other work of the same helpers.
    pub(crate) fn lend<T>(&self, work: impl FnOnce(Option<&Threads>) -> T) -> T {
        work(self.helpers.as_ref().filter(|helpers| helpers.are_here()).map(|helpers| &*helpers.threads))
    }
}
