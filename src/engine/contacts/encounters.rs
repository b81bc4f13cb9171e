//! Which impacts are those of two bodies alone, and how much of the energy of all contacts they have: what decides how long a time
//! step may be.
//!
//! The neighbour lists hold every pair that can touch until they are made anew. So a look at them foresees every impact until then:
//! a pair of bodies that are in no contact counts with the energy with which it will meet. Bodies that bonds hold together are one.

use super::listed::{Bodies, ContactEntries};
use super::records::Motion;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::bodies::RigidBody;
use crate::engine::bonds::clusters::{self, Clusters};
use crate::engine::integration::Fields;
use crate::engine::state::contacts::{TOUCHING, is_suppressed};
use crate::engine::state::{State, WallContacts};
use crate::laws::contact::{Contact, Law, MOST_HISTORY};
use std::ops::Range;

/// Contacts in one piece of work.
const PIECE: usize = 8192;

/// What rounding may add to a bound, over it.
const ROUNDING: f64 = 1e-9;

/// How two bodies meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meetings {
    /// They touch, and nothing else.
    Impact,
    /// They may touch, and touch nothing now.
    ComingImpact,
    /// They touch, and others.
    Packed,
    /// They may touch, and one of them touches others.
    ComingPacked,
}

/// Energies of contacts \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Energies {
    /// Of impacts of two bodies alone.
    pub impacts: f64,
    /// Of bodies that come upon others in contact.
    pub coming: f64,
    /// Of contacts inside packings.
    pub packed: f64,
    /// Elastic energy of the only contacts that clusters of bonded bodies have.
    pub held: f64,
}

impl Energies {
    /// With those of another part.
    fn with(self, other: Self) -> Self {
        Self {
            impacts: self.impacts + other.impacts,
            coming: self.coming + other.coming,
            packed: self.packed + other.packed,
            held: self.held + other.held,
        }
    }
}

/// What is looked at, and what was found.
pub(crate) struct Encounters<'a> {
    /// The threads.
    context: &'a Context<'a>,
    /// How many contacts the body has that moves each particle (slot), or those that bonds hold together with it, up to 2.
    contacts: Vec<u8>,
    /// Bodies that bonds hold together, where any do.
    clusters: Option<&'a Clusters>,
    /// Gravity and applied forces.
    fields: &'a Fields,
    /// Groups and surfaces that move.
    bodies: &'a [Option<RigidBody>],
    /// Largest speed that each boundary has or is about to get \[m/s\].
    speeds: Vec<f64>,
    /// Whether contacts inside packings are looked at.
    whole: bool,
    /// Time in which contacts to come count \[s\].
    time: f64,
    /// Largest acceleration by gravity and applied forces \[m/s²\].
    acceleration: f64,
    /// What was found.
    pub energies: Energies,
}

/// The place of the body that moves a particle (slot), or of the first one that bonds hold together with it.
#[inline]
fn mover(state: &State, clusters: Option<&Clusters>, slot: u32) -> usize {
    let body = clusters::mover(state, slot);
    clusters.map_or(body, |clusters| clusters.representative(body))
}

/// Whether bodies with these bits touch, and no bond takes the place of the contact.
fn touches(flags: u8) -> bool {
    flags & TOUCHING != 0 && !is_suppressed(flags)
}

impl<'a> Encounters<'a> {
    /// Counts the contacts of each body.
    pub(crate) fn of(
        state: &State,
        (fields, bodies): (&'a Fields, &'a [Option<RigidBody>]),
        (speeds, mut contacts): (Vec<f64>, Vec<u8>),
        clusters: Option<&'a Clusters>,
        (whole, time): (bool, f64),
        context: &'a Context<'a>,
    ) -> Self {
        contacts.clear();
        contacts.resize(clusters::bodies(state), 0);
        let mut count = |body: usize| {
            let place = &mut contacts[body];
            *place = (*place + 1).min(2);
        };
        for list in &state.contacts {
            for (entry, _) in list.flags.iter().enumerate().filter(|(_, flags)| touches(**flags)) {
                let [a, b] = [list.first[entry], list.second[entry]].map(|slot| mover(state, clusters, slot));
                if a != b {
                    count(a);
                    count(b);
                }
            }
        }
        for WallContacts { particle, flags, .. } in &state.walls {
            // A particle may have several feet on one surface, which follow each other.
            let mut last = None;
            for (slot, _) in particle.iter().zip(flags).filter(|(_, flags)| touches(**flags)) {
                if last != Some(slot) {
                    count(mover(state, clusters, *slot));
                    last = Some(slot);
                }
            }
        }
        // They were counted at one particle or body for all that move together.
        for slot in 0..state.particles.len() {
            contacts[slot] = contacts[mover(state, clusters, slot as u32)];
        }
        let acceleration = fields.acceleration(&state.particles);
        let energies = Energies::default();
        Self { context, contacts, clusters, fields, bodies, speeds, whole, time, acceleration, energies }
    }

