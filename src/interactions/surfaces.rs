//! Contacts of particles with surfaces of features: one pass for each surface and contact law that meet.
//!
//! A particle touches several features at once, in a corner or a bend, and other ones in the next step. Its contacts are
//! found anew in each step from the parts that are near ([`crate::surface::Features`]); what a contact remembers goes with
//! its feature, and from one feature to the next where the foot rolls over a bend. Each particle is worked on by one
//! thread, and its contacts in the order of the features; loads on the surface are summed piece by piece, in order.

use super::ahead::{Ahead, Link};
use super::coefficients::{CoefficientTable, Partners};
use super::pass::Pass;
use super::records::{self, ContactRecord, Motion};
use super::surface_history::{Past, carry};
use crate::contact::{Contact, Law, MOST_HISTORY, Reaction, Response};
use crate::geometry::Frame;
use crate::lanes::Shared;
use crate::number::Vector;
use crate::run_error::{Cause, RunError};
use crate::scene::{Boundary, Shape};
use crate::state::contacts::{REVERSE, SLIDING, TOUCHING};
use crate::state::ledger::Source;
use crate::state::{BoundaryState, Particles, Row, State, StateFault, WallContacts};
use crate::surface::{Features, Feet, Foot};
use crate::threads::{CHUNK, Context};
use std::f64::consts::PI;
use std::ops::Range;

/// The pass of one surface and one contact law.
pub(crate) struct SurfacePass {
    /// Which list of the state is its own.
    index: usize,
    /// Name of the boundary.
    name: String,
    /// Its shape.
    shape: Shape,
    /// Index of its material.
    material: u32,
    /// Point about which the moment is taken, at time 0 \[m\].
    reference: Vector,
    /// Coefficients of the law.
    table: CoefficientTable,
    /// The law.
    law: Law,
}

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
}

/// A particle: position and radius, velocity and mass, angular velocity.
type Body = [Row; 3];

/// A contact of a particle with a feature.
struct Meeting {
    /// Geometry and relative motion.
    contact: Contact,
    /// Where it is \[m\].
    point: Vector,
    /// Arm at the particle \[m\].
    arm: f64,
}

impl Standing<'_> {
    /// What a sphere touches.
    fn feet(&self, [position, ..]: &Body, parts: &[u32], feet: &mut Feet) {
        feet.clear();
        self.features.feet(self.frame.inside(Vector::from(*position)), position[3], parts, feet);
    }

    /// Geometry and relative motion of a sphere at a foot. The surface moves as at the point of contact, half an overlap
    /// behind it, where the loads act, too: so angular momentum is kept.
    fn meet(&self, foot: &Foot, [position, velocity, spin]: &Body, pair_constant: f64) -> Meeting {
        let (radius, normal) = (position[3], self.frame.outside(foot.normal));
        let overlap = radius - foot.distance;
        let arm = radius - 0.5 * overlap;
        let point = Vector::from(*position) - normal * arm;
        let mut relative = Vector::from(*velocity) - self.velocity;
        let mut relative_spin = Vector::from(*spin);
        if self.spin != Vector::zero() {
            relative = relative - self.spin.cross(point - self.pivot);
            relative_spin = relative_spin - self.spin;
        }
        let normal_velocity = relative.dot(normal);
        let contact = Contact {
            overlap,
            radius,
            mass: velocity[3],
            section_area: PI * overlap * (radius + radius - overlap),
            section_radius: radius,
            normal,
            normal_velocity,
            slip: relative - normal * normal_velocity - (Vector::from(*spin) * arm).cross(normal),
            relative_spin,
            spin_sum: Vector::from(*spin),
            per_reach: 0.0,
            rolling_inertia: velocity[3] * radius * radius,
            pair_constant,
        };
        Meeting { contact, point, arm }
    }
}

/// Elastic force of a foot without motion \[N\].
fn pressing(law: &Law, at: &Standing, foot: &Foot, body: &Body, (row, constant): (&[f64], f64)) -> f64 {
    let resting = Contact {
        normal_velocity: 0.0,
        slip: Vector::zero(),
        relative_spin: Vector::zero(),
        ..at.meet(foot, body, constant).contact
    };
    law.react(row, &resting, &mut [[0.0; 4]; MOST_HISTORY], 0.0).force.dot(resting.normal)
}

