//! A surface of features: where it is touched is found anew in each step.
//!
//! A particle touches several features at once, in a corner or a bend, and other ones in the next step. Its feet are found from
//! the parts that are near ([`crate::surface::Features`]) and become entries of a batch, with their weights and shares of
//! friction as columns. What a contact remembers goes with its feature, and from one feature to the next where the foot rolls
//! over a bend. A law that holds bodies together beyond touch does so where there was a contact before.

use super::AtSurface;
use super::history::{Past, source, taken};
use super::nodes::{Held, HeldColumns, Moving};
use super::sphere::{Load, Loaded, SphereAt, along, lanes};
use super::{Range, Touched, Work};
use crate::batches::coefficients::CoefficientTable;
use crate::batches::{Bodies, ContactGeometry, Entries, FOUND, Touching};
use crate::contact::{Contact, Law, MOST_HISTORY, Needs, Reaction};
use crate::geometry::Frame;
use crate::interactions::ahead::{Ahead, Link};
use crate::interactions::records::{self, ContactRecord, Motion};
use crate::lanes::{Lane, vector};
use crate::number::Vector;
use crate::state::contacts::{REVERSE, SLIDING, TOUCHING};
use crate::state::{BoundaryState, Nodes, Row, State, WallContacts};
use crate::surface::{Features, Feet, Foot};
use std::sync::PoisonError;

/// A surface where it stands, as it moves.
#[derive(Clone, Copy)]
struct Standing<'a> {
    /// Its features, in its own axes.
    features: &'a dyn Features,
    /// Where these axes are.
    frame: Frame,
    /// The moved point of reference \[m\].
    pivot: Vector,
    /// Velocity of that point \[m/s\].
    velocity: Vector,
    /// Angular velocity \[rad/s\].
    spin: Vector,
    /// Whether it turns.
    turning: bool,
    /// How the surface runs in itself where it lies along this \[m/s\].
    conveying: Vector,
    /// Whether it does.
    conveys: bool,
    /// Its nodes, where they move one by one.
    moving: Option<Moving<'a>>,
}

impl<'a> Standing<'a> {
    /// A surface of features where its boundary stands.
    fn of(features: &'a dyn Features, surface: &AtSurface, boundary: &BoundaryState) -> Self {
        let frame = Frame::of(surface.reference, boundary.displacement.into(), boundary.orientation.0);
        let spin = boundary.angular_velocity.into();
        let (pivot, turning) = (frame.pivot(), spin != Vector::zero());
        let (conveying, conveys) = (frame.outside(surface.conveying), surface.conveying != Vector::zero());
        let velocity = boundary.velocity.into();
        Self { features, frame, pivot, velocity, spin, turning, conveying, conveys, moving: None }
    }

    /// The surface of a boundary, whose nodes may move one by one, where it stands.
    fn with<T>(
        surface: &AtSurface,
        (boundary, nodes): (&BoundaryState, Option<&Nodes>),
        then: impl FnOnce(Standing) -> T,
    ) -> Option<T> {
        match (&surface.touched, nodes) {
            (Touched::Features(shape), _) => Some(then(Standing::of(shape.features()?, surface, boundary))),
            (Touched::Nodes(shape), Some(nodes)) => {
                let shape = shape.read().unwrap_or_else(PoisonError::into_inner);
                let moving = Some(Moving { shape: &shape, nodes });
                Some(then(Standing { moving, ..Standing::of(shape.features(), surface, boundary) }))
            }
            _ => None,
        }
    }

    /// Geometry and relative motion of spheres. The surface moves as at the point of contact, half an overlap behind it, where
    /// the loads act, too: so angular momentum is kept.
    #[inline(always)]
    fn meet<N: Lane>(
        &self,
        sphere: &SphereAt<N>,
        position: [N; 4],
        motion: [[N; 4]; 2],
        moving: Option<[Vector<N>; 2]>,
        pair_constant: N,
    ) -> ContactGeometry<N> {
        let (mut velocity, mut relative_spin) = (lanes(self.velocity), vector(motion[1]));
        if self.turning {
            let (spin, point) = (lanes(self.spin), vector(position) - sphere.normal * sphere.arm());
            velocity += spin.cross(point - lanes(self.pivot));
            relative_spin = relative_spin - spin;
        }
        if let Some([along, about]) = moving {
            velocity += along;
            relative_spin = relative_spin - about;
        }
        if self.conveys {
            velocity += along(lanes(self.conveying), sphere.normal);
        }
        sphere.meet(motion, velocity, relative_spin, pair_constant)
    }
}

