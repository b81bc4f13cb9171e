//! `[fluid.<name>]`: a fluid that is everywhere, whose motion is given.

use super::{AxisMotion, MotionPlane, ParticleShape, SceneDraft};
use crate::base::document::Mistake;
use crate::laws::drag::DragModel;

/// A fluid around the particles.
#[derive(Clone, Debug)]
pub struct Fluid {
    /// Its name in the scene.
    pub name: String,
    /// Density \[kg/m³\].
    pub density: f64,
    /// Dynamic viscosity \[Pa s\].
    pub viscosity: f64,
    /// How it moves between the particles.
    pub velocity: FluidVelocity,
    /// Part of the space that the particles leave to it, where the scene says so.
    pub porosity: Option<f64>,
    /// The law of its drag.
    pub drag: DragModel,
    /// Whether it brakes the rotation of the particles.
    pub torque: bool,
}

/// The velocity of a fluid.
#[derive(Clone, Debug, PartialEq)]
pub enum FluidVelocity {
    /// This one \[m/s\].
    Given([f64; 3]),
    /// As the outside says, from this one on \[m/s\].
    Driven([f64; 3]),
    /// That of these motions along x, y, z.
    Prescribed(Box<[AxisMotion; 3]>),
}

impl FluidVelocity {
    /// The velocity at a time \[m/s\], if the scene alone determines it.
    pub fn at(&self, time: f64) -> Option<[f64; 3]> {
        match self {
            Self::Given(velocity) => Some(*velocity),
            Self::Driven(_) => None,
            Self::Prescribed(axes) => {
                Some([0, 1, 2].map(|axis: usize| axes[axis].at(time).map_or(0.0, |[_, velocity]| velocity)))
            }
        }
    }

    /// The velocity at time 0 \[m/s\].
    pub fn at_start(&self) -> [f64; 3] {
        match self {
            Self::Driven(start) => *start,
            _ => self.at(0.0).unwrap_or_default(),
        }
    }

    /// Whether the outside gives it.
    pub fn is_driven(&self) -> bool {
        matches!(self, Self::Driven(_))
    }

    /// Whether it may change.
    pub fn changes(&self) -> bool {
        !matches!(self, Self::Given(_))
    }

    /// Whether it may have a component along an axis.
    fn flows_along(&self, axis: usize) -> bool {
        match self {
            Self::Given(velocity) | Self::Driven(velocity) => velocity[axis] != 0.0,
            Self::Prescribed(axes) => !axes[axis].is_fixed(),
        }
    }
}

/// What speaks against the fluid in this scene: table, key, and why.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<(String, &'static str, Mistake)> {
    let Some(fluid) = &scene.fluid else { return Vec::new() };
    let table = format!("fluid.{}", fluid.name);
    let mut found = Vec::new();
    let mut refuse = |table: String, key, message: &str| {
        found.push((table, key, Mistake::Refused { message: message.to_owned() }));
    };
    if fluid.porosity.is_none() && !fluid.drag.is_of_one_sphere() {
        let law = fluid.drag.name();
        let expected = format!(
            "the law {law} needs it: part of the space that the particles leave to the fluid, 1 for single grains"
        );
        found.push((table, "porosity", Mistake::Missing { expected }));
        return found;
    }
    if scene.particles.iter().any(|particle| particle.shape == ParticleShape::Disc) {
        refuse("run".to_owned(), "plane_particles", "expected spheres in a fluid, found \"discs\"");
    }
    if scene.run.plane == Some(MotionPlane::Xz) && fluid.velocity.flows_along(1) {
        let message = "expected a velocity without a component along y with plane = \"xz\", found one";
        refuse(table.clone(), "velocity", message);
    }
    if scene.cell.as_ref().is_some_and(super::Cell::moves) {
        refuse(
            "cell".to_owned(),
            "motion",
            "expected a cell that keeps its edges in a fluid, found one that is deformed",
        );
    }
    if let Some(damping) = scene.damping.first() {
        let message = "expected no global damping in a fluid, found one: it brakes what sinks as drag does, and grains would settle \
                       too slowly";
        refuse(format!("damping.{}", damping.name), "", message);
    }
    if scene.heat.frozen {
        refuse(
            "heat".to_owned(),
            "frozen",
            "expected motion in a fluid, found frozen = true, with which nothing moves",
        );
    }
    let floats = |boundary: &&super::Boundary| {
        !boundary.shape.members().is_empty() && boundary.axes.iter().any(AxisMotion::is_free)
    };
    if let Some(group) = scene.boundaries.iter().find(floats) {
        let message = "expected a group that stays or is moved from outside in a fluid, found one that forces move: its drag is not \
                       modelled, take a clump";
        refuse(format!("boundary.{}", group.name), "motion", message);
    }
    found
}
