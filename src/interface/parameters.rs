//! Numbers of the scene as variables that may be given.

use super::{Causality, Quantity, Source, Value, Variability, Variable};
use crate::engine::simulation::Simulation;
use crate::scene::{Range, Scene};

/// A parameter of the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameter {
    /// Its place among the scene's.
    pub(super) place: usize,
    /// Its place among those that are tunable.
    pub(super) tunable: Option<usize>,
    /// Which numbers it takes.
    pub(super) range: Range,
}

impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place
    }
}

impl Parameter {
    /// Its present value.
    pub(super) fn value(&self, simulation: &Simulation) -> Value {
        let parameter = &simulation.scene().parameters[self.place];
        let value = self.tunable.map_or(parameter.value, |place| simulation.state().tuned[place]);
        if parameter.unit.is_some() { Value::Real(value) } else { Value::Integer(value as i32) }
    }
}

/// The parameters of a scene as variables.
pub(super) fn variables(scene: &Scene) -> impl Iterator<Item = Variable> {
    let mut tunables = 0..;
    scene.parameters.iter().enumerate().map(move |(place, parameter)| {
        let tunable = if parameter.tunable { tunables.next() } else { None };
        Variable {
            name: parameter.name.clone(),
            description: parameter.about.clone(),
            quantity: Quantity::of_unit(parameter.unit.as_deref()),
            causality: Causality::Parameter,
            variability: if parameter.tunable { Variability::Tunable } else { Variability::Fixed },
            start: Some(parameter.value),
            minimum: parameter.range.minimum,
            maximum: parameter.range.maximum,
            follows_inputs_at_start: false,
            source: Source::Parameter(Parameter { place, tunable, range: parameter.range }),
        }
    })
}
