//! How particles change with a few inputs.

use super::inputs::vectors_at;
use super::{InLanes, Inputs, Tangent, alone, row_of, rows_at};
use crate::geometry::Quaternion;
use crate::lanes::{Kernel, Lane, Places};
use crate::number::{Number, Vector};
use crate::state::{Particles, State};

/// How the vectors of particles change.
pub(crate) struct ParticleSlopes<I: Inputs> {
    /// Of positions.
    pub position: Vec<I::Row>,
    /// Of velocities.
    pub velocity: Vec<I::Row>,
    /// Of angular velocities, where torques change them.
    pub spin: Vec<I::Row>,
    /// Of forces.
    pub force: Vec<I::Row>,
    /// Of torques, where there are any.
    pub torque: Vec<I::Row>,
    /// Of orientations; empty where there are none.
    pub orientation: Vec<I::Row>,
    /// Whether an input has reached the particle.
    pub is_reached: Vec<bool>,
    /// Whether an input has reached every particle.
    all_reached: bool,
    /// Whether torques turn the particles.
    turning: bool,
    /// Which of the scene's particles each is.
    id: Vec<u32>,
}

impl<I: Inputs> Tangent<I> {
    /// Half a kick and the drift of free particles, by the loads and motions before it. Loads begin anew.
    pub(crate) fn drift_particles(&mut self, state: &State, step: f64) {
        I::run(self.width, Drift { slopes: &mut self.particles, particles: &state.particles, step });
    }

    /// The second half of the kick of free particles.
    pub(crate) fn kick_particles(&mut self, state: &State, step: f64) {
        I::run(self.width, Kick { slopes: &mut self.particles, particles: &state.particles, half: 0.5 * step });
    }
}

impl<I: Inputs> ParticleSlopes<I> {
    /// Nothing changes yet.
    pub(super) fn of(particles: &Particles, turning: bool) -> Self {
        let rows = || vec![I::NONE; particles.len()];
        Self {
            position: rows(),
            velocity: rows(),
            spin: rows(),
            force: rows(),
            torque: rows(),
            orientation: vec![I::NONE; particles.orientation.len()],
            is_reached: vec![false; particles.len()],
            all_reached: false,
            turning,
            id: particles.id.clone(),
        }
    }

    /// Half a kick, of this length \[s\].
    #[inline(always)]
    fn kick(&mut self, particles: &Particles, slot: usize, half: f64) {
        let (mass, inertia) = (particles.velocity[slot][3], particles.angular_velocity[slot][3]);
        I::add_times(&mut self.velocity[slot], &self.force[slot], half / mass);
        if self.turning {
            I::add_times(&mut self.spin[slot], &self.torque[slot], half / inertia);
        }
    }

    /// Turns an orientation as the drift does; the angular velocity has had its half kick, that of the state not yet.
    #[inline(always)]
    fn turn(&mut self, particles: &Particles, slot: usize, step: f64) {
        let (mut spin, torque) = (particles.angular_velocity[slot], particles.torque[slot]);
        if particles.owner[slot] == 0 {
            let factor = 0.5 * step / spin[3];
            for axis in 0..3 {
                spin[axis] += factor * torque[axis];
            }
        }
        let spin = Vector::of_row(alone::<I>(spin, &self.spin[slot]));
        let orientation = Quaternion::from_row(alone::<I>(particles.orientation[slot], &self.orientation[slot]));
        self.orientation[slot] = row_of::<I>(orientation.turned(spin, Number::splat(step)).to_row());
    }

    /// Takes over the order of the particles.
    pub(super) fn follow(&mut self, particles: &Particles) {
        let mut before = vec![0_u32; self.id.len()];
        for (slot, &id) in self.id.iter().enumerate() {
            before[id as usize] = slot as u32;
        }
        let came_from: Vec<usize> = particles.id.iter().map(|&id| before[id as usize] as usize).collect();
        let move_all = |column: &mut Vec<I::Row>| *column = came_from.iter().map(|&slot| column[slot]).collect();
        [&mut self.position, &mut self.velocity, &mut self.force].into_iter().for_each(move_all);
        if self.turning {
            [&mut self.spin, &mut self.torque].into_iter().for_each(move_all);
        }
        if !self.orientation.is_empty() {
            move_all(&mut self.orientation);
        }
        self.is_reached = came_from.iter().map(|&slot| self.is_reached[slot]).collect();
        self.id.clone_from(&particles.id);
    }

