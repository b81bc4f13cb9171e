//! Scenes of one plane: their rows while time steps are made, and what stops them.

use super::Simulation;
use crate::boundaries::rigid_body;
use crate::integration::plane;
use crate::run_error::RunError;
use crate::scene::{MotionPlane, Scene};
use crate::state::plane_rows::ParticleMotion;
use crate::threads::Context;

/// Time steps from which plane rows are worth the two passes over the particles that making them and leaving them takes.
const WORTH: u64 = 8;

/// Whether the time steps of a scene can be made in plane rows. Outlets, flow meters, sweeps over dashpots of bonds (they are the `others`)
/// and the book of forces look at rows on the way, and where nothing turns there is nothing to spare.
pub(super) fn permits_plane_rows(scene: &Scene, turning: bool, others: bool) -> bool {
    scene.run.plane.is_some() && turning && !others && !scene.output.energy
}

impl Simulation {
    /// Whether time steps are made without the numbers of the third dimension: in a scene of one plane whose particles turn.
    pub fn spares_third_dimension(&self) -> bool {
        self.permits_plane_rows
    }

    /// Lets the particles stand in plane rows if the scene permits that and there are enough steps to come.
    pub(super) fn use_plane_rows(&mut self, steps: u64, context: &Context) {
        let particles = &mut self.state.particles;
        if self.permits_plane_rows && steps >= WORTH && !particles.plane_rows {
            plane::to_plane(particles, context);
        }
    }

    /// Lets them stand in rows of three dimensions again.
    pub(super) fn leave_plane_rows(&mut self, context: &Context) {
        if self.state.particles.plane_rows {
            plane::to_space(&mut self.state.particles, context);
            rigid_body::give_motions(&self.scene, &self.bodies, &mut self.state);
        }
    }

    /// Finds a particle that left the plane in which the scene says that all stay, or is about to.
    pub(super) fn check_plane(&self) -> Result<(), RunError> {
        let Some(MotionPlane::Xz) = self.scene.run.plane else { return Ok(()) };
        let (particles, level) = (&self.state.particles, self.scene.particles.first().map(|first| first.position[1]));
        for slot in 0..particles.len() {
            let ParticleMotion { velocity, spin, force, torque } = particles.motion(slot);
            let y = particles.position[slot][1];
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
