//! How exactly a sphere rebounds from a plane, over the number of time steps in the contact.
//!
//! Set-up 3 of Y. C. Chung & J. Y. Ooi, *Granular Matter* 13 (2011) 643–656. The error is the largest over the moments at
//! which the contact may begin and end within a time step. Theory: the restitution that leaves is the one that the scene
//! gives; Tsuji's dashpot is exact for Hertz's force, the dashpot of `hooke` for its spring, where the end may pull.

use crate::drops::{SPEED, Throw, hertz_duration, hooke_duration};
use crate::peers::{PEERS, Peer};
use crate::schemes::{ENGINE, PREDICTED_NORMAL, SCHEMES, Scheme};
use crate::{Chart, Measures};
use cograin_chart::picture::{Panel, Picture, logarithmic};
use cograin_chart::table::Table;
use cograin_chart::{ChartError, Drawing};

/// The chart.
pub(crate) const CHART: Chart = Chart {
    name: "impact",
    shows: "error of restitution over time steps in a contact: hertz and hooke, from damped to elastic",
    seconds: 5.0,
    measures: Measures::Errors,
    draw,
};

/// Moments within a time step at which contacts end: parts of a step that a contact is longer.
const ENDS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Time steps in an elastic contact.
pub(crate) const STEPS: [f64; 12] = [5.0, 8.0, 12.0, 20.0, 32.0, 50.0, 80.0, 125.0, 200.0, 400.0, 800.0, 1600.0];

/// Coefficients of restitution.
pub(crate) const RESTITUTIONS: [f64; 5] = [0.1, 0.3, 0.6, 0.9, 1.0];

/// What the default step is called.
const DEFAULT: &str = "default step, all e";

/// What follows the name of a peer where its points are named.
const ALL: &str = ", all e";

/// Time steps in an elastic contact of the peer's points.
pub(crate) const PEER_STEPS: [f64; 3] = [20.0, 80.0, 400.0];

/// A normal model: its name, its table in the scene, the duration of an elastic contact \[s\].
pub(crate) struct Normal {
    /// Its name.
    pub name: &'static str,
    /// Its table in the scene.
    table: String,
    /// Duration of the elastic contact \[s\].
    duration: f64,
}

impl Normal {
    /// Spheres with this restitution.
    fn throw(&self, restitution: f64) -> Throw<'_> {
        Throw { law: &self.table, coefficients: [restitution, 0.0], angle: 0.0, duration: self.duration }
    }
}

/// The errors of restitution with so many time steps in an elastic contact, over the moments at which it begins and ends.
pub(crate) fn errors(normal: &Normal, restitution: f64, scheme: &Scheme, steps: f64) -> Result<Vec<f64>, ChartError> {
    let mut errors = Vec::new();
    for end in ENDS {
        let rebounds = normal.throw(restitution).steps(steps + end, scheme.run)?;
        errors.extend(rebounds.iter().map(|[velocity, _]| velocity[2] / SPEED - restitution));
    }
    Ok(errors)
}

/// The largest of them.
pub(crate) fn error(normal: &Normal, restitution: f64, scheme: &Scheme, steps: f64) -> Result<f64, ChartError> {
    Ok(errors(normal, restitution, scheme, steps)?.into_iter().map(f64::abs).fold(0.0, f64::max))
}

/// Adds a row for each number of steps.
fn fill(table: &mut Table, normal: &Normal, restitution: f64, scheme: &Scheme) -> Result<(), ChartError> {
    let (case, series) = (scheme.named(normal.name), format!("e = {restitution}"));
    for steps in STEPS {
        let error = error(normal, restitution, scheme, steps)?;
        table.push([case.clone().into(), series.clone().into(), restitution.into(), steps.into(), error.into()]);
    }
    Ok(())
}

/// Adds a row for the step that the program chooses.
fn fill_default(table: &mut Table, normal: &Normal, restitution: f64, scheme: &Scheme) -> Result<(), ChartError> {
    let (_, steps) = normal.throw(restitution).automatic(scheme.run)?;
    let error = error(normal, restitution, scheme, steps)?;
    table.push([scheme.named(normal.name).into(), DEFAULT.into(), restitution.into(), steps.into(), error.into()]);
    Ok(())
}

