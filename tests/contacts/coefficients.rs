//! Coefficients of contact laws are state: they can be replaced between communication steps, and are saved and restored.

use crate::support::scene;
use cograin::contact::{Properties, property};
use cograin::quantity::MaterialIndex;
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use cograin::state::State;
use std::sync::Arc;

/// A sphere that slides on a plane with friction µ.
fn sliding(friction: f64) -> Arc<Scene> {
    let text = format!(
        r#"
gravity = [0.0, 0.0, -10.0]
[run]
step = 1.0e-5
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = {friction}
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.ball]
material = "a"
list = [{{ position = [0.0, 0.0, 0.00999], radius = 0.01 }}]
velocity = [1.0, 0.0, 0.0]
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "a"
"#
    );
    scene(&text)
}

/// The properties of the scene with another coefficient of friction.
fn with_friction(scene: &Scene, friction: f64) -> Properties {
    scene.pairs[0].clone().with(&property::FRICTION, friction)
}

/// The pair of the only material.
const PAIR: [MaterialIndex; 2] = [MaterialIndex(0); 2];

#[test]
fn a_replaced_coefficient_is_that_of_a_scene_that_has_it_from_the_start() {
    let mut changed = Simulation::new(sliding(0.2)).unwrap();
    let other = with_friction(changed.scene(), 0.6);
    changed.set_pair_properties(PAIR, &other).unwrap();
    let (mut from_start, mut untouched) =
        (Simulation::new(sliding(0.6)).unwrap(), Simulation::new(sliding(0.2)).unwrap());
    for simulation in [&mut changed, &mut from_start, &mut untouched] {
        simulation.advance(1e-3).unwrap();
    }
    let velocity = |simulation: &Simulation| simulation.state().particles.velocity[0];
    assert_eq!(velocity(&changed), velocity(&from_start));
    // They slide, and the normal motion does not depend on friction.
    let [pull, less] = [&changed, &untouched].map(|simulation| simulation.contacts()[0].tangential_force[0]);
    assert!((pull / less - 3.0).abs() < 1e-12, "{pull} N and {less} N");
}

#[test]
fn coefficients_are_saved_and_restored_and_the_run_continues_bit_for_bit() {
    let scene = sliding(0.2);
    let mut simulation = Simulation::new(scene.clone()).unwrap();
    let before = simulation.state().clone();
    simulation.set_pair_properties(PAIR, &with_friction(&scene, 0.6)).unwrap();
    simulation.advance(1e-3).unwrap();
    let bytes = simulation.state().to_bytes(7);
    simulation.advance(1e-3).unwrap();
    let mut resumed = Simulation::resume(scene.clone(), State::from_bytes(&bytes, 7).unwrap()).unwrap();
    resumed.advance(1e-3).unwrap();
    assert_eq!(resumed.state().fingerprint(), simulation.state().fingerprint());
    // Back to before the change, friction is the scene's again.
    simulation.restore(&before).unwrap();
    simulation.advance(1e-3).unwrap();
    let mut untouched = Simulation::new(scene).unwrap();
    untouched.advance(1e-3).unwrap();
    assert_eq!(simulation.state().fingerprint(), untouched.state().fingerprint());
}

#[test]
fn a_missing_property_is_named_and_changes_nothing() {
    let scene = sliding(0.2);
    let mut simulation = Simulation::new(scene.clone()).unwrap();
    let before = simulation.state().fingerprint();
    let bare = scene.pairs[0].clone().without(&property::FRICTION);
    let missing = simulation.set_pair_properties(PAIR, &bare).unwrap_err();
    assert_eq!((missing[0].table.as_str(), missing[0].key), ("pair.a.a", "friction"));
    assert_eq!(simulation.state().fingerprint(), before);
}
