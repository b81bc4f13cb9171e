//! Scenes of one plane: their rows while time steps are made, and what stops them.

use super::Simulation;
use crate::integration::plane::{self, ParticleMotion};
use crate::run_error::RunError;
use crate::scene::{MotionPlane, Scene};
use crate::state::State;
use crate::threads::Context;

/// Time steps from which plane rows are worth the two passes over the particles that making them and leaving them takes.
const WORTH: u64 = 8;

/// Whether the time steps of a scene can be made in plane rows. Groups, bonds and particles that come or go look at rows on the way,
/// and where nothing turns there is nothing to spare.
pub(super) fn permits_plane_rows(scene: &Scene, turning: bool) -> bool {
    let grouped = scene.boundaries.iter().any(|boundary| !boundary.shape.members().is_empty());
    let exchanged = !(scene.insertions.is_empty() && scene.outlets.is_empty() && scene.meters.is_empty());
    scene.run.plane.is_some() && turning && !grouped && !exchanged && scene.bonds.is_empty()
}

impl Simulation {
    /// Lets the particles stand in plane rows if the scene permits that, nobody keeps a book of the steps to come, and there
    /// are enough of them.
    pub(super) fn use_plane_rows(&mut self, steps: u64, context: &Context) {
        let State { ledger, losses, .. } = &self.state;
        let booked = ledger.is_some() || losses.is_some() || !self.followed.is_empty();
        let moved = self.bodies.iter().any(Option::is_some);
        let weight_alone = self.fields.weight_alone().is_some() || !self.fields.act();
        let can = self.permits_plane_rows && !booked && !moved && weight_alone;
        if can && steps >= WORTH && !self.plane_rows {
            plane::to_plane(&mut self.state.particles, context);
            self.plane_rows = true;
        }
    }

    /// Lets them stand in rows of three dimensions again.
    pub(super) fn leave_plane_rows(&mut self, context: &Context) {
        if std::mem::take(&mut self.plane_rows) {
            plane::to_space(&mut self.state.particles, context);
        }
    }

    /// Finds a particle that left the plane in which the scene says that all stay, or is about to.
    pub(super) fn check_plane(&self) -> Result<(), RunError> {
        let Some(MotionPlane::Xz) = self.scene.run.plane else { return Ok(()) };
        let (particles, level) = (&self.state.particles, self.scene.particles.first().map(|first| first.position[1]));
        for slot in 0..particles.len() {
            let ParticleMotion { velocity, spin, force, torque } = ParticleMotion::of(particles, slot, false);
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
