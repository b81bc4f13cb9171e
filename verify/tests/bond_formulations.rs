//! How far the formulations are from `engine_exact` on the stored cases, and what that difference does as the step is
//! halved: the table in `bond_formulations.md`.

use cograin::bond::keys::FormulationChoice;
use cograin_verify::{Options, find, replay};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// Where the cases of bonds lie.
const BOND: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/reference/bond");

/// Where the table stands.
const TABLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bond_formulations.md");

/// Steps of a case that are compared at most.
const MOST: u64 = 2000;

/// A difference below this counts as none.
const SAME: f64 = 1e-9;

/// Cases in which bonds bend in space: the difference from the engine is not small, and rounding grows in the engine.
const BENT: [&str; 17] = [
    "create_at_step",
    "cube_impact",
    "damping_on",
    "damping_smooth",
    "dissipation",
    "dissipation_and_damping",
    "energies",
    "flag_off_compressionStress",
    "flag_off_normalTorqueStress",
    "flag_off_shearStress",
    "flag_off_tensionStress",
    "free_combined",
    "free_combined_large_lambda",
    "spin_with_load",
    "triangle",
    "two_types",
    "wall_bond",
];

/// A folder of this test's own that goes when it is dropped.
struct Scratch(PathBuf);

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The steps of a case up to which rounding does not matter.
fn until(case: &Value) -> u64 {
    let steps = case["steps"].as_u64().expect("a number of steps");
    let horizon = case["reproducible"]["free_run_1e9_until_step"].as_u64().unwrap_or(steps);
    let every = case["sample_every"].as_u64().expect("a number of steps");
    let until = if horizon < steps { horizon / 2 } else { steps };
    (until.min(MOST) / every).max(1) * every
}

/// The case with as many times the steps.
fn finer(case: &Value, share: u64) -> Value {
    let mut finer = case.clone();
    finer["dt"] = json!(case["dt"].as_f64().expect("a step") / share as f64);
    finer["steps"] = json!(until(case) * share);
    finer["sample_every"] = json!(case["sample_every"].as_u64().expect("a number of steps") * share);
    if let Some(created) = case["pair_properties"]["tsCreateBond"].as_f64() {
        finer["pair_properties"]["tsCreateBond"] = json!((created as u64 - 1) * share + 1);
    }
    finer
}

/// Position, velocity and angular velocity of each row that a free run leaves.
fn run(scratch: &Path, case: &Value, formulation: FormulationChoice) -> Vec<[[f64; 3]; 3]> {
    let (folder, out) = (scratch.join("case"), scratch.join("out"));
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("case.json"), case.to_string()).expect("a file");
    let options = Options { formulation, free: true, write: Some(out.clone()), ..Options::default() };
    let report = replay(&folder, &options).expect("the case is right");
    assert!(report.stopped.is_none(), "{report}");
    let text = fs::read_to_string(out.join("case.csv")).expect("the trajectory");
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').skip(3).map(|field| field.parse().expect("a number")).collect();
        [0, 3, 6].map(|first| [numbers[first], numbers[first + 1], numbers[first + 2]])
    };
    text.lines().skip(1).map(row).collect()
}

/// The largest part of the difference of two vectors.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).fold(0.0, |most, axis| (a[axis] - b[axis]).abs().max(most))
}

/// Largest difference of two runs, over the largest displacement, velocity and angular velocity of the first.
fn difference(case: &Value, theirs: &[[[f64; 3]; 3]], ours: &[[[f64; 3]; 3]]) -> f64 {
    let particles = case["particles"].as_array().expect("particles");
    let radius = particles.iter().filter_map(|particle| particle["radius"].as_f64()).fold(f64::INFINITY, f64::min);
    let (mut scale, mut worst) = ([0.0_f64; 3], [0.0_f64; 3]);
    for (place, (a, b)) in theirs.iter().zip(ours).enumerate() {
        let start = theirs[place % particles.len()];
        for quantity in 0..3 {
            let zero = if quantity == 0 { start[0] } else { [0.0; 3] };
            scale[quantity] = scale[quantity].max(apart(a[quantity], zero));
            worst[quantity] = worst[quantity].max(apart(a[quantity], b[quantity]));
        }
    }
    if scale[2] < 1e-9 * scale[1] / radius {
        scale[2] = scale[1] / radius;
    }
    (0..3).fold(0.0, |most, quantity| (worst[quantity] / scale[quantity].max(f64::MIN_POSITIVE)).max(most))
}