/// A particle: position and radius, velocity and mass, angular velocity.
type Body = [Row; 3];

/// What a particle touches, and by which coefficients.
struct Stand<'a> {
    /// The surface.
    at: &'a Standing<'a>,
    /// The particle.
    body: Body,
    /// Coefficients.
    row: &'a [f64],
    /// Pair constant.
    constant: f64,
}

impl Stand<'_> {
    /// The contact at a foot.
    fn meet(&self, foot: &Foot) -> ContactGeometry {
        let moving = self.at.moving.map(|moving| moving.motion(foot, self.centre(), self.body[0][3]));
        self.meet_moving(foot, moving)
    }

    /// Its centre in the axes of the surface \[m\].
    fn centre(&self) -> Vector {
        self.at.frame.inside(Vector::from(self.body[0]))
    }

    /// The contact at a foot, where the nodes give this motion to the surface.
    fn meet_moving(&self, foot: &Foot, moving: Option<[Vector; 2]>) -> ContactGeometry {
        let [position, velocity, spin] = self.body;
        let normal = self.at.frame.outside(foot.normal);
        let sphere = SphereAt { normal, distance: foot.distance, radius: position[3] };
        self.at.meet(&sphere, position, [velocity, spin], moving, self.constant)
    }

    /// Elastic force of a foot without motion \[N\].
    fn pressing(&self, law: &Law, foot: &Foot) -> f64 {
        let resting = Contact {
            normal_velocity: 0.0,
            slip: Vector::zero(),
            relative_spin: Vector::zero(),
            ..self.meet_moving(foot, None).contact
        };
        law.react(self.row, &resting, &mut [[0.0; 4]; MOST_HISTORY], 0.0).force.dot(resting.normal)
    }

    /// The share of friction that a foot has: none at a saddle, less than all at its faces.
    fn friction(&self, law: &Law, foot: &Foot, feet: &Feet) -> f64 {
        let mut share = foot.weight;
        for saddle in &feet.saddles {
            let Some(place) = saddle.faces.iter().position(|face| *face == foot.feature) else { continue };
            let Some(edge) = feet.on(saddle.feature) else { continue };
            let force = self.pressing(law, foot);
            if force != 0.0 {
                share -= saddle.shares[place] * self.pressing(law, edge) / force;
            }
        }
        share.max(0.0)
    }
}

/// Contacts of a piece of the particles with the features of a surface, each a column; kept from one step to the next for its
/// room.
#[derive(Default)]
pub(super) struct FeatureContacts {
    /// The particle of each (slot).
    particle: Vec<u32>,
    /// Its feature.
    feature: Vec<u32>,
    /// Its bits.
    flags: Vec<u8>,
    /// What the law remembers of it, row by row.
    history: Vec<Vec<Row>>,
    /// Its pair constant; empty where the law has none.
    pair_constant: Vec<f64>,
    /// Its number: 0, 1, 2, …
    number: Vec<u32>,
    /// Normal and distance of its foot \[m\].
    foot: Vec<Row>,
    /// How often its normal force counts, and its share of friction.
    weight: Vec<[f64; 2]>,
    /// Whether the centre is behind the face.
    behind: Vec<bool>,
    /// What it has beside where nodes move one by one.
    held: Held,
    /// What the present particle touches.
    feet: Feet,
}

impl FeatureContacts {
    /// Forgets all contacts, of which so many rows are kept.
    fn clear(&mut self, rows: usize) {
        self.particle.clear();
        self.feature.clear();
        self.flags.clear();
        self.history.resize(rows, Vec::new());
        self.history.iter_mut().for_each(Vec::clear);
        self.pair_constant.clear();
        self.foot.clear();
        self.weight.clear();
        self.behind.clear();
        self.held.clear();
    }