    /// The room for the numbers of contacts, for the next look.
    pub(crate) fn into_room(self) -> Vec<u8> {
        self.contacts
    }

    /// How a particle (slot) meets another one, or a surface; none where that does not matter.
    #[inline]
    pub(crate) fn meeting(
        &self,
        state: &State,
        (first, second): (u32, Option<u32>),
        touches: impl FnOnce() -> bool,
    ) -> Option<Meetings> {
        let own = self.contacts[first as usize];
        let other = second.map_or(own, |second| self.contacts[second as usize]);
        let (least, most) = (own.min(other), own.max(other));
        // Most pairs of a packing end here.
        if !self.whole && least > 0 && most > 1 {
            return None;
        }
        let mover = |slot| mover(state, self.clusters, slot);
        match (least, most) {
            _ if second.is_some_and(|second| mover(second) == mover(first)) => {
                (self.whole && touches()).then_some(Meetings::Packed)
            }
            (0, 0) => Some(Meetings::ComingImpact),
            (0, _) => Some(Meetings::ComingPacked),
            (1, 1) => touches().then_some(Meetings::Impact),
            _ => (self.whole && touches()).then_some(Meetings::Packed),
        }
    }

    /// How much nearer two particles (slots) can come to each other in the time that counts, at most \[m\]: which pairs need no closer look.
    fn reach(&self, state: &State, slots: [u32; 2]) -> f64 {
        if state.cell.is_some() || self.time.is_infinite() {
            return f64::INFINITY; // velocities in a cell are relative to the streaming motion
        }
        let particles = &state.particles;
        let [v, u] = slots.map(|slot| Vector::from(particles.velocity[slot as usize]));
        let [x, y] = slots.map(|slot| Vector::from(particles.position[slot as usize]));
        let (relative, apart) = (v - u, x - y);
        let closing = ROUNDING * relative.length() - relative.dot(apart) / apart.length();
        let gained = slots.map(|slot| self.gained(state, slot));
        ((closing + gained[0] + gained[1] + self.acceleration * self.time) * self.time * (1.0 + ROUNDING)).max(0.0)
    }

    /// What the group of a particle (slot) may add to its speed \[m/s\].
    fn gained(&self, state: &State, slot: u32) -> f64 {
        let now = || Vector::from(state.particles.velocity[slot as usize]).length();
        state.particles.group(slot as usize).map_or(0.0, |group| self.gained_by(group, now()))
    }

    /// What a boundary of this speed may gain \[m/s\].
    fn gained_by(&self, boundary: usize, now: f64) -> f64 {
        self.speeds.get(boundary).map_or(0.0, |speed| speed - now).max(0.0)
    }

