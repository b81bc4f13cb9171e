//! What the unit reads when it starts: the scene, the files it names, and the state it begins in.
//!
//! [`resources`] writes them, [`read_resources`] reads them back; [`identity`] tells whether they are still
//! those that the unit's description was made from.

use super::names::LONGEST;
use crate::scene::Source;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use uuid::Uuid;

/// The scene's text.
const SCENE: &str = "scene.toml";
/// Names of the files that the scene names, in their order. A name may be no safe path: the files are numbered.
const INDEX: &str = "files.json";
/// The state to begin in.
const STATE: &str = "state.bin";

/// What an entry holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// Bytes that are read.
    Data(Vec<u8>),
    /// A library, which is marked as executable.
    Program(Vec<u8>),
}

impl Content {
    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Data(bytes) | Self::Program(bytes) => bytes,
        }
    }
}

impl From<Vec<u8>> for Content {
    fn from(bytes: Vec<u8>) -> Self {
        Self::Data(bytes)
    }
}

impl From<String> for Content {
    fn from(text: String) -> Self {
        Self::Data(text.into_bytes())
    }
}

/// A file of the unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resource {
    /// Its path in the unit.
    pub path: String,
    /// What it holds.
    pub content: Content,
}

impl Resource {
    /// A file of the unit.
    pub(super) fn new(path: impl Into<String>, content: impl Into<Content>) -> Self {
        Self { path: path.into(), content: content.into() }
    }

    /// The same file in a folder.
    pub(super) fn inside(self, folder: &str) -> Self {
        Self { path: format!("{folder}/{}", self.path), content: self.content }
    }

    /// Its bytes.
    pub fn bytes(&self) -> &[u8] {
        self.content.bytes()
    }
}

/// What a unit was made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// The scene's text and files.
    pub source: Source,
    /// The state to begin in, as bytes.
    pub state: Option<Vec<u8>>,
}

/// Why the resources of a unit cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ResourceError {
    /// A file is missing or cannot be read.
    #[error("{}: {cause}; take the resources folder of the unpacked unit", path.display())]
    Read {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
    /// The list of files is not readable.
    #[error("{}: expected a list of names, found {cause}", path.display())]
    Index {
        /// Its path.
        path: PathBuf,
        /// What is wrong with it.
        cause: serde_json::Error,
    },
    /// The scene is not a text.
    #[error("{}: expected text in UTF-8, found other bytes", path.display())]
    Text {
        /// Its path.
        path: PathBuf,
    },
}

/// The files that a unit of this scene reads when it starts, by their paths in the resources folder.
pub fn resources(source: &Source, state: Option<Vec<u8>>) -> Vec<Resource> {
    let mut entries = vec![Resource::new(SCENE, source.text.clone())];
    if !source.files.is_empty() {
        let names: Vec<&str> = source.files.keys().map(String::as_str).collect();
        entries.push(Resource::new(INDEX, serde_json::json!(names).to_string()));
    }
    for (number, (name, bytes)) in source.files.iter().enumerate() {
        entries.push(Resource::new(stored(number, name), bytes.clone()));
    }
    entries.extend(state.map(|state| Resource::new(STATE, state)));
    entries
}

/// Path of the file with a number and a name: readable, and never outside the folder.
fn stored(number: usize, name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    // The end tells what kind of file it is.
    let last: String = last.chars().skip(last.chars().count().saturating_sub(LONGEST)).collect();
    let safe = |letter: char| if letter.is_ascii_alphanumeric() || letter == '.' { letter } else { '_' };
    format!("files/{number}_{}", last.chars().map(safe).collect::<String>())
}

/// Reads what [`resources`] wrote to a folder.
pub fn read_resources(folder: &Path) -> Result<Contents, ResourceError> {
    let read = |name: &str| {
        let path = folder.join(name);
        fs::read(&path).map_err(|cause| ResourceError::Read { path, cause })
    };
    let optional = |name: &str| match read(name) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(ResourceError::Read { cause, .. }) if cause.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    };

    let text = String::from_utf8(read(SCENE)?).map_err(|_| ResourceError::Text { path: folder.join(SCENE) })?;
    let names: Vec<String> = match optional(INDEX)? {
        Some(bytes) => {
            serde_json::from_slice(&bytes).map_err(|cause| ResourceError::Index { path: folder.join(INDEX), cause })?
        }
        None => Vec::new(),
    };
    let mut files = BTreeMap::new();
    for (number, name) in names.into_iter().enumerate() {
        let bytes = read(&stored(number, &name))?;
        files.insert(name, bytes);
    }
    Ok(Contents { source: Source { name: SCENE.to_owned(), text, files }, state: optional(STATE)? })
}

/// The unit's GUID: of the program's version, the scene's text, every file it names, and the state to begin in.
pub fn identity(source: &Source, state: Option<&[u8]>) -> String {
    let mut decides = Vec::new();
    let mut part = |bytes: &[u8]| {
        decides.extend_from_slice(&(bytes.len() as u64).to_le_bytes());
        decides.extend_from_slice(bytes);
    };
    part(concat!("cograin FMI 2.0 library, version ", env!("CARGO_PKG_VERSION"), ";").as_bytes());
    part(source.text.as_bytes());
    for (name, bytes) in &source.files {
        part(name.as_bytes());
        part(bytes);
    }
    // a unit without a state differs from one with an empty state
    part(&[u8::from(state.is_some())]);
    part(state.unwrap_or_default());
    Uuid::new_v5(&Uuid::NAMESPACE_OID, &decides).to_string()
}
