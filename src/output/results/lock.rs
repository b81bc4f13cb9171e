//! One folder, one run: a lock that ends with the process that holds it.
//!
//! The lock is an advisory one of the system on a hidden file, so it is gone when the process is, whatever ended it.
//! The file names the process that holds it. It is removed at the end; a run takes over one that a killed process left.

use super::error::OutputError;
use super::failure::{Failure, Refusal};
use super::files::is_at;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// File that is locked.
pub(crate) const LOCK: &str = ".cograin-lock";

/// What the file begins with.
const MARK: &str = "process ";

/// The lock of a folder, until it is dropped.
#[derive(Debug)]
pub(crate) struct FolderLock {
    /// The locked file.
    path: PathBuf,
    /// The process that took it. A child made by `fork` has a copy of this value, but the lock is not its own to give back.
    process: u32,
    /// What keeps it locked.
    file: File,
}

impl FolderLock {
    /// Locks a folder. If another process holds it, the refusal names that process and when it began.
    pub(crate) fn take(folder: &Path) -> Result<Self, Failure> {
        let path = folder.join(LOCK);
        let failed = |source: io::Error| OutputError::Write { path: path.clone(), source };
        loop {
            // What is not a file that a run left is somebody else's: links are not followed, files not emptied.
            match fs::symlink_metadata(&path) {
                Ok(about) if !about.is_file() => {
                    return Err(OutputError::not_own(&path, "a link or a folder", "a file of a run").into());
                }
                _ => {}
            }
            let mut file =
                OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path).map_err(failed)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let mut holder = String::new();
                    // Who cannot be read is told without a name.
                    let _ = file.read_to_string(&mut holder);
                    return Err(Refusal::InUse { folder: folder.to_owned(), holder: name(&holder) }.into());
                }
                // A file system without locks: nobody can be kept out, and nobody is.
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(error)) => return Err(failed(error).into()),
            }
            // Whoever held it before may have removed the file after it was opened here.
            if !is_at(&file, &path).map_err(failed)? {
                continue;
            }
            let mut earlier = Vec::new();
            (&file).take(MARK.len() as u64).read_to_end(&mut earlier).map_err(failed)?;
            if !MARK.as_bytes().starts_with(&earlier) {
                return Err(OutputError::not_own(&path, "a file of another kind", "a lock that a run left").into());
            }
            file.set_len(0).and_then(|()| file.rewind()).map_err(failed)?;
            let begun = humantime::format_rfc3339_seconds(SystemTime::now());
            writeln!(file, "{MARK}{}, started {begun}", std::process::id()).map_err(failed)?;
            return Ok(Self { path, process: std::process::id(), file });
        }
    }

    /// Refuses a folder that no longer is the one that was locked.
    pub(crate) fn expect_in_place(&self) -> Result<(), OutputError> {
        let folder = self.path.parent().unwrap_or(&self.path);
        match is_at(&self.file, &self.path) {
            Ok(true) => Ok(()),
            Ok(false) => Err(OutputError::Moved { folder: folder.to_owned() }),
            Err(error) => Err(OutputError::at(folder)(error)),
        }
    }

    /// Whether this process took it.
    pub(crate) fn is_own(&self) -> bool {
        self.process == std::process::id()
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        if !self.is_own() {
            return;
        }
        // A file that stays locks nobody out.
        let _ = fs::remove_file(&self.path);
    }
}

/// The process that holds the lock, in a message.
fn name(holder: &str) -> String {
    let holder = holder.trim();
    if holder.is_empty() { "another process".to_owned() } else { holder.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::scratch::Scratch;

    #[test]
    fn a_folder_is_locked_once_and_free_again_afterwards() {
        let folder = Scratch::new();
        // What a killed process leaves locks nobody out.
        fs::write(folder.join(LOCK), "process 1, started long ago").unwrap();
        let held = FolderLock::take(&folder).unwrap();
        let told = FolderLock::take(&folder).unwrap_err().to_string();
        assert!(told.contains(&format!("process {}, started 2", std::process::id())), "{told}");
        drop(held);
        assert!(!folder.join(LOCK).exists());
        drop(FolderLock::take(&folder).unwrap());
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_lock_is_neither_followed_nor_emptied() {
        let folder = Scratch::new();
        fs::write(folder.join("mine.txt"), "mine").unwrap();
        std::os::unix::fs::symlink("mine.txt", folder.join(LOCK)).unwrap();
        let told = FolderLock::take(&folder).unwrap_err().to_string();
        assert!(told.contains("expected a file of a run, found a link"), "{told}");
        fs::remove_file(folder.join(LOCK)).unwrap();
        fs::hard_link(folder.join("mine.txt"), folder.join(LOCK)).unwrap();
        let told = FolderLock::take(&folder).unwrap_err().to_string();
        assert!(told.contains("expected a lock that a run left"), "{told}");
        assert_eq!(fs::read_to_string(folder.join("mine.txt")).unwrap(), "mine");
    }
}
