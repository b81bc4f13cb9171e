//! A time step in steady state asks for no memory: with planes, a group, a mesh, bonds and suppressed contacts, on one thread
//! and on two.

use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use std::alloc::{GlobalAlloc, Layout, System};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The system's allocator, counted.
struct Counting;

/// How often memory was asked for.
static ASKED: AtomicU64 = AtomicU64::new(0);

// SAFETY: everything is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ASKED.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ASKED.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Layers of spheres that press on each other, in a box of planes with a mesh as its floor; the topmost ones are a group that is
/// driven. Lists reach so far that none is made anew.
const SCENE: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 1.0e-6
threads = THREADS
skin = 4.0e-4
[material.ice]
youngs_modulus = 1.0e8
poissons_ratio = 0.3
density = 1000.0
[pair.ice.ice]
restitution = 0.5
friction = 0.5
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.loose]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 0.0], counts = [16, 16, 8], spacing = 1.99e-3, radius = 1.0e-3 }
[particles.lid]
material = "ice"
lattice = { kind = "simple_cubic", origin = [0.0, 0.0, 15.92e-3], counts = [16, 16, 1], spacing = 1.99e-3, radius = 1.0e-3 }
[boundary.west]
plane = { point = [-0.995e-3, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "ice"
[boundary.south]
plane = { point = [0.0, -0.995e-3, 0.0], normal = [0.0, 1.0, 0.0] }
material = "ice"
[boundary.floor]
mesh = { file = "floor.stl" }
material = "ice"
[boundary.lid]
particles = { set = "lid" }
motion = { driven = ["z"] }
[output]
energy = ENERGY
"#;

/// Bonds between the loose spheres that suppress their contacts, and bonds of them to a plane.
const BONDS: &str = r#"
[bond.glue]
between = ["loose", "loose"]
create_distance = 2.1e-3
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
contact = "CONTACT"
[bond.wall]
between = ["loose", "west"]
create_distance = 2.1e-3
normal_stiffness = 1.0e10
tangential_stiffness = 4.0e9
contact = "CONTACT"
"#;

/// The floor: two triangles as an STL file.
fn floor() -> Vec<u8> {
    let [low, high] = [-0.1, 0.1];
    let corners = [[low, low], [high, low], [high, high], [low, high]];
    let mut text = "solid floor\n".to_owned();
    for triangle in [[0, 1, 2], [0, 2, 3]] {
        text += "facet normal 0 0 1\nouter loop\n";
        for [x, y] in triangle.map(|corner: usize| corners[corner]) {
            text += &format!("vertex {x} {y} -0.000995\n");
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

/// How often time steps ask for memory, when some have been made.
fn asked(threads: usize, energy: bool, more: &str) -> u64 {
    let text = SCENE.replace("THREADS", &threads.to_string()).replace("ENERGY", &energy.to_string()) + more;
    let files = BTreeMap::from([("floor.stl".to_owned(), floor())]);
    let source = Source { name: "scene.toml".into(), text, files };
    let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
    let mut simulation = Simulation::new(Arc::new(scene)).expect("the scene starts");
    simulation.advance(4.0e-6).expect("it runs");
    let (mut asked, mut steady) = (0, 0);
    for _ in 0..6 {
        let work = |simulation: &Simulation| (simulation.state().clock.rebuilds, simulation.state().foresight.looks);
        let (before, done) = (ASKED.load(Ordering::Relaxed), work(&simulation));
        simulation.advance(1.0e-6).expect("it runs");
        // Lists and the stable time step are found now and then, with room of their own.
        if work(&simulation) == done {
            asked += ASKED.load(Ordering::Relaxed) - before;
            steady += 1;
        }
    }
    assert!(steady >= 3, "{steady} steps without new lists and a new stable time step");
    assert!(simulation.state().walls.iter().all(|list| !list.particle.is_empty()), "every surface is touched");
    asked
}

#[test]
fn a_step_in_steady_state_asks_for_no_memory() {
    let mut found = Vec::new();
    for (threads, energy, contact) in [(1, true, "none"), (2, false, "without_normal")] {
        let bonds = BONDS.replace("CONTACT", contact);
        found.push(((threads, energy, contact), asked(threads, energy, &bonds)));
    }
    assert!(found.iter().all(|(_, asked)| *asked == 0), "{found:?}");
}
