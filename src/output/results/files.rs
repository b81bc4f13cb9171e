//! Files that are whole at any time, also for one who looks after a crash.

use super::UNFINISHED;
use super::error::{OutputError, ResumeError, TakeOverError};
use super::failure::Refusal;
use crate::base::files;
use crate::engine::simulation::{Description, Simulation};
use crate::engine::state::snapshot::SnapshotError;
use crate::engine::state::{State, StateFault};
use crate::scene::packing::made::Packed;
use crate::scene::{Packings, Scene};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// Whether a file must be on the disk, or may still be in the system's memory, when it has its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Durability {
    /// It outlives the program.
    Process,
    /// It outlives the machine.
    Machine,
}

/// Writes a file under another name and renames it: a reader finds either the old one or the new one, complete.
pub(crate) fn write_whole(path: &Path, bytes: &[u8], durability: Durability) -> Result<(), OutputError> {
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
        // What a run that was broken off left there, or a link, which is not followed.
        match fs::remove_file(&unfinished) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        let mut file = File::create_new(&unfinished)?;
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
pub(crate) fn sync(path: &Path) -> Result<(), OutputError> {
    // Windows asks for the right to write.
    OpenOptions::new().write(true).open(path).and_then(|file| file.sync_all()).map_err(OutputError::at(path))
}

/// Whether a path still leads to this open file, and through no link.
#[cfg(unix)]
pub(crate) fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let open = file.metadata()?;
    match fs::symlink_metadata(path) {
        Ok(named) => Ok((named.dev(), named.ino()) == (open.dev(), open.ino())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// Whether a path still leads to this open file: elsewhere an open file cannot be removed.
#[cfg(not(unix))]
pub(crate) fn is_at(_: &File, _: &Path) -> io::Result<bool> {
    Ok(true)
}

/// Whether two paths lead to one file.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    let same = |path: &Path| path.canonicalize().ok();
    let Some(there) = same(one).filter(|_| same(other).is_some()) else { return false };
    Some(there) == same(other) || is_same_file(one, other)
}

/// Whether two paths are two names of one file.
#[cfg(unix)]
fn is_same_file(one: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let of = |path: &Path| fs::metadata(path).ok().map(|about| (about.dev(), about.ino()));
    of(one).is_some() && of(one) == of(other)
}

/// Whether two paths are two names of one file, which is not looked at elsewhere.
#[cfg(not(unix))]
fn is_same_file(_: &Path, _: &Path) -> bool {
    false
}

/// What happens to a file that is where another one is to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EarlierFile {
    /// It stays, and the command is refused.
    Keep,
    /// It is replaced.
    Replace,
}

/// Refuses a place where no file can be written, a file that the command reads itself, and one that is there and is not to be replaced.
pub fn claim_file(path: &Path, earlier: EarlierFile, read: &[PathBuf]) -> Result<(), Refusal> {
    if let Some(own) = read.iter().find(|own| is_same(own, path)) {
        return Err(Refusal::Read { path: path.to_owned(), read: own.clone() });
    }
    expect_a_file(path)?;
    match fs::symlink_metadata(path) {
        Ok(_) if earlier == EarlierFile::Keep => Err(Refusal::Exists { path: path.to_owned() }),
        _ => Ok(()),
    }
}

/// Refuses a place where no file can be written: a folder, a device or a pipe, also behind a link, and a name in no folder.
pub(crate) fn expect_a_file(path: &Path) -> Result<(), Refusal> {
    let not = |found| Err(Refusal::NotAFile { path: path.to_owned(), found });
    match fs::metadata(path) {
        Ok(about) if about.is_dir() => return not("a folder"),
        Ok(about) if !about.is_file() => return not("a device or a pipe"),
        _ => {}
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if folder.is_dir() { Ok(()) } else { Err(Refusal::NoFolder { folder: folder.to_owned() }) }
}

/// Refuses to replace what an earlier attempt to settle left, or what somebody else has put there under its name.
pub(crate) fn claim_unsettled(path: &Path, earlier: EarlierFile) -> Result<(), Refusal> {
    expect_a_file(path)?;
    let Ok(mut file) = File::open(path) else { return Ok(()) };
    let mut beginning = [0; KIND.len()];
    let is_own = file.read_exact(&mut beginning).is_ok() && is_checkpoint(&beginning);
    match earlier {
        _ if !is_own => Err(Refusal::NotUnsettled { path: path.to_owned() }),
        EarlierFile::Keep => Err(Refusal::Unsettled { path: path.to_owned() }),
        EarlierFile::Replace => Ok(()),
    }
}

/// Refuses a folder of results in which a file that the command reads stands under the name of a result.
pub fn refuse_to_replace(folder: &Path, read: &[PathBuf]) -> Result<(), Refusal> {
    let results = if folder.is_dir() { super::replacement::results(folder).unwrap_or_default() } else { Vec::new() };
    match results.iter().find_map(|file| Some((file, read.iter().find(|read| is_same(file, read))?))) {
        Some((path, read)) => Err(Refusal::Read { path: path.clone(), read: read.clone() }),
        None => Ok(()),
    }
}

/// The name a file has while it is being written.
fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().map_or_else(OsString::new, OsString::from);
    name.push(".");
    name.push(UNFINISHED);
    path.with_file_name(name)
}

/// Makes a new name in a folder last, where the system lets folders be opened.
pub(crate) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

/// Whether a file is a checkpoint, of any format.
pub(crate) fn is_checkpoint(beginning: &[u8]) -> bool {
    beginning.starts_with(KIND) || beginning.starts_with(b"cograin\0")
}

/// What a checkpoint begins with; the number is that of its format.
const HEAD: &str = "cograin checkpoint 2\n";

/// What every checkpoint begins with, whatever its format.
const KIND: &[u8] = b"cograin checkpoint ";

/// A state and the scene that it is of.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    /// Where it stands.
    path: PathBuf,
    /// The scene.
    pub scene: Description,
    /// The state as bytes.
    bytes: Vec<u8>,
}

