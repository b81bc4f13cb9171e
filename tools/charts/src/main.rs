//! Draws the charts of `docs/`: each is a file here with its name, what it shows, what it costs, and a function that computes its
//! table.

mod accuracy;
mod bed;
mod block;
mod bodies;
mod border;
mod cantilever;
mod cohesion;
mod dashpots;
mod drops;
mod features;
mod impact;
mod kharaz;
mod mean_impact;
mod oblique;
mod peers;
mod rolling;
mod runs;
mod schemes;
mod size_ratio;
mod stage;
mod work;

use clap::Parser;
use cograin_chart::{ChartError, Drawing};
use rayon::prelude::*;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// One chart.
struct Chart {
    /// Its name on the command line and of its files.
    name: &'static str,
    /// What it shows, in a line.
    shows: &'static str,
    /// What it takes, about: processor time of one core \[s\].
    seconds: f64,
    /// What it measures.
    measures: Measures,
    /// Computes it.
    draw: fn() -> Result<Drawing, ChartError>,
}

/// What a chart measures.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Measures {
    /// Errors alone: other charts may be computed meanwhile.
    Errors,
    /// Also times, which whatever runs meanwhile would change.
    Times,
}

/// All charts.
const CHARTS: &[Chart] = &[
    impact::CHART,
    mean_impact::CHART,
    oblique::CHART,
    kharaz::CHART,
    rolling::CHART,
    cantilever::CHART,
    accuracy::CHART,
    dashpots::CHART,
    cohesion::CHART,
    bed::CHART,
    size_ratio::CHART,
    bodies::CHART,
    features::CHART,
    work::CHART,
];

/// Draws the charts of the documentation.
///
/// Charts that measure times are drawn one after the other; use a release build for them.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Names of charts
    #[arg(required_unless_present_any = ["list", "all"], conflicts_with_all = ["list", "all"], value_name = "NAME",
        value_parser = named)]
    names: Vec<&'static Chart>,
    /// Name all charts, what they show and what they cost
    #[arg(long)]
    list: bool,
    /// Draw all charts
    #[arg(long, conflicts_with = "list")]
    all: bool,
    /// Folder of the tables and pictures
    #[arg(short, long, value_name = "DIR", default_value = "docs/charts")]
    output: PathBuf,
}

/// The chart of this name.
fn named(name: &str) -> Result<&'static Chart, String> {
    let all = || CHARTS.iter().map(|chart| chart.name).collect::<Vec<_>>().join(", ");
    CHARTS.iter().find(|chart| chart.name == name).ok_or_else(|| format!("expected one of {}", all()))
}

/// Computes a chart and writes its files. Returns what is to be said about it.
fn draw(chart: &Chart, folder: &Path) -> Result<String, ChartError> {
    let drawing = (chart.draw)()?;
    let mut said = format!("{}: {}\n", chart.name, chart.shows);
    for path in drawing.write(folder, chart.name)? {
        said += &format!("  wrote {}\n", path.display());
    }
    for note in &drawing.notes {
        said += &format!("  {note}\n");
    }
    Ok(said)
}

/// Computes charts: first those beside each other that bear it, then the others one by one.
fn draw_all(charts: &[&Chart], folder: &Path, say: &mut dyn FnMut(&str)) -> Result<(), ChartError> {
    let (timed, others): (Vec<&Chart>, Vec<&Chart>) =
        charts.iter().partition(|chart| chart.measures == Measures::Times);
    let drawn: Vec<_> = others.par_iter().map(|chart| draw(chart, folder)).collect();
    for said in drawn.into_iter().chain(timed.into_iter().map(|chart| draw(chart, folder))) {
        say(&said?);
    }
    Ok(())
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    // Who closed the standard output does not want to know.
    let mut say = |text: &str| drop(std::io::stdout().write_all(text.as_bytes()));
    if arguments.list {
        for Chart { name, shows, seconds, .. } in CHARTS {
            say(&format!("{name:<16} {seconds:>5} s  {shows}\n"));
        }
        return ExitCode::SUCCESS;
    }
    let charts = if arguments.all { CHARTS.iter().collect() } else { arguments.names };
    let cost: f64 = charts.iter().map(|chart| chart.seconds).sum();
    say(&format!("about {cost:.0} s of processor time\n"));
    match draw_all(&charts, &arguments.output, &mut say) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            drop(writeln!(std::io::stderr(), "{error}"));
            ExitCode::FAILURE
        }
    }
}
