//! The network of springs and dashpots: contacts and bonds between the bodies that forces move.

use crate::base::number::{Vector, binade};
use crate::engine::boundaries::RigidBody;
use crate::engine::contacts::{Link, Pass, SearchLimits};
use crate::engine::integration::Fields;
use crate::engine::state::State;
use nalgebra::Matrix6;
use std::sync::Arc;

/// Instead of a slot: what does not move by the forces on it.
pub(super) const UNMOVED: u32 = u32::MAX;

/// A contact or bond between two bodies that forces move, or of one with something else; its springs and dashpots stand in
/// [`Parts`]. Single precision: the network of a million particles is to fit beside them; the bound allows for the rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    /// Particles (slots) at which it acts; the second may be [`UNMOVED`].
    pub slots: [u32; 2],
    /// Unit normal.
    pub normal: [f32; 3],
    /// From each centre to where the forces act, along the normal \[m\].
    pub arms: [f32; 2],
}

impl Element {
    /// The same between the body at this end and something that stands still.
    fn end(&self, end: usize) -> Self {
        Self { slots: [self.slots[end], UNMOVED], arms: [self.arms[end], 0.0], ..*self }
    }
}

/// Two parts of all elements, in a unit that is a power of two: single precision then holds springs and dashpots of bodies of any size.
#[derive(Debug, Default)]
struct Column {
    /// What they are counted in.
    unit: f64,
    /// The parts; empty while no element has any.
    rows: Vec<[f32; 2]>,
}

/// A number in single precision, whatever its size.
#[inline(always)]
pub(super) fn single(number: f64) -> f64 {
    let unit = binade(number);
    f64::from((number / unit) as f32) * unit
}

impl Column {
    /// Adds those of the next element: there are `before` others, and in all at most `most`.
    fn push(&mut self, parts: [f64; 2], before: usize, most: usize) {
        if self.rows.is_empty() {
            if parts == [0.0; 2] {
                return;
            }
            self.unit = binade(parts[0].max(parts[1]));
            self.rows.reserve(most);
            self.rows.resize(before, [0.0; 2]);
        }
        self.rows.push(parts.map(|part| (part / self.unit) as f32));
    }

    /// Those of an element.
    #[inline(always)]
    fn of(&self, place: usize) -> [f64; 2] {
        self.rows.get(place).map_or([0.0; 2], |row| row.map(|part| f64::from(part) * self.unit))
    }
}

/// Springs, or dashpots, of all elements.
#[derive(Debug, Default)]
pub(super) struct Parts {
    /// Along the normal and across it \[N/m or kg/s\].
    shifting: Column,
    /// Against twisting and against bending \[N m or N m s\].
    turning: Column,
}

impl Parts {
    /// Adds those of the next element: there are `before` others, and in all at most `most`.
    fn push(&mut self, [along, across, twisting, bending]: [f64; 4], before: usize, most: usize) {
        self.shifting.push([along, across], before, most);
        self.turning.push([twisting, bending], before, most);
    }

    /// Whether anything resists twisting or bending.
    pub(super) fn resists_turning(&self) -> bool {
        !self.turning.rows.is_empty()
    }

    /// Whether there are any.
    pub(super) fn any(&self) -> bool {
        !self.shifting.rows.is_empty() || self.resists_turning()
    }

    /// Those of an element: along the normal, across it, against twisting, against bending.
    #[inline(always)]
    pub(super) fn of(&self, place: usize) -> [f64; 4] {
        let ([along, across], [twisting, bending]) = (self.shifting.of(place), self.turning.of(place));
        [along, across, twisting, bending]
    }
}

/// A group that forces move.
pub(super) struct Group {
    /// Where its reference point stands \[m\].
    pub pivot: Vector,
    /// L of the acceleration L Lᵀ that unit loads give it: what scales its freedoms.
    pub root: Matrix6<f64>,
}

/// What is to be stable.
pub(crate) struct Network<'a> {
    /// Where everything stands.
    pub(super) state: &'a State,
    /// Of each particle (slot): what scales its translations \[1/√kg\] and its rotations \[1/√(kg m²)\].
    pub(super) roots: Arc<[[f64; 2]]>,
    /// Of each boundary.
    pub(super) groups: Arc<[Option<Group>]>,
    /// Boundaries whose contacts count twice for their particles: surfaces that forces move, to whose inertia the other half is
    /// added ([`crate::engine::boundaries::implicit`]).
    light: Vec<bool>,
    /// The interactions, in the order of the passes.
    pub(super) elements: Vec<Element>,
    /// Their springs.
    pub(super) stiffness: Parts,
    /// Their dashpots.
    pub(super) damping: Parts,
}

