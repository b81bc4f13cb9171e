//! What keeping and restoring a state costs, against a copy of as many bytes: the dense packing of 20,000 spheres.
//!
//! `cargo bench --bench snapshots`

use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use cograin::state::State;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::hint::black_box;
use std::io::Cursor;
use std::sync::Arc;
use std::time::Instant;

/// The packing in a box of planes.
fn dense() -> Source {
    let packing = std::fs::read("models/loaded_beam/dense_20k.csv.gz").expect("the packing can be read");
    let mut text = String::from(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nstep = 1.5e-5\nthreads = 1\nmax_overlap = 0.5\n[material.grain]\n\
         youngs_modulus = 5.0e7\npoissons_ratio = 0.3\ndensity = 2500.0\n[pair.grain.grain]\nrestitution = 0.5\n\
         friction = 0.5\n[contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[particles.bed]\n\
         material = \"grain\"\nfile = \"bed.csv.gz\"\n",
    );
    for (axis, end) in [("x", 0.2448), ("y", 0.2448), ("z", 0.4)] {
        for (name, place, sign) in [("low", 0.0, 1.0), ("high", end, -1.0)] {
            let [point, normal] = [place, sign].map(|n| ["x", "y", "z"].map(|a| if a == axis { n } else { 0.0 }));
            let _ = writeln!(text, "[boundary.{axis}_{name}]\nplane = {{ point = {point:?}, normal = {normal:?} }}");
            text += "material = \"grain\"\n";
        }
    }
    Source { name: "dense".into(), text, files: BTreeMap::from([("bed.csv.gz".into(), packing)]) }
}

/// Does something a few times and prints what the quickest of them took.
#[allow(clippy::print_stdout, reason = "a benchmark prints")]
fn time<T>(what: &str, bytes: usize, mut work: impl FnMut() -> T) {
    let quickest = (0..30)
        .map(|_| {
            let begun = Instant::now();
            black_box(work());
            begun.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    println!("{what:42} {:6.2} ms, {:5.1} GB/s", quickest * 1e3, bytes as f64 * 1e-9 / quickest);
}

fn main() {
    let scene = Arc::new(Scene::from_source(&dense()).unwrap_or_else(|errors| panic!("{errors}")));
    let mut simulation = Simulation::new(scene.clone()).expect("the scene starts");
    simulation.advance(20.0 * 1.5e-5).expect("it runs");
    let state = simulation.state().clone();
    let bytes = state.to_bytes(scene.fingerprint);
    let count = bytes.len();
    let (mut there, mut kept, mut file) = (bytes.clone(), state.clone(), Cursor::new(Vec::with_capacity(count)));
    time("a copy of the bytes to where bytes were", count, || there.copy_from_slice(black_box(&bytes)));
    time("a copy of the bytes to new memory", count, || bytes.clone());
    time("a state to where a state was", count, || kept.clone_from(black_box(&state)));
    time("a state to new memory", count, || state.clone());
    time("bytes of a state", count, || state.to_bytes(scene.fingerprint));
    time("a state of bytes", count, || State::from_bytes(&bytes, scene.fingerprint).expect("they are whole"));
    time("hash of a state", count, || state.fingerprint());
    time("a checkpoint, list by list", count, || {
        file.set_position(0);
        state.write_to(scene.fingerprint, &mut file).expect("memory takes it");
    });
}
