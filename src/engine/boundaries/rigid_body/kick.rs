//! Half kicks of rigid bodies.
//!
//! ```text
//! (M + ½ Δt C) Δ = Δt/2 · load
//! ```
//!
//! Δ is the change of motion, M has mass and inertia, C the dashpots to the ground. Both half kicks of a load together give
//! M (v' − v) = Δt (the other loads − C (v + v')/2): the dashpots see the mean of the velocities before and after, take energy
//! whatever the step, and do not limit it.

use super::{Motion, RigidBody};
use crate::base::geometry::Quaternion;
use crate::base::number::Vector;
use crate::engine::boundaries::inertia;
use crate::engine::state::BoundaryState;
use nalgebra::{Matrix3, Vector3};

/// What half a kick makes of the free axes.
struct Kick {
    /// Their motion afterwards.
    motion: Motion,
    /// Angular momentum afterwards \[kg m²/s\].
    momentum: Vector,
    /// Impulse and angular impulse by which dashpots to the ground follow the change of motion \[N s, N m s\].
    following: [Vector; 2],
}

impl RigidBody {
    /// Half a kick to the free axes.
    pub(crate) fn kick(&self, moved: &mut BoundaryState, step: f64) {
        let Kick { motion: [velocity, spin], momentum, following } = self.kicked(moved, step);
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
        self.book(moved, following, step);
    }

    /// Books what half a kick gave beside the particles, weight and damping.
    fn book(&self, moved: &mut BoundaryState, following: [Vector; 2], step: f64) {
        let inertial = &mut moved.inertial;
        let (freedoms, following) = (self.freedoms(), following.map(Vector::to_array).concat());
        for axis in (0..6).filter(|&axis| freedoms[axis]) {
            inertial.applied_impulse[axis] += 0.5 * step * inertial.applied[axis];
            inertial.support_impulse[axis] += 0.5 * step * inertial.support[axis] + following[axis];
        }
    }

    /// Angular momentum that half a kick gives \[kg m²/s\].
    fn twist(&self, moved: &BoundaryState, step: f64) -> Vector {
        self.about_free(moved.inertial.couple) * (0.5 * step)
    }

    /// Half a kick with the present load.
    fn kicked(&self, moved: &BoundaryState, step: f64) -> Kick {
        let (orientation, inertial) = (Quaternion::from(moved.orientation), &moved.inertial);
        let [shifting, turning] = self.dashpots().map(|dashpots| dashpots * (0.5 * step));
        let force = self.along_free(inertial.load);
        let (shift, pulled) = if shifting == Vector::zero() {
            let per_mass = if self.moves == [false; 3] { 0.0 } else { 0.5 * step / self.mass };
            (force * per_mass, Vector::zero())
        } else {
            let (push, shifting) = ((force * (0.5 * step)).to_array(), shifting.to_array());
            let shift = Vector::from([0, 1, 2].map(|axis| push[axis] / (self.mass + shifting[axis])));
            (shift, shift * self.mass - push.into())
        };
        let twist = self.twist(moved, step);
        let turned = if turning == Vector::zero() { twist } else { self.slowed(orientation, twist, turning) };
        let momentum = Vector::from(inertial.angular_momentum) + turned;
        let motion = [self.along_free(moved.velocity) + shift, self.spin(orientation, momentum)];
        Kick { motion, momentum, following: [pulled, turned - twist] }
    }

    /// The angular momentum that an angular impulse gives against dashpots about the axes \[kg m²/s\].
    fn slowed(&self, orientation: Quaternion, twist: Vector, dashpots: Vector) -> Vector {
        let whole = inertia::turned(&self.inertia, orientation);
        let free = |axis: usize| self.freedoms()[3 + axis];
        let held = |row: usize, column: usize| if row == column { 1.0 } else { 0.0 };
        let own = whole
            .map_with_location(|row, column, part| if free(row) && free(column) { part } else { held(row, column) });
        let resisting = own + Matrix3::from_diagonal(&Vector3::from(dashpots.to_array()));
        let turn =
            resisting.cholesky().map_or(Vector3::repeat(f64::NAN), |it| it.solve(&Vector3::from(twist.to_array())));
        self.about_free(inertia::times(&own, <[f64; 3]>::from(turn).into()).to_array())
    }

    /// Mean of the motion of the free axes before and after half a kick with the present load, and the work of what dashpots to the
    /// ground do in following it \[J\].
    pub(crate) fn mean_motion(&self, moved: &BoundaryState, step: f64) -> (Motion, f64) {
        let Kick { motion: after, following, .. } = self.kicked(moved, step);
        let before = self.kicked(moved, 0.0).motion;
        let [drift, turn] = [0, 1].map(|part| (before[part] + after[part]) * 0.5);
        ([drift, turn], drift.dot(following[0]) + turn.dot(following[1]))
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
