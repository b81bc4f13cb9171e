//! What directional derivatives cost: a bonded block, the bed of the coupling set, and spheres with Hertz contacts and friction that
//! press each other.
//!
//! Two simulations of a scene go on by turns. One is never asked; its communication step is an evaluation. The other is asked after
//! each step. What its step and the question take more, in evaluations, is the cost of a derivative, the way back included.
//!
//! `cargo bench --bench derivatives`; with `-- bed` behind it of this scene alone

use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, Source};
use cograin::simulation::{Input, Simulation};
use std::collections::BTreeMap;
use std::hint::black_box;
use std::sync::Arc;

/// Time steps of a communication step.
const LENGTHS: [u32; 4] = [10, 50, 100, 400];

/// Time steps that are timed in all; the quickest communication step counts.
const STEPS: u32 = 4000;

/// Ten by ten by ten spheres between planes, pressed by the upper one.
const PRESSED: &str = r#"
[run]
step = 1.0e-5
threads = 1
[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3
[pair.glass.glass]
restitution = 0.5
friction = 0.5
[contact.all.normal.hertz]
[contact.all.tangential.history]
[particles.all]
material = "glass"
lattice = { kind = "simple_cubic", radius = 0.005, spacing = 0.00999, counts = [10, 10, 10], origin = [0.0, 0.0, 0.0] }
[boundary.floor]
plane = { point = [0.0, 0.0, -0.004995], normal = [0.0, 0.0, 1.0] }
material = "glass"
[boundary.top]
plane = { point = [0.0, 0.0, 0.094905], normal = [0.0, 0.0, -1.0] }
material = "glass"
motion = { driven = ["x", "y", "z"] }
"#;

/// A scene of the coupling set, whose boundary of this name is driven.
fn model(name: &str) -> Source {
    let read = |file: &str| std::fs::read(format!("models/coupling_set/{file}")).expect("the model can be read");
    let text = String::from_utf8(read(&format!("{name}.toml"))).expect("it is text");
    Source { name: name.into(), text, files: BTreeMap::from([("bed.csv.gz".into(), read("bed.csv.gz"))]) }
}

/// The time that this thread has worked so far \[s\]: what others do on the machine does not count.
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
fn worked() -> f64 {
    unsafe extern "C" {
        fn clock_gettime(clock: i32, time: *mut [i64; 2]) -> i32;
    }
    /// The clock of the thread that asks.
    const CLOCK_THREAD_CPUTIME_ID: i32 = 3;
    let mut time = [0; 2];
    // SAFETY: seconds and nanoseconds have room; the library of the system is there.
    let failed = unsafe { clock_gettime(CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    assert_eq!(failed, 0, "the clock of the thread");
    time[0] as f64 + time[1] as f64 * 1e-9
}

/// The time that has passed \[s\].
#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
fn worked() -> f64 {
    static BEGINNING: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    BEGINNING.elapsed().as_secs_f64()
}

/// How long something takes \[s\].
fn time(work: impl FnOnce()) -> f64 {
    let begun = worked();
    work();
    worked() - begun
}

/// Prints the cost of a derivative by the axis z of a boundary, with communication steps of so many time steps.
#[allow(clippy::print_stdout, reason = "a benchmark prints")]
fn tell(source: &Source, step: f64, boundary: &str, steps: u32) {
    let scene = Arc::new(Scene::from_source(source).unwrap_or_else(|errors| panic!("{errors}")));
    let place = scene.boundaries.iter().position(|it| it.name == boundary).expect("the boundary is there");
    let direction = [(Input::Axis(BoundaryIndex(place as u32), 2), 1.0)];
    let [mut plain, mut asked] = [(); 2].map(|()| Simulation::new(Arc::clone(&scene)).expect("the scene starts"));
    let length = f64::from(steps) * step;
    let advance = |simulation: &mut Simulation| {
        simulation.advance_or_roll_back(length).unwrap_or_else(|error| panic!("{error}"));
    };
    let ask = |simulation: &mut Simulation| {
        let mut read = |simulation: &Simulation| simulation.state().boundaries[place].force.to_vec();
        black_box(simulation.differences(&direction, &mut read).unwrap_or_else(|refusal| panic!("{refusal}")));
    };
    let (mut once, mut with) = (f64::INFINITY, f64::INFINITY);
    // By turns, so that both have the same share of a machine's slow moments.
    for _ in 0..STEPS.div_ceil(steps).max(10) {
        once = once.min(time(|| advance(&mut plain)));
        with = with.min(time(|| {
            advance(&mut asked);
            ask(&mut asked);
        }));
    }
    let cost = with / once - 1.0;
    println!("{:10} {steps:4} time steps, {:8.3} ms: {cost:5.2} evaluations a derivative", source.name, once * 1e3);
}

fn main() {
    // Cargo adds an option of its own.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let pressed = Source { name: "pressed".into(), text: PRESSED.into(), files: BTreeMap::new() };
    let all = [(model("block"), 1e-6, "top"), (model("bed"), 5e-5, "floor"), (pressed, 1e-5, "top")];
    for (source, step, boundary) in all.iter().filter(|it| words.is_empty() || words.contains(&it.0.name)) {
        for steps in LENGTHS {
            tell(source, *step, boundary, steps);
        }
    }
}
