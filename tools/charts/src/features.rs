//! What each feature adds to the cost of a time step of a block of spheres.

use crate::block::{BOND, EDGE, Feature, HERTZ, HOOKE, ROUGH, Timed, times};
use crate::schemes::{ENGINE, MIDWAY, PREDICTED};
use crate::{Chart, Measures};
use cograin_chart::picture::{Bars, Picture};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "features",
    shows: "what laws, bonds, damping and books add to the time of a step",
    seconds: 16.0,
    measures: Measures::Times,
    draw,
};

/// What is measured.
const FEATURES: [Feature; 29] = [
    Feature::new("no law at all", &[]),
    Feature::new("hooke", &[HOOKE]),
    Feature::new("hertz", &[HERTZ]),
    Feature::new("hertz, engine", &[HERTZ]).with(ENGINE),
    Feature::new("hertz, predicted", &[HERTZ]).with(PREDICTED),
    Feature::new("hertz + no_history", &[HERTZ, "[contact.c.tangential.no_history]\n"]),
    Feature::new(BASE, &[HERTZ, ROUGH]),
    Feature { friction: 0.0, ..Feature::new("hertz + history of friction 0", &[HERTZ, ROUGH]) },
    Feature::new("hertz + turned_history", &[HERTZ, TURNED]),
    Feature::new("hertz + history, engine", &[HERTZ, ROUGH]).with(ENGINE),
    Feature::new("hertz + history, midway", &[HERTZ, ROUGH]).with(MIDWAY),
    Feature::new("hertz + history, predicted", &[HERTZ, ROUGH]).with(PREDICTED),
    Feature::new("hertz + history + cdt", &[HERTZ, ROUGH, "[contact.c.rolling.cdt]\n"]),
    Feature::new("hertz + history + epsd2", &[HERTZ, ROUGH, "[contact.c.rolling.epsd2]\n"]),
    Feature::new("hertz + history + sjkr", &[HERTZ, ROUGH, "[contact.c.cohesion.sjkr]\n"]),
    Feature::new("jkr + turned_history", &["[contact.c.normal.jkr]\n", TURNED]),
    Feature::new(
        "eepa + history",
        &["[contact.c.normal.eepa]\noverlap_exponent = 1.5\nadhesion_exponent = 1.5\n", ROUGH],
    ),
    Feature { gravity: true, ..Feature::new("hertz + history, gravity", &[HERTZ, ROUGH]) },
    Feature::new("hertz + history, Cundall damping", &[HERTZ, ROUGH, "[damping.d]\nlinear = 0.7\nangular = 0.7\n"]),
    Feature::new("hertz + history, energy book", &[HERTZ, ROUGH, ENERGY]),
    Feature::new("hertz + history, losses", &[HERTZ, ROUGH, LOSSES]),
    Feature { single_steps: true, ..Feature::new("hertz + history, every step an interval", &[HERTZ, ROUGH]) },
    Feature::new("bonds incremental", &[BOND, "formulation = \"incremental\"\n"]),
    Feature::new("bonds finite_rotation", &[BOND]),
    Feature::new(
        "bonds finite_rotation, viscous",
        &[BOND, "[bond.b.damping.viscous]\nnormal_force = 0.05\ntangential_force = 0.05\n"],
    ),
    Feature::new(
        "bonds finite_rotation, breakage",
        &[BOND, "[bond.b.breakage]\nmax_normal_stress = 1e12\nmax_shear_stress = 1e12\n"],
    ),
    Feature::new("bonds finite_rotation, energy book", &[BOND, ENERGY]),
    Feature::new("bonds finite_rotation, losses", &[BOND, LOSSES]),
    Feature::new("bonds + hertz + history", &[HERTZ, ROUGH, BOND]),
];

/// Lines of another friction.
const TURNED: &str = "[contact.c.tangential.turned_history]\n";

/// Lines of books.
const ENERGY: &str = "[output]\nenergy = true\n";

/// The same, with every loss by itself.
const LOSSES: &str = "[output]\nlosses = true\n";

/// Columns of the table.
const COLUMNS: [&str; 5] =
    ["feature", "contacts", "bonds", "time of a step", "time of a step over that of hertz + history"];

/// What is compared with.
const BASE: &str = "hertz + history";

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let stages = times(&FEATURES)?;
    let base = stages.iter().find(|timed| timed.name == BASE).map_or(1.0, |timed| timed.least);
    let mut table =
        Table::new([(COLUMNS[0], ""), (COLUMNS[1], "1"), (COLUMNS[2], "1"), (COLUMNS[3], "µs"), (COLUMNS[4], "1")]);
    for timed in &stages {
        let Timed { name, least, .. } = *timed;
        let (contacts, bonds) = (timed.contacts(), timed.bonds());
        table.push([name.into(), contacts.into(), bonds.into(), (1e6 * least).into(), (least / base).into()]);
    }
    let title = format!("{} spheres in a block between six planes, one thread", EDGE * EDGE * EDGE);
    let bars = Bars { title, words: COLUMNS[0], number: COLUMNS[4] };
    let notes = vec![format!("hertz + history: {:.0} µs a step", 1e6 * base)];
    Ok(Drawing { table, picture: Picture { bars: vec![bars], ..Picture::default() }, notes })
}