/// Writes a state to a file that is whole at any time: a line that says what it is, the scene as a line of JSON after its
/// checksum, random packings, the state.
pub fn write_checkpoint(path: &Path, state: &State, scene: &Scene, scene_name: &str) -> Result<(), OutputError> {
    write_run_checkpoint(path, state, (scene, scene_name), None)
}

/// The same of a run with a table of inputs of this digest.
pub(crate) fn write_run_checkpoint(
    path: &Path,
    state: &State,
    (scene, scene_name): (&Scene, &str),
    inputs: Option<u64>,
) -> Result<(), OutputError> {
    let description = Description::of(scene, scene_name, state.clock.time).with_inputs(inputs);
    // Plain numbers and strings: writing them to memory has no way to fail.
    let description = serde_json::to_string(&description).unwrap_or_default();
    let checksum = xxh3_64(description.as_bytes());
    write_whole_by(path, Durability::Machine, |file| {
        let mut buffered = BufWriter::new(file);
        writeln!(buffered, "{HEAD}{checksum:016x} {description}")?;
        Packed::write(scene, &mut buffered)?;
        state.write_to(scene.fingerprint, &mut buffered)?;
        buffered.flush()
    })
}

/// The scene that a line describes, behind its checksum.
fn described(line: &[u8]) -> Option<Description> {
    let (sum, text) = std::str::from_utf8(line).ok()?.split_once(' ')?;
    (u64::from_str_radix(sum, 16) == Ok(xxh3_64(text.as_bytes()))).then(|| serde_json::from_str(text).ok())?
}

impl Checkpoint {
    /// Reads a checkpoint of any scene.
    pub fn read(path: &Path) -> Result<Self, ResumeError> {
        let at = path.to_owned();
        let bytes = files::read(path).map_err(|source| ResumeError::Read { path: at.clone(), source })?;
        let Some(rest) = bytes.strip_prefix(HEAD.as_bytes()) else {
            return Err(if is_checkpoint(&bytes) {
                ResumeError::Format { path: at }
            } else {
                ResumeError::Foreign { path: at }
            });
        };
        let line = rest.split(|byte| *byte == b'\n').next().unwrap_or_default();
        let damaged = || ResumeError::Snapshot { path: at.clone(), source: SnapshotError::Damaged };
        let scene = described(line).ok_or_else(damaged)?;
        let packings = scene.packings.iter().map(Packed::bytes).fold(0, u64::saturating_add);
        let from = usize::try_from(packings).ok().and_then(|length| length.checked_add(line.len() + 1));
        let bytes = from.and_then(|from| rest.get(from..)).ok_or_else(damaged)?.to_vec();
        Ok(Self { path: at, scene, bytes })
    }

