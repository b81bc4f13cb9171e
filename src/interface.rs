//! The variables seen from outside: one table, from which the unit's description, the unit and `history.csv` come.
//!
//! Forces and moments are those *of the particles on the boundary*; moments are taken about the boundary's
//! moved reference point. Reading a variable changes nothing; setting one is checked first.

mod meaning;
mod quantity;

pub use quantity::Quantity;

use crate::motion::Seen;
use crate::quantity::BoundaryIndex;
use crate::scene::{Boundary, Scene};
use crate::state::State;
use crate::step::{RunError, Simulation};
use meaning::Meaning;

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
    /// Where its value is found.
    meaning: Meaning,
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
        let mut variables = Vec::new();
        for (index, boundary) in scene.boundaries.iter().enumerate() {
            let index = BoundaryIndex(u32::try_from(index).unwrap_or(u32::MAX));
            variables.extend(of_boundary(scene, boundary, index).into_iter().map(|meaning| meaning.variable(scene)));
        }
        let mut whole = vec![Meaning::KineticEnergy];
        if !(scene.contacts.is_empty() && scene.bonds.is_empty()) {
            whole.push(Meaning::ElasticEnergy);
        }
        if scene.output.energy {
            whole.extend([Meaning::DissipatedEnergy, Meaning::EnergyResidual]);
        }
        whole.extend([Meaning::ContactCount, Meaning::LargestOverlap]);
        if !scene.bonds.is_empty() {
            let energies = [Meaning::BondElasticEnergy, Meaning::BondDissipatedEnergy];
            whole.extend([Meaning::IntactBonds, Meaning::BrokenBonds].into_iter().chain(energies));
        }
        whole.extend([Meaning::TimeStep, Meaning::StableStep]);
        variables.extend(whole.into_iter().map(|meaning| meaning.variable(scene)));
        Self { variables }
    }

    /// The same variables, with the start values of a scene that begins in this state.
    pub fn starting_in(mut self, state: &State) -> Self {
        for variable in &mut self.variables {
            if let (Causality::Input, Some((boundary, axis))) = (variable.causality, variable.meaning.axis()) {
                variable.start = Some(state.boundaries[boundary.index()].target[axis]);
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
        self.variables[index].meaning.value(simulation)
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
        if let Some((boundary, axis)) = self.variables[index].meaning.axis() {
            simulation.set_displacement(boundary, axis, value.number());
        }
        Ok(())
    }

    /// Sets the rate of an input: in the next communication step it goes on from its value at this rate
    /// \[unit of the input/s\].
    pub fn set_rate(&self, simulation: &mut Simulation, index: usize, rate: f64) -> Result<(), InterfaceError> {
        self.check(index, rate)?;
        if let Some((boundary, axis)) = self.variables[index].meaning.axis() {
            simulation.set_displacement_rate(boundary, axis, rate);
        }
        Ok(())
    }

    /// Takes the boundaries to the present values of the inputs without motion, before the first communication
    /// step. If the scene cannot start so, nothing has changed.
    pub fn place(&self, simulation: &mut Simulation) -> Result<(), RunError> {
        let before = simulation.state().clone();
        let mut starts = Vec::new();
        for (_, variable) in self.inputs() {
            if let Some((boundary, axis)) = variable.meaning.axis() {
                starts.push((boundary, axis, before.boundaries[boundary.index()].target[axis]));
            }
        }
        simulation.place(&starts).inspect_err(|_| simulation.restore(&before))
    }
}

/// What the outside gives to and gets from one boundary, inputs first.
fn of_boundary(scene: &Scene, boundary: &Boundary, index: BoundaryIndex) -> Vec<Meaning> {
    let axes = &scene.boundaries[index.index()].axes;
    let place = |axis: usize| match axis {
        0..3 => Meaning::Displacement(index, axis),
        _ => Meaning::Rotation(index, axis - 3),
    };
    let rate = |axis: usize| match axis {
        0..3 => Meaning::Velocity(index, axis),
        _ => Meaning::AngularVelocity(index, axis - 3),
    };
    let of = |seen: &'static [Seen]| (0..6).filter(move |&axis| seen.contains(&axes[axis].seen()));
    let mut list: Vec<Meaning> = of(&[Seen::Input]).map(place).collect();
    list.extend(of(&[Seen::Place, Seen::PlaceAndRate]).map(place));
    list.extend(of(&[Seen::PlaceAndRate]).map(rate));
    for load in [Meaning::Force, Meaning::Moment, Meaning::MeanForce, Meaning::MeanMoment] {
        list.extend((0..3).map(|axis| load(index, axis)));
    }
    list.push(Meaning::Work(index));
    if !boundary.shape.members().is_empty() {
        list.push(Meaning::Mass(index));
    }
    list
}

#[cfg(test)]
mod tests;
