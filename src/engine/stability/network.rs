//! The network of springs and dashpots: contacts and bonds between the bodies that forces move.

use crate::base::number::{Vector, binade};
use crate::base::threads::{CHUNK, Context};
use crate::engine::bodies::{self, RigidBody};
use crate::engine::contacts::{Link, Pass, SearchLimits};
use crate::engine::integration::Fields;
use crate::engine::state::{IMAGE, State};
use nalgebra::Matrix6;
use std::sync::Arc;

/// Instead of a slot: what does not move by the forces on it.
pub(super) const UNMOVED: u32 = u32::MAX;

/// Interactions that become elements at a time.
const ROUND: usize = 16 * CHUNK;

/// Added to a slot: a particle that counts as standing still, and tells where a surface is touched.
const HELD: u32 = 1 << 31;

/// A contact or bond between two bodies that forces move, or of one with something else; its springs and dashpots stand in
/// [`Parts`]. Single precision: the network of a million particles is to fit beside them; the bound allows for the rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    /// Particles (slots) at which it acts, or behind all particles a boundary by its index; the second may be [`UNMOVED`] or held.
    pub slots: [u32; 2],
    /// Unit normal.
    pub normal: [f32; 3],
    /// From each centre to where the forces act, along the normal \[m\].
    pub arms: [f32; 2],
}

impl Element {
    /// The same between the body at this end and something that stands still, of `count` particles.
    fn end(&self, end: usize, count: usize) -> Self {
        let [own, other] = [self.slots[end], self.slots[1 - end]];
        let held = own as usize >= count && other != UNMOVED;
        Self { slots: [own, if held { other | HELD } else { UNMOVED }], arms: [self.arms[end], 0.0], ..*self }
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

/// How many units a part may have: far from where single precision ends, at 2^128.
const MOST_UNITS: f64 = (1_u128 << 100) as f64;

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
        } else if parts[0].max(parts[1]) > MOST_UNITS * self.unit {
            self.count_in(binade(parts[0].max(parts[1])));
        }
        self.rows.push(parts.map(|part| (part / self.unit) as f32));
    }

    /// Counts them in a larger unit: what single precision no longer holds beside that vanishes.
    #[cold]
    fn count_in(&mut self, unit: f64) {
        let share = self.unit / unit;
        self.rows.iter_mut().flatten().for_each(|part| *part = (share * f64::from(*part)) as f32);
        self.unit = unit;
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

/// A body that forces move.
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
    /// Of each body of several parts, by its number.
    pub(super) groups: Arc<[Option<Group>]>,
    /// The interactions, in the order of the passes.
    pub(super) elements: Vec<Element>,
    /// The bodies at the ends of each, as [`Self::mover`] tells them; [`UNMOVED`] for what does not move.
    pub(super) bodies: Vec<[u32; 2]>,
    /// Their springs.
    pub(super) stiffness: Parts,
    /// Their dashpots.
    pub(super) damping: Parts,
}

