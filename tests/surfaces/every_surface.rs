//! Every shape of a surface and every motion of an axis, in one scene: the same bits for any number of threads and any lane width,
//! and after its state went through bytes.
//!
//! Twelve stations stand side by side along x, each a surface under spheres that meet it and each other. High above them a block of
//! spheres falls: with fewer than 2,000 particles one thread would do all the work.

use crate::support::{Files, scene_with};
use cograin::lanes::Width;
use cograin::quantity::BoundaryIndex;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Radius \[m\].
const RADIUS: f64 = 5e-3;

/// Distance of two stations \[m\].
const APART: f64 = 0.1;

/// Time step \[s\].
const STEP: f64 = 2e-5;

/// Shape and motion of each station; `X` is its middle along x. Where `z` = 0 the spheres begin.
const STATIONS: [(&str, &str); 12] = [
    (
        "disc = { centre = [X, 0.0, -0.0012], normal = [0.0, 0.1, 1.0], radius = 0.03 }",
        "mass = 0.02\ninertia = [5e-6, 5e-6, 1e-5]\n\
      stiffness = { z = 300.0, \"rotation.x\" = 0.01 }\ndamping = { z = 0.1 }\n\
      motion = { loaded = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }",
    ),
    (
        "rectangle = { corner = [X - 0.03, -0.03, 0.0], edges = [[0.06, 0.0, 0.0], [0.0, 0.06, 0.0]] }",
        "motion = { conveying = { x = 0.5 }, driven = [\"z\"] }",
    ),
    (
        "cylinder = { from = [X, -0.04, 0.049], to = [X, 0.04, 0.049], radius = 0.05 }",
        "motion = { prescribed = { \"rotation.y\" = 3.0, z = { sine = { amplitude = 2e-4, frequency = 80.0 } } } }",
    ),
    (
        "cylinder = { from = [X, -0.04, -0.03], to = [X, 0.04, -0.03], radius = 0.0299, caps = \"both\" }",
        "motion = { driven = [\"z\", \"rotation.y\"], by = \"velocity\" }",
    ),
    (
        "cylinder = { from = [X, -1.0, -0.03], to = [X, 1.0, -0.03], radius = 0.0298, infinite = true }",
        "motion = \"fixed\"",
    ),
    (
        "cone = { from = [X, 0.0, -0.0076], to = [X, 0.0, 0.0164], radii = [0.0, 0.05] }",
        "motion = { driven = [\"rotation.x\", \"rotation.z\", \"x\"] }\ninput = \"smooth\"",
    ),
    (
        "revolution = { origin = [X, 0.0, 0.0], axis = [0.0, 0.0, 1.0], profile = [[0.0, -0.004], [0.01, 0.0], [0.03, 0.0], [0.035, 0.02]] }",
        "motion = { prescribed = { z = { trapezoid = { distance = 5e-4, speed = 0.5, acceleration = 100.0 } } } }",
    ),
    (
        "mesh = { file = \"bumps.obj\", offset = [X, 0.0, 0.0], sides = 2 }",
        "mass = 0.01\nmotion = { free = [\"x\"], loaded = { z = 0.3 } }",
    ),
    (
        "mesh = { file = \"bumps.obj\", offset = [X, 0.0, 0.0], rotation = [0.0, 0.0, 1.0], sides = 2 }",
        "motion = { servo = { z = { target = -2.0, speed = 0.05 } } }",
    ),
    ("mesh = { file = \"bumps.obj\", offset = [X, 0.0, 0.0], sides = 2 }", "nodes = \"driven\""),
    (
        "particles = { set = \"group\" }",
        "motion = { free = [\"x\", \"y\", \"z\", \"rotation.x\", \"rotation.y\", \"rotation.z\"] }",
    ),
    (
        "plane = { point = [X + 0.0175, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }",
        "motion = { prescribed = { x = { table = \"way.csv\" } }, driven = [\"rotation.y\"] }",
    ),
];

/// A square of 60 mm of random heights as an OBJ file.
fn bumps() -> Vec<u8> {
    let height = |i: usize, j: usize| 4e-4 * (((i * 37 + j * 101) % 17) as f64 / 17.0 - 0.5);
    let mut text = String::new();
    for i in 0..7 {
        for j in 0..7 {
            text += &format!("v {:?} {:?} {:?}\n", 0.01 * i as f64 - 0.03, 0.01 * j as f64 - 0.03, height(i, j));
        }
    }
    for i in 0..6 {
        for j in 0..6 {
            let a = 7 * i + j + 1;
            text += &format!("f {} {} {}\nf {} {} {}\n", a, a + 7, a + 8, a, a + 8, a + 1);
        }
    }
    text.into_bytes()
}

