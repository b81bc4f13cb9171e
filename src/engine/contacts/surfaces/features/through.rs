//! Near pairs of particles with a surface between them: what touches through it is told.

use super::parts;
use super::standing::MovingSurface;
use crate::base::number::Vector;
use crate::engine::contacts::surfaces::{AtSurface, SurfacePass, Touched};
use crate::engine::state::{Separated, State};
use crate::laws::surface::{Feet, Foot};

/// Distance of a point from a surface, over the smaller radius, at which it counts as on it.
const ON: f64 = 1e-3;

/// Points that are tried on the way between two centres. On a flat surface the second is on it.
const POINTS: usize = 8;

impl SurfacePass {
    /// Finds the near pairs that a surface is between, unless two have touched through one.
    pub(in crate::engine::contacts::surfaces) fn find_separated(&self, state: &mut State) {
        state.through.pairs.clear();
        if state.through.first.is_some() || self.surfaces.iter().all(|surface| surface.is_plane()) {
            return;
        }
        let mut is_near = vec![false; state.particles.len()];
        for surface in self.surfaces.iter().filter(|surface| !surface.is_plane()) {
            surface.list(state).near.particle.iter().for_each(|&slot| is_near[slot as usize] = true);
        }
        let mut pairs = Vec::new();
        for (index, list) in state.contacts.iter().enumerate() {
            let both = |&entry: &usize| is_near[list.first[entry] as usize] && is_near[list.second[entry] as usize];
            for entry in (0..list.flags.len()).filter(both) {
                let slots = [list.first[entry], list.second[entry]];
                let between = self.surfaces.iter().find(|surface| surface.is_between(state, slots));
                pairs.extend(between.map(|surface| Separated {
                    list: index as u32,
                    entry: entry as u32,
                    boundary: surface.list(state).boundary,
                }));
            }
        }
        state.through.pairs = pairs;
    }
}

impl AtSurface {
    /// Whether it is a plane that does not turn: nothing can be behind it.
    fn is_plane(&self) -> bool {
        matches!(self.touched, Touched::Plane(_))
    }

    /// Whether it is between two particles (slots) that are near it.
    fn is_between(&self, state: &State, slots: [u32; 2]) -> bool {
        let list = self.list(state);
        let [Ok(place), Ok(_)] = slots.map(|slot| list.near.particle.binary_search(&slot)) else { return false };
        let boundary = list.boundary as usize;
        let standing = (&state.boundaries[boundary], state.nodes_of(boundary));
        let parts = parts(list, place);
        MovingSurface::with(self, standing, |at| {
            let rows = slots.map(|slot| state.particles.position[slot as usize]);
            let centres = rows.map(|row| at.frame.inside(Vector::from(row)));
            crosses(centres, rows[0][3].min(rows[1][3]), |point, reach, feet| {
                at.features.feet(point, reach, parts, feet);
            })
        })
        .unwrap_or(false)
    }
}

/// Whether the way from one centre to another leads through a surface, of whose feet \[m\] one is asked at a point within a reach. Each
/// point that is tried is where the plane of the foot of the one before crosses the way.
fn crosses([a, b]: [Vector; 2], radius: f64, find: impl Fn(Vector, f64, &mut Feet)) -> bool {
    let (mut feet, mut point, reach) = (Feet::default(), a, (b - a).length() + radius);
    for _ in 0..POINTS {
        feet.clear();
        find(point, reach, &mut feet);
        let nearest = feet.list.iter().filter(|foot| foot.weight > 0.0);
        let nearest = nearest.reduce(|near, next| if next.distance < near.distance { next } else { near });
        let Some(&Foot { distance, normal, .. }) = nearest else { return false };
        if distance <= ON * radius {
            return true;
        }
        let foot = point - normal * distance;
        // The end that is on the other side of the foot's plane than the point, if one is.
        let Some(end) = [b, a].into_iter().find(|end| (*end - foot).dot(normal) < 0.0) else { return false };
        let behind = -(end - foot).dot(normal);
        point = point + (end - point) * (distance / (distance + behind));
    }
    false
}
