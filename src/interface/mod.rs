//! The variables seen from outside: one table, from which the unit's description, the unit and `history.csv` come.
//!
//! Forces and moments are those *of the particles on the boundary*; moments are taken about the boundary's
//! moved reference point. Reading a variable changes nothing; setting one is checked first.

mod derivatives;
mod findings;
mod losses;
mod parameters;
mod quantity;
mod reader;
mod rows;
mod texts;

pub use derivatives::Derivatives;
pub use findings::Findings;
pub use quantity::{Quantity, Type};
pub use texts::FRAMES;

use crate::quantity::BoundaryIndex;
use crate::scene::{self, InputCourse, Scene, SceneErrors};
use crate::state::State;
use crate::step::{NoDerivative, Simulation, TuneError};
use parameters::Parameter;
use reader::Reader;
use rows::Present;
use std::collections::BTreeMap;
use texts::Text;

/// Whether the host sets a variable or the program computes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The host sets it before each communication step.
    Input,
    /// The program computes it.
    Output,
    /// The host sets it before the start or, if it is tunable, between communication steps.
    Parameter,
}

/// When a variable changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Never.
    Constant,
    /// Not after the initialisation.
    Fixed,
    /// When it is set between communication steps.
    Tunable,
    /// From one communication step to the next, in jumps.
    Discrete,
    /// At any time.
    Continuous,
}

/// The value of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A real number, in the unit of its quantity.
    Real(f64),
    /// A count.
    Integer(i32),
}

impl Value {
    /// The value as a real number.
    pub fn number(self) -> f64 {
        match self {
            Self::Real(value) => value,
            Self::Integer(value) => f64::from(value),
        }
    }
}

impl std::fmt::Display for Value {
    /// The shortest text that reads back as the same number.
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Real(value) => write!(formatter, "{value:?}"),
            Self::Integer(value) => write!(formatter, "{value}"),
        }
    }
}

/// One variable, as the host sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name: `<boundary>.<quantity>.<axis>` or `<group>.<quantity>`.
    pub name: String,
    /// What it is, with its sign.
    pub description: String,
    /// What is measured, and with it the unit and the type.
    pub quantity: Quantity,
    /// Given or computed.
    pub causality: Causality,
    /// When it changes.
    pub variability: Variability,
    /// Its value before anything is set, for inputs, parameters and constants that are numbers.
    pub start: Option<f64>,
    /// Its lower bound, if physics sets one.
    pub minimum: Option<f64>,
    /// Its upper bound, likewise.
    pub maximum: Option<f64>,
    /// Whether its value at the start follows from the start values of the inputs.
    pub follows_inputs_at_start: bool,
    /// How it is read and written.
    source: Source,
}

impl Variable {
    /// The node that it is of, from 0, if it is of one.
    pub fn node(&self) -> Option<usize> {
        match &self.source {
            Source::Row(row) => row.node(),
            Source::Parameter(_) | Source::Text(_) => None,
        }
    }

    /// Its value before anything is set, if it is a text.
    pub fn start_text(&self) -> Option<&'static str> {
        match self.source {
            Source::Text(text) => Some(text.start),
            Source::Row(_) | Source::Parameter(_) => None,
        }
    }
}