/// The share of friction that a foot has: none at a saddle, less than all at its faces.
fn friction(law: &Law, at: &Standing, (foot, feet): (&Foot, &Feet), body: &Body, of: (&[f64], f64)) -> f64 {
    if foot.weight <= 0.0 {
        return 0.0;
    }
    let mut share = foot.weight;
    for saddle in &feet.saddles {
        let Some(place) = saddle.faces.iter().position(|face| *face == foot.feature) else { continue };
        let Some(edge) = feet.on(saddle.feature) else { continue };
        let force = pressing(law, at, foot, body, of);
        if force != 0.0 {
            share -= saddle.shares[place] * pressing(law, at, edge, body, of) / force;
        }
    }
    share.max(0.0)
}

/// What a foot does with its weight and its share of friction.
fn weigh(reaction: &Reaction, normal: Vector, weight: f64, friction: f64) -> Reaction {
    if weight == 1.0 && friction == 1.0 {
        return *reaction;
    }
    let along = normal * reaction.force.dot(normal);
    Reaction {
        force: along * weight + (reaction.force - along) * friction,
        couple: reaction.couple * friction,
        rolling: reaction.rolling * friction,
        ..*reaction
    }
}

/// What a piece of the particles does to the surface, and the contacts that it has now.
struct Piece {
    /// Force on the surface \[N\].
    force: Vector,
    /// Moment about the moved reference point \[N m\].
    moment: Vector,
    /// A particle whose centre went through the surface.
    through: Option<u32>,
    /// Its contacts: particle, feature, bits, what the law remembers.
    contacts: Vec<(u32, u32, u8, [Row; MOST_HISTORY])>,
}

/// The particles, while loads are added to them.
struct Loaded<'a> {
    /// Positions, velocities, materials.
    particles: [&'a [Row]; 3],
    /// Materials.
    material: &'a [u32],
    /// Forces.
    force: Shared<Row>,
    /// Torques.
    torque: Shared<Row>,
}

impl SurfacePass {
    /// The pass of a boundary and a law with this table, whose list is this one.
    pub(crate) fn of(boundary: &Boundary, index: usize, table: CoefficientTable, law: Law) -> Self {
        Self {
            index,
            name: boundary.name.clone(),
            shape: boundary.shape.clone(),
            material: boundary.shape.material().map_or(0, |material| material.0),
            reference: boundary.reference.into(),
            table,
            law,
        }
    }

