//! Random packings: how dense they become, and that no region makes the program stop.
//!
//! Dense packings of equal spheres failed in boxes of ten diameters (0.5 for two seeds of four, 0.55 for every one),
//! and long or huge regions ended in a panic or without memory.

use cograin::results::{Checkpoint, write_checkpoint};
use cograin::scene::{Models, PackingProgress, Packings, Scene, SceneErrors, Source};
use cograin::simulation::Simulation;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// A scene with one packing of spheres of radius 1/2.
fn packed(seed: u64, packing: &str) -> Result<Scene, SceneErrors> {
    let text = format!(
        "[run]\nseed = {seed}\n[material.a]\ndensity = 1.0\n[particles.p]\nmaterial = \"a\"\npacking = {{ {packing} }}\n"
    );
    Scene::from_source(&Source { name: "packing.toml".to_owned(), text, ..Source::default() })
}

/// Equal spheres in a box with these edges, counted in diameters.
fn in_a_box(seed: u64, [x, y, z]: [f64; 3], solid_fraction: f64) -> Result<Scene, SceneErrors> {
    packed(
        seed,
        &format!("box = [[0, 0, 0], [{x:?}, {y:?}, {z:?}]], solid_fraction = {solid_fraction:?}, radius = 0.5"),
    )
}

/// The least gap of two spheres over their radius, and how far one reaches out of the box.
fn gap_and_excess(scene: &Scene, edges: [f64; 3]) -> (f64, f64) {
    let (mut gap, mut excess) = (f64::INFINITY, f64::NEG_INFINITY);
    for (index, a) in scene.particles.iter().enumerate() {
        for b in &scene.particles[..index] {
            let squared: f64 = (0..3).map(|axis| (a.position[axis] - b.position[axis]).powi(2)).sum();
            gap = gap.min((squared.sqrt() - a.radius - b.radius) / a.radius);
        }
        for axis in 0..3 {
            let out = (a.radius - a.position[axis]).max(a.position[axis] + a.radius - edges[axis]);
            excess = excess.max(out);
        }
    }
    (gap, excess)
}

/// The packing of a seed is as dense as asked for, without overlap, and inside.
fn expect(seed: u64, edges: [f64; 3], solid_fraction: f64) {
    let scene = in_a_box(seed, edges, solid_fraction).unwrap_or_else(|errors| panic!("seed {seed}: {errors}"));
    let volume: f64 = edges.iter().product();
    let found = scene.particles.len() as f64 * std::f64::consts::PI / 6.0 / volume;
    assert!((found - solid_fraction).abs() <= 0.5 / volume, "{found} for {solid_fraction}");
    let (gap, excess) = gap_and_excess(&scene, edges);
    assert!(gap > 0.0 && excess <= 1e-14, "seed {seed}: gap {gap}, excess {excess}");
}

#[test]
fn equal_spheres_fill_half_a_box_of_ten_diameters_whatever_the_seed() {
    (1..=8).for_each(|seed| expect(seed, [10.0; 3], 0.5));
}

#[test]
fn equal_spheres_reach_six_tenths_where_shaking_has_to_order_them() {
    (1..=2).for_each(|seed| expect(seed, [6.0, 10.0, 10.0], 0.59));
}

#[test]
fn small_boxes_are_filled_further_by_longer_shaking() {
    (1..=2).for_each(|seed| expect(seed, [5.0; 3], 0.55));
}