/// Where a variable comes from.
#[derive(Clone, Debug, PartialEq)]
enum Source {
    /// A row of the table.
    Row(rows::Source),
    /// The parameter of the scene with this place.
    Parameter(Parameter),
    /// A row of the table of texts.
    Text(&'static Text),
}

/// Why a variable was not set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InterfaceError {
    /// There is no such variable.
    #[error("{index} is not a variable; the variables are 0 to {last}")]
    Unknown {
        /// The index asked for.
        index: usize,
        /// The last index there is.
        last: usize,
    },
    /// It is neither input nor parameter.
    #[error("{index} is an output ({name}); only inputs and parameters may be set")]
    Output {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
    },
    /// A parameter does not take the value.
    #[error("{index} ({name}): {refusal}")]
    Range {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
        /// What was found and what would be right, as the scene says it.
        refusal: String,
    },
    /// A parameter is not an input.
    #[error("{index} is a parameter ({name}); only inputs have rates")]
    NoRate {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
    },
    /// An input that has no second derivative.
    #[error(
        "order 2 for {index} ({name}); order 1, or the displacement along an axis of a boundary with input = \"quadratic\", is \
         right"
    )]
    NoAcceleration {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
    },
    /// A parameter that can no longer be changed.
    #[error("{index} ({name}) is a fixed parameter; it may be set until fmi2ExitInitializationMode")]
    Fixed {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
    },
    /// An output whose derivatives are not followed.
    #[error(
        "{index} ({name}): no derivative; displacement, velocity, force and moment of a boundary, and mean loads, have some by inputs; displacement, force and moment in time"
    )]
    NoSlope {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
    },
    /// A derivative with respect to what is not an input.
    #[error("{index} ({name}) is not an input; derivatives are with respect to inputs")]
    NoInput {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
    },
    /// The scene or the moment has no derivatives.
    #[error(transparent)]
    NoDerivative(#[from] NoDerivative),
    /// Values of tunable parameters that contradict each other.
    #[error(transparent)]
    Tune(#[from] TuneError),
    /// The value is not a finite number.
    #[error("{value} for {index} ({name}); a finite number is right")]
    NotFinite {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
        /// The value given.
        value: f64,
    },
}

/// All variables of a scene. The index of a variable is its place in the table.
#[derive(Clone, Debug)]
pub struct Interface {
    /// The table.
    variables: Vec<Variable>,
    /// How each is read.
    readers: Vec<Reader>,
}

impl Interface {
    /// The variables of a scene.
    pub fn of(scene: &Scene) -> Self {
        let mut variables = rows::variables(scene);
        variables.extend(parameters::variables(scene));
        variables.extend(texts::variables());
        let readers = variables.iter().map(Reader::of).collect();
        Self { variables, readers }
    }

    /// The same variables, with the start values of a scene that begins in this state.
    pub fn starting_in(mut self, state: &State) -> Self {
        for variable in &mut self.variables {
            if let Source::Row(rows::Source { row: rows::Row { write: Some(write), .. }, at }) = variable.source {
                variable.start = Some((write.held)(state, at));
            }
        }
        self
    }

    /// The table.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The variables of one causality, each with its index.
    pub fn of_causality(&self, causality: Causality) -> impl Iterator<Item = (usize, &Variable)> {
        self.variables.iter().enumerate().filter(move |(_, variable)| variable.causality == causality)
    }

    /// The outputs, each with its index.
    pub fn outputs(&self) -> impl Iterator<Item = (usize, &Variable)> {
        self.of_causality(Causality::Output)
    }

    /// The outputs that a run records, each with its index: all but those of single nodes.
    pub fn recorded(&self) -> impl Iterator<Item = (usize, &Variable)> {
        self.outputs().filter(|(_, variable)| variable.node().is_none())
    }

    /// The inputs, each with its index.
    pub fn inputs(&self) -> impl Iterator<Item = (usize, &Variable)> {
        self.of_causality(Causality::Input)
    }

    /// Index of the variable with this name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.variables.iter().position(|variable| variable.name == name)
    }

    /// The variable at an index.
    pub fn variable(&self, index: usize) -> Result<&Variable, InterfaceError> {
        let unknown = InterfaceError::Unknown { index, last: self.variables.len().saturating_sub(1) };
        self.variables.get(index).ok_or(unknown)
    }

    /// The present value of the variable at an index of the table; not a number for a text.
    pub fn value(&self, simulation: &Simulation, index: usize) -> Value {
        self.value_with(simulation, &Findings::default(), index)
    }

    /// The same for several values: results found for one value are used again for the others.
    pub fn value_with(&self, simulation: &Simulation, findings: &Findings, index: usize) -> Value {
        if let Reader { read: Some(read), at, .. } = self.readers[index] {
            return read(Present { simulation, findings }, at);
        }
        match &self.variables[index].source {
            Source::Row(rows::Source { row, at }) => (row.read)(Present { simulation, findings }, *at),
            Source::Parameter(parameter) => parameter.value(simulation),
            // Who holds the simulation holds its texts.
            Source::Text(_) => Value::Real(f64::NAN),
        }
    }

    /// The type of the variable at an index; nothing where there is no such variable.
    pub fn type_of(&self, index: usize) -> Option<Type> {
        self.readers.get(index).map(|reader| reader.of_type)
    }

    /// Whether the variable at an index may be set to a value.
    pub fn check(&self, index: usize, value: f64) -> Result<(), InterfaceError> {
        let variable = self.variable(index)?;
        if variable.causality == Causality::Output {
            return Err(InterfaceError::Output { index, name: variable.name.clone() });
        }
        if let Source::Parameter(parameter) = &variable.source
            && let Err(refusal) = parameter.range.check(value)
        {
            return Err(InterfaceError::Range { index, name: variable.name.clone(), refusal });
        }
        is_finite(variable, index, value)?;
        if variable.minimum.is_some_and(|minimum| value < minimum) {
            let refusal =
                format!("{value:?} found; a number of {:?} or above is right", variable.minimum.unwrap_or(0.0));
            return Err(InterfaceError::Range { index, name: variable.name.clone(), refusal });
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

    /// Sets tunable parameters between communication steps, all or none. Parameters that are not tunable are ignored.
    pub fn tune(&self, simulation: &mut Simulation, values: &[(usize, f64)]) -> Result<(), InterfaceError> {
        let mut changes = Vec::new();
        for &(index, value) in values {
            self.check(index, value)?;
            if let Source::Parameter(parameter) = &self.variables[index].source {
                let name = || self.variables[index].name.clone();
                let place = parameter.tunable.ok_or_else(|| InterfaceError::Fixed { index, name: name() })?;
                changes.push((place, value));
            }
        }
        if changes.is_empty() { Ok(()) } else { Ok(simulation.tune(&changes)?) }
    }

    /// The scene of this source with these values of parameters, by index.
    pub fn scene_with(&self, source: &scene::Source, values: &BTreeMap<usize, f64>) -> Result<Scene, SceneErrors> {
        let named = values.iter().map(|(&index, &value)| (self.variables[index].name.as_str(), value));
        Scene::with_parameters(source, named)
    }

    /// Whether the variable at an index may be given a rate.
    pub fn check_rate(&self, index: usize, rate: f64) -> Result<(), InterfaceError> {
        let variable = self.variable(index)?;
        match variable.causality {
            Causality::Parameter => Err(InterfaceError::NoRate { index, name: variable.name.clone() }),
            Causality::Output => self.check(index, rate),
            Causality::Input => is_finite(variable, index, rate),
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
}

impl Interface {
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
            Source::Row(rows::Source { row: rows::Row { write: Some(write), .. }, at }) => (write.axis)(*at),
            _ => None,
        };
        let quadratic = |&(boundary, axis): &(BoundaryIndex, usize)| {
            let boundary = &scene.boundaries[boundary.index()];
            boundary.input == InputCourse::Quadratic && axis < 3 && boundary.axes[axis].takes_place()
        };
        let refused = || InterfaceError::NoAcceleration { index, name: variable.name.clone() };
        axis.filter(quadratic).ok_or_else(refused)
    }
}

/// Whether a value for a variable is a finite number.
fn is_finite(variable: &Variable, index: usize, value: f64) -> Result<(), InterfaceError> {
    let refused = || InterfaceError::NotFinite { index, name: variable.name.clone(), value };
    if value.is_finite() { Ok(()) } else { Err(refused()) }
}

#[cfg(test)]
mod tests;
