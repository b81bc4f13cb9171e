//! Numbers of the scene as parameters: given before the start they make another scene, tunable ones change on the way.

use super::host::{Host, Unpacked, source};
use crate::types::Status;
use crate::v2::values::*;
use crate::v2::*;
use cograin::scene::Source;
use std::collections::BTreeMap;

/// The bed with a number written otherwise.
fn with(written: &str, otherwise: &str) -> Source {
    let mut source = source();
    assert!(source.text.contains(written), "{written}");
    source.text = source.text.replace(written, otherwise);
    source
}

/// Starts an instance that was made before.
fn start(host: &Host) -> Status {
    assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    fmi2ExitInitializationMode(host.component)
}

/// Two spheres whose bond a driven end stretches.
fn bonded() -> Source {
    let text = r#"
[run]
step = 1.0e-6
threads = 1

[material.ice]
density = 900.0

[particles.pair]
material = "ice"
list = [{ position = [0.0, 0.0, 0.0], radius = 0.01 }, { position = [0.0, 0.0, 0.02], radius = 0.01 }]

[bond.neck]
between = ["pair", "pair"]
create_distance = 0.021
normal_stiffness = 1.0e12
tangential_stiffness = 5.0e11

[bond.neck.breakage]
max_normal_stress = 1.0e9

[boundary.bottom]
particles = { set = "pair", box = [[-1.0, -1.0, -1.0], [1.0, 1.0, 0.005]] }

[boundary.top]
particles = { set = "pair", box = [[-1.0, -1.0, 0.015], [1.0, 1.0, 1.0]] }
motion = { driven = ["z"] }
"#;
    Source { name: "scene.toml".to_owned(), text: text.to_owned(), files: BTreeMap::new() }
}

#[test]
fn a_parameter_given_before_the_start_makes_the_scene_that_says_so() {
    for (name, value, written, otherwise) in [
        ("pair.glass.glass.friction", 0.1, "friction = 0.4", "friction = 0.1"),
        ("material.glass.youngs_modulus", 4.0e7, "youngs_modulus = 5.0e7", "youngs_modulus = 4.0e7"),
        ("material.glass.density", 2000.0, "density = 2500.0", "density = 2000.0"),
        ("run.time_step", 2.0e-5, "step = 1.0e-5", "step = 2.0e-5"),
    ] {
        let (unit, other) = (Unpacked::new(), Unpacked::of(&with(written, otherwise), "other"));
        let (host, expected) = (Host::instantiated(&unit), Host::started(&other));
        assert_eq!(host.set(name, value), Status::Ok, "{}", host.said());
        assert_eq!(start(&host), Status::Ok, "{}", host.said());
        assert_eq!((host.get(name), expected.get(name)), (value, value));
        assert!(host.shake(0, 6) == expected.shake(0, 6), "{name}");
        assert_eq!(fmi2Reset(host.component), Status::Ok);
        assert_eq!(start(&host), Status::Ok);
        assert_ne!(host.get(name), value, "reset takes the scene's own value");
    }
}

#[test]
fn an_automatic_time_step_is_asked_for_by_0() {
    let unit = Unpacked::new();
    let host = Host::instantiated(&unit);
    assert_eq!(host.set("run.time_step", 0.0), Status::Ok);
    assert_eq!(host.set("run.safety", 0.1), Status::Ok);
    assert_eq!(start(&host), Status::Ok, "{}", host.said());
    let (step, stable) = (host.get("time_step.current"), host.get("time_step.stable"));
    assert!((step - 0.1 * stable).abs() <= 1.0e-15 * stable, "{step} of {stable}");
}

#[test]
fn an_automatic_time_step_follows_the_accuracy_that_a_host_gives() {
    let unit = Unpacked::new();
    let step = |settings: &[(&str, f64)]| {
        let host = Host::instantiated(&unit);
        assert_eq!(host.set("run.time_step", 0.0), Status::Ok);
        for (name, value) in settings {
            assert_eq!(host.set(name, *value), Status::Ok, "{}", host.said());
        }
        assert_eq!(start(&host), Status::Ok, "{}", host.said());
        host.get("time_step.current")
    };
    let standard = step(&[]);
    assert_eq!(step(&[("run.safety", 0.0)]), standard);
    assert_eq!(step(&[("run.accuracy", 0.01)]), standard);
    let exact = step(&[("run.accuracy", 1e-4)]);
    assert!(exact <= standard, "{exact} s, {standard} s by default");
}

