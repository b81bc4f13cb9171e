//! How bonded bodies move and resist motion, and what their bonds feel of it.

use super::System;
use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::bodies;
use crate::engine::bonds::clusters;
use crate::engine::contacts::{Frame, Link, SearchLimits};
use crate::engine::state::ledger::Source;
use nalgebra::{Matrix3, Vector3};

/// Velocity and angular velocity, or their derivatives in time.
pub(super) type Twist = [Vector; 2];

/// How a body resists motion.
pub(super) struct Inertia {
    /// Mass along each axis, 0 along those that forces do not move \[kg\].
    pub(super) mass: [f64; 3],
    /// Moments of inertia about its point of reference, 0 where it does not turn \[kg m²\].
    pub(super) turning: Matrix3<f64>,
    /// Whether forces move it along and about all axes; along some; or not at all.
    pub(super) support: Option<bool>,
}

impl Inertia {
    /// What of a motion is along and about axes along and about which it has inertia: others are led.
    pub(super) fn moved(&self, [along, about]: Twist) -> Twist {
        let turns = self.turning.diagonal();
        let of = |vector: Vector, holds: [bool; 3]| {
            let parts = vector.to_array();
            Vector::from([0, 1, 2].map(|axis| if holds[axis] { parts[axis] } else { 0.0 }))
        };
        [of(along, self.mass.map(|mass| mass > 0.0)), of(about, [0, 1, 2].map(|axis| turns[axis] > 0.0))]
    }

    /// Half of the mass times the square of a motion.
    pub(super) fn half_square(&self, [along, about]: Twist) -> f64 {
        let [x, y, z] = along.to_array();
        let [a, b, c] = self.mass;
        0.5 * (a * x * x + b * y * y + c * z * z + about.dot(times(&self.turning, about)))
    }
}

/// A bond between two bodies.
pub(super) struct Joint {
    /// The bodies.
    pub(super) bodies: [usize; 2],
    /// From the point of reference of each to where it acts \[m\].
    pub(super) points: [Vector; 2],
    /// Its axis.
    pub(super) normal: Vector,
    /// Stiffness.
    pub(super) stiffness: Frame,
}

impl Joint {
    /// Half of the stiffness times the square of these motions of its bodies.
    pub(super) fn half_square(&self, [[velocity, spin], [other, turn]]: [Twist; 2]) -> f64 {
        let slip = velocity + spin.cross(self.points[0]) - other - turn.cross(self.points[1]);
        let turning = spin - turn;
        let parts = |vector: Vector| {
            let along = vector.dot(self.normal);
            [along * along, (vector.dot(vector) - along * along).max(0.0)]
        };
        let ([along, across], [twist, bend]) = (parts(slip), parts(turning));
        let [kn, kt, kz, kb] = self.stiffness;
        0.5 * (kn * along + kt * across + kz * twist + kb * bend)
    }
}

/// A matrix times a vector.
pub(super) fn times(matrix: &Matrix3<f64>, vector: Vector) -> Vector {
    let [x, y, z] = vector.to_array();
    let found = matrix * Vector3::new(x, y, z);
    Vector::new(found.x, found.y, found.z)
}

/// Moments of inertia of a mass \[kg\] at this place \[m\].
pub(super) fn of_point(mass: f64, place: Vector) -> Matrix3<f64> {
    let [x, y, z] = place.to_array();
    let place = Vector3::new(x, y, z);
    (Matrix3::identity() * place.norm_squared() - place * place.transpose()) * mass
}

