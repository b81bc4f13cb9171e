//! Half kicks of rigid bodies.

use super::{Motion, RigidBody};
use crate::base::geometry::Quaternion;
use crate::base::number::Vector;
use crate::engine::boundaries::{implicit, inertia};
use crate::engine::state::BoundaryState;
use nalgebra::{Matrix6, Vector6};

/// What half a kick makes of the free axes.
struct Kick {
    /// Their motion afterwards.
    motion: Motion,
    /// Angular momentum afterwards \[kg m²/s\].
    momentum: Vector,
    /// Impulse and angular impulse of what stiff contacts add to the inertia \[N s, N m s\].
    added: [f64; 6],
}

impl RigidBody {
    /// Half a kick to the free axes.
    pub(crate) fn kick(&self, moved: &mut BoundaryState, step: f64) {
        let Kick { motion: [velocity, spin], momentum, added } = self.kicked(moved, step);
        let before = moved.angular_velocity;
        for axis in 0..3 {
            if self.moves[axis] {
                moved.inertial.kick[axis] = velocity.to_array()[axis] - moved.velocity[axis];
                moved.velocity[axis] = velocity.to_array()[axis];
            }
        }
        if self.spins() {
            moved.inertial.angular_momentum = momentum.to_array();
            moved.angular_velocity = spin.to_array();
            moved.inertial.spin_kick = (spin - before.into()).to_array();
        }
        self.book(moved, added, step);
    }

    /// Books what half a kick gave beside the particles, weight and damping.
    fn book(&self, moved: &mut BoundaryState, added: [f64; 6], step: f64) {
        let inertial = &mut moved.inertial;
        let freedoms = self.freedoms();
        for axis in (0..6).filter(|&axis| freedoms[axis]) {
            inertial.applied_impulse[axis] += 0.5 * step * inertial.applied[axis];
            inertial.support_impulse[axis] += 0.5 * step * inertial.support[axis];
            inertial.added_impulse[axis] += added[axis];
        }
    }

    /// Angular momentum that half a kick gives \[kg m²/s\].
    fn twist(&self, moved: &BoundaryState, step: f64) -> Vector {
        self.about_free(moved.inertial.couple) * (0.5 * step)
    }

    /// Half a kick with the present load.
    fn kicked(&self, moved: &BoundaryState, step: f64) -> Kick {
        let (orientation, inertial) = (Quaternion::from(moved.orientation), &moved.inertial);
        let before = Vector::from(inertial.angular_momentum);
        let added = if self.is_implicit() {
            implicit::added(&inertial.stiffness.into(), &inertial.damping.into(), self.freedoms(), step)
        } else {
            Matrix6::zeros()
        };
        if added == Matrix6::zeros() {
            let per_mass = if self.moves == [false; 3] { 0.0 } else { 0.5 * step / self.mass };
            let velocity = self.along_free(moved.velocity) + self.along_free(inertial.load) * per_mass;
            let momentum = before + self.twist(moved, step);
            return Kick { motion: [velocity, self.spin(orientation, momentum)], momentum, added: [0.0; 6] };
        }
        let [shift, turn, impulse] = self.kicked_implicitly(moved, &added, step);
        let velocity = self.along_free(moved.velocity) + shift;
        let momentum =
            before + self.about_free(inertia::times(&inertia::turned(&self.inertia, orientation), turn).to_array());
        let [x, y, z] = impulse.to_array();
        let [a, b, c] = (momentum - before - self.twist(moved, step)).to_array();
        Kick { motion: [velocity, self.spin(orientation, momentum)], momentum, added: [x, y, z, a, b, c] }
    }

    /// The change of velocity and of angular velocity by half a kick, and the impulse of what is added to the mass.
    fn kicked_implicitly(&self, moved: &BoundaryState, added: &Matrix6<f64>, step: f64) -> [Vector; 3] {
        let free = self.freedoms();
        let mut own = Matrix6::from_diagonal_element(self.mass);
        own.fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&inertia::turned(&self.inertia, Quaternion::from(moved.orientation)));
        let held = |row: usize, column: usize| if row == column { 1.0 } else { 0.0 };
        let own =
            own.map_with_location(|row, column, part| if free[row] && free[column] { part } else { held(row, column) });
        let force = self.along_free(moved.inertial.load) * (0.5 * step);
        let [[x, y, z], [a, b, c]] = [force, self.twist(moved, step)].map(Vector::to_array);
        let [x, y, z, a, b, c] = implicit::solve(own + added, &Vector6::new(x, y, z, a, b, c)).into();
        let shift = Vector::new(x, y, z);
        [shift, Vector::new(a, b, c), shift * self.mass - force]
    }

    /// Mean of the motion of the free axes before and after half a kick with the present load, and the work of what is
    /// added to the inertia in it \[J\].
    pub(crate) fn mean_motion(&self, moved: &BoundaryState, step: f64) -> (Motion, f64) {
        let Kick { motion: after, added: [x, y, z, a, b, c], .. } = self.kicked(moved, step);
        let before = self.kicked(moved, 0.0).motion;
        let [drift, turn] = [0, 1].map(|part| (before[part] + after[part]) * 0.5);
        ([drift, turn], drift.dot(Vector::new(x, y, z)) + turn.dot(Vector::new(a, b, c)))
    }

    /// Largest speed that one of its spheres can have after half a kick with the present load \[m/s\].
    pub(crate) fn coming_speed(&self, moved: &BoundaryState, step: f64) -> f64 {
        let [velocity, spin] = self.kicked(moved, step).motion;
        velocity.length() + spin.length() * self.farthest
    }

    /// Kinetic energy of the free axes \[J\].
    pub(crate) fn kinetic(&self, moved: &BoundaryState) -> f64 {
        let [velocity, spin] = self.kicked(moved, 0.0).motion;
        0.5 * self.mass * velocity.dot(velocity) + 0.5 * spin.dot(moved.inertial.angular_momentum.into())
    }
}