impl<'a> Network<'a> {
    /// The bodies without interactions.
    pub(super) fn of_bodies(state: &'a State, bodies: &[Option<RigidBody>], fields: &Fields) -> Self {
        let particles = &state.particles;
        let root = |slot: usize| {
            let [linear, angular] = fields.amplification(particles.id[slot]);
            let (mass, inertia) = (particles.velocity[slot][3], particles.angular_velocity[slot][3]);
            [(linear / mass).sqrt(), (angular / inertia).sqrt()]
        };
        let group = |(body, moved): (&Option<RigidBody>, _)| {
            let body = body.as_ref().filter(|body| body.is_free() && !body.is_implicit())?;
            let [linear, angular] = fields.amplification(body.members[0]);
            let factor = |row: usize| if row < 3 { linear } else { angular };
            let mobility = body.mobility(moved).map_with_location(|row, _, part| part * factor(row));
            Some(Group { pivot: moved.pivot.into(), root: root_of(&mobility) })
        };
        Self {
            state,
            roots: (0..particles.len()).map(root).collect(),
            groups: bodies.iter().zip(&state.boundaries).map(group).collect(),
            light: bodies.iter().map(|body| body.as_ref().is_some_and(RigidBody::is_implicit)).collect(),
            elements: Vec::new(),
            stiffness: Parts::default(),
            damping: Parts::default(),
        }
    }

    /// The bodies with what is at work between them or, looking ahead, may be.
    pub(crate) fn of(
        state: &'a State,
        bodies: &[Option<RigidBody>],
        fields: &Fields,
        passes: &[Box<dyn Pass>],
        ahead: &SearchLimits,
    ) -> Self {
        let mut network = Self::of_bodies(state, bodies, fields);
        // Memory that is asked for and not written to costs nothing; to grow would take half as much again.
        let most = most_links(state);
        network.elements.reserve(most);
        for pass in passes {
            pass.stiffness(state, ahead, &mut |link| network.add(&link, most));
        }
        network
    }

    /// That of the chosen bodies (places as [`Self::mover`] tells them), to which all others stand still. What they share with
    /// one of the others counts by the factor that `borne` tells of the element and its end.
    pub(super) fn part(&self, chosen: &[bool], borne: impl Fn(usize, usize) -> f64) -> Self {
        let mut part = Self {
            state: self.state,
            roots: Arc::clone(&self.roots),
            groups: Arc::clone(&self.groups),
            light: Vec::new(),
            elements: Vec::new(),
            stiffness: Parts::default(),
            damping: Parts::default(),
        };
        for (place, element) in self.elements.iter().enumerate() {
            let inside = element.slots.map(|slot| self.mover(slot).is_some_and(|mover| chosen[mover]));
            let (taken, factor) = match inside {
                [false, false] => continue,
                [true, true] => (*element, 1.0),
                [true, false] => (element.end(0), borne(place, 0)),
                [false, true] => (element.end(1), borne(place, 1)),
            };
            let most = part.elements.len() + 1;
            part.stiffness.push(self.stiffness.of(place).map(|it| factor * it), part.elements.len(), most);
            part.damping.push(self.damping.of(place).map(|it| factor * it), part.elements.len(), most);
            part.elements.push(taken);
        }
        part
    }

    /// Adds an interaction, unless nothing moves by it.
    fn add(&mut self, link: &Link, most: usize) {
        if let Some((element, [stiffness, damping])) = self.between(link) {
            self.stiffness.push(stiffness, self.elements.len(), most);
            self.damping.push(damping, self.elements.len(), most);
            self.elements.push(element);
        }
    }

    /// An interaction between what moves, with its springs and dashpots as they count; none if nothing moves by it.
    pub(super) fn between(&self, link: &Link) -> Option<(Element, [[f64; 4]; 2])> {
        let twice = link.boundary.is_some_and(|boundary| self.light[boundary as usize]);
        let share = |part: f64| if twice { 2.0 * part } else { part };
        Some((self.element(link)?, [link.stiffness.map(share), link.damping.map(share)]))
    }

