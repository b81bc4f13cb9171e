//! What stops a run before its numbers are nonsense, and how it is told.

use super::{RunError, Simulation};

/// Way of a particle in one time step, over its radius, that is no longer taken for motion.
const RUNAWAY: f64 = 0.5;

impl Simulation {
    /// Refuses a step in which a particle would move further than makes sense.
    pub(super) fn check_way(&self, step: f64) -> Result<(), RunError> {
        let smallest = self.search.smallest_radius();
        if self.state.clock.speed * step <= RUNAWAY * smallest {
            return Ok(());
        }
        let particles = &self.state.particles;
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0) {
            let (velocity, force) = (particles.velocity[slot], particles.force[slot]);
            let next = |axis: usize| velocity[axis] + 0.5 * step / velocity[3] * force[axis];
            let radius = particles.position[slot][3];
            let way = step * (0..3).map(|axis| next(axis) * next(axis)).sum::<f64>().sqrt();
            if way > RUNAWAY * radius {
                return Err(self.runaway(particles.id[slot], way / radius));
            }
        }
        for (body, moved) in self.bodies.iter().zip(&self.state.boundaries) {
            let Some(body) = body else { continue };
            let way = step * body.coming_speed(moved, step);
            if way > RUNAWAY * body.smallest {
                return Err(self.runaway(body.members[0], way / body.smallest));
            }
        }
        Ok(())
    }

    /// A particle that would move further than makes sense.
    fn runaway(&self, id: u32, radii: f64) -> RunError {
        RunError::Runaway { id, radii, time: self.time(), stable: self.state.clock.stable }
    }

    /// Finds what is not finite.
    pub(super) fn not_finite(&self) -> RunError {
        let particles = &self.state.particles;
        let finite = |row: &[f64; 4]| row.iter().all(|number| number.is_finite());
        for slot in 0..particles.len() {
            let quantities = [
                ("position", &particles.position[slot]),
                ("force", &particles.force[slot]),
                ("torque", &particles.torque[slot]),
                ("velocity", &particles.velocity[slot]),
                ("angular velocity", &particles.angular_velocity[slot]),
            ];
            if let Some((quantity, _)) = quantities.into_iter().find(|(_, row)| !finite(row)) {
                let (time, stable) = (self.time(), self.state.clock.stable);
                return RunError::NotFinite { id: particles.id[slot], quantity, time, stable };
            }
        }
        RunError::NotFinite { id: 0, quantity: "speed", time: self.time(), stable: self.state.clock.stable }
    }

    /// Finds a particle outside the domain.
    pub(super) fn check_domain(&self) -> Result<(), RunError> {
        let Some([low, high]) = self.scene.domain else { return Ok(()) };
        let particles = &self.state.particles;
        for (slot, row) in particles.position.iter().enumerate() {
            if (0..3).any(|axis| row[axis] < low[axis] || row[axis] > high[axis]) {
                let [x, y, z, _] = *row;
                return Err(RunError::Escaped { id: particles.id[slot], time: self.time(), x, y, z });
            }
        }
        Ok(())
    }

    /// The number in the scene of a particle by its index.
    fn number(&self, index: u32) -> u32 {
        self.scene.particles.get(index as usize).map_or(index, |particle| particle.id.0)
    }

    /// The error with the particle's number in the scene instead of its index.
    pub(super) fn named(&self, mut error: RunError) -> RunError {
        match &mut error {
            RunError::Runaway { id, .. }
            | RunError::NotFinite { id, .. }
            | RunError::Behind { id, .. }
            | RunError::Escaped { id, .. } => *id = self.number(*id),
            RunError::Overbent { first, second, .. } => {
                (*first, *second) = (self.number(*first), second.map(|second| self.number(second)));
            }
            RunError::StepTooLong { .. }
            | RunError::Turn { .. }
            | RunError::PutAtPlane { .. }
            | RunError::Interval { .. }
            | RunError::GroupElsewhere { .. }
            | RunError::Memory { .. } => {}
        }
        error
    }
}
