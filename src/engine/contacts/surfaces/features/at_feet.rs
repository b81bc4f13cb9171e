//! Particles at their feet on a surface, as batches see them.

use super::standing::MovingSurface;
use crate::base::lanes::Lane;
use crate::base::number::Vector;
use crate::engine::contacts::batches::{Bodies, ContactGeometry, FOUND, Touching};
use crate::engine::contacts::coefficients::CoefficientTable;
use crate::engine::contacts::surfaces::nodes::HeldColumns;
use crate::engine::contacts::surfaces::sphere::{Load, ParticleLoads, SphereAt, along};
use crate::engine::state::Row;
use crate::engine::state::heat::Level;
use crate::laws::contact::Needs;

/// Particles at their feet on a surface. The second body of an entry is the number of its foot.
#[derive(Clone, Copy)]
pub(super) struct AtFeet<'a> {
    /// The surface, where it stands.
    pub(super) at: MovingSurface<'a>,
    /// The particle of each foot.
    pub(super) particle: &'a [u32],
    /// Numbers of the feet.
    pub(super) number: &'a [u32],
    /// Normals and distances.
    pub(super) foot: &'a [Row],
    /// How often the normal force counts, the share of friction, and how often the energy counts; empty where all count once.
    pub(super) weight: &'a [[f64; 3]],
    /// How the surface moves at each, where nodes move one by one.
    pub(super) held: Option<HeldColumns<'a>>,
    /// The surface's material.
    pub(super) material: u32,
    /// Which share of the heat of losses the surface takes.
    pub(super) share_of_heat: f64,
    /// Its temperature, where its nodes have none.
    pub(super) level: Level,
    /// The particles.
    pub(super) particles: ParticleLoads<'a>,
}

impl Bodies for AtFeet<'_> {
    type Sum = Load;
    const FOUND: usize = 0;

    fn first(&self) -> &[u32] {
        self.particle
    }

    fn second(&self) -> &[u32] {
        self.number
    }

    #[inline(always)]
    unsafe fn touch<N: Lane>(
        &self,
        _first: *const u32,
        _second: *const u32,
        _beyond: Option<N>,
        _load: &mut Load,
    ) -> (u32, [N; FOUND]) {
        // A foot is there because it is touched.
        (u32::MAX, [N::zero(); FOUND])
    }

    #[inline(always)]
    fn roots<N: Lane>(_found: &[N; FOUND]) -> [N; 2] {
        [N::zero(); 2]
    }

    #[inline(always)]
    unsafe fn meet<N: Lane, const TORQUE: bool>(
        &self,
        first: *const u32,
        second: *const u32,
        _found: [N; FOUND],
        _roots: [N; 2],
    ) -> ContactGeometry<N> {
        // SAFETY: entries are slots of particles and numbers of feet.
        let (foot, position, motion, moving) = unsafe {
            let foot = N::load_rows(self.foot.as_ptr(), second);
            let position = N::load_rows(self.particles.position.as_ptr(), first);
            (foot, position, self.particles.motion::<N, TORQUE>(first), self.held.map(|held| held.motion(second)))
        };
        let sphere = SphereAt { normal: Vector::of_row(foot), distance: foot[3], radius: position[3] };
        self.at.meet(&sphere, position, motion, moving, N::zero())
    }

    fn weights(&self) -> Option<&[[f64; 3]]> {
        (!self.weight.is_empty()).then_some(self.weight)
    }

    fn row(&self, table: &CoefficientTable, first: u32, _second: u32) -> u32 {
        table.entry(self.particles.material[first as usize], self.material)
    }

    fn warm(&self, first: u32, second: u32, heat: f64, load: &mut Load) {
        // SAFETY: each particle is in one piece, and each piece is worked on by one thread.
        unsafe {
            self.particles.warm(first, heat, self.share_of_heat, load);
            if let Some(held) = self.held {
                held.warm(second as usize, heat * self.share_of_heat);
            }
        }
    }

    fn conduct(&self, [first, second]: [&[u32]; 2], conductance: &[f64], load: &mut Load) {
        for ((&slot, &number), &conductance) in first.iter().zip(second).zip(conductance) {
            let number = number as usize;
            let conductance = self.weight.get(number).map_or(conductance, |[.., weight]| conductance * weight);
            // SAFETY: as above.
            unsafe {
                let level = self.held.and_then(|held| held.level(number)).unwrap_or(self.level);
                let flow = self.particles.conduct(slot, level, conductance, load);
                if let Some(held) = self.held {
                    held.take(number, [flow, conductance]);
                }
            }
        }
    }

    #[inline(always)]
    fn spread(&self, touching: &Touching, needs: Needs, load: &mut Load) {
        let Touching { first, second, force, couple, rolling, first_arm, .. } = *touching;
        for place in 0..first.len() {
            let (slot, number) = (first[place] as usize, second[place] as usize);
            let normal = Vector::from(self.foot[number]);
            let mut loads = [force[place], couple[place], rolling[place]];
            if let Some(&[weight, share, _]) = self.weight.get(number) {
                let whole = Vector::from(force[place]);
                let along = normal * whole.dot(normal);
                loads[0] = (along * weight + (whole - along) * share).row_with(0.0);
                loads[1] = loads[1].map(|part| part * share);
                loads[2] = loads[2].map(|part| part * share);
            }
            if self.at.conveys {
                load.conveying_power += along(self.at.conveying, normal).dot(loads[0].into());
            }
            // SAFETY: each particle is in one piece, and each piece is worked on by one thread.
            unsafe {
                if let Some(held) = self.held {
                    held.note(number, loads[0], needs.spin.then_some(loads[2]));
                }
                self.particles.add(slot, (normal, first_arm[place]), &loads, needs, (self.at.pivot, &mut *load));
            }
        }
    }
}
