//! How exact a result is for the processor time that it takes: error over cost, scheme by scheme, and other programs beside.
//!
//! The cost of an impact is that of one contact: its time steps times what a contact and step takes in the block of `features`,
//! with the same law and scheme (all have friction there). That of a sphere that rocks is that of its contact, over a period of its bounce; that of a
//! cantilever is the same for one bond. Other programs rebound the same way, and compute the same block.

use crate::block::{BOND, Feature, HERTZ, HOOKE, ROUGH, times};
use crate::cantilever::deflection_errors;
use crate::impact::{self, RESTITUTIONS};
use crate::oblique;
use crate::peers::{PEERS, Peer};
use crate::rolling::rocking_errors;
use crate::schemes::{PREDICTED, SCHEMES, Scheme};
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "work",
    shows: "error over processor time: impacts, a sphere that rocks and a bonded cantilever, over schemes, formulations and other programs",
    seconds: 40.0,
    measures: Measures::Times,
    draw,
};

/// Contacts that are timed, in every scheme: the case, and the block's law.
const CONTACTS: [(&str, &[&str]); 2] = [("hertz", &[HERTZ, ROUGH]), ("hooke", &[HOOKE, ROUGH])];

/// Lines of the block that give bonds the dashpots of the cantilever.
const VISCOUS: &str = "[bond.b.damping.viscous]\nnormal_force = 0.05\ntangential_force = 0.05\nnormal_torque = 0.05\ntangential_torque = 0.05\n";

/// Bonds that are timed: formulation and damping of the cantilever, and the block's bonds.
const BONDS: [([&str; 2], Feature); 4] = [
    (["finite_rotation", ""], Feature::new("finite_rotation", &[BOND])),
    (["incremental", ""], Feature::new("incremental", &[BOND, "formulation = \"incremental\"\n"])),
    (["finite_rotation", "viscous 0.05"], Feature::new("finite_rotation, viscous 0.05", &[BOND, VISCOUS])),
    (
        ["finite_rotation", "viscous 0.05"],
        Feature::new("finite_rotation, viscous 0.05, predicted", &[BOND, VISCOUS]).with(PREDICTED),
    ),
];

/// Restitution and friction of the oblique impacts.
const OBLIQUE: [f64; 2] = [0.5, 0.4];

/// The law of the sphere that rocks.
const ROCKING: [&str; 3] = [HERTZ, ROUGH, "[contact.c.rolling.epsd2]\n"];

/// The diagrams: cases and their titles.
const CASES: [(&str, &str); 5] = [
    ("impact, hertz", "impact, hertz: restitution, largest error over e = 0.1 to 1"),
    ("impact, hooke", "impact, hooke: restitution, largest error over e = 0.1 to 1"),
    ("oblique impact", "oblique impact, hertz + history, e = 0.5, µ = 0.4: rebound, largest error over 5° to 70°"),
    ("rocking", "rocking sphere, hertz + history + epsd2: speed"),
    ("cantilever", "bonded cantilever: deflection over a period"),
];

/// Errors for which the notes say what they cost.
const WANTED: [f64; 2] = [1e-2, 1e-3];

/// Columns.
const COLUMNS: [&str; 5] = ["case", "series", "time steps", "processor time of a contact or bond", "largest error"];

/// Adds the points of a case and series: time steps and errors, with the cost of a contact or bond and step \[ns\].
fn fill(table: &mut Table, case: &str, series: &str, points: &[[f64; 2]], cost: f64) {
    for &[steps, error] in points {
        table.push([case.into(), series.into(), steps.into(), (cost * steps).into(), error.into()]);
    }
}

/// The largest errors of an impact over all restitutions, over time steps in an elastic contact.
fn impact_errors(normal: &impact::Normal, scheme: &Scheme) -> Result<Vec<[f64; 2]>, ChartError> {
    let mut points = Vec::new();
    for steps in impact::STEPS {
        let mut error = 0.0_f64;
        for restitution in RESTITUTIONS {
            error = error.max(impact::error(normal, restitution, scheme, steps)?);
        }
        points.push([steps, error]);
    }
    Ok(points)
}

/// Impacts with every scheme, and of the peers. What is to be said about them.
fn impacts(table: &mut Table) -> Result<Vec<String>, ChartError> {
    let of_law = |(_, law)| SCHEMES.iter().map(move |scheme| Feature::new(scheme.name, law).with(*scheme));
    let features: Vec<Feature> = CONTACTS.into_iter().flat_map(of_law).collect();
    let (timed, mut notes) = (times(&features)?, Vec::new());
    for (normal, timed) in impact::models().iter().zip(timed.chunks(SCHEMES.len())) {
        let case = format!("impact, {}", normal.name);
        for (scheme, timed) in SCHEMES.iter().zip(timed) {
            let cost = 1e9 * timed.least / timed.contacts();
            fill(table, &case, scheme.name, &impact_errors(normal, scheme)?, cost);
            if normal.name == "hertz" {
                let points = oblique::largest_errors(oblique::HISTORY, OBLIQUE, scheme.run)?;
                fill(table, "oblique impact", scheme.name, &points, cost);
            }
        }
        // The first scheme is that of the peers.
        let ours = &timed[0];
        for peer in &PEERS {
            notes.push(match peer.step_time(normal.name, ours.stage.step())? {
                Some(time) => {
                    fill(table, &case, peer.name, &peer_errors(peer, normal.name)?, 1e9 * time / ours.contacts());
                    format!("{case}: a step of {} takes {:.2} times one of {}", peer.name, time / ours.least, ours.name)
                }
                None => format!("{case}: {} is not installed: its points are left out", peer.name),
            });
        }
    }
    Ok(notes)
}

