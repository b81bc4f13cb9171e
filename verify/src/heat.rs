//! `heat.csv`: temperatures and heat flows of the particles, as another engine has them.

use super::build::positive;
use super::case::{Case, Conducted};
use super::error::{Mistake, VerifyError};
use super::trajectory::Sample;
use cograin::column::TEMPERATURE;
use cograin::contact::heat::overlap_area::{Area, Keys};
use cograin::contact::{HeatModel, NoKeys};
use cograin::scene::{Boundary, BoundaryTemperature, ColumnStart, HeatGiven, HeatSource, Models};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::Path;

/// Temperature \[K\] and heat flow \[W\] of a particle.
pub(super) type Heated = [f64; 2];

/// Largest relative error of a temperature that passes.
const OF_TEMPERATURE: f64 = 1e-12;

/// Largest error of a heat flow that passes, over the largest flow.
const OF_FLOW: f64 = 1e-10;

/// Columns: step, number, temperature, heat flow.
const COLUMNS: usize = 4;

/// The record of another engine.
pub(super) struct Heats {
    /// By step, in the case's order.
    pub(super) rows: BTreeMap<u64, Vec<Heated>>,
}

impl Heats {
    /// Reads the record of a case, if there is one.
    pub(super) fn read(path: &Path, case: &Case) -> Result<Option<Self>, VerifyError> {
        if !path.exists() {
            return Ok(None);
        }
        let text = fs::read_to_string(path).map_err(|cause| VerifyError::file(path, &cause))?;
        let mut rows: BTreeMap<u64, Vec<Heated>> = BTreeMap::new();
        for (line, text) in (1..).zip(text.lines()).skip(1) {
            let numbers: Vec<f64> = text.split(',').filter_map(|field| field.trim().parse().ok()).collect();
            let index = numbers.get(1).and_then(|id| case.particles.iter().position(|it| f64::from(it.id) == *id));
            let (Some(index), COLUMNS) = (index, numbers.len()) else {
                let message = format!("expected step, id of a particle, temperature, heat flow, found \"{text}\"");
                return Err(VerifyError::Samples { path: path.to_path_buf(), line, message });
            };
            let step = rows.entry(numbers[0] as u64).or_insert_with(|| vec![[f64::NAN; 2]; case.particles.len()]);
            step[index] = [numbers[2], numbers[3]];
        }
        Ok(Some(Self { rows }))
    }
}

/// Largest errors of temperatures and heat flows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatErrors {
    /// Of temperatures over themselves, of flows over the largest.
    pub found: [f64; 2],
}

impl HeatErrors {
    /// Compares with the record; a step that was not kept counts as infinitely far. Before the first step engines tell flows differently.
    pub(super) fn between(theirs: &Heats, ours: &[Sample]) -> Self {
        let (mut found, mut largest) = ([0.0_f64; 2], 0.0_f64);
        for (step, theirs) in &theirs.rows {
            let ours = ours.iter().find(|sample| sample.step == *step);
            for (place, [temperature, flow]) in theirs.iter().enumerate() {
                let [t, q] = ours.map_or([f64::NAN; 2], |sample| sample.heat[place]);
                let mut note = |part: usize, error: f64| {
                    found[part] = if error.is_nan() { f64::INFINITY } else { found[part].max(error) };
                };
                note(0, (t / temperature - 1.0).abs());
                if *step > 0 {
                    note(1, (q - flow).abs());
                    largest = largest.max(flow.abs());
                }
            }
        }
        if largest > 0.0 {
            found[1] /= largest;
        }
        Self { found }
    }

    /// Whether both pass.
    pub fn passed(&self) -> bool {
        self.found[0] <= OF_TEMPERATURE && self.found[1] <= OF_FLOW
    }
}

impl fmt::Display for HeatErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "temperatures {:.1e}, heat flows {:.1e}", self.found[0], self.found[1])
    }
}

