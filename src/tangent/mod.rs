//! How the state changes with a few inputs: slopes that are carried through time steps beside it.
//!
//! Slopes have the places of what they belong to, row by row. What no input has reached yet has none and is passed over.

mod boundary;
mod list;
pub(crate) mod rotation;

pub(crate) use boundary::BoundarySlopes;
pub(crate) use list::ListSlopes;

use crate::dual::{Dual, RowSlopes, Slopes};
use crate::geometry::Quaternion;
use crate::number::{Number, Vector};
use crate::state::{Particles, State};

/// No change.
pub(crate) const NONE: RowSlopes = [[0.0; 4]; 4];

/// How everything that changes does so with a few inputs.
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
    /// The time step in which the lists had been made whose order this follows.
    made_at: u64,
}

/// How the rows of particles change.
pub(crate) struct ParticleSlopes {
    /// Of positions.
    pub position: Vec<RowSlopes>,
    /// Of velocities.
    pub velocity: Vec<RowSlopes>,
    /// Of angular velocities.
    pub spin: Vec<RowSlopes>,
    /// Of forces.
    pub force: Vec<RowSlopes>,
    /// Of torques.
    pub torque: Vec<RowSlopes>,
    /// Of orientations; empty where there are none.
    pub orientation: Vec<RowSlopes>,
    /// Whether an input has reached the particle.
    pub reached: Vec<bool>,
    /// Which of the scene's particles each is.
    id: Vec<u32>,
}

impl Tangent {
    /// Nothing changes yet.
    pub(crate) fn of(state: &State) -> Self {
        let count = state.particles.len();
        let rows = || vec![NONE; count];
        let particles = ParticleSlopes {
            position: rows(),
            velocity: rows(),
            spin: rows(),
            force: rows(),
            torque: rows(),
            orientation: vec![NONE; state.particles.orientation.len()],
            reached: vec![false; count],
            id: state.particles.id.clone(),
        };
        let mut tangent = Self {
            particles,
            contacts: state.contacts.iter().map(|list| ListSlopes::of(list.history.len())).collect(),
            walls: state.walls.iter().map(|list| ListSlopes::of(list.history.len())).collect(),
            bonds: state.bonds.iter().map(|list| ListSlopes::of(list.rows.len())).collect(),
            boundaries: state.boundaries.iter().map(|_| BoundarySlopes::default()).collect(),
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

    /// Everything goes on in time: the first of the directions is time itself.
    pub(crate) fn go_on(&mut self, state: &State) {
        let (slopes, particles) = (&mut self.particles, &state.particles);
        for slot in 0..particles.len() {
            let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
            for axis in 0..3 {
                slopes.position[slot][axis][0] = velocity[axis];
                if particles.owner[slot] == 0 {
                    slopes.velocity[slot][axis][0] = particles.force[slot][axis] / velocity[3];
                    slopes.spin[slot][axis][0] = particles.torque[slot][axis] / spin[3];
                }
            }
            if let Some(row) = slopes.orientation.get_mut(slot) {
                let passing = Dual::new(0.0, std::array::from_fn(|direction| if direction == 0 { 1.0 } else { 0.0 }));
                let orientation = Quaternion::from_row(Dual::row(particles.orientation[slot], &NONE));
                *row = Dual::slopes_of(orientation.turned(Vector::of_row(spin.map(Dual::splat)), passing).to_row());
            }
        }
        slopes.reached.fill(true);
        for (slopes, boundary) in self.boundaries.iter_mut().zip(&state.boundaries) {
            for axis in 0..3 {
                slopes.displacement[axis][0] = boundary.velocity[axis];
            }
        }
    }

    /// Half a kick and the drift of free particles, by the loads and motions before it. Loads begin anew.
    pub(crate) fn drift(&mut self, state: &State, step: f64) {
        let (slopes, particles) = (&mut self.particles, &state.particles);
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0) {
            if slopes.reached[slot] {
                slopes.kick(particles, slot, 0.5 * step);
                let velocity = slopes.velocity[slot];
                add(&mut slopes.position[slot], &velocity, step);
            }
        }
        slopes.turn(particles, step);
        slopes.force.fill(NONE);
        slopes.torque.fill(NONE);
    }

    /// The second half of the kick of free particles.
    pub(crate) fn kick(&mut self, state: &State, step: f64) {
        let (slopes, particles) = (&mut self.particles, &state.particles);
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0) {
            if slopes.reached[slot] {
                slopes.kick(particles, slot, 0.5 * step);
            }
        }
    }
}

