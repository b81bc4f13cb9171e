//! Texts of scenes: refused in words, or started, checked and advanced.

use crate::{advance, expect_finite};
use cograin::report;
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// More of anything is slow without being new.
const MOST: u64 = 2000;

/// Files that scenes of the corpus name.
const FILES: [(&str, &[u8]); 12] = [
    ("grains.csv", include_bytes!("../../tests/scenes/files/grains.csv")),
    ("two.csv", include_bytes!("../../tests/scenes/files/two.csv")),
    ("bonds.csv", include_bytes!("../../tests/scenes/files/bonds.csv")),
    ("grains.vtu", include_bytes!("../../tests/scenes/files/grains.vtu")),
    ("grains.data", include_bytes!("../../tests/scenes/files/grains.data")),
    ("grains.dump", include_bytes!("../../tests/scenes/files/grains.dump")),
    ("skin.obj", include_bytes!("../../tests/scenes/files/skin.obj")),
    ("corner.obj", include_bytes!("../../tests/scenes/files/corner.obj")),
    ("types.csv", include_bytes!("../../tests/scenes/files/types.csv")),
    ("materials.csv", include_bytes!("../../tests/scenes/files/materials.csv")),
    ("reduced_units.data", include_bytes!("../../tests/scenes/files/reduced_units.data")),
    ("large_ids.csv", include_bytes!("../../tests/scenes/files/large_ids.csv")),
];

/// The files, by the names that scenes have for them.
fn files(text: &str) -> BTreeMap<String, Vec<u8>> {
    let folders = ["", "../files/", "./"];
    let named = folders.iter().flat_map(|folder| FILES.map(|(name, bytes)| (format!("{folder}{name}"), bytes)));
    named.filter(|(name, _)| text.contains(name.as_str())).map(|(name, bytes)| (name, bytes.to_vec())).collect()
}

/// Whether a text asks for many of something: particles of a lattice, segments, insertions, and spheres that fill a region.
fn asks_for_much(text: &str) -> bool {
    let of_one = |line: &str| {
        let key = line.split('=').next().unwrap_or("").trim();
        !["seed", "timestep", "end", "id"].contains(&key)
            && line.split(|letter: char| !letter.is_ascii_digit() && letter != '_').any(|word| {
                let digits: String = word.chars().filter(char::is_ascii_digit).collect();
                digits.len() > 4 || digits.parse().is_ok_and(|number: u64| number > MOST)
            })
    };
    let counts = ["count", "number", "segments", "layers"];
    text.contains("solid_fraction")
        || text.lines().filter(|line| counts.iter().any(|word| line.contains(word))).any(of_one)
}

/// Reads a text, starts its scene and makes some steps.
pub(crate) fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if text.len() > 20_000 || asks_for_much(text) {
        return;
    }
    let source = Source { name: "scene.toml".to_owned(), text: text.to_owned(), files: files(text) };
    let scene = match Scene::from_source(&source) {
        Ok(scene) => Arc::new(scene.with_threads(std::num::NonZero::new(1))),
        Err(errors) => {
            assert!(!errors.to_string().is_empty(), "a refusal says why");
            return;
        }
    };
    if scene.particles.len() as u64 > MOST {
        return;
    }
    // A check makes a trial of a second.
    if xxh3_64(bytes).is_multiple_of(512) {
        let _ = report::check(&scene, "scene.toml", None).map(|report| report.to_string());
        let _ = report::stiffness(&scene, "scene.toml", None, None).map(|report| report.to_string());
    }
    let Ok(mut simulation) = Simulation::new(scene) else { return };
    expect_finite(&simulation);
    advance(&mut simulation, 10);
    simulation.renew_lists();
    advance(&mut simulation, 10);
}
