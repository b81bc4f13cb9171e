//! Where cohesion collapses contacts: `sjkr` with Hertz and with linear springs.
//!
//! With Hertz two spheres rest at the overlap δ/R* = (3 π C/(2 E*))², C the cohesion energy density: deep where C is some
//! per cent of E*. With linear springs nothing holds them from C = k_n/(π R) on, for two spheres of radius R.

use crate::stage::Stage;
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::f64::consts::PI;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "cohesion",
    shows: "stability: overlap at rest and collapse of cohesive contacts over stiffness, measured and in theory",
    seconds: 1.0,
    measures: Measures::Errors,
    draw,
};

/// Radius \[m\].
const RADIUS: f64 = 1e-3;

/// Effective modulus of two spheres of 2 · 0.91 · 10⁷ Pa and ν = 0.3 \[Pa\].
const MODULUS: f64 = 1e7;

/// Time steps in which two spheres come to rest, with the damping of [`text`].
const STEPS: f64 = 4000.0;

/// Two spheres that touch, damped.
fn text(law: &str, density: f64, run: &str) -> String {
    let (distance, youngs) = (2.0 * RADIUS * (1.0 - 1e-6), 2.0 * 0.91 * MODULUS);
    format!(
        "[run]\nthreads = 1\n{run}\n[material.a]\ndensity = 2500.0\nyoungs_modulus = {youngs:?}\npoissons_ratio = 0.3\n\
         [pair.a.a]\nrestitution = 0.5\ncohesion_energy_density = {density:?}\n{law}\n[contact.c.cohesion.sjkr]\n\
         [damping.d]\nlinear = 0.7\nangular = 0.7\n\
         [particles.s]\nmaterial = \"a\"\nlist = [{{ position = [0.0, 0.0, 0.0], radius = {RADIUS:?} }}, \
         {{ position = [{distance:?}, 0.0, 0.0], radius = {RADIUS:?} }}]\n"
    )
}

/// Overlap of the two spheres at rest \[m\], if they come to rest outside of each other's centres.
fn overlap(text: &str) -> Result<Option<f64>, ChartError> {
    let mut stage = Stage::of(text)?;
    let (step, mut before) = (stage.step(), f64::NAN);
    for _ in 0..50 {
        if stage.advance(STEPS * step).is_err() {
            return Ok(None);
        }
        let now = 2.0 * RADIUS - (stage.position(1)[0] - stage.position(0)[0]);
        if (now - before).abs() < 1e-6 * now {
            return Ok((now < RADIUS).then_some(now));
        }
        before = now;
    }
    Ok(None)
}

/// The density from which on nothing holds two spheres with linear springs of this stiffness \[J/m³\].
fn collapse(stiffness: f64) -> Result<f64, ChartError> {
    let holds = |density: f64| {
        let law = "[contact.c.normal.hooke_stiffness]";
        let mass = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * 2500.0;
        let run = format!("step = {:?}", 0.1 * (0.5 * mass / stiffness).sqrt());
        let text = text(law, density, &run)
            .replace("restitution = 0.5\n", &format!("normal_stiffness = {stiffness:?}\nnormal_damping = 0.0\n"));
        // Linear springs without collapse rest at no overlap: the spheres part.
        let mut stage = Stage::of(&text)?;
        let step = stage.step();
        let begun = 2.0 * RADIUS * 1e-6;
        let failed = stage.advance(STEPS * step).is_err();
        let now = 2.0 * RADIUS - (stage.position(1)[0] - stage.position(0)[0]);
        Ok::<_, ChartError>(!failed && now < 2.0 * begun)
    };
    let theory = stiffness / (PI * RADIUS);
    let (mut low, mut high) = (0.5 * theory, 2.0 * theory);
    while high - low > 2e-3 * theory {
        let middle = 0.5 * (low + high);
        if holds(middle)? { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

/// Columns of the table.
const COLUMNS: [&str; 4] = [
    "cohesion energy density over effective modulus",
    "overlap at rest over effective radius",
    "normal stiffness",
    "cohesion energy density at collapse",
];

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let columns =
        [("case", ""), ("series", ""), (COLUMNS[0], "1"), (COLUMNS[1], "1"), (COLUMNS[2], "N/m"), (COLUMNS[3], "J/m³")];
    let mut table = Table::new(columns);
    let mut notes = Vec::new();
    for ratio in [0.001, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.13, 0.16, 0.2] {
        let theory = (1.5 * PI * ratio) * (1.5 * PI * ratio);
        let mut add = |series: &str, depth: f64| {
            table.push(["hertz".into(), series.into(), ratio.into(), depth.into(), "".into(), "".into()]);
        };
        match overlap(&text("[contact.c.normal.hertz]", ratio * MODULUS, ""))? {
            Some(overlap) => add("measured", overlap / (0.5 * RADIUS)),
            None => notes.push(format!("density over modulus {ratio}: the run stops, the contact has collapsed")),
        }
        add("theory", theory);
    }
    for stiffness in [1e2, 1e3, 1e4, 1e5] {
        let mut add = |series: &str, density: f64| {
            table.push(["hooke".into(), series.into(), "".into(), "".into(), stiffness.into(), density.into()]);
        };
        add("measured", collapse(stiffness)?);
        add("theory", stiffness / (PI * RADIUS));
    }
    let panel = |case: &str, title: &str, [across, upwards]: [&'static str; 2]| Panel {
        only: Some(("case", case.to_owned())),
        theory: vec!["theory"],
        single: vec!["measured"],
        ..Panel::new(title, logarithmic(across), logarithmic(upwards), "series")
    };
    let panels = vec![
        panel("hertz", "two spheres, hertz with sjkr", [COLUMNS[0], COLUMNS[1]]),
        panel("hooke", "two spheres, linear springs with sjkr: collapse above", [COLUMNS[2], COLUMNS[3]]),
    ];
    Ok(Drawing { table, picture: Picture { panels, ..Picture::default() }, notes })
}
