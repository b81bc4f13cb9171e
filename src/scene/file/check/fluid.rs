//! The fluid.

use super::particles::ReadParticles;
use super::raw_tables::{FluidTables, RawTables};
use super::{heat, tables};
use crate::base::document::{Faults, Mistake};
use crate::base::quantity::{Porosity, Positive};
use crate::laws::contact::Material;
use crate::scene::file::tables::{FluidTable, TemperatureKey, VelocityKey};
use crate::scene::{AxisMotion, ColumnStart, Fluid, FluidHeat, FluidVelocity, Source};

/// The fluid of a scene, if it has one.
pub(super) fn fluid(
    written: &RawTables,
    source: &Source,
    particles: (&[Material], &ReadParticles, &[ColumnStart]),
    faults: &mut Faults,
) -> Option<Fluid> {
    let tables = written.fluid.as_ref()?;
    let FluidTables { name, keys, drag, lift, .. } = tables;
    let table = format!("fluid.{name}");
    let known: Vec<String> = written.grids.iter().map(|(name, _)| name.clone()).collect();
    let grid = keys.grid.as_ref().map(|grid| known.iter().position(|name| name == grid).ok_or(grid)).transpose();
    let grid = grid.map_err(|grid| {
        faults.add(&table, "grid", Mistake::UnknownName { found: grid.clone(), kind: "grid", known });
    });
    Some(Fluid {
        name: name.clone(),
        density: keys.density.get(),
        viscosity: keys.viscosity.get(),
        velocity: velocity(keys, source, &table, faults),
        grid: grid.ok()?,
        pressure: keys.pressure,
        porosity: keys.porosity.map(Porosity::get),
        drag: *drag,
        lift: lift.clone(),
        added_mass: keys.added_mass.map(Positive::get),
        torque: keys.torque,
        heat: heat_of(tables, &table, particles, faults),
    })
}

/// Its temperature and what lets heat flow into it, where any does.
fn heat_of(
    tables: &FluidTables,
    table: &str,
    (materials, born, columns): (&[Material], &ReadParticles, &[ColumnStart]),
    faults: &mut Faults,
) -> Option<FluidHeat> {
    let keys = &tables.keys;
    let given = [
        ("temperature", keys.temperature.is_some(), "its temperature [K], or \"driven\""),
        ("conductivity", keys.conductivity.is_some(), "its conductivity [W/(m K)]"),
        ("specific_heat", keys.specific_heat.is_some(), "its specific heat [J/(kg K)]"),
    ];
    for (key, is_there, what) in given {
        if is_there && tables.convection.is_none() {
            let what_for = "no heat flows into the fluid".to_owned();
            let expected = format!("a table [{table}.heat.<law>] beside it, or leave it out");
            faults.add(table, key, Mistake::InvalidCombination { what: what_for, expected });
        } else if !is_there && tables.convection.is_some() {
            faults.add(table, key, Mistake::Missing { expected: format!("{what}: heat flows into it") });
        }
    }
    let (temperature, is_driven) = match keys.temperature? {
        TemperatureKey::Given(temperature) => (temperature, false),
        TemperatureKey::DrivenFrom(temperature) => (temperature, true),
        TemperatureKey::Driven => match heat::mean(materials, born, columns) {
            Some(temperature) => (temperature, true),
            None => {
                let expected = "{ driven = .. } with that at the start [K]: there are no particles that have one";
                faults.add(table, "temperature", Mistake::Missing { expected: expected.to_owned() });
                return None;
            }
        },
    };
    let (conductivity, specific_heat) = (keys.conductivity?.get(), keys.specific_heat?.get());
    Some(FluidHeat { law: tables.convection?, temperature, is_driven, conductivity, specific_heat })
}

/// How it moves.
fn velocity(keys: &FluidTable, source: &Source, table: &str, faults: &mut Faults) -> FluidVelocity {
    let axes = match &keys.velocity {
        None => return FluidVelocity::Given([0.0; 3]),
        Some(VelocityKey::Given(velocity)) => return FluidVelocity::Given(velocity.get()),
        Some(VelocityKey::Driven) => return FluidVelocity::Driven([0.0; 3]),
        Some(VelocityKey::DrivenFrom(start)) => return FluidVelocity::Driven(start.get()),
        Some(VelocityKey::Prescribed(axes)) => axes,
    };
    const KEY: &str = "velocity.prescribed";
    let mut motions = [const { AxisMotion::Fixed }; 3];
    for (axis, motion) in axes {
        let axis = *axis as usize;
        let motion = motion.of_axis(|keys| tables::read(keys, axis, source, (table, KEY), faults));
        match motions.get_mut(axis) {
            Some(place) => *place = motion,
            None => {
                let found = AxisMotion::WORDS[axis].to_owned();
                faults.add(table, KEY, Mistake::Unexpected { found, expected: "x, y or z".to_owned() });
            }
        }
    }
    FluidVelocity::Prescribed(Box::new(motions))
}
