//! Impacts in files: one by one, and counted by the energy that they lost.

use super::error::OutputError;
use super::files::{Durability, write_whole};
use super::table::Table;
use crate::engine::state::{Impact, ImpactBin, Named, Traces};
use crate::engine::traces::name;
use crate::scene::Scene;
use std::path::Path;

/// Columns of the file of impacts.
pub(super) const COLUMNS: [&str; 10] = [
    "time",
    "id1",
    "id2",
    "between",
    "normal_loss",
    "tangential_loss",
    "largest_force",
    "normal_speed",
    "tangential_speed",
    "duration",
];

/// First line of the file of their counts.
pub(super) const HISTOGRAM_HEAD: &str =
    "between,energy_from,energy_to,count,normal_loss,tangential_loss,largest_force\n";

/// Adds a row for each impact.
pub(super) fn add(table: &mut Table, scene: &Scene, impacts: &[Impact]) -> Result<(), OutputError> {
    let number = |named: Named| {
        let own = scene.particles.get(named.index as usize).map(|particle| particle.id.0);
        named.number.or(own).unwrap_or(named.index).to_string()
    };
    let boundary = |between: u32| scene.boundaries.get(between as usize).map_or("", |boundary| &boundary.name);
    for Impact { time, particle, partner, between, record } in impacts {
        let [normal, tangential] = record.lost;
        let [closing, sliding] = record.speed;
        let numbers = [normal, tangential, record.largest_force, closing, sliding, record.duration];
        let other = partner.map_or_else(|| boundary(*between).to_owned(), number);
        let mut row = vec![format!("{time:?}"), number(*particle), other, name(scene, *between)];
        row.extend(numbers.map(|number| format!("{number:?}")));
        table.add(&row)?;
    }
    Ok(())
}

/// Writes the counts: a row for each pair of bodies and bin of energies in which there are any.
pub(crate) fn write_histograms(path: &Path, scene: &Scene, traces: &Traces) -> Result<(), OutputError> {
    let Some(output) = scene.output.impacts else { return Ok(()) };
    let mut text = HISTOGRAM_HEAD.to_owned();
    for ImpactBin { between, bin, count, lost: [normal, tangential], largest_force } in &traces.bins {
        let ends = if *bin == ImpactBin::NOTHING { [0.0; 2] } else { output.histogram.ends(*bin) };
        let (between, [from, to]) = (name(scene, *between), ends);
        text += &format!("{between},{from:?},{to:?},{count},{normal:?},{tangential:?},{largest_force:?}\n");
    }
    write_whole(path, text.as_bytes(), Durability::Process)
}
