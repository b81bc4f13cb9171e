//! The stored cases without touching bodies.

use super::replay::{Run, largest};
use super::stored::Case;
use crate::bond::keys::FormulationChoice;

/// Largest magnitude of x (as displacement), v, ω, f, t over all samples and of the bond forces; what is rounding only is
/// scaled by speed/radius and force · radius.
fn scales(case: &Case) -> [f64; 6] {
    let count = case.json["particles"].as_array().unwrap().len();
    let mut scale = [0.0_f64; 6];
    for (index, row) in case.samples.rows.iter().enumerate() {
        let start = case.samples.vector(&case.samples.rows[index % count], "x");
        scale[0] = scale[0].max(largest(case.samples.vector(row, "x") - start));
        for (part, first) in ["vx", "omegax", "fx", "tx"].into_iter().enumerate() {
            scale[part + 1] = scale[part + 1].max(largest(case.samples.vector(row, first)));
        }
    }
    let radii = case.json["particles"].as_array().unwrap().iter().map(|particle| particle["radius"].as_f64().unwrap());
    let radius = radii.fold(f64::INFINITY, f64::min);
    if scale[2] < 1e-9 * scale[1] / radius {
        scale[2] = scale[1] / radius;
    }
    if scale[4] < 1e-9 * scale[3] * radius {
        scale[4] = scale[3] * radius;
    }
    if let Some(bonds) = &case.bonds {
        for row in &bonds.rows {
            scale[5] = scale[5].max(largest(bonds.vector(row, "fx")));
        }
    }
    scale
}

/// The largest relative deviation.
fn relative(deviation: [f64; 6], scale: [f64; 6]) -> f64 {
    deviation.into_iter().zip(scale).fold(0.0, |worst, (deviation, scale)| {
        let relative = if scale > 0.0 { deviation / scale } else { deviation };
        if relative.is_nan() { f64::INFINITY } else { f64::max(worst, relative) }
    })
}

/// Steps between samples, samples.
fn sampling(case: &Case) -> (u64, usize) {
    let count = case.json["particles"].as_array().unwrap().len();
    (case.json["sample_every"].as_u64().unwrap(), case.samples.rows.len() / count)
}

/// Worst deviation of windows restarted from each stored sample, and whether all living bonds agree.
fn windows(name: &str) -> (f64, bool, f64) {
    let case = Case::read(name);
    let scale = scales(&case);
    let (every, samples) = sampling(&case);
    let (mut worst, mut same) = (0.0_f64, true);
    for sample in 0..samples - 1 {
        let mut run = Run::new(&case, FormulationChoice::EngineExact);
        if sample > 0 {
            run.restore(&case, sample);
        }
        let from = sample as u64 * every;
        run.advance_over(from + 1..=from + every);
        let (deviation, agrees) = run.compare(&case, sample + 1);
        worst = worst.max(relative(deviation, scale));
        same &= agrees;
    }
    (worst, same, case.json["reproducible"]["window_deviation"].as_f64().unwrap())
}

/// Worst deviation of a run from the start to a step, and whether all living bonds agree.
fn free(name: &str, formulation: FormulationChoice, until: u64) -> (f64, bool) {
    let case = Case::read(name);
    let scale = scales(&case);
    let (every, samples) = sampling(&case);
    let mut run = Run::new(&case, formulation);
    let (mut worst, mut same) = (0.0_f64, true);
    for sample in (1..samples).take_while(|&sample| sample as u64 * every <= until) {
        let from = (sample as u64 - 1) * every;
        run.advance_over(from + 1..=from + every);
        let (deviation, agrees) = run.compare(&case, sample);
        worst = worst.max(relative(deviation, scale));
        same &= agrees;
    }
    (worst, same)
}

