//! How particles moved in the present time step, as boundaries see it: whether one came through.
//!
//! A particle at rest beside a surface is turned back by the contact as long as its centre stays on its side. Where it did not,
//! the straight way of the centre in the axes of the surface leads through it. In one time step a particle goes at most half of
//! its radius, so what came through a slow surface is deep in it now, and only what is deep is looked at. Where a surface or a
//! group goes far in one time step, all particles are.

use crate::base::geometry::Frame;
use crate::base::number::Vector;
use crate::engine::state::nodes::farthest;
use crate::engine::state::{BoundaryState, Nodes, Row, State};
use crate::laws::motion::InputCourse;
use crate::laws::surface::{Deforming, Features, SLOW, is_skipped};
use crate::scene::{GoverningLaws, Scene};
use std::f64::consts::PI;

/// What is known of the boundaries of a scene, for those who look for particles that came through.
pub(crate) struct Passing {
    /// Points of reference \[m\].
    references: Vec<Vector>,
    /// How far the particles of each are from its point, to their centres; nothing where it has none \[m\].
    groups: Vec<Option<f64>>,
    /// Whether each jumps to where its inputs say, which puts a group there without a way.
    jumps: Vec<bool>,
    /// Radius of the smallest particle \[m\].
    smallest: f64,
    /// Whether particles are brought back into a periodic cell.
    in_cell: bool,
    /// Which materials touch each other.
    laws: GoverningLaws,
}

/// Particles as they are looked at.
#[derive(Clone, Copy)]
pub(crate) struct MovedParticles<'a> {
    /// Positions and radii, after the drift of the present time step.
    pub(crate) position: &'a [Row],
    /// Velocities in it, and masses.
    pub(crate) velocity: &'a [Row],
    /// What moves each particle ([`crate::engine::state::Particles::owner`]).
    pub(crate) owner: &'a [u32],
    /// The time step \[s\].
    pub(crate) step: f64,
}

impl<'a> MovedParticles<'a> {
    /// Those of a state.
    pub(crate) fn of(state: &'a State, step: f64) -> Self {
        let particles = &state.particles;
        Self { position: &particles.position, velocity: &particles.velocity, owner: &particles.owner, step }
    }
}

impl Passing {
    /// That of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        let extent = |boundary: &crate::scene::Boundary| {
            let centres = boundary.shape.members().iter().map(|member| scene.particles[*member as usize].position);
            let apart = centres.map(|centre| (Vector::from(centre) - boundary.reference.into()).length());
            apart.reduce(f64::max)
        };
        Self {
            references: scene.boundaries.iter().map(|boundary| boundary.reference.into()).collect(),
            groups: scene.boundaries.iter().map(extent).collect(),
            jumps: scene.boundaries.iter().map(|boundary| boundary.input == InputCourse::Hold).collect(),
            smallest: scene.radii().fold(f64::INFINITY, f64::min),
            in_cell: scene.cell.is_some(),
            laws: scene.governing_laws(),
        }
    }

    /// Whether a contact law governs two materials.
    pub(crate) fn meet(&self, one: u32, other: u32) -> bool {
        self.laws.between(one, other).is_some()
    }

    /// Where a boundary stood before the present time step, and where it stands.
    pub(crate) fn frames(&self, boundary: usize, moved: &BoundaryState) -> [Frame; 2] {
        [moved.before, moved.stand()]
            .map(|stand| Frame::of(self.references[boundary], moved.shift_at(&stand).into(), stand.orientation.0))
    }

    /// Where the centre of a particle (slot) was before the present time step, to rounding \[m\].
    fn origin(&self, boundaries: &[BoundaryState], particles: MovedParticles, slot: usize) -> Vector {
        let centre = Vector::from(particles.position[slot]);
        match particles.owner[slot] {
            // A sphere of another body, or of a group in a cell, was there to the second order of the step.
            owner if owner == 0 || owner as usize > boundaries.len() || self.in_cell => {
                centre - Vector::from(particles.velocity[slot]) * particles.step
            }
            owner => {
                let group = owner as usize - 1;
                let [before, now] = self.frames(group, &boundaries[group]);
                before.place(now.inside(centre))
            }
        }
    }

    /// The way of a particle (slot) in the present time step, in the axes of a boundary \[m\].
    pub(crate) fn way(
        &self,
        (boundary, boundaries): (usize, &[BoundaryState]),
        particles: MovedParticles,
        slot: usize,
    ) -> [Vector; 2] {
        let [before, now] = self.frames(boundary, &boundaries[boundary]);
        [before.inside(self.origin(boundaries, particles, slot)), now.inside(particles.position[slot].into())]
    }

    /// Whether surfaces and groups went so far in the present time step that what came through may not be near any more.
    pub(crate) fn went_far(&self, state: &State) -> bool {
        let [surfaces, groups] = self.ways(state);
        surfaces + groups > SLOW * self.smallest
    }

    /// Whether a group went far in the present time step.
    fn group_went_far(&self, state: &State) -> bool {
        self.ways(state)[1] > SLOW * self.smallest
    }

    /// Upper bounds of how far a surface went in the present time step, and a particle of a group \[m\].
    fn ways(&self, state: &State) -> [f64; 2] {
        let extents = state.neighbours.boundary_extent.iter().copied().chain(std::iter::repeat(0.0));
        let mut most = [0.0_f64; 2];
        for ((moved, group), extent) in state.boundaries.iter().zip(&self.groups).zip(extents) {
            let shift = Vector::from(moved.displacement) - moved.before.displacement.into();
            let (from, to) = (moved.before.orientation.0, moved.orientation.0);
            // Two unit quaternions are as far apart as twice the sine of a quarter of the angle between them.
            let turn = (0..4).map(|part| (to[part] - from[part]).powi(2)).sum::<f64>().sqrt() * PI;
            let way = shift.length() + turn * group.unwrap_or(extent);
            let most = &mut most[usize::from(group.is_some())];
            *most = most.max(way);
        }
        let bent = state.nodes.iter().map(|nodes| farthest(&nodes.displacement, &nodes.before));
        most[0] += bent.fold(0.0, f64::max);
        most
    }

    /// A particle (slot) that a group of particles went through in the present time step, and the group.
    pub(crate) fn through_groups(&self, state: &State, step: f64) -> Option<(u32, usize)> {
        if !self.group_went_far(state) {
            return None;
        }
        let particles = MovedParticles::of(state, step);
        let groups = (0..self.groups.len()).filter(|group| self.groups[*group].is_some() && !self.jumps[*group]);
        groups.into_iter().find_map(|group| Some((self.through_group(group, state, particles)?, group)))
    }

    /// The first particle (slot) that a group went through.
    fn through_group(&self, group: usize, state: &State, particles: MovedParticles) -> Option<u32> {
        let [_, now] = self.frames(group, &state.boundaries[group]);
        let (own, material) = (group as u32 + 1, &state.particles.material);
        let count = particles.position.len();
        let owner = |slot: usize| particles.owner[state.particles.original(slot as u32) as usize];
        let members: Vec<(Vector, f64, u32)> = (0..count)
            .filter(|&slot| owner(slot) == own)
            .map(|slot| (now.inside(particles.position[slot].into()), particles.position[slot][3], material[slot]))
            .collect();
        let around = |largest: bool| {
            members.iter().fold(
                [if largest { f64::NEG_INFINITY } else { f64::INFINITY }; 3],
                |most, (centre, radius, _)| {
                    let centre = centre.to_array();
                    [0, 1, 2].map(|axis| {
                        if largest {
                            most[axis].max(centre[axis] + radius)
                        } else {
                            most[axis].min(centre[axis] - radius)
                        }
                    })
                },
            )
        };
        let [low, high] = [false, true].map(around);
        let through = |slot: &usize| {
            let [from, to] = self.way((group, &state.boundaries), particles, *slot);
            let (radius, [a, b]) = (particles.position[*slot][3], [from, to].map(Vector::to_array));
            let beside =
                |axis: usize| a[axis].min(b[axis]) - radius > high[axis] || a[axis].max(b[axis]) + radius < low[axis];
            let mut near = members.iter().filter(|(_, _, other)| self.meet(material[*slot], *other));
            !(0..3).any(beside)
                && near.any(|(centre, other, _)| goes_over([from - *centre, to - *centre], radius + other))
        };
        (0..count).filter(|&slot| owner(slot) != own).find(through).map(|slot| slot as u32)
    }
}

