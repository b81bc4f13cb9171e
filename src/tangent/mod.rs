//! How the state changes with a few inputs: slopes that are carried through time steps beside it.
//!
//! Slopes have the places of what they belong to, row by row. What no input has reached yet has none and is passed over.

mod boundary;
mod group;
mod list;
mod motion;
mod particles;
pub(crate) mod rotation;
mod rows;

pub(crate) use boundary::BoundarySlopes;
pub(crate) use group::Group;
pub(crate) use list::ListSlopes;
pub(crate) use particles::{Moving, ParticleSlopes};
pub(crate) use rows::{alone, row_of, rows_at, slopes_of, spread, sum, vector_of, vector_slopes, with_slopes};

use crate::dual::Dual;
use crate::geometry::Quaternion;
use crate::lanes::Width;
use crate::number::Vector;
use crate::state::State;

/// How everything that changes does so with some inputs.
pub(crate) struct Tangent {
    /// Of particles.
    pub particles: ParticleSlopes,
    /// Of what contacts between particles remember, a list for each law.
    pub contacts: Vec<ListSlopes>,
    /// Of what contacts with surfaces remember, a list for each surface and law.
    pub walls: Vec<ListSlopes>,
    /// Of the rows of bonds, a list for each law.
    pub bonds: Vec<ListSlopes>,
    /// Of boundaries.
    pub boundaries: Vec<BoundarySlopes>,
    /// Registers that slopes are worked on in.
    pub width: Width,
    /// The time step in which the lists had been made whose order this follows.
    made_at: u64,
}

/// A pass of a time step that slopes by some inputs go through.
pub(crate) trait FollowPass {
    /// Adds the slopes of its forces and torques to those of the particles and boundaries, as the pass is about to find them
    /// after a time step of this length \[s\], and brings those of what it remembers to the present.
    fn add_slopes(&self, state: &State, tangent: &mut Tangent, step: Dual);
}

/// A pass whose slopes are added to those of the particles and boundaries: the work of a kernel.
pub(crate) struct AddSlopes<'a, P> {
    /// The pass.
    pub pass: P,
    /// The state.
    pub state: &'a State,
    /// How it changes.
    pub tangent: &'a mut Tangent,
    /// The time step, or time itself.
    pub step: Dual,
}

impl Tangent {
    /// Nothing changes yet. `turning` says whether torques turn the particles.
    pub(crate) fn of(state: &State, width: Width, turning: bool) -> Self {
        let mut tangent = Self {
            particles: ParticleSlopes::of(&state.particles, turning),
            contacts: state.contacts.iter().map(|list| ListSlopes::of(list.history.rows())).collect(),
            walls: state.walls.iter().map(|list| ListSlopes::of(list.history.rows())).collect(),
            bonds: state.bonds.iter().map(|list| ListSlopes::of(list.rows.len() + list.rate_columns().len())).collect(),
            boundaries: state.boundaries.iter().map(|_| BoundarySlopes::default()).collect(),
            width,
            made_at: state.neighbours.made_at,
        };
        tangent.follow_lists(state);
        tangent
    }

    /// Takes over the order of the particles and lists where they have been made anew.
    pub(crate) fn follow(&mut self, state: &State) {
        if self.made_at != state.neighbours.made_at {
            self.made_at = state.neighbours.made_at;
            self.particles.follow(&state.particles);
            self.follow_lists(state);
        }
    }

    /// Takes over the order of the lists.
    fn follow_lists(&mut self, state: &State) {
        let id = |slot: u32| state.particles.id[slot as usize];
        for (slopes, list) in self.contacts.iter_mut().zip(&state.contacts) {
            slopes.follow(list.first.iter().zip(&list.second).map(|(&i, &j)| [id(i), id(j)]));
        }
        for (slopes, list) in self.walls.iter_mut().zip(&state.walls) {
            let feature = |entry: usize| list.feature.get(entry).copied().unwrap_or(0);
            slopes.follow(list.particle.iter().enumerate().map(|(entry, &slot)| [id(slot), feature(entry)]));
        }
        self.follow_bonds(state);
    }

    /// Takes over which bonds there are, and in which order.
    pub(crate) fn follow_bonds(&mut self, state: &State) {
        let id = |slot: u32| state.particles.id[slot as usize];
        for (slopes, list) in self.bonds.iter_mut().zip(&state.bonds) {
            let second = |bond: usize| list.second.get(bond).map_or(u32::MAX, |&slot| id(slot));
            slopes.follow(list.first.iter().enumerate().map(|(bond, &slot)| [id(slot), second(bond)]));
        }
    }
}

impl Tangent {
    /// Everything goes on in time: time itself is what is followed.
    pub(crate) fn go_on(&mut self, state: &State) {
        let (slopes, particles) = (&mut self.particles, &state.particles);
        for slot in 0..particles.len() {
            let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
            for axis in 0..3 {
                slopes.position[slot][axis] = velocity[axis];
                if particles.owner[slot] == 0 {
                    slopes.velocity[slot][axis] = particles.force[slot][axis] / velocity[3];
                    slopes.spin[slot][axis] = particles.torque[slot][axis] / spin[3];
                }
            }
            if let Some(row) = slopes.orientation.get_mut(slot) {
                let orientation = Quaternion::from_row(particles.orientation[slot].map(Dual::constant));
                let turned = orientation.turned(Vector::of_row(spin.map(Dual::constant)), PASSING);
                *row = row_of(turned.to_row());
            }
        }
        slopes.is_reached.fill(true);
        for (slopes, boundary) in self.boundaries.iter_mut().zip(&state.boundaries) {
            slopes.displacement = boundary.velocity.map(|velocity| [velocity]);
        }
    }
}

/// Time as what is followed.
pub(crate) const PASSING: Dual = Dual { value: 0.0, slopes: [1.0] };
