//! A thread that writes, so that the simulation does not wait for the disk.
//!
//! The queue is short: a disk slower than the simulation holds it back instead of filling the memory.

use super::error::OutputError;
use super::folder::Folder;
use super::job::Job;
use std::path::PathBuf;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

/// Jobs that may wait: a frame and what comes with it, and one more.
const QUEUE: usize = 4;

/// The thread, and the way to it.
pub(crate) struct Writer {
    /// Where jobs are handed over.
    jobs: Option<SyncSender<Job>>,
    /// The thread; none once its end is known.
    thread: Option<JoinHandle<Result<(), OutputError>>>,
    /// The folder, for messages.
    folder: PathBuf,
}

impl Writer {
    /// Starts the thread.
    pub(crate) fn start(folder: Arc<Mutex<Folder>>) -> Result<Self, OutputError> {
        let path = opened(&folder).path().to_owned();
        Self::with(path, move |job| opened(&folder).write(job))
    }

    /// Starts a thread that does jobs so, until there are no more or one fails.
    fn with(
        folder: PathBuf,
        write: impl FnMut(Job) -> Result<(), OutputError> + Send + 'static,
    ) -> Result<Self, OutputError> {
        let (jobs, queue) = sync_channel::<Job>(QUEUE);
        let thread = thread::Builder::new()
            .name("writer".to_owned())
            .spawn(move || queue.iter().try_for_each(write))
            .map_err(OutputError::at(&folder))?;
        Ok(Self { jobs: Some(jobs), thread: Some(thread), folder })
    }

    /// Hands over a job. An error is that of an earlier one.
    pub(crate) fn send(&mut self, job: Job) -> Result<(), OutputError> {
        match &self.jobs {
            Some(jobs) if jobs.send(job).is_ok() => Ok(()),
            _ => self.finish().and(Err(OutputError::Writer { path: self.folder.clone() })),
        }
    }

    /// Waits until all jobs so far are done. An error is that of one of them.
    pub(crate) fn wait(&mut self) -> Result<(), OutputError> {
        let (done, wait) = sync_channel(1);
        self.send(Job::Tell(done))?;
        match wait.recv() {
            Ok(()) => Ok(()),
            Err(_) => self.finish().and(Err(OutputError::Writer { path: self.folder.clone() })),
        }
    }

    /// Waits until everything is written. Called again, it has nothing more to say.
    pub(crate) fn finish(&mut self) -> Result<(), OutputError> {
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

/// The folder; a panic of the writer is reported where its end is waited for.
pub(crate) fn opened(folder: &Mutex<Folder>) -> MutexGuard<'_, Folder> {
    folder.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::mpsc::channel;
    use std::time::{Duration, Instant};

    /// A row of this time \[s\].
    fn row(time: usize) -> Job {
        Job::Row { time: time as f64, values: Vec::new() }
    }

    #[test]
    fn a_disk_that_stands_still_holds_the_run_back_and_keeps_no_more_than_the_queue() {
        let (gate, wait) = channel::<()>();
        let (written, sent) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicUsize::new(0)));
        let kept = Arc::clone(&written);
        let mut writer = Writer::with(PathBuf::new(), move |job| {
            // Until the gate is dropped.
            let _ = wait.recv();
            if let Job::Row { time, .. } = job {
                kept.lock().unwrap().push(time);
            }
            Ok(())
        })
        .unwrap();
        let count = Arc::clone(&sent);
        let run = thread::spawn(move || {
            for time in 0..50 {
                writer.send(row(time)).unwrap();
                count.fetch_add(1, Ordering::SeqCst);
            }
            writer.finish()
        });
        let held = || sent.load(Ordering::SeqCst) > QUEUE;
        let begun = Instant::now();
        while !held() && begun.elapsed() < Duration::from_secs(60) {
            thread::yield_now();
        }
        thread::sleep(Duration::from_millis(50));
        assert_eq!(sent.load(Ordering::SeqCst), QUEUE + 1, "one in hand, the others in the queue");
        drop(gate);
        run.join().unwrap().unwrap();
        assert_eq!(*written.lock().unwrap(), (0..50).map(f64::from).collect::<Vec<_>>());
    }

    #[test]
    fn who_waits_finds_all_jobs_done_or_is_told_why_not() {
        let (mut left, written) = (3, Arc::new(AtomicUsize::new(0)));
        let count = Arc::clone(&written);
        let mut writer = Writer::with(PathBuf::from("here"), move |job| {
            thread::sleep(Duration::from_millis(5));
            match job {
                Job::Tell(done) => drop(done.send(())),
                _ => drop(count.fetch_add(1, Ordering::SeqCst)),
            }
            left -= 1;
            if left >= 0 { Ok(()) } else { Err(OutputError::at(&PathBuf::from("full"))(std::io::Error::other("full"))) }
        })
        .unwrap();
        writer.send(row(0)).unwrap();
        writer.send(row(1)).unwrap();
        writer.wait().unwrap();
        assert_eq!(written.load(Ordering::SeqCst), 2);
        writer.send(row(2)).unwrap();
        let told = writer.wait().unwrap_err();
        assert!(told.to_string().contains("full"), "{told}");
    }

    #[test]
    fn a_job_that_fails_is_told_at_the_next_one_and_ends_the_writing() {
        let mut writer = Writer::with(PathBuf::from("here"), |_| {
            Err(OutputError::at(&PathBuf::from("history.csv"))(std::io::Error::other("full")))
        })
        .unwrap();
        let told = (0..50).find_map(|time| writer.send(row(time)).err()).unwrap();
        assert!(told.to_string().contains("history.csv"), "{told}");
        assert!(writer.finish().is_ok(), "told once");
    }
}
