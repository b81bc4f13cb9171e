//! `cograin chart`

use super::{Ending, say};
use clap::Args;
use cograin::scene::{Models, Setting};
use cograin_chart::SceneChart;
use std::path::PathBuf;

/// `cograin chart`
#[derive(Args)]
pub(super) struct ChartArguments {
    /// Scene files
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Another value for a key of the scenes, for example run.end=0.5; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<Setting>,
    /// Error of the outputs, over the largest value of each quantity, for which to recommend a step
    #[arg(long, value_name = "ERROR", default_value_t = 0.01, allow_negative_numbers = true, value_parser = above_zero)]
    wanted: f64,
    /// Folder of the tables and pictures
    #[arg(short, long, value_name = "DIR", default_value = "charts")]
    output: PathBuf,
}

/// A finite number above 0.
pub(super) fn above_zero(text: &str) -> Result<f64, String> {
    let found = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
    found.ok_or_else(|| format!("expected a number above 0, found {text:?}"))
}

/// `cograin chart`
pub(super) fn chart(models: &Models, arguments: &ChartArguments) -> Result<(), Ending> {
    let read = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let chart = SceneChart::of(models, path, &arguments.settings, arguments.wanted).map_err(Ending::refused)?;
        Ok((name, chart))
    };
    let charts = arguments.scenes.iter().map(read).collect::<Result<Vec<_>, Ending>>()?;
    for (name, chart) in charts {
        say(format_args!(
            "{name}: outputs over the time step against the finest one, about {:.1} s of processor time",
            chart.seconds
        ))?;
        let drawing = chart.draw().map_err(Ending::failed)?;
        for path in drawing.write(&arguments.output, &name).map_err(Ending::failed)? {
            say(format_args!("  wrote {}", path.display()))?;
        }
        for note in &drawing.notes {
            say(format_args!("  {note}"))?;
        }
    }
    Ok(())
}
