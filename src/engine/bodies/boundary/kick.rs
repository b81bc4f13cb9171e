//! Half kicks of rigid bodies.
//!
//! ```text
//! (M + ½ Δt C) Δ = Δt/2 · load
//! ```
//!
//! Δ is the change of motion, M has mass and inertia, C the dashpots to the ground. Both half kicks of a load together give
//! M (v' − v) = Δt (the other loads − C (v + v')/2): the dashpots see the mean of the velocities before and after, take energy
//! whatever the step, and do not limit it.

use super::{RigidBody, inertia};
use crate::base::geometry::Quaternion;
use crate::base::number::Vector;
use crate::engine::bodies::Rigid;
use crate::engine::state::BoundaryState;
use nalgebra::{Matrix3, Vector3};

/// What half a kick makes of the free axes.
pub(in crate::engine::bodies) struct Kick {
    /// How they move afterwards.
    pub(in crate::engine::bodies) after: Rigid,
    /// Impulse and angular impulse by which dashpots to the ground follow the change of motion \[N s, N m s\].
    pub(in crate::engine::bodies) following: [Vector; 2],
}

impl RigidBody {
    /// Half a kick to the free axes.
    pub(crate) fn kick(&self, moved: &mut BoundaryState, step: f64) {
        let Kick { after, following } = self.kicked(moved, step);
        let (velocity, spin, before) = (after.velocity.to_array(), after.spin(), moved.angular_velocity);
        for axis in 0..3 {
            if self.moves[axis] {
                moved.inertial.kick[axis] = velocity[axis] - moved.velocity[axis];
                moved.velocity[axis] = velocity[axis];
            }
        }
        if self.spins() {
            moved.inertial.angular_momentum = after.momentum.to_array();
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

    /// Half a kick with the present load.
    pub(in crate::engine::bodies) fn kicked(&self, moved: &BoundaryState, step: f64) -> Kick {
        let (half, rigid) = (0.5 * step, self.rigid(moved));
        let [shifting, turning] = self.dashpots().map(|dashpots| dashpots * half);
        let (mut after, mut following) = (rigid.kicked(half), [Vector::zero(); 2]);
        if shifting != Vector::zero() {
            let (push, shifting) = ((rigid.force * half).to_array(), shifting.to_array());
            let shift = Vector::from([0, 1, 2].map(|axis| push[axis] / (self.mass + shifting[axis])));
            after.velocity = rigid.velocity + shift;
            following[0] = shift * self.mass - push.into();
        }
        if turning != Vector::zero() {
            let twist = rigid.moment * half;
            let turned = self.slowed(Quaternion::from(moved.orientation), twist, turning);
            after.momentum = rigid.momentum + turned;
            following[1] = turned - twist;
        }
        Kick { after, following }
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
}
