//! Heat has the same bits for any number of threads, and after a state is restored.

use super::balance::pile;
use crate::support::start;
use cograin::simulation::Simulation;
use cograin::state::State;

/// A pile on a floor that takes up heat.
fn begin(threads: usize) -> Simulation {
    let text = pile("temperature = 350.0\nheat_capacity = 1.0", 100.0);
    start(&text.replace("[run]\n", &format!("[run]\nthreads = {threads}\n")))
}

#[test]
fn threads_change_no_bit() {
    let mut states = Vec::new();
    for threads in [1, 2, 3] {
        let mut simulation = begin(threads);
        simulation.advance(6e-3).unwrap();
        states.push(simulation.state().clone());
    }
    assert!(states.windows(2).all(|two| two[0] == two[1]));
}

#[test]
fn a_restored_state_goes_on_with_the_same_bits() {
    let mut simulation = begin(1);
    simulation.advance(3e-3).unwrap();
    let bytes = simulation.state().to_bytes(0);
    let mut other = begin(2);
    other.restore(&State::from_bytes(&bytes, 0).unwrap()).unwrap();
    for simulation in [&mut simulation, &mut other] {
        simulation.advance(3e-3).unwrap();
    }
    assert!(simulation.state() == other.state());
}
