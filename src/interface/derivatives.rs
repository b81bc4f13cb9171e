//! How outputs change with inputs and in time.

use super::{Causality, Findings, Interface, InterfaceError, Quantity, Source, Type, Variability, Variable, rows};
use crate::engine::simulation::{Input, Simulation};

/// What has been found of the derivatives of the last communication step. As [`Findings`] it is part of no state: whoever changes the
/// simulation forgets it.
#[derive(Debug, Default)]
pub struct Derivatives {
    /// Each direction that was asked for, and what changes along it.
    found: Vec<Found>,
}

/// Changes of outputs along a direction.
#[derive(Debug)]
struct Found {
    /// The inputs, by index, each with its share.
    direction: Vec<(usize, f64)>,
    /// The outputs, by index, ascending, each with its change.
    changes: Vec<(usize, f64)>,
}

impl Found {
    /// The change of an output, if it is known.
    fn of(&self, output: usize) -> Option<f64> {
        self.changes.binary_search_by_key(&output, |(known, _)| *known).ok().map(|place| self.changes[place].1)
    }
}

impl Derivatives {
    /// Forgets what has been found, for the simulation is another one now.
    pub fn forget(&mut self) {
        self.found.clear();
    }
}

impl Interface {
    /// Whether a variable is an output that changes continuously: one that has derivatives by inputs.
    pub fn is_continuous_output(&self, index: usize) -> bool {
        self.variables.get(index).is_some_and(|variable| is_continuous(variable, Causality::Output))
    }

    /// Whether there are inputs to take derivatives by.
    pub fn has_derivatives(&self) -> bool {
        self.variables.iter().any(|variable| is_continuous(variable, Causality::Input))
    }

    /// Whether any output has a rate.
    pub fn has_rates(&self) -> bool {
        self.outputs().any(|(_, variable)| rate_of(variable).is_some())
    }

    /// By how much outputs change at the end of the last communication step for each unit by which inputs change along a direction at
    /// that end: inputs by index, each with its share.
    pub fn derivatives(
        &self,
        simulation: &mut Simulation,
        known: &mut Derivatives,
        (outputs, direction): (&[usize], &[(usize, f64)]),
    ) -> Result<Vec<f64>, InterfaceError> {
        for &index in outputs {
            if !self.is_continuous_output(index) {
                return Err(InterfaceError::NoDerivative { name: self.variable(index)?.name.clone() });
            }
        }
        let mut inputs = Vec::new();
        for &(index, share) in direction {
            let input = self.input_of(index)?;
            if !share.is_finite() {
                let name = self.variables[index].name.clone();
                return Err(InterfaceError::NotFinite { name, value: share });
            }
            inputs.push(input);
        }
        // Of one input the unit direction is remembered.
        let (factor, direction) = match *direction {
            [(input, share)] if share != 0.0 => (share, vec![(input, 1.0)]),
            _ => (1.0, direction.to_vec()),
        };
        let there =
            |found: &Found| found.direction == direction && outputs.iter().all(|&output| found.of(output).is_some());
        let place = match known.found.iter().position(there) {
            Some(place) => place,
            None => {
                let inputs: Vec<(Input, f64)> =
                    inputs.into_iter().zip(&direction).map(|(input, (_, share))| (input, *share)).collect();
                let changes = self.changes(simulation, outputs, &inputs)?;
                known.found.retain(|found| found.direction != direction);
                known.found.push(Found { direction, changes });
                known.found.len() - 1
            }
        };
        let change = |&index: &usize| {
            let value = factor * known.found[place].of(index).unwrap_or(f64::NAN);
            let name = || self.variables[index].name.clone();
            if value.is_finite() { Ok(value) } else { Err(InterfaceError::NotKnown { name: name() }) }
        };
        outputs.iter().map(change).collect()
    }

    /// Changes of these outputs along a direction, and of those of boundaries, for which the host may ask next.
    fn changes(
        &self,
        simulation: &mut Simulation,
        outputs: &[usize],
        direction: &[(Input, f64)],
    ) -> Result<Vec<(usize, f64)>, InterfaceError> {
        let is_likely = |index: &usize| self.is_continuous_output(*index) && is_read_at_once(&self.variables[*index]);
        let mut read: Vec<usize> = (0..self.variables.len()).filter(is_likely).chain(outputs.iter().copied()).collect();
        read.sort_unstable();
        read.dedup();
        let changes = simulation.differences(direction, &mut |simulation| {
            let findings = Findings::default();
            read.iter().map(|&index| self.value_with(simulation, &findings, index).number()).collect()
        })?;
        Ok(read.into_iter().zip(changes).collect())
    }

    /// Rate of an output at the present time, per second.
    pub fn rate(&self, simulation: &Simulation, output: usize) -> Result<f64, InterfaceError> {
        let variable = self.variable(output)?;
        match rate_of(variable) {
            Some((rate, at)) => Ok(rate(simulation.state(), at)),
            None => Err(InterfaceError::NoOutputRate { name: variable.name.clone() }),
        }
    }

    /// The input at an index, if it is one that changes continuously.
    fn input_of(&self, index: usize) -> Result<Input, InterfaceError> {
        let variable = self.variable(index)?;
        match &variable.source {
            Source::Row(rows::Source { row: rows::Row { write: Some(write), .. }, at }) => Ok((write.input)(*at)),
            _ => Err(InterfaceError::NoInput { name: variable.name.clone() }),
        }
    }
}

/// Whether a variable of this causality is a real number that changes at any time.
fn is_continuous(variable: &Variable, causality: Causality) -> bool {
    let kind = (variable.causality, variable.variability, variable.quantity.of_type());
    kind == (causality, Variability::Continuous, Type::Real)
}

/// Whether a variable is one of the few of a boundary that are read without a pass over particles or contacts.
fn is_read_at_once(variable: &Variable) -> bool {
    let of_boundary = matches!(&variable.source, Source::Row(source) if source.is_of_boundary());
    of_boundary && variable.quantity != Quantity::Stiffness
}

/// How the rate of a variable is read, if it has one.
fn rate_of(variable: &Variable) -> Option<(rows::ReadRate, rows::At)> {
    match &variable.source {
        Source::Row(rows::Source { row, at }) => row.rate.map(|rate| (rate, *at)),
        Source::Parameter(_) | Source::Text(_) | Source::Derived(_) => None,
    }
}
