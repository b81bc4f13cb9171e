//! How particles change with a few inputs.

use super::{NONE, Tangent};
use crate::dual::{DIRECTIONS, Dual, RowSlopes, Slopes};
use crate::geometry::Quaternion;
use crate::lanes::{Kernel, Lane, add_eight, run};
use crate::number::{Number, Vector};
use crate::state::{Particles, State};

/// The slopes of a vector that does not change.
const NO_VECTOR: VectorSlopes = [[0.0; DIRECTIONS]; 3];

/// How a vector changes.
type VectorSlopes = [Slopes; 3];

/// How the vectors of particles change.
pub(crate) struct ParticleSlopes {
    /// Of positions.
    pub position: Vec<VectorSlopes>,
    /// Of velocities.
    pub velocity: Vec<VectorSlopes>,
    /// Of angular velocities, where torques change them.
    pub spin: Vec<VectorSlopes>,
    /// Of forces.
    pub force: Vec<VectorSlopes>,
    /// Of torques, where there are any.
    pub torque: Vec<VectorSlopes>,
    /// Of orientations; empty where there are none.
    pub orientation: Vec<RowSlopes>,
    /// Whether an input has reached the particle.
    pub reached: Vec<bool>,
    /// Whether torques turn the particles.
    turning: bool,
    /// Which of the scene's particles each is.
    id: Vec<u32>,
}

impl Tangent {
    /// Half a kick and the drift of free particles, by the loads and motions before it. Loads begin anew.
    pub(crate) fn drift(&mut self, state: &State, step: f64) {
        run(self.width, Drift { slopes: &mut self.particles, particles: &state.particles, step });
    }

    /// The second half of the kick of free particles.
    pub(crate) fn kick(&mut self, state: &State, step: f64) {
        run(self.width, Kick { slopes: &mut self.particles, particles: &state.particles, half: 0.5 * step });
    }
}

impl ParticleSlopes {
    /// Nothing changes yet.
    pub(super) fn of(particles: &Particles, turning: bool) -> Self {
        let vectors = || vec![NO_VECTOR; particles.len()];
        Self {
            position: vectors(),
            velocity: vectors(),
            spin: vectors(),
            force: vectors(),
            torque: vectors(),
            orientation: vec![NONE; particles.orientation.len()],
            reached: vec![false; particles.len()],
            turning,
            id: particles.id.clone(),
        }
    }

    /// Half a kick, of this length \[s\].
    #[inline(always)]
    fn kick(&mut self, particles: &Particles, slot: usize, half: f64) {
        let (mass, inertia) = (particles.velocity[slot][3], particles.angular_velocity[slot][3]);
        add(&mut self.velocity[slot], &self.force[slot], half / mass);
        if self.turning {
            add(&mut self.spin[slot], &self.torque[slot], half / inertia);
        }
    }

    /// Turns an orientation as the drift does; the angular velocity has had its half kick, that of the state not yet.
    #[inline(always)]
    fn turn<N: Lane>(&mut self, particles: &Particles, slot: usize, step: f64) {
        let (mut spin, torque) = (particles.angular_velocity[slot], particles.torque[slot]);
        if particles.owner[slot] == 0 {
            let factor = 0.5 * step / spin[3];
            for axis in 0..3 {
                spin[axis] += factor * torque[axis];
            }
        }
        let spin = Dual::<N>::vector(Vector::from(spin), &self.spin[slot]);
        let orientation = Quaternion::from_row(Dual::row(particles.orientation[slot], &self.orientation[slot]));
        self.orientation[slot] = Dual::slopes_of(orientation.turned(spin, Dual::splat(step)).to_row());
    }

    /// Takes over the order of the particles.
    pub(super) fn follow(&mut self, particles: &Particles) {
        let mut before = vec![0_u32; self.id.len()];
        for (slot, &id) in self.id.iter().enumerate() {
            before[id as usize] = slot as u32;
        }
        let came_from: Vec<usize> = particles.id.iter().map(|&id| before[id as usize] as usize).collect();
        let move_all = |column: &mut Vec<VectorSlopes>| *column = came_from.iter().map(|&slot| column[slot]).collect();
        [&mut self.position, &mut self.velocity, &mut self.force].into_iter().for_each(move_all);
        if self.turning {
            [&mut self.spin, &mut self.torque].into_iter().for_each(move_all);
        }
        if !self.orientation.is_empty() {
            self.orientation = came_from.iter().map(|&slot| self.orientation[slot]).collect();
        }
        self.reached = came_from.iter().map(|&slot| self.reached[slot]).collect();
        self.id.clone_from(&particles.id);
    }

