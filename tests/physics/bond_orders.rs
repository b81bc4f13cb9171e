//! With which power of the time step the error of dashpots of bonds falls: the first where they see the velocities of half a
//! step ago, the second where these are predicted.
//!
//! `cargo test --test library bond_orders -- --nocapture` prints the errors.

use super::orders::{Case, order};
use crate::support::checked;
use cograin::contact::Scheme;
use cograin::scene::SceneDraft;

/// Three bonded spheres, of which the last may be bonded to a plane, stretched, sheared, bent and twisted as they spin.
const SCENE: &str = r#"
[run]
scheme = "SCHEME"
[material.a]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.3
[bond.chain]
between = ["spheres", "spheres"]
LAW
[particles.spheres]
material = "a"
list = [
{ position = [0.0, 0.0, 0.005], radius = 0.005, velocity = [0.03, 0.02, -0.01], angular_velocity = [1.0, 2.0, 20.0] },
{ position = [0.001, 0.0, 0.01492], radius = 0.005, velocity = [-0.02, 0.04, 0.02], angular_velocity = [3.0, -2.0, 14.0] },
{ position = [0.001, 0.002, 0.02464], radius = 0.004, velocity = [0.05, -0.02, -0.02], angular_velocity = [-5.0, 4.0, 22.0] },
]
"#;

/// A plane below the first sphere, which is bonded to it.
const FLOOR: &str = r#"
[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "a"
[bond.foot]
between = ["spheres", "floor"]
LAW
"#;

/// What both bonds have.
const LAW: &str = r#"formulation = "FORMULATION"
create = "start"
create_distance = 0.0101
normal_stiffness = 1.3e7
tangential_stiffness = 5.0e6
damping.viscous = { normal_force = RATIO, tangential_force = RATIO, normal_torque = RATIO, tangential_torque = RATIO }"#;

/// A scene with this scheme, formulation and damping ratio; with a foot, if asked for.
fn scene(scheme: Scheme, formulation: &str, ratio: f64, foot: bool) -> SceneDraft {
    let text = format!("{SCENE}{}", if foot { FLOOR } else { "" });
    let text = text.replace("LAW", LAW).replace("SCHEME", scheme.name()).replace("FORMULATION", formulation);
    let text = text.replace("RATIO", &format!("{ratio:?}"));
    checked(&text).into_draft()
}

/// The motions: formulations and damping ratios.
fn cases() -> [Case; 4] {
    let case = |name, scene| Case { name, scene, time: 0.01, steps: 400, phases: 1 };
    [
        case("finite_rotation, ratio 0.05", |scheme, _| scene(scheme, "finite_rotation", 0.05, false)),
        case("finite_rotation, ratio 1", |scheme, _| scene(scheme, "finite_rotation", 1.0, false)),
        case("incremental, ratio 0.3", |scheme, _| scene(scheme, "incremental", 0.3, false)),
        case("finite_rotation, ratio 0.3, at a plane", |scheme, _| scene(scheme, "finite_rotation", 0.3, true)),
    ]
}

#[test]
fn predicted_dashpots_of_bonds_are_of_second_order() {
    for case in cases() {
        let found = [Scheme::Engine, Scheme::Predicted].map(|scheme| order(&case, scheme));
        assert!(found[0] < 1.3 && found[1] >= 1.9, "{}: {found:?}", case.name);
    }
}
