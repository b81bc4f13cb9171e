//! How the state changes with a few inputs: slopes that are carried through time steps beside it.
//!
//! Slopes have the places of what they belong to, row by row. What no input has reached yet has none and is passed over.

mod boundary;
mod list;
pub(crate) mod rotation;

pub(crate) use boundary::BoundarySlopes;
pub(crate) use list::ListSlopes;

use crate::dual::{DIRECTIONS, Dual, RowSlopes, Slopes};
use crate::geometry::Quaternion;
use crate::lanes::{Kernel, Lane, Width, add_eight, run};
use crate::number::{Number, Vector};
use crate::state::{Particles, State};

/// No change.
pub(crate) const NONE: RowSlopes = [[0.0; DIRECTIONS]; 4];

/// How a vector changes that does not.
const NO_VECTOR: VectorSlopes = [[0.0; DIRECTIONS]; 3];

/// How a vector changes.
type VectorSlopes = [Slopes; 3];

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
    /// Registers that slopes are worked on in.
    pub width: Width,
    /// The time step in which the lists had been made whose order this follows.
    made_at: u64,
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

/// How the vectors of particles change.
pub(crate) struct ParticleSlopes {
    /// Of positions.
    pub position: Vec<VectorSlopes>,
    /// Of velocities.
    pub velocity: Vec<VectorSlopes>,
    /// Of angular velocities.
    pub spin: Vec<VectorSlopes>,
    /// Of forces.
    pub force: Vec<VectorSlopes>,
    /// Of torques.
    pub torque: Vec<VectorSlopes>,
    /// Of orientations; empty where there are none.
    pub orientation: Vec<RowSlopes>,
    /// Whether an input has reached the particle.
    pub reached: Vec<bool>,
    /// Which of the scene's particles each is.
    id: Vec<u32>,
}

impl Tangent {
    /// Nothing changes yet.
    pub(crate) fn of(state: &State, width: Width) -> Self {
        let count = state.particles.len();
        let vectors = || vec![NO_VECTOR; count];
        let particles = ParticleSlopes {
            position: vectors(),
            velocity: vectors(),
            spin: vectors(),
            force: vectors(),
            torque: vectors(),
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
                let passing = passing();
                let orientation = Quaternion::from_row(<Dual>::row(particles.orientation[slot], &NONE));
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
        if !slopes.orientation.is_empty() {
            run(self.width, Turn { slopes, particles, step });
        }
        slopes.force.fill(NO_VECTOR);
        slopes.torque.fill(NO_VECTOR);
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

    /// Takes over the order of the particles.
    fn follow(&mut self, particles: &Particles) {
        let mut before = vec![0_u32; self.id.len()];
        for (slot, &id) in self.id.iter().enumerate() {
            before[id as usize] = slot as u32;
        }
        let came_from: Vec<usize> = particles.id.iter().map(|&id| before[id as usize] as usize).collect();
        let columns = [&mut self.position, &mut self.velocity, &mut self.spin, &mut self.force, &mut self.torque];
        for column in columns {
            *column = came_from.iter().map(|&slot| column[slot]).collect();
        }
        if !self.orientation.is_empty() {
            self.orientation = came_from.iter().map(|&slot| self.orientation[slot]).collect();
        }
        self.reached = came_from.iter().map(|&slot| self.reached[slot]).collect();
        self.id.clone_from(&particles.id);
    }

    /// Position with radius, velocity with mass, angular velocity with inertia of a particle, with their slopes.
    #[inline(always)]
    pub(crate) fn body<N: Lane>(&self, particles: &Particles, slot: usize) -> [[Dual<N>; 4]; 3] {
        let with = |[x, y, z, rest]: [f64; 4], slopes: &VectorSlopes| {
            let [dx, dy, dz] = slopes;
            [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::splat(rest)]
        };
        [
            with(particles.position[slot], &self.position[slot]),
            with(particles.velocity[slot], &self.velocity[slot]),
            with(particles.angular_velocity[slot], &self.spin[slot]),
        ]
    }

    /// Adds to the slopes of force and torque on a particle, which is reached then.
    #[inline(always)]
    pub(crate) fn load<N: Lane>(&mut self, slot: usize, force: Vector<Dual<N>>, torque: Vector<Dual<N>>) {
        raise(&mut self.force[slot], force);
        raise(&mut self.torque[slot], torque);
        self.reached[slot] = true;
    }
}

/// Adds the slopes of a vector.
#[inline(always)]
fn raise<N: Lane>(sums: &mut VectorSlopes, vector: Vector<Dual<N>>) {
    let [x, y, z] = sums;
    add_eight::<N>(x, vector.x.slopes);
    add_eight::<N>(y, vector.y.slopes);
    add_eight::<N>(z, vector.z.slopes);
}

/// Time as the first of the directions.
pub(crate) fn passing() -> Dual {
    Dual::new(0.0, &std::array::from_fn(|direction| if direction == 0 { 1.0 } else { 0.0 }))
}

/// Turns orientations as the drift does; angular velocities have had their half kick, those of the state not yet.
struct Turn<'a> {
    /// What changes.
    slopes: &'a mut ParticleSlopes,
    /// The particles.
    particles: &'a Particles,
    /// Length of the time step \[s\].
    step: f64,
}

impl Kernel for Turn<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { slopes, particles, step } = self;
        for slot in (0..slopes.orientation.len()).filter(|&slot| slopes.reached[slot]) {
            let (mut spin, torque) = (particles.angular_velocity[slot], particles.torque[slot]);
            if particles.owner[slot] == 0 {
                let factor = 0.5 * step / spin[3];
                for axis in 0..3 {
                    spin[axis] += factor * torque[axis];
                }
            }
            let spin = Dual::<N>::vector(Vector::from(spin), &slopes.spin[slot]);
            let orientation = Quaternion::from_row(Dual::row(particles.orientation[slot], &slopes.orientation[slot]));
            slopes.orientation[slot] = Dual::slopes_of(orientation.turned(spin, Dual::splat(step)).to_row());
        }
    }
}

/// Adds a multiple of slopes.
pub(crate) fn add(row: &mut [Slopes], other: &[Slopes], factor: f64) {
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
