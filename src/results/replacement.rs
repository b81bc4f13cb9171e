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
use super::files::sync_folder;
use super::{BREAKAGE, CHECKPOINT, HISTORY, SUMMARY, UNFINISHED, frame_number, is_collection};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Where a run begins.
const NEW: &str = ".cograin-new";

/// The same, once the new run stands.
const REPLACING: &str = ".cograin-replacing";

/// The same, once the earlier run's results are gone.
const MOVING: &str = ".cograin-moving";

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

/// Ends a replacement that was broken off; one that had not come to its decisive moment is undone.
pub(crate) fn take_up(folder: &Path) -> Result<(), OutputError> {
    remove_folder(&folder.join(NEW))?;
    if folder.join(REPLACING).is_dir() {
        for path in results(folder)? {
            fs::remove_file(&path).map_err(OutputError::at(&path))?;
        }
        rename(folder, REPLACING, MOVING)?;
    }
    let moving = folder.join(MOVING);
    if moving.is_dir() {
        let entries = fs::read_dir(&moving).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        for entry in entries.map_err(OutputError::at(&moving))? {
            let place = folder.join(entry.file_name());
            fs::rename(entry.path(), &place).map_err(OutputError::at(&place))?;
        }
        fs::remove_dir(&moving).map_err(OutputError::at(&moving))?;
    }
    Ok(())
}

/// The results of a run in a folder, also those that are not finished.
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

/// Whether a file has a name that runs give.
fn is_result(name: &str) -> bool {
    let name = name.strip_suffix(&format!(".{UNFINISHED}")).unwrap_or(name);
    [HISTORY, BREAKAGE, SUMMARY, CHECKPOINT].contains(&name) || frame_number(name).is_some() || is_collection(name)
}

/// Gives a hidden folder another name, for good.
fn rename(folder: &Path, from: &str, to: &str) -> Result<(), OutputError> {
    let path = folder.join(to);
    fs::rename(folder.join(from), &path).and_then(|()| sync_folder(&path)).map_err(OutputError::at(&path))
}

/// Removes a folder with what is in it, if it is there.
fn remove_folder(path: &Path) -> Result<(), OutputError> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(OutputError::at(path)(error)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder with these files, each holding the word.
    fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
        let path = std::env::temp_dir().join(format!("cograin-replacement-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
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
        let path = folder("undone", &[("history.csv", "old"), (".cograin-new/history.csv", "new")]);
        take_up(&path).unwrap();
        assert_eq!(contents(&path), [("history.csv".to_owned(), "old".to_owned())]);
    }

    #[test]
    fn what_stands_is_finished_wherever_it_was_broken_off() {
        let expected = [("checkpoint.cograin", "new"), ("history.csv", "new"), ("notes.txt", "mine")];
        let expected = expected.map(|(name, word)| (name.to_owned(), word.to_owned()));
        let cases: [&[(&str, &str)]; 3] = [
            &[
                ("history.csv", "old"),
                ("particles_000007.vtu", "old"),
                (".cograin-replacing/history.csv", "new"),
                (".cograin-replacing/checkpoint.cograin", "new"),
            ],
            &[("history.csv", "new"), (".cograin-moving/checkpoint.cograin", "new")],
            &[(".cograin-moving/history.csv", "new"), (".cograin-moving/checkpoint.cograin", "new")],
        ];
        for (number, case) in cases.into_iter().enumerate() {
            let path = folder(&format!("finished{number}"), &[case, &[("notes.txt", "mine")]].concat());
            take_up(&path).unwrap();
            assert_eq!(contents(&path), expected, "case {number}");
        }
    }
}
