//! What contacts leave behind: wear and losses on the facets of boundaries, and impacts from touch to parting.
//!
//! Passes follow single contacts (`engine/contacts/followed.rs`, `surfaces/traces.rs`) and hand over here what they found, piece by piece in
//! the order of their lists: sums have the same bits for any number of threads. What an open impact has lost stands in the history of its
//! contact, so it goes with the contact wherever that goes.

use crate::engine::state::{Impact, ImpactBin, ImpactRecord, Named, State, Traces};
use crate::scene::{Boundary, Scene};

/// Traces at time 0; none where the scene asks for none.
pub(crate) fn begun(scene: &Scene) -> Option<Traces> {
    scene.has_traces().then(|| Traces::of(scene.boundaries.iter().map(facets)))
}

/// How many facets of a boundary have traces: a group of particles and a plane are one.
fn facets(boundary: &Boundary) -> usize {
    match boundary.shape.plane() {
        Some(_) => 1,
        None => boundary.shape.facets(&[]).map_or(1, |facets| facets.len()),
    }
}

/// What is left on a facet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    /// The boundary.
    pub(crate) boundary: u32,
    /// The facet.
    pub(crate) facet: u32,
    /// Volume worn off \[m³\].
    pub(crate) wear: f64,
    /// Energy lost along the normal and across it \[J\].
    pub(crate) lost: [f64; 2],
}

/// An impact that ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ended {
    /// The particle (slot).
    pub(crate) first: u32,
    /// The other one (slot); none at a surface.
    pub(crate) second: Option<u32>,
    /// Who met: see [`ImpactBin::between`].
    pub(crate) between: u32,
    /// What happened.
    pub(crate) record: ImpactRecord,
}

/// What a piece of a list leaves behind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Left {
    /// On facets.
    pub(crate) shares: Vec<Share>,
    /// Impacts that ended.
    pub(crate) ended: Vec<Ended>,
}

impl Left {
    /// Forgets all; the room stays.
    pub(crate) fn clear(&mut self) {
        self.shares.clear();
        self.ended.clear();
    }

    /// Adds it to the traces of a state.
    pub(crate) fn book(&self, scene: &TracedScene, state: &mut State) {
        let State { traces: Some(traces), particles, clock, .. } = state else { return };
        for share in &self.shares {
            let (facets, facet) = (&mut traces.boundaries[share.boundary as usize], share.facet as usize);
            facets.wear[facet] += share.wear;
            facets.normal[facet] += share.lost[0];
            facets.tangential[facet] += share.lost[1];
        }
        let Some(output) = scene.impacts else { return };
        for ended in &self.ended {
            let name = |slot: u32| Named::at(particles, slot);
            let (particle, partner) = (name(ended.first), ended.second.map(name));
            let (between, record) = (ended.between, ended.record);
            let impact = Impact { time: clock.time, particle, partner, between, record };
            let energy = record.lost[0] + record.lost[1];
            traces.count(&impact, if energy > 0.0 { output.histogram.of(energy) } else { ImpactBin::NOTHING });
            if output.events {
                traces.impacts.push(impact);
            }
        }
    }
}

/// What of a scene says who meets and what is told of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TracedScene {
    /// How many boundaries there are.
    pub(crate) boundaries: u32,
    /// How many materials.
    materials: u32,
    /// Whether groups of particles are among the boundaries.
    pub(crate) groups: bool,
    /// How impacts are told, if they are.
    pub(crate) impacts: Option<crate::scene::Impacts>,
}

impl TracedScene {
    /// Of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        Self {
            boundaries: scene.boundaries.len() as u32,
            materials: scene.materials.len() as u32,
            groups: scene.boundaries.iter().any(|boundary| !boundary.shape.members().is_empty()),
            impacts: scene.output.impacts,
        }
    }

    /// The number of particles of two materials that meet.
    pub(crate) fn between(&self, one: u32, other: u32) -> u32 {
        self.boundaries + one.min(other) * self.materials + one.max(other)
    }
}

/// Who met, as the scene's own tables name them: `boundary.floor`, `pair.glass.steel`.
pub(crate) fn name(scene: &Scene, between: u32) -> String {
    let (boundaries, materials) = (scene.boundaries.len(), scene.materials.len());
    if let Some(boundary) = scene.boundaries.get(between as usize) {
        return format!("boundary.{}", boundary.name);
    }
    let pair = (between as usize).saturating_sub(boundaries);
    let name = |material: usize| scene.materials.get(material).map_or("", |material| &material.name);
    format!("pair.{}.{}", name(pair / materials.max(1)), name(pair % materials.max(1)))
}

impl ImpactRecord {
    /// Goes on for a time step of this length \[s\]. Before the first one (0) what touches has begun already. Returns whether the bodies
    /// touch first in it.
    pub(crate) fn go_on(&mut self, step: f64, force: f64, speed: [f64; 2], lost: [f64; 2]) -> bool {
        let touches_first = !self.begun && step > 0.0;
        self.begun = true;
        self.largest_force = self.largest_force.max(force);
        if step > 0.0 {
            self.duration += step;
            (0..2).for_each(|part| self.lost[part] += lost[part]);
        }
        if touches_first {
            self.speed = speed;
        }
        touches_first
    }
}
