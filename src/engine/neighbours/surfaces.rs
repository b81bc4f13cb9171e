//! Particles near surfaces of features, and which parts of the surface are near each.

use super::order::Order;
use super::pairs::Laws;
use crate::base::geometry::Frame;
use crate::base::number::Vector;
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{IMAGE, NearParts, Particles, WallContacts};
use crate::laws::surface::{Features, NO_PLANE};

/// A surface of the scene that is touched feature by feature.
pub(crate) struct Near<'a> {
    /// Which boundary it is.
    pub boundary: u32,
    /// Its material.
    pub material: u32,
    /// Where its features are.
    pub features: &'a dyn Features,
    /// Where it stands.
    pub frame: Frame,
    /// How far beyond touch \[m\].
    pub skin: f64,
}

/// Makes the list of a surface and a law anew: what is near, and the contacts by the new slots of their particles.
pub(crate) fn replace(
    list: &mut WallContacts,
    near: &Near,
    (particles, laws): (&Particles, &Laws),
    (order, context): (&Order, &Context),
) {
    let pieces = context.collect(particles.len().div_ceil(CHUNK), |piece| {
        let mut found = NearParts::default();
        for slot in piece * CHUNK..((piece + 1) * CHUNK).min(particles.len()) {
            let foreign = ![near.boundary + 1, IMAGE].contains(&particles.owner[slot]);
            if !foreign || laws.between(particles.material[slot], near.material) != Some(list.law) {
                continue;
            }
            let (row, before) = (particles.position[slot], found.parts.len());
            let (centre, reach) = (near.frame.inside(Vector::from(row)), row[3] + near.skin);
            near.features.near(centre, reach, &mut found.parts);
            if found.parts.len() > before {
                found.particle.push(slot as u32);
                found.starts.push(before as u32);
                let plane = near.features.plane(centre, reach, &found.parts[before..]);
                found.plane.push(plane.unwrap_or(NO_PLANE));
            }
        }
        found
    });
    list.near = NearParts::default();
    for piece in pieces {
        let first = list.near.parts.len() as u32;
        list.near.particle.extend(piece.particle);
        list.near.starts.extend(piece.starts.into_iter().map(|start| first + start));
        list.near.parts.extend(piece.parts);
        list.near.plane.extend(piece.plane);
    }
    list.near.starts.push(list.near.parts.len() as u32);
    renumber(list, order);
}

/// Puts the contacts in the order of the new slots.
fn renumber(list: &mut WallContacts, order: &Order) {
    let slot = |entry: usize| order.new_slot[list.particle[entry] as usize];
    let mut entries: Vec<usize> = (0..list.particle.len()).collect();
    entries.sort_unstable_by_key(|&entry| (slot(entry), list.feature[entry]));
    list.particle = entries.iter().map(|&entry| slot(entry)).collect();
    list.feature = entries.iter().map(|&entry| list.feature[entry]).collect();
    list.flags = entries.iter().map(|&entry| list.flags[entry]).collect();
    list.history = list.history.chosen(&entries);
}

/// The largest distance of a particle from a point \[m\].
pub(crate) fn farthest_from(particles: &Particles, point: Vector) -> f64 {
    particles.position.iter().map(|row| (Vector::from(*row) - point).length() + row[3]).fold(0.0, f64::max)
}