    /// Position with radius and velocity with mass of a particle, with their slopes.
    #[inline(always)]
    pub(crate) fn body<N: Lane>(&self, particles: &Particles, slot: usize) -> [[Dual<N>; 4]; 2] {
        let position = row_of(particles.position[slot], &self.position[slot]);
        [position, row_of(particles.velocity[slot], &self.velocity[slot])]
    }

    /// Angular velocity with inertia of a particle, with its slopes.
    #[inline(always)]
    pub(crate) fn spin<N: Lane>(&self, particles: &Particles, slot: usize) -> [Dual<N>; 4] {
        row_of(particles.angular_velocity[slot], &self.spin[slot])
    }

    /// Adds to the slopes of the force on a particle, which is reached then.
    #[inline(always)]
    pub(crate) fn press<N: Lane>(&mut self, slot: usize, force: Vector<Dual<N>>) {
        raise(&mut self.force[slot], force);
        self.reached[slot] = true;
    }

    /// Adds to the slopes of force and torque on a particle, which is reached then.
    #[inline(always)]
    pub(crate) fn load<N: Lane>(&mut self, slot: usize, force: Vector<Dual<N>>, torque: Vector<Dual<N>>) {
        self.press(slot, force);
        raise(&mut self.torque[slot], torque);
    }
}

/// A vector with its slopes, and behind it a number that does not change.
#[inline(always)]
fn row_of<N: Lane>([x, y, z, rest]: [f64; 4], [dx, dy, dz]: &VectorSlopes) -> [Dual<N>; 4] {
    [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::splat(rest)]
}

/// Adds the slopes of a vector.
#[inline(always)]
fn raise<N: Lane>(sums: &mut VectorSlopes, vector: Vector<Dual<N>>) {
    let [x, y, z] = sums;
    add_eight::<N>(x, vector.x.slopes);
    add_eight::<N>(y, vector.y.slopes);
    add_eight::<N>(z, vector.z.slopes);
}

/// Half a kick and the drift of particles.
struct Drift<'a> {
    /// What changes.
    slopes: &'a mut ParticleSlopes,
    /// The particles.
    particles: &'a Particles,
    /// Length of the time step \[s\].
    step: f64,
}

impl Kernel for Drift<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { slopes, particles, step } = self;
        for slot in 0..particles.len() {
            // Nothing has ever been written of a particle that is not reached.
            if !slopes.reached[slot] {
                continue;
            }
            if particles.owner[slot] == 0 {
                slopes.kick(particles, slot, 0.5 * step);
                let velocity = slopes.velocity[slot];
                add(&mut slopes.position[slot], &velocity, step);
            }
            if !slopes.orientation.is_empty() {
                slopes.turn::<N>(particles, slot, step);
            }
            slopes.force[slot] = NO_VECTOR;
            if slopes.turning {
                slopes.torque[slot] = NO_VECTOR;
            }
        }
    }
}

/// Half a kick of particles.
struct Kick<'a> {
    /// What changes.
    slopes: &'a mut ParticleSlopes,
    /// The particles.
    particles: &'a Particles,
    /// Its length \[s\].
    half: f64,
}

impl Kernel for Kick<'_> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { slopes, particles, half } = self;
        for slot in 0..particles.len() {
            if particles.owner[slot] == 0 && slopes.reached[slot] {
                slopes.kick(particles, slot, half);
            }
        }
    }
}

/// Adds a multiple of slopes.
#[inline(always)]
fn add(row: &mut [Slopes], other: &[Slopes], factor: f64) {
    for (sum, part) in row.iter_mut().zip(other) {
        for (sum, part) in sum.iter_mut().zip(part) {
            *sum += factor * part;
        }
    }
}
