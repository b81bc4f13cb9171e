//! Neighbour lists made anew: milliseconds, for the dense packing and for mixtures of two sizes.
//!
//! `cargo bench --bench neighbours -- [--repeats N] [--threads N] [--packing FILE.csv.gz]`
//!
//! Mixtures: large spheres on a cubic lattice, small ones on a finer lattice in what is left. LIGGGHTS on the same
//! mixtures: `benches/mixtures.py`.

use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

/// Large arrays begin at different places of a page, as in the program.
#[global_allocator]
static ALLOCATOR: cograin::memory::Staggered = cograin::memory::Staggered;

/// What all scenes have.
const COMMON: &str = r#"
gravity = [0.0, 0.0, 0.0]
[run]
end = 1.0
step = 1.0e-6
threads = THREADS
SKIN
[material.grain]
youngs_modulus = 5.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.grain.grain]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.bed]
material = "grain"
file = "FILE"
"#;

/// Ratios of radii and number of spheres of the mixtures.
const MIXTURES: [(f64, usize); 4] = [(1.0, 100_000), (2.0, 100_000), (5.0, 100_000), (20.0, 100_000)];

/// A mixture of about this many spheres: x, y, z, radius, smallest radius 1 mm, no two of them touch.
fn mixture(ratio: f64, count: usize) -> String {
    let (small, large) = (1e-3, ratio * 1e-3);
    let (fine, coarse) = (2.05 * small, 2.4 * large);
    let void = if ratio > 1.0 { 1.0 - 4.19 * ((large + small) / coarse).powi(3) } else { 1.0 };
    let width = (count as f64 * fine.powi(3) / void.max(0.2)).cbrt();
    let cells = (width / coarse).round().max(1.0);
    let width = cells * coarse;
    let mut text = String::from("x,y,z,radius\n");
    let each = |spacing: f64, hand: &mut dyn FnMut([f64; 3])| {
        let along = (width / spacing) as usize;
        for n in 0..along.pow(3) {
            let at = [n / (along * along), n / along % along, n % along];
            hand(at.map(|k| (k as f64 + 0.5) * spacing));
        }
    };
    if ratio > 1.0 {
        each(coarse, &mut |[x, y, z]| writeln!(text, "{x},{y},{z},{large}").expect("text grows"));
    }
    each(fine, &mut |point| {
        let from_large = |x: f64| x - ((x / coarse).floor() + 0.5) * coarse;
        let distance = point.map(from_large).iter().map(|d| d * d).sum::<f64>().sqrt();
        if ratio == 1.0 || distance > large + small {
            let [x, y, z] = point;
            writeln!(text, "{x},{y},{z},{small}").expect("text grows");
        }
    });
    text
}

/// Makes the lists of a scene several times and tells the least time.
#[allow(clippy::print_stdout, reason = "a benchmark prints")]
fn measure(name: &str, text: String, file: (&str, Vec<u8>), repeats: usize) {
    let files = BTreeMap::from([(file.0.to_string(), file.1)]);
    let source = Source { name: "scene.toml".into(), text, files };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
    let mut simulation = Simulation::new(Arc::new(scene)).expect("the scene starts");
    let mut least = f64::INFINITY;
    for _ in 0..repeats {
        let begin = Instant::now();
        simulation.renew_lists();
        least = least.min(begin.elapsed().as_secs_f64());
    }
    let state = simulation.state();
    let pairs: usize = state.contacts.iter().map(|list| list.first.len()).sum();
    println!(
        "{name:12} {:8.3} ms, {:6.1} ns a particle; {} particles, {pairs} pairs, {} contacts, {} slabs, state {:016x}",
        least * 1e3,
        least * 1e9 / state.particles.len() as f64,
        state.particles.len(),
        simulation.contact_count(),
        state.neighbours.slabs.len() - 1,
        state.fingerprint(),
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let after = |name: &str, other: &str| {
        let place = arguments.iter().position(|argument| argument == name);
        place.and_then(|place| arguments.get(place + 1)).map_or(other, |value| value).to_string()
    };
    let repeats = after("--repeats", "20").parse().unwrap_or(20);
    let threads = after("--threads", "1");
    let text = |file: &str, skin: &str| COMMON.replace("FILE", file).replace("THREADS", &threads).replace("SKIN", skin);
    let packing =
        std::fs::read(after("--packing", "models/loaded_beam/dense_20k.csv.gz")).expect("the packing is read");
    let walls = [(0, 0.0, 1), (0, 0.2448, -1), (1, 0.0, 1), (1, 0.2448, -1), (2, 0.0, 1), (2, 0.4, -1)];
    let mut dense = text("packing.csv.gz", "skin = 0.001");
    for (number, (axis, place, sign)) in walls.into_iter().enumerate() {
        let (mut point, mut normal) = ([0.0; 3], [0; 3]);
        (point[axis], normal[axis]) = (place, sign);
        let normal = normal.map(f64::from);
        writeln!(
            dense,
            "[boundary.wall{number}]\nplane = {{ point = {point:?}, normal = {normal:?} }}\nmaterial = \"grain\""
        )
        .expect("text grows");
    }
    measure("dense", dense, ("packing.csv.gz", packing), repeats);
    for (ratio, count) in MIXTURES {
        let name = format!("1 to {ratio}");
        measure(
            &name,
            text("mixture.csv", "skin = 1.0e-4"),
            ("mixture.csv", mixture(ratio, count).into_bytes()),
            repeats,
        );
    }
}