/// `cargo test --release --test library packings:: -- --ignored --nocapture`
#[test]
#[ignore = "takes minutes; docs/scene.md has the figures"]
fn success_and_time_of_dense_packings() {
    let cases: [([f64; 3], f64); 13] = [
        ([10.0; 3], 0.55),
        ([10.0; 3], 0.6),
        ([10.0; 3], 0.62),
        ([3.0, 10.0, 10.0], 0.55),
        ([3.0, 10.0, 10.0], 0.555),
        ([3.0, 10.0, 10.0], 0.58),
        ([3.0, 20.0, 20.0], 0.58),
        ([4.0, 10.0, 10.0], 0.58),
        ([5.0; 3], 0.55),
        ([5.0; 3], 0.58),
        ([5.0, 10.0, 10.0], 0.58),
        ([20.0; 3], 0.6),
        ([30.0; 3], 0.62),
    ];
    for (edges, solid_fraction) in cases {
        let (mut reached, mut times) = (0, Vec::new());
        for seed in 1..=20 {
            let start = Instant::now();
            reached += u32::from(in_a_box(seed, edges, solid_fraction).is_ok());
            times.push(start.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        println!("{edges:?} {solid_fraction}: {reached} of 20, median {:.2} s, most {:.2} s", times[10], times[19]);
    }
}

#[test]
fn a_packing_that_cannot_be_is_refused_at_once() {
    let message = in_a_box(1, [10.0; 3], 0.72).unwrap_err().to_string();
    assert!(message.contains("[particles.p] packing.solid_fraction: spheres that fill 0.72"), "{message}");
}

#[test]
fn regions_of_any_shape_are_filled_or_refused_in_words() {
    let lengths = ["1e-3", "0.9", "3.0", "1e12", "1e200"];
    for x in lengths {
        for y in lengths {
            for amount in ["count = 40", "solid_fraction = 1e-18", "solid_fraction = 0.1"] {
                for radius in ["0.01", "[0.1, 0.4]", "1e-120"] {
                    for z in ["2.0", "1e15"] {
                        let text = format!("box = [[0, 0, 0], [{x}, {y}, {z}]], {amount}, radius = {radius}");
                        // As many spheres as that would only take long.
                        if amount == "solid_fraction = 0.1" && radius == "0.01" {
                            continue;
                        }
                        match packed(1, &text) {
                            Ok(scene) => assert!(scene.particles.len() < 1_000_000, "{text}"),
                            Err(errors) => assert!(!errors.list.is_empty(), "{text}"),
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_packing_tells_how_far_it_is() {
    let folder = std::env::temp_dir().join(format!("cograin_packings_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("scene.toml");
    let two = "[material.a]\ndensity = 1.0\n\
        [particles.few]\nmaterial = \"a\"\npacking = { box = [[0, 0, 0], [1, 1, 1]], count = 5, radius = 0.1 }\n\
        [particles.many]\nmaterial = \"a\"\n\
        packing = { box = [[5, 0, 0], [6, 1, 1]], solid_fraction = 0.4, radius = 0.1 }\n";
    std::fs::write(&path, two).unwrap();
    let (mut placed, mut rounds) = (0, 0);
    cograin::scene::Models::standard()
        .read(&path, &[], &mut |progress| match progress {
            PackingProgress::Placing { placed: now, count, .. } => placed = now * usize::from(count == 5),
            PackingProgress::Pushing { rounds: now, .. } => rounds = now,
        })
        .unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(placed, 5);
    assert!(rounds > 10, "{rounds}");
}

/// A scene with a random packing and a seed, and how often it told of packings while it was read.
fn read(path: &Path, made: &Packings) -> (Scene, usize) {
    let mut told = 0;
    let (scene, _) = Models::standard().read_with(path, &[], made, &mut |_| told += 1).unwrap();
    (scene, told)
}

/// Writes a scene whose packing has this seed into a folder of a test, and its state at the start beside it.
fn written(folder: &Path, seed: u64) -> (PathBuf, PathBuf) {
    let (path, state) = (folder.join(format!("{seed}.toml")), folder.join(format!("{seed}.state")));
    let text = format!(
        "[run]\nseed = {seed}\n[material.a]\ndensity = 1.0\n[particles.p]\nmaterial = \"a\"\n\
         packing = {{ box = [[0, 0, 0], [5, 5, 5]], count = 20, radius = [0.3, 0.5] }}\n"
    );
    fs::write(&path, text).unwrap();
    let scene = Arc::new(read(&path, &Packings::default()).0);
    let simulation = Simulation::new(Arc::clone(&scene)).unwrap();
    write_checkpoint(&state, simulation.state(), &scene, "packing.toml").unwrap();
    (path, state)
}

/// A folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("cograin_packings_{name}_{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_packing_that_a_checkpoint_has_is_not_made_again() {
    let folder = folder("made");
    let ((one, state), (other, _)) = (written(&folder, 1), written(&folder, 2));
    let made = Checkpoint::packings(&state);
    let places = |scene: &Scene| Vec::from_iter(scene.particles.iter().map(|it| (it.position, it.radius)));
    let ((anew, told), (taken, told_again)) = (read(&one, &Packings::default()), read(&one, &made));
    assert!(told > 0 && told_again == 0, "{told}, {told_again}");
    assert_eq!(places(&anew), places(&taken));
    assert_eq!(anew.fingerprint, taken.fingerprint);
    // Another seed makes another one.
    assert!(read(&other, &made).1 > 0);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_packing_that_was_damaged_or_moved_is_made_again() {
    let folder = folder("damaged");
    let (path, state) = written(&folder, 1);
    let mut bytes = fs::read(&state).unwrap();
    let line = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(1).unwrap().0;
    bytes[line + 9] ^= 1;
    fs::write(&state, bytes).unwrap();
    assert!(read(&path, &Checkpoint::packings(&state)).1 > 0);
    let mut draft = read(&path, &Packings::default()).0.into_draft();
    draft.particles[0].position[2] += 1e-3;
    let scene = Arc::new(draft.build().unwrap());
    let simulation = Simulation::new(Arc::clone(&scene)).unwrap();
    write_checkpoint(&state, simulation.state(), &scene, "packing.toml").unwrap();
    assert!(read(&path, &Checkpoint::packings(&state)).1 > 0);
    fs::remove_dir_all(folder).unwrap();
}
