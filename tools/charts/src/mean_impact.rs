//! How far restitution is off in the mean over the moments at which contacts begin and end within a time step.
//!
//! Chart `impact` has the largest error over the same moments. Those of `engine` have either sign, so they cancel over many impacts;
//! those of `predicted_normal` have one: the velocity that a dashpot foresees is off by ⅜ Δt² of its second derivative.

use crate::impact::{Normal, errors, models};
use crate::schemes::{ENGINE, PREDICTED_NORMAL, Scheme};
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "mean_impact",
    shows: "error of the mean restitution of many impacts over time steps in a contact: hertz and hooke, two schemes",
    seconds: 3.0,
    measures: Measures::Errors,
    draw,
};

/// Time steps in an elastic contact.
const STEPS: [f64; 9] = [5.0, 7.0, 10.0, 14.0, 20.0, 32.0, 50.0, 80.0, 125.0];

/// Coefficients of restitution.
const RESTITUTIONS: [f64; 3] = [0.3, 0.65, 0.9];

/// Columns.
const COLUMNS: [&str; 5] =
    ["law", "series", "time steps in an elastic contact", "error of the mean restitution", "largest error"];

/// The mean and the largest error of restitution with so many time steps in an elastic contact, without their signs.
fn found(normal: &Normal, restitution: f64, scheme: &Scheme, steps: f64) -> Result<[f64; 2], ChartError> {
    let errors = errors(normal, restitution, scheme, steps)?;
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    Ok([mean.abs(), errors.into_iter().map(f64::abs).fold(0.0, f64::max)])
}

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let models = models();
    let mut table =
        Table::new([(COLUMNS[0], ""), (COLUMNS[1], ""), (COLUMNS[2], "1"), (COLUMNS[3], "1"), (COLUMNS[4], "1")]);
    let mut notes = Vec::new();
    for normal in &models {
        for scheme in [ENGINE, PREDICTED_NORMAL] {
            for restitution in RESTITUTIONS {
                let series = format!("{}, e = {restitution}", scheme.name);
                for steps in STEPS {
                    let [mean, largest] = found(normal, restitution, &scheme, steps)?;
                    if steps == 10.0 {
                        notes.push(format!(
                            "{}, {series}: at 10 steps {mean:.1e} in the mean, {largest:.1e} at most",
                            normal.name
                        ));
                    }
                    table.push([normal.name.into(), series.clone().into(), steps.into(), mean.into(), largest.into()]);
                }
            }
        }
    }
    let panel = |normal: &Normal| Panel {
        only: Some((COLUMNS[0], normal.name.to_owned())),
        ..Panel::new(normal.name, logarithmic(COLUMNS[2]), logarithmic(COLUMNS[3]), COLUMNS[1])
    };
    let panels = models.iter().map(panel).collect();
    Ok(Drawing { table, picture: Picture { panels, ..Picture::default() }, notes })
}
