//! Bonded bodies with the automatic step: error over the number of time steps, with fractions of the stable step and with `accuracy`.
//!
//! A cantilever swings slowly beside its stable step, a pair that vibrates along its axis as fast as anything in it. The error is that of
//! the place in about a period, against the finest step, over the static deflection or the amplitude.

use crate::cantilever::{self, DENSITY, FINITE_ROTATION, RADIUS, STIFFNESS};
use crate::runs::{Sampled, apart};
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};
use std::f64::consts::PI;

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "accuracy",
    shows: "bonded bodies: error over time steps, with fractions of the stable step and with accuracy",
    seconds: 5.0,
    measures: Measures::Errors,
    draw,
};

/// Fractions of the stable step.
const FRACTIONS: [f64; 6] = [0.8, 0.4, 0.2, 0.1, 0.05, 0.025];

/// Values of `accuracy`.
const ACCURACIES: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];

/// The fraction that the others are held against.
const FINEST: f64 = 1.0 / 512.0;

/// Columns.
const COLUMNS: [&str; 5] = ["body", "series", "value", "time steps", "largest error over the amplitude"];

/// A body that is tried.
struct Body {
    /// Its name.
    name: &'static str,
    /// What the picture says of it.
    title: &'static str,
    /// The scene, with these lines of `[run]`.
    text: fn(&str) -> String,
    /// What its errors are measured in \[m\].
    scale: f64,
    /// How it is sampled: where it moves, so that errors of amplitude and of frequency show.
    sampled: Sampled,
}

/// Speed with which each sphere of the pair parts \[m/s\].
const SPEED: f64 = 1e-3;

/// The pair.
fn pair(run: &str) -> String {
    let sphere = |side: f64| {
        let (x, speed) = (side * RADIUS, side * SPEED);
        format!("{{ position = [{x:?}, 0.0, 0.0], radius = {RADIUS:?}, velocity = [{speed:?}, 0.0, 0.0] }},\n")
    };
    cantilever::bonded(run, &(sphere(-1.0) + &sphere(1.0)), FINITE_ROTATION)
}

/// The bodies.
fn bodies() -> [Body; 2] {
    // Each of two masses m swings by half of a spring k against the middle: ω² = 2 k/m.
    let mass = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * DENSITY;
    let rate = (2.0 * STIFFNESS[0] * PI * RADIUS * RADIUS / mass).sqrt();
    let [deflection, period] = cantilever::theory();
    [
        Body {
            name: "cantilever",
            title: "cantilever of 10 spheres, loaded suddenly",
            text: |run| cantilever::cantilever(run, FINITE_ROTATION),
            scale: deflection,
            sampled: Sampled { interval: 0.1 * period, count: 10, observe: cantilever::observe },
        },
        Body {
            name: "pair",
            title: "pair that vibrates along its axis",
            text: pair,
            scale: SPEED / rate,
            // An interval shortens the last of its time steps.
            sampled: Sampled {
                interval: 1.15 * 2.0 * PI / rate,
                count: 1,
                observe: |stage| vec![stage.position(1)[0]],
            },
        },
    ]
}

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut table =
        Table::new([(COLUMNS[0], ""), (COLUMNS[1], ""), (COLUMNS[2], "1"), (COLUMNS[3], "1"), (COLUMNS[4], "1")]);
    let mut notes = Vec::new();
    for body in bodies() {
        let run = |key: &str, value: f64| body.sampled.of(&(body.text)(&format!("threads = 1\n{key} = {value:?}\n")));
        let (right, _) = run("safety", FINEST)?;
        for (key, values) in [("safety", &FRACTIONS[..]), ("accuracy", &ACCURACIES[..])] {
            for &value in values {
                let (found, steps) = run(key, value)?;
                let error = apart(&found, &right) / body.scale;
                notes.push(format!("{}, {key} = {value}: {steps} time steps, error {error:.1e}", body.name));
                table.push([body.name.into(), key.into(), value.into(), (steps as f64).into(), error.into()]);
            }
        }
    }
    let panel = |body: Body| Panel {
        only: Some((COLUMNS[0], body.name.to_owned())),
        ..Panel::new(body.title, logarithmic(COLUMNS[3]), logarithmic(COLUMNS[4]), COLUMNS[1])
    };
    let panels = bodies().into_iter().map(panel).collect();
    Ok(Drawing { table, picture: Picture { panels, ..Picture::default() }, notes })
}
