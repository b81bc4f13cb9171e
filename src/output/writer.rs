//! A thread that writes, so that the simulation does not wait for the disk.
//!
//! The queue is short: a disk slower than the simulation holds it back instead of filling the memory.

use super::error::OutputError;
use super::folder::{Folder, Job};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

/// Jobs that may wait: a frame and what comes with it, and one more.
const QUEUE: usize = 4;

/// The thread, and the way to it.
pub(super) struct Writer {
    /// Where jobs are handed over.
    jobs: Option<SyncSender<Job>>,
    /// The thread; none once its end is known.
    thread: Option<JoinHandle<Result<(), OutputError>>>,
    /// The folder, for messages.
    folder: PathBuf,
}

impl Writer {
    /// Starts the thread.
    pub(super) fn start(folder: Folder) -> Result<Self, OutputError> {
        let path = folder.path().to_owned();
        let (jobs, queue) = sync_channel(QUEUE);
        let thread = thread::Builder::new()
            .name("writer".to_owned())
            .spawn(move || write_all(folder, &queue))
            .map_err(OutputError::at(&path))?;
        Ok(Self { jobs: Some(jobs), thread: Some(thread), folder: path })
    }

    /// Hands over a job. An error is that of an earlier one.
    pub(super) fn send(&mut self, job: Job) -> Result<(), OutputError> {
        match &self.jobs {
            Some(jobs) if jobs.send(job).is_ok() => Ok(()),
            _ => self.finish().and(Err(OutputError::Writer { path: self.folder.clone() })),
        }
    }

    /// Waits until everything is written. Called again, it has nothing more to say.
    pub(super) fn finish(&mut self) -> Result<(), OutputError> {
        self.jobs = None;
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(_)) => Err(OutputError::Writer { path: self.folder.clone() }),
            None => Ok(()),
        }
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        // Whoever wants to know how it ended has asked before.
        let _ = self.finish();
    }
}

/// Does jobs until there are no more or one fails.
fn write_all(mut folder: Folder, queue: &Receiver<Job>) -> Result<(), OutputError> {
    queue.iter().try_for_each(|job| folder.write(job))
}