/// What becomes of a difference at the step as it is halved three times, as the table writes it.
///
/// The first ratio does not count: the step of a case need not lie in the range where the first order rules. In
/// `cantilever_10` spheres turn against the shear of their bonds at ω² = k_t A L² / (2/5 m r²) = 4e9 · 7.85e-5 · 0.0101² /
/// 1.31e-8, ω = 4.9e4 rad/s; velocity Verlet turns that mode by (ω Δt)²/24 too far, over t = 8 ms by ω t · (ω Δt)²/24 =
/// 0.63 rad at the case's step of 4 µs, 0.16 rad at half of it, 0.04 at a quarter. The difference of two runs, which
/// lives in that mode, is out of phase accordingly: its ratios are 2.34, then 1.99.
fn class([whole, half, quarter, eighth]: [f64; 4]) -> String {
    let ratios = [half / quarter, quarter / eighth];
    let near = |expected: f64, within: f64| ratios.iter().all(|ratio| (ratio - expected).abs() <= within);
    match () {
        () if whole <= SAME => "same".to_owned(),
        () if near(2.0, 0.1) => format!("÷ 2 ({whole:.0e})"),
        () if near(1.0, 0.02) => format!("stays ({whole:.0e})"),
        () => "–".to_owned(),
    }
}

#[test]
fn the_table_of_differences_holds() {
    let scratch = Scratch(std::env::temp_dir().join(format!("cograin-formulations-{}", std::process::id())));
    let table = fs::read_to_string(TABLE).expect("the table");
    let mut wrong = Vec::new();
    for folder in find(&[BOND.into()]).expect("cases") {
        let name = folder.file_name().expect("a name").to_string_lossy().into_owned();
        let text = fs::read_to_string(folder.join("case.json")).expect("a case");
        let case: Value = serde_json::from_str(&text).expect("a case");
        let cases = [1, 2, 4, 8].map(|share| finer(&case, share));
        let theirs = cases.each_ref().map(|case| run(&scratch.0, case, FormulationChoice::EngineExact));
        let classes = [FormulationChoice::Incremental, FormulationChoice::FiniteRotation].map(|formulation| {
            let mut found = [0.0; 4];
            for (place, case) in cases.iter().enumerate() {
                found[place] = difference(case, &theirs[place], &run(&scratch.0, case, formulation));
            }
            println!("{name}, {formulation:?}: {found:?}");
            if BENT.contains(&name.as_str()) {
                assert!(found.iter().all(|difference| *difference > 1e-8), "{name}: {found:?}");
                return "–".to_owned();
            }
            class(found)
        });
        let row = format!("| {name} | {} | {} |", classes[0], classes[1]);
        if !table.contains(&row) {
            wrong.push(row);
        }
    }
    assert!(wrong.is_empty(), "not in the table:\n{}", wrong.join("\n"));
}

/// The case with this share of its velocities.
fn slower(case: &Value, share: f64) -> Value {
    let mut slower = case.clone();
    for particle in slower["particles"].as_array_mut().expect("particles") {
        for key in ["velocity", "omega"] {
            for part in particle[key].as_array_mut().expect("a vector") {
                *part = json!(part.as_f64().expect("a number") * share);
            }
        }
    }
    slower
}

#[test]
fn the_stored_energy_differs_from_the_rate_form_in_the_second_order_of_the_strains() {
    let scratch = Scratch(std::env::temp_dir().join(format!("cograin-strains-{}", std::process::id())));
    let text = fs::read_to_string(Path::new(BOND).join("free_planar/case.json")).expect("a case");
    let case: Value = serde_json::from_str(&text).expect("a case");
    // Relative to the motion, which is halved as well: the first order is left.
    let of = |speed: f64| {
        let case = finer(&slower(&case, speed), 4);
        let engine = run(&scratch.0, &case, FormulationChoice::EngineExact);
        difference(&case, &engine, &run(&scratch.0, &case, FormulationChoice::FiniteRotation))
    };
    let (whole, half) = (of(1.0), of(0.5));
    assert!((whole / half - 2.0).abs() < 0.15, "{whole:e} {half:e}");
}
