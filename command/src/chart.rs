//! `cograin chart`

use super::{Ending, say};
use clap::Args;
use cograin_chart::{CHARTS, Chart, named};
use std::path::PathBuf;

/// `cograin chart`
#[derive(Args)]
pub(super) struct ChartArguments {
    /// Names of charts
    #[arg(required_unless_present_any = ["list", "all"], conflicts_with_all = ["list", "all"])]
    names: Vec<String>,
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
pub(super) fn chart(arguments: &ChartArguments) -> Result<(), Ending> {
    if arguments.list {
        for Chart { name, shows, seconds, .. } in CHARTS {
            say(format_args!("{name:<16} {seconds:>5} s  {shows}"));
        }
        return Ok(());
    }
    let charts = if arguments.all { CHARTS.iter().collect() } else { chosen(&arguments.names)? };
    std::fs::create_dir_all(&arguments.output)
        .map_err(|error| Ending::failed(format_args!("{}: {error}", arguments.output.display())))?;
    let cost: f64 = charts.iter().map(|chart| chart.seconds).sum();
    say(format_args!("about {cost} s on one core"));
    for chart in charts {
        say(format_args!("{}: {}", chart.name, chart.shows));
        let drawing = (chart.draw)().map_err(Ending::failed)?;
        for path in drawing.write(&arguments.output, chart.name).map_err(Ending::failed)? {
            say(format_args!("  wrote {}", path.display()));
        }
        for note in &drawing.notes {
            say(format_args!("  {note}"));
        }
    }
    Ok(())
}

/// The charts of these names.
fn chosen(names: &[String]) -> Result<Vec<&'static Chart>, Ending> {
    let all = || CHARTS.iter().map(|chart| chart.name).collect::<Vec<_>>().join(", ");
    let find = |name: &String| {
        named(name).ok_or_else(|| Ending::refused(format_args!("{name} is no chart; one of {} is right", all())))
    };
    names.iter().map(find).collect()
}
