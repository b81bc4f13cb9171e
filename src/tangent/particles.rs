//! How particles change with a few inputs.

use super::inputs::vectors_at;
use super::{InLanes, Inputs, Tangent, rows_at, slopes_of, with_slopes};
use crate::dual::Dual;
use crate::geometry::Quaternion;
use crate::lanes::{Kernel, Lane, Places, columns_at, columns_from};
use crate::number::{Number, Row, Vector};
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
    /// 1 over mass \[1/kg\] and moment of inertia \[1/(kg m²)\] of each; 0 of those of boundaries.
    inverse: Vec<[f64; 2]>,
    /// Which of the scene's particles each is.
    id: Vec<u32>,
}

/// How particles stand and move.
#[derive(Clone, Copy)]
pub(crate) struct Moving<'a> {
    /// Positions and radii.
    pub position: &'a [Row],
    /// Velocities and masses.
    pub velocity: &'a [Row],
    /// Angular velocities and moments of inertia.
    pub angular_velocity: &'a [Row],
}

impl<'a> Moving<'a> {
    /// By these rows.
    pub(crate) fn of(position: &'a [Row], velocity: &'a [Row], angular_velocity: &'a [Row]) -> Self {
        Self { position, velocity, angular_velocity }
    }
}

impl<I: Inputs> Tangent<I> {
    /// Half a kick and the drift of free particles, by the loads and motions before it. Loads begin anew.
    pub(crate) fn drift_particles(&mut self, state: &State, step: f64) {
        I::run(self.width, Drift { slopes: &mut self.particles, particles: &state.particles, step });
    }

    /// The second half of the kick of free particles.
    pub(crate) fn kick_particles(&mut self, step: f64) {
        I::run(self.width, Kick { slopes: &mut self.particles, half: 0.5 * step });
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
            inverse: (0..particles.len()).map(|slot| inverse(particles, slot)).collect(),
            id: particles.id.clone(),
        }
    }

    /// Half a kick of a particle, of this length \[s\].
    #[inline(always)]
    fn kick(&mut self, slot: usize, half: f64) {
        let [per_mass, per_inertia] = self.inverse[slot];
        I::add_times(&mut self.velocity[slot], &self.force[slot], half * per_mass);
        if self.turning {
            I::add_times(&mut self.spin[slot], &self.torque[slot], half * per_inertia);
        }
    }

    /// Turns orientations as the drift does; the angular velocity has had its half kick, that of the state not yet.
    #[inline(always)]
    fn turn<N: Lane>(&mut self, particles: &Particles, first: usize, step: f64) {
        let mut spin = columns_from::<I::Values<N>>(&particles.angular_velocity, first);
        if particles.owner[first] == 0 {
            let torque = columns_from::<I::Values<N>>(&particles.torque, first);
            let factor = I::Values::<N>::splat(0.5 * step) / spin[3];
            for axis in 0..3 {
                spin[axis] = spin[axis] + factor * torque[axis];
            }
        }
        let spin = with_slopes::<I, N>(spin, I::rows_from::<N>(&self.spin, first));
        let orientation = columns_from(&particles.orientation, first);
        let orientation = with_slopes::<I, N>(orientation, I::rows_from::<N>(&self.orientation, first));
        let turned = Quaternion::from_row(orientation).turned(Vector::of_row(spin), Number::splat(step));
        I::put_from::<N>(slopes_of::<I, N>(turned.to_row()), &mut self.orientation, first);
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
        self.inverse = (0..particles.len()).map(|slot| inverse(particles, slot)).collect();
        self.id.clone_from(&particles.id);
    }

    /// Two spheres of a register's worth of contacts: from the second to the first, and the radii, whose values have been found.
    #[inline(always)]
    pub(crate) fn pair<N: Lane>(
        &self,
        [x, y, z, i, j]: [I::Values<N>; 5],
        first: &Places,
        second: &Places,
    ) -> [InLanes<I, N>; 5] {
        let [dx, dy, dz, _] = I::differences_at::<N>(&self.position, first, second);
        [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::constant(i), Dual::constant(j)]
    }

    /// Velocities and masses of their bodies; the slopes of the first ones are those of the difference.
    #[inline(always)]
    pub(crate) fn velocities<N: Lane>(
        &self,
        moving: &Moving,
        first: &Places,
        second: &Places,
    ) -> [[InLanes<I, N>; 4]; 2] {
        let [x, y, z, mass] = columns_at(moving.velocity, first);
        let [dx, dy, dz, _] = I::differences_at::<N>(&self.velocity, first, second);
        let difference = [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::constant(mass)];
        [difference, Dual::constants(columns_at(moving.velocity, second))]
    }

    /// Positions with radii of the bodies of some bonds; the slopes of the first ones are those of the difference.
    #[inline(always)]
    pub(crate) fn positions<N: Lane>(
        &self,
        moving: &Moving,
        first: &Places,
        second: &Places,
    ) -> [[InLanes<I, N>; 4]; 2] {
        let [x, y, z, radius] = columns_at(moving.position, first);
        let [dx, dy, dz, _] = I::differences_at::<N>(&self.position, first, second);
        let difference = [Dual::new(x, dx), Dual::new(y, dy), Dual::new(z, dz), Dual::constant(radius)];
        [difference, Dual::constants(columns_at(moving.position, second))]
    }

    /// Positions with radii and velocities with masses of a register's worth of particles, with their slopes.
    #[inline(always)]
    pub(crate) fn bodies<N: Lane>(&self, moving: &Moving, slots: &Places) -> [[InLanes<I, N>; 4]; 2] {
        let position = vectors_at::<I, N>(moving.position, &self.position, slots);
        [position, vectors_at::<I, N>(moving.velocity, &self.velocity, slots)]
    }

    /// Angular velocities with inertias of a register's worth of particles, with their slopes.
    #[inline(always)]
    pub(crate) fn spins<N: Lane>(&self, moving: &Moving, slots: &Places) -> [InLanes<I, N>; 4] {
        vectors_at::<I, N>(moving.angular_velocity, &self.spin, slots)
    }

    /// Orientations of a register's worth of particles with their slopes, where there are any.
    #[inline(always)]
    pub(crate) fn orientations<N: Lane>(&self, particles: &Particles, slots: &Places) -> Quaternion<InLanes<I, N>> {
        match self.orientation.is_empty() {
            true => Quaternion::identity(),
            false => Quaternion::from_row(rows_at::<I, N>(&particles.orientation, &self.orientation, slots)),
        }
    }

    /// Whether an input has reached any of some particles.
    pub(crate) fn reaches(&self, slots: &[u32]) -> bool {
        self.all_reached || slots.iter().any(|&slot| self.is_reached[slot as usize])
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

    /// Adds to the slopes of the forces on the first so many of some particles, which are reached then.
    #[inline(always)]
    pub(crate) fn press<N: Lane>(&mut self, slots: &Places, count: usize, force: Vector<InLanes<I, N>>) {
        I::add::<N>(force.slopes(), &mut self.force, slots, count);
        for &slot in slots.first(count) {
            self.is_reached[slot as usize] = true;
        }
    }

    /// Adds to the slopes of the forces on the first ones of some pairs of particles, and takes from those on the second ones, pair by
    /// pair, of the first so many. Both are reached then, of the pairs whose bit is set; of others there are no slopes.
    #[inline(always)]
    pub(crate) fn press_pairs<N: Lane>(
        &mut self,
        slots: [&Places; 2],
        (count, mut reached): (usize, u32),
        force: Vector<InLanes<I, N>>,
    ) {
        I::add_opposite::<N>(force.slopes(), &mut self.force, slots, count);
        while reached != 0 && !self.all_reached {
            let pair = reached.trailing_zeros() as usize;
            for slots in slots {
                self.is_reached[slots.at(pair)] = true;
            }
            reached &= reached - 1;
        }
    }

    /// Adds to the slopes of the torques on both particles of the first so many of some pairs, pair by pair.
    #[inline(always)]
    pub(crate) fn twist_pairs<N: Lane>(
        &mut self,
        slots: [&Places; 2],
        count: usize,
        [first, second]: [Vector<InLanes<I, N>>; 2],
    ) {
        I::add_pairs::<N>([first.slopes(), second.slopes()], &mut self.torque, slots, count);
    }

    /// Adds to the slopes of the torques on the first so many of some particles.
    #[inline(always)]
    pub(crate) fn twist<N: Lane>(&mut self, slots: &Places, count: usize, torque: Vector<InLanes<I, N>>) {
        I::add::<N>(torque.slopes(), &mut self.torque, slots, count);
    }
}

