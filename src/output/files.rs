//! Files that are whole at any time, also for one who looks after a crash.

use super::UNFINISHED;
use super::error::{OutputError, ResumeError};
use crate::state::State;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Whether a file must be on the disk, or may still be in the system's memory, when it has its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Durability {
    /// It outlives the program.
    Process,
    /// It outlives the machine.
    Machine,
}

/// Writes a file under another name and renames it: whoever looks finds the old one or the new one, whole.
pub(super) fn write_whole(path: &Path, bytes: &[u8], durability: Durability) -> Result<(), OutputError> {
    write_whole_by(path, durability, |file| file.write_all(bytes))
}

/// The same, with a function that writes the contents.
fn write_whole_by(
    path: &Path,
    durability: Durability,
    contents: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), OutputError> {
    let unfinished = unfinished(path);
    let write = || -> io::Result<()> {
        let mut file = File::create(&unfinished)?;
        contents(&mut file)?;
        if durability == Durability::Machine {
            file.sync_all()?;
        }
        drop(file);
        fs::rename(&unfinished, path)?;
        if durability == Durability::Machine { sync_folder(path) } else { Ok(()) }
    };
    write().map_err(|source| {
        // What is left of it helps nobody; the first error is the one to tell.
        let _ = fs::remove_file(&unfinished);
        OutputError::Write { path: path.to_owned(), source }
    })
}

/// Makes sure that a file written earlier is on the disk.
pub(super) fn sync(path: &Path) -> Result<(), OutputError> {
    File::open(path).and_then(|file| file.sync_all()).map_err(OutputError::at(path))
}

/// The name a file has while it is being written.
fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().map_or_else(OsString::new, OsString::from);
    name.push(".");
    name.push(UNFINISHED);
    path.with_file_name(name)
}

/// Makes a new name in a folder last, where the system lets folders be opened.
pub(super) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

/// Writes a state to a file that is whole at any time.
pub fn write_checkpoint(path: &Path, state: &State, scene_fingerprint: u64) -> Result<(), OutputError> {
    write_whole_by(path, Durability::Machine, |file| {
        let mut buffered = BufWriter::new(file);
        state.write_to(scene_fingerprint, &mut buffered)?;
        buffered.flush()
    })
}

/// Reads a state that was written for the same scene.
pub fn read_checkpoint(path: &Path, scene_fingerprint: u64) -> Result<State, ResumeError> {
    let bytes = fs::read(path).map_err(|source| ResumeError::Read { path: path.to_owned(), source })?;
    State::from_bytes(&bytes, scene_fingerprint)
        .map_err(|source| ResumeError::Snapshot { path: path.to_owned(), source })
}
