//! A bonded cantilever and a bonded pair that spins: error over the time step, over formulations and dampings of bonds.
//!
//! The cantilever is a row of spheres, clamped at one end and loaded at the other from time 0 on; it vibrates freely. Its error
//! is that of the deflection over a period of the first mode, over the static deflection, against the same bonds with the
//! finest step. The pair spins about its middle and vibrates in bending; its energy is to stay.

use crate::runs::{Sampled, apart, given};
use crate::stage::Stage;
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::f64::consts::PI;
use std::fmt::Write;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "cantilever",
    shows: "bonded cantilever and spinning pair: error over time steps, over formulations and dampings",
    seconds: 10.0,
    measures: Measures::Errors,
    draw,
};

/// Radius of a sphere \[m\].
pub(crate) const RADIUS: f64 = 1e-3;

/// Spheres of the cantilever.
const SPHERES: u32 = 10;

/// Normal and tangential stiffness of bonds \[Pa/m\].
pub(crate) const STIFFNESS: [f64; 2] = [1e12, 4e11];

/// Density \[kg/m³\].
pub(crate) const DENSITY: f64 = 2500.0;

/// Load at the tip \[N\].
const LOAD: f64 = 1e-3;

/// Time steps over the stable one.
const PARTS: [f64; 6] = [0.9, 0.6, 0.4, 0.2, 0.1, 0.05];

/// That of the run that the others are held against.
const FINEST: f64 = 1.0 / 128.0;

/// Bonds without damping.
pub(crate) const FINITE_ROTATION: [&str; 3] = ["finite_rotation", "finite_rotation", ""];

/// A formulation and a damping, as the legend and as the scene has them.
const BONDS: [[&str; 3]; 6] = [
    FINITE_ROTATION,
    ["incremental", "incremental", ""],
    ["engine_exact", "engine_exact", ""],
    ["finite_rotation, viscous 0.05", "finite_rotation", "viscous 0.05"],
    ["incremental, viscous 0.05", "incremental", "viscous 0.05"],
    ["finite_rotation, opposing 0.05", "finite_rotation", "opposing 0.05"],
];

/// The static deflection of the tip \[m\] and the period of the first mode \[s\].
///
/// Deflection of a chain of n bonds: F a² (4 n³ − n)/(12 k_θ) + F n/k_s; frequency: 1.8751² √(E I/(ρ A L⁴)) of Euler's beam.
pub(crate) fn theory() -> [f64; 2] {
    let (bonds, spacing) = (f64::from(SPHERES - 1), 2.0 * RADIUS);
    let (area, second_moment) = (PI * RADIUS * RADIUS, 0.25 * PI * RADIUS * RADIUS * RADIUS * RADIUS);
    let [bending, shear] = [STIFFNESS[0] * second_moment, STIFFNESS[1] * area];
    let deflection =
        LOAD * spacing * spacing * (4.0 * bonds * bonds * bonds - bonds) / (12.0 * bending) + LOAD * bonds / shear;
    let length = bonds * spacing;
    let mass = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * DENSITY / spacing;
    let rate = 1.8751 * 1.8751 * (bending * spacing / (mass * length * length * length * length)).sqrt();
    [deflection, 2.0 * PI / rate]
}

/// Material, spheres and bonds.
pub(crate) fn bonded(run: &str, spheres: &str, [_, formulation, damping]: [&str; 3]) -> String {
    let [normal, tangential] = STIFFNESS;
    let mut text = format!(
        "[run]\n{run}\n[material.a]\ndensity = {DENSITY:?}\n[particles.row]\nmaterial = \"a\"\nlist = [\n{spheres}]\n\
         [bond.b]\nformulation = \"{formulation}\"\nbetween = [\"row\", \"row\"]\ncreate_distance = {:?}\n\
         normal_stiffness = {normal:?}\ntangential_stiffness = {tangential:?}\n",
        2.2 * RADIUS
    );
    if let Some((model, share)) = damping.split_once(' ') {
        writeln!(text, "[bond.b.damping.{model}]").expect("a text grows");
        for part in ["normal_force", "tangential_force", "normal_torque", "tangential_torque"] {
            writeln!(text, "{part} = {share}").expect("a text grows");
        }
    }
    text
}

/// The cantilever.
pub(crate) fn cantilever(run: &str, bonds: [&str; 3]) -> String {
    let place = |number: u32| 2.0 * RADIUS * f64::from(number);
    let sphere = |number| format!("{{ position = [{:?}, 0.0, 0.0], radius = {RADIUS:?} }},\n", place(number));
    let spheres: String = (0..SPHERES).map(sphere).collect();
    bonded(run, &spheres, bonds)
        + &format!(
            "[boundary.clamp]\nparticles = {{ ids = [1] }}\n[force.tip]\nparticles = {{ ids = [{SPHERES}] }}\n\
             force = [0.0, 0.0, -{LOAD:?}]\n"
        )
}

/// Deflection of the tip \[m\].
pub(crate) fn observe(stage: &Stage) -> Vec<f64> {
    vec![stage.position(SPHERES as usize - 1)[2]]
}

/// Angular velocity at which the pair spins \[rad/s\].
const SPIN: f64 = 2e4;