    /// What the contacts have beside where nodes move one by one.
    pub(super) fn held(&self) -> &Held {
        &self.held
    }

    /// Writes the bits of all contacts when the law has acted: a saddle is not a contact of its own.
    fn finish(&mut self) {
        for ((flags, [weight, _]), behind) in self.flags.iter_mut().zip(&self.weight).zip(&self.behind) {
            let kept = if *weight > 0.0 { *flags & (TOUCHING | SLIDING) } else { 0 };
            *flags = kept | if *behind { REVERSE } else { 0 };
        }
    }
}

/// Puts the contacts that the pieces found, of each of which so many rows are kept, in the place of a list's.
pub(super) fn replace<'a>(list: &mut WallContacts, rows: usize, pieces: impl Iterator<Item = &'a FeatureContacts>) {
    list.particle.clear();
    list.feature.clear();
    list.flags.clear();
    list.history.resize(rows, Vec::new());
    list.history.iter_mut().for_each(Vec::clear);
    for piece in pieces {
        list.particle.extend_from_slice(&piece.particle);
        list.feature.extend_from_slice(&piece.feature);
        list.flags.extend_from_slice(&piece.flags);
        for (all, rows) in list.history.iter_mut().zip(&piece.history) {
            all.extend_from_slice(rows);
        }
    }
}

/// The parts that are near a listed particle.
fn parts(list: &WallContacts, place: usize) -> &[u32] {
    let [from, to] = [place, place + 1].map(|place| list.near.starts.get(place).map_or(0, |&start| start as usize));
    &list.near.parts[from..to.max(from)]
}

/// The pair constant of a particle that is near.
fn constant(list: &WallContacts, place: usize) -> f64 {
    list.pair_constant.get(place).copied().unwrap_or(0.0)
}

impl AtSurface {
    /// What the particles in a range of slots do to a surface of features.
    pub(super) fn piece_at_features(&self, work: &Work, slots: Range<usize>, contacts: &mut FeatureContacts) -> Load {
        let boundary = work.walls[self.index].boundary as usize;
        let nodes = work.nodes.iter().find(|nodes| nodes.boundary as usize == boundary);
        let evaluate = |at: Standing| self.piece_at(at, work, slots, contacts);
        Standing::with(self, (&work.boundaries[boundary], nodes), evaluate).unwrap_or_default()
    }

    /// The same where it stands.
    fn piece_at(&self, at: Standing, work: &Work, slots: Range<usize>, contacts: &mut FeatureContacts) -> Load {
        let list = &work.walls[self.index];
        contacts.clear(self.kept_rows);
        let through = self.find(&at, list, &work.particles, slots, contacts);
        let count = contacts.particle.len();
        contacts.number.extend(contacts.number.len() as u32..count as u32);
        let FeatureContacts { particle, number, foot, weight, flags, history, pair_constant, held, .. } = contacts;
        let (particles, held) = (work.particles, at.moving.map(|_| held.columns()));
        let bodies = AtFeet { at, particle, number, foot, weight, held, material: self.material, particles };
        let entries = Entries::of(flags, history, pair_constant);
        let load = self.run(&self.batches(bodies, entries, work.context), 0..count);
        contacts.finish();
        Load { behind: through, ..load }
    }

