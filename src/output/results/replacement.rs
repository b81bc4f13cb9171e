//! How a run's first files take the place of an earlier run's: all of them or none, whatever ends the program.
//!
//! A run begins in a hidden folder inside the folder of its results. When its first files are there and on the disk, the
//! hidden folder gets another name: from this one moment on the new run stands. What is left to do, removing the earlier
//! run's files and putting the new ones in their place, is done by the next run that opens the folder, if need be.
//!
//! | hidden folder        | valid results                  | what the next run does with it    |
//! |----------------------|--------------------------------|-----------------------------------|
//! | `.cograin-new`       | the earlier run, whole         | removes it                        |
//! | `.cograin-replacing` | the new run                    | removes the earlier run's results |
//! | `.cograin-moving`    | the new run, the other is gone | puts the new files in their place |

use super::error::OutputError;
use super::files::{is_checkpoint, sync_folder};
use super::{
    BREAKAGE, CHECKPOINT, HISTOGRAMS, HISTORY, IMPACTS, SUMMARY, UNFINISHED, collection, frame_number, impacts,
    is_collection,
};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Where a run begins.
const NEW: &str = ".cograin-new";

/// The same, once the new run stands.
const REPLACING: &str = ".cograin-replacing";

/// The same, once the earlier run's results are gone.
const MOVING: &str = ".cograin-moving";

/// What every summary begins with.
const SUMMARY_MARK: &[u8] = b"{\n  \"program\": \"cograin ";

/// Bytes that tell what a file is.
const BEGINNING: u64 = 256;

/// Makes the empty folder in which a run begins.
pub(crate) fn begin(folder: &Path) -> Result<PathBuf, OutputError> {
    let new = folder.join(NEW);
    remove_folder(&new)?;
    fs::create_dir_all(&new).map_err(OutputError::at(&new))?;
    Ok(new)
}

/// Lets the files of the run that has begun take the place of all results. They are on the disk already.
pub(crate) fn finish(folder: &Path) -> Result<(), OutputError> {
    rename(folder, NEW, REPLACING)?;
    take_up(folder)
}

/// Ends a replacement that was broken off; one that had not come to its decisive moment is undone. Nothing is followed
/// through a link, and nothing is removed or overwritten that no run has written.
pub(crate) fn take_up(folder: &Path) -> Result<(), OutputError> {
    remove_folder(&folder.join(NEW))?;
    let replacing = folder.join(REPLACING);
    if is_own_folder(&replacing)? {
        // A run's first files are whole before the folder gets this name.
        if kind_of(&replacing.join(CHECKPOINT))? != Kind::Own {
            return Err(OutputError::not_own(&replacing, "others", "the first files of a run"));
        }
        for path in last_first(own_results(folder)?) {
            fs::remove_file(&path).map_err(OutputError::at(&path))?;
        }
        rename(folder, REPLACING, MOVING)?;
    }
    let moving = folder.join(MOVING);
    if is_own_folder(&moving)? {
        for path in last_first(own_results(&moving)?) {
            let place = folder.join(path.file_name().unwrap_or_default());
            if fs::symlink_metadata(&place).is_ok() {
                return Err(OutputError::not_own(&place, "a file", "no file where the run's own is to stand"));
            }
            fs::rename(&path, &place).map_err(OutputError::at(&place))?;
        }
        fs::remove_dir(&moving).map_err(OutputError::at(&moving))?;
    }
    Ok(())
}

/// The files in a folder that have names of results, also those that are not finished.
pub(crate) fn results(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(OutputError::at(folder))? {
        let entry = entry.map_err(OutputError::at(folder))?;
        if entry.file_name().to_str().is_some_and(is_result) && !entry.path().is_dir() {
            found.push(entry.path());
        }
    }
    found.sort();
    Ok(found)
}

/// Those of them that a run has written.
pub(crate) fn own_results(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let mut own = Vec::new();
    for path in results(folder)? {
        if kind_of(&path)? == Kind::Own {
            own.push(path);
        }
    }
    Ok(own)
}

/// Results in an order in which some may go and the rest is still known as a run's, whatever ends the program: frames from the last one
/// on, then the list by which they are known, whose name stands before theirs.
fn last_first(results: Vec<PathBuf>) -> impl Iterator<Item = PathBuf> {
    results.into_iter().rev()
}

/// The first file with the name of a result that no run has written, if there is any.
pub(crate) fn foreign_result(folder: &Path) -> Result<Option<String>, OutputError> {
    for path in results(folder)? {
        if kind_of(&path)? == Kind::Foreign {
            return Ok(path.file_name().map(|name| name.to_string_lossy().into_owned()));
        }
    }
    Ok(None)
}