#[test]
fn a_tunable_parameter_changes_on_the_way_and_belongs_to_the_state() {
    let unit = Unpacked::new();
    let (host, other) = (Host::instantiated(&unit), Host::started(&unit));
    let (friction, restitution) = ("pair.glass.glass.friction", "pair.glass.glass.restitution");
    assert_eq!(host.set("material.glass.youngs_modulus", 4.0e7), Status::Ok);
    assert_eq!(start(&host), Status::Ok, "{}", host.said());
    host.shake(0, 4);
    let before = host.save();
    let unchanged = host.shake(4, 6);
    assert_eq!(fmi2SetFMUstate(host.component, before), Status::Ok);
    assert_eq!(host.set(friction, 0.05), Status::Ok, "{}", host.said());
    assert_eq!(host.set(restitution, 0.9), Status::Ok, "{}", host.said());
    let after = host.save();
    let bytes = host.serialize(after);
    let changed = host.shake(4, 6);
    assert!(changed != unchanged, "less friction goes elsewhere");
    assert_eq!(fmi2SetFMUstate(host.component, before), Status::Ok);
    assert_eq!(host.get(friction), 0.4);
    assert!(host.shake(4, 6) == unchanged, "the old value is back");
    assert_eq!(fmi2SetFMUstate(host.component, after), Status::Ok);
    assert_eq!(host.get(friction), 0.05);
    assert!(host.shake(4, 6) == changed, "the new value is back");
    let state = other.deserialize(&bytes);
    assert!(!state.is_null(), "{}", other.said());
    assert_eq!(fmi2SetFMUstate(other.component, state), Status::Ok, "{}", other.said());
    assert_eq!((other.get(friction), other.get("material.glass.youngs_modulus")), (0.05, 4.0e7));
    assert!(other.shake(4, 6) == changed, "the other instance goes elsewhere");
}

#[test]
fn a_bond_breaks_where_its_strength_is_lowered_below_its_load() {
    let unit = Unpacked::of(&bonded(), "bonded");
    let host = Host::started(&unit);
    let strength = "bond.neck.breakage.max_normal_stress";
    let broken = || {
        let (reference, mut count) = (unit.reference("bonds.broken"), -1);
        // SAFETY: one reference and one value.
        assert_eq!(unsafe { fmi2GetInteger(host.component, &raw const reference, 1, &raw mut count) }, Status::Ok);
        count
    };
    // the stress is the stiffness times the stretch: 1e12 Pa/m times 1e-5 m
    assert_eq!(host.set("top.displacement.z", 1.0e-5), Status::Ok);
    assert_eq!(host.step(0.0, 1.0e-5), Status::Ok, "{}", host.said());
    let state = host.save();
    for (limit, expected) in [(1.001e7, 0), (0.999e7, 1)] {
        assert_eq!(fmi2SetFMUstate(host.component, state), Status::Ok);
        assert_eq!(host.set(strength, limit), Status::Ok, "{}", host.said());
        assert_eq!(host.step(1.0e-5, 1.0e-5), Status::Ok, "{}", host.said());
        assert_eq!((broken(), host.get(strength)), (expected, limit));
    }
}

#[test]
fn wrong_values_are_refused_in_the_words_of_the_scene_and_change_nothing() {
    let unit = Unpacked::new();
    let host = Host::instantiated(&unit);
    let friction = "pair.glass.glass.friction";
    host.refused(host.set(friction, -0.1), &[friction, "expected a number of 0 or above, found -0.1"]);
    host.refused(
        host.set("pair.glass.glass.restitution", 1.5),
        &["expected a number above 0 and at most 1, found 1.5"],
    );
    host.refused(host.set_rate(friction, 0.1), &[friction, "only inputs have rates"]);
    assert_eq!(start(&host), Status::Ok);
    let stiffness = "material.glass.youngs_modulus";
    host.refused(host.set(stiffness, 1.0e7), &[stiffness, "fixed parameter", "until the initialisation mode ends"]);
    assert_eq!((host.get(friction), host.get(stiffness)), (0.4, 5.0e7));
    let untouched = Host::started(&unit);
    assert!(host.shake(0, 3) == untouched.shake(0, 3));
}

#[test]
fn parameters_that_make_no_scene_are_told_at_the_start_and_can_be_mended() {
    let mut strict = source();
    strict.text = strict.text.replace("[run]\n", "[run]\nstrict_step = true\n");
    let unit = Unpacked::of(&strict, "strict");
    let host = Host::instantiated(&unit);
    // the unstable step is refused by the run, not by the number alone
    assert_eq!(host.set("run.time_step", 1.0), Status::Ok);
    host.refused(start(&host), &["1.000e0 s"]);
    assert_eq!(host.set("run.time_step", 1.0e-5), Status::Ok);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok, "{}", host.said());
    assert!(host.shake(0, 3) == Host::started(&unit).shake(0, 3));
}

#[test]
fn a_unit_that_begins_in_a_state_takes_other_parameters_there() {
    let scene = std::sync::Arc::new(cograin::scene::Scene::from_source(&source()).unwrap());
    let mut reached = cograin::simulation::Simulation::new(std::sync::Arc::clone(&scene)).unwrap();
    reached.advance(1.0e-3).unwrap();
    let bytes = reached.state().to_bytes(scene.fingerprint);
    let unit = Unpacked::begun(&source(), Some(bytes), "begun");
    let (host, own) = (Host::instantiated(&unit), Host::started(&unit));
    assert_eq!(host.set("pair.glass.glass.friction", 0.05), Status::Ok);
    assert_eq!(start(&host), Status::Ok, "{}", host.said());
    let (moving, expected) = (host.get("energy.kinetic"), own.get("energy.kinetic"));
    assert!(moving > 0.0 && (moving - expected).abs() <= 1.0e-12 * expected, "{moving} is not {expected}");
    assert!(host.shake(0, 6) != own.shake(0, 6), "less friction goes elsewhere");
}