    /// Finds the contacts of the particles in a range of slots. Returns a particle that went through the surface.
    fn find(
        &self,
        at: &Standing,
        list: &WallContacts,
        particles: &Loaded,
        slots: Range<usize>,
        contacts: &mut FeatureContacts,
    ) -> Option<u32> {
        let law = &self.law.law;
        let near = &list.near.particle;
        let [first, last] = [slots.start, slots.end].map(|end| near.partition_point(|&slot| (slot as usize) < end));
        let mut past = list.particle.partition_point(|&slot| (slot as usize) < slots.start);
        let (mut through, mut feet) = (None, std::mem::take(&mut contacts.feet));
        for (place, &slot) in (first..last).zip(&near[first..last]) {
            while list.particle.get(past).is_some_and(|&other| other < slot) {
                past += 1;
            }
            let position = particles.position[slot as usize];
            let constant = constant(list, place);
            let beyond = if law.holds_beyond_touch() { constant } else { 0.0 };
            feet.clear();
            let centre = at.frame.inside(Vector::from(position));
            at.features.feet(centre, position[3] + beyond, parts(list, place), &mut feet);
            if feet.list.is_empty() {
                continue;
            }
            let count = list.particle[past..].iter().take_while(|&&other| other == slot).count();
            let past = Past::of(list, past..past + count);
            let body = [position, particles.velocity[slot as usize], particles.angular_velocity[slot as usize]];
            let row = self.table.row(particles.material[slot as usize], self.material);
            let stand = Stand { at, body, row, constant };
            let went = self.add_feet(&stand, slot, &feet, &past, contacts);
            through = through.or(went.then_some(slot));
        }
        contacts.feet = feet;
        through
    }

    /// Adds the contacts of one particle. Returns whether it went through the surface.
    fn add_feet(&self, stand: &Stand, slot: u32, feet: &Feet, past: &Past, contacts: &mut FeatureContacts) -> bool {
        let (law, mut through) = (&self.law.law, false);
        for foot in &feet.list {
            let known = source(foot, feet, past, stand.at.features, law);
            if foot.distance > stand.body[0][3] && known.is_none() {
                continue;
            }
            let normal = stand.at.frame.outside(foot.normal);
            let own = |entry: usize| past.is_of(entry, foot.feature);
            for (row, rows) in contacts.history.iter_mut().enumerate() {
                let kept = known.map_or([0.0; 4], |entry| past.row(entry, row));
                let moved = law.history().get(row).filter(|_| known.is_some_and(|entry| !own(entry)));
                rows.push(moved.map_or(kept, |memory| taken(kept, memory, normal)));
            }
            let share = match foot.weight > 0.0 {
                true if feet.saddles.is_empty() => foot.weight,
                true => stand.friction(law, foot, feet),
                false => 0.0,
            };
            if law.has_pair_constant() {
                contacts.pair_constant.push(stand.constant);
            }
            contacts.particle.push(slot);
            contacts.feature.push(foot.feature);
            contacts.flags.push(0);
            contacts.foot.push(normal.row_with(foot.distance));
            contacts.weight.push([foot.weight, share]);
            contacts.behind.push(foot.behind);
            if let Some(moving) = &stand.at.moving {
                contacts.held.push(moving, (foot, normal), stand.centre(), stand.body[0][3]);
            }
            through |= past.went_through(foot);
        }
        through
    }

    /// Hands out the contacts of the last evaluation: entry of the list, foot, its share of friction, contact.
    fn each(&self, state: &State, motion: Motion, hand: impl FnMut(usize, &Foot, f64, &ContactGeometry)) {
        // A face without area has been told when forces were evaluated.
        let _ = self.follow(state);
        let boundary = self.list(state).boundary as usize;
        let standing = (&state.boundaries[boundary], state.nodes_of(boundary));
        Standing::with(self, standing, |at| self.each_at(&at, state, motion, hand));
    }

    /// The same where it stands.
    fn each_at(
        &self,
        at: &Standing,
        state: &State,
        motion: Motion,
        mut hand: impl FnMut(usize, &Foot, f64, &ContactGeometry),
    ) {
        let (list, law) = (self.list(state), &self.law.law);
        let (mut feet, mut entry) = (Feet::default(), 0);
        while entry < list.particle.len() {
            let slot = list.particle[entry];
            let count = list.particle[entry..].partition_point(|&other| other == slot);
            let place = list.near.particle.partition_point(|&other| other < slot);
            let position = state.particles.position[slot as usize];
            let (velocity, spin) = motion.of(state, slot);
            let constant = constant(list, place);
            let row = self.row(state, slot);
            let stand = Stand { at, body: [position, velocity, spin], row, constant };
            let beyond = if law.holds_beyond_touch() { constant } else { 0.0 };
            feet.clear();
            at.features.feet(
                at.frame.inside(Vector::from(position)),
                position[3] + beyond,
                parts(list, place),
                &mut feet,
            );
            for entry in entry..entry + count {
                let Some(foot) = feet.on(list.feature[entry]) else { continue };
                let share = if foot.weight > 0.0 { stand.friction(law, foot, &feet) } else { 0.0 };
                hand(entry, foot, share, &stand.meet(foot));
            }
            entry += count;
        }
    }

