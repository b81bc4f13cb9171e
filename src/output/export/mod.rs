//! A scene as an FMI 2.0 co-simulation unit: `modelDescription.xml`, resources and library in one `.fmu`.

mod archive;
mod description;
mod library;
mod nodes;
mod page;
mod resources;

pub use description::LOG_CATEGORIES;
pub use library::{ENVIRONMENT_VARIABLE, LIBRARY_MARK, LibraryError, STANDARD_LIBRARY, find_library};
pub use resources::{Content, Contents, Resource, ResourceError, identity, read_resources, resources};

use crate::engine::state::State;
use crate::interface::{ChosenError, Interface};
use crate::scene::{Scene, Source};
use std::io;
use std::path::{Path, PathBuf};

/// Why no unit was made.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// No usable library.
    #[error(transparent)]
    Library(#[from] LibraryError),
    /// An output that the scene names and does not have.
    #[error(transparent)]
    Chosen(#[from] ChosenError),
    /// The file was not written.
    #[error("{}: {cause}; take a path that can be written", path.display())]
    Write {
        /// The unit's file.
        path: PathBuf,
        /// The message of the system.
        cause: io::Error,
    },
}

/// Packages a scene, in the state of `state` if there is one, with the library at `library`, as the unit `output`.
///
/// The same scene, state and library give the same bytes. The file appears whole or not at all.
pub fn export(
    source: &Source,
    scene: &Scene,
    state: Option<&State>,
    library: &Path,
    output: &Path,
) -> Result<(), PackageError> {
    let platform = library::Platform::of_this_program()?;
    let binary = library::read(library)?;
    let interface = match state {
        Some(state) => Interface::of(scene).starting_in(state),
        None => Interface::of(scene),
    };
    interface.check_names(scene)?;
    let bytes = state.map(|state| state.to_bytes(scene.fingerprint));
    let identifier = identifier(output);
    let written = |cause| PackageError::Write { path: output.to_owned(), cause };
    let model = description::Model {
        identifier: &identifier,
        identity: &identity(source, bytes.as_deref()),
        scene,
        interface: &interface,
    };

    let mut entries = vec![
        Resource::new("modelDescription.xml", description::write(&model).map_err(written)?),
        Resource::new(
            format!("binaries/{}/{identifier}{}", platform.folder, platform.suffix),
            Content::Program(binary),
        ),
        Resource::new("documentation/index.html", page::write(&model)),
    ];
    let resources = resources(source, bytes).into_iter().chain(nodes::tables(scene));
    entries.extend(resources.map(|entry| entry.inside("resources")));
    archive::write(&entries, output).map_err(written)
}

/// The unit's identifier, which is also its library's name: the file's name as C would have it.
fn identifier(output: &Path) -> String {
    let stem = output.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let name: String = stem.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    if name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_') { name } else { format!("_{name}") }
}

#[cfg(test)]
mod tests;