/// Who has written a file with the name of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A run.
    Own,
    /// Somebody else.
    Foreign,
    /// Nobody: there is none.
    Absent,
}

/// Who has written a file with the name of a result, as its first bytes show; frames are those that a run's own list of them, the
/// `.pvd` beside them, names, and those that follow the last one named.
fn kind_of(path: &Path) -> Result<Kind, OutputError> {
    let about = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Kind::Absent),
        about => about.map_err(OutputError::at(path))?,
    };
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let beginning = || -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(path)?.take(BEGINNING).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let begins = |own: &dyn Fn(&[u8]) -> bool| beginning().map(|bytes| own(&bytes)).map_err(OutputError::at(path));
    let own = about.is_file()
        && match name {
            _ if name.ends_with(&format!(".{UNFINISHED}")) => true,
            HISTORY | BREAKAGE | IMPACTS => {
                begins(&|bytes| bytes.starts_with(b"time,") || bytes.starts_with(b"time\n"))?
            }
            HISTOGRAMS => begins(&|bytes| bytes.starts_with(impacts::HISTOGRAM_HEAD.as_bytes()))?,
            SUMMARY => begins(&|bytes| bytes.starts_with(SUMMARY_MARK))?,
            CHECKPOINT => begins(&is_checkpoint)?,
            _ if is_collection(name) => begins(&|bytes| bytes.starts_with(collection::HEAD.as_bytes()))?,
            _ => is_listed(path, name),
        };
    Ok(if own { Kind::Own } else { Kind::Foreign })
}

/// Whether a frame stands in the list of frames of its kind, or follows it there.
fn is_listed(path: &Path, name: &str) -> bool {
    let Some((kind, number)) = name.rsplit_once('_').zip(frame_number(name)) else { return false };
    let Ok(list) = fs::read_to_string(path.with_file_name(super::collection_name(kind.0))) else { return false };
    let frame = |number: usize| super::frame_name(kind.0, number);
    // A run that was broken off may have left frames that its list does not name yet: they follow each other from the last one named on.
    let known = |number: &usize| list.contains(&format!("file=\"{}\"", frame(*number)));
    let mut before = (0..=number).rev().take_while(|before| path.with_file_name(frame(*before)).exists());
    list.starts_with(collection::HEAD) && (before.any(|before| known(&before) || before == 0))
}

/// Whether a file has a name that runs give.
fn is_result(name: &str) -> bool {
    let name = name.strip_suffix(&format!(".{UNFINISHED}")).unwrap_or(name);
    [HISTORY, BREAKAGE, IMPACTS, HISTOGRAMS, SUMMARY, CHECKPOINT].contains(&name)
        || frame_number(name).is_some()
        || is_collection(name)
}

/// Gives a hidden folder another name, for good.
fn rename(folder: &Path, from: &str, to: &str) -> Result<(), OutputError> {
    let path = folder.join(to);
    fs::rename(folder.join(from), &path).and_then(|()| sync_folder(&path)).map_err(OutputError::at(&path))
}

/// Removes a hidden folder with what a run has begun in it, if it is there.
fn remove_folder(path: &Path) -> Result<(), OutputError> {
    if !is_own_folder(path)? {
        return Ok(());
    }
    for file in results(path)? {
        fs::remove_file(&file).map_err(OutputError::at(&file))?;
    }
    fs::remove_dir(path).map_err(OutputError::at(path))
}

