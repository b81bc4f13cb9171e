//! The scene file: its tables, how they are read, and the checks across tables that turn them into a [`Scene`].

mod check;
pub(crate) mod parameters;
mod tables;

use crate::base::document::{self, Document, Faults, Mistake, SceneError, SceneErrors, Setting};
use crate::base::files;
use crate::scene::file::parameters::{CENTRAL_DERIVATIVES, SAFETY, THREADS, TIME_STEP};
use crate::scene::packing::{PackingProgress, Packings};
use crate::scene::{Models, Scene, Source};
use check::raw_tables;
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::num::NonZeroUsize;
use std::path::Path;
use std::str::FromStr;
pub(in crate::scene) use tables::Inertia;

impl Scene {
    /// Reads a scene and the files that it names, whose paths count from the folder of the scene.
    pub fn read(path: &Path) -> Result<(Self, Source), SceneErrors> {
        Models::standard().read(path, &[], &mut |_| {})
    }

    /// Reads a scene from its source alone.
    pub fn from_source(source: &Source) -> Result<Self, SceneErrors> {
        Models::standard().scene(source, &[])
    }
}

/// Scenes that name these sub-models.
impl Models {
    /// Reads a scene and the files that it names, which it searches in the folder of the scene, with other values of some keys,
    /// which are part of the text from here on; reports the progress of random packings.
    pub fn read(
        &self,
        path: &Path,
        settings: &[Setting],
        tell: &mut dyn FnMut(PackingProgress),
    ) -> Result<(Scene, Source), SceneErrors> {
        self.read_with(path, settings, &Packings::default(), tell)
    }

    /// The same, with random packings that were made before: what needs one of them does not make it again.
    pub fn read_with(
        &self,
        path: &Path,
        settings: &[Setting],
        made: &Packings,
        tell: &mut dyn FnMut(PackingProgress),
    ) -> Result<(Scene, Source), SceneErrors> {
        let name = path.file_name().map_or_else(|| path.to_string_lossy(), |name| name.to_string_lossy()).into_owned();
        let text = bytes(path).map_err(|reason| unreadable(&name, reason))?;
        let text = String::from_utf8(text).map_err(|_| unreadable(&name, "it is not UTF-8 text".to_owned()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut source = Source { name, text, files: BTreeMap::new() };
        let changes = document::apply(&mut source.text, settings)?;
        let scene =
            self.with_files(&mut source, folder, (made, tell)).map_err(|errors| changes.told(&source.name, errors))?;
        Ok((scene, source))
    }

    /// Reads a scene from its text, and the files that it names from a folder.
    fn with_files(
        &self,
        source: &mut Source,
        folder: &Path,
        made: (&Packings, &mut dyn FnMut(PackingProgress)),
    ) -> Result<Scene, SceneErrors> {
        let document = Document::parse(&source.name, &source.text)?;
        let mut faults = Faults::new(&document);
        for (table, key, file) in raw_tables::files(&document, self) {
            match bytes(&folder.join(&file)) {
                Ok(bytes) => {
                    source.files.insert(file, bytes);
                }
                Err(reason) => faults.add(&table, &key, Mistake::Unreadable { file, reason }),
            }
        }
        check::scene(source, &document, faults, self, made)
    }

    /// Reads a scene from its source alone, with other values of some keys.
    pub fn scene(&self, source: &Source, settings: &[Setting]) -> Result<Scene, SceneErrors> {
        if !settings.is_empty() {
            let mut changed = Source::clone(source);
            let changes = document::apply(&mut changed.text, settings)?;
            return self.scene(&changed, &[]).map_err(|errors| changes.told(&source.name, errors));
        }
        let document = Document::parse(&source.name, &source.text)?;
        let mut faults = Faults::new(&document);
        for (table, key, file) in raw_tables::files(&document, self) {
            if !source.files.contains_key(&file) {
                let reason = "it was not handed over with the scene".to_owned();
                faults.add(&table, &key, Mistake::Unreadable { file, reason });
            }
        }
        check::scene(source, &document, faults, self, (&Packings::default(), &mut |_| {}))
    }

    /// Reads a scene from its source alone, with these values of some of its parameters.
    pub fn with_parameters<'a>(
        &self,
        source: &Source,
        values: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Scene, SceneErrors> {
        let (mut settings, mut threads) = (Vec::new(), None);
        for (name, value) in values {
            let text = match name {
                THREADS => {
                    threads = Some(value);
                    continue;
                }
                TIME_STEP if value == 0.0 => "run.step=auto".to_owned(),
                TIME_STEP => format!("run.step={value:?}"),
                // What no key says is so already.
                SAFETY if value == 0.0 && !Document::parse(&source.name, &source.text)?.has(SAFETY) => continue,
                CENTRAL_DERIVATIVES => format!("run.central_derivatives={}", value != 0.0),
                _ => format!("{name}={value:?}"),
            };
            settings.extend(text.parse::<Setting>());
        }
        let scene = self.scene(source, &settings)?;
        Ok(match threads {
            Some(threads) => scene.with_threads(NonZeroUsize::new(threads as usize)),
            None => scene,
        })
    }
}

impl FromStr for Scene {
    type Err = SceneErrors;

    /// Reads a scene that names no files from its text.
    fn from_str(text: &str) -> Result<Self, SceneErrors> {
        Self::from_source(&Source { name: "scene".to_owned(), text: text.to_owned(), files: BTreeMap::new() })
    }
}

/// The scene itself cannot be read.
fn unreadable(name: &str, reason: String) -> SceneErrors {
    let mistake = Mistake::Unreadable { file: "the scene".to_owned(), reason };
    let (file, table, key) = (name.to_owned(), String::new(), String::new());
    SceneErrors { list: vec![SceneError { file, line: None, table, key, mistake }] }
}

/// The bytes of a file; otherwise why it cannot be read.
fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    files::read(path).map_err(|error| reason(&error))
}

/// Why a file cannot be read, in the same words on every system.
fn reason(error: &Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "permission denied".to_owned(),
        ErrorKind::IsADirectory => "it is a folder".to_owned(),
        ErrorKind::InvalidData => "it is not UTF-8 text".to_owned(),
        _ => error.to_string(),
    }
}