    /// The surface where it stands.
    fn standing(&self, boundary: &BoundaryState) -> Option<Standing<'_>> {
        let frame = Frame::of(self.reference, boundary.displacement.into(), boundary.orientation.0);
        Some(Standing {
            features: self.shape.features()?,
            frame,
            pivot: frame.pivot(),
            velocity: boundary.velocity.into(),
            spin: boundary.angular_velocity.into(),
        })
    }

    /// Does the particles in a range of slots. Ranges worked on at the same time do not overlap.
    fn piece(&self, at: &Standing, list: &WallContacts, loaded: &Loaded, slots: Range<usize>, step: f64) -> Piece {
        let (force, moment) = (Vector::zero(), Vector::zero());
        let (mut piece, mut feet) = (Piece { force, moment, through: None, contacts: Vec::new() }, Feet::default());
        let [first, last] =
            [slots.start, slots.end].map(|end| list.near.particle.partition_point(|&slot| (slot as usize) < end));
        let mut past = list.particle.partition_point(|&slot| (slot as usize) < slots.start);
        for place in first..last {
            let slot = list.near.particle[place];
            past += list.particle[past..].partition_point(|&other| other < slot);
            let count = list.particle[past..].partition_point(|&other| other == slot);
            let body = loaded.particles.map(|rows| rows[slot as usize]);
            at.feet(&body, parts(list, place), &mut feet);
            let constant = list.pair_constant.get(place).copied().unwrap_or(0.0);
            let past = Past::of(list, past..past + count);
            self.particle(at, &feet, (slot, body, constant), &past, loaded, (step, &mut piece));
        }
        piece
    }

    /// Does one particle.
    fn particle(
        &self,
        at: &Standing,
        feet: &Feet,
        (slot, body, constant): (u32, Body, f64),
        past: &Past,
        loaded: &Loaded,
        (step, piece): (f64, &mut Piece),
    ) {
        let row = self.table.row(loaded.material[slot as usize], self.material);
        for foot in &feet.list {
            let Meeting { contact, point, arm } = at.meet(foot, &body, constant);
            let mut history = carry(foot, contact.normal, feet, past, at.features, &self.law);
            let reaction = self.law.react(row, &contact, &mut history, step);
            let arm = if self.law.undeformed_arms() { contact.radius } else { arm };
            let share = friction(&self.law, at, (foot, feet), &body, (row, constant));
            let weighed = weigh(&reaction, contact.normal, foot.weight, share);
            let Reaction { force, couple, rolling, sliding, .. } = weighed;
            // SAFETY: each particle is in one piece, and each piece is worked on by one thread.
            let (on_force, on_torque) = unsafe { (loaded.force.at(slot as usize), loaded.torque.at(slot as usize)) };
            add(on_force, force);
            if self.law.needs().torque {
                add(on_torque, -(couple * arm));
                add(on_torque, -rolling);
            }
            piece.force = piece.force - force;
            piece.moment = piece.moment - ((point - at.pivot).cross(force) - rolling);
            let mut flags = if foot.weight > 0.0 { TOUCHING } else { 0 };
            flags |= if sliding && flags != 0 { SLIDING } else { 0 };
            flags |= if foot.behind { REVERSE } else { 0 };
            if past.went_through(foot) {
                piece.through = piece.through.or(Some(slot));
            }
            piece.contacts.push((slot, foot.feature, flags, history));
        }
    }

    /// Hands out the contacts of the last evaluation: entry of the list, foot, its share of friction, meeting.
    fn each(&self, state: &State, body_of: impl Fn(usize) -> Body, mut hand: impl FnMut(usize, &Foot, f64, &Meeting)) {
        let list = &state.walls[self.index];
        let Some(at) = self.standing(&state.boundaries[list.boundary as usize]) else { return };
        let mut feet = Feet::default();
        let mut entry = 0;
        while entry < list.particle.len() {
            let slot = list.particle[entry];
            let count = list.particle[entry..].partition_point(|&other| other == slot);
            let place = list.near.particle.partition_point(|&other| other < slot);
            let body = body_of(slot as usize);
            at.feet(&body, parts(list, place), &mut feet);
            let constant = list.pair_constant.get(place).copied().unwrap_or(0.0);
            let row = self.table.row(state.particles.material[slot as usize], self.material);
            for entry in entry..entry + count {
                let Some(foot) = feet.on(list.feature[entry]) else { continue };
                let share = friction(&self.law, &at, (foot, &feet), &body, (row, constant));
                hand(entry, foot, share, &at.meet(foot, &body, constant));
            }
            entry += count;
        }
    }

    /// The coefficients of a listed contact.
    fn row(&self, state: &State, entry: usize) -> &[f64] {
        let slot = state.walls[self.index].particle[entry] as usize;
        self.table.row(state.particles.material[slot], self.material)
    }
}

/// The parts that are near a listed particle.
fn parts(list: &WallContacts, place: usize) -> &[u32] {
    let [from, to] = [place, place + 1].map(|place| list.near.starts.get(place).map_or(0, |&start| start as usize));
    &list.near.parts[from..to.max(from)]
}

/// Adds a vector to a row.
fn add(row: &mut Row, vector: Vector) {
    for (sum, part) in row.iter_mut().zip(vector.to_array()) {
        *sum += part;
    }
}

/// A particle as it is at the present time.
fn present(particles: &Particles) -> impl Fn(usize) -> Body + '_ {
    |slot| [particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot]]
}

impl Pass for SurfacePass {
    fn check(&self, state: &State) -> Result<(), StateFault> {
        let counts = self.shape.features().map_or([0; 2], |features| features.counts());
        state.walls[self.index].check_features(self.law.history().len(), self.law.has_pair_constant(), counts)
    }

    fn apply(&self, state: &mut State, context: &Context) -> Result<(), RunError> {
        let State { walls, particles, boundaries, clock, .. } = state;
        let list = &mut walls[self.index];
        let boundary = &mut boundaries[list.boundary as usize];
        let Some(at) = self.standing(boundary) else { return Ok(()) };
        let count = particles.len();
        let loaded = Loaded {
            particles: [&particles.position, &particles.velocity, &particles.angular_velocity],
            material: &particles.material,
            force: Shared::new(&mut particles.force),
            torque: Shared::new(&mut particles.torque),
        };
        let known: &WallContacts = list;
        let pieces = context.collect(count.div_ceil(CHUNK), |piece| {
            let slots = piece * CHUNK..((piece + 1) * CHUNK).min(count);
            self.piece(&at, known, &loaded, slots, context.step)
        });
        let mut through = None;
        list.particle.clear();
        list.feature.clear();
        list.flags.clear();
        list.history.resize(self.law.history().len(), Vec::new());
        list.history.iter_mut().for_each(Vec::clear);
        for piece in pieces {
            boundary.force = (Vector::from(boundary.force) + piece.force).to_array();
            boundary.moment = (Vector::from(boundary.moment) + piece.moment).to_array();
            through = through.or(piece.through);
            for (slot, feature, flags, history) in piece.contacts {
                list.particle.push(slot);
                list.feature.push(feature);
                list.flags.push(flags);
                list.history.iter_mut().zip(history).for_each(|(rows, row)| rows.push(row));
            }
        }
        match through {
            None => Ok(()),
            Some(slot) => Err(RunError::Behind {
                id: particles.id[slot as usize],
                boundary: self.name.clone(),
                time: clock.time,
                cause: Cause::Unknown,
            }),
        }
    }

