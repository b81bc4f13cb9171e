//! Saved states with changed bytes and right checksums: refused, or advanced.

use crate::advance;
use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use cograin::state::State;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};
use xxhash_rust::xxh3::xxh3_64;

/// Where the checksum stands in a snapshot; the payload follows it.
const CHECKSUM: usize = 28;

/// A sheet behind the heap, of two triangles.
const MAT: &str =
    "v -0.01 -0.00099 -0.01\nv 0.02 -0.00099 -0.01\nv 0.02 -0.00099 0.02\nv -0.01 -0.00099 0.02\nf 1 3 2\nf 1 4 3\n";

/// The scene in which every part of a state has something in it.
pub(crate) fn source() -> Source {
    let files = BTreeMap::from([("mat.obj".to_owned(), MAT.into())]);
    Source { name: "rich.toml".to_owned(), text: include_str!("rich.toml").to_owned(), files }
}

/// The scene, and bytes of a state of it.
static WHOLE: LazyLock<(Arc<Scene>, Vec<u8>)> = LazyLock::new(|| {
    let scene = Arc::new(Scene::from_source(&source()).expect("the scene is right"));
    let mut simulation = Simulation::new(Arc::clone(&scene)).expect("the scene starts");
    simulation.advance(6.0e-5).expect("the scene runs");
    let bytes = simulation.state().to_bytes(scene.fingerprint);
    (scene, bytes)
});

/// Changes a state as the bytes say, five for each change: how, where (two) and to what (two).
pub(crate) fn forge(state: &mut [u8], changes: &[u8]) {
    let payload = CHECKSUM + 8;
    let length = state.len() - payload;
    for change in changes.chunks_exact(5).take(8) {
        let number = |at: usize| usize::from(u16::from_le_bytes([change[at], change[at + 1]]));
        let (place, to) = (payload + number(1) * length / 0x1_0000, number(3));
        let last = state.len() - 8;
        match change[0] % 6 {
            0 => state[place] = change[3],
            1 => state[place] ^= 1 << (change[3] % 8),
            2 => state[place] = u8::MAX,
            // A number: none, an infinite one, a huge one, a tiny one, zero, one.
            3 => {
                let numbers = [f64::NAN, f64::INFINITY, 1e300, 1e-300, 0.0, 1.0, -1.0, f64::MIN_POSITIVE];
                state[place.min(last)..][..8].copy_from_slice(&numbers[to % numbers.len()].to_le_bytes());
            }
            4 => state[place.min(last)..][..4].copy_from_slice(&(to as u32).to_le_bytes()),
            _ => {
                let from = (payload + to * length / 0x1_0000).min(last);
                state.copy_within(from..from + 8, place.min(last));
            }
        }
    }
    let checksum = xxh3_64(&state[payload..]);
    state[CHECKSUM..payload].copy_from_slice(&checksum.to_le_bytes());
}

/// Forges a state, reads it and goes on from it.
pub(crate) fn run(bytes: &[u8]) {
    let (scene, whole) = &*WHOLE;
    let mut forged = whole.clone();
    forge(&mut forged, bytes);
    let Ok(state) = State::from_bytes(&forged, scene.fingerprint) else { return };
    let Ok(mut simulation) = Simulation::resume(Arc::clone(scene), state) else { return };
    advance(&mut simulation, 3);
    simulation.renew_lists();
    advance(&mut simulation, 3);
    let _ = (simulation.contacts().len(), simulation.bonds().len());
}
