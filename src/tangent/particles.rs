//! How particles change with a few inputs.

use super::rows::vectors_with_slopes;
use super::{rows_at, vector_slopes};
use crate::dual::Dual;
use crate::geometry::Quaternion;
use crate::lanes::{Lane, Places, add_at, add_opposite_at, add_pairs_at, columns_at, differences_at};
use crate::number::{Row, Vector};
use crate::state::Particles;

/// How the vectors of particles change.
pub(crate) struct ParticleSlopes {
    /// Of positions.
    pub position: Vec<Row>,
    /// Of velocities.
    pub velocity: Vec<Row>,
    /// Of angular velocities, where torques change them.
    pub spin: Vec<Row>,
    /// Of forces.
    pub force: Vec<Row>,
    /// Of torques, where there are any.
    pub torque: Vec<Row>,
    /// Of orientations; empty where there are none.
    pub orientation: Vec<Row>,
    /// Whether an input has reached the particle.
    pub is_reached: Vec<bool>,
    /// Whether an input has reached every particle.
    pub(super) all_reached: bool,
    /// Whether torques turn the particles.
    pub(super) turning: bool,
    /// 1 over mass \[1/kg\] and moment of inertia \[1/(kg m²)\] of each; 0 of those of boundaries.
    pub(super) inverse: Vec<[f64; 2]>,
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

impl ParticleSlopes {
    /// Nothing changes yet.
    pub(super) fn of(particles: &Particles, turning: bool) -> Self {
        let rows = || vec![[0.0; 4]; particles.len()];
        Self {
            position: rows(),
            velocity: rows(),
            spin: rows(),
            force: rows(),
            torque: rows(),
            orientation: vec![[0.0; 4]; particles.orientation.len()],
            is_reached: vec![false; particles.len()],
            all_reached: false,
            turning,
            inverse: (0..particles.len()).map(|slot| inverse(particles, slot)).collect(),
            id: particles.id.clone(),
        }
    }

    /// Takes over the order of the particles.
    pub(super) fn follow(&mut self, particles: &Particles) {
        let mut before = vec![0_u32; self.id.len()];
        for (slot, &id) in self.id.iter().enumerate() {
            before[id as usize] = slot as u32;
        }
        let came_from: Vec<usize> = particles.id.iter().map(|&id| before[id as usize] as usize).collect();
        let move_all = |column: &mut Vec<Row>| *column = came_from.iter().map(|&slot| column[slot]).collect();
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
    pub(crate) fn pair<N: Lane>(&self, [x, y, z, i, j]: [N; 5], first: &Places, second: &Places) -> [Dual<N>; 5] {
        let [dx, dy, dz, _] = differences_at(&self.position, first, second);
        [Dual::new(x, [dx]), Dual::new(y, [dy]), Dual::new(z, [dz]), Dual::constant(i), Dual::constant(j)]
    }

    /// Velocities and masses of their bodies; the slopes of the first ones are those of the difference.
    #[inline(always)]
    pub(crate) fn velocities<N: Lane>(&self, moving: &Moving, first: &Places, second: &Places) -> [[Dual<N>; 4]; 2] {
        let [x, y, z, mass] = columns_at(moving.velocity, first);
        let [dx, dy, dz, _] = differences_at(&self.velocity, first, second);
        let difference = [Dual::new(x, [dx]), Dual::new(y, [dy]), Dual::new(z, [dz]), Dual::constant(mass)];
        [difference, Dual::constants(columns_at(moving.velocity, second))]
    }

    /// Positions with radii of the bodies of some bonds; the slopes of the first ones are those of the difference.
    #[inline(always)]
    pub(crate) fn positions<N: Lane>(&self, moving: &Moving, first: &Places, second: &Places) -> [[Dual<N>; 4]; 2] {
        let [x, y, z, radius] = columns_at(moving.position, first);
        let [dx, dy, dz, _] = differences_at(&self.position, first, second);
        let difference = [Dual::new(x, [dx]), Dual::new(y, [dy]), Dual::new(z, [dz]), Dual::constant(radius)];
        [difference, Dual::constants(columns_at(moving.position, second))]
    }

    /// Positions with radii and velocities with masses of a register's worth of particles, with their slopes.
    #[inline(always)]
    pub(crate) fn bodies<N: Lane>(&self, moving: &Moving, slots: &Places) -> [[Dual<N>; 4]; 2] {
        let position = vectors_with_slopes(columns_at(moving.position, slots), columns_at(&self.position, slots));
        [position, vectors_with_slopes(columns_at(moving.velocity, slots), columns_at(&self.velocity, slots))]
    }

    /// Angular velocities with inertias of a register's worth of particles, with their slopes.
    #[inline(always)]
    pub(crate) fn spins<N: Lane>(&self, moving: &Moving, slots: &Places) -> [Dual<N>; 4] {
        vectors_with_slopes(columns_at(moving.angular_velocity, slots), columns_at(&self.spin, slots))
    }

    /// Orientations of a register's worth of particles with their slopes, where there are any.
    #[inline(always)]
    pub(crate) fn orientations<N: Lane>(&self, particles: &Particles, slots: &Places) -> Quaternion<Dual<N>> {
        match self.orientation.is_empty() {
            true => Quaternion::identity(),
            false => Quaternion::from_row(rows_at::<N>(&particles.orientation, &self.orientation, slots)),
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

    /// Adds to the slopes of the forces on the first so many of some particles. Those are reached then whose bit is set; of others there
    /// are no slopes.
    #[inline(always)]
    pub(crate) fn press<N: Lane>(
        &mut self,
        slots: &Places,
        (count, mut reached): (usize, u32),
        force: Vector<Dual<N>>,
    ) {
        add_at(vector_slopes(force), &mut self.force, slots, count);
        while reached != 0 && !self.all_reached {
            self.is_reached[slots.at(reached.trailing_zeros() as usize)] = true;
            reached &= reached - 1;
        }
    }

    /// Adds to the slopes of the forces on the first ones of some pairs of particles, and takes from those on the second ones, pair by
    /// pair, of the first so many. Both are reached then, of the pairs whose bit is set; of others there are no slopes.
    #[inline(always)]
    pub(crate) fn press_pairs<N: Lane>(
        &mut self,
        slots: [&Places; 2],
        (count, mut reached): (usize, u32),
        force: Vector<Dual<N>>,
    ) {
        add_opposite_at(vector_slopes(force), &mut self.force, slots[0], slots[1], count);
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
        [first, second]: [Vector<Dual<N>>; 2],
    ) {
        add_pairs_at([vector_slopes(first), vector_slopes(second)], &mut self.torque, slots[0], slots[1], count);
    }

    /// Adds to the slopes of the torques on the first so many of some particles.
    #[inline(always)]
    pub(crate) fn twist<N: Lane>(&mut self, slots: &Places, count: usize, torque: Vector<Dual<N>>) {
        add_at(vector_slopes(torque), &mut self.torque, slots, count);
    }
}

/// 1 over mass \[1/kg\] and moment of inertia \[1/(kg m²)\] of a particle; 0 of one of a boundary.
fn inverse(particles: &Particles, slot: usize) -> [f64; 2] {
    let free = if particles.owner[slot] == 0 { 1.0 } else { 0.0 };
    [free / particles.velocity[slot][3], free / particles.angular_velocity[slot][3]]
}