impl System<'_> {
    /// Tells every bond, and once more what its tension adds.
    pub(super) fn each_joint(&self, tell: &mut dyn FnMut(Joint)) {
        let present = SearchLimits::default();
        for pass in self.passes.iter().filter(|pass| pass.source() == Source::Bonds) {
            pass.stiffness(self.state, &present, &Context::ALONE, &mut |link| tell(self.joint(&link)));
        }
    }

    /// A bond as one between the bodies that move its particles.
    pub(super) fn joint(&self, link: &Link) -> Joint {
        let (normal, stiffness) = (link.normal, link.stiffness);
        let first = self.end(link.first, normal * -link.arms[0]);
        let other = match (link.second, link.boundary) {
            (Some(second), _) => self.end(second, normal * link.arms[1]),
            (None, Some(boundary)) => {
                let body = self.state.particles.len() + boundary as usize;
                let centre = Vector::from(self.state.particles.position[link.first as usize]);
                (body, centre + normal * -link.arms[0] - self.reference(body))
            }
            (None, None) => first,
        };
        Joint { bodies: [first.0, other.0], points: [first.1, other.1], normal, stiffness }
    }

    /// The body that moves a particle (slot), and from its point of reference to a point that is there from the centre of the particle \[m\].
    pub(super) fn end(&self, slot: u32, from_centre: Vector) -> (usize, Vector) {
        let body = clusters::mover(self.state, slot);
        if body < self.state.particles.len() {
            return (body, from_centre);
        }
        let original = self.state.particles.original(slot) as usize;
        let centre = match self.state.clump(original) {
            // A clump is brought back into a cell with its mass centre, a group stays where its pivot is.
            Some(_) => Vector::from(self.state.particles.position[original]),
            None => self.state.unwrapped(original).into(),
        };
        (body, centre - self.reference(body) + from_centre)
    }

    /// The point of reference of a body \[m\].
    pub(super) fn reference(&self, body: usize) -> Vector {
        let (particles, boundaries) = (self.state.particles.len(), self.state.boundaries.len());
        match body.checked_sub(particles) {
            None => self.state.particles.position[body].into(),
            Some(group) if group < boundaries => self.state.boundaries[group].pivot.into(),
            Some(group) => self.state.clumps.position[group - boundaries].into(),
        }
    }

    /// Velocity and acceleration of a body, with what it turns by.
    pub(super) fn motions(&self, body: usize) -> [Twist; 2] {
        let (particles, boundaries) = (&self.state.particles, &self.state.boundaries);
        let Some(group) = body.checked_sub(particles.len()) else {
            let (velocity, spin) = (particles.velocity[body], particles.angular_velocity[body]);
            let (force, torque) = (Vector::from(particles.force[body]), Vector::from(particles.torque[body]));
            return [[velocity.into(), spin.into()], [force * (1.0 / velocity[3]), torque * (1.0 / spin[3])]];
        };
        if group < boundaries.len() {
            let moved = &boundaries[group];
            let velocity = [moved.velocity.into(), moved.angular_velocity.into()];
            let Some(body) = self.bodies[group].as_ref().filter(|body| body.is_free()) else {
                return [velocity, [Vector::zero(); 2]];
            };
            return [velocity, body.rigid(moved).answer()];
        }
        let (clumps, clump) = (&self.state.clumps, group - boundaries.len());
        let velocity = [clumps.velocity[clump].into(), clumps.angular_velocity[clump].into()];
        let answer = bodies::numbered(self.bodies, self.state, group).map_or([Vector::zero(); 2], |body| body.answer());
        [velocity, answer]
    }

    /// How a body resists motion.
    pub(super) fn inertia(&self, body: usize) -> Inertia {
        let (particles, boundaries) = (&self.state.particles, &self.state.boundaries);
        let Some(group) = body.checked_sub(particles.len()) else {
            let (mass, moment) = (particles.velocity[body][3], particles.angular_velocity[body][3]);
            return Inertia { mass: [mass; 3], turning: Matrix3::identity() * moment, support: None };
        };
        let root = bodies::numbered(self.bodies, self.state, group).map(|body| body.root([1.0; 2])).unwrap_or_default();
        let inverse = (root * root.transpose()).fixed_view::<3, 3>(3, 3).into_owned();
        if group < boundaries.len() {
            let Some(body) = self.bodies[group].as_ref().filter(|body| body.is_free()) else {
                return Inertia { mass: [0.0; 3], turning: Matrix3::zeros(), support: Some(false) };
            };
            let freedoms = body.freedoms();
            let of_axis = inverse.map(|part| if part > 0.0 { 1.0 / part } else { 0.0 });
            let turning = inverse.try_inverse().unwrap_or_else(|| Matrix3::from_diagonal(&of_axis.diagonal()));
            let mass = [0, 1, 2].map(|axis| if freedoms[axis] { body.mass } else { 0.0 });
            return Inertia { mass, turning, support: (freedoms != [true; 6]).then_some(true) };
        }
        let (clumps, clump) = (&self.state.clumps, group - boundaries.len());
        let turning = inverse.try_inverse().unwrap_or_else(Matrix3::zeros);
        Inertia { mass: [clumps.velocity[clump][3]; 3], turning, support: None }
    }
}