impl ParticleSlopes {
    /// Half a kick, of this length \[s\].
    fn kick(&mut self, particles: &Particles, slot: usize, half: f64) {
        let (mass, inertia) = (particles.velocity[slot][3], particles.angular_velocity[slot][3]);
        add(&mut self.velocity[slot], &self.force[slot], half / mass);
        add(&mut self.spin[slot], &self.torque[slot], half / inertia);
    }

    /// Turns orientations as the drift does; angular velocities have had their half kick, those of the state not yet.
    fn turn(&mut self, particles: &Particles, step: f64) {
        for (slot, slopes) in self.orientation.iter_mut().enumerate().filter(|(slot, _)| self.reached[*slot]) {
            let (mut spin, torque) = (particles.angular_velocity[slot], particles.torque[slot]);
            if particles.owner[slot] == 0 {
                let factor = 0.5 * step / spin[3];
                for axis in 0..3 {
                    spin[axis] += factor * torque[axis];
                }
            }
            let spin = Vector::of_row(Dual::row(spin, &self.spin[slot]));
            let orientation = Quaternion::from_row(Dual::row(particles.orientation[slot], slopes));
            *slopes = Dual::slopes_of(orientation.turned(spin, Dual::splat(step)).to_row());
        }
    }

    /// Takes over the order of the particles.
    fn follow(&mut self, particles: &Particles) {
        let mut before = vec![0_u32; self.id.len()];
        for (slot, &id) in self.id.iter().enumerate() {
            before[id as usize] = slot as u32;
        }
        let came_from: Vec<usize> = particles.id.iter().map(|&id| before[id as usize] as usize).collect();
        let columns = [&mut self.position, &mut self.velocity, &mut self.spin, &mut self.orientation];
        for column in columns.into_iter().chain([&mut self.force, &mut self.torque]) {
            if !column.is_empty() {
                *column = came_from.iter().map(|&slot| column[slot]).collect();
            }
        }
        self.reached = came_from.iter().map(|&slot| self.reached[slot]).collect();
        self.id.clone_from(&particles.id);
    }

    /// Position with radius, velocity with mass, angular velocity with inertia of a particle, with their slopes.
    pub(crate) fn body(&self, particles: &Particles, slot: usize) -> [[Dual; 4]; 3] {
        [
            Dual::row(particles.position[slot], &self.position[slot]),
            Dual::row(particles.velocity[slot], &self.velocity[slot]),
            Dual::row(particles.angular_velocity[slot], &self.spin[slot]),
        ]
    }

    /// Adds to the slopes of force and torque on a particle, which is reached then.
    pub(crate) fn load(&mut self, slot: usize, force: Vector<Dual>, torque: Vector<Dual>) {
        add_vector(&mut self.force[slot], &force.slopes());
        add_vector(&mut self.torque[slot], &torque.slopes());
        self.reached[slot] = true;
    }
}

/// Adds a multiple of slopes.
pub(crate) fn add(row: &mut RowSlopes, other: &RowSlopes, factor: f64) {
    for (sum, part) in row.iter_mut().zip(other) {
        for (sum, part) in sum.iter_mut().zip(part) {
            *sum += factor * part;
        }
    }
}

/// Adds the slopes of a vector to those of a row or of another vector.
pub(crate) fn add_vector(sums: &mut [Slopes], parts: &[Slopes; 3]) {
    for (sum, part) in sums.iter_mut().zip(parts) {
        for (sum, part) in sum.iter_mut().zip(part) {
            *sum += part;
        }
    }
}
