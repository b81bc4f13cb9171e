//! Bodies of several parts that forces move: groups of particles and surfaces, which are boundaries with free axes, and clumps.
//!
//! Their spheres are rows among the particles, whose owner is the body: boundaries by their index, behind them clumps by theirs. Lists and passes
//! need not know. A body gathers the loads of its spheres, moves as a [`Rigid`] and gives its spheres their motion. Code outside of this room asks a
//! [`Body`], whichever it is: [`each`] hands them out. Single spheres are moved by `integration`, all at once.

pub(crate) mod book;
pub(crate) mod boundary;
pub(crate) mod clumps;
pub(crate) mod loads;
mod rigid;

pub(crate) use boundary::{RigidBody, Turning};
pub(crate) use clumps::{ClumpBodies, Striker};
pub(crate) use rigid::Rigid;

use crate::base::number::{Vector, larger};
use crate::engine::integration::Load;
use crate::engine::state::{BoundaryState, CellState, State};
use nalgebra::Matrix6;

/// A body as it stands and moves now.
pub(crate) struct Body<'a> {
    /// Its number among the owners of particles: boundaries, then clumps.
    pub number: usize,
    /// How it moves along its free axes.
    pub rigid: Rigid,
    /// Which of x, y, z are free.
    pub moves: [bool; 3],
    /// Its point of reference \[m\]: of a clump the mass centre.
    pub point: Vector,
    /// From there to the mass centre \[m\].
    pub mass_centre: Vector,
    /// Indices of its spheres; none of a surface.
    pub members: &'a [u32],
    /// The largest distance of the centre of a sphere from the point \[m\].
    pub reach: f64,
    /// Radius of its smallest sphere, for a surface of the smallest that it may touch \[m\].
    pub smallest: f64,
    /// Global damping among the loads.
    pub braking: Load,
    /// The boundary that it is.
    pub boundary: Option<(&'a RigidBody, &'a BoundaryState)>,
    /// The cell in which its spheres are brought back one by one.
    cell: Option<&'a CellState>,
}

/// The body of this number, if forces move it.
pub(crate) fn numbered<'a>(bodies: &'a [Option<RigidBody>], state: &'a State, number: usize) -> Option<Body<'a>> {
    match number.checked_sub(state.boundaries.len()) {
        Some(clump) => Some(Body { number, ..clumps::body(&state.clumps, clump) }),
        None => {
            let body = bodies[number].as_ref().filter(|body| body.is_free())?;
            Some(body.of_boundary(number, &state.boundaries[number], state.cell.as_ref()))
        }
    }
}

/// The bodies that forces move, in the order of their numbers.
pub(crate) fn each<'a>(bodies: &'a [Option<RigidBody>], state: &'a State) -> impl Iterator<Item = Body<'a>> {
    (0..state.owners()).filter_map(move |number| numbered(bodies, state, number))
}

impl Body<'_> {
    /// How it moves after half a kick of a step of this length \[s\] with the present load.
    pub(crate) fn kicked(&self, step: f64) -> Rigid {
        self.boundary.map_or_else(|| self.rigid.kicked(0.5 * step), |(body, moved)| body.kicked(moved, step).after)
    }

    /// The whole force on it, along axes that are not free as well \[N\].
    pub(crate) fn force(&self) -> Vector {
        self.boundary.map_or(self.rigid.force, |(_, moved)| moved.inertial.load.into())
    }

    /// The acceleration of its point \[m/s²\] and the angular one \[rad/s²\] that its present load gives.
    pub(crate) fn answer(&self) -> [Vector; 2] {
        self.rigid.answer()
    }

    /// Largest speed that one of its spheres can have then \[m/s\].
    pub(crate) fn speed_after(&self, step: f64) -> f64 {
        self.kicked(step).fastest(self.reach)
    }

    /// L of the acceleration L Lᵀ that unit loads give it, linear and angular ones larger by these factors.
    pub(crate) fn root(&self, [linear, angular]: [f64; 2]) -> Matrix6<f64> {
        let (mut root, inertia) = (Matrix6::zeros(), self.rigid.inertia.to_array());
        let axes = rigid::axes(self.rigid.turn);
        for axis in 0..3 {
            root[(axis, axis)] = if self.moves[axis] { (linear / self.rigid.mass).sqrt() } else { 0.0 };
            let along = axes[axis] * (angular / inertia[axis]).sqrt();
            for (row, part) in along.to_array().into_iter().enumerate() {
                root[(3 + row, 3 + axis)] = part;
            }
        }
        root
    }
}

/// Largest speed of a sphere of a body at the middle of a step of this length \[s\], from rest or not \[m/s\].
pub(crate) fn coming_speed(bodies: &[Option<RigidBody>], state: &State, step: f64) -> f64 {
    each(bodies, state).map(|body| body.speed_after(step)).fold(0.0, larger)
}

/// Kinetic energy of the bodies \[J\].
pub(crate) fn kinetic(bodies: &[Option<RigidBody>], state: &State) -> f64 {
    each(bodies, state).map(|body| body.rigid.kinetic()).sum()
}

/// What the last half kick of a step of this length \[s\] gave to the velocity at the centre of a particle (slot), and to its angular
/// velocity, if it belongs to a body \[m/s, rad/s\].
pub(crate) fn kick_at(state: &State, slot: usize, step: f64) -> Option<[Vector; 2]> {
    let number = state.particles.group(slot)?;
    let (kick, twist, arm) = match number.checked_sub(state.boundaries.len()) {
        Some(clump) => {
            let arm = Vector::from(state.particles.position[slot]) - state.clumps.position[clump].into();
            let [kick, twist] = clumps::last_kick(&state.clumps, clump, step);
            (kick, twist, arm)
        }
        None => {
            let moved = &state.boundaries[number];
            let arm = Vector::from(state.unwrapped(slot)) - moved.pivot.into();
            (moved.inertial.kick.into(), moved.inertial.spin_kick.into(), arm)
        }
    };
    Some([kick + twist.cross(arm), twist])
}
