//! Pairs of particles, whose loads go to both.

use crate::base::lanes::{Lane, Shared};
use crate::base::memory::prefetch;
use crate::base::number::{Number, add, subtract};
use crate::engine::contacts::batches::{Bodies, ContactGeometry, FOUND, SpherePair, Touching};
use crate::engine::contacts::coefficients::CoefficientTable;
use crate::engine::state::Row;
use crate::engine::state::heat::exchange;
use crate::laws::contact::Needs;
use std::ops::Range;

/// Pairs of particles.
#[derive(Clone, Copy)]
pub(super) struct Pairs<'a> {
    /// First particle of each pair.
    pub first: &'a [u32],
    /// Second particle of each pair.
    pub second: &'a [u32],
    /// Positions and radii.
    pub position: &'a [Row],
    /// Velocities and masses.
    pub velocity: &'a [Row],
    /// Angular velocities.
    pub angular_velocity: &'a [Row],
    /// Materials.
    pub material: &'a [u32],
    /// Forces.
    pub force: Shared<Row>,
    /// Torques.
    pub torque: Shared<Row>,
    /// Heat of losses \[J\]; empty where none warms the particles.
    pub heat: Shared<f64>,
    /// Temperatures and heat flows; empty where nothing conducts.
    pub present: Shared<Row>,
}

impl Bodies for Pairs<'_> {
    type Sum = ();
    const FOUND: usize = FOUND;

    fn first(&self) -> &[u32] {
        self.first
    }

    fn second(&self) -> &[u32] {
        self.second
    }

    #[inline(always)]
    unsafe fn touch<N: Lane>(
        &self,
        first: *const u32,
        second: *const u32,
        beyond: Option<N>,
        _sum: &mut (),
    ) -> (u32, [N; FOUND]) {
        let positions = self.position.as_ptr();
        // SAFETY: a list holds slots of particles, below their number.
        let pair = unsafe { SpherePair::of([N::load_rows(positions, first), N::load_rows(positions, second)]) };
        (N::bits(pair.overlap(beyond)), pair.to_found())
    }

    #[inline(always)]
    fn roots<N: Lane>(found: &[N; FOUND]) -> [N; 2] {
        SpherePair::from_found(*found).roots()
    }

    #[inline(always)]
    unsafe fn meet<N: Lane, const TORQUE: bool>(
        &self,
        first: *const u32,
        second: *const u32,
        found: [N; FOUND],
        roots: [N; 2],
    ) -> ContactGeometry<N> {
        let (v, w) = (self.velocity.as_ptr(), self.angular_velocity.as_ptr());
        // SAFETY: a list holds slots of particles, below their number.
        let (velocities, spins) = unsafe {
            let spins = if TORQUE { [N::load_rows(w, first), N::load_rows(w, second)] } else { [[N::zero(); 4]; 2] };
            ([N::load_rows(v, first), N::load_rows(v, second)], spins)
        };
        SpherePair::from_found(found).meet_at(roots, velocities, spins, N::zero())
    }

    #[inline(always)]
    fn smaller_radius<N: Number>([.., radius_i, radius_j]: [N; FOUND], _effective: N) -> N {
        radius_i.min(radius_j)
    }

    fn row(&self, table: &CoefficientTable, first: u32, second: u32) -> u32 {
        table.entry(self.material[first as usize], self.material[second as usize])
    }

    fn prefetch(&self, slots: Range<usize>, needs: Needs) {
        // A line of the cache holds two rows.
        for slot in slots.step_by(2) {
            prefetch(self.position.as_ptr().wrapping_add(slot));
            prefetch(self.velocity.as_ptr().wrapping_add(slot));
            prefetch(self.force.pointer().wrapping_add(slot));
            if needs.torque {
                prefetch(self.angular_velocity.as_ptr().wrapping_add(slot));
                prefetch(self.torque.pointer().wrapping_add(slot));
            }
        }
    }

    fn warm(&self, first: u32, second: u32, heat: f64, _sum: &mut ()) {
        for slot in [first, second] {
            // SAFETY: slabs worked on at the same time do not share particles.
            unsafe { *self.heat.at(slot as usize) += 0.5 * heat };
        }
    }

    fn conduct(&self, [first, second]: [&[u32]; 2], conductance: &[f64], _sum: &mut ()) {
        for ((&first, &second), &conductance) in first.iter().zip(second).zip(conductance) {
            // SAFETY: slabs worked on at the same time do not share particles.
            unsafe { exchange([self.present.at(first as usize), self.present.at(second as usize)], conductance) };
        }
    }

    #[inline(always)]
    fn spread(&self, touching: &Touching, needs: Needs, _sum: &mut ()) {
        let Touching { first, second, force, .. } = *touching;
        for place in 0..first.len() {
            let (i, j) = (first[place] as usize, second[place] as usize);
            // SAFETY: slabs worked on at the same time do not share particles.
            unsafe {
                add(self.force.at(i), &force[place]);
                subtract(self.force.at(j), &force[place]);
                if needs.torque {
                    let [mut on_i, mut on_j] = touching.torques(place);
                    if needs.spin {
                        subtract(&mut on_i, &touching.rolling[place]);
                        add(&mut on_j, &touching.rolling[place]);
                    }
                    add(self.torque.at(i), &on_i);
                    add(self.torque.at(j), &on_j);
                }
            }
        }
    }
}
