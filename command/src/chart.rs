//! `cograin chart`

use super::{Ending, say};
use clap::Args;
use cograin::scene::{Models, Setting};
use cograin_chart::{CHARTS, Chart, ChartError, Drawing, SceneChart, named};
use std::path::{Path, PathBuf};

/// `cograin chart`
#[derive(Args)]
pub(super) struct ChartArguments {
    /// Names of charts; or scene files, whose outputs are charted over the time step
    #[arg(required_unless_present_any = ["list", "all"], conflicts_with_all = ["list", "all"], value_name = "NAME|SCENE")]
    names: Vec<String>,
    /// Another value for a key of the scenes, for example run.end=0.5; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<Setting>,
    /// Error of the outputs of a scene, over the largest value of each quantity, for which to recommend a step
    #[arg(long, value_name = "ERROR", default_value_t = 0.01)]
    wanted: f64,
    /// Name all charts, what they show and what they cost
    #[arg(long)]
    list: bool,
    /// Draw all charts
    #[arg(long, conflicts_with = "list")]
    all: bool,
    /// Folder of the tables and pictures
    #[arg(short, long, value_name = "DIR", default_value = "charts")]
    output: PathBuf,
}

/// `cograin chart`
pub(super) fn chart(models: &Models, arguments: &ChartArguments) -> Result<(), Ending> {
    if arguments.list {
        for Chart { name, shows, seconds, .. } in CHARTS {
            say(format_args!("{name:<16} {seconds:>5} s  {shows}"));
        }
        return Ok(());
    }
    std::fs::create_dir_all(&arguments.output)
        .map_err(|error| Ending::failed(format_args!("{}: {error}", arguments.output.display())))?;
    let charts = if arguments.all { CHARTS.iter().map(Wanted::Named).collect() } else { chosen(models, arguments)? };
    let cost: f64 = charts.iter().map(Wanted::seconds).sum();
    say(format_args!("about {cost:.0} s on one core"));
    for chart in charts {
        say(chart.headline());
        let drawing = chart.draw().map_err(Ending::failed)?;
        for path in drawing.write(&arguments.output, chart.name()).map_err(Ending::failed)? {
            say(format_args!("  wrote {}", path.display()));
        }
        for note in &drawing.notes {
            say(format_args!("  {note}"));
        }
    }
    Ok(())
}

/// A chart that is wanted.
enum Wanted {
    /// One of the program's own.
    Named(&'static Chart),
    /// That of a user's scene, under the name of its file.
    Scene(String, SceneChart),
}

impl Wanted {
    /// Name of its files.
    fn name(&self) -> &str {
        match self {
            Self::Named(chart) => chart.name,
            Self::Scene(name, _) => name,
        }
    }

    /// What it costs, about \[s\].
    fn seconds(&self) -> f64 {
        match self {
            Self::Named(chart) => chart.seconds,
            Self::Scene(_, chart) => chart.seconds,
        }
    }

    /// What is said before it is drawn.
    fn headline(&self) -> String {
        match self {
            Self::Named(chart) => format!("{}: {}", chart.name, chart.shows),
            Self::Scene(name, chart) => {
                format!("{name}: outputs over the time step against the finest one, about {:.1} s", chart.seconds)
            }
        }
    }

    /// Computes it.
    fn draw(&self) -> Result<Drawing, ChartError> {
        match self {
            Self::Named(chart) => (chart.draw)(),
            Self::Scene(_, chart) => chart.draw(),
        }
    }
}

/// The charts of the names that were given.
fn chosen(models: &Models, arguments: &ChartArguments) -> Result<Vec<Wanted>, Ending> {
    let all = || CHARTS.iter().map(|chart| chart.name).collect::<Vec<_>>().join(", ");
    let find = |name: &String| {
        if let Some(chart) = named(name) {
            return Ok(Wanted::Named(chart));
        }
        let path = Path::new(name);
        if path.extension().is_none_or(|ending| ending != "toml") {
            return Err(Ending::refused(format_args!(
                "{name} is not a chart; one of {}, or a scene file, is right",
                all()
            )));
        }
        let chart = SceneChart::of(models, path, &arguments.settings, arguments.wanted).map_err(Ending::refused)?;
        let stem = path.file_stem().map_or_else(|| name.clone(), |stem| stem.to_string_lossy().into_owned());
        Ok(Wanted::Scene(stem, chart))
    };
    arguments.names.iter().map(find).collect()
}