    /// Adds what a contact holds, or will hold.
    pub(crate) fn add(
        &self,
        energies: &mut Energies,
        meeting: Meetings,
        (law, row, contact): (&Law, &[f64], &Contact),
        state: &State,
        (first, second, boundary): Bodies,
    ) {
        let (mass, velocity, overlap) = (contact.mass, contact.normal_velocity, contact.overlap);
        // Attraction holds energy below 0.
        let elastic = || law.normal_energy(row, contact, 0.0, &[[0.0; 4]; MOST_HISTORY]).max(0.0);
        match meeting {
            Meetings::Packed => energies.packed += 0.5 * mass * velocity * velocity + elastic(),
            // What bonds bring to bear on a contact may hold it for good.
            Meetings::Impact if self.is_bonded(state, first) || second.is_some_and(|it| self.is_bonded(state, it)) => {
                energies.impacts += 0.5 * mass * velocity * velocity;
                energies.held += elastic();
            }
            Meetings::Impact => {
                // What presses the bodies on each other holds back so much of it: at rest, all.
                let held = mass * self.closing(state, contact, first, second).max(0.0) * overlap;
                let energy = 0.5 * mass * velocity * velocity + elastic();
                energies.impacts += (energy - held).max(0.0);
            }
            Meetings::ComingImpact | Meetings::ComingPacked => {
                let of_surface = |boundary: u32| {
                    let moved = &state.boundaries[boundary as usize];
                    self.gained_by(boundary as usize, Vector::from(moved.velocity).length())
                };
                let extra = self.gained(state, first)
                    + second.map_or(0.0, |second| self.gained(state, second))
                    + boundary.map_or(0.0, of_surface);
                let acceleration = self.closing(state, contact, first, second);
                let closing = extra - velocity;
                let reached = (closing + 0.5 * acceleration.max(0.0) * self.time) * self.time;
                if (closing <= 0.0 && acceleration <= 0.0) || reached < -overlap {
                    return;
                }
                let energy = mass * (0.5 * closing * closing - acceleration * overlap);
                let sum = if meeting == Meetings::ComingImpact { &mut energies.impacts } else { &mut energies.coming };
                *sum += energy.max(0.0);
            }
        }
    }

    /// Whether bonds act on the body that moves a particle (slot).
    fn is_bonded(&self, state: &State, slot: u32) -> bool {
        self.clusters.is_some_and(|clusters| clusters.of(clusters::mover(state, slot)).is_some())
    }

    /// How gravity and applied forces accelerate two bodies towards each other along their normal \[m/s²\].
    fn closing(&self, state: &State, contact: &Contact, first: u32, second: Option<u32>) -> f64 {
        let of = |slot: u32| {
            let (mass, id) = (state.particles.velocity[slot as usize][3], state.particles.id[slot as usize]);
            let group = state.particles.group(slot as usize);
            let body = group.and_then(|group| self.bodies.get(group));
            let moves = body.is_none_or(|body| body.as_ref().is_some_and(RigidBody::is_free));
            if moves { Vector::from(self.fields.loads(mass, id)) * (1.0 / mass) } else { Vector::zero() }
        };
        let relative = of(first) - second.map_or(Vector::zero(), of);
        -relative.dot(contact.normal)
    }
}

/// Adds the contacts of a list. Sums are taken piece by piece, so that they do not depend on the number of threads.
pub(crate) fn of_list(list: &(impl ContactEntries + Sync), state: &State, found: &mut Encounters) {
    let (count, so_far) = (list.kept(state).flags.len(), found.energies);
    let piece = |piece: usize| {
        let mut energies = if piece == 0 { so_far } else { Energies::default() };
        of_entries(list, state, piece * PIECE..((piece + 1) * PIECE).min(count), found, &mut energies);
        energies
    };
    let pieces = count.div_ceil(PIECE).max(1);
    found.energies = found.context.fold(pieces, piece, Energies::default(), Energies::with);
}

/// Adds some contacts of a list.
fn of_entries(
    list: &impl ContactEntries,
    state: &State,
    entries: Range<usize>,
    found: &Encounters,
    energies: &mut Energies,
) {
    let (law, kept) = (list.law(), list.kept(state));
    for entry in entries {
        let flags = kept.flags[entry];
        let bodies @ (first, second, _) = list.bodies(state, entry);
        let Some(meeting) = found.meeting(state, (first, second), || touches(flags)) else { continue };
        let gap = match (meeting, second) {
            (Meetings::ComingImpact | Meetings::ComingPacked, Some(second)) => found.reach(state, [first, second]),
            _ => f64::INFINITY,
        };
        let Some(met) = list.meet(state, entry, gap, Motion::Present) else { continue };
        found.add(energies, meeting, (law, met.row, &met.contact), state, bodies);
    }
}
