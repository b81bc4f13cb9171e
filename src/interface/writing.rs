//! How variables are set: values, rates, second derivatives.

use super::{Causality, Interface, InterfaceError, Source, Value, Variable, rows};
use crate::base::quantity::BoundaryIndex;
use crate::engine::simulation::{Input, Simulation};
use crate::scene::{self, InputCourse, Models, Scene, SceneErrors};
use std::collections::BTreeMap;

impl Interface {
    /// Whether the variable at an index may be set to a value.
    pub fn check(&self, index: usize, value: f64) -> Result<(), InterfaceError> {
        let variable = self.variable(index)?;
        if variable.causality == Causality::Output {
            return Err(InterfaceError::Output { name: variable.name.clone() });
        }
        if let Source::Parameter(parameter) = &variable.source
            && let Err(refusal) = parameter.range.check(value)
        {
            return Err(InterfaceError::Range { name: variable.name.clone(), refusal });
        }
        is_finite(variable, value)?;
        if variable.minimum.is_some_and(|minimum| value < minimum) {
            let refusal =
                format!("expected a number of {:?} or above, found {value:?}", variable.minimum.unwrap_or(0.0));
            return Err(InterfaceError::Range { name: variable.name.clone(), refusal });
        }
        Ok(())
    }

    /// Sets an input; it takes effect in the next communication step.
    pub fn set(&self, simulation: &mut Simulation, index: usize, value: Value) -> Result<(), InterfaceError> {
        self.check(index, value.number())?;
        if let Source::Row(rows::Source { row: rows::Row { write: Some(write), .. }, at }) =
            self.variables[index].source
        {
            (write.set)(simulation, at, value.number());
        }
        Ok(())
    }

    /// Sets tunable parameters between communication steps, all or none. A parameter that is not tunable is refused; inputs are
    /// only checked.
    pub fn tune(&self, simulation: &mut Simulation, values: &[(usize, f64)]) -> Result<(), InterfaceError> {
        let mut changes = Vec::new();
        for &(index, value) in values {
            self.check(index, value)?;
            if let Source::Parameter(parameter) = &self.variables[index].source {
                let name = || self.variables[index].name.clone();
                let place = parameter.tunable.ok_or_else(|| InterfaceError::Fixed { name: name() })?;
                changes.push((place, value));
            }
        }
        if changes.is_empty() { Ok(()) } else { Ok(simulation.tune(&changes)?) }
    }

    /// The scene of this source, which may name these sub-models, with these values of parameters, by index.
    pub fn scene_with(
        &self,
        models: &Models,
        source: &scene::Source,
        values: &BTreeMap<usize, f64>,
    ) -> Result<Scene, SceneErrors> {
        let named = values.iter().map(|(&index, &value)| (self.variables[index].name.as_str(), value));
        models.with_parameters(source, named)
    }

    /// Whether the variable at an index may be given a rate.
    pub fn check_rate(&self, index: usize, rate: f64) -> Result<(), InterfaceError> {
        let variable = self.variable(index)?;
        match variable.causality {
            Causality::Parameter => Err(InterfaceError::NoRate { name: variable.name.clone() }),
            Causality::Output => self.check(index, rate),
            Causality::Input => is_finite(variable, rate),
        }
    }

    /// Sets the rate of an input: in the next communication step it goes on from its value at this rate
    /// \[unit of the input/s\].
    pub fn set_rate(&self, simulation: &mut Simulation, index: usize, rate: f64) -> Result<(), InterfaceError> {
        self.check_rate(index, rate)?;
        if let Source::Row(rows::Source { row: rows::Row { write: Some(write), .. }, at }) =
            self.variables[index].source
        {
            (write.set_rate)(simulation, at, rate);
        }
        Ok(())
    }

    /// The axis along which the variable at an index takes a second derivative: only quadratic motion has one.
    pub fn check_acceleration(
        &self,
        scene: &Scene,
        index: usize,
        acceleration: f64,
    ) -> Result<(BoundaryIndex, usize), InterfaceError> {
        self.check_rate(index, acceleration)?;
        let variable = self.variable(index)?;
        let axis = match &variable.source {
            Source::Row(rows::Source { row: rows::Row { write: Some(write), .. }, at }) => match (write.input)(*at) {
                Input::Axis(boundary, axis) => Some((boundary, axis)),
                Input::Node(..) | Input::Rate(_) | Input::Strain(_) | Input::Heat(..) | Input::Fluid(..) => None,
            },
            _ => None,
        };
        let quadratic = |&(boundary, axis): &(BoundaryIndex, usize)| {
            let boundary = &scene.boundaries[boundary.index()];
            boundary.input == InputCourse::Quadratic && axis < 3 && boundary.axes[axis].takes_place()
        };
        let refused = || InterfaceError::NoAcceleration { name: variable.name.clone() };
        axis.filter(quadratic).ok_or_else(refused)
    }
}

/// Whether a value for a variable is a finite number.
fn is_finite(variable: &Variable, value: f64) -> Result<(), InterfaceError> {
    let refused = || InterfaceError::NotFinite { name: variable.name.clone(), value };
    if value.is_finite() { Ok(()) } else { Err(refused()) }
}
