//! The threads of one simulation.

use super::helpers::{Dismissal, Team};
use std::thread::JoinHandle;

/// Fewer particles than this are not worth a second thread.
const FEW: usize = 2000;

/// A thread pool of its own, so that two simulations in one process do not disturb each other; joined when dropped.
pub(crate) struct Workers {
    /// The pool of the helpers; none where one thread works.
    pool: Option<rayon::ThreadPool>,
    /// Its threads.
    handles: Vec<JoinHandle<()>>,
}

impl Workers {
    /// As many threads as asked for, or as the machine offers; one for a few particles.
    pub(crate) fn new(threads: Option<usize>, particles: usize) -> Self {
        let alone = Self { pool: None, handles: Vec::new() };
        let offered = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = threads.filter(|&threads| threads > 0).unwrap_or_else(offered);
        if threads < 2 || particles < FEW {
            return alone;
        }
        let mut handles = Vec::new();
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads - 1)
            .spawn_handler(|thread| {
                handles.push(std::thread::Builder::new().name("cograin".into()).spawn(|| thread.run())?);
                Ok(())
            })
            .build();
        match pool {
            Ok(pool) => Self { pool: Some(pool), handles },
            Err(_) => alone,
        }
    }

    /// How many threads work.
    pub(crate) fn count(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.current_num_threads() + 1)
    }

    /// Does work to which helpers come, if there are any.
    pub(crate) fn run<T>(&self, work: impl FnOnce(Option<&Team>) -> T) -> T {
        let Some(pool) = &self.pool else { return work(None) };
        let team = &Team::of(self.count());
        pool.in_place_scope(|scope| {
            for place in 1..self.count() {
                scope.spawn(move |_| team.help(place));
            }
            let _dismissal = Dismissal(team);
            work(Some(team))
        })
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        drop(self.pool.take());
        for handle in self.handles.drain(..) {
            // A worker that panicked has told so already, where its work was waited for.
            drop(handle.join());
        }
    }
}
