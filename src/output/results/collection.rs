//! `.pvd`: which frame belongs to which time.

use super::error::OutputError;
use super::files::{Durability, write_whole};
use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// What stands before the first frame.
pub(super) const HEAD: &str = "<?xml version=\"1.0\"?>\n\
    <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";

/// What stands behind the last frame.
const TAIL: &str = "</Collection>\n</VTKFile>\n";

/// The open file.
pub(crate) struct Collection {
    /// Where it is.
    path: PathBuf,
    /// The file.
    file: File,
    /// Where the next frame is to stand.
    end: u64,
}

impl Collection {
    /// A file of these frames, each with its time \[s\].
    pub(crate) fn create(path: &Path, frames: &[(f64, String)]) -> Result<Self, OutputError> {
        let entries: String = frames.iter().map(|(time, name)| entry(*time, name)).collect();
        let text = format!("{HEAD}{entries}{TAIL}");
        write_whole(path, text.as_bytes(), Durability::Process)?;
        let file = OpenOptions::new().write(true).open(path).map_err(OutputError::at(path))?;
        Ok(Self { path: path.to_owned(), file, end: (text.len() - TAIL.len()) as u64 })
    }

    /// Adds the frame of a time \[s\]: one write over the old tail, so that the file is whole before and after it.
    pub(crate) fn add(&mut self, time: f64, name: &str) -> Result<(), OutputError> {
        let entry = entry(time, name);
        let text = format!("{entry}{TAIL}");
        let place = self.file.seek(SeekFrom::Start(self.end));
        place.and_then(|_| self.file.write_all(text.as_bytes())).map_err(OutputError::at(&self.path))?;
        self.end += entry.len() as u64;
        Ok(())
    }
}

/// One frame.
fn entry(time: f64, name: &str) -> String {
    format!("<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::scratch::Scratch;

    #[test]
    fn adding_frames_gives_the_file_of_all_frames() {
        let folder = Scratch::new();
        let frames: Vec<_> = (0..3).map(|k| (f64::from(k) / 10.0, format!("particles_{k:06}.vtu"))).collect();
        let [one, whole] = [folder.join("one.pvd"), folder.join("whole.pvd")];
        let mut collection = Collection::create(&one, &frames[..1]).unwrap();
        for (time, name) in &frames[1..] {
            collection.add(*time, name).unwrap();
        }
        Collection::create(&whole, &frames).unwrap();
        assert_eq!(std::fs::read_to_string(one).unwrap(), std::fs::read_to_string(whole).unwrap());
    }
}
