//! Schemes of `[run] scheme` and what `accuracy` makes of them: chosen by a word, with the same bits whatever the lane width, the number of threads,
//! and whether a state was saved on the way.

use crate::support::checked;
use cograin::contact::Scheme;
use cograin::lanes::Width;
use cograin::scene::{Accuracy, Scene, Step};
use cograin::simulation::Simulation;
use cograin::state::State;
use std::sync::Arc;

/// A cloud that falls on a plane, on a turning drum's wall and on itself.
const SCENE: &str = r#"
gravity = [0.3, 0.0, -9.81]
[run]
step = 2.0e-5
RUN
[material.a]
youngs_modulus = 1.0e7
poissons_ratio = 0.3
density = 2500.0
[pair.a.a]
restitution = 0.5
friction = 0.5
rolling_friction = 0.1
rolling_viscous_damping = 0.3
[contact.touch.normal.hertz]
[contact.touch.tangential.TANGENTIAL]
[contact.touch.rolling.epsd]
[particles.heavy]
material = "a"
lattice = { kind = "simple_cubic", origin = [0.004, 0.004, 0.004], counts = [12, 12, 6], spacing = 8.0e-3, radius = 4.02e-3 }
velocity = [0.4, 0.1, -0.6]
angular_velocity = [20.0, 30.0, -40.0]
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[boundary.drum]
cylinder = { from = [0.05, -0.1, 0.03], to = [0.05, 0.2, 0.03], radius = 0.07 }
material = "a"
motion = { prescribed = { "rotation.y" = 3.0 } }
"#;

/// Bonds with dashpots between the spheres of the cloud, and to the floor.
const BONDS: &str = r#"
[bond.block]
between = ["heavy", "heavy"]
create_distance = 8.1e-3
normal_stiffness = 3.0e8
tangential_stiffness = 1.0e8
damping.viscous = { normal_force = 0.2, tangential_force = 0.3, normal_torque = 0.1, tangential_torque = 0.4 }
[bond.foot]
formulation = "incremental"
between = ["heavy", "floor"]
create_distance = 8.1e-3
normal_stiffness = 3.0e8
tangential_stiffness = 1.0e8
damping.viscous = { normal_force = 0.2, tangential_force = 0.3, normal_torque = 0.1, tangential_torque = 0.4 }
"#;

/// The scene with these lines in `[run]`, this tangential model and more tables.
fn scene(run: &str, tangential: &str, more: &str) -> Scene {
    let text = format!("{SCENE}{more}").replace("RUN", run).replace("TANGENTIAL", tangential);
    checked(&text)
}

/// Hash of the state after some communication steps in this lane width; saved and restored on the way, if asked for.
fn hash(scene: Scene, width: Width, restored: bool) -> u64 {
    let scene = Arc::new(scene);
    let mut simulation = Simulation::new(Arc::clone(&scene)).expect("it starts");
    for step in 0..4 {
        simulation.set_width(width);
        simulation.advance(2.0e-4).expect("it runs");
        if restored && step == 1 {
            let bytes = simulation.state().to_bytes(scene.fingerprint);
            let state = State::from_bytes(&bytes, scene.fingerprint).expect("its own bytes");
            simulation = Simulation::resume(Arc::clone(&scene), state).expect("its own state");
        }
    }
    simulation.state().fingerprint()
}

#[test]
fn every_scheme_has_the_same_bits_in_every_lane_width_on_any_threads_and_after_a_restart() {
    let mut seen = Vec::new();
    for (tangential, more) in [("history", ""), ("turned_history", ""), ("no_history", ""), ("history", BONDS)] {
        for scheme in ["engine", "predicted_normal", "midway", "predicted"] {
            let of = |threads: u32| scene(&format!("threads = {threads}\nscheme = \"{scheme}\""), tangential, more);
            let expected = hash(of(1), Width::Least, false);
            for width in Width::ALL.into_iter().filter(|width| width.offered()) {
                assert_eq!(hash(of(1), width, false), expected, "{tangential}, {scheme}, {width:?}");
            }
            assert_eq!(hash(of(3), Width::widest(), false), expected, "{tangential}, {scheme}, three threads");
            assert_eq!(hash(of(2), Width::widest(), true), expected, "{tangential}, {scheme}, restored");
            seen.push(expected);
        }
    }
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), 16, "each scheme moves particles in its own way");
}

#[test]
fn accuracy_chooses_scheme_and_step_where_the_scene_does_not() {
    let of = |run: &str| {
        let text = SCENE.replace("step = 2.0e-5\n", "").replace("RUN", run).replace("TANGENTIAL", "history");
        let run = checked(&text).run;
        (run.accuracy, run.scheme, run.step)
    };
    assert_eq!(of(""), (Accuracy::Standard, Scheme::PredictedNormal, Step::Following));
    assert_eq!(of("accuracy = \"high\""), (Accuracy::High, Scheme::Predicted, Step::Following));
    assert_eq!(of("accuracy = 0.02"), (Accuracy::Within(0.02), Scheme::PredictedNormal, Step::Following));
    let fixed = Step::Automatic { safety: 0.1 };
    assert_eq!(of("accuracy = \"high\"\nscheme = \"midway\"\nsafety = 0.1"), (Accuracy::High, Scheme::Midway, fixed));
    assert_eq!(of("scheme = \"predicted\""), (Accuracy::Standard, Scheme::Predicted, Step::Following));
}