/// Whether a hidden folder is there; a link or a file of its name is refused.
fn is_own_folder(path: &Path) -> Result<bool, OutputError> {
    match fs::symlink_metadata(path) {
        Ok(about) if about.is_dir() => Ok(true),
        Ok(_) => Err(OutputError::not_own(path, "a link or a file", "a folder that a run has made")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(OutputError::at(path)(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::scratch::Scratch;

    /// A folder with these files, each holding the word.
    fn folder(files: &[(&str, &str)]) -> Scratch {
        let path = Scratch::new();
        for (file, word) in files {
            fs::create_dir_all(path.join(file).parent().unwrap()).unwrap();
            fs::write(path.join(file), word).unwrap();
        }
        path
    }

    /// All files of a folder and what they hold.
    fn contents(path: &Path) -> Vec<(String, String)> {
        let mut all: Vec<_> = fs::read_dir(path)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .map(|path| {
                (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(path).unwrap_or_default())
            })
            .collect();
        all.sort();
        all
    }

    #[test]
    fn results_are_told_from_other_files() {
        for name in
            ["history.csv", "particles_000003.vtu", "contacts_1234567.vtu", "particles.pvd", "summary.json.part"]
        {
            assert!(is_result(name), "{name}");
        }
        for name in
            ["scene.toml", "particles_3.vtu", "particles_000003.vtk", "my_history.csv", "settled.cograin", "x.part"]
        {
            assert!(!is_result(name), "{name}");
        }
    }

    #[test]
    fn what_had_not_begun_to_stand_is_undone() {
        let path = folder(&[("history.csv", "old"), (".cograin-new/history.csv", "new")]);
        take_up(&path).unwrap();
        assert_eq!(contents(&path), [("history.csv".to_owned(), "old".to_owned())]);
    }

    #[test]
    fn what_stands_is_finished_wherever_it_was_broken_off() {
        let (old, new, checkpoint) = ("time,old\n", "time,new\n", "cograin checkpoint 2\nnew");
        let list = format!("{}<DataSet timestep=\"0.0\" part=\"0\" file=\"particles_000007.vtu\"/>", collection::HEAD);
        let expected = [
            ("checkpoint.cograin", checkpoint),
            ("history.csv", new),
            ("notes.txt", "mine"),
            ("particles_000003.vtu", "mine"),
        ];
        let expected = expected.map(|(name, word)| (name.to_owned(), word.to_owned()));
        let cases: [&[(&str, &str)]; 3] = [
            &[
                ("history.csv", old),
                ("particles.pvd", &list),
                ("particles_000007.vtu", "old"),
                ("particles_000008.vtu", "old, not yet in the list"),
                (".cograin-replacing/history.csv", new),
                (".cograin-replacing/checkpoint.cograin", checkpoint),
            ],
            &[("history.csv", new), (".cograin-moving/checkpoint.cograin", checkpoint)],
            &[(".cograin-moving/history.csv", new), (".cograin-moving/checkpoint.cograin", checkpoint)],
        ];
        for (number, case) in cases.into_iter().enumerate() {
            let path = folder(&[case, &[("notes.txt", "mine"), ("particles_000003.vtu", "mine")]].concat());
            take_up(&path).unwrap();
            assert_eq!(contents(&path), expected, "case {number}");
        }
    }

    #[cfg(unix)]
    /// Once the list of frames was gone, those that a kill had left were taken for somebody else's.
    #[test]
    fn results_are_a_runs_however_many_of_them_are_gone() {
        let named = |number| {
            format!("<DataSet timestep=\"0.0\" part=\"0\" file=\"{}\"/>", super::super::frame_name("particles", number))
        };
        let list = format!("{}{}{}", collection::HEAD, named(0), named(1));
        let frames: Vec<String> = (0..4).map(|number| super::super::frame_name("particles", number)).collect();
        let mut files: Vec<(&str, &str)> = frames.iter().map(|frame| (frame.as_str(), "frame")).collect();
        files.extend([("particles.pvd", list.as_str()), ("history.csv", "time,a\n")]);
        let path = folder(&files);
        let all: Vec<_> = last_first(own_results(&path).unwrap()).collect();
        assert_eq!(all.len(), files.len());
        for (gone, file) in all.iter().enumerate() {
            assert_eq!(own_results(&path).unwrap().len(), files.len() - gone);
            fs::remove_file(file).unwrap();
        }
    }

    #[test]
    fn what_no_run_has_made_is_neither_followed_nor_removed_nor_overwritten() {
        let checkpoint = "cograin checkpoint 2\n";
        let cases: [(&[(&str, &str)], &str); 3] = [
            (&[("history.csv", "time,a\n"), (".cograin-replacing/notes", "x")], "expected the first files of a run"),
            (&[("history.csv", "mine"), (".cograin-moving/history.csv", "time,a\n")], "expected no file where"),
            (&[("a", "x"), (".cograin-moving/notes", "x")], ".cograin-moving"),
        ];
        for (files, expected) in cases {
            let path = folder(files);
            let told = take_up(&path).unwrap_err().to_string();
            assert!(told.contains(expected), "{told}");
            for (file, word) in files {
                assert_eq!(fs::read_to_string(path.join(file)).unwrap(), *word);
            }
        }
        let others = folder(&[("history.csv", "time,a\n"), ("checkpoint.cograin", checkpoint)]);
        for name in [NEW, REPLACING, MOVING] {
            let path = folder(&[("history.csv", "time,b\n")]);
            std::os::unix::fs::symlink(&*others, path.join(name)).unwrap();
            let told = take_up(&path).unwrap_err().to_string();
            assert!(told.contains("found a link"), "{name}: {told}");
            assert_eq!(
                (contents(&others).len(), fs::read_to_string(path.join("history.csv")).unwrap().as_str()),
                (2, "time,b\n")
            );
        }
        let path = folder(&[("history.csv", "mine"), ("summary.json", "{}"), ("particles_000000.vtu", "mine")]);
        assert_eq!(own_results(&path).unwrap(), Vec::<PathBuf>::new());
        assert_eq!(foreign_result(&path).unwrap().as_deref(), Some("history.csv"));
    }
}