    fn has_torque(&self) -> bool {
        self.law.needs().torque
    }

    fn take_coefficients(&mut self, state: &State) {
        self.table.take(&state.coefficients[state.walls[self.index].law as usize]);
    }

    fn source(&self) -> Source {
        Source::Walls
    }

    fn prepare(&self, state: &mut State) {
        let (list, particles) = (&mut state.walls[self.index], &state.particles);
        list.pair_constant.clear();
        if self.law.has_pair_constant() {
            list.pair_constant.extend(list.near.particle.iter().map(|&slot| {
                let slot = slot as usize;
                let row = self.table.row(particles.material[slot], self.material);
                self.law.pair_constant(row, particles.position[slot][3], particles.velocity[slot][3])
            }));
        }
    }

    fn stiffness(&self, state: &State, ahead: &Ahead, tell: &mut dyn FnMut(Link)) {
        let list = &state.walls[self.index];
        let speed = Vector::from(state.boundaries[list.boundary as usize].velocity).length();
        self.each(state, present(&state.particles), |entry, foot, _, Meeting { contact, arm, .. }| {
            // A saddle only takes away from what its faces have.
            if foot.weight > 0.0 {
                let row = self.row(state, entry);
                let deep = ahead.at_boundary(&self.law, row, contact, speed, list.boundary).unwrap_or(*contact);
                let bodies = (list.particle[entry], None, Some(list.boundary));
                tell(Link::of_contact(bodies, (&self.law, row), &deep, [*arm, 0.0]));
            }
        });
    }

    fn impact(&self, radius: f64, mass: f64, speed: f64) -> Option<Response> {
        // The effective radius and mass are the particle's own, twice those of an equal pair.
        self.table.stiffest(&self.law, Partners::Boundary(self.material), 2.0 * radius, 2.0 * mass, speed)
    }

    fn contacts(&self, state: &State, step: f64, tell: &mut dyn FnMut(ContactRecord)) {
        let (list, particles) = (&state.walls[self.index], &state.particles);
        let before = |slot: usize| {
            let (velocity, spin) = Motion::HalfStepBack(step).of(state, slot as u32);
            [particles.position[slot], velocity, spin]
        };
        self.each(state, before, |entry, foot, share, Meeting { contact, point, .. }| {
            let (row, flags) = (self.row(state, entry), list.flags[entry]);
            let (reaction, sliding) = records::react(&self.law, row, contact, &list.history, entry, flags);
            let reaction = weigh(&reaction, contact.normal, foot.weight, share);
            let ids = (particles.id[list.particle[entry] as usize], None);
            tell(ContactRecord::new(ids, Some(list.boundary), *point, contact, &reaction, sliding));
        });
    }

    fn elastic_energy(&self, state: &State) -> f64 {
        let (list, mut sum) = (&state.walls[self.index], 0.0);
        self.each(state, present(&state.particles), |entry, foot, share, Meeting { contact, .. }| {
            let energy = |history: &[Row]| self.law.elastic_energy(self.row(state, entry), contact, 0.0, history);
            let pressed = energy(&[[0.0; 4]; MOST_HISTORY]);
            sum += foot.weight * pressed + share * (energy(&records::history(&list.history, entry)) - pressed);
        });
        sum
    }

    fn largest_overlap(&self, state: &State) -> f64 {
        let mut largest = 0.0_f64;
        self.each(state, present(&state.particles), |_, foot, _, Meeting { contact, .. }| {
            if foot.weight > 0.0 {
                largest = largest.max(contact.overlap / contact.radius);
            }
        });
        largest
    }
}
