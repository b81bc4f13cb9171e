//! Where a simulation starts.
//!
//! The first bonds are made before start values are put, so a driven group that starts elsewhere has loaded bonds. Start values
//! leave the energy book of a reached state as it is. A settled state begins with nothing taken by damping of its bonds.

use crate::support;
use cograin::interface::{Interface, Value};
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::sync::Arc;

/// A row of bonded spheres, held at one end and driven at the other.
const BEAM: &str = r#"
[run]
step = 1e-6

[material.ice]
density = 900.0

[particles.beam]
material = "ice"
list = [
  { id = 1, position = [0.0, 0.0, 0.0], radius = 1e-3 },
  { id = 2, position = [2e-3, 0.0, 0.0], radius = 1e-3 },
  { id = 3, position = [4e-3, 0.0, 0.0], radius = 1e-3 },
  { id = 4, position = [6e-3, 0.0, 0.0], radius = 1e-3 },
]

[boundary.foot]
particles = { set = "beam", box = [[-1.0, -1.0, -1.0], [1e-3, 1.0, 1.0]] }

[boundary.tip]
particles = { set = "beam", box = [[5e-3, -1.0, -1.0], [1.0, 1.0, 1.0]] }
motion = { driven = ["z"] }

[bond.freeze]
between = ["beam", "beam"]
create_distance = 2.05e-3
normal_stiffness = 1e11
tangential_stiffness = 4e10
damping = { viscous = { normal_force = 1e-3, tangential_force = 1e-3, normal_torque = 1e-3, tangential_torque = 1e-3 } }

[output]
energy = true
"#;

/// The scene.
fn scene() -> Arc<Scene> {
    support::scene(BEAM)
}

/// Gives the tip a displacement.
fn set(simulation: &mut Simulation, displacement: f64) {
    let interface = Interface::of(simulation.scene());
    let tip = interface.find("tip.displacement.z").unwrap();
    interface.set(simulation, tip, Value::Real(displacement)).unwrap();
}

/// The value of a variable.
fn get(simulation: &Simulation, name: &str) -> f64 {
    let interface = Interface::of(simulation.scene());
    interface.value(simulation, interface.find(name).unwrap()).number()
}

/// Asserts that every book and count begins here.
fn books_begin(simulation: &Simulation) {
    for name in ["energy.dissipated", "energy.residual", "bonds.dissipated_energy", "tip.work", "bonds.broken"] {
        assert_eq!(get(simulation, name), 0.0, "{name}");
    }
    let State { bonds, boundaries, damping_impulse, particles, .. } = simulation.state();
    for list in bonds {
        assert_eq!((list.made, list.broken), (list.first.len() as u64, 0));
        assert!(list.lost.iter().all(|lost| *lost == 0.0), "{:?}", list.lost);
    }
    assert!(boundaries.iter().all(|boundary| boundary.total_impulse == [0.0; 3]));
    assert_eq!(*damping_impulse, [0.0; 3]);
    assert_eq!(particles.bonds, [[1, 0], [2, 0], [2, 0], [1, 0]]);
}

#[test]
fn a_start_value_loads_the_bonds_of_the_scene_as_it_was_built() {
    for displacement in [1e-5, 1e-3, 5e-3] {
        let mut simulation = Simulation::new(scene()).unwrap();
        let built = simulation.state().clone();
        set(&mut simulation, displacement);
        simulation.place(None).unwrap();
        assert_eq!(get(&simulation, "bonds.intact"), 3.0, "at {displacement} m");
        assert!(get(&simulation, "tip.force.z") < 0.0, "the bonds pull back at {displacement} m");
        books_begin(&simulation);

        let mut resumed = Simulation::resume(scene(), built.clone()).unwrap();
        set(&mut resumed, displacement);
        resumed.place(Some(&built)).unwrap();
        assert_eq!(resumed.state(), simulation.state(), "from the scene and from its state at {displacement} m");
    }
}

#[test]
fn the_last_start_value_counts_whatever_was_set_before() {
    let mut once = Simulation::new(scene()).unwrap();
    set(&mut once, 1e-4);
    once.place(None).unwrap();
    let mut often = Simulation::new(scene()).unwrap();
    for displacement in [-3e-3, 8e-3, 1e-4] {
        set(&mut often, displacement);
        often.place(None).unwrap();
    }
    assert_eq!(once.state(), often.state());
    set(&mut often, 0.0);
    often.place(None).unwrap();
    let mut untouched = Simulation::new(scene()).unwrap();
    untouched.place(None).unwrap();
    assert_eq!(often.state(), untouched.state());
    assert_eq!(untouched.state(), Simulation::new(scene()).unwrap().state());
}

/// A state in which bonds have been damped.
fn reached() -> State {
    let mut simulation = Simulation::new(scene()).unwrap();
    set(&mut simulation, 2e-5);
    simulation.advance(2e-4).unwrap();
    assert!(get(&simulation, "bonds.dissipated_energy") > 0.0);
    assert!(get(&simulation, "energy.dissipated") != 0.0);
    simulation.state().clone()
}

#[test]
fn books_begin_whole_in_a_reached_state_with_and_without_a_start_value() {
    let mut begun = Simulation::resume(scene(), reached()).unwrap();
    begun.open_books();
    books_begin(&begun);
    let from = begun.state().clone();
    for displacement in [2e-5, 3e-5] {
        set(&mut begun, displacement);
        begun.place(Some(&from)).unwrap();
        books_begin(&begun);
    }
    begun.advance(1e-4).unwrap();
    let (residual, kinetic) = (get(&begun, "energy.residual"), get(&begun, "energy.kinetic"));
    assert!(residual.abs() < 1e-9 * kinetic, "{residual} J of {kinetic} J");
}

#[test]
fn every_count_of_a_settled_state_begins_anew() {
    books_begin(&Simulation::settled(scene(), reached()).unwrap());
}

#[test]
fn a_communication_step_that_fails_leaves_the_state_of_its_beginning() {
    let mut simulation = Simulation::new(scene()).unwrap();
    for number in 0..100 {
        set(&mut simulation, 1e-7 * f64::from(number % 7));
        simulation.advance_or_roll_back(2e-6).unwrap();
        if number % 9 == 0 {
            let before = simulation.state().clone();
            set(&mut simulation, 1.0);
            let error = simulation.advance_or_roll_back(1e-6 * f64::from(5 + number % 5)).unwrap_err();
            let mut asked = before.clone();
            asked.boundaries[1].target[2] = 1.0;
            assert!(*simulation.state() == asked, "after {number} steps: {error}");
        }
    }
}

#[test]
fn an_interval_is_stopped_from_outside_and_taken_back() {
    let mut simulation = Simulation::new(scene()).unwrap();
    let stop = Arc::default();
    simulation.stop_when(&stop);
    simulation.advance_or_roll_back(5e-6).unwrap();
    let before = simulation.state().clone();
    stop.store(true, std::sync::atomic::Ordering::Relaxed);
    let error = simulation.advance_or_roll_back(1.0).unwrap_err().to_string();
    assert!(error.starts_with("stopped at t = "), "{error}");
    assert_eq!(*simulation.state(), before);
}
