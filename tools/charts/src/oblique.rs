//! How exactly spheres rebound that hit a plane at an angle, over the number of time steps in the contact.
//!
//! Set-up 4 of Y. C. Chung & J. Y. Ooi, *Granular Matter* 13 (2011) 643–656, and the same spheres with e = 0.5 and µ = 0.4.
//! The error is the largest one of velocity and of angular velocity times radius, together, against what the same law leaves
//! with [`CONVERGED`] time steps, over the speed of the impact and over the moments at which the contact begins.

use crate::drops::{RADIUS, Rebound, SPEED, Throw, hertz_duration};
use crate::schemes::{ENGINE, PREDICTED, PREDICTED_NORMAL, SCHEMES, Scheme};
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "oblique",
    shows: "error of rebound of oblique impacts over time steps in a contact, over tangential laws",
    seconds: 2.0,
    measures: Measures::Errors,
    draw,
};

/// Time steps in an elastic contact.
const STEPS: [f64; 10] = [6.0, 10.0, 17.0, 30.0, 55.0, 100.0, 200.0, 400.0, 800.0, 1600.0];

/// Time steps of the run that the others are held against.
const CONVERGED: f64 = 12_800.0;

/// Angles to the normal \[°\].
const ANGLES: [f64; 4] = [5.0, 20.0, 40.0, 70.0];

/// What the default step is called.
const DEFAULT: &str = "default step, all angles";

/// The tangential model `history`.
pub(crate) const HISTORY: &str = "[contact.touch.tangential.history]";

/// `turned_history`, as in LAMMPS.
const TURNED: &str = "[contact.touch.tangential.turned_history]";

/// `turned_history` with a spring that is at rest while the dashpot exceeds the limit.
const AT_REST: &str = "[contact.touch.tangential.turned_history]\nbackward_spring = false";

/// A diagram: its name, the tangential model as a scene writes it, restitution and friction.
type Case = (&'static str, &'static str, [f64; 2]);

/// Schemes of which the picture has diagrams: the curves of `midway` lie on the others; the table has them.
const DRAWN: [Scheme; 3] = [ENGINE, PREDICTED_NORMAL, PREDICTED];

/// The diagrams.
const CASES: [Case; 5] = [
    ("history, e = 0.98, µ = 0.092", HISTORY, [0.98, 0.092]),
    ("turned_history, e = 0.98, µ = 0.092", TURNED, [0.98, 0.092]),
    ("history, e = 0.5, µ = 0.4", HISTORY, [0.5, 0.4]),
    ("turned_history, e = 0.5, µ = 0.4", TURNED, [0.5, 0.4]),
    ("turned_history, at rest, e = 0.5, µ = 0.4", AT_REST, [0.5, 0.4]),
];

/// Mean of what spheres leave with.
fn mean(rebounds: &[Rebound]) -> Rebound {
    let part = |row: usize, axis: usize| {
        rebounds.iter().map(|rebound| rebound[row][axis]).sum::<f64>() / rebounds.len() as f64
    };
    [0, 1].map(|row| [0, 1, 2].map(|axis| part(row, axis)))
}

/// The largest error, over the speed of the impact.
fn largest(rebounds: &[Rebound], right: &Rebound) -> f64 {
    let square = |a: [f64; 3], b: [f64; 3]| a.iter().zip(&b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    let error = |rebound: &Rebound| {
        (square(rebound[0], right[0]) + RADIUS * RADIUS * square(rebound[1], right[1])).sqrt() / SPEED
    };
    rebounds.iter().map(error).fold(0.0, f64::max)
}

/// The largest errors over all angles of a case, over numbers of time steps in an elastic contact.
pub(crate) fn largest_errors(tangential: &str, coefficients: [f64; 2], run: &str) -> Result<Vec<[f64; 2]>, ChartError> {
    let law = format!("[contact.touch.normal.hertz]\n{tangential}");
    let mut errors = STEPS.map(|steps| [steps, 0.0_f64]);
    for angle in ANGLES.map(f64::to_radians) {
        let duration = hertz_duration(SPEED * libm::cos(angle));
        let throw = Throw { law: &law, coefficients, angle, duration };
        let right = mean(&throw.steps(CONVERGED, run)?);
        for [steps, error] in &mut errors {
            *error = error.max(largest(&throw.steps(*steps, run)?, &right));
        }
    }
    Ok(errors.to_vec())
}

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut table = Table::new([
        ("case", ""),
        ("series", ""),
        ("angle", "°"),
        ("time steps in an elastic contact", "1"),
        ("largest error of rebound over impact speed", "1"),
    ]);
    let mut notes = Vec::new();
    for (case, tangential, coefficients) in CASES {
        let law = format!("[contact.touch.normal.hertz]\n{tangential}");
        for scheme in SCHEMES {
            let case = scheme.named(case);
            let mut defaults = Vec::new();
            for angle in ANGLES {
                let radians = angle.to_radians();
                let duration = hertz_duration(SPEED * libm::cos(radians));
                let throw = Throw { law: &law, coefficients, angle: radians, duration };
                let right = mean(&throw.steps(CONVERGED, scheme.run)?);
                let mut add = |series: String, steps: f64, error: f64| {
                    table.push([case.clone().into(), series.into(), angle.into(), steps.into(), error.into()]);
                };
                for steps in STEPS {
                    let error = largest(&throw.steps(steps, scheme.run)?, &right);
                    add(format!("{angle}°"), steps, error);
                }
                let (rebounds, steps) = throw.automatic(scheme.run)?;
                defaults.push((angle, steps, largest(&rebounds, &right)));
            }
            for (angle, steps, error) in defaults {
                notes.push(format!("{case}, {angle}°, default step: {steps:.1} steps, error {error:.1e}"));
                table.push([case.clone().into(), DEFAULT.into(), angle.into(), steps.into(), error.into()]);
            }
        }
    }
    let panel = |case: String| {
        let across = logarithmic("time steps in an elastic contact");
        let upwards = logarithmic("largest error of rebound over impact speed");
        let panel = Panel::new(&case, across, upwards, "series");
        Panel { only: Some(("case", case)), single: vec![DEFAULT], ..panel }
    };
    let cases = CASES.iter().flat_map(|(case, ..)| DRAWN.map(|scheme| scheme.named(case)));
    let panels = cases.map(panel).collect();
    Ok(Drawing { table, picture: Picture { panels, columns: DRAWN.len(), ..Picture::default() }, notes })
}