/// Part of it by which the spheres spin against each other: they vibrate in bending.
const BENDING: f64 = 0.2;

/// Turns of the pair.
const TURNS: f64 = 10.0;

/// The spinning pair.
fn pair(run: &str, bonds: [&str; 3]) -> String {
    let sphere = |side: f64| {
        let (x, speed, spin) = (side * RADIUS, -side * RADIUS * SPIN, SPIN * (1.0 + side * BENDING));
        format!(
            "{{ position = [{x:?}, 0.0, 0.0], radius = {RADIUS:?}, velocity = [0.0, 0.0, {speed:?}], \
             angular_velocity = [0.0, {spin:?}, 0.0] }},\n"
        )
    };
    bonded(run, &(sphere(-1.0) + &sphere(1.0)), bonds)
}

/// Largest change of the pair's energy over that of its vibration.
fn energy_error(steps: f64, bonds: [&str; 3]) -> Result<f64, ChartError> {
    let turn = 2.0 * PI / SPIN;
    let mut stage = Stage::of(&pair(&given(turn / steps), bonds))?;
    let energy = |stage: &Stage| stage.simulation.kinetic_energy() + stage.simulation.bond_elastic_energy();
    let begun = energy(&stage);
    let inertia = 0.4 * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * DENSITY * RADIUS * RADIUS;
    let vibration = inertia * (SPIN * BENDING) * (SPIN * BENDING);
    let mut largest = 0.0_f64;
    for _ in 0..TURNS as u32 {
        stage.advance(turn)?;
        largest = largest.max((energy(&stage) - begun).abs());
    }
    Ok(largest / vibration)
}

/// An error of the cantilever.
pub(crate) struct Error {
    /// Time steps in a period of the first mode.
    pub steps: f64,
    /// Largest error of the deflection over the static one.
    pub error: f64,
}

/// The errors of the cantilever with these bonds, and more lines of `[run]`: with given steps, and with the automatic one, which bonds
/// whose forces depend on the step refuse.
pub(crate) fn deflection_errors(bonds: [&str; 3], run: &str) -> Result<(Vec<Error>, Option<Error>), ChartError> {
    let [deflection, period] = theory();
    let sampled = Sampled { interval: period / 10.0, count: 10, observe };
    let lines = |step: f64| given(step) + run;
    let stable = Stage::of(&cantilever(&lines(1e-9), bonds))?.stable();
    let samples = |part: f64| sampled.of(&cantilever(&lines(sampled.dividing(part * stable)), bonds));
    let (right, _) = samples(FINEST)?;
    let error =
        |(found, steps): (Vec<f64>, u64)| Error { steps: steps as f64, error: apart(&found, &right) / deflection };
    let given = PARTS.into_iter().map(|part| Ok::<_, ChartError>(error(samples(part)?))).collect::<Result<_, _>>()?;
    let automatic = || sampled.of(&cantilever(&format!("threads = 1\n{run}"), bonds)).map(error);
    Ok((given, (bonds[1] != "engine_exact").then(automatic).transpose()?))
}

/// What the automatic step is called.
const AUTOMATIC: &str = "automatic step, all bonds";

/// Columns.
const COLUMNS: [&str; 4] = [
    "time steps in a period of the first mode",
    "largest error of deflection over the static one",
    "time steps in a turn",
    "largest change of energy over that of the vibration",
];

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let columns =
        [("case", ""), ("series", ""), (COLUMNS[0], "1"), (COLUMNS[1], "1"), (COLUMNS[2], "1"), (COLUMNS[3], "1")];
    let mut table = Table::new(columns);
    let mut notes = Vec::new();
    for bonds in BONDS {
        let (given, automatic) = deflection_errors(bonds, "")?;
        if let Some(Error { steps, error }) = &automatic {
            notes.push(format!("{}: {error:.1e} at the automatic step, {steps:.0} steps a period", bonds[0]));
        }
        let automatic = automatic.map(|error| (AUTOMATIC, error));
        let named = given.into_iter().map(|error| (bonds[0], error)).chain(automatic);
        for (series, Error { steps, error }) in named {
            table.push(["cantilever".into(), series.into(), steps.into(), error.into(), "".into(), "".into()]);
        }
    }
    for bonds in BONDS.into_iter().filter(|[_, _, damping]| damping.is_empty()) {
        for steps in [200.0, 400.0, 800.0, 1_600.0, 3_200.0, 6_400.0] {
            let error = energy_error(steps, bonds)?;
            table.push(["pair".into(), bonds[0].into(), "".into(), "".into(), steps.into(), error.into()]);
        }
    }
    let panel = |case: &str, title: &str, [across, upwards]: [&'static str; 2]| Panel {
        only: Some(("case", case.to_owned())),
        single: vec![AUTOMATIC],
        ..Panel::new(title, logarithmic(across), logarithmic(upwards), "series")
    };
    let panels = vec![
        panel("cantilever", "cantilever of 10 spheres, loaded suddenly: one period", [COLUMNS[0], COLUMNS[1]]),
        panel("pair", "bonded pair that spins and vibrates: ten turns", [COLUMNS[2], COLUMNS[3]]),
    ];
    Ok(Drawing { table, picture: Picture { panels, ..Picture::default() }, notes })
}
