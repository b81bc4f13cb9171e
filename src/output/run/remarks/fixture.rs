//! A scene that remarks are tried with.

use crate::scene::{Scene, Source};

/// A scene with these lines about the pair and the law.
pub(super) fn scene(pair: &str, law: &str, density: f64) -> Scene {
    let text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[material.g]\ndensity = {density:?}\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\n\
         [pair.g.g]\n{pair}\n{law}\n[particles.a]\nmaterial = \"g\"\nlist = [{{ position = [0.0, 0.0, 0.02], radius = 0.01 }}]\n\
         [boundary.floor]\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nmaterial = \"g\"\n"
    );
    let source = Source { name: "scene.toml".into(), text, files: Default::default() };
    Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"))
}