    /// Positions with radii and velocities with masses of a register's worth of particles, with their slopes.
    #[inline(always)]
    pub(crate) fn bodies<N: Lane>(&self, particles: &Particles, slots: &Places) -> [[InLanes<I, N>; 4]; 2] {
        let position = vectors_at::<I, N>(&particles.position, &self.position, slots);
        [position, vectors_at::<I, N>(&particles.velocity, &self.velocity, slots)]
    }

    /// Angular velocities with inertias of a register's worth of particles, with their slopes.
    #[inline(always)]
    pub(crate) fn spins<N: Lane>(&self, particles: &Particles, slots: &Places) -> [InLanes<I, N>; 4] {
        vectors_at::<I, N>(&particles.angular_velocity, &self.spin, slots)
    }

    /// Orientations of a register's worth of particles with their slopes, where there are any.
    #[inline(always)]
    pub(crate) fn orientations<N: Lane>(&self, particles: &Particles, slots: &Places) -> Quaternion<InLanes<I, N>> {
        match self.orientation.is_empty() {
            true => Quaternion::identity(),
            false => Quaternion::from_row(rows_at::<I, N>(&particles.orientation, &self.orientation, slots)),
        }
    }

    /// Which of some particles an input has reached, a bit for each.
    #[inline(always)]
    pub(crate) fn reached(&self, slots: &[u32]) -> u32 {
        if self.all_reached {
            return (1 << slots.len()) - 1;
        }
        let mut bits = 0;
        for (lane, &slot) in slots.iter().enumerate() {
            bits |= u32::from(self.is_reached[slot as usize]) << lane;
        }
        bits
    }

    /// Adds to the slopes of the forces on some particles, which are reached then.
    #[inline(always)]
    pub(crate) fn press<N: Lane>(&mut self, slots: &[u32], force: Vector<InLanes<I, N>>) {
        I::add::<N>(force.slopes(), &mut self.force, slots);
        for &slot in slots {
            self.is_reached[slot as usize] = true;
        }
    }

    /// Adds to the slopes of the forces on the first ones of some pairs of particles, and takes from those on the second ones, pair by
    /// pair; both are reached then.
    #[inline(always)]
    pub(crate) fn press_pairs<N: Lane>(&mut self, slots: [&[u32]; 2], force: Vector<InLanes<I, N>>) {
        I::add_opposite::<N>(force.slopes(), &mut self.force, slots);
        for &slot in slots.into_iter().flatten() {
            self.is_reached[slot as usize] = true;
        }
    }

    /// Adds to the slopes of the torques on both particles of some pairs, pair by pair.
    #[inline(always)]
    pub(crate) fn twist_pairs<N: Lane>(&mut self, slots: [&[u32]; 2], torques: [Vector<InLanes<I, N>>; 2]) {
        let [first, second] = torques;
        I::add_pairs::<N>([first.slopes(), second.slopes()], &mut self.torque, slots);
    }

    /// Adds to the slopes of the torques on some particles.
    #[inline(always)]
    pub(crate) fn twist<N: Lane>(&mut self, slots: &[u32], torque: Vector<InLanes<I, N>>) {
        I::add::<N>(torque.slopes(), &mut self.torque, slots);
    }
}

/// Half a kick and the drift of particles.
struct Drift<'a, I: Inputs> {
    /// What changes.
    slopes: &'a mut ParticleSlopes<I>,
    /// The particles.
    particles: &'a Particles,
    /// Length of the time step \[s\].
    step: f64,
}

impl<I: Inputs> Kernel for Drift<'_, I> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { slopes, particles, step } = self;
        slopes.all_reached = true;
        for slot in 0..particles.len() {
            // Nothing has ever been written of a particle that is not reached.
            if !slopes.is_reached[slot] {
                slopes.all_reached = false;
                continue;
            }
            if particles.owner[slot] == 0 {
                slopes.kick(particles, slot, 0.5 * step);
                let velocity = slopes.velocity[slot];
                I::add_times(&mut slopes.position[slot], &velocity, step);
            }
            if !slopes.orientation.is_empty() {
                slopes.turn(particles, slot, step);
            }
            slopes.force[slot] = I::NONE;
            if slopes.turning {
                slopes.torque[slot] = I::NONE;
            }
        }
    }
}

/// Half a kick of particles.
struct Kick<'a, I: Inputs> {
    /// What changes.
    slopes: &'a mut ParticleSlopes<I>,
    /// The particles.
    particles: &'a Particles,
    /// Its length \[s\].
    half: f64,
}

impl<I: Inputs> Kernel for Kick<'_, I> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { slopes, particles, half } = self;
        for slot in 0..particles.len() {
            if particles.owner[slot] == 0 && slopes.is_reached[slot] {
                slopes.kick(particles, slot, half);
            }
        }
    }
}
