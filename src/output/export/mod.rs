//! A scene as a co-simulation unit of FMI 2.0 or 3.0: `modelDescription.xml`, resources and library in one `.fmu`.

mod archive;
mod description;
mod experiment;
mod functions;
mod library;
mod names;
mod nodes;
mod page;
mod picture;
mod resources;
#[cfg(test)]
mod sample_library;
mod terminals;

pub use description::LOG_CATEGORIES;
pub use library::{ENVIRONMENT_VARIABLE, LIBRARY_MARK, Libraries, LibraryError, STANDARD_LIBRARY, find_libraries};
pub use resources::{Content, Contents, Resource, ResourceError, identity, read_resources, resources};

use crate::engine::simulation::{RunError, Simulation};
use crate::engine::state::State;
use crate::engine::state::snapshot::SnapshotError;
use crate::interface::{ChosenError, Interface, Standard};
use crate::scene::{Scene, Source};
use experiment::Experiment;
use library::Library;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Why no unit was made.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// No usable library.
    #[error(transparent)]
    Library(#[from] LibraryError),
    /// An output that the scene names and does not have.
    #[error(transparent)]
    Chosen(#[from] ChosenError),
    /// The unit would not start.
    #[error(transparent)]
    Start(#[from] RunError),
    /// Nor would it in this state.
    #[error(transparent)]
    State(#[from] SnapshotError),
    /// A table of the unit would have a name that not every system takes.
    #[error("[boundary.{name}]: its mesh becomes a file of the unit; expected {expected}, found {name:?}")]
    Name {
        /// Name of the boundary.
        name: String,
        /// What is expected of it.
        expected: String,
    },
    /// The file was not written.
    #[error("{}: {cause}; take a path that can be written", path.display())]
    Write {
        /// The unit's file.
        path: PathBuf,
        /// The message of the system.
        cause: io::Error,
    },
}

/// Licences of what a unit contains; `tools/notices` writes the one of the packages of others.
const LICENSES: [(&str, &str); 3] = [
    ("license-mit.txt", include_str!("../../../LICENSE-MIT")),
    ("license-apache.txt", include_str!("../../../LICENSE-APACHE")),
    ("third_party.txt", include_str!("../../../fmu/library/third_party.txt")),
];

/// Packages a scene, in the state of `state` if there is one, with libraries, one for each platform, as the unit `output` that speaks an
/// edition of the standard.
///
/// The same scene, state and libraries give the same bytes. The file appears whole or not at all. A scene that does not start is
/// refused.
pub fn export(
    source: &Source,
    scene: &Arc<Scene>,
    state: Option<&State>,
    libraries: &Libraries,
    standard: Standard,
    output: &Path,
) -> Result<(), PackageError> {
    let libraries = Library::read_all(libraries)?;
    let simulation = begin(scene, state)?;
    let interface = match state {
        Some(state) => Interface::of(scene).starting_in(state),
        None => Interface::of(scene),
    };
    interface.check_names(scene)?;
    nodes::check_names(scene)?;
    let bytes = state.map(|state| state.to_bytes(scene.fingerprint));
    let identifier = identifier(output);
    let written = |cause| PackageError::Write { path: output.to_owned(), cause };
    let model = description::Model {
        identifier: &identifier,
        identity: &identity(source, bytes.as_deref()),
        standard,
        scene,
        interface: &interface,
    };

    let mut entries = vec![Resource::new("modelDescription.xml", description::write(&model).map_err(written)?)];
    let platforms: Vec<_> = libraries.iter().map(|library| library.platform.folder(standard)).collect();
    let picture = picture::png(scene, simulation.state());
    let steps = page::steps(scene, &simulation);
    // A scene that starts and then stops by itself has a unit without an experiment.
    // The layered standard has no names for the elements of arrays.
    let experiment = match standard {
        Standard::Fmi2 => Experiment::run(simulation, &interface).ok(),
        Standard::Fmi3 => None,
    };
    let page = page::Page {
        model: &model,
        source,
        platforms: &platforms,
        steps,
        has_picture: picture.is_some(),
        has_state: state.is_some(),
        has_experiment: experiment.is_some(),
    };
    let page = page.write();
    entries.extend(picture.map(|picture| Resource::new(page::picture(standard), picture)));
    if standard == Standard::Fmi3 {
        let terminals = terminals::write(&model).map_err(written)?;
        entries.extend(terminals.map(|terminals| Resource::new("terminalsAndIcons/terminalsAndIcons.xml", terminals)));
    }
    entries.extend(libraries.into_iter().map(|Library { platform, bytes }| {
        let path = format!("binaries/{}/{identifier}{}", platform.folder(standard), platform.suffix);
        Resource::new(path, Content::Program(bytes))
    }));
    entries.push(Resource::new("documentation/index.html", page));
    entries.extend(licenses(scene));
    let resources = resources(source, bytes).into_iter().chain(nodes::tables(scene));
    entries.extend(resources.map(|entry| entry.inside("resources")));
    if let Some(experiment) = experiment {
        entries.extend(experiment.files().map_err(written)?);
    }
    archive::write(&entries, output).map_err(written)
}

/// The simulation as the unit begins it.
fn begin(scene: &Arc<Scene>, state: Option<&State>) -> Result<Simulation, PackageError> {
    let Some(state) = state else { return Ok(Simulation::new(Arc::clone(scene))?) };
    let mut simulation = Simulation::resume(Arc::clone(scene), state.clone()).map_err(SnapshotError::from)?;
    simulation.open_books();
    Ok(simulation)
}

/// The licences, and where to begin to read them.
fn licenses(scene: &Scene) -> Vec<Resource> {
    let model = scene.about.license.as_deref().unwrap_or("not stated");
    let copyright = scene.about.copyright.as_deref().map_or_else(String::new, |text| format!(" {text}."));
    let first = format!(
        "The model in resources/: licence {model}.{copyright}\n\nThe library in binaries/: MIT (license-mit.txt) or Apache 2.0 \
         (license-apache.txt), as you like; third_party.txt has the notices of what it contains of others.\n"
    );
    let files = LICENSES.map(|(name, text)| Resource::new(name, text.to_owned()));
    let all = std::iter::once(Resource::new("license.txt", first)).chain(files);
    all.map(|file| file.inside("documentation/licenses")).collect()
}

/// The unit's identifier, which is also its library's name: the file's name as C would have it.
fn identifier(output: &Path) -> String {
    let stem = output.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let name: String = stem.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    let name: String = name.chars().take(names::LONGEST).collect();
    if name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_') && !names::is_reserved(&name) {
        name
    } else {
        format!("_{name}")
    }
}

#[cfg(test)]
mod tests;
