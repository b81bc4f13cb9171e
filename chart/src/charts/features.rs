//! What each feature adds to the cost of a time step of a block of spheres.

use super::block::{EDGE, Timed, times};
use super::{Chart, Drawing};
use crate::ChartError;
use crate::picture::{Bars, Picture};
use crate::table::Table;

/// The chart.
pub(super) const CHART: Chart = Chart {
    name: "features",
    shows: "what laws, bonds, damping and books add to the time of a step",
    seconds: 16.0,
    draw,
};

/// What is measured: its name, and what the scene has beside particles and planes.
const FEATURES: [(&str, &str); 27] = [
    ("no law at all", ""),
    ("hooke", "[contact.c.normal.hooke]\ncharacteristic_velocity = 1.0\n"),
    ("hertz", "[contact.c.normal.hertz]\n"),
    ("hertz + no_history", "[contact.c.normal.hertz]\n[contact.c.tangential.no_history]\n"),
    ("hertz + history", "[contact.c.normal.hertz]\nROUGH\n"),
    ("hertz + history of friction 0", "[contact.c.normal.hertz]\nROUGH\nSMOOTH"),
    ("hertz + turned_history", "[contact.c.normal.hertz]\n[contact.c.tangential.turned_history]\n"),
    ("hertz + history, midway", "[contact.c.normal.hertz]\nROUGH\nMIDWAY"),
    ("hertz + history, predicted", "[contact.c.normal.hertz]\nROUGH\nPREDICTED"),
    ("hertz, predicted", "[contact.c.normal.hertz]\nPREDICTED"),
    ("hertz + history + cdt", "[contact.c.normal.hertz]\nROUGH\n[contact.c.rolling.cdt]\n"),
    ("hertz + history + epsd2", "[contact.c.normal.hertz]\nROUGH\n[contact.c.rolling.epsd2]\n"),
    ("hertz + history + sjkr", "[contact.c.normal.hertz]\nROUGH\n[contact.c.cohesion.sjkr]\n"),
    ("jkr + turned_history", "[contact.c.normal.jkr]\n[contact.c.tangential.turned_history]\n"),
    ("eepa + history", "[contact.c.normal.eepa]\noverlap_exponent = 1.5\nadhesion_exponent = 1.5\nROUGH\n"),
    ("hertz + history, gravity", "[contact.c.normal.hertz]\nROUGH\nGRAVITY"),
    ("hertz + history, Cundall damping", "[contact.c.normal.hertz]\nROUGH\n[damping.d]\nlinear = 0.7\nangular = 0.7\n"),
    ("hertz + history, energy book", "[contact.c.normal.hertz]\nROUGH\n[output]\nenergy = true\n"),
    ("hertz + history, losses", "[contact.c.normal.hertz]\nROUGH\n[output]\nlosses = true\n"),
    ("hertz + history, every step an interval", "[contact.c.normal.hertz]\nROUGH\nSINGLE"),
    ("bonds incremental", "BOND\nformulation = \"incremental\"\n"),
    ("bonds finite_rotation", "BOND\n"),
    (
        "bonds finite_rotation, viscous",
        "BOND\n[bond.b.damping.viscous]\nnormal_force = 0.05\ntangential_force = 0.05\n",
    ),
    ("bonds finite_rotation, breakage", "BOND\n[bond.b.breakage]\nmax_normal_stress = 1e12\nmax_shear_stress = 1e12\n"),
    ("bonds finite_rotation, energy book", "BOND\n[output]\nenergy = true\n"),
    ("bonds finite_rotation, losses", "BOND\n[output]\nlosses = true\n"),
    ("bonds + hertz + history", "[contact.c.normal.hertz]\nROUGH\nBOND\n"),
];

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
