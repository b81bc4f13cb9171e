//! What the contacts with features are, for those who ask: stiffness, records, energies.

use super::standing::{MovingSurface, SphereOnSurface};
use super::{constant, parts};
use crate::base::number::Vector;
use crate::engine::contacts::ahead::{Kind, Link, SearchLimits};
use crate::engine::contacts::batches::ContactGeometry;
use crate::engine::contacts::encounters::Encounters;
use crate::engine::contacts::records::{self, ContactRecord, Motion};
use crate::engine::contacts::surfaces::AtSurface;
use crate::engine::state::contacts::TOUCHING;
use crate::engine::state::{Row, State};
use crate::laws::contact::{MOST_HISTORY, Reaction};
use crate::laws::surface::{Feet, Foot, NodeWeights};

/// Stiffness of a contact that a sphere has all around an axis over that along its normal, in any direction, at most: near the axis
/// the force turns by 8 F δ⁻¹ for each length, and no law's F is above k δ.
const AROUND: f64 = 8.0;

impl AtSurface {
    /// Hands out the contacts of the last evaluation: entry of the list, foot, its share of friction, contact.
    fn each(&self, state: &State, motion: Motion, hand: impl FnMut(usize, &Foot, f64, &ContactGeometry)) {
        // A face without area has been told when forces were evaluated.
        let _ = self.follow(state);
        let boundary = self.list(state).boundary as usize;
        let standing = (&state.boundaries[boundary], state.nodes_of(boundary));
        let [kick, twist] = motion.kick_of(standing.0);
        MovingSurface::with(self, standing, |at| self.each_at(&at.before(kick, twist), state, motion, hand));
    }

