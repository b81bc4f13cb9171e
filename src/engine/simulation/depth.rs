//! Overlaps larger than any contact law is valid for.

use super::run_checks::COLLAPSING_COHESION;
use super::{RunError, Simulation};
use crate::base::number::Vector;
use crate::engine::run_error::Cause;
use crate::engine::state::contacts::TOUCHING;
use crate::laws::motion::InputCourse;

/// Overlap over the smaller radius at which the centre of one particle is inside the other: no contact law is valid there.
const DEEPEST: f64 = 1.0;

/// Distance moved between two checks, over the smallest radius: particles cannot pass through each other unnoticed.
const BETWEEN_LOOKS: f64 = 0.25;

/// Way in one stable time step over the depth below which bodies are squeezed rather than thrown into each other. The time
/// from touch to rest is π/2 times the stable step where their contact limits that, and more where a stiffer one does.
const SLOW: f64 = 0.01;

/// Distance moved in one time step, over the smallest radius, above which every step is checked.
const FAST: f64 = 0.1;

impl Simulation {
    /// Whether overlaps are to be checked in a step in which bodies move by at most `way` \[m\], and the largest displacement since the
    /// neighbour lists were made grows from `before` to `after` \[m\]: where `way` is large, or the displacement passes the next quarter
    /// of the smallest radius.
    pub(super) fn is_depth_due(&self, way: f64, [before, after]: [f64; 2]) -> bool {
        let smallest = self.search.smallest_radius();
        let looks = |travel: f64| (travel / (BETWEEN_LOOKS * smallest)).floor();
        let due = way > FAST * smallest || looks(after) > looks(before);
        due && !self.scene.run.allow_unstable
    }

    /// Stops where one particle's centre is inside another: cohesion has pulled it there, an impact or a load has pushed
    /// it. What the scene put there, bonded bodies and jumps of a boundary are not judged.
    pub(super) fn check_depth(&self) -> Result<(), RunError> {
        let particles = &self.state.particles;
        for list in &self.state.contacts {
            for place in (0..list.flags.len()).filter(|&place| list.flags[place] & TOUCHING != 0) {
                let slots = [list.first[place], list.second[place]];
                let [a, b] = slots.map(|slot| particles.position[slot as usize]);
                let apart = Vector::from(a) - Vector::from(b);
                let overlap = (a[3] + b[3] - apart.length()) / a[3].min(b[3]);
                if overlap > DEEPEST
                    && let Some(cause) = self.cause_of_depth(slots, apart)
                {
                    let [first, second] = slots.map(|slot| particles.id[slot as usize]);
                    return Err(RunError::Crushed { first, second, overlap, time: self.time(), cause });
                }
            }
        }
        Ok(())
    }

    /// Why two particles (slots) overlap that far, whose centres are this vector apart \[m\]; none where the scene says so.
    fn cause_of_depth(&self, slots: [u32; 2], apart: Vector) -> Option<Cause> {
        let particles = &self.state.particles;
        let [one, other] = slots.map(|slot| particles.material[slot as usize] as usize);
        let cohesive = self.scene.cohesion_ratio(one, other).filter(|ratio| *ratio > COLLAPSING_COHESION);
        if let Some(ratio) = cohesive {
            return Some(Cause::Cohesion { ratio, bound: COLLAPSING_COHESION });
        }
        let ids = slots.map(|slot| particles.id[slot as usize]);
        let jumps = self.scene.boundaries.iter().any(|boundary| boundary.input == InputCourse::Hold);
        if jumps || self.began_deep(ids) || self.are_bonded(slots) {
            return None;
        }
        let [u, v] = slots.map(|slot| Vector::from(particles.velocity[slot as usize]));
        let closing = -(u - v).dot(apart) / apart.length();
        let depth =
            particles.position[slots[0] as usize][3] + particles.position[slots[1] as usize][3] - apart.length();
        Some(self.step_as_cause().unwrap_or_else(|| self.impact_or_load(closing, depth)))
    }

    /// What pressed bodies to this overlap \[m\], which approach each other at this speed \[m/s\]: an impact takes about half an
    /// oscillation of the contact, a load any time.
    pub(super) fn impact_or_load(&self, closing: f64, depth: f64) -> Cause {
        if closing * self.state.clock.stable > SLOW * depth { Cause::Impact { speed: closing } } else { Cause::Load }
    }

    /// Whether the scene puts two particles (index) so deep into each other that they may get there again.
    fn began_deep(&self, ids: [u32; 2]) -> bool {
        let [Some(a), Some(b)] = ids.map(|id| self.scene.particles.get(id as usize)) else { return false };
        let apart = (Vector::from(a.position) - Vector::from(b.position)).length();
        a.radius + b.radius - apart > 0.5 * DEEPEST * a.radius.min(b.radius)
    }

    /// Whether a bond holds two particles (slots).
    fn are_bonded(&self, slots: [u32; 2]) -> bool {
        let [i, j] = slots;
        let holds = |pair: (&u32, &u32)| pair == (&i, &j) || pair == (&j, &i);
        self.state.bonds.iter().any(|list| list.first.iter().zip(&list.second).any(holds))
    }
}