    /// Tells the stiffness of the contacts with features.
    pub(super) fn stiffness_at_features(&self, state: &State, ahead: &Ahead, tell: &mut dyn FnMut(Link)) {
        let (list, law) = (self.list(state), &self.law.law);
        let bent = state.nodes_of(list.boundary as usize).map_or(0.0, |nodes| nodes.fastest);
        let speed = Vector::from(state.boundaries[list.boundary as usize].velocity).length() + bent;
        self.each(state, Motion::Present, |entry, foot, _, ContactGeometry { contact, first_arm, .. }| {
            // A saddle only takes away from what its faces have.
            if foot.weight > 0.0 {
                let row = self.row(state, list.particle[entry]);
                let deep = ahead.at_boundary(law, row, contact, speed, list.boundary).unwrap_or(*contact);
                let bodies = (list.particle[entry], None, Some(list.boundary));
                tell(Link::of_contact(bodies, (law, row), &deep, [*first_arm, 0.0]));
            }
        });
    }

    /// Tells the contacts with features as they were in the last evaluation, after a time step of this length \[s\].
    pub(super) fn records_at_features(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
        let (list, law, particles) = (self.list(state), &self.law.law, &state.particles);
        self.each(state, Motion::shown(law, step), |entry, foot, share, geometry| {
            let (slot, contact) = (list.particle[entry], &geometry.contact);
            let (row, flags) = (self.row(state, slot), list.flags[entry]);
            let (reaction, sliding) = records::react(law, row, contact, &list.history, entry, flags);
            let along = contact.normal * reaction.force.dot(contact.normal);
            let force = along * foot.weight + (reaction.force - along) * share;
            let point = Vector::from(particles.position[slot as usize]) - contact.normal * geometry.first_arm;
            let (ids, boundary) = ((particles.id[slot as usize], None), Some(list.boundary));
            tell(ContactRecord::new(ids, boundary, point, contact, &Reaction { force, ..reaction }, sliding));
        });
    }

    /// Elastic energy of the contacts with features \[J\].
    pub(super) fn energy_at_features(&self, state: &State) -> f64 {
        let (list, law, mut sum) = (self.list(state), &self.law.law, 0.0);
        self.each(state, Motion::Present, |entry, foot, share, ContactGeometry { contact, .. }| {
            let row = self.row(state, list.particle[entry]);
            let energy = |history: &[Row]| law.elastic_energy(row, contact, 0.0, history);
            let pressed = energy(&[[0.0; 4]; MOST_HISTORY]);
            sum += foot.weight * pressed + share * (energy(&records::history(&list.history, entry)) - pressed);
        });
        sum
    }

    /// Energy at features of rolling springs, of sticky and of plastic normal forces \[J\].
    pub(super) fn held_at_features(&self, state: &State) -> [f64; 3] {
        let (list, law, mut held) = (self.list(state), &self.law.law, [0.0; 3]);
        if !law.has_rolling() && law.takes_offset() {
            return held;
        }
        let own = if law.is_plastic() { 2 } else { 1 };
        self.each(state, Motion::Present, |entry, foot, share, ContactGeometry { contact, .. }| {
            let (row, history) = (self.row(state, list.particle[entry]), records::history(&list.history, entry));
            held[0] += share * law.rolling_energy(row, contact, &history);
            if !law.takes_offset() {
                held[own] += foot.weight * law.normal_energy(row, contact, 0.0, &history);
            }
        });
        held
    }

    /// Largest overlap with a feature over the radius of the particle.
    pub(super) fn largest_overlap(&self, state: &State) -> f64 {
        let mut largest = 0.0_f64;
        self.each(state, Motion::Present, |_, foot, _, ContactGeometry { contact, .. }| {
            if foot.weight > 0.0 {
                largest = largest.max(contact.overlap / contact.radius);
            }
        });
        largest
    }
}

