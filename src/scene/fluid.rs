//! `[fluid.<name>]`: a fluid that is everywhere or in the box of a grid, whose motion is given.

use super::{AxisMotion, Cell, Grid, MotionPlane, ParticleShape, SceneDraft};
use crate::base::document::Mistake;
use crate::laws::convection::ConvectionModel;
use crate::laws::drag::DragModel;
use crate::laws::lift::{LiftModel, Rotation};
use serde::Deserialize;

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
    /// The grid of the scene in whose box it is, by its number; none where it is everywhere.
    pub grid: Option<usize>,
    /// What the gradient of the pressure that the outside gives contains; none where none is given.
    pub pressure: Option<Pressure>,
    /// Part of the space that the particles leave to it, where the scene says so.
    pub porosity: Option<f64>,
    /// The law of its drag.
    pub drag: DragModel,
    /// The laws of its lift.
    pub lift: Vec<LiftModel>,
    /// Added mass of a sphere over the mass of the fluid in its volume, where that is modelled.
    pub added_mass: Option<f64>,
    /// Whether it brakes the rotation of the particles.
    pub torque: bool,
    /// What lets heat flow into it; none where none does.
    pub heat: Option<FluidHeat>,
}

/// What lets heat flow between a fluid and the particles.
#[derive(Clone, Copy, Debug)]
pub struct FluidHeat {
    /// The law of its convection.
    pub law: ConvectionModel,
    /// Its temperature, at the start where the outside gives it \[K\].
    pub temperature: f64,
    /// Whether the outside gives it.
    pub is_driven: bool,
    /// Its conductivity \[W/(m K)\].
    pub conductivity: f64,
    /// Its specific heat \[J/(kg K)\].
    pub specific_heat: f64,
}

/// What a gradient of the pressure contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pressure {
    /// All of it, that of the fluid at rest among it.
    Total,
    /// That of the motion alone: ρ g is to be added.
    Dynamic,
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

impl Fluid {
    /// How many places it is given values for: the cells of its grid, or one.
    pub fn cells(&self, grids: &[Grid]) -> usize {
        self.grid.map_or(1, |grid| grids[grid].shape.cells())
    }

    /// The gradient of the pressure at the start that the outside gives, if it gives any: that of the fluid at rest \[Pa/m\].
    pub fn gradient_at_start(&self, gravity: [f64; 3]) -> Option<[f64; 3]> {
        self.pressure.map(|pressure| match pressure {
            Pressure::Total => gravity.map(|part| self.density * part),
            Pressure::Dynamic => [0.0; 3],
        })
    }

    /// Numbers of the unit for each cell of its grid.
    pub(in crate::scene) fn numbers(&self) -> u64 {
        let vectors = u64::from(self.velocity.is_driven()) + 3 * u64::from(self.pressure.is_some());
        let of_heat = self.heat.map_or(0, |heat| 2 + u64::from(heat.is_driven));
        5 + 3 * vectors + of_heat
    }
}

/// What speaks against the grid of a fluid: key and why.
fn grid_objections(fluid: &Fluid, scene: &SceneDraft) -> Vec<(&'static str, String)> {
    let Some(grid) = fluid.grid.map(|grid| &scene.grids[grid]) else { return Vec::new() };
    let mut found = Vec::new();
    if fluid.porosity.is_some() {
        let message =
            format!("expected no porosity beside a grid, found one: the cells of [grid.{}] tell it", grid.name);
        found.push(("porosity", message));
    }
    let goes_through = |axis: &usize| grid.shape.repeats[*axis];
    let repeats = |axis: &usize| scene.cell.as_ref().is_some_and(|cell| cell.lattice.periodic[*axis]);
    if let Some(axis) = (0..3).filter(repeats).find(|axis| !goes_through(axis)) {
        let axis = AxisMotion::WORDS[axis];
        let message = format!(
            "expected a grid that reaches from face to face of the periodic cell along {axis}, at right angles to its other edges, found \
             [grid.{}]",
            grid.name
        );
        found.push(("grid", message));
    }
    found
}

