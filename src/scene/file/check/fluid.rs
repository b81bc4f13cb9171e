//! The fluid.

use super::raw_tables::RawTables;
use super::tables;
use crate::base::document::{Faults, Mistake};
use crate::base::quantity::Porosity;
use crate::scene::file::tables::{FluidTable, VelocityKey};
use crate::scene::{AxisMotion, Fluid, FluidVelocity, Source};

/// The fluid of a scene, if it has one.
pub(super) fn fluid(written: &RawTables, source: &Source, faults: &mut Faults) -> Option<Fluid> {
    let (name, keys, drag) = written.fluid.as_ref()?;
    let table = format!("fluid.{name}");
    answer(keys, &table, faults);
    let known: Vec<String> = written.grids.iter().map(|(name, _)| name.clone()).collect();
    let grid = keys.grid.as_ref().map(|grid| known.iter().position(|name| name == grid).ok_or(grid));
    if let Some(Err(grid)) = grid {
        faults.add(&table, "grid", Mistake::UnknownName { found: grid.clone(), kind: "grid", known: known.clone() });
    }
    Some(Fluid {
        name: name.clone(),
        density: keys.density.get(),
        viscosity: keys.viscosity.get(),
        velocity: velocity(keys, source, &table, faults),
        grid: grid.and_then(Result::ok),
        pressure: keys.pressure,
        porosity: keys.porosity.map(Porosity::get),
        drag: *drag,
        torque: keys.torque,
    })
}

/// Answers keys for what is not modelled.
fn answer(keys: &FluidTable, table: &str, faults: &mut Faults) {
    let answers = [
        ("lift", keys.lift.is_some(), "expected none, found one: lift is not modelled"),
        ("added_mass", keys.added_mass.is_some(), "expected none, found one: added mass is not modelled"),
    ];
    for (key, is_there, message) in answers {
        if is_there {
            faults.add(table, key, Mistake::Refused { message: message.to_owned() });
        }
    }
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
