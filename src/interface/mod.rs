//! The variables seen from outside: one table, from which the unit's description, the unit and `history.csv` come.
//!
//! Forces and moments are those *of the particles on the boundary*; moments are taken about the boundary's
//! moved reference point. Reading a variable changes nothing; setting one is checked first.

mod arrays;
mod chosen;
mod derivatives;
mod error;
mod findings;
mod losses;
mod parameters;
mod quantity;
mod reader;
mod rows;
mod standard;
mod texts;
mod writing;

pub use arrays::Array;
pub use chosen::{ChosenError, MOST_COLUMNS};
pub use derivatives::Derivatives;
pub use error::InterfaceError;
pub use findings::Findings;
pub use quantity::{Quantity, Type};
pub use rows::{Field, fields};
pub use standard::Standard;
pub use texts::FRAMES;

use crate::engine::simulation::Simulation;
use crate::engine::state::State;
use crate::scene::Scene;
use parameters::Parameter;
use reader::Reader;
use rows::Present;
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
    #[inline]
    pub fn number(self) -> f64 {
        match self {
            Self::Real(value) => value,
            Self::Integer(value) => f64::from(value),
        }
    }
}

impl std::fmt::Display for Value {
    /// The shortest text that reads back as the same number; none where there is no number.
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Real(value) if !value.is_finite() => Ok(()),
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
    /// The node of a mesh or the cell of a grid that it is of, from 0, if it is of one.
    pub fn element(&self) -> Option<usize> {
        match &self.source {
            Source::Row(row) => row.element(),
            Source::Parameter(_) | Source::Text(_) | Source::Derived(_) => None,
        }
    }

    /// The boundary that it is of, from 0, if it is of one.
    pub fn boundary(&self) -> Option<usize> {
        match &self.source {
            Source::Row(row) => row.boundary(),
            Source::Parameter(_) | Source::Text(_) | Source::Derived(_) => None,
        }
    }

    /// Its value before anything is set, if it is a text.
    pub fn start_text(&self) -> Option<&'static str> {
        match self.source {
            Source::Text(text) => Some(text.start),
            Source::Row(_) | Source::Parameter(_) | Source::Derived(_) => None,
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
    /// The sum of these variables.
    Derived(Vec<usize>),
}

/// All variables of a scene. The index of a variable is its place in the table.
#[derive(Clone, Debug)]
pub struct Interface {
    /// The table.
    variables: Vec<Variable>,
    /// How each is read.
    readers: Vec<Reader>,
    /// Indices of the outputs and inputs that a run records.
    recorded: Vec<usize>,
}

impl Interface {
    /// The variables of a scene.
    pub fn of(scene: &Scene) -> Self {
        let mut variables = rows::variables(scene);
        let derived = chosen::derived(scene, &variables);
        variables.extend(derived);
        variables.extend(parameters::variables(scene));
        variables.extend(texts::variables());
        let readers = variables.iter().map(Reader::of).collect();
        let recorded = chosen::recorded(scene, &variables);
        Self { variables, readers, recorded }
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

    /// What a run records, each with its index: the outputs and inputs that the scene names, or all outputs but those of single nodes and cells of grids and, beyond
    /// [`MOST_COLUMNS`], of groups of particles.
    pub fn recorded(&self) -> impl Iterator<Item = (usize, &Variable)> {
        self.recorded.iter().map(|&index| (index, &self.variables[index]))
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
    #[inline]
    pub fn value_with(&self, simulation: &Simulation, findings: &Findings, index: usize) -> Value {
        if let Reader { read: Some(read), at, .. } = self.readers[index] {
            return read(Present { simulation, findings }, at);
        }
        match &self.variables[index].source {
            Source::Row(rows::Source { row, at }) => (row.read)(Present { simulation, findings }, *at),
            Source::Parameter(parameter) => parameter.value(simulation),
            Source::Derived(terms) => {
                let values = || terms.iter().map(|&term| self.value_with(simulation, findings, term));
                match self.type_of(index) {
                    Some(Type::Integer) => {
                        let count = |sum: i32, value: Value| match value {
                            Value::Integer(count) => sum.saturating_add(count),
                            Value::Real(_) => sum,
                        };
                        Value::Integer(values().fold(0, count))
                    }
                    _ => Value::Real(values().map(Value::number).sum()),
                }
            }
            // Who holds the simulation holds its texts.
            Source::Text(_) => Value::Real(f64::NAN),
        }
    }

    /// The type of the variable at an index; nothing where there is no such variable.
    #[inline]
    pub fn type_of(&self, index: usize) -> Option<Type> {
        self.readers.get(index).map(|reader| reader.of_type)
    }
}

#[cfg(test)]
mod tests;