/// Cases in which no bodies touch, all but those with a plane.
const APART: [&str; 33] = [
    "bending",
    "bonded_contact_disabled",
    "break_bending",
    "break_distance",
    "break_sigma",
    "break_tau",
    "break_twist",
    "cantilever_10",
    "cantilever_10_oblique_damped",
    "create_always",
    "create_at_step",
    "damping_on",
    "damping_smooth",
    "damping_smooth_axial",
    "dissipation",
    "dissipation_and_damping",
    "drucker_prager_compression",
    "drucker_prager_tension",
    "energies",
    "flag_off_compressionStress",
    "flag_off_normalTorqueStress",
    "flag_off_shearStress",
    "flag_off_shearTorqueStress",
    "flag_off_tensionStress",
    "free_combined",
    "free_combined_large_lambda",
    "free_planar",
    "ratio_tension_compression",
    "shear",
    "spin_transverse",
    "spin_with_load",
    "tension",
    "twist",
];

#[test]
fn engine_exact_repeats_the_engine_from_sample_to_sample() {
    for name in APART.into_iter().chain(["triangle", "two_types"]) {
        let (deviation, same, theirs) = windows(name);
        let bound = f64::max(1e-9, 10.0 * theirs);
        assert!(same && deviation <= bound, "{name}: {deviation:e} over {bound:e}, bonds the same: {same}");
    }
}

#[test]
fn engine_exact_runs_freely_as_far_as_rounding_lets_it() {
    for name in APART.into_iter().chain(["triangle", "two_types", "wall_bond", "wall_bond_planar"]) {
        let half = Case::read(name).json["reproducible"]["free_run_1e9_until_step"].as_u64().unwrap() / 2;
        let (deviation, same) = free(name, FormulationChoice::EngineExact, half);
        assert!(same && deviation <= 1e-9, "{name} to step {half}: {deviation:e}, bonds the same: {same}");
    }
}

#[test]
fn all_formulations_agree_where_bonds_do_not_turn() {
    for name in [
        "tension",
        "twist",
        "bending",
        "break_distance",
        "break_sigma",
        "break_bending",
        "break_twist",
        "ratio_tension_compression",
    ] {
        for formulation in [FormulationChoice::Incremental, FormulationChoice::FiniteRotation] {
            let (deviation, same) = free(name, formulation, u64::MAX);
            assert!(same && deviation <= 1e-9, "{name} with {formulation:?}: {deviation:e}, bonds the same: {same}");
        }
    }
}

/// Largest difference of a formulation from `engine_exact` in x, v and ω over the first steps of a case, relative to the
/// case's magnitudes, with `share` times as many steps and `speed` times the velocities.
fn difference(name: &str, formulation: FormulationChoice, until: u64, share: u64, speed: f64) -> f64 {
    let case = Case::read(name);
    let scale = scales(&case);
    let mut runs = [formulation, FormulationChoice::EngineExact].map(|formulation| {
        let mut run = Run::new(&case, formulation);
        run.step /= share as f64;
        for body in &mut run.bodies {
            body.velocity = body.velocity * speed;
            body.spin = body.spin * speed;
        }
        run
    });
    let mut worst = [0.0_f64; 6];
    for number in 1..=until * share {
        runs.iter_mut().for_each(|run| run.advance(number));
        for (one, other) in runs[0].bodies.iter().zip(&runs[1].bodies) {
            worst[0] = worst[0].max(largest(one.position - other.position));
            worst[1] = worst[1].max(largest(one.velocity - other.velocity));
            worst[2] = worst[2].max(largest(one.spin - other.spin));
        }
    }
    relative(worst, scale)
}

#[test]
fn the_engines_increments_on_the_axis_of_the_steps_end_are_an_error_of_first_order() {
    for (name, until) in [("free_planar", 2000), ("spin_transverse", 1500), ("cantilever_10", 1000)] {
        let of = |share| difference(name, FormulationChoice::Incremental, until, share, 1.0);
        let ratio = of(2) / of(4);
        assert!((ratio - 2.0).abs() < 0.15, "{name}: {ratio}");
    }
}

#[test]
fn the_stored_energy_differs_from_the_rate_form_in_the_second_order_of_the_strains() {
    let of = |share, speed| difference("free_planar", FormulationChoice::FiniteRotation, 2000, share, speed);
    let (whole, half) = (of(4, 1.0), of(4, 0.5));
    assert!((whole / half - 4.0).abs() < 0.3, "{whole:e} {half:e}");
    assert!((of(2, 1.0) / whole - 1.0).abs() < 0.01, "not an error of the step");
}