/// A sphere of the list.
fn sphere([x, y, z]: [f64; 3], down: f64) -> String {
    format!("{{ position = [{x:?}, {y:?}, {z:?}], velocity = [0.1, 0.05, {down:?}], radius = {RADIUS:?} }}")
}

/// Eighteen spheres over the middle of a station, in two layers that do not stand straight above each other.
fn over(station: usize) -> Vec<String> {
    let place = |k: usize| {
        let [i, j, layer] = [k % 3, k / 3 % 3, k / 9].map(|it| it as f64);
        let shift = if layer > 0.0 { 2e-3 } else { 0.0 };
        let height = RADIUS + 5e-4 + 1e-4 * ((k * 7 + station) % 5) as f64;
        [APART * station as f64 + 0.0103 * (i - 1.0) + shift, 0.0104 * (j - 1.0) + shift, height + 0.0107 * layer]
    };
    (0..18).map(|k| sphere(place(k), -0.4)).collect()
}

/// The scene with this many threads.
fn scene(threads: usize) -> Arc<Scene> {
    scene_of(threads, |motion| motion)
}

/// The scene with this many threads, in which the motions of the stations became others.
fn scene_of(threads: usize, other: impl Fn(&'static str) -> &'static str) -> Arc<Scene> {
    let (text, files) = text_of(threads, other);
    scene_with(&text, files)
}

/// Its text and files.
pub(crate) fn text_of(threads: usize, other: impl Fn(&'static str) -> &'static str) -> (String, Files) {
    let mut boundaries = String::new();
    let mut spheres = Vec::new();
    let mut group = Vec::new();
    for (station, (shape, motion)) in STATIONS.into_iter().enumerate() {
        let middle = APART * station as f64;
        let shape = shape.replace("X - 0.03", &format!("{:?}", middle - 0.03));
        let shape = shape.replace("X + 0.0175", &format!("{:?}", middle + 0.0175)).replace('X', &format!("{middle:?}"));
        let material = if shape.starts_with("particles") { "" } else { "material = \"stone\"\n" };
        boundaries += &format!("[boundary.s{station:02}]\n{material}{shape}\n{}\n", other(motion));
        spheres.extend(over(station));
        if !material.is_empty() {
            continue;
        }
        group.extend((0..16).map(|k| {
            let [i, j] = [k % 4, k / 4].map(|it| it as f64);
            sphere([middle + 0.0102 * (i - 1.0), 0.0102 * (j - 1.0), -RADIUS], 0.0)
        }));
    }
    let text = format!(
        r#"
gravity = [0.0, 0.5, -9.81]
[run]
step = {STEP:?}
threads = {threads}
max_overlap = 0.5
[material.stone]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[pair.stone.stone]
restitution = 0.5
friction = 0.4
rolling_friction = 0.1
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[contact.touch.rolling.cdt]
[particles.all]
material = "stone"
list = [{}]
[particles.group]
material = "stone"
list = [{}]
[particles.above]
material = "stone"
lattice = {{ kind = "simple_cubic", origin = [-0.06, -0.025, 0.13], counts = [114, 6, 3], spacing = 9.999e-3, radius = 5e-3 }}
{boundaries}
[output]
energy = true
"#,
        spheres.join(", "),
        group.join(", ")
    );
    let way = "time,x\n0.0,0.0\n0.004,-8e-4\n0.01,2e-4\n";
    (text, BTreeMap::from([("bumps.obj".to_owned(), bumps()), ("way.csv".to_owned(), way.into())]))
}

/// Moves all inputs and advances, from one communication step to another. Says of each station whether something pushed it.
fn run(simulation: &mut Simulation, numbers: std::ops::Range<u32>) -> [bool; 12] {
    let mut pushed = [false; 12];
    for number in numbers {
        let swing = f64::from(number % 4) - 1.5;
        for (boundary, axis, share) in [
            (0, 2, 0.05),  // [N]
            (0, 3, 1e-4),  // [N m]
            (1, 2, 1e-4),  // [m]
            (3, 2, 0.05),  // [m/s]
            (3, 4, 2.0),   // [rad/s]
            (5, 0, 1e-4),  // [m]
            (5, 3, 5e-3),  // [rad]
            (5, 5, 1e-2),  // [rad]
            (7, 2, 0.2),   // [N]
            (8, 2, -1.0),  // [N]
            (11, 4, 1e-4), // [rad]
        ] {
            simulation.set_input(BoundaryIndex(boundary), axis, share * swing);
        }
        for node in 0..49 {
            simulation.set_node(BoundaryIndex(9), (node, 2), 1e-4 * swing * (node % 3) as f64);
        }
        simulation.advance(30.0 * STEP).unwrap_or_else(|error| panic!("{error}"));
        for (pushed, moved) in pushed.iter_mut().zip(&simulation.state().boundaries) {
            *pushed |= moved.mean_force != [0.0; 3];
        }
    }
    pushed
}

/// The scene after some communication steps, in a lane width.
fn after(threads: usize, width: Option<Width>, numbers: u32) -> Simulation {
    let mut simulation = Simulation::new(scene(threads)).unwrap_or_else(|error| panic!("{error}"));
    if let Some(width) = width {
        simulation.set_width(width);
    }
    run(&mut simulation, 0..numbers);
    assert_eq!(simulation.threads(), threads);
    simulation
}

#[test]
fn any_number_of_threads_any_width_and_a_saved_state_give_the_same_bits() {
    let mut first = Simulation::new(scene(1)).unwrap_or_else(|error| panic!("{error}"));
    let before = run(&mut first, 0..6);
    let saved = first.state().to_bytes(0);
    let later = run(&mut first, 6..12);
    assert!((0..12).all(|station| before[station] || later[station]), "touched: {before:?}, {later:?}");
    assert!(later.iter().filter(|pushed| **pushed).count() > 8, "touched after the state was saved: {later:?}");
    let ledger = first.state().ledger.as_ref().expect("a book is kept");
    let residual = first.energy_residual().expect("a book is kept");
    assert!(residual.abs() < 1e-11 * ledger.turnover, "{residual:e} J of {:e} J", ledger.turnover);
    let expected = first.state().to_bytes(0);
    for threads in [2, 3, 4] {
        assert!(after(threads, None, 12).state().to_bytes(0) == expected, "{threads} threads");
    }
    for width in Width::ALL.into_iter().filter(|width| width.offered()) {
        assert!(after(1, Some(width), 12).state().to_bytes(0) == expected, "{width:?}");
    }
    let state = State::from_bytes(&saved, 0).unwrap_or_else(|error| panic!("{error}"));
    let mut again = Simulation::resume(scene(3), state).unwrap_or_else(|fault| panic!("{fault}"));
    run(&mut again, 6..12);
    assert!(again.state().to_bytes(0) == expected, "gone on from bytes");
}

#[test]
fn work_on_every_shape_is_mean_force_times_displacement_and_mean_moment_times_turn() {
    let driven = "motion = { driven = [\"x\", \"y\", \"z\", \"rotation.y\"] }";
    let nodes = |motion: &str| motion.starts_with("nodes");
    let mut simulation = Simulation::new(scene_of(1, |motion| if nodes(motion) { "" } else { driven }))
        .unwrap_or_else(|error| panic!("{error}"));
    let mut turnover = [0.0_f64; STATIONS.len()];
    for number in 0..20_u32 {
        let before = simulation.state().boundaries.clone();
        for station in (0..STATIONS.len()).filter(|station| !nodes(STATIONS[*station].1)) {
            let swing = f64::from((number + station as u32) % 4) - 1.5;
            for (axis, share) in [(0, 5e-5), (1, 3e-5), (2, 1e-4), (4, 2e-3)] {
                simulation.set_input(BoundaryIndex(station as u32), axis, share * swing);
            }
        }
        simulation.advance(30.0 * STEP).unwrap_or_else(|error| panic!("{error}"));
        for (station, (before, after)) in before.iter().zip(&simulation.state().boundaries).enumerate() {
            let product = |axis: usize| {
                after.mean_force[axis] * (after.displacement[axis] - before.displacement[axis])
                    + after.mean_moment[axis] * (after.rotation[axis] - before.rotation[axis])
            };
            let (found, expected) = (after.work - before.work, -(0..3).map(product).sum::<f64>());
            turnover[station] += found.abs();
            let most = 1e-12 * turnover[station].max(1e-6);
            assert!((found - expected).abs() <= most, "station {station}: {found:e} J, not {expected:e} J");
        }
    }
    let worked = (0..STATIONS.len()).filter(|station| turnover[*station] > 1e-6).count();
    assert_eq!(worked, STATIONS.len() - 1, "{turnover:?} J");
}
