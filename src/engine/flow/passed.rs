//! Particles that came through a boundary which lets them be taken away.

use crate::base::number::Vector;
use crate::engine::boundaries::passing::{MovedParticles, Passed, Passing};
use crate::engine::neighbours::sorted;
use crate::engine::state::{IMAGE, State};
use crate::laws::surface::Deforming;
use crate::scene::{Outside, Scene};

/// A particle that came through a boundary in the present time step.
#[derive(Clone, Copy, Debug)]
pub(super) struct PassedParticle {
    /// Which one (slot).
    pub(super) slot: usize,
    /// The boundary.
    pub(super) boundary: usize,
    /// Where it was before that: in the middle of the time step, to which its velocity belongs, or at its beginning \[m\].
    pub(super) before: Vector,
}

/// All of them, after the drift of a time step of this length \[s\].
pub(super) fn find(scene: &Scene, state: &State, passing: &Passing, step: f64) -> Vec<PassedParticle> {
    let (moved, far) = (MovedParticles::of(state, step), passing.went_far(state));
    let mut found = Vec::new();
    for (index, boundary) in scene.boundaries.iter().enumerate().filter(|(_, it)| it.outside == Outside::Remove) {
        let nodes = state.nodes_of(index);
        let deformed = nodes.and_then(|nodes| Some(sorted(boundary.shape.deforming()?, nodes)));
        let Some(surface) = surface(boundary, deformed.as_ref(), nodes) else { continue };
        // A plane takes all that are behind it, as it would otherwise stop for them.
        let plane = boundary.shifting_plane();
        let [_, now] = passing.frames(index, &state.boundaries[index]);
        let mut look = |slot: usize| {
            let way = passing.way((index, &state.boundaries), moved, slot);
            let through = match &plane {
                Some(plane) => plane.height(way[1].to_array()) < 0.0,
                None if far => surface.is_over(way, moved.position[slot][3]),
                None => surface.is_through(way),
            };
            if through {
                let middle = (way[0] + way[1]) * 0.5;
                let before = if surface.is_through([way[0], middle]) { way[0] } else { middle };
                found.push(PassedParticle { slot, boundary: index, before: now.place(before) });
            }
        };
        let lists = state.walls.iter().filter(|list| list.boundary as usize == index);
        if !far {
            let near = lists.flat_map(|list| if plane.is_some() { &list.particle } else { &list.near.particle });
            near.for_each(|slot| look(*slot as usize));
            continue;
        }
        let material = boundary.shape.material().map_or(0, |material| material.0);
        let touches = |slot: &usize| {
            ![index as u32 + 1, IMAGE].contains(&moved.owner[*slot])
                && passing.meet(state.particles.material[*slot], material)
        };
        (0..moved.position.len()).filter(touches).for_each(&mut look);
    }
    found
}

/// The surface of a boundary, whose nodes may stand elsewhere than at time 0.
fn surface<'a>(
    boundary: &'a crate::scene::Boundary,
    deformed: Option<&'a Deforming>,
    nodes: Option<&'a crate::engine::state::Nodes>,
) -> Option<Passed<'a>> {
    match (deformed, nodes) {
        (Some(mesh), Some(nodes)) => Some(Passed::Nodes(mesh, nodes)),
        _ => boundary.shape.features().map(Passed::Features),
    }
}
