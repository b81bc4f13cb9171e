//! The variables seen from outside: one table, from which the unit's description, the unit and `history.csv` come.
//!
//! Forces and moments are those *of the particles on the boundary*; moments are taken about the boundary's
//! moved reference point. Reading a variable changes nothing; setting one is checked first.

mod findings;
mod quantity;
mod rows;

pub use findings::Findings;
pub use quantity::Quantity;

use crate::scene::Scene;
use crate::state::State;
use crate::step::Simulation;
use rows::Present;

/// Whether a variable is given from outside or computed here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Given from outside before each communication step.
    Input,
    /// Computed here.
    Output,
}

/// When a variable changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Never.
    Constant,
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

/// One variable, as the outside sees it.
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
    /// Its value before anything is set, for inputs and constants.
    pub start: Option<f64>,
    /// Its lower bound, where nature sets one.
    pub minimum: Option<f64>,
    /// Whether its value at the start follows from the start values of the inputs.
    pub follows_inputs_at_start: bool,
    /// How it is read and written.
    source: rows::Source,
}

/// Why a variable was not set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InterfaceError {
    /// There is no such variable.
    #[error("{index} is no variable; 0 to {last} are")]
    Unknown {
        /// The index asked for.
        index: usize,
        /// The last index there is.
        last: usize,
    },
    /// It is not an input.
    #[error("{index} is an output ({name}); only inputs may be set")]
    Output {
        /// Its index.
        index: usize,
        /// Its name.
        name: String,
    },
    /// The value is no number.
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
}

impl Interface {
    /// The variables of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self { variables: rows::variables(scene) }
    }

    /// The same variables, with the start values of a scene that begins in this state.
    pub fn starting_in(mut self, state: &State) -> Self {
        for variable in &mut self.variables {
            if let Some(write) = variable.source.row.write {
                variable.start = Some((write.held)(state, variable.source.at));
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

    /// The present value of the variable at an index of the table.
    pub fn value(&self, simulation: &Simulation, index: usize) -> Value {
        self.value_with(simulation, &Findings::default(), index)
    }

    /// The same, where several values are asked for: what was found for one serves the others.
    pub fn value_with(&self, simulation: &Simulation, findings: &Findings, index: usize) -> Value {
        let rows::Source { row, at } = self.variables[index].source;
        (row.read)(Present { simulation, findings }, at)
    }

    /// Whether the variable at an index may be set to a value.
    pub fn check(&self, index: usize, value: f64) -> Result<(), InterfaceError> {
        let variable = self.variable(index)?;
        if variable.causality == Causality::Output {
            return Err(InterfaceError::Output { index, name: variable.name.clone() });
        }
        if !value.is_finite() {
            return Err(InterfaceError::NotFinite { index, name: variable.name.clone(), value });
        }
        Ok(())
    }

    /// Sets an input; it takes effect in the next communication step.
    pub fn set(&self, simulation: &mut Simulation, index: usize, value: Value) -> Result<(), InterfaceError> {
        self.check(index, value.number())?;
        let rows::Source { row, at } = self.variables[index].source;
        if let Some(write) = row.write {
            (write.set)(simulation, at, value.number());
        }
        Ok(())
    }

    /// Sets the rate of an input: in the next communication step it goes on from its value at this rate
    /// \[unit of the input/s\].
    pub fn set_rate(&self, simulation: &mut Simulation, index: usize, rate: f64) -> Result<(), InterfaceError> {
        self.check(index, rate)?;
        let rows::Source { row, at } = self.variables[index].source;
        if let Some(write) = row.write {
            (write.set_rate)(simulation, at, rate);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