    /// Whether any interaction has a dashpot.
    pub(super) fn is_damped(&self) -> bool {
        self.damping.any()
    }

    /// Spring and dashpot of an element at this root \[1/s\], part by part.
    #[inline(always)]
    pub(super) fn parts(&self, place: usize, root: f64) -> [f64; 4] {
        let (stiffness, damping) = (self.stiffness.of(place), self.damping.of(place));
        std::array::from_fn(|k| stiffness[k] + root * damping[k])
    }

    /// An interaction between what moves, if it moves anything.
    pub(super) fn element(&self, link: &Link) -> Option<Element> {
        let moved = |slot: &u32| self.mover(*slot).is_some();
        let (first, second) = (Some(link.first).filter(moved), link.second.filter(moved));
        let [x, y, z] = link.normal.to_array();
        let same = first.is_some_and(|first| second.is_some_and(|second| self.mover(first) == self.mover(second)));
        let (slots, [a, b]) = match (first, second) {
            (Some(_), Some(_)) if same => return None,
            (Some(first), second) => ([first, second.unwrap_or(UNMOVED)], [-link.arms[0], link.arms[1]]),
            (None, Some(second)) => ([second, UNMOVED], [link.arms[1], 0.0]),
            (None, None) => return None,
        };
        Some(Element { slots, normal: [x as f32, y as f32, z as f32], arms: [a as f32, b as f32] })
    }

    /// How many bodies there may be: particles, then boundaries.
    pub(super) fn movers(&self) -> usize {
        self.roots.len() + self.groups.len()
    }

    /// The body that moves a particle, if forces move it: the particle itself, or behind all particles its group.
    #[inline]
    pub(super) fn mover(&self, slot: u32) -> Option<usize> {
        match (*self.state.particles.owner.get(slot as usize)? as usize).checked_sub(1) {
            None => Some(slot as usize),
            Some(group) => self.groups[group].as_ref().map(|_| self.roots.len() + group),
        }
    }

    /// The group behind the place of a body, if it is one.
    fn group(&self, mover: usize) -> Option<&Group> {
        self.groups.get(mover.checked_sub(self.roots.len())?)?.as_ref()
    }

    /// The trace of what the body at one end of an element with these springs would feel of it alone; 0 where none moves.
    pub(super) fn trace(&self, element: &Element, end: usize, [along, across, twisting, bending]: [f64; 4]) -> f64 {
        let Some(mover) = self.mover(element.slots[end]) else { return 0.0 };
        let Some(group) = self.group(mover) else {
            let ([v, w], arm) = (self.roots[mover], f64::from(element.arms[end]));
            let turning = 2.0 * (arm * arm * across + bending) + twisting;
            return v * v * (along + 2.0 * across) + w * w * turning;
        };
        let arm = self.arm(element, end, group);
        (along + 2.0 * across) * group.root.fixed_rows::<3>(0).norm_squared()
            + ((along + across) * arm.dot(arm) + 2.0 * bending + twisting)
                * group.root.fixed_rows::<3>(3).norm_squared()
    }

    /// From what moves a particle to where an element acts on it \[m\].
    pub(super) fn arm(&self, element: &Element, end: usize, group: &Group) -> Vector {
        let [x, y, z] = element.normal.map(f64::from);
        let center = Vector::from(self.state.particles.position[element.slots[end] as usize]);
        center - group.pivot + Vector::new(x, y, z) * f64::from(element.arms[end])
    }
}

/// How many interactions there are at most, unless bonds are still to be made: near pairs, and two parts of each bond.
fn most_links(state: &State) -> usize {
    let pairs = state.contacts.iter().map(|list| list.first.len());
    let walls = state.walls.iter().map(|list| list.particle.len());
    let bonds = state.bonds.iter().map(|list| 2 * list.first.len());
    pairs.chain(walls).chain(bonds).sum()
}

/// L of the mobility L Lᵀ of a body (Cholesky); freedoms that do not move have zeros.
fn root_of(mobility: &Matrix6<f64>) -> Matrix6<f64> {
    // With ones in their place, freedoms that do not move have a root, too.
    let still = Matrix6::from_diagonal(&mobility.diagonal().map(|part| if part > 0.0 { 0.0 } else { 1.0 }));
    (mobility + still).cholesky().map_or(Matrix6::zeros(), |root| root.l() - still)
}