/// The heat sub-model of a case, if it has one.
pub(super) fn model(case: &Case) -> Result<Option<HeatModel>, Mistake> {
    let Some(name) = &case.model.heat else { return Ok(None) };
    let models = Models::standard();
    let area = match &case.model.heat_area {
        None => Area::Section,
        Some(Conducted::Given(area)) => Area::Given(positive("model.heat_area", *area)?.get()),
        Some(Conducted::Named(word)) if word == "projection" => Area::Projection,
        Some(Conducted::Named(word)) => {
            let message = format!("expected a number or \"projection\", found \"{word}\"");
            return Err(Mistake::new("model.heat_area", message));
        }
    };
    let found = match name.as_str() {
        "overlap_area" => models.heat(name, Keys { area }),
        _ => models.heat(name, NoKeys {}),
    };
    let unknown =
        || Mistake::new("model.heat", format!("expected constriction, overlap_area or transfer, found \"{name}\""));
    found.map(Some).ok_or_else(unknown)
}

/// The temperatures of the particles of a case, where heat flows.
pub(super) fn columns(case: &Case) -> Result<Vec<ColumnStart>, Mistake> {
    if case.model.heat.is_none() {
        return Ok(Vec::new());
    }
    let temperature = |place: usize| {
        let key = format!("particles[{place}].temperature");
        let missing = || Mistake::new(key.clone(), "absent; heat flows in this case");
        Ok(positive(key.clone(), case.particles[place].temperature.ok_or_else(missing)?)?.get())
    };
    let particles = case.by_id().into_iter().map(temperature).collect::<Result<_, Mistake>>()?;
    Ok(vec![ColumnStart { column: &TEMPERATURE, particles, insertions: Vec::new() }])
}

/// The heat sources of a case, by the places of its particles.
pub(super) fn sources(case: &Case, index_of: &BTreeMap<u32, u32>) -> Result<Vec<HeatSource>, Mistake> {
    let mut sources = Vec::new();
    for (place, source) in case.heat_sources.iter().enumerate() {
        let members = super::build::members(&format!("heat_sources[{place}]"), &source.ids, index_of)?;
        let ambient = |[temperature, conductance]: [f64; 2]| HeatGiven::Ambient { temperature, conductance };
        let gives = source.ambient.map_or(HeatGiven::Power(source.power), ambient);
        sources.push(HeatSource { name: format!("source{place}"), members, gives });
    }
    Ok(sources)
}

/// The particles as a simulation has them, in the case's order.
pub(super) fn observe(case: &Case, simulation: &Simulation) -> Vec<Heated> {
    let Some(heat) = &simulation.state().heat else { return Vec::new() };
    let held = |index: u32| {
        let boundaries = &simulation.scene().boundaries;
        boundaries.iter().position(|boundary| boundary.shape.members() == [index])
    };
    let mut rows = vec![[0.0; 2]; case.particles.len()];
    for (in_scene, in_case) in case.by_id().into_iter().enumerate() {
        rows[in_case] = match held(in_scene as u32) {
            Some(boundary) => [heat.boundaries[boundary].temperature(), heat.boundaries[boundary].flow],
            None => [heat.temperature(in_scene), heat.flow[in_scene]],
        };
    }
    rows
}

/// The temperature of a wall of a case.
pub(super) fn of_wall(temperature: Option<f64>) -> BoundaryTemperature {
    temperature.map_or(BoundaryTemperature::None, BoundaryTemperature::Held)
}

/// Particles that are held at a temperature, each a group of its own.
pub(super) fn held(
    case: &Case,
    index_of: &BTreeMap<u32, u32>,
    like: &dyn Fn(u32) -> Boundary,
) -> Result<Vec<Boundary>, Mistake> {
    let mut all = Vec::new();
    for (place, held) in case.held_temperatures.iter().enumerate() {
        let place = format!("held_temperatures[{place}]");
        for member in super::build::members(&place, &held.ids, index_of)? {
            let temperature =
                BoundaryTemperature::Held(positive(format!("{place}.temperature"), held.temperature)?.get());
            all.push(Boundary { temperature, ..like(member) });
        }
    }
    Ok(all)
}
