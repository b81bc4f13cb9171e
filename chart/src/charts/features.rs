//! What each feature adds to the cost of a time step.
//!
//! A block of spheres that press on each other and on six planes makes steps on one thread, one feature after the other, in turn;
//! the least time of several rounds counts. It is processor time where the system tells it, so that other programs disturb less.

use super::{Chart, Drawing};
use crate::ChartError;
use crate::picture::{Bars, Picture};
use crate::stage::Stage;
use crate::table::Table;
use std::time::Instant;

/// The chart.
pub(super) const CHART: Chart = Chart {
    name: "features",
    shows: "what laws, bonds, damping and books add to the time of a step",
    seconds: 16.0,
    draw,
};

/// Spheres along each edge of the block.
const EDGE: usize = 20;

/// Time steps in a round.
const STEPS: f64 = 40.0;

/// Rounds.
const ROUNDS: u32 = 5;

/// Friction and rolling friction of the spheres, that have them.
const ROUGH: &str = "[contact.c.tangential.history]";

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

/// The scene with a feature.
fn text(feature: &str) -> String {
    let (spacing, high) = (0.999 * 2e-3, (EDGE as f64 - 0.5) * 0.999 * 2e-3);
    let friction = if feature.contains("SMOOTH") { 0.0 } else { 0.5 };
    let gravity = if feature.contains("GRAVITY") { "gravity = [0.0, 0.0, -9.81]\n" } else { "" };
    let scheme = [("MIDWAY", "scheme = \"midway\""), ("PREDICTED", "scheme = \"predicted\"")];
    let run = scheme.iter().find(|(word, _)| feature.contains(word)).map_or("", |(_, line)| line);
    let bond = "[bond.b]\nbetween = [\"block\", \"block\"]\ncreate_distance = 2.1e-3\nnormal_stiffness = 1e12\n\
                tangential_stiffness = 4e11";
    let own = feature.replace("ROUGH", ROUGH).replace("BOND", bond);
    let own =
        ["SMOOTH", "GRAVITY", "SINGLE", "MIDWAY", "PREDICTED"].iter().fold(own, |text, word| text.replace(word, ""));
    let mut planes = String::new();
    for axis in 0..3 {
        for (side, at) in [("low", -0.5 * spacing), ("high", high)] {
            let vector = |value: f64| (0..3).map(|place| if place == axis { value } else { 0.0 }).collect::<Vec<_>>();
            let (point, normal) = (vector(at), vector(if side == "low" { 1.0 } else { -1.0 }));
            planes += &format!(
                "[boundary.{side}{axis}]\nmaterial = \"a\"\nplane = {{ point = {point:?}, normal = {normal:?} }}\n"
            );
        }
    }
    format!(
        "{gravity}[run]\nthreads = 1\nmax_overlap = 0.1\n{run}\n\
         [material.a]\ndensity = 2500.0\nyoungs_modulus = 1e8\npoissons_ratio = 0.25\n\
         [pair.a.a]\nrestitution = 0.5\nfriction = {friction:?}\nrolling_friction = 0.1\ncohesion_energy_density = 1e3\n\
         surface_energy = 1e-3\ndamping_coefficient = 1e3\ntangential_damping_ratio = 1.0\nunloading_stiffness_ratio = 2.0\n\
         pull_off_force = 0.0\n{own}\n\
         [particles.block]\nmaterial = \"a\"\n\
         lattice = {{ kind = \"simple_cubic\", radius = 1e-3, spacing = {spacing:?}, counts = [{EDGE}, {EDGE}, {EDGE}] }}\n{planes}"
    )
}

/// Processor time of this thread \[s\], or wall time where the system does not tell it.
fn processor_time(begun: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| begun.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

/// Columns of the table.
const COLUMNS: [&str; 5] =
    ["feature", "contacts", "bonds", "time of a step", "time of a step over that of hertz + history"];

/// What is compared with.
const BASE: &str = "hertz + history";

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut stages = Vec::new();
    for (name, feature) in FEATURES {
        let mut stage = Stage::of(&text(feature))?;
        let pieces = if feature.contains("SINGLE") { STEPS as u32 } else { 1 };
        stage.advance(STEPS / 4.0 * stage.step())?;
        stages.push((name, pieces, stage, f64::INFINITY));
    }
    let begun = Instant::now();
    for _ in 0..ROUNDS {
        for (_, pieces, stage, least) in &mut stages {
            let (before, made) = (processor_time(begun), stage.simulation.state().clock.steps);
            for _ in 0..*pieces {
                stage.advance(STEPS / f64::from(*pieces) * stage.step())?;
            }
            let steps = stage.simulation.state().clock.steps - made;
            *least = least.min((processor_time(begun) - before) / steps as f64);
        }
    }
    let base = stages.iter().find(|(name, ..)| *name == BASE).map_or(1.0, |(.., least)| *least);
    let mut table =
        Table::new([(COLUMNS[0], ""), (COLUMNS[1], "1"), (COLUMNS[2], "1"), (COLUMNS[3], "µs"), (COLUMNS[4], "1")]);
    for (name, _, stage, least) in &stages {
        let bonds = stage.simulation.state().bonds.iter().map(|list| list.first.len()).sum::<usize>();
        let contacts = stage.simulation.contact_count();
        let (contacts, bonds) = (contacts as f64, bonds as f64);
        table.push([(*name).into(), contacts.into(), bonds.into(), (1e6 * least).into(), (least / base).into()]);
    }
    let title = format!("{} spheres in a block between six planes, one thread", EDGE * EDGE * EDGE);
    let bars = Bars { title, words: COLUMNS[0], number: COLUMNS[4] };
    let notes = vec![format!("hertz + history: {:.0} µs a step", 1e6 * base)];
    Ok(Drawing { table, picture: Picture { bars: vec![bars], ..Picture::default() }, notes })
}
