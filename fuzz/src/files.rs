//! Files of particles and of meshes, in every format: refused in words, or particles and surfaces of finite numbers.

use crate::{advance, expect_finite};
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::sync::Arc;

/// More particles or faces are slow without being new.
const MOST: usize = 500;

/// A scene for particles of a file.
const PARTICLES: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
threads = 1
max_overlap = 0.5
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.5
[contact.c.normal.hertz]
[particles.some]
MATERIAL
file = "FILE"
"#;

/// A scene for a frame that a run wrote: spheres, or clumps, in the cell of the frame or without one.
const FRAME: &str = r#"
[run]
threads = 1
max_overlap = 0.5
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.5
[contact.c.normal.hertz]
[clump.c]
material = "a"
spheres = [{ position = [0.0, 0.0, 0.0], radius = 1e-2 }, { position = [0.01, 0.0, 0.0], radius = 8e-3 }]
[particles.some]
KIND
materials = { 0 = "a" }
file = "f.vtu"
"#;

/// A scene for a mesh of a file: spheres near it, one of which moves.
const MESH: &str = r#"
[run]
threads = 1
max_overlap = 0.5
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.3
[pair.a.a]
restitution = 0.5
friction = 0.4
[contact.c.normal.hertz]
[contact.c.tangential.history]
[particles.some]
material = "a"
list = [
    { position = [0.3, 0.2, 0.33], radius = 0.1, velocity = [0.3, 0.0, -3.0] },
    { position = [0.7, 0.75, -0.35], radius = 0.1, velocity = [0.0, 0.0, 3.0] },
]
[boundary.skin]
material = "a"
mesh = { file = "FILE" }
MOTION
[output]
energy = true
"#;

/// What a file of particles seems to be, and how a scene names its materials and units.
fn kind_of_particles(bytes: &[u8]) -> (&'static str, &'static str) {
    let begins = |with: &[u8]| bytes.starts_with(with);
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(400)]);
    let materials = "materials = { 1 = \"a\", 2 = \"a\", 3 = \"a\", glass = \"a\", steel = \"a\" }";
    match () {
        () if begins(b"ITEM:") => ("f.dump", "units = \"si\"\nmaterials = { 1 = \"a\", 2 = \"a\" }"),
        () if begins(b"# vtk") => ("f.vtk", "material = \"a\""),
        () if begins(b"<") && head.contains("PolyData") => ("f.vtp", "material = \"a\""),
        () if begins(b"<") => ("f.vtu", "material = \"a\""),
        () if begins(&[0x1f, 0x8b]) => ("f.csv.gz", "material = \"a\""),
        () if head.contains("atoms") => ("f.data", "units = \"si\"\nmaterials = { 1 = \"a\", 2 = \"a\" }"),
        () if head.contains("material") => ("f.csv", materials),
        () => ("f.csv", "material = \"a\""),
    }
}

/// What a file of a mesh seems to be.
fn kind_of_mesh(bytes: &[u8]) -> &'static str {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(400)]);
    match () {
        () if bytes.starts_with(b"# vtk") => "f.vtk",
        () if bytes.starts_with(b"<") && head.contains("PolyData") => "f.vtp",
        () if bytes.starts_with(b"<") => "f.vtu",
        () if head.starts_with("solid") || bytes.contains(&0) => "f.stl",
        () => "f.obj",
    }
}

/// A text with one file.
fn scene(text: String, file: &str, bytes: &[u8]) -> Option<Arc<Scene>> {
    let files = BTreeMap::from([(file.to_owned(), bytes.to_vec())]);
    match Scene::from_source(&Source { name: "scene.toml".to_owned(), text, files }) {
        Ok(scene) => Some(Arc::new(scene)),
        Err(errors) => {
            assert!(!errors.to_string().is_empty(), "a refusal says why");
            None
        }
    }
}

/// Reads particles and makes some steps with them.
pub(crate) fn particles(bytes: &[u8]) {
    let (file, materials) = kind_of_particles(bytes);
    let text = PARTICLES.replace("FILE", file).replace("MATERIAL", materials);
    let Some(scene) = scene(text, file, bytes) else { return };
    if scene.particles.len() > MOST {
        return;
    }
    let Ok(mut simulation) = Simulation::new(scene) else { return };
    let rows = &simulation.state().particles;
    assert!(rows.position.iter().flatten().all(|number| number.is_finite()), "places of a file");
    assert!(rows.position.iter().all(|row| row[3] > 0.0), "radii of a file");
    expect_finite(&simulation);
    advance(&mut simulation, 5);
}

/// Reads a frame of a run, as spheres and as clumps, and makes some steps with what it has.
pub(crate) fn frames(bytes: &[u8]) {
    for kind in ["", "clump = \"c\""] {
        for cell in ["", "[cell]\n"] {
            let text = FRAME.replace("KIND", kind) + cell;
            let Some(scene) = scene(text, "f.vtu", bytes).filter(|scene| scene.particles.len() <= MOST) else {
                continue;
            };
            let Ok(mut simulation) = Simulation::new(scene) else { continue };
            let rows = &simulation.state().particles;
            assert!(rows.position.iter().flatten().all(|number| number.is_finite()), "places of a frame");
            expect_finite(&simulation);
            advance(&mut simulation, 5);
        }
    }
}

/// Reads a mesh and lets spheres fly past it: as a wall, and as a skin whose nodes are driven.
pub(crate) fn mesh(bytes: &[u8]) {
    let file = kind_of_mesh(bytes);
    for motion in ["", "nodes = \"driven\"", "motion = { prescribed = { z = 0.1, rotation.x = 1.0 } }"] {
        let text = MESH.replace("FILE", file).replace("MOTION", motion);
        let Some(scene) = scene(text, file, bytes) else { return };
        let Ok(mut simulation) = Simulation::new(scene) else { continue };
        expect_finite(&simulation);
        advance(&mut simulation, 20);
    }
}
