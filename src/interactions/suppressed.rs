//! What the pass of a contact law does with contacts that a bond hides or has hidden: one by one, in the order of
//! their list, after its near pairs. A scene without a bond that hides contacts has no such list.

use super::ahead::{Ahead, Link};
use super::batch;
use super::contacts::{ContactPass, effective};

use super::records::ContactRecord;
use super::sphere_geometry::SpherePair;
use super::walls::{Plane, WallPass};
use crate::bond::creation;
use crate::contact::{Contact, Law, MOST_HISTORY, Offset, Reaction, Response};
use crate::number::Vector;
use crate::state::contacts::{SLIDING, TOUCHING};
use crate::state::hidden::{FRESH, HiddenContact, LASTING};
use crate::state::{Particles, State};

/// Two bodies that touch.
struct Meeting {
    /// Geometry and relative motion.
    contact: Contact,
    /// The contact at an overlap of the offset.
    offset: Contact,
    /// Arm at the first body \[m\].
    first_arm: f64,
    /// Arm at the second body \[m\].
    second_arm: f64,
}

/// Ends a contact whose bodies do not touch.
fn part(entry: &mut HiddenContact, step: f64) {
    entry.flags &= !(TOUCHING | SLIDING);
    entry.history = [[0.0; 4]; MOST_HISTORY];
    entry.force = [0.0; 4];
    if step > 0.0 {
        entry.flags &= !FRESH;
        if entry.bonds == 0 && entry.flags & LASTING == 0 {
            entry.offset = 0.0;
        }
    }
}

/// What a contact does; its entry remembers it. Nothing where the bond silences it.
fn react(law: &Law, entry: &mut HiddenContact, meeting: &Meeting, row: &[f64], step: f64) -> Option<Reaction> {
    let (silent, contact) = (entry.is_silent(), &meeting.contact);
    let found = creation::suppressed(contact.overlap, entry.offset, entry.is_hidden());
    let offset = Offset { pressing: found.pressing, acts: found.acts, contact: meeting.offset };
    let mut history = if silent { [[0.0; 4]; MOST_HISTORY] } else { entry.history };
    let reaction = (!silent).then(|| law.react_beyond(row, contact, &offset, &mut history, step));
    if step > 0.0 {
        entry.offset = found.offset;
        entry.flags &= !FRESH;
    }
    entry.flags = (entry.flags | TOUCHING) & !SLIDING;
    if reaction.is_some_and(|reaction| reaction.sliding) {
        entry.flags |= SLIDING;
    }
    entry.history = history;
    entry.force = reaction.map_or(Vector::zero(), |reaction| reaction.force).row_with(0.0);
    reaction
}

/// The stiffness of a contact as it acts at present.
fn stiffness(law: &Law, entry: &HiddenContact, contact: &Contact, row: &[f64]) -> Option<Response> {
    if entry.bonds == 0 {
        return Some(law.stiffness(row, contact));
    }
    let friction = law.stiffness(row, contact);
    (!entry.is_silent()).then_some(Response { normal_stiffness: 0.0, normal_damping: 0.0, ..friction })
}

/// A reaction of which the force alone is known, for records.
fn remembered(entry: &HiddenContact) -> Reaction {
    Reaction {
        force: entry.force.into(),
        couple: Vector::zero(),
        rolling: Vector::zero(),
        sliding: entry.flags & SLIDING != 0,
    }
}

/// Elastic energy of a contact \[J\]: none of the normal force while a bond hides it.
fn elastic_energy(law: &Law, entry: &HiddenContact, contact: &Contact, row: &[f64]) -> f64 {
    if entry.is_silent() {
        return 0.0;
    }
    let offset = if entry.bonds > 0 { contact.overlap } else { entry.offset.min(contact.overlap) };
    law.elastic_energy(row, contact, offset, &entry.history)
}

/// Adds a multiple of a vector to a row.
fn add(row: &mut [f64; 4], vector: Vector, factor: f64) {
    for (sum, part) in row.iter_mut().zip(vector.to_array()) {
        *sum += factor * part;
    }
}

/// Two particles, if they touch.
fn pair(particles: &Particles, entry: &HiddenContact) -> Option<Meeting> {
    let [i, j] = slots(particles, entry);
    let (x, y) = (particles.position[i], particles.position[j]);
    let (apart, reach) = (Vector::from(x) - Vector::from(y), x[3] + y[3]);
    if apart.dot(apart) >= reach * reach {
        return None;
    }
    let (v, w) = (&particles.velocity, &particles.angular_velocity);
    let at = |y| SpherePair::of([x, y]).meet([v[i], v[j]], [w[i], w[j]], entry.pair_constant);
    let batch::ContactGeometry { contact, first_arm, second_arm } = at(y);
    let [a, b, c] = (Vector::from(x) - contact.normal * (reach - entry.offset.min(contact.overlap))).to_array();
    Some(Meeting { contact, offset: at([a, b, c, y[3]]).contact, first_arm, second_arm })
}