    /// The same where it stands.
    fn each_at(
        &self,
        at: &MovingSurface,
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
            let stand = SphereOnSurface { at, body: [position, velocity, spin], row, constant };
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

    /// Tells the stiffness of the contacts with features, and of those to come where forces move the surface: a light one may meet many
    /// particles at once.
    pub(in crate::engine::contacts::surfaces) fn stiffness_at_features(
        &self,
        state: &State,
        ahead: &SearchLimits,
        tell: &mut dyn FnMut(Link),
    ) {
        let (list, law) = (self.list(state), &self.law.law);
        let bent = state.nodes_of(list.boundary as usize).map_or(0.0, |nodes| nodes.fastest);
        let speed = Vector::from(state.boundaries[list.boundary as usize].velocity).length() + bent;
        let link =
            |slot: u32, slope: f64, ContactGeometry { contact, first_arm, .. }: &ContactGeometry, touches: bool| {
                let row = self.row(state, slot);
                let particle = Vector::from(state.particles.velocity[slot as usize]);
                let deepest = ahead.at_boundary((law, row, contact), (particle, speed), list.boundary);
                let deep = deepest.or(touches.then_some(*contact))?;
                let bodies = (slot, None, Some(list.boundary));
                let mut link = Link::of_contact(bodies, (law, row), &deep, [*first_arm, 0.0]);
                if slope != 1.0 {
                    link.stiffness[0] *= AROUND;
                    link.stiffness[1] += link.stiffness[0];
                }
                link.kind = if touches { Kind::Contact } else { Kind::ComingContact };
                Some(link)
            };
        self.each(state, Motion::Present, |entry, foot, _, geometry| {
            // A saddle only takes away from what its faces have.
            if foot.weight > 0.0 {
                link(list.particle[entry], foot.slope, geometry, true).into_iter().for_each(&mut *tell);
            }
        });
        if !ahead.moves(list.boundary) {
            return;
        }
        let standing = (&state.boundaries[list.boundary as usize], state.nodes_of(list.boundary as usize));
        MovingSurface::with(self, standing, |at| {
            let mut feet = Feet::default();
            for (place, &slot) in list.near.particle.iter().enumerate() {
                if list.particle.binary_search(&slot).is_err()
                    && let Some((slope, geometry)) = self.nearest(&at, state, (place, slot), &mut feet)
                {
                    link(slot, slope, &geometry, false).into_iter().for_each(&mut *tell);
                }
            }
        });
    }

    /// How a particle (slot) at a place of the list of near ones meets what is nearest to it, and the slope there; none where nothing is.
    fn nearest(
        &self,
        at: &MovingSurface,
        state: &State,
        (place, slot): (usize, u32),
        feet: &mut Feet,
    ) -> Option<(f64, ContactGeometry)> {
        let list = self.list(state);
        let position = state.particles.position[slot as usize];
        let (velocity, spin) = Motion::Present.of(state, slot);
        feet.clear();
        let reach = position[3] + state.neighbours.skin;
        at.features.feet(at.frame.inside(Vector::from(position)), reach, parts(list, place), feet);
        let nearest = feet.list.iter().filter(|foot| foot.weight > 0.0);
        let foot = nearest.reduce(|near, next| if next.distance < near.distance { next } else { near })?;
        let (row, constant) = (self.row(state, slot), constant(list, place));
        Some((foot.slope, SphereOnSurface { at, body: [position, velocity, spin], row, constant }.meet(foot)))
    }

    /// Tells the contacts with features as they were in the last evaluation, after a time step of this length \[s\].
    pub(in crate::engine::contacts::surfaces) fn records_at_features(
        &self,
        state: &State,
        step: f64,
        tell: &mut dyn FnMut(ContactRecord),
    ) {
        let (list, law, particles) = (self.list(state), &self.law.law, &state.particles);
        self.each(state, Motion::HalfStepBack(step), |entry, foot, share, geometry| {
            let (slot, contact) = (list.particle[entry], &records::seen(law, geometry.contact, &list.history, entry));
            let (row, flags) = (self.row(state, slot), list.flags[entry]);
            let (reaction, sliding) = records::react(law, row, contact, &list.history, entry, flags);
            let along = contact.normal * reaction.force.dot(contact.normal);
            let force = along * (foot.weight * foot.slope) + (reaction.force - along) * share;
            let point = Vector::from(particles.position[slot as usize]) - contact.normal * geometry.first_arm;
            let (ids, boundary) = ((particles.id[slot as usize], None), Some(list.boundary));
            tell(ContactRecord::new(ids, boundary, point, contact, &Reaction { force, ..reaction }, sliding));
        });
    }

    /// Adds the energies of contacts with features at work and to come. A particle touches the whole surface where it is deepest.
    pub(in crate::engine::contacts::surfaces) fn encounters_at_features(&self, state: &State, found: &mut Encounters) {
        let boundary = self.list(state).boundary as usize;
        let standing = (&state.boundaries[boundary], state.nodes_of(boundary));
        MovingSurface::with(self, standing, |at| self.encounters_at(&at, state, found));
    }

    /// The same where it stands.
    fn encounters_at(&self, at: &MovingSurface, state: &State, found: &mut Encounters) {
        let (list, law, mut feet) = (self.list(state), &self.law.law, Feet::default());
        let mut energies = found.energies;
        for (place, &slot) in list.near.particle.iter().enumerate() {
            let touches = || list.particle.binary_search(&slot).is_ok();
            let Some(meeting) = found.meeting(state, (slot, None), touches) else { continue };
            if let Some((_, geometry)) = self.nearest(at, state, (place, slot), &mut feet) {
                let row = self.row(state, slot);
                let bodies = (slot, None, Some(list.boundary));
                found.add(&mut energies, meeting, (law, row, &geometry.contact), state, bodies);
            }
        }
        found.energies = energies;
    }

    /// Elastic energy of the contacts with features \[J\].
    pub(in crate::engine::contacts::surfaces) fn energy_at_features(&self, state: &State) -> f64 {
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
    pub(in crate::engine::contacts::surfaces) fn held_at_features(&self, state: &State) -> [f64; 3] {
        let (list, law, mut held) = (self.list(state), &self.law.law, [0.0; 3]);
        if !law.has_rolling() && law.presses() {
            return held;
        }
        let own = if law.is_plastic() { 2 } else { 1 };
        self.each(state, Motion::Present, |entry, foot, share, ContactGeometry { contact, .. }| {
            let (row, history) = (self.row(state, list.particle[entry]), records::history(&list.history, entry));
            held[0] += share * law.rolling_energy(row, contact, &history);
            if !law.presses() {
                held[own] += foot.weight * law.normal_energy(row, contact, 0.0, &history);
            }
        });
        held
    }

    /// Tells the particle (slot), the overlap \[m\] and the weight of each contact with a feature that has one of these flags, and what
    /// the nodes around its foot give, where these have temperatures.
    pub(in crate::engine::contacts::surfaces) fn touched_at_features(
        &self,
        (state, flags): (&State, u8),
        mut tell: impl FnMut(u32, f64, f64, &[NodeWeights]),
    ) {
        // No bond suppresses a contact with a feature.
        if flags & TOUCHING == 0 {
            return;
        }
        let _ = self.follow(state);
        let (list, mut grips) = (self.list(state), Vec::new());
        let boundary = list.boundary as usize;
        let are_warm = state.heat.as_ref().is_some_and(|heat| heat.nodes_of(boundary).is_some());
        let standing = (&state.boundaries[boundary], state.nodes_of(boundary));
        MovingSurface::with(self, standing, |at| {
            self.each_at(&at, state, Motion::Present, |entry, foot, _, ContactGeometry { contact, .. }| {
                let slot = list.particle[entry];
                grips.clear();
                if let Some(moving) = at.moving.as_ref().filter(|_| are_warm) {
                    let centre = at.frame.inside(Vector::from(state.particles.position[slot as usize]));
                    moving.shape.grips(foot.feature, centre - foot.normal * foot.distance, &mut grips);
                }
                tell(slot, contact.overlap, foot.weight, &grips);
            });
        });
    }

    /// Largest overlap with a feature over the radius of the particle.
    pub(in crate::engine::contacts::surfaces) fn largest_overlap(&self, state: &State) -> f64 {
        let mut largest = 0.0_f64;
        self.each(state, Motion::Present, |_, foot, _, ContactGeometry { contact, .. }| {
            if foot.weight > 0.0 {
                largest = largest.max(contact.overlap / contact.radius);
            }
        });
        largest
    }
}
