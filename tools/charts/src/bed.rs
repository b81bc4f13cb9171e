//! A column of grains that settles behind a gate and collapses when the gate is drawn: its measures over the time step and the processor time.
//!
//! Grains that fall and roll are chaotic: a trajectory does not converge, its measures do, up to what another packing would
//! change. So each step is run from several packings, and the picture shows each of them. The automatic step stands beside the fixed
//! fractions of the stable one.

use crate::block::processor_time;
use crate::stage::Stage;
use crate::{Chart, Measures};
use cograin::interface::Interface;
use cograin_chart::picture::{Panel, Picture, linear, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::time::Instant;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "bed",
    shows: "settled column and collapse: height, force on the gate, coordination, run-out, over processor time, time steps and packings",
    seconds: 33.0,
    measures: Measures::Times,
    draw,
};

/// Fractions of the stable step.
const PARTS: [f64; 5] = [0.8, 0.4, 0.2, 0.1, 0.05];

/// What the automatic step is called.
const AUTOMATIC: &str = "automatic step, all packings";

/// Packings.
const SEEDS: [u32; 3] = [1, 2, 3];

/// Grains, and their radii \[m\].
const GRAINS: (u32, [f64; 2]) = (200, [0.0045, 0.005]);

/// When the gate is drawn, and when the heap is measured \[s\].
const TIMES: [f64; 2] = [0.25, 0.7];

/// Communication steps over which the force on the gate is averaged, and their length \[s\].
const AVERAGED: (u32, f64) = (20, 0.005);

/// The scene, with the automatic step if no fraction is given.
fn text(part: Option<f64>, seed: u32) -> String {
    let ((count, radius), start) = (GRAINS, TIMES[0]);
    let step = part.map_or_else(String::new, |part| format!("safety = {part:?}\n"));
    let mut text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[run]\nthreads = 1\n{step}seed = {seed}\n\
         [material.grain]\ndensity = 2500.0\nyoungs_modulus = 1e7\npoissons_ratio = 0.25\n\
         [pair.grain.grain]\nrestitution = 0.5\nfriction = 0.5\nrolling_friction = 0.1\n\
         [contact.touch.normal.hertz]\n[contact.touch.tangential.history]\n[contact.touch.rolling.epsd2]\n\
         [particles.column]\nmaterial = \"grain\"\n\
         packing = {{ box = [[0.0, 0.0, 0.0], [0.05, 0.04, 0.25]], count = {count}, radius = {radius:?} }}\n\
         [boundary.gate]\nmaterial = \"grain\"\nplane = {{ point = [0.05, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }}\n\
         motion = {{ prescribed = {{ x = {{ trapezoid = {{ distance = 1.0, speed = 3.0, acceleration = 100.0, start = {start:?} }} }} }} }}\n"
    );
    for (name, point, normal) in [
        ("floor", "[0.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]"),
        ("back", "[0.0, 0.0, 0.0]", "[1.0, 0.0, 0.0]"),
        ("left", "[0.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]"),
        ("right", "[0.0, 0.04, 0.0]", "[0.0, -1.0, 0.0]"),
    ] {
        text += &format!("[boundary.{name}]\nmaterial = \"grain\"\nplane = {{ point = {point}, normal = {normal} }}\n");
    }
    text
}

/// Mean of an axis over all grains \[m\].
fn mean(stage: &Stage, axis: usize) -> f64 {
    (0..stage.count()).map(|grain| stage.position(grain)[axis]).sum::<f64>() / stage.count() as f64
}

/// What is measured: force on the gate \[N\], height of the settled centre of mass \[m\], contacts a grain, how far nine tenths of the
/// grains ran out \[m\], height of the heap's centre of mass \[m\]; time steps; and processor time \[s\].
fn measure(part: Option<f64>, seed: u32) -> Result<([f64; 5], [f64; 2]), ChartError> {
    let mut stage = Stage::of(&text(part, seed))?;
    let interface = Interface::of(stage.simulation.scene());
    let force = interface.find("gate.mean_force.x").expect("a boundary has a mean force");
    let (count, interval) = AVERAGED;
    let begun = Instant::now();
    let before = processor_time(begun);
    stage.advance(TIMES[0] - f64::from(count) * interval)?;
    let mut pushed = 0.0;
    for _ in 0..count {
        stage.advance(interval)?;
        pushed += interface.value(&stage.simulation, force).number() / f64::from(count);
    }
    let coordination = 2.0 * stage.simulation.contact_count() as f64 / stage.count() as f64;
    let settled = mean(&stage, 2);
    stage.advance(TIMES[1] - TIMES[0])?;
    let mut ways: Vec<f64> = (0..stage.count()).map(|grain| stage.position(grain)[0]).collect();
    ways.sort_by(f64::total_cmp);
    let run_out = ways[ways.len() * 9 / 10];
    let steps = stage.simulation.state().clock.steps as f64;
    Ok(([pushed, settled, coordination, run_out, mean(&stage, 2)], [steps, processor_time(begun) - before]))
}

/// Column of the fraction of the stable step.
const PART: &str = "fraction of the stable step";

/// Column of what a run costs.
const COST: &str = "processor time of the run";

/// Columns of what is measured.
const COLUMNS: [(&str, &str); 5] = [
    ("mean force on the gate", "N"),
    ("height of the settled centre of mass", "m"),
    ("contacts a grain, walls counted twice", "1"),
    ("run-out of nine tenths", "m"),
    ("height of the heap's centre of mass", "m"),
];

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let [a, b, c, d, e] = COLUMNS;
    let mut table = Table::new([("series", ""), (PART, "1"), ("time steps", "1"), (COST, "s"), a, b, c, d, e]);
    for seed in SEEDS {
        for part in PARTS.map(Some).into_iter().chain([None]) {
            let (measured, [steps, time]) = measure(part, seed)?;
            let [a, b, c, d, e] = measured.map(Into::into);
            let series = if part.is_some() { format!("packing {seed}") } else { AUTOMATIC.to_owned() };
            let part = part.map_or_else(|| "".into(), Into::into);
            table.push([series.into(), part, steps.into(), time.into(), a, b, c, d, e]);
        }
    }
    let panel = |(column, _): (&'static str, &str)| {
        let title = format!("{} grains: {column}", GRAINS.0);
        Panel { single: vec![AUTOMATIC], ..Panel::new(&title, logarithmic(COST), linear(column), "series") }
    };
    let notes = COLUMNS.map(|(column, unit)| scatter(&table, column, unit)).into();
    Ok(Drawing { table, picture: Picture { panels: COLUMNS.map(panel).into(), ..Picture::default() }, notes })
}

/// How much the step changes a measure, and how much the packing does.
fn scatter(table: &Table, column: &str, unit: &str) -> String {
    let of = |part: Option<f64>| {
        let rows = (0..table.rows.len()).filter(|row| table.number(*row, PART) == part);
        rows.filter_map(|row| table.number(row, column)).collect::<Vec<_>>()
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let finest = of(PARTS.last().copied());
    let spread = finest.iter().fold(f64::NEG_INFINITY, |most, value| most.max(*value))
        - finest.iter().fold(f64::INFINITY, |least, value| least.min(*value));
    let (right, shown) = (mean(&finest), PARTS.map(|part| format!("{part}: {:.4}", mean(&of(Some(part))))));
    format!(
        "{column} [{unit}], mean of packings: {}, automatic: {:.4}; over packings {:.1} % apart",
        shown.join(", "),
        mean(&of(None)),
        100.0 * spread / right
    )
}