/// What speaks against the fluid in this scene: table, key, and why.
pub(in crate::scene) fn objections(scene: &SceneDraft) -> Vec<(String, &'static str, Mistake)> {
    let Some(fluid) = &scene.fluid else { return Vec::new() };
    let table = format!("fluid.{}", fluid.name);
    let of_convection = fluid.heat.map(|heat| (heat.law.name(), heat.law.is_of_one_sphere()));
    let laws = [Some((fluid.drag.name(), fluid.drag.is_of_one_sphere())), of_convection];
    let dense = laws.into_iter().flatten().find(|(_, is_of_one_sphere)| !is_of_one_sphere);
    if let (None, None, Some((law, _))) = (fluid.porosity, fluid.grid, dense) {
        let expected = format!(
            "the law {law} needs it, or a grid: part of the space that the particles leave to the fluid, 1 for single grains"
        );
        return vec![(table, "porosity", Mistake::Missing { expected })];
    }
    let of_grid = grid_objections(fluid, scene).into_iter().map(|(key, message)| (table.clone(), key, message));
    let all = of_grid.chain(unsupported(fluid, scene));
    all.map(|(table, key, message)| (table, key, Mistake::Refused { message })).collect()
}

/// What a fluid is not modelled with: table, key and why.
fn unsupported(fluid: &Fluid, scene: &SceneDraft) -> Vec<(String, &'static str, String)> {
    let mut found = Vec::new();
    let mut refuse = |table: &str, key, message: &str| found.push((table.to_owned(), key, message.to_owned()));
    if scene.particles.iter().any(|particle| particle.shape == ParticleShape::Disc) {
        refuse("run", "plane_particles", "expected spheres in a fluid, found \"discs\"");
    }
    if scene.run.plane == Some(MotionPlane::Xz) && fluid.velocity.flows_along(1) {
        let message = "expected a velocity without a component along y with plane = \"xz\", found one";
        refuse(&format!("fluid.{}", fluid.name), "velocity", message);
    }
    if scene.cell.as_ref().is_some_and(Cell::moves) {
        refuse("cell", "motion", "expected a cell that keeps its edges in a fluid, found one that is deformed");
    }
    if let Some(damping) = scene.damping.first() {
        let message = "expected no global damping in a fluid, found one: it brakes what sinks as drag does, and grains would settle \
                       too slowly";
        refuse(&format!("damping.{}", damping.name), "", message);
    }
    if scene.heat.frozen {
        let message = "expected motion in a fluid, found frozen = true, with which nothing moves";
        refuse("heat", "frozen", message);
    }
    if let (None, Some(law)) = (fluid.grid, fluid.lift.iter().find(|law| law.rotation() == Rotation::Vorticity)) {
        let message =
            format!("expected a grid, found one velocity for all places: {} lifts in a shear flow alone", law.name());
        refuse(&format!("fluid.{}.lift.{}", fluid.name, law.name()), "", &message);
    }
    let is_led = |boundary: &&super::Boundary| {
        let moves = |axis: &AxisMotion| !axis.is_fixed() && !axis.is_free();
        !boundary.shape.members().is_empty() && boundary.axes.iter().any(moves)
    };
    if let Some(group) = scene.boundaries.iter().filter(|_| fluid.added_mass.is_some()).find(is_led) {
        let message = "expected a group that stays in a fluid with added mass, found one that is moved from outside: the force of its \
                       acceleration is not modelled";
        refuse(&format!("boundary.{}", group.name), "motion", message);
    }
    let floats = |boundary: &&super::Boundary| {
        !boundary.shape.members().is_empty() && boundary.axes.iter().any(AxisMotion::is_free)
    };
    if let Some(group) = scene.boundaries.iter().find(floats) {
        let message = "expected a group that stays or is moved from outside in a fluid, found one that forces move: its drag is not \
                       modelled, take a clump";
        refuse(&format!("boundary.{}", group.name), "motion", message);
    }
    found
}
