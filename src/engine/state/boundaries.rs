//! Where the boundaries stand and what they feel.

use super::Row;
use crate::base::geometry::Quaternion;
use serde::{Deserialize, Serialize};

/// Motion and loads of one boundary. Force and moment are those *of the particles on the boundary*.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundaryState {
    /// Displacement since time 0 \[m\].
    pub displacement: [f64; 3],
    /// Velocity in the present time step, of free axes at the present time \[m/s\].
    pub velocity: [f64; 3],
    /// Rotation vector since time 0, in global axes \[rad\].
    pub rotation: [f64; 3],
    /// Angular velocity in the present time step, of free axes at the present time \[rad/s\].
    pub angular_velocity: [f64; 3],
    /// Orientation that the rotation vector stands for.
    pub orientation: Orientation,
    /// The reference point where it stands now \[m\].
    pub pivot: [f64; 3],
    /// Where it stood before the present time step.
    pub before: Stand,
    /// By whole edges of a periodic cell: how far its surface is before where it has come to \[m\].
    pub brought_back: [f64; 3],
    /// Where the present communication step began: along x, y, z \[m\] and about them \[rad\]; of axes that take a force, the force
    /// that was given then \[N, N m\].
    pub start: [f64; 6],
    /// Where it is to end, in the same order.
    pub end: [f64; 6],
    /// The last values given, in the unit of the input; of prescribed axes where they stood at time 0.
    pub target: [f64; 6],
    /// Rates of the inputs at the start of the communication step; 0 where none was given.
    pub target_rate: [f64; 6],
    /// Second derivatives of the inputs along x, y, z; 0 where none was given \[m/s²\].
    pub target_acceleration: [f64; 3],
    /// Accelerations along x, y, z in the present communication step, where its motion is quadratic \[m/s²\].
    pub acceleration: [f64; 3],
    /// Orientation when the present communication step began.
    pub start_orientation: Orientation,
    /// Rotation vector from there to its end \[rad\].
    pub turn: [f64; 3],
    /// Largest speed of each driven axis on the way to it, signed \[m/s, rad/s\].
    pub fastest: [f64; 6],
    /// What servos press on, along x, y, z; zeros for others.
    pub pressed: [Pressed; 3],
    /// What free axes need.
    pub inertial: Inertial,
    /// Force at the present time \[N\].
    pub force: [f64; 3],
    /// Moment about the moved reference point at the present time \[N m\].
    pub moment: [f64; 3],
    /// Force one time step ago; the present one before the first \[N\].
    pub force_before: [f64; 3],
    /// Moment one time step ago \[N m\].
    pub moment_before: [f64; 3],
    /// Power of a surface that runs in itself, on the particles, at the present time \[W\].
    pub conveying_power: f64,
    /// Sum of the half-kick impulses of the present communication step \[N s\].
    pub impulse: [f64; 3],
    /// Sum of the same impulses times the time from the middle of the communication step to each \[N s²\]; 0 unless the motion is
    /// quadratic.
    pub first_moment: [f64; 3],
    /// Sum of the half-kick angular impulses of the present communication step \[N m s\].
    pub angular_impulse: [f64; 3],
    /// Mean force over the last communication step \[N\].
    pub mean_force: [f64; 3],
    /// Slope of the straight line through the force over the last communication step, from its first moment \[N/s\].
    pub force_slope: [f64; 3],
    /// Mean moment over the last communication step \[N m\].
    pub mean_moment: [f64; 3],
    /// Impulse since time 0 along axes that are not free, for the momentum balance \[N s\].
    pub total_impulse: [f64; 3],
    /// Work done by the boundary on the particles since time 0 \[J\]. Free axes do none.
    pub work: f64,
}

impl BoundaryState {
    /// Where it stands.
    pub(crate) fn stand(&self) -> Stand {
        Stand { displacement: self.displacement, orientation: self.orientation }
    }

    /// How far from its place at time 0 its surface stands; in a periodic cell, that of its copies which is nearest to it \[m\].
    pub(crate) fn shift(&self) -> [f64; 3] {
        self.shift_at(&self.stand())
    }

    /// The same where the boundary stood there.
    pub(crate) fn shift_at(&self, stand: &Stand) -> [f64; 3] {
        [0, 1, 2].map(|axis| stand.displacement[axis] - self.brought_back[axis])
    }

    /// Rates of force and moment after a time step of this length \[s\], 0 before the first \[N/s, N m/s\].
    pub(crate) fn rates(&self, step: f64) -> [[f64; 3]; 2] {
        let Self { force, moment, force_before, moment_before, .. } = self;
        let rate = |axis: usize, now: &[f64; 3], before: &[f64; 3]| {
            if step > 0.0 { (now[axis] - before[axis]) / step } else { 0.0 }
        };
        [[0, 1, 2].map(|axis| rate(axis, force, force_before)), [0, 1, 2].map(|axis| rate(axis, moment, moment_before))]
    }

    /// Counts impulse and work from here.
    pub(super) fn begin_counting(&mut self) {
        (self.total_impulse, self.work) = ([0.0; 3], 0.0);
        let Inertial { applied_impulse, support_impulse, .. } = &mut self.inertial;
        (*applied_impulse, *support_impulse) = ([0.0; 6], [0.0; 6]);
    }
}