/// The largest error of restitution of a peer with so many steps in an elastic contact; none where it is not installed.
pub(crate) fn peer_error(peer: &Peer, model: &str, restitution: f64, steps: f64) -> Result<Option<f64>, ChartError> {
    let mut error = 0.0_f64;
    for end in ENDS {
        let Some(found) = peer.impact(model, restitution, steps + end)? else { return Ok(None) };
        error = error.max(found);
    }
    Ok(Some(error))
}

/// Adds the points of a peer. Returns whether it is installed.
fn fill_peer(table: &mut Table, normal: &Normal, peer: &Peer) -> Result<bool, ChartError> {
    // Peers step as this scheme does.
    let (law, series) = (ENGINE.named(normal.name), format!("{}{ALL}", peer.name));
    for restitution in RESTITUTIONS {
        for steps in PEER_STEPS {
            let Some(error) = peer_error(peer, normal.name, restitution, steps)? else { return Ok(false) };
            table.push([law.clone().into(), series.clone().into(), restitution.into(), steps.into(), error.into()]);
        }
    }
    Ok(true)
}

/// The normal models.
pub(crate) fn models() -> [Normal; 2] {
    let hooke = format!("[contact.touch.normal.hooke]\ncharacteristic_velocity = {SPEED:?}");
    [
        Normal { name: "hertz", table: "[contact.touch.normal.hertz]".into(), duration: hertz_duration(SPEED) },
        Normal { name: "hooke", table: hooke, duration: hooke_duration() },
    ]
}

/// Schemes of which the picture has diagrams: the curves of `midway` lie on those of `engine`, those of `predicted` on those of
/// `predicted_normal`; the table has them.
const DRAWN: [Scheme; 2] = [ENGINE, PREDICTED_NORMAL];

/// Computes the chart.
fn draw() -> Result<Drawing, ChartError> {
    let models = models();
    let mut table = Table::new([
        ("law", ""),
        ("series", ""),
        ("restitution", "1"),
        ("time steps in an elastic contact", "1"),
        ("largest error of restitution", "1"),
    ]);
    let mut absent = Vec::new();
    for normal in &models {
        for scheme in SCHEMES {
            for restitution in RESTITUTIONS {
                fill(&mut table, normal, restitution, scheme)?;
            }
            for restitution in RESTITUTIONS {
                fill_default(&mut table, normal, restitution, scheme)?;
            }
        }
        for peer in &PEERS {
            if !absent.contains(&peer.name) && !fill_peer(&mut table, normal, peer)? {
                absent.push(peer.name);
            }
        }
    }
    let panel = |law: String| {
        let title = format!("{law}, without limit_force");
        let axes = [logarithmic("time steps in an elastic contact"), logarithmic("largest error of restitution")];
        Panel {
            only: Some(("law", law)),
            single: vec![DEFAULT, "LIGGGHTS, all e", "LAMMPS, all e"],
            ..Panel::new(&title, axes[0], axes[1], "series")
        }
    };
    let mut notes = notes(&table);
    notes.extend(absent.into_iter().map(|name| format!("{name} is not installed: its points are left out")));
    let laws = models.iter().flat_map(|normal| DRAWN.map(|scheme| scheme.named(normal.name)));
    let panels = laws.map(panel).collect();
    Ok(Drawing { table, picture: Picture { panels, columns: DRAWN.len(), ..Picture::default() }, notes })
}

/// What the default step costs in accuracy.
fn notes(table: &Table) -> Vec<String> {
    let defaults =
        (0..table.rows.len()).filter(|row| table.rows[*row][table.place("series")].to_string().starts_with(DEFAULT));
    let told = |row: usize| {
        let number = |column| table.number(row, column).unwrap_or(f64::NAN);
        let (law, series) = (&table.rows[row][0], &table.rows[row][1]);
        let steps = number("time steps in an elastic contact");
        let error = number("largest error of restitution");
        format!("{law}, {series}: e = {}, {steps:.1} steps, error {error:.1e}", number("restitution"))
    };
    defaults.map(told).collect()
}
