//! What a law does to one contact: its sub-models, called one after another.

use super::Law;
use crate::base::number::{Row, Vector};
#[cfg(test)]
use crate::laws::contact::pressing_force;
use crate::laws::contact::{Carry, Contact, HistoryPlaces, NormalForce, Reaction, foresee_normal};

/// How much of a contact is left where a bond suppresses it, or has suppressed it.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub struct Offset {
    /// Overlap beyond the offset: what the elastic force is taken from \[m\].
    pub pressing: f64,
    /// Whether the normal force acts. Friction sees it in either case.
    pub acts: bool,
    /// The contact of these bodies at an overlap of the offset alone.
    pub contact: Contact,
}

impl Law {
    /// Force and torque of one contact; `history`, as many rows as [`Law::history`], is advanced by `step` \[s\]. The velocities
    /// of `contact` become those that its dashpots see.
    pub fn react(&self, row: &[f64], contact: &mut Contact, history: &mut [Row], step: f64) -> Reaction {
        let (carry, weight) = self.carry(contact, history, step);
        let normal = self.press(row, contact, history, (step, weight));
        if self.is_apart(contact.overlap) {
            self.history_places.of_touch().for_each(|place| history[place] = [0.0; 4]);
            let nothing = Vector::zero();
            return Reaction {
                force: contact.normal * normal.force,
                couple: nothing,
                rolling: nothing,
                sliding: false,
            };
        }
        let along = (&normal, normal.force);
        let (force, couple, sliding) = self.friction(row, contact, along, history, (step, &carry));
        let rolling = self.roll(row, contact, &normal, history, (step, &carry));
        Reaction { force, couple, rolling, sliding }
    }

    /// The normal force of one contact that was carried, with this weight of γ_t.
    fn press(&self, row: &[f64], contact: &Contact, history: &mut [Row], (step, weight): (f64, f64)) -> NormalForce {
        let HistoryPlaces { normal: own, cohesion, .. } = self.history_places;
        let mut none = [0.0; 4];
        let remembered = own.map_or(&mut none, |place| &mut history[place]);
        let mut normal = (self.normal().force)(row, contact, remembered, step);
        normal.response.tangential_damping *= weight;
        if self.has_cohesion() {
            let mut none = [0.0; 4];
            let remembered = cohesion.map_or(&mut none, |place| &mut history[place]);
            (self.cohesion().pull)(&row[self.places.cohesion..], contact, remembered, step, &mut normal);
        }
        normal
    }

    /// The same of a contact that a bond suppresses, or has suppressed. The elastic force is taken from the overlap beyond the
    /// offset, and attraction is what the offset's does not hold already, so that neither jumps when the bond is
    /// gone; stiffness and damping are those of the whole overlap. Where the normal force does not act, friction
    /// alone does. For tests: what batches of such contacts are compared with.
    #[cfg(test)]
    pub fn react_beyond(
        &self,
        row: &[f64],
        contact: &Contact,
        offset: &Offset,
        history: &mut [Row],
        step: f64,
    ) -> Reaction {
        let mut contact = *contact;
        let (carry, weight) = self.carry(&mut contact, history, step);
        let contact = &contact;
        let (response, switches) = ((self.normal().response)(row, contact), self.switches(row));
        let mut normal = pressing_force(response, switches, offset.pressing, contact.normal_velocity);
        normal.response.tangential_damping *= weight;
        if self.has_cohesion() {
            let (row, cohesion) = (&row[self.places.cohesion..], self.cohesion());
            let pull = (cohesion.force)(row, contact) - (cohesion.force)(row, &offset.contact);
            (cohesion.add)(row, pull, &mut normal);
        }
        let along = if offset.acts { normal.force } else { 0.0 };
        let (force, couple, sliding) = self.friction(row, contact, (&normal, along), history, (step, &carry));
        let pressed = Contact { overlap: offset.pressing, ..*contact };
        let rolling =
            if offset.acts { self.roll(row, &pressed, &normal, history, (step, &carry)) } else { Vector::zero() };
        Reaction { force, couple, rolling, sliding }
    }

    /// How a contact was carried, where the scheme asks for it, and a weight of γ_t; it gets the velocities that dashpots see, and the
    /// slip of undeformed bodies where the law takes that.
    fn carry(&self, contact: &mut Contact, history: &mut [Row], step: f64) -> (Option<Carry>, f64) {
        if self.undeformed_arms() {
            *contact = contact.with_undeformed_arms();
        }
        if let Some(place) = self.history_places.normal_velocity {
            let foreseen = foresee_normal(contact, history[place][3], self.onset(), step);
            history[place][3] = foreseen.middle;
            if let Some(place) = self.history_places.seen {
                history[place] = [contact.normal_velocity, foreseen.weight, 1.0, 0.0];
            }
            return (None, foreseen.weight);
        }
        if !self.scheme().carries() {
            return (None, 1.0);
        }
        let carry = Carry::of(contact, step, !self.pulls_beyond_touch());
        let mut rates = [contact.normal_velocity, 0.0];
        if let Some(place) = self.history_places.rates {
            let before = history[place][0];
            history[place] = carry.foresee(contact, history[place], step);
            rates = [history[place][0], before];
        }
        carry.weigh(contact, self.onset(), step, rates);
        if let Some(place) = self.history_places.seen {
            let Vector { x, y, z } = contact.slip;
            history[place] = [contact.normal_velocity, x, y, z];
        }
        (Some(carry), 1.0)
    }

    /// Force on i of a normal force \[N\] and the friction beside it, n × F_t, and whether friction is at its limit.
    fn friction(
        &self,
        row: &[f64],
        contact: &Contact,
        (normal, along): (&NormalForce, f64),
        history: &mut [Row],
        (mut step, carry): (f64, &Option<Carry>),
    ) -> (Vector, Vector, bool) {
        let force = contact.normal * along;
        if !self.has_friction() {
            return (force, Vector::zero(), false);
        }
        let mut none = [0.0; 4];
        let remembered = self.history_places.tangential.map_or(&mut none, |place| &mut history[place]);
        if let Some(carry) = carry.as_ref().filter(|_| self.tangential().has_spring) {
            (*remembered, step) = (carry.spring(contact.normal, *remembered), 0.0);
        }
        let row = &row[self.places.tangential..];
        let (friction, sliding) = (self.tangential().force)(row, contact, normal, remembered, step);
        (force + friction, contact.normal.cross(friction), sliding)
    }

    /// Rolling torque from i to j.
    fn roll(
        &self,
        row: &[f64],
        contact: &Contact,
        normal: &NormalForce,
        history: &mut [Row],
        (mut step, carry): (f64, &Option<Carry>),
    ) -> Vector {
        if !self.has_rolling() {
            return Vector::zero();
        }
        let place = self.history_places.rolling;
        let mut none = [0.0; 4];
        let remembered = place.map_or(&mut none, |place| &mut history[place]);
        let (mut contact, mut pressed) = (*contact, *normal);
        let carry = carry.as_ref().filter(|_| place.is_some());
        if let Some(carry) = carry {
            pressed = carry.mean_stiffness(normal, remembered[3]);
            *remembered = carry.torque(contact.normal, *remembered);
            (contact.relative_spin, step) = (carry.to_end(contact.normal, contact.relative_spin), step * carry.share);
        }
        let torque = (self.rolling().torque)(&row[self.places.rolling..], &contact, &pressed, remembered, step);
        if carry.is_some() {
            remembered[3] = normal.response.normal_stiffness;
        }
        torque
    }
}