/// The largest errors of a peer's impact over all restitutions, over time steps in an elastic contact; none if it fails in one.
fn peer_errors(peer: &Peer, model: &str) -> Result<Vec<[f64; 2]>, ChartError> {
    let mut points = Vec::new();
    for steps in impact::PEER_STEPS {
        let mut error = 0.0_f64;
        for restitution in RESTITUTIONS {
            let Some(found) = impact::peer_error(peer, model, restitution, steps)? else { return Ok(Vec::new()) };
            error = error.max(found);
        }
        points.push([steps, error]);
    }
    Ok(points)
}

/// The sphere that rocks, with every scheme.
fn rocking(table: &mut Table) -> Result<(), ChartError> {
    let features: Vec<Feature> =
        SCHEMES.iter().map(|scheme| Feature::new(scheme.name, &ROCKING).with(*scheme)).collect();
    for (scheme, timed) in SCHEMES.iter().zip(times(&features)?) {
        fill(table, "rocking", scheme.name, &rocking_errors(scheme)?, 1e9 * timed.least / timed.contacts());
    }
    Ok(())
}

/// The cantilever with every kind of bond.
fn cantilevers(table: &mut Table) -> Result<(), ChartError> {
    let timed = times(&BONDS.map(|(_, feature)| feature))?;
    for (([formulation, damping], feature), timed) in BONDS.into_iter().zip(&timed) {
        let (series, scheme) = (feature.name, feature.scheme.map_or("", |scheme| scheme.run));
        let (errors, _) = deflection_errors([series, formulation, damping], scheme)?;
        let points: Vec<[f64; 2]> = errors.iter().map(|found| [found.steps, found.error]).collect();
        fill(table, "cantilever", series, &points, 1e9 * timed.least / timed.bonds());
    }
    Ok(())
}

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let mut table =
        Table::new([(COLUMNS[0], ""), (COLUMNS[1], ""), (COLUMNS[2], "1"), (COLUMNS[3], "ns"), (COLUMNS[4], "1")]);
    let mut notes = impacts(&mut table)?;
    rocking(&mut table)?;
    cantilevers(&mut table)?;
    for (case, _) in CASES {
        notes.extend(costs(&table, case));
    }
    notes.extend(CASES.iter().flat_map(|(case, _)| below(&table, case)));
    if cfg!(debug_assertions) {
        notes.push("this is a development build: the times of a release build are shorter".to_owned());
    }
    let panel = |(case, title): (&str, &str)| Panel {
        only: Some((COLUMNS[0], case.to_owned())),
        single: PEERS.iter().map(|peer| peer.name).collect(),
        ..Panel::new(title, logarithmic(COLUMNS[3]), logarithmic(COLUMNS[4]), COLUMNS[1])
    };
    let panels = CASES.into_iter().map(panel).collect();
    Ok(Drawing { table, picture: Picture { panels, columns: 2, ..Picture::default() }, notes })
}

/// The points of a case, series by series in the order of the table: cost \[ns\] and error.
fn series_of(table: &Table, case: &str) -> Vec<(String, Vec<[f64; 2]>)> {
    let mut all: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    for (row, cells) in table.rows.iter().enumerate() {
        if cells[0].to_string() != case {
            continue;
        }
        let [Some(cost), Some(error)] = [COLUMNS[3], COLUMNS[4]].map(|column| table.number(row, column)) else {
            continue;
        };
        let series = cells[1].to_string();
        match all.iter_mut().find(|(name, _)| *name == series) {
            Some((_, points)) => points.push([cost, error]),
            None => all.push((series, vec![[cost, error]])),
        }
    }
    all.iter_mut().for_each(|(_, points)| points.sort_by(|a, b| a[0].total_cmp(&b[0])));
    all
}

/// The cost from which on a series has at most this error, on the straight lines of the picture; none if it never does.
fn cost_of(points: &[[f64; 2]], wanted: f64) -> Option<f64> {
    let place = points.iter().rposition(|point| point[1] > wanted).map_or(0, |last| last + 1);
    let [cost, error] = *points.get(place)?;
    let Some(before) = place.checked_sub(1) else { return Some(cost) };
    let part = libm::log(points[before][1] / wanted) / libm::log(points[before][1] / error);
    Some(points[before][0] * libm::pow(cost / points[before][0], part))
}

/// What wanted errors of a case cost.
fn costs(table: &Table, case: &str) -> Vec<String> {
    let told = |wanted: f64| {
        let series = series_of(table, case).into_iter().map(|(name, points)| match cost_of(&points, wanted) {
            Some(cost) => format!("{name} {cost:.0} ns"),
            None => format!("{name} not reached"),
        });
        format!("{case}, error {wanted:.0e}: {}", series.collect::<Vec<_>>().join(", "))
    };
    WANTED.into_iter().map(told).collect()
}

/// Which points of peers in a case are more exact than ours at the same cost.
fn below(table: &Table, case: &str) -> Vec<String> {
    let of_peer = |name: &String| PEERS.iter().any(|peer| peer.name == name);
    let (peers, ours): (Vec<_>, Vec<_>) = series_of(table, case).into_iter().partition(|(name, _)| of_peer(name));
    let needed =
        |error: f64| ours.iter().filter_map(|(_, points)| cost_of(points, error)).fold(f64::INFINITY, f64::min);
    let mut found = Vec::new();
    for (name, points) in &peers {
        for &[cost, error] in points.iter().filter(|[cost, error]| needed(*error) > *cost) {
            let needed = needed(error);
            found.push(format!(
                "{case}: {name} has an error of {error:.1e} for {cost:.0} ns, cograin needs {needed:.0} ns"
            ));
        }
    }
    if !peers.is_empty() && found.is_empty() {
        found.push(format!("{case}: no point of another program lies below those of cograin"));
    }
    found
}
