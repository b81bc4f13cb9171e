//! Temperatures of boundaries, and heat sources.

use super::particles::ReadParticles;
use super::raw_tables::RawTables;
use super::selection::members;
use crate::base::document::{Faults, Mistake};
use crate::base::quantity::{Finite, Positive};
use crate::laws::column::TEMPERATURE;
use crate::laws::contact::Material;
use crate::scene::file::tables::{BoundaryTable, TemperatureKey};
use crate::scene::{BoundaryTemperature, ColumnStart, HeatGiven, HeatSource};

/// The temperature of a boundary.
pub(super) fn temperature(
    written: &BoundaryTable,
    table: &str,
    (materials, born, columns): (&[Material], &ReadParticles, &[ColumnStart]),
    faults: &mut Faults,
) -> BoundaryTemperature {
    let capacity = written.heat_capacity.map(Positive::get);
    if capacity.is_none() && written.applied_heat.is_some() {
        let what = "without a heat_capacity a heat flow has nowhere to go when nothing touches".to_owned();
        let expected = "heat_capacity = .. [J/K] beside it, or a temperature alone".to_owned();
        faults.add(table, "applied_heat", Mistake::InvalidCombination { what, expected });
    }
    let mut needs_number = |what: &str| {
        let (what, expected) = (what.to_owned(), "temperature = .. [K], where it begins".to_owned());
        faults.add(table, "heat_capacity", Mistake::InvalidCombination { what, expected });
    };
    match (written.temperature, capacity) {
        (None, None) => BoundaryTemperature::None,
        (None, Some(_)) => {
            needs_number("its temperature is not known");
            BoundaryTemperature::None
        }
        (Some(TemperatureKey::Given(temperature)), Some(capacity)) => {
            let applied = written.applied_heat.map_or(0.0, Finite::get);
            BoundaryTemperature::Body { temperature, capacity, applied }
        }
        (Some(TemperatureKey::Given(temperature)), None) => BoundaryTemperature::Held(temperature),
        (Some(_), Some(_)) => {
            needs_number("a driven temperature takes up no heat");
            BoundaryTemperature::None
        }
        (Some(TemperatureKey::DrivenFrom(temperature)), None) => BoundaryTemperature::Driven(temperature),
        (Some(TemperatureKey::Driven), None) => match mean(materials, born, columns) {
            Some(temperature) => BoundaryTemperature::Driven(temperature),
            None => {
                let expected = "{ driven = .. } with that at the start [K]: there are no particles that have one";
                faults.add(table, "temperature", Mistake::Missing { expected: expected.to_owned() });
                BoundaryTemperature::None
            }
        },
    }
}

/// Mean temperature of the particles by their heat capacities \[K\]; none where none has one.
pub(super) fn mean(materials: &[Material], born: &ReadParticles, columns: &[ColumnStart]) -> Option<f64> {
    let temperatures = &columns.iter().find(|start| start.column.name == TEMPERATURE.name)?.particles;
    let (mut heat, mut capacity, first) = (0.0, 0.0, *temperatures.first()?);
    for (particle, temperature) in born.particles.iter().zip(temperatures) {
        let own = particle.mass() * materials[particle.material.index()].thermal.specific_heat.unwrap_or(0.0);
        heat += own * (temperature - first);
        capacity += own;
    }
    Some(if capacity > 0.0 { first + heat / capacity } else { first })
}

/// All heat sources.
pub(super) fn sources(written: &RawTables, born: &ReadParticles, faults: &mut Faults) -> Vec<HeatSource> {
    let mut sources = Vec::new();
    for (name, source) in &written.heat_sources {
        let table = format!("heat_source.{name}");
        let members = members(&source.particles, born, &table, faults);
        let gives = match (source.power, &source.ambient) {
            (Some(power), None) => HeatGiven::Power(power.get()),
            (None, Some(ambient)) => {
                HeatGiven::Ambient { temperature: ambient.temperature.get(), conductance: ambient.conductance.get() }
            }
            (None, None) => {
                let expected = "power = .. [W] or ambient = { temperature, conductance }".to_owned();
                faults.add(&table, "", Mistake::Missing { expected });
                continue;
            }
            (Some(_), Some(_)) => {
                let (found, expected) = ("power and ambient".to_owned(), "one of them".to_owned());
                faults.add(&table, "ambient", Mistake::Unexpected { found, expected });
                continue;
            }
        };
        sources.push(HeatSource { name: name.clone(), members, gives });
    }
    sources
}
