//! Saved states that were changed and given right checksums again: each is refused, or makes a step.
//!
//! Kernels trust the slots in the lists, and lists come from the bytes. What is tried here goes through the same door as a
//! checkpoint and a state from a host.

use crate::support;
use cograin::results::{Checkpoint, write_checkpoint};
use cograin::run::{EarlierResults, RunOrder, Start};
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::State;
use cograin::state::contacts::BONDED;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use xxhash_rust::xxh3::xxh3_64;

/// Where the checksum stands in a snapshot; the payload follows it.
const CHECKSUM: usize = 28;

/// A heap over a floor beside a wall and a sheet whose nodes are driven, with bonds that suppress contacts, bonds to a plane, a free group, a driven group
/// and the energy book: every part of a state has something in it.
const SCENE: &str = r#"
gravity = [0.3, 0.0, -9.81]
[run]
step = 1.0e-6
threads = 1
max_overlap = 0.2
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[material.b]
youngs_modulus = 2.0e7
poissons_ratio = 0.25
density = 1500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
[pair.a.b]
restitution = 0.6
friction = 0.3
[pair.b.b]
restitution = 0.4
friction = 0.2
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.heap]
material = "a"
file = "heap.csv"
[particles.top]
material = "b"
file = "top.csv"
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
motion = { driven = ["z"] }
[boundary.side]
plane = { point = [-0.00099, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "b"
[boundary.mat]
mesh = { file = "mat.obj" }
material = "b"
nodes = "driven"
[boundary.grip]
particles = { set = "top", box = [[-1.0, -1.0, -1.0], [0.003, 1.0, 1.0]] }
motion = { driven = ["x", "rotation.z"] }
[boundary.raft]
particles = { set = "top", box = [[0.003, -1.0, -1.0], [1.0, 1.0, 1.0]] }
motion = { free = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"] }
[bond.glue]
between = ["heap", "heap"]
create_distance = 2.0e-3
contact = "without_normal"
normal_stiffness = 1e9
tangential_stiffness = 4e8
damping = { viscous = { normal_force = 1e-4, tangential_force = 1e-4, normal_torque = 1e-4, tangential_torque = 1e-4 } }
breakage = { max_distance = 2.2e-3 }
[bond.foot]
between = ["heap", "floor"]
create_distance = 2.05e-3
normal_stiffness = 1e9
tangential_stiffness = 4e8
[output]
energy = true
"#;

/// A sheet behind the heap, of two triangles.
const MAT: &str =
    "v -0.01 -0.00099 -0.01\nv 0.02 -0.00099 -0.01\nv 0.02 -0.00099 0.02\nv -0.01 -0.00099 0.02\nf 1 3 2\nf 1 4 3\n";

/// The scene.
fn scene() -> Arc<Scene> {
    scene_with(SCENE)
}

/// A scene of the same particles.
fn scene_with(text: &str) -> Arc<Scene> {
    let block = |counts: [u32; 3], height: f64, distance: f64, first: u32| {
        let mut text = String::from("id,x,y,z,radius\n");
        let (mut id, [columns, rows, layers]) = (first, counts);
        for layer in 0..layers {
            for row in 0..rows {
                for column in 0..columns {
                    let [x, y, z] = [column, row, layer].map(|step| distance * f64::from(step));
                    let radius = if (column + row) % 3 == 0 { 0.98e-3 } else { 1.0e-3 };
                    text += &format!("{id},{x:?},{y:?},{:?},{radius:?}\n", z + height);
                    id += 1;
                }
            }
        }
        text.into_bytes()
    };
    let files = BTreeMap::from([
        ("heap.csv".to_owned(), block([4, 3, 2], 0.99e-3, 1.99e-3, 0)),
        ("top.csv".to_owned(), block([4, 3, 1], 5.0e-3, 1.99e-3, 100)),
        ("mat.obj".to_owned(), MAT.into()),
    ]);
    support::scene_with(text, files)
}

/// How a state ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Ending {
    /// Its bytes were no state.
    Unread,
    /// It was refused.
    Refused,
    /// A time step was made, or refused with a reason.
    Stepped,
}

/// Reads a state, looks through it and goes on from it.
fn go_on(bytes: &[u8], scene: &Arc<Scene>) -> Ending {
    let Ok(state) = State::from_bytes(bytes, scene.fingerprint) else { return Ending::Unread };
    let Ok(mut simulation) = Simulation::resume(Arc::clone(scene), state) else { return Ending::Refused };
    // steps with these lists, and with lists that are made of them
    let _ = simulation.advance(2.0e-6);
    simulation.renew_lists();
    let _ = simulation.advance(2.0e-6);
    let _ = (simulation.elastic_energy(), simulation.contacts().len(), simulation.bonds().len());
    Ending::Stepped
}

/// Changes some bytes of the payload and repairs the checksum.
fn forge(bytes: &mut [u8], chance: &mut ChaCha8Rng) {
    let payload = CHECKSUM + 8;
    for _ in 0..1 + chance.next_u32() % 3 {
        let place = payload + chance.next_u32() as usize % (bytes.len() - payload);
        let number = chance.next_u32();
        match number % 4 {
            0 => bytes[place] = (number >> 8) as u8,
            1 => bytes[place] = u8::MAX,
            2 => bytes[place] ^= 1 << (number >> 8 & 7),
            _ => {
                let other = payload + (number >> 8) as usize % (bytes.len() - payload - 4);
                let place = place.min(bytes.len() - 4);
                bytes.copy_within(other..other + 4, place);
            }
        }
    }
    let checksum = xxh3_64(&bytes[payload..]);
    bytes[CHECKSUM..payload].copy_from_slice(&checksum.to_le_bytes());
}

#[test]
fn ten_thousand_forged_states_are_refused_or_make_a_step() {
    let scene = scene();
    let mut simulation = Simulation::new(Arc::clone(&scene)).unwrap();
    simulation.advance(3.0e-5).unwrap();
    let state = simulation.state();
    let suppressed = state.contacts.iter().flat_map(|list| &list.flags).filter(|flags| **flags & BONDED != 0).count();
    assert!(suppressed > 10, "bonds suppress contacts");
    assert!(state.bonds.iter().all(|list| list.first.len() > 5), "there are bonds of both kinds");
    assert!(state.contacts[0].first.len() > 10 && state.walls.iter().all(|list| !list.particle.is_empty()));
    let bytes = state.to_bytes(scene.fingerprint);
    assert_eq!(go_on(&bytes, &scene), Ending::Stepped);

    let mut chance = ChaCha8Rng::seed_from_u64(9);
    let mut endings = BTreeMap::new();
    for number in 0..10_000 {
        let mut forged = bytes.clone();
        forge(&mut forged, &mut chance);
        let ending = catch_unwind(AssertUnwindSafe(|| go_on(&forged, &scene)));
        let ending = ending.unwrap_or_else(|_| panic!("state {number} panics"));
        *endings.entry(ending).or_insert(0) += 1;
    }
    assert!(endings[&Ending::Refused] > 1000 && endings[&Ending::Stepped] > 1000, "{endings:?}");
}

#[test]
fn a_thousand_forged_checkpoints_are_refused_by_another_scene_or_make_a_step() {
    let mut simulation = Simulation::new(scene()).unwrap();
    simulation.advance(3.0e-5).unwrap();
    let path = std::env::temp_dir().join(format!("cograin_forged_{}.cograin", std::process::id()));
    write_checkpoint(&path, simulation.state(), simulation.scene(), "scene.toml").unwrap();
    let whole = std::fs::read(&path).unwrap();
    let lines = whole.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(1).unwrap().0 + 1;
    let rougher = scene_with(&SCENE.replace("friction = 0.5", "friction = 0.6"));
    let go_on = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let Ok(checkpoint) = Checkpoint::read(&path) else { return Ending::Unread };
        let Ok(mut taken) = checkpoint.taken_over(&rougher) else { return Ending::Refused };
        assert!(!taken.goes_on);
        let _ = taken.simulation.advance(2.0e-6);
        Ending::Stepped
    };
    assert_eq!(go_on(&whole), Ending::Stepped);
    let mut chance = ChaCha8Rng::seed_from_u64(4);
    let mut endings = BTreeMap::new();
    for number in 0..1000 {
        let mut forged = whole.clone();
        forge(&mut forged[lines..], &mut chance);
        let ending = catch_unwind(AssertUnwindSafe(|| go_on(&forged)));
        *endings.entry(ending.unwrap_or_else(|_| panic!("state {number} panics"))).or_insert(0) += 1;
    }
    std::fs::remove_file(&path).unwrap();
    assert!(endings[&Ending::Refused] > 100 && endings[&Ending::Stepped] > 100, "{endings:?}");
}

/// Of 18,000 such checkpoints some 30 ended a run with status 0 and a summary whose energies were null.
#[test]
fn a_run_from_a_forged_checkpoint_ends_with_whole_books_or_in_words() {
    let scene = scene_with(
        &SCENE
            .replace("[run]", "[run]\nend = 3.2e-5")
            .replace("energy = true", "energy = true\nlosses = true\nhistory_interval = 1e-6"),
    );
    let mut simulation = Simulation::new(Arc::clone(&scene)).unwrap();
    simulation.advance(3.0e-5).unwrap();
    let folder = std::env::temp_dir().join(format!("cograin_forged_run_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("forged.cograin");
    write_checkpoint(&path, simulation.state(), &scene, "scene.toml").unwrap();
    let whole = std::fs::read(&path).unwrap();
    let lines = whole.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(1).unwrap().0 + 1;
    let start = Start::Checkpoint(path.clone());
    let stop = AtomicBool::new(false);
    let run = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let order = RunOrder {
            scene: &scene,
            scene_name: "scene.toml",
            folder: &folder.join("out"),
            end: None,
            start: &start,
            earlier_results: EarlierResults::Replace,
            inputs: None,
            stop: &stop,
        };
        let summary = match cograin::run::run(order, &mut |_| ()) {
            Ok(summary) => summary,
            Err(failure) => return Err(failure.to_string()),
        };
        let summary: serde_json::Value = serde_json::from_str(&summary.to_json()).unwrap();
        for book in ["energy", "losses", "momentum"] {
            assert!(summary[book].is_object() && !summary[book].to_string().contains("null"), "{summary:#}");
        }
        Ok(())
    };
    assert_eq!(run(&whole), Ok(()));
    let numbers = [f64::NAN, f64::INFINITY, f64::MAX, -1e300, 1e200, 1e-300, 5e-324, 0.0];
    let mut chance = ChaCha8Rng::seed_from_u64(33);
    let mut endings = BTreeMap::new();
    for number in 0..400 {
        let mut forged = whole.clone();
        let state = &mut forged[lines..];
        let place = CHECKSUM + 8 + chance.next_u32() as usize % (state.len() - CHECKSUM - 16);
        state[place..place + 8].copy_from_slice(&numbers[number % numbers.len()].to_le_bytes());
        let checksum = xxh3_64(&state[CHECKSUM + 8..]);
        state[CHECKSUM..CHECKSUM + 8].copy_from_slice(&checksum.to_le_bytes());
        let ended = catch_unwind(AssertUnwindSafe(|| run(&forged)));
        let ended = ended.unwrap_or_else(|_| panic!("checkpoint {number}, place {place}"));
        *endings.entry(ended.is_ok()).or_insert(0) += 1;
    }
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(endings[&false] > 50 && endings[&true] > 10, "{endings:?}");
}

#[test]
fn a_checkpoint_without_its_rows_is_refused_also_where_outputs_ask_for_more() {
    let mut simulation = Simulation::new(scene()).unwrap();
    simulation.advance(3.0e-5).unwrap();
    let path = std::env::temp_dir().join(format!("cograin_rows_{}.cograin", std::process::id()));
    let shown = scene_with(&SCENE.replace("energy = true", "energy = true\ncontacts = true\nframe_interval = 1e-3"));
    let go_on = |state: &State| {
        write_checkpoint(&path, state, simulation.scene(), "scene.toml").unwrap();
        Checkpoint::read(&path).unwrap().taken_over(&shown).map(|taken| taken.goes_on)
    };
    let mut state = simulation.state().clone();
    assert!(go_on(&state).unwrap());
    let rows = state.contacts[0].history.rows();
    state.contacts[0].history.clear(rows);
    let refusal = go_on(&state).unwrap_err().to_string();
    std::fs::remove_file(&path).unwrap();
    assert!(refusal.contains("history[2]: expected the rows of the law"), "{refusal}");
}

#[test]
fn a_state_is_refused_with_the_part_that_cannot_be() {
    let scene = scene();
    let simulation = Simulation::new(scene).unwrap();
    let refusal = |change: &dyn Fn(&mut State)| {
        let mut state = simulation.state().clone();
        change(&mut state);
        simulation.check(&state).unwrap_err().to_string()
    };
    assert!(simulation.check(simulation.state()).is_ok());
    assert_eq!(
        refusal(&|state| state.contacts[0].second[3] = 4000),
        "invalid state, contacts[3]: expected a second particle behind it, of this slab or the next"
    );
    assert_eq!(
        refusal(&|state| state.particles.velocity[2][3] *= 2.0),
        "invalid state, particles[2]: expected the scene's radius, mass, inertia, material and group"
    );
    assert_eq!(
        refusal(&|state| state.particles.position[1][0] = f64::NAN),
        "invalid state, position[1]: expected finite numbers"
    );
    // The energy of this spin was infinite: cells of the history were empty, with status 0.
    assert_eq!(
        refusal(&|state| state.particles.angular_velocity[1][0] = 1e300),
        "invalid state, angular_velocity[1]: expected a kinetic energy that is a number"
    );
    assert_eq!(
        refusal(&|state| state.nodes[0].force[3][2] = f64::INFINITY),
        "invalid state, nodes[3]: expected finite numbers"
    );
    assert_eq!(
        refusal(&|state| state.nodes[0].listed.truncate(3)),
        "invalid state, nodes[6]: expected columns of one length"
    );
    assert_eq!(
        refusal(&|state| state.nodes[0].boundary = 1),
        "invalid state, nodes[0]: expected the nodes of the scene's meshes"
    );
}

#[test]
fn a_step_after_which_a_sum_of_the_books_is_infinite_ends_in_words() {
    let scene = scene_with(&SCENE.replace("energy = true", "energy = true\nlosses = true"));
    let simulation = Simulation::new(Arc::clone(&scene)).unwrap();
    let huge: [fn(&mut State); 4] = [
        |state| state.ledger.as_mut().unwrap().work[..2].fill(f64::MAX),
        |state| state.losses.as_mut().unwrap().taken[..2].fill(f64::MAX),
        |state| state.bonds.iter_mut().for_each(|list| list.damped = f64::MAX),
        |state| state.boundaries.iter_mut().for_each(|boundary| boundary.work = f64::MAX),
    ];
    for change in huge {
        let mut state = simulation.state().clone();
        change(&mut state);
        let message = Simulation::resume(Arc::clone(&scene), state).unwrap().advance(2.0e-6).unwrap_err().to_string();
        assert!(message.starts_with("what the energy books sum up is not finite at t = 0.000002 s: "), "{message}");
    }
}

#[test]
fn bytes_of_another_schema_are_refused_in_words() {
    let scene = scene();
    let mut bytes = Simulation::new(Arc::clone(&scene)).unwrap().state().to_bytes(scene.fingerprint);
    bytes[15] ^= 1;
    let refusal = State::from_bytes(&bytes, scene.fingerprint).unwrap_err().to_string();
    assert!(
        refusal.starts_with("expected the schema ") && refusal.ends_with("that of another build of this program"),
        "{refusal}"
    );
}