/// The slots of the two particles of an entry.
fn slots(particles: &Particles, entry: &HiddenContact) -> [usize; 2] {
    [entry.first, entry.second.unwrap_or(entry.first)].map(|index| particles.slot[index as usize] as usize)
}

impl ContactPass {
    /// The coefficients of the two particles of an entry.
    fn row_of(&self, particles: &Particles, entry: &HiddenContact) -> &[f64] {
        let [i, j] = slots(particles, entry);
        self.table.row(particles.material[i], particles.material[j])
    }

    /// Adds what hidden contacts do, in a time step of this length \[s\].
    pub(crate) fn apply_hidden(&self, state: &mut State, step: f64) {
        let State { particles, hidden, .. } = state;
        let (Some(list), Some(active)) = (hidden.pairs.get_mut(self.index), hidden.active.get(self.index)) else {
            return;
        };
        for &place in active {
            let Some(entry) = list.get_mut(place as usize) else { continue };
            let Some(meeting) = pair(particles, entry) else {
                part(entry, step);
                continue;
            };
            let Some(reaction) = react(&self.law.law, entry, &meeting, self.row_of(particles, entry), step) else {
                continue;
            };
            let [i, j] = slots(particles, entry);
            add(&mut particles.force[i], reaction.force, 1.0);
            add(&mut particles.force[j], reaction.force, -1.0);
            if self.law.needs.torque {
                add(&mut particles.torque[i], reaction.couple, -meeting.first_arm);
                add(&mut particles.torque[j], reaction.couple, -meeting.second_arm);
                add(&mut particles.torque[i], reaction.rolling, -1.0);
                add(&mut particles.torque[j], reaction.rolling, 1.0);
            }
        }
    }

    /// Finds the pair constants of hidden contacts.
    pub(crate) fn prepare_hidden(&self, state: &mut State) {
        let particles = &state.particles;
        for entry in state.hidden.pairs.get_mut(self.index).into_iter().flatten() {
            let [i, j] = slots(particles, entry).map(|slot| slot as u32);
            let (radius, mass) = effective(particles, i, j);
            entry.pair_constant = self.law.law.pair_constant(self.row_of(particles, entry), radius, mass);
        }
    }

    /// Tells the stiffness of hidden contacts, as far as they act.
    pub(crate) fn hidden_stiffness(&self, state: &State, ahead: &Ahead, tell: &mut dyn FnMut(Link)) {
        let particles = &state.particles;
        for entry in state.hidden.pairs.get(self.index).into_iter().flatten().filter(|entry| !entry.is_silent()) {
            let Some(Meeting { contact, first_arm, second_arm, .. }) = pair(particles, entry) else { continue };
            let law = &self.law.law;
            let row = self.row_of(particles, entry);
            let [i, j] = slots(particles, entry).map(|slot| slot as u32);
            let deep = ahead.between(law, row, &contact, particles, [i, j]).unwrap_or(contact);
            let Some(response) = stiffness(law, entry, &deep, row) else { continue };
            let link = Link::of_contact((i, Some(j), None), (law, row), &deep, [first_arm, second_arm]);
            tell(link.with_normal(&response));
        }
    }

    /// Tells the records of hidden contacts, as far as they act.
    pub(crate) fn hidden_records(&self, state: &State, tell: &mut dyn FnMut(ContactRecord)) {
        for entry in state.hidden.pairs.get(self.index).into_iter().flatten().filter(|entry| entry.is_told()) {
            let Some(Meeting { contact, first_arm, .. }) = pair(&state.particles, entry) else { continue };
            let [i, _] = slots(&state.particles, entry);
            let point = Vector::from(state.particles.position[i]) - contact.normal * first_arm;
            let reaction = remembered(entry);
            tell(ContactRecord::new((entry.first, entry.second), None, point, &contact, &reaction, reaction.sliding));
        }
    }

    /// Elastic energy of hidden contacts \[J\].
    pub(crate) fn hidden_energy(&self, state: &State) -> f64 {
        let particles = &state.particles;
        let entries = state.hidden.pairs.get(self.index).into_iter().flatten().filter(|entry| !entry.is_silent());
        let energy = |entry| {
            let meeting = pair(particles, entry)?;
            Some(elastic_energy(&self.law.law, entry, &meeting.contact, self.row_of(particles, entry)))
        };
        entries.filter_map(energy).sum()
    }
}

/// A particle at a plane, if it touches.
fn at_plane(plane: &Plane, particles: &Particles, entry: &HiddenContact) -> Option<Meeting> {
    let [slot, _] = slots(particles, entry);
    let position = particles.position[slot];
    if plane.distance(position) > position[3] {
        return None;
    }
    let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
    let at = |position| plane.meet(position, velocity, spin, entry.pair_constant);
    let batch::ContactGeometry { contact, first_arm, .. } = at(position);
    let raised = contact.overlap - entry.offset.min(contact.overlap);
    let [a, b, c] = (Vector::from(position) + plane.normal * raised).to_array();
    Some(Meeting { contact, offset: at([a, b, c, position[3]]).contact, first_arm, second_arm: 0.0 })
}