/// What a servo presses on, as it was looked at last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pressed {
    /// Mechanical impedance of what touches; 0 where nothing does \[kg/s\].
    pub impedance: f64,
    /// Stiffness of what touches; 0 where nothing does \[N/m\].
    pub stiffness: f64,
    /// Force on the boundary then \[N\].
    pub force: f64,
    /// The way that a time step may go towards the target, by the stiffness felt last near it; 0 where none was \[m\].
    pub way: f64,
}

impl Pressed {
    /// Whether what touches, by the force \[N\], is not what it was.
    pub(crate) fn has_changed(&self, force: f64) -> bool {
        let (now, then) = (force.abs(), self.force.abs());
        (force == 0.0) != (self.stiffness == 0.0) || now > 2.0 * then || then > 2.0 * now
    }

    /// Takes over stiffness \[N/m\], impedance \[kg/s\] and force \[N\], where the force is to reach a target \[N\].
    pub(crate) fn take(&mut self, [stiffness, impedance, force]: [f64; 3], target: f64) {
        let is_near = force.abs() >= 0.5 * target.abs();
        if stiffness > 0.0 && (is_near || self.way == 0.0) {
            self.way = 0.5 * target.abs() / stiffness;
        }
        (self.stiffness, self.impedance, self.force) = (stiffness, impedance, force);
    }
}

/// Where a boundary stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stand {
    /// Displacement since time 0 \[m\].
    pub displacement: [f64; 3],
    /// Orientation.
    pub orientation: Orientation,
}

/// What moves the free axes of a boundary, and what it gave them. Zero where none is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inertial {
    /// Angular momentum about the reference point \[kg m²/s\].
    pub angular_momentum: [f64; 3],
    /// Force on the body: of the particles, weight, applied forces, springs and dashpots to the ground, damping \[N\].
    pub load: [f64; 3],
    /// Moment of all these about the moved reference point \[N m\].
    pub couple: [f64; 3],
    /// The part of the force that is global damping \[N\].
    pub braking_force: [f64; 3],
    /// The part of the moment that is global damping \[N m\].
    pub braking_moment: [f64; 3],
    /// What the last half kick added to the velocity \[m/s\].
    pub kick: [f64; 3],
    /// What the last half kick added to the angular velocity \[rad/s\].
    pub spin_kick: [f64; 3],
    /// The input load at the present time \[N, N m\].
    pub applied: [f64; 6],
    /// What springs and dashpots to the ground do at the present time \[N, N m\].
    pub support: [f64; 6],
    /// Impulse of the input loads since time 0 \[N s, N m s\].
    pub applied_impulse: [f64; 6],
    /// Impulse of springs and dashpots to the ground since time 0 \[N s, N m s\].
    pub support_impulse: [f64; 6],
}

/// A unit quaternion: scalar, x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Orientation(pub Row);

impl From<Quaternion> for Orientation {
    fn from(orientation: Quaternion) -> Self {
        Self(orientation.to_row())
    }
}

impl From<Orientation> for Quaternion {
    fn from(orientation: Orientation) -> Self {
        Self::from_row(orientation.0)
    }
}

impl Default for Orientation {
    /// As at time 0.
    fn default() -> Self {
        Self([1.0, 0.0, 0.0, 0.0])
    }
}

impl BoundaryState {
    /// Whether every number is finite.
    pub(super) fn is_finite(&self) -> bool {
        let Self {
            displacement, velocity, rotation, angular_velocity, orientation, pivot, start, target, fastest, ..
        } = self;
        let Self { target_rate, start_orientation, turn, inertial, force, moment, impulse, .. } = self;
        let Self { angular_impulse, mean_force, mean_moment, total_impulse, work, .. } = self;
        let Self { target_acceleration, acceleration, first_moment, force_slope, .. } = self;
        let Self { force_before, moment_before, before, brought_back, .. } = self;
        let triples = [
            displacement,
            velocity,
            rotation,
            angular_velocity,
            pivot,
            turn,
            force,
            moment,
            impulse,
            angular_impulse,
            mean_force,
            mean_moment,
            total_impulse,
            target_acceleration,
            acceleration,
            first_moment,
            force_slope,
            force_before,
            moment_before,
            &before.displacement,
            brought_back,
            &inertial.angular_momentum,
            &inertial.load,
            &inertial.couple,
            &inertial.braking_force,
            &inertial.braking_moment,
            &inertial.kick,
            &inertial.spin_kick,
        ];
        let sixes = [
            start,
            &self.end,
            target,
            target_rate,
            fastest,
            &inertial.applied,
            &inertial.support,
            &inertial.applied_impulse,
            &inertial.support_impulse,
        ];
        let rows = [orientation.0, start_orientation.0, before.orientation.0];
        triples.into_iter().flatten().chain(sixes.into_iter().flatten()).all(|number| number.is_finite())
            && rows.iter().flatten().all(|number| number.is_finite())
            && work.is_finite()
            && self.pressed.iter().all(Pressed::is_finite)
    }
}

impl Pressed {
    /// Whether all numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        let Self { impedance, stiffness, force, way } = *self;
        [impedance, stiffness, force, way].iter().all(|number| number.is_finite())
    }
}
