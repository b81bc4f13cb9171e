//! Records of the present contacts and bonds, for outputs.

use crate::base::number::Vector;
use crate::engine::bodies::kick_at;
use crate::engine::integration::kick;
use crate::engine::state::contacts::SLIDING;
use crate::engine::state::{BoundaryState, History, Row, State};
use crate::laws::bond::BondLoads;
use crate::laws::contact::{Contact, Law, MOST_HISTORY, Reaction};

/// One contact at work, as it was when the present forces were evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRecord {
    /// The particle: index into the scene's particles.
    pub first: u32,
    /// The other particle, unless it is a plane.
    pub second: Option<u32>,
    /// The plane: index into the scene's boundaries.
    pub boundary: Option<u32>,
    /// Where they touch \[m\].
    pub point: [f64; 3],
    /// Unit normal, from the other body to the first particle.
    pub normal: [f64; 3],
    /// Overlap \[m\].
    pub overlap: f64,
    /// Force along the normal on the first particle, cohesion included \[N\].
    pub normal_force: f64,
    /// Force in the tangent plane on the first particle \[N\].
    pub tangential_force: [f64; 3],
    /// Whether the tangential spring is at its limit.
    pub sliding: bool,
}

/// One living bond and what it carries at the present time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondRecord {
    /// Its law: index into the scene's bond laws.
    pub law: u32,
    /// Body i: index into the scene's particles.
    pub first: u32,
    /// Body j: index into the scene's particles; none where it is the law's plane.
    pub second: Option<u32>,
    /// Where body i is \[m\].
    pub position: [f64; 3],
    /// Where body j is, or the foot of the bond on the plane \[m\].
    pub other: [f64; 3],
    /// Force on body i, that of damping included \[N\].
    pub force: [f64; 3],
    /// Forces, torques, stresses and energy.
    pub carried: BondLoads,
    /// Energy that damping and relaxation took of it so far \[J\].
    pub dissipated: f64,
}

impl BondRecord {
    /// Whether it is a bond of these two of the scene's particles, in this order.
    pub fn joins(&self, [i, j]: [u32; 2]) -> bool {
        self.first == i && self.second == Some(j)
    }
}

impl ContactRecord {
    /// The record of a contact and what it does.
    pub(crate) fn new(
        (first, second): (u32, Option<u32>),
        boundary: Option<u32>,
        point: Vector,
        contact: &Contact,
        reaction: &Reaction,
        sliding: bool,
    ) -> Self {
        let along = reaction.force.dot(contact.normal);
        Self {
            first,
            second,
            boundary,
            point: point.to_array(),
            normal: contact.normal.to_array(),
            overlap: contact.overlap,
            normal_force: along,
            tangential_force: (reaction.force - contact.normal * along).to_array(),
            sliding,
        }
    }
}

/// When the motion of bodies is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Motion {
    /// Now.
    Present,
    /// At the middle of the last time step, of this length \[s\], when forces were evaluated.
    HalfStepBack(f64),
}

impl Motion {
    /// What the last half kick added to the velocity and the angular velocity of a surface, if it is looked at before.
    pub(crate) fn kick_of(self, boundary: &BoundaryState) -> [Vector; 2] {
        match self {
            Self::Present => [Vector::zero(); 2],
            Self::HalfStepBack(_) => [boundary.inertial.kick.into(), boundary.inertial.spin_kick.into()],
        }
    }

    /// Velocity with mass and angular velocity with moment of inertia of a particle then.
    pub(crate) fn of(self, state: &State, slot: u32) -> (Row, Row) {
        let (particles, slot) = (&state.particles, slot as usize);
        // An image moves as its particle does; its own rows are those of the last evaluation.
        let original = particles.original(slot as u32) as usize;
        let (mut velocity, mut spin) = (particles.velocity[original], particles.angular_velocity[original]);
        if let Some(cell) = &state.cell {
            let stream = cell.streaming_at(state.carried_point(slot));
            velocity.iter_mut().zip(stream).for_each(|(sum, part)| *sum += part);
        }
        let Self::HalfStepBack(step) = self else { return (velocity, spin) };
        if let Some([kick, twist]) = kick_at(state, original, step).map(|kick| kick.map(Vector::to_array)) {
            for axis in 0..3 {
                velocity[axis] -= kick[axis];
                spin[axis] -= twist[axis];
            }
        } else {
            let (force, torque) = (particles.force[original], particles.torque[original]);
            let (shift, twist) = (kick(&velocity, &force, 0.5 * step), kick(&spin, &torque, 0.5 * step));
            for axis in 0..3 {
                velocity[axis] -= shift * force[axis];
                spin[axis] -= twist * torque[axis];
            }
        }
        (velocity, spin)
    }
}

/// What a law remembers of an entry of a list; rows that it does not have are zero.
pub(crate) fn history(kept: &History, entry: usize) -> [Row; MOST_HISTORY] {
    let mut rows = [[0.0; 4]; MOST_HISTORY];
    for (row, kept) in rows.iter_mut().zip(kept.get(entry)) {
        *row = *kept;
    }
    rows
}

/// A contact in the motion that the records of its law show, as its dashpots saw it, if that is remembered.
pub(crate) fn seen(law: &Law, mut contact: Contact, kept: &History, entry: usize) -> Contact {
    // Where records were not asked for until now, nothing is remembered yet. Springs do not grow in records: here slip is what the
    // dashpot sees.
    match law.history_places().seen.and_then(|place| kept.get(entry).get(place)) {
        Some(&[velocity, x, y, z]) if law.scheme().carries() && [velocity, x, y, z] != [0.0; 4] => {
            (contact.normal_velocity, contact.slip) = (velocity, Vector::new(x, y, z));
        }
        Some(&[velocity, weight, 1.0, _]) if !law.scheme().carries() => {
            (contact.normal_velocity, contact.slip) = (velocity, contact.slip * weight);
        }
        _ => {}
    }
    contact
}

/// What a contact does, with what the last evaluation left to remember. A spring that slid then has no dashpot beside
/// it, unless both stand at the limit together.
pub(crate) fn react(
    law: &Law,
    row: &[f64],
    contact: &Contact,
    kept: &History,
    entry: usize,
    flags: u8,
) -> (Reaction, bool) {
    let sliding = flags & SLIDING != 0;
    let mut contact = *contact;
    if sliding && law.spring().is_some() && !law.limits_dashpot() {
        contact.slip = Vector::zero();
    }
    (law.react(row, &mut contact, &mut history(kept, entry), 0.0), sliding)
}

/// The spring of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedSpring {
    /// The bodies: indices into the scene's particles.
    pub bodies: [u32; 2],
    /// Tangential spring, as the first sees the second \[m\].
    pub spring: [f64; 3],
    /// Overlap from which the normal force is taken, of a contact that a bond suppresses or has suppressed \[m\].
    pub offset: f64,
}
