//! What hostile input is tried on. A target is a function of bytes that returns whatever they are: it panics where the library panics, where
//! the unit tells of an internal error, and where numbers that are not finite come out of work that was done without complaint.
//!
//! The test of this crate runs each target over its corpus and over changes of it for some seconds; `tools/fuzz` does so for longer,
//! under libFuzzer, which looks for input that takes new ways through the library.

mod calls;
mod files;
mod mutator;
mod scene;
mod state;

pub use mutator::Mutator;

use cograin::interface::{Findings, Interface, Type};
use cograin::simulation::Simulation;
use std::path::{Path, PathBuf};

/// A target.
pub struct Target {
    /// Its name, and that of the folder of its corpus.
    pub name: &'static str,
    /// Takes any bytes.
    pub run: fn(&[u8]),
    /// Folders of the repository whose files are its corpus, beside its own.
    pub corpus: &'static [&'static str],
}

/// All targets.
pub static TARGETS: [Target; 6] = [
    Target {
        name: "scene",
        run: scene::run,
        corpus: &["tests/scenes/good", "tests/scenes/bad", "tests/scenes/overflowing"],
    },
    Target { name: "particles", run: files::particles, corpus: &["tests/scenes/foreign/clouds", "tests/scenes/files"] },
    Target { name: "frames", run: files::frames, corpus: &["fuzz/corpus/particles"] },
    Target { name: "mesh", run: files::mesh, corpus: &["tests/scenes/foreign/meshes"] },
    Target { name: "state", run: state::run, corpus: &[] },
    Target { name: "calls", run: calls::run, corpus: &[] },
];

/// A folder among the results of builds, for what is kept.
pub fn kept_in(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/fuzz").join(name);
    std::fs::create_dir_all(&folder).and_then(|()| folder.canonicalize()).expect("a folder is made")
}

impl Target {
    /// The folders of its corpus.
    pub fn folders(&self) -> Vec<PathBuf> {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let others = self.corpus.iter().map(|folder| here.join("..").join(folder));
        std::iter::once(here.join("corpus").join(self.name)).chain(others).collect()
    }

    /// Its corpus: names and bytes, in the order of the names.
    pub fn entries(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let folders = self.folders();
        let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten().flatten());
        let mut paths: Vec<PathBuf> = files.map(|file| file.path()).filter(|path| path.is_file()).collect();
        paths.sort();
        paths
            .into_iter()
            .map(|path| (path.clone(), std::fs::read(&path).expect("a file of the corpus is read")))
            .collect()
    }
}

/// Demands finite outputs of a simulation that has advanced without complaint.
fn expect_finite(simulation: &Simulation) {
    let (interface, findings) = (Interface::of(simulation.scene()), Findings::default());
    for (index, variable) in interface.outputs().filter(|(_, variable)| variable.quantity.of_type() == Type::Real) {
        let value = interface.value_with(simulation, &findings, index).number();
        assert!(value.is_finite(), "{} is {value}, and nothing was said", variable.name);
    }
    let energies = [simulation.kinetic_energy(), simulation.elastic_energy()];
    assert!(energies.iter().all(|energy| energy.is_finite()), "energies {energies:?}, and nothing was said");
}

/// Advances by some time steps, and looks at what comes out.
fn advance(simulation: &mut Simulation, steps: u32) {
    let interval = f64::from(steps) * simulation.state().clock.step;
    if interval.is_finite() && interval > 0.0 && simulation.advance(interval).is_ok() {
        expect_finite(simulation);
    }
}
