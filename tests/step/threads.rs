//! Which threads work.

use crate::support::start;
use cograin::simulation::LoopEvent;
use std::sync::Mutex;
use std::thread::{self, ThreadId};

/// The threads that did a piece of a loop.
static WORKERS: Mutex<Vec<ThreadId>> = Mutex::new(Vec::new());

/// Notes who did a piece.
fn note(event: LoopEvent) {
    let (mut workers, this) = (WORKERS.lock().unwrap(), thread::current().id());
    if matches!(event, LoopEvent::Done(_)) && !workers.contains(&this) {
        workers.push(this);
    }
}

#[test]
fn one_thread_works_on_few_particles_even_where_many_may_come() {
    let mut simulation = start(
        r#"
[run]
step = 1e-5
threads = 2
[material.glass]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[pair.glass.glass]
restitution = 0.6
[contact.all.normal.hertz]
[particles.row]
material = "glass"
lattice = { kind = "simple_cubic", radius = 0.001, spacing = 0.00196, counts = [100, 4, 4], origin = [0.0, 0.0, 0.0] }
[region.aside]
box = [[0.0, 0.1, 0.0], [0.1, 0.2, 0.1]]
[insertion.feed]
region = "aside"
material = "glass"
sizes = { radius = 0.001 }
count_rate = 0.0
"#,
    );
    simulation.watch_loops(note);
    simulation.advance(2e-3).unwrap();
    assert_eq!(*WORKERS.lock().unwrap(), [thread::current().id()]);
}