impl<'a> Network<'a> {
    /// The bodies without interactions.
    pub(super) fn of_bodies(state: &'a State, rigid: &[Option<RigidBody>], fields: &Fields) -> Self {
        let particles = &state.particles;
        let root = |slot: usize| {
            let [linear, angular] = fields.amplification(particles.id[slot]);
            let (mass, inertia) = (particles.velocity[slot][3], particles.angular_velocity[slot][3]);
            [(linear / mass).sqrt(), (angular / inertia).sqrt()]
        };
        let mut groups: Vec<Option<Group>> = Vec::new();
        groups.resize_with(state.owners(), || None);
        for body in bodies::each(rigid, state) {
            let root = body.root(fields.amplification_of(body.members));
            groups[body.number] = Some(Group { pivot: body.point, root });
        }
        Self {
            state,
            roots: (0..particles.len()).map(root).collect(),
            groups: groups.into(),
            elements: Vec::new(),
            bodies: Vec::new(),
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
        context: &Context,
    ) -> Self {
        let mut network = Self::of_bodies(state, bodies, fields);
        // Memory that is asked for and not written to costs nothing; to grow would take half as much again.
        let most = most_links(state);
        network.elements.reserve(most);
        network.bodies.reserve(most);
        let mut links = Vec::with_capacity(ROUND.min(most));
        for pass in passes {
            pass.stiffness(state, ahead, context, &mut |link| {
                links.push(link);
                if links.len() == ROUND {
                    network.add(&links, most, context);
                    links.clear();
                }
            });
        }
        network.add(&links, most, context);
        network.add_supports(bodies);
        network
    }

    /// Adds the springs of bodies to the ground, axis by axis.
    fn add_supports(&mut self, bodies: &[Option<RigidBody>]) {
        for (element, stiffness) in self.supports(bodies) {
            self.push(element, self.bodies_of(&element), [stiffness, [0.0; 4]], self.elements.len() + 1);
        }
    }

    /// The springs of bodies to the ground. Their dashpots do not limit the time step
    /// ([`crate::engine::bodies::boundary`]).
    pub(super) fn supports(&self, bodies: &[Option<RigidBody>]) -> Vec<(Element, [f64; 4])> {
        let mut supports = Vec::new();
        for (index, body) in bodies.iter().enumerate() {
            let Some(body) = body.as_ref().filter(|body| body.is_free()) else { continue };
            for (axis, stiffness) in body.springs().into_iter().enumerate().filter(|(_, stiffness)| *stiffness > 0.0) {
                let normal = [0, 1, 2].map(|k| if k == axis % 3 { 1.0 } else { 0.0 });
                let element = Element { slots: [self.boundary_slot(index as u32), UNMOVED], normal, arms: [0.0; 2] };
                let parts = if axis < 3 { [stiffness, 0.0, 0.0, 0.0] } else { [0.0, 0.0, stiffness, 0.0] };
                supports.push((element, parts));
            }
        }
        supports
    }

    /// The boundary that an element holds to the ground, by its place.
    pub(super) fn supported(&self, place: usize) -> Option<u32> {
        self.elements.get(place)?.slots[0].checked_sub(self.roots.len() as u32)
    }

    /// What stands for a slot where a boundary acts itself, instead of one of its particles.
    fn boundary_slot(&self, boundary: u32) -> u32 {
        self.roots.len() as u32 + boundary
    }

    /// That of the chosen bodies (places as [`Self::mover`] tells them), to which all others stand still. What they share with
    /// one of the others counts by the factor that `borne` tells of the element and its end.
    pub(super) fn part(&self, chosen: &[bool], borne: impl Fn(usize, usize) -> f64) -> Self {
        let mut part = Self {
            state: self.state,
            roots: Arc::clone(&self.roots),
            groups: Arc::clone(&self.groups),
            elements: Vec::new(),
            bodies: Vec::new(),
            stiffness: Parts::default(),
            damping: Parts::default(),
        };
        for (place, (element, bodies)) in self.elements.iter().zip(&self.bodies).enumerate() {
            let inside = bodies.map(|body| body != UNMOVED && chosen[body as usize]);
            let (taken, own, factor) = match inside {
                [false, false] => continue,
                [true, true] => (*element, *bodies, 1.0),
                [true, false] => (element.end(0, self.roots.len()), [bodies[0], UNMOVED], borne(place, 0)),
                [false, true] => (element.end(1, self.roots.len()), [bodies[1], UNMOVED], borne(place, 1)),
            };
            let parts = [&self.stiffness, &self.damping].map(|parts| parts.of(place).map(|it| factor * it));
            part.push(taken, own, parts, part.elements.len() + 1);
        }
        part
    }

    /// Adds interactions, but those by which nothing moves.
    fn add(&mut self, links: &[Link], most: usize, context: &Context) {
        let found = |link: Link| {
            let element = self.element(&link)?;
            Some((element, self.bodies_of(&element), [link.stiffness, link.damping]))
        };
        let pieces = context.collect(links.len().div_ceil(CHUNK), |piece| {
            let links = &links[piece * CHUNK..((piece + 1) * CHUNK).min(links.len())];
            links.iter().flat_map(|link| self.with_itself(link)).flatten().filter_map(found).collect::<Vec<_>>()
        });
        for (element, bodies, parts) in pieces.into_iter().flatten() {
            self.push(element, bodies, parts, most);
        }
    }

    /// Adds an element between these bodies, with its springs and dashpots; in all there are at most `most`.
    fn push(&mut self, element: Element, bodies: [u32; 2], [stiffness, damping]: [[f64; 4]; 2], most: usize) {
        let before = self.elements.len();
        self.stiffness.push(stiffness, before, most);
        self.damping.push(damping, before, most);
        self.bodies.push(bodies);
        self.elements.push(element);
    }

    /// The bodies at the ends of an element.
    fn bodies_of(&self, element: &Element) -> [u32; 2] {
        element.slots.map(|slot| self.mover(slot).map_or(UNMOVED, |mover| mover as u32))
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

    /// An interaction; of a body with an image of itself two with what stands still, which are together at least as stiff, as
    /// |a − b|² ≤ 2 |a|² + 2 |b|².
    pub(super) fn with_itself(&self, link: &Link) -> [Option<Link>; 2] {
        if self.state.cell.is_none() {
            return [Some(*link), None];
        }
        let is_same = |a: u32, b: u32| a != b && self.mover(a).is_some() && self.mover(a) == self.mover(b);
        let Some(second) = link.second.filter(|&second| is_same(second, link.first)) else {
            return [Some(*link), None];
        };
        let alone = |first: u32, arms: [f64; 2]| Link {
            first,
            second: None,
            arms,
            stiffness: link.stiffness.map(|part| 2.0 * part),
            damping: link.damping.map(|part| 2.0 * part),
            ..*link
        };
        let [a, b] = link.arms;
        [Some(alone(link.first, [a, 0.0])), Some(alone(second, [-b, 0.0]))]
    }

    /// An interaction between what moves, if it moves anything.
    pub(super) fn element(&self, link: &Link) -> Option<Element> {
        let moved = |slot: &u32| self.mover(*slot).is_some();
        // A surface feels an element where its particle is touched.
        let surface = link.boundary.map(|boundary| self.boundary_slot(boundary)).filter(moved);
        let second = link.second.map(|second| (second, link.arms[1]));
        let second = second.filter(|(slot, _)| moved(slot)).or(surface.map(|slot| (slot, -link.arms[0])));
        let first = Some(link.first).filter(moved);
        let [x, y, z] = link.normal.to_array();
        let same = first.is_some_and(|first| second.is_some_and(|(second, _)| self.mover(first) == self.mover(second)));
        let (slots, [a, b]) = match (first, second) {
            (Some(_), Some(_)) if same => return None,
            (Some(first), Some((second, arm))) => ([first, second], [-link.arms[0], arm]),
            (Some(first), None) => ([first, UNMOVED], [-link.arms[0], 0.0]),
            (None, Some((second, arm))) if surface.is_some() => ([second, link.first | HELD], [arm, 0.0]),
            (None, Some((second, arm))) => ([second, UNMOVED], [arm, 0.0]),
            (None, None) => return None,
        };
        Some(Element { slots, normal: [x as f32, y as f32, z as f32], arms: [a as f32, b as f32] })
    }

    /// How many bodies there may be: particles, then boundaries.
    pub(super) fn movers(&self) -> usize {
        self.roots.len() + self.groups.len()
    }

    /// The body that moves a particle or a boundary, if forces move it: the particle itself, or behind all particles the boundary.
    #[inline]
    pub(super) fn mover(&self, slot: u32) -> Option<usize> {
        let group = match self.state.particles.owner.get(slot as usize) {
            Some(0) => return Some(slot as usize),
            Some(&IMAGE) => return self.mover(self.state.particles.original(slot)),
            Some(owner) => *owner as usize - 1,
            None => (slot as usize).checked_sub(self.roots.len())?,
        };
        self.groups.get(group)?.as_ref().map(|_| self.roots.len() + group)
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
        let particles = &self.state.particles;
        let centre = |slot: u32| {
            let slot = Some(slot & !HELD).filter(|slot| (*slot as usize) < particles.len())?;
            Some(particles.original(slot) as usize)
        };
        // A surface is touched by the particle at the other end; what holds it to the ground acts at its point of reference.
        let [own, other] = [element.slots[end], element.slots[1 - end]];
        let in_cell = |slot: usize| Vector::from(particles.position[slot]);
        let centre = match centre(own) {
            // What is loose is brought back into a cell as a whole, a group stays where its pivot is.
            Some(slot) if self.state.is_loose(slot) => in_cell(slot),
            Some(slot) => Vector::from(self.state.unwrapped(slot)),
            None => match centre(other) {
                Some(slot) => in_cell(slot),
                None => return Vector::zero(),
            },
        };
        centre - group.pivot + Vector::new(x, y, z) * f64::from(element.arms[end])
    }
}

/// How many interactions there are at most, unless bonds are still to be made: near pairs, and two parts of each bond.
fn most_links(state: &State) -> usize {
    let pairs = state.contacts.iter().map(|list| list.first.len());
    let walls = state.walls.iter().map(|list| list.particle.len());
    let bonds = state.bonds.iter().map(|list| 2 * list.first.len());
    pairs.chain(walls).chain(bonds).sum()
}
