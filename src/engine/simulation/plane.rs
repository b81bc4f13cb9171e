//! Scenes of one plane: what stops them.

use super::Simulation;
use crate::engine::run_error::RunError;
use crate::scene::MotionPlane;

impl Simulation {
    /// Finds a particle that left the plane in which the scene says that all stay, or is about to.
    pub(super) fn check_plane(&self) -> Result<(), RunError> {
        let Some(MotionPlane::Xz) = self.scene.run.plane else { return Ok(()) };
        let (particles, level) = (&self.state.particles, self.scene.particles.first().map(|first| first.position[1]));
        for slot in 0..particles.len() {
            let (velocity, spin) = (particles.velocity[slot], particles.angular_velocity[slot]);
            let (y, force, torque) = (particles.position[slot][1], particles.force[slot], particles.torque[slot]);
            let found = [
                ("its y", y, "m", Some(y) != level),
                ("its velocity along y", velocity[1], "m/s", velocity[1] != 0.0),
                ("its angular velocity about x", spin[0], "rad/s", spin[0] != 0.0),
                ("its angular velocity about z", spin[2], "rad/s", spin[2] != 0.0),
                ("the force on it along y", force[1], "N", force[1] != 0.0),
                ("the torque on it about x", torque[0], "N m", torque[0] != 0.0),
                ("the torque on it about z", torque[2], "N m", torque[2] != 0.0),
            ];
            if let Some(&(quantity, value, unit, _)) = found.iter().find(|(.., leaves)| *leaves) {
                return Err(RunError::LeftPlane { id: particles.id[slot], quantity, value, unit, time: self.time() });
            }
        }
        Ok(())
    }
}
