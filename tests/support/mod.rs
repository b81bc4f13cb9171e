//! Scenes from text, for all tests of the library.

mod builders;
mod values;

pub(crate) use builders::{DRIVEN, HERTZ_AND_FRICTION, Triangle, cell, glass, obj, spheres, uniform};
pub(crate) use values::{assert_all_near, assert_near, set, value, velocity_of_first};

use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Files that a scene names: what is in each, by its name.
pub(crate) type Files = BTreeMap<String, Vec<u8>>;

/// The scene of a text, or why it is refused.
pub(crate) fn read(text: &str) -> Result<Scene, String> {
    read_with(text, Files::new())
}

/// The scene of a text and its files, or why it is refused.
pub(crate) fn read_with(text: &str, files: Files) -> Result<Scene, String> {
    let source = Source { name: "scene.toml".to_owned(), text: text.to_owned(), files };
    Scene::from_source(&source).map_err(|errors| errors.to_string())
}

/// The scene of a text.
#[track_caller]
pub(crate) fn checked(text: &str) -> Scene {
    read(text).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

/// The scene of a text, to be shared.
#[track_caller]
pub(crate) fn scene(text: &str) -> Arc<Scene> {
    Arc::new(checked(text))
}

/// The scene of a text and its files, to be shared.
#[track_caller]
pub(crate) fn scene_with(text: &str, files: Files) -> Arc<Scene> {
    Arc::new(read_with(text, files).unwrap_or_else(|errors| panic!("{errors}\n{text}")))
}

/// The simulation of a scene at time 0.
#[track_caller]
pub(crate) fn start(text: &str) -> Simulation {
    start_with(text, Files::new())
}

/// The simulation of a scene that names files, at time 0.
#[track_caller]
pub(crate) fn start_with(text: &str, files: Files) -> Simulation {
    Simulation::new(scene_with(text, files)).unwrap_or_else(|error| panic!("{error}\n{text}"))
}