/// 1 over mass \[1/kg\] and moment of inertia \[1/(kg m²)\] of a particle; 0 of one of a boundary.
fn inverse(particles: &Particles, slot: usize) -> [f64; 2] {
    let free = if particles.owner[slot] == 0 { 1.0 } else { 0.0 };
    [free / particles.velocity[slot][3], free / particles.angular_velocity[slot][3]]
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
        slopes.all_reached = !slopes.is_reached.contains(&false);
        for slot in 0..particles.len() {
            // Nothing has ever been written of a particle that is not reached. Those of boundaries are put where they belong later.
            if slopes.is_reached[slot] {
                slopes.kick(slot, 0.5 * step);
                I::add_times(&mut slopes.position[slot], &slopes.velocity[slot], step);
                slopes.force[slot] = I::NONE;
            }
        }
        let mut first = 0;
        while first < slopes.orientation.len() {
            let whole = are_free::<I::Values<N>>(particles, first);
            let some = first..first + if whole { I::Values::<N>::WIDTH } else { 1 };
            first = some.end;
            if !slopes.is_reached[some.clone()].contains(&true) {
                continue;
            }
            if whole {
                slopes.turn::<N>(particles, some.start, step);
            } else {
                slopes.turn::<f64>(particles, some.start, step);
            }
        }
        if slopes.turning {
            slopes.torque.fill(I::NONE);
        }
    }
}

/// Half a kick of particles.
struct Kick<'a, I: Inputs> {
    /// What changes.
    slopes: &'a mut ParticleSlopes<I>,
    /// Its length \[s\].
    half: f64,
}

impl<I: Inputs> Kernel for Kick<'_, I> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let Self { slopes, half } = self;
        for slot in 0..slopes.velocity.len() {
            if slopes.is_reached[slot] {
                slopes.kick(slot, half);
            }
        }
    }
}

/// Whether there is a register's worth of particles from one on, all of them free.
#[inline(always)]
fn are_free<N: Lane>(particles: &Particles, first: usize) -> bool {
    particles.owner.get(first..first + N::WIDTH).is_some_and(|owners| owners.iter().all(|&owner| owner == 0))
}