/// Whether a centre on its straight way past a sphere about the origin comes nearer than `touch` in the middle of the way and goes
/// on: beside it, where it touches at neither end, or from one side to the other \[m\].
fn goes_over([from, to]: [Vector; 2], touch: f64) -> bool {
    let way = to - from;
    let (square, along) = (way.dot(way), -from.dot(way));
    if !(0.0 < along && along < square) {
        return false;
    }
    let nearest = from + way * (along / square);
    let ends = from.length() < touch || to.length() < touch;
    nearest.length() < touch && (!ends || from.dot(to) < 0.0)
}

/// The surface of a boundary, as particles touch it.
#[derive(Clone, Copy)]
pub(crate) enum Passed<'a> {
    /// As it is at time 0.
    Features(&'a dyn Features),
    /// As its nodes stand.
    Nodes(&'a Deforming, &'a Nodes),
}

impl Passed<'_> {
    /// Whether the way of a centre in the axes of the surface leads through it \[m\].
    pub(crate) fn is_through(&self, way: [Vector; 2]) -> bool {
        match self {
            Self::Features(features) => features.is_passed(way),
            Self::Nodes(mesh, nodes) => mesh.is_passed(way, &nodes.before),
        }
    }

    /// The same of a sphere with this radius \[m\] where the surface went far: it may have gone over the sphere beside its centre.
    pub(crate) fn is_over(&self, way: [Vector; 2], radius: f64) -> bool {
        let skipped = |features: &dyn Features| is_skipped(features, way, radius);
        self.is_through(way) || matches!(self, Self::Features(features) if skipped(*features))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_goes_over_another_where_it_touches_at_neither_end_or_comes_to_the_other_side() {
        let way = |from: [f64; 2], to: [f64; 2]| [from, to].map(|[x, y]| Vector::new(x, y, 0.0));
        assert!(goes_over(way([-3.0, 0.5], [3.0, 0.5]), 1.0));
        assert!(!goes_over(way([-3.0, 1.1], [3.0, 1.1]), 1.0), "beside it");
        assert!(!goes_over(way([-3.0, 0.5], [-0.5, 0.5]), 1.0), "it has met it and is turned back");
        assert!(goes_over(way([-0.9, 0.1], [0.9, 0.1]), 1.0), "from one side to the other");
        assert!(!goes_over(way([-0.3, 0.9], [0.3, 0.9]), 1.0), "it rolls over it");
        assert!(!goes_over(way([0.9, 0.1], [2.9, 0.1]), 1.0), "it leaves");
    }
}
