//! The fluid: what it does to particles and clumps.
//!
//! On a sphere of diameter d and volume V act, beside contacts and weight,
//!
//! ```text
//! β (u − v) − V ∇p        β = 3π µ d ε F(ε, Re)        T = −π µ d³ ω   where the fluid brakes rotation
//! ```
//!
//! u is the velocity of the fluid, ∇p the gradient of its pressure, ε the porosity: those of all places or, on a grid, those between the
//! centres of the cells around the centre of the sphere. Without a given gradient ∇p = ρ g. A load is written beside its dashpot to the
//! ground: β stands behind the force in the rows of loads, π µ d³ behind the torque, and half kicks solve both with the mean of the motions
//! before and after ([`kick`](crate::engine::integration)). The relaxation of the fluid thus limits no time step. β is that of the velocity
//! half a step later, which makes the scheme of second order whatever the law.

mod acceleration;
mod beside;
mod book;
mod columns;
mod convection;
mod course;
mod half_kick;
mod particles;
mod porosity;
mod stream;
mod sums;

pub(crate) use acceleration::accelerate;
pub(crate) use book::{Kick, book};
pub(crate) use convection::{convect, rate};
pub(crate) use course::{advance, begin, begun, end, put};
pub(crate) use particles::load;
pub(crate) use porosity::renew;
pub(crate) use stream::Stream;

use crate::base::number::Vector;
use crate::engine::state::{Clumps, Row};
use crate::laws::convection::Nusselt;
use crate::laws::drag::Factor;
use crate::laws::lift::Across;
use crate::laws::region::Grid;
use crate::scene::{FluidHeat, Pressure, Scene};
use std::f64::consts::PI;
use std::sync::Arc;
use stream::Here;
use sums::CellSums;

/// What never changes of a fluid.
pub(crate) struct Medium {
    /// Density \[kg/m³\].
    density: f64,
    /// Dynamic viscosity \[Pa s\].
    viscosity: f64,
    /// The grid in whose box it is; none where it is everywhere.
    grid: Option<Grid>,
    /// The law of its drag.
    law: Arc<dyn Factor>,
    /// The laws of its lift.
    lift: Vec<Arc<dyn Across>>,
    /// Added mass of a sphere over its volume; 0 where none is modelled \[kg/m³\].
    added_mass: f64,
    /// Force of the pressure gradient on each volume over the acceleration of the fluid: its density, where added mass is modelled and no
    /// gradient given, which would contain it; else 0 \[kg/m³\].
    inertial: f64,
    /// Whether it brakes rotation.
    torque: bool,
    /// Force of the pressure gradient on each volume beside that which is given: of the fluid at rest, where that does not contain it
    /// \[N/m³\].
    buoyancy: Vector,
    /// Diameter of the sphere of the volume of each shape of clumps at scale 1 \[m\].
    diameters: Vec<f64>,
    /// Room for sums over the cells of the grid.
    sums: CellSums,
    /// Room for changes of the acceleration in each of them \[m/s²\].
    changes: Vec<Row>,
    /// What lets heat flow into it, where any does.
    heat: Option<Convects>,
}

/// What lets heat flow into a fluid.
struct Convects {
    /// The law.
    law: Arc<dyn Nusselt>,
    /// Conductivity \[W/(m K)\].
    conductivity: f64,
    /// Viscosity and specific heat over conductivity.
    prandtl: f64,
}

/// Volume of a sphere of this diameter \[m³\].
#[inline(always)]
fn volume(diameter: f64) -> f64 {
    (PI / 6.0) * (diameter * diameter * diameter)
}

/// What a fluid does to a body.
#[derive(Clone, Copy)]
pub(crate) struct Flow {
    /// Drag and force of the pressure gradient \[N\].
    pub force: Vector,
    /// Drag over the velocity \[kg/s\].
    pub drag: f64,
    /// Torque \[N m\].
    pub torque: Vector,
    /// The same over the angular velocity \[kg m²/s\].
    pub turning: f64,
}

impl Medium {
    /// That of a scene, if it has one.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        let fluid = scene.fluid.as_ref()?;
        let diameter = |volume: f64| libm::cbrt(6.0 / PI * volume);
        let contains_rest = fluid.pressure == Some(Pressure::Total);
        Some(Self {
            density: fluid.density,
            viscosity: fluid.viscosity,
            grid: fluid.grid.map(|grid| scene.grids[grid].shape),
            law: fluid.drag.law(),
            lift: fluid.lift.iter().map(|lift| lift.law()).collect(),
            added_mass: fluid.added_mass.unwrap_or(0.0) * fluid.density,
            inertial: if fluid.added_mass.is_some() && fluid.pressure.is_none() { fluid.density } else { 0.0 },
            torque: fluid.torque,
            buoyancy: if contains_rest { Vector::zero() } else { Vector::from(scene.gravity) * -fluid.density },
            diameters: scene.clump_shapes.iter().map(|shape| diameter(shape.volume)).collect(),
            sums: CellSums::default(),
            changes: Vec::new(),
            heat: fluid.heat.map(|FluidHeat { law, conductivity, specific_heat, .. }| Convects {
                law: law.law(),
                conductivity,
                prandtl: specific_heat * fluid.viscosity / conductivity,
            }),
        })
    }

    /// Whether it brakes rotation.
    pub(crate) fn has_torque(&self) -> bool {
        self.torque
    }

    /// Diameter of the sphere of the volume of a clump \[m\].
    pub(crate) fn diameter(&self, clumps: &Clumps, clump: usize) -> f64 {
        self.diameters[clumps.shape[clump] as usize] * clumps.scale[clump]
    }

    /// Drag over the velocity of a sphere with this factor of its law \[kg/s\].
    #[inline(always)]
    fn drag(&self, diameter: f64, porosity: f64, factor: f64) -> f64 {
        3.0 * PI * self.viscosity * diameter * porosity * factor
    }

    /// Torque over the angular velocity of a sphere \[kg m²/s\]; 0 where it brakes no rotation.
    #[inline(always)]
    fn turning(&self, diameter: f64) -> f64 {
        if self.torque { PI * self.viscosity * (diameter * diameter * diameter) } else { 0.0 }
    }

    /// Reynolds number of a sphere against which the fluid moves so.
    #[inline(always)]
    fn reynolds(&self, diameter: f64, porosity: f64, slip: Vector) -> f64 {
        self.density * diameter * porosity * slip.length() / self.viscosity
    }

    /// Conductance between the fluid and a sphere against which it moves so \[W/K\]; 0 where no heat flows.
    fn conductance(&self, diameter: f64, porosity: f64, slip: Vector) -> f64 {
        let Some(Convects { law, conductivity, prandtl }) = &self.heat else { return 0.0 };
        PI * conductivity * diameter * law.nusselt(porosity, self.reynolds(diameter, porosity, slip), *prandtl)
    }
}
