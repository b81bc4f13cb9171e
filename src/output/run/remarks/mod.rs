//! What is legal in a scene but risky: said once, by `check`, in `summary.json` and by the unit's logger.

mod contacts;
mod course;
#[cfg(test)]
mod fixture;
mod output;
mod servos;
mod surroundings;
mod time;
mod unread;
mod unusual;

pub use course::course;
pub(super) use servos::missed;

use crate::engine::simulation::Simulation;
use crate::laws::contact::Properties;
use crate::scene::Scene;

/// The remarks on a scene in its present state.
pub fn remarks(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut remarks = Vec::new();
    remarks.extend(time::time_step(scene, simulation));
    remarks.extend(output::intervals(scene));
    remarks.extend(unusual::moduli(scene));
    remarks.extend(unusual::unusual(scene));
    remarks.extend(unread::unread(scene));
    remarks.extend(scene.unread.iter().cloned());
    remarks.extend(unread::idle(scene));
    remarks.extend(output::columns(scene));
    remarks.extend(surroundings::passed_through(scene));
    remarks.extend(surroundings::cracks(scene));
    remarks.extend(surroundings::cells(scene));
    remarks.extend(surroundings::dry(simulation));
    remarks.extend(contacts::cohesion(scene));
    remarks.extend(contacts::friction(scene));
    remarks.extend(surroundings::falling(scene));
    remarks.extend(course(simulation));
    remarks
}

/// The tables of pairs of materials, by name, each once.
fn pairs(scene: &Scene) -> impl Iterator<Item = (String, &Properties)> {
    let count = scene.materials.len();
    let name = |index: usize| &scene.materials[index].name;
    let entries = (0..count).flat_map(move |a| (a..count).map(move |b| (a, b)));
    entries.map(move |(a, b)| (format!("pair.{}.{}", name(a), name(b)), &scene.pairs[a * count + b]))
}