/// Particles at their feet on a surface. The second body of an entry is the number of its foot.
#[derive(Clone, Copy)]
struct AtFeet<'a> {
    /// The surface, where it stands.
    at: Standing<'a>,
    /// The particle of each foot.
    particle: &'a [u32],
    /// Numbers of the feet.
    number: &'a [u32],
    /// Normals and distances.
    foot: &'a [Row],
    /// How often the normal force counts, and the share of friction.
    weight: &'a [[f64; 2]],
    /// How the surface moves at each, where nodes move one by one.
    held: Option<HeldColumns<'a>>,
    /// The surface's material.
    material: u32,
    /// The particles.
    particles: Loaded<'a>,
}

impl Bodies for AtFeet<'_> {
    type Sum = Load;
    const FOUND: usize = 5;

    fn first(&self) -> &[u32] {
        self.particle
    }

    fn second(&self) -> &[u32] {
        self.number
    }

    #[inline(always)]
    unsafe fn touch<N: Lane>(
        &self,
        first: *const u32,
        second: *const u32,
        _beyond: Option<N>,
        _load: &mut Load,
    ) -> (u32, [N; FOUND]) {
        // SAFETY: entries are slots of particles and numbers of feet.
        let ([x, y, z, distance], position) = unsafe {
            (N::load_rows(self.foot.as_ptr(), second), N::load_rows(self.particles.position.as_ptr(), first))
        };
        // A foot is there because it is touched.
        (u32::MAX, [distance, position[3], x, y, z])
    }

    #[inline(always)]
    fn roots<N: Lane>(_found: &[N; FOUND]) -> [N; 2] {
        [N::zero(); 2]
    }

    #[inline(always)]
    unsafe fn meet<N: Lane, const TORQUE: bool>(
        &self,
        first: *const u32,
        second: *const u32,
        [distance, radius, x, y, z]: [N; FOUND],
        _roots: [N; 2],
    ) -> ContactGeometry<N> {
        // SAFETY: entries are slots of particles and numbers of feet.
        let (position, motion, moving) = unsafe {
            let position = N::load_rows(self.particles.position.as_ptr(), first);
            (position, self.particles.motion::<N, TORQUE>(first), self.held.map(|held| held.motion(second)))
        };
        let sphere = SphereAt { normal: Vector::new(x, y, z), distance, radius };
        self.at.meet(&sphere, position, motion, moving, N::zero())
    }

    fn weights(&self) -> Option<&[[f64; 2]]> {
        Some(self.weight)
    }

    fn row(&self, table: &CoefficientTable, first: u32, _second: u32) -> u32 {
        table.entry(self.particles.material[first as usize], self.material)
    }

    #[inline(always)]
    fn spread(&self, touching: &Touching, needs: Needs, load: &mut Load) {
        let Touching { first, second, force, couple, rolling, first_arm, .. } = *touching;
        for place in 0..first.len() {
            let (slot, number) = (first[place] as usize, second[place] as usize);
            let (normal, [weight, share]) = (Vector::from(self.foot[number]), self.weight[number]);
            let mut loads = [force[place], couple[place], rolling[place]];
            if weight != 1.0 || share != 1.0 {
                let whole = Vector::from(force[place]);
                let along = normal * whole.dot(normal);
                loads[0] = (along * weight + (whole - along) * share).row_with(0.0);
                loads[1] = loads[1].map(|part| part * share);
                loads[2] = loads[2].map(|part| part * share);
            }
            if self.at.conveys {
                load.conveying_power += along(self.at.conveying, normal).dot(loads[0].into());
            }
            // SAFETY: each particle is in one piece, and each piece is worked on by one thread.
            unsafe {
                if let Some(held) = self.held {
                    held.note(number, loads[0], needs.spin.then_some(loads[2]));
                }
                self.particles.add(slot, (normal, first_arm[place]), &loads, needs, (self.at.pivot, &mut *load));
            }
        }
    }
}