impl WallPass {
    /// The coefficients of the particle of an entry at this plane.
    fn row_of(&self, particles: &Particles, entry: &HiddenContact) -> &[f64] {
        let [slot, _] = slots(particles, entry);
        self.table.row(particles.material[slot], self.material)
    }

    /// Adds what hidden contacts do, in a time step of this length \[s\]. Returns a particle (slot) whose centre is
    /// behind the plane.
    pub(crate) fn apply_hidden(&self, state: &mut State, step: f64) -> Option<u32> {
        let plane = self.plane(state);
        let boundary = state.walls[self.index].boundary as usize;
        let reference = self.reference + state.boundaries[boundary].displacement.into();
        let (particles, boundary) = (&mut state.particles, &mut state.boundaries[boundary]);
        let mut behind = None;
        for entry in state.hidden.planes.get_mut(self.index).into_iter().flatten() {
            let [slot, _] = slots(particles, entry);
            if plane.distance(particles.position[slot]) < 0.0 {
                behind = behind.or(Some(slot as u32));
            }
            let Some(meeting) = at_plane(&plane, particles, entry) else {
                part(entry, step);
                continue;
            };
            let Some(reaction) = react(&self.law.law, entry, &meeting, self.row_of(particles, entry), step) else {
                continue;
            };
            let point = Vector::from(particles.position[slot]) - plane.normal * meeting.first_arm;
            let moment = reaction.rolling - (point - reference).cross(reaction.force);
            add(&mut particles.force[slot], reaction.force, 1.0);
            if self.law.needs.torque {
                add(&mut particles.torque[slot], reaction.couple, -meeting.first_arm);
                add(&mut particles.torque[slot], reaction.rolling, -1.0);
            }
            for axis in 0..3 {
                boundary.force[axis] -= reaction.force.to_array()[axis];
                boundary.moment[axis] += moment.to_array()[axis];
            }
        }
        behind
    }

    /// Finds the pair constants of hidden contacts.
    pub(crate) fn prepare_hidden(&self, state: &mut State) {
        let particles = &state.particles;
        for entry in state.hidden.planes.get_mut(self.index).into_iter().flatten() {
            let [slot, _] = slots(particles, entry);
            let (radius, mass) = (particles.position[slot][3], particles.velocity[slot][3]);
            entry.pair_constant = self.law.law.pair_constant(self.row_of(particles, entry), radius, mass);
        }
    }

    /// Tells the stiffness of hidden contacts, as far as they act.
    pub(crate) fn hidden_stiffness(&self, state: &State, ahead: &Ahead, tell: &mut dyn FnMut(Link)) {
        let particles = &state.particles;
        for entry in state.hidden.planes.get(self.index).into_iter().flatten() {
            let Some(Meeting { contact, first_arm, .. }) = at_plane(&self.plane(state), particles, entry) else {
                continue;
            };
            let law = &self.law.law;
            let (row, speed) = (self.row_of(particles, entry), self.plane(state).velocity.length());
            let deep =
                ahead.at_boundary(law, row, &contact, speed, state.walls[self.index].boundary).unwrap_or(contact);
            let Some(response) = stiffness(law, entry, &deep, row) else { continue };
            let bodies = (slots(particles, entry)[0] as u32, None, Some(state.walls[self.index].boundary));
            let link = Link::of_contact(bodies, (law, row), &deep, [first_arm, 0.0]);
            tell(link.with_normal(&response));
        }
    }

    /// Tells the records of hidden contacts, as far as they act.
    pub(crate) fn hidden_records(&self, state: &State, tell: &mut dyn FnMut(ContactRecord)) {
        let boundary = Some(state.walls[self.index].boundary);
        for entry in state.hidden.planes.get(self.index).into_iter().flatten().filter(|entry| entry.is_told()) {
            let Some(Meeting { contact, first_arm, .. }) = at_plane(&self.plane(state), &state.particles, entry) else {
                continue;
            };
            let [slot, _] = slots(&state.particles, entry);
            let point = Vector::from(state.particles.position[slot]) - contact.normal * first_arm;
            let reaction = remembered(entry);
            tell(ContactRecord::new((entry.first, None), boundary, point, &contact, &reaction, reaction.sliding));
        }
    }

    /// Elastic energy of hidden contacts \[J\].
    pub(crate) fn hidden_energy(&self, state: &State) -> f64 {
        let (plane, particles) = (self.plane(state), &state.particles);
        let entries = state.hidden.planes.get(self.index).into_iter().flatten();
        let energy = |entry| {
            let meeting = at_plane(&plane, particles, entry)?;
            Some(elastic_energy(&self.law.law, entry, &meeting.contact, self.row_of(particles, entry)))
        };
        entries.filter_map(energy).sum()
    }
}
