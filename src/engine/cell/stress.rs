//! Stress and structure of a cell, looked at between time steps.

use super::Cell;
use super::deformation::times;
use super::sweeps::{Columns, add_dyad, square};
use crate::base::geometry::lattice::STRAIN_PLACES;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::contacts::{Link, Pass, SearchLimits};
use crate::engine::state::cell::{Square, Strains};
use crate::engine::state::{IMAGE, State};

/// A component of the stress times the volume: of forces and of velocities, tension positive \[J\].
pub(super) fn of(virial: &Square, kinetic: &Square, component: usize) -> f64 {
    let [row, column] = STRAIN_PLACES[component];
    -0.5 * (virial[row][column] + virial[column][row] + kinetic[row][column] + kinetic[column][row])
}

/// How stiff the velocities are to a component of the strain with which they go, times the volume \[J\]: they change by A⁻¹.
pub(super) fn kinetic_stiffness(kinetic: &Square, component: usize) -> f64 {
    let [row, column] = STRAIN_PLACES[component];
    // Along an axis the square of the velocity changes twice, and the volume once.
    let times = if row == column { 3.0 } else { 1.0 };
    times * kinetic[column][column]
}

/// Contacts between particles, as far as they tell the structure of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fabric {
    /// Contacts of a particle in the mean.
    pub coordination: f64,
    /// Mean of n ⊗ n over the contacts: xx, yy, zz, xy, xz, yz; zeros without any.
    pub tensor: Strains,
}

impl Fabric {
    /// Of these normals of contacts, each between two of so many particles.
    pub(crate) fn of(normals: impl Iterator<Item = [f64; 3]>, particles: usize) -> Self {
        let (mut sum, mut count) = (Strains::default(), 0_u64);
        for normal in normals {
            count += 1;
            for (sum, [row, column]) in sum.iter_mut().zip(STRAIN_PLACES) {
                *sum += normal[row] * normal[column];
            }
        }
        let per = if count > 0 { 1.0 / count as f64 } else { 0.0 };
        let coordination = if particles > 0 { 2.0 * count as f64 / particles as f64 } else { 0.0 };
        Self { coordination, tensor: sum.map(|sum| sum * per) }
    }
}

impl Cell {
    /// Cauchy stress of contacts, bonds and velocities at the present time, tension positive \[Pa\].
    pub(crate) fn stress(&self, state: &State) -> Strains {
        let Some(cell) = &state.cell else { return Strains::default() };
        let mut kinetic = Columns::default();
        for &[u, v, w, mass] in state.grains().map(|grain| grain.velocity) {
            add_dyad(&mut kinetic, &[mass * u, mass * v, mass * w, 0.0], &[u, v, w, 0.0]);
        }
        let kinetic = square(&kinetic);
        let volume = self.volume(state);
        std::array::from_fn(|component| of(&cell.virial, &kinetic, component) / volume)
    }

    /// Volume at the present time \[m³\].
    pub(crate) fn volume(&self, state: &State) -> f64 {
        state.cell.as_ref().map_or(0.0, |cell| self.images.lattice(cell).volume())
    }

    /// Part of the volume that no particle fills; what they overlap counts twice, but not within a clump.
    pub(crate) fn porosity(&self, state: &State) -> f64 {
        let rows =
            state.particles.position.iter().enumerate().filter(|(slot, _)| state.particles.owner[*slot] != IMAGE);
        let volume = |row: &[f64; 4]| 4.0 / 3.0 * std::f64::consts::PI * row[3] * row[3] * row[3];
        let solid: f64 = rows.map(|(slot, row)| self.fullness.share(state, slot) * volume(row)).sum();
        1.0 - solid / self.volume(state)
    }

    /// Finds how stiff the network of these passes is to each component of the strain, where every particle goes with the cell, and how
    /// heavy the particles are.
    pub(crate) fn find_stiffness(&self, state: &mut State, passes: &[Box<dyn Pass>]) {
        let mut sums = Strains::default();
        for pass in passes {
            pass.stiffness(
                state,
                &SearchLimits::default(),
                &Context::ALONE,
                &mut |Link { first, second, normal, stiffness, .. }| {
                    let Some(second) = second else { return };
                    let [a, b] = [first, second].map(|slot| Vector::from(state.carried_point(slot as usize)));
                    let (branch, normal) = ((a - b).to_array(), normal.to_array());
                    for (sum, [row, column]) in sums.iter_mut().zip(STRAIN_PLACES) {
                        let mut unit = Square::default();
                        unit[row][column] = 1.0;
                        let went = Vector::from(times(&unit, branch));
                        let along = went.dot(normal.into());
                        *sum += stiffness[0] * along * along + stiffness[1] * (went.dot(went) - along * along);
                    }
                },
            );
        }
        let (volume, inertia) = (self.volume(state), self.inertia(state));
        if let Some(cell) = &mut state.cell {
            cell.stiffness = sums.map(|sum| sum / volume);
            cell.inertia = inertia;
        }
    }

    /// Mean mass of the particles and clumps over the third root of the volume for each; 0 where there are none \[kg/m\].
    fn inertia(&self, state: &State) -> f64 {
        let (sum, count) = state.grains().fold((0.0, 0_u32), |(sum, count), it| (sum + it.velocity[3], count + 1));
        let each = f64::from(count.max(1));
        sum / each / libm::cbrt(self.volume(state) / each)
    }

    /// Whether a servo moves any component.
    pub(crate) fn serves(&self) -> bool {
        self.motion.iter().any(|motion| motion.servo().is_some())
    }
}
