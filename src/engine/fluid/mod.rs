//! The fluid: what it does to particles and clumps.
//!
//! On a sphere of diameter d and volume V act, beside contacts and weight,
//!
//! ```text
//! β (u − v) − V ρ g        β = 3π µ d ε F(ε, Re)        T = −π µ d³ ω   where the fluid brakes rotation
//! ```
//!
//! u is the velocity of the fluid. A load is written beside its dashpot to the ground: β stands behind the force in the rows of loads,
//! π µ d³ behind the torque, and half kicks solve both with the mean of the motions before and after ([`kick`](crate::engine::integration)).
//! The relaxation of the fluid thus limits no time step. β is that of the velocity half a step later, which makes the scheme of second
//! order whatever the law.

mod book;
mod course;

pub(crate) use book::{Kick, book};
pub(crate) use course::{advance, begin, begun, end, put};

use crate::base::number::Vector;
use crate::base::threads::Context;
use crate::engine::integration::{Fields, Rows};
use crate::engine::state::{Clumps, State};
use crate::laws::drag::Factor;
use crate::scene::Scene;
use std::f64::consts::PI;
use std::sync::Arc;

/// What never changes of a fluid.
pub(crate) struct Medium {
    /// Density \[kg/m³\].
    density: f64,
    /// Dynamic viscosity \[Pa s\].
    viscosity: f64,
    /// Part of the space that the particles leave to it.
    porosity: f64,
    /// The law of its drag.
    law: Arc<dyn Factor>,
    /// Whether it brakes rotation.
    torque: bool,
    /// Gravity \[m/s²\].
    gravity: Vector,
    /// Diameter of the sphere of the volume of each shape of clumps at scale 1 \[m\].
    diameters: Vec<f64>,
}

/// What a fluid does to a body.
#[derive(Clone, Copy)]
pub(crate) struct Flow {
    /// Drag and buoyancy \[N\].
    pub force: Vector,
    /// Drag over the velocity \[kg/s\].
    pub drag: f64,
    /// Torque \[N m\].
    pub torque: Vector,
    /// The same over the angular velocity \[kg m²/s\].
    pub turning: f64,
}

/// A fluid as it flows now.
#[derive(Clone, Copy)]
pub(crate) struct Stream<'a> {
    /// What never changes.
    medium: &'a Medium,
    /// Its velocity \[m/s\].
    velocity: Vector,
}

impl Medium {
    /// That of a scene, if it has one.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let fluid = scene.fluid.as_ref()?;
        let diameter = |volume: f64| libm::cbrt(6.0 / PI * volume);
        Some(Self {
            density: fluid.density,
            viscosity: fluid.viscosity,
            porosity: fluid.porosity.unwrap_or(1.0),
            law: fluid.drag.law(),
            torque: fluid.torque,
            gravity: scene.gravity.into(),
            diameters: scene.clump_shapes.iter().map(|shape| diameter(shape.volume)).collect(),
        })
    }

    /// Whether it brakes rotation.
    pub(crate) fn has_torque(&self) -> bool {
        self.torque
    }

    /// The same as it flows in a state.
    pub(crate) fn stream(&self, state: &State) -> Stream<'_> {
        let velocity = state.fluid.as_ref().map_or([0.0; 3], |fluid| fluid.velocity);
        Stream { medium: self, velocity: velocity.into() }
    }

    /// Diameter of the sphere of the volume of a clump \[m\].
    pub(crate) fn diameter(&self, clumps: &Clumps, clump: usize) -> f64 {
        self.diameters[clumps.shape[clump] as usize] * clumps.scale[clump]
    }

    /// Force of the pressure gradient of the fluid at rest on a sphere \[N\].
    fn buoyancy(&self, diameter: f64) -> Vector {
        self.gravity * -(self.density * (PI / 6.0) * (diameter * diameter * diameter))
    }

    /// Drag over the velocity of a sphere against which the fluid moves so \[kg/s\].
    fn drag(&self, diameter: f64, slip: Vector) -> f64 {
        let Self { density, viscosity, porosity, .. } = *self;
        let reynolds = density * diameter * porosity * slip.length() / viscosity;
        3.0 * PI * viscosity * diameter * porosity * self.law.factor(porosity, reynolds)
    }
}

impl Stream<'_> {
    /// What it does to a sphere of this diameter \[m\] with this velocity \[m/s\] and angular velocity \[rad/s\], on which another force acts
    /// \[N\]; forces move its mass \[kg\] in half kicks of this length \[s\], or it is held where the length is 0.
    pub(crate) fn on(&self, diameter: f64, motion: [Vector; 2], (mass, other): (f64, Vector), half: f64) -> Flow {
        let Self { medium, velocity } = *self;
        let (slip, buoyancy) = (velocity - motion[0], medium.buoyancy(diameter));
        let mut drag = medium.drag(diameter, slip);
        if half > 0.0 {
            let gained = (other + buoyancy + slip * drag) * (half / (mass + half * drag));
            drag = medium.drag(diameter, slip - gained);
        }
        let turning = if medium.torque { PI * medium.viscosity * (diameter * diameter * diameter) } else { 0.0 };
        Flow { force: slip * drag + buoyancy, drag, torque: motion[1] * -turning, turning }
    }

    /// The largest acceleration that it gives to what forces move in a state \[m/s²\].
    pub(crate) fn acceleration(&self, state: &State) -> f64 {
        let State { particles, clumps, .. } = state;
        let of = |velocity: [f64; 4], drag: f64, diameter: f64| {
            let drag = (self.velocity - Vector::from(velocity)) * drag;
            (drag.length() + self.medium.buoyancy(diameter).length()) / velocity[3]
        };
        let free = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
        let of_particles =
            free.map(|slot| of(particles.velocity[slot], particles.force[slot][3], 2.0 * particles.position[slot][3]));
        let of_clumps =
            (0..clumps.len()).map(|it| of(clumps.velocity[it], clumps.force[it][3], self.medium.diameter(clumps, it)));
        of_particles.chain(of_clumps).fold(0.0, f64::max)
    }
}

/// Adds the force of the fluid to the loads on particles, those of groups among them; clumps have it as bodies.
pub(crate) fn load(medium: &Medium, state: &mut State, fields: &Fields, context: &Context) {
    let stream = medium.stream(state);
    let boundaries = state.boundaries.len() as u32;
    let particles = &mut state.particles;
    let ids = std::mem::take(&mut particles.id);
    let rows = Rows::of(particles);
    context.each(rows.pieces(), |piece| {
        rows.each(piece, |body, is_free| {
            // Images and spheres of clumps are counted on behind the boundaries.
            if body.owner > boundaries {
                return;
            }
            let motion = [Vector::from(*body.velocity), Vector::from(*body.spin)];
            let own = Vector::from(fields.loads(body.velocity[3], ids[body.slot])) + Vector::from(*body.force);
            let half = if is_free { 0.5 * context.step } else { 0.0 };
            let flow = stream.on(2.0 * body.position[3], motion, (body.velocity[3], own), half);
            *body.force = (Vector::from(*body.force) + flow.force).row_with(flow.drag);
            *body.torque = (Vector::from(*body.torque) + flow.torque).row_with(flow.turning);
        });
    });
    particles.id = ids;
    if let Some(fluid) = &mut state.fluid {
        fluid.step = context.step;
    }
}