    /// The random packings of the scene of a checkpoint; none where it cannot be read, which is told where it is read as a whole.
    pub fn packings(path: &Path) -> Packings {
        let read = || -> io::Result<Packings> {
            let (mut file, mut line) = (BufReader::new(files::open(path)?), Vec::new());
            // A file that is no checkpoint may have no end of a line.
            let mut beginning = Vec::new();
            file.by_ref().take(HEAD.len() as u64).read_to_end(&mut beginning)?;
            if beginning != HEAD.as_bytes() {
                return Ok(Packings::default());
            }
            file.read_until(b'\n', &mut line)?;
            let told =
                described(line.strip_suffix(b"\n").unwrap_or(&line)).map_or_else(Vec::new, |scene| scene.packings);
            Packings::read(&told, file)
        };
        read().unwrap_or_default()
    }

    /// The state, if it is of this very scene.
    pub fn state_of(&self, scene: &Scene) -> Result<State, ResumeError> {
        State::from_bytes(&self.bytes, scene.fingerprint).map_err(|source| match source {
            SnapshotError::Scene { .. } => self.other_scene(scene),
            source => ResumeError::Snapshot { path: self.path.clone(), source },
        })
    }

    /// The same, of a run with the table of inputs of this digest.
    pub(crate) fn state_of_run(&self, scene: &Scene, inputs: Option<u64>) -> Result<State, ResumeError> {
        let state = self.state_of(scene)?;
        // What is at rest at time 0 has not seen a table.
        if self.scene.inputs != inputs && (self.scene.time > 0.0 || self.scene.inputs.is_some()) {
            let (found, path) = (self.scene.inputs, self.path.clone());
            return Err(ResumeError::OtherInputs { path, found, expected: inputs });
        }
        Ok(state)
    }

    /// Refuses a scene that goes on in another way than that of the checkpoint.
    pub(crate) fn expect_course_of(&self, scene: &Scene) -> Result<(), ResumeError> {
        if self.scene.goes_on_as(scene) { Ok(()) } else { Err(self.other_scene(scene)) }
    }

    /// It is of another scene.
    fn other_scene(&self, scene: &Scene) -> ResumeError {
        ResumeError::OtherScene {
            path: self.path.clone(),
            scene: self.scene.scene.clone(),
            program: self.scene.program.clone(),
            time: self.scene.time,
            differs: self.scene.differing_parts(scene),
            goes_on: self.scene.goes_on_as(scene),
        }
    }

    /// A scene in this state, which need not be that of the checkpoint.
    pub fn taken_over(&self, scene: &Arc<Scene>) -> Result<TakenOver, TakeOverError> {
        let state = State::from_bytes(&self.bytes, self.scene.fingerprint)
            .map_err(|source| ResumeError::Snapshot { path: self.path.clone(), source })?;
        if self.scene.goes_on_as(scene) {
            let simulation = Simulation::going_on(Arc::clone(scene), state, &self.scene)
                .map_err(|fault| ResumeError::Snapshot { path: self.path.clone(), source: fault.into() })?;
            return Ok(TakenOver { simulation, left_behind: Vec::new(), goes_on: true });
        }
        let not = |fault: StateFault| ResumeError::Snapshot { path: self.path.clone(), source: fault.into() };
        self.scene.check(&state).map_err(not)?;
        let (simulation, left_behind) = Simulation::taken_over(Arc::clone(scene), &state, &self.scene)?;
        Ok(TakenOver { simulation, left_behind, goes_on: false })
    }
}

/// A scene in the state of a checkpoint.
pub struct TakenOver {
    /// The scene in motion.
    pub simulation: Simulation,
    /// What could not be taken over, in words.
    pub left_behind: Vec<String>,
    /// Whether the scene differs from that of the checkpoint in its end and its outputs at most: it goes on bit for bit.
    pub goes_on: bool,
}

/// Reads a state that was written for the same scene.
pub fn read_checkpoint(path: &Path, scene: &Scene) -> Result<State, ResumeError> {
    Checkpoint::read(path)?.state_of(scene)
}
