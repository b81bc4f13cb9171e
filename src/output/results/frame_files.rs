//! The files of the frames in a folder: one for each kind and frame, and for each kind the times of all.

use super::collection::Collection;
use super::error::OutputError;
use super::files::{Durability, write_whole};
use super::job::Job;
use super::vtk::EncodeError;
use super::{FRAMES, collection_name, frame_name, frames, grid_frames};
use crate::scene::Scene;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A frame that is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Its number.
    pub number: usize,
    /// Its time \[s\].
    pub time: f64,
}

/// The frames of a folder, which may be added to.
pub(crate) struct FrameFiles {
    /// The folder.
    path: PathBuf,
    /// The kinds of frames that the scene has.
    series: Vec<Series>,
}

impl FrameFiles {
    /// Takes up the frames that are kept.
    pub(crate) fn open(path: &Path, scene: &Scene, kept: &[Frame]) -> Result<Self, OutputError> {
        let bonds = !scene.bonds.is_empty();
        let (cell, clumps) = (scene.cell.is_some(), scene.has_clumps());
        let wanted = [true, scene.output.contacts, bonds, scene.output.boundaries, cell, clumps];
        let kinds = FRAMES.into_iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(name, _)| name.to_owned());
        let kinds = kinds.chain(frames::grids(scene).map(|grid| grid_frames(&grid.name)));
        let series = kinds.map(|name| Series::open(path, name, kept)).collect::<Result<_, _>>()?;
        Ok(Self { path: path.to_owned(), series })
    }

    /// Begins with no frame: all collections or none.
    pub(crate) fn begin(path: &Path, scene: &Scene) -> Result<Self, OutputError> {
        Self::open(path, scene, &[]).inspect_err(|_| {
            let grids = frames::grids(scene).map(|grid| grid_frames(&grid.name));
            for name in FRAMES.into_iter().map(str::to_owned).chain(grids) {
                // The first error is the one to tell.
                let _ = remove(&path.join(collection_name(&name)));
            }
        })
    }

    /// Writes the files of a frame, then their entries. Yields the files.
    pub(crate) fn write(&mut self, scene: &Scene, frame: Frame, job: Job) -> Result<Vec<PathBuf>, OutputError> {
        let files = frames::files(scene, job);
        self.series.iter_mut().zip(files).map(|(series, bytes)| series.add(&self.path, frame, bytes)).collect()
    }

    /// Keeps these frames and removes the others: first their entries, then their files.
    pub(crate) fn keep(&mut self, kept: &[Frame], others: &[Frame]) -> Result<(), OutputError> {
        for series in &mut self.series {
            *series = Series::open(&self.path, std::mem::take(&mut series.name), kept)?;
            for frame in others {
                remove(&self.path.join(frame_name(&series.name, frame.number)))?;
            }
        }
        Ok(())
    }

    /// Removes everything.
    pub(crate) fn remove(self, frames: &[Frame]) -> Result<(), OutputError> {
        for series in self.series {
            drop(series.collection);
            remove(&self.path.join(collection_name(&series.name)))?;
            for frame in frames {
                remove(&self.path.join(frame_name(&series.name, frame.number)))?;
            }
        }
        Ok(())
    }
}

/// A kind of frames.
struct Series {
    /// Beginning of the file names.
    name: String,
    /// The times.
    collection: Collection,
}

impl Series {
    /// Takes up the frames that are kept.
    fn open(path: &Path, name: String, kept: &[Frame]) -> Result<Self, OutputError> {
        let frames: Vec<_> = kept.iter().map(|frame| (frame.time, frame_name(&name, frame.number))).collect();
        let collection = Collection::create(&path.join(collection_name(&name)), &frames)?;
        Ok(Self { name, collection })
    }

    /// Writes a frame.
    fn add(
        &mut self,
        folder: &Path,
        frame: Frame,
        bytes: Result<Vec<u8>, EncodeError>,
    ) -> Result<PathBuf, OutputError> {
        let name = frame_name(&self.name, frame.number);
        let path = folder.join(&name);
        let bytes = bytes.map_err(|source| OutputError::Encode { path: path.clone(), source })?;
        write_whole(&path, &bytes, Durability::Process)?;
        self.collection.add(frame.time, &name)?;
        Ok(path)
    }
}

/// Removes a file, which need not be there.
fn remove(path: &Path) -> Result<(), OutputError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(OutputError::at(path)(error)),
        _ => Ok(()),
    }
}
