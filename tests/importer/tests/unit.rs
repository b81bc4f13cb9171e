//! A unit of the model `piston`, loaded, stepped, saved and asked for derivatives by the crate `fmi`.

use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common, InstanceCS};
use fmi::fmi2::{Fmi2Res, Fmi2Status};
use fmi::traits::{FmiImport, FmiStatus};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The communication step \[s\].
const STEP: f64 = 1e-3;

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Exports the model `piston` under this name and opens the unit.
fn unit(name: &str) -> Fmi2Import {
    let program = std::env::var_os("COGRAIN_PROGRAM").map_or_else(|| "target/debug/cograin".into(), PathBuf::from);
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.fmu"));
    let mut command = Command::new(root().join(program));
    command.arg("export").arg(root().join("models/piston/scene.toml")).arg("-o").arg(&file).arg("--overwrite");
    let done = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    fmi::import::from_path(&file).unwrap_or_else(|error| panic!("{error}"))
}

/// The reference of a variable.
fn reference(unit: &Fmi2Import, name: &str) -> u32 {
    let mut variables = unit.model_description().model_variables.variables.iter();
    variables.find(|variable| variable.name == name).unwrap_or_else(|| panic!("no variable {name}")).value_reference
}

/// An instance that is ready to step.
fn instance(unit: &Fmi2Import) -> InstanceCS {
    let mut instance = unit.instantiate_cs("piston", false, false).unwrap_or_else(|error| panic!("{error}"));
    done(instance.setup_experiment(None, 0.0, None));
    done(instance.enter_initialization_mode());
    done(instance.exit_initialization_mode());
    instance
}

/// What a call gives that is to succeed without a warning.
#[track_caller]
fn done<E: std::fmt::Display>(result: Result<Fmi2Res, E>) {
    match result {
        Ok(Fmi2Res::OK) => {}
        Ok(other) => panic!("expected OK, found {other:?}"),
        Err(error) => panic!("{error}"),
    }
}

/// Whether a status is OK.
#[track_caller]
fn succeeded(status: Fmi2Status) {
    done(status.ok());
}

/// The value of a variable.
fn get(instance: &mut InstanceCS, reference: u32) -> f64 {
    let mut value = [f64::NAN];
    done(instance.get_real(&[reference], &mut value));
    value[0]
}

/// Moves the piston up evenly through some communication steps. Returns the force on it after each \[N\].
fn push(instance: &mut InstanceCS, [lift, force]: [u32; 2], steps: std::ops::Range<u32>) -> Vec<f64> {
    let push = |step| {
        done(instance.set_real(&[lift], &[1e-5 * f64::from(step + 1)]));
        done(instance.do_step(STEP * f64::from(step), STEP, false));
        get(instance, force)
    };
    steps.map(push).collect()
}

#[test]
fn a_saved_and_a_serialised_state_go_on_with_the_same_bits() {
    let unit = unit("states");
    let places = ["piston.displacement.z", "piston.force.z"].map(|name| reference(&unit, name));
    let mut first = instance(&unit);
    push(&mut first, places, 0..20);
    let saved = first.get_fmu_state().unwrap_or_else(|error| panic!("{error}"));
    let bytes = first.serialize_fmu_state(&saved).unwrap_or_else(|error| panic!("{error}"));
    let expected = push(&mut first, places, 20..40);
    assert!(expected.iter().any(|force| *force != expected[0]), "the force does not change: {expected:?}");

    succeeded(first.set_fmu_state(&saved));
    assert_eq!(push(&mut first, places, 20..40), expected, "after a saved state");

    let mut second = instance(&unit);
    let state = second.deserialize_fmu_state(&bytes).unwrap_or_else(|error| panic!("{error}"));
    succeeded(second.set_fmu_state(&state));
    assert_eq!(push(&mut second, places, 20..40), expected, "in another instance, from bytes");
    done(second.terminate());
}

#[test]
fn a_derivative_is_the_change_of_the_force_over_that_of_the_piston() {
    let unit = unit("derivatives");
    let [lift, force] = ["piston.displacement.z", "piston.force.z"].map(|name| reference(&unit, name));
    let mut instance = instance(&unit);
    push(&mut instance, [lift, force], 0..40);
    let mut derivative = [f64::NAN];
    done(instance.get_directional_derivative(&[force], &[lift], &[1.0], &mut derivative));

    // The last communication step made again, the piston a little higher and a little lower at its end.
    let mut again = self::instance(&unit);
    push(&mut again, [lift, force], 0..39);
    let before = again.get_fmu_state().unwrap_or_else(|error| panic!("{error}"));
    let mut ends = |lifted: f64| {
        succeeded(again.set_fmu_state(&before));
        done(again.set_real(&[lift], &[40e-5 + lifted]));
        done(again.do_step(39.0 * STEP, STEP, false));
        get(&mut again, force)
    };
    let displaced = 1e-9;
    let expected = (ends(displaced) - ends(-displaced)) / (2.0 * displaced);
    // The displacement is 1e-9 m where overlaps are about 1e-6 m: Hertz's stiffness changes by 1e-3 of itself at most.
    assert!(
        (derivative[0] - expected).abs() <= 1e-3 * expected.abs(),
        "{} N/m, by differences {expected} N/m",
        derivative[0]
    );
    assert!(expected < 0.0, "the grains push the piston down: {expected} N/m");
}
