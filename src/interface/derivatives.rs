//! How outputs change with inputs and in time.

use super::{Causality, Interface, InterfaceError, Source, rows};
use crate::dual::DIRECTIONS;
use crate::quantity::BoundaryIndex;
use crate::scene::Scene;
use crate::step::{BoundaryDerivatives, NoDerivative, Simulation};

/// What has been found of the derivatives of the last communication step. As [`super::Findings`] it is part of no state: whoever
/// changes the simulation forgets it.
#[derive(Debug, Default)]
pub struct Derivatives {
    /// Inputs, by index, that were followed together, and what came of it.
    found: Vec<(Vec<usize>, Vec<BoundaryDerivatives>)>,
    /// Rates of the loads at the present time.
    rates: Option<Vec<BoundaryDerivatives>>,
}

impl Interface {
    /// Whether the unit of a scene has directional derivatives: otherwise why not.
    pub fn check_derivatives(&self, scene: &Scene) -> Result<(), InterfaceError> {
        Ok(Simulation::follows(scene)?)
    }

    /// Whether the unit of a scene has rates of outputs: otherwise why not.
    pub fn check_rates(&self, scene: &Scene) -> Result<(), InterfaceError> {
        Ok(Simulation::has_rates(scene)?)
    }

    /// Whether a variable has derivatives by inputs, in a scene that has them.
    pub fn has_slopes(&self, index: usize) -> bool {
        self.slopes_of(index).is_ok()
    }

    /// The inputs of a scene that derivatives are taken by, by index.
    pub fn followed(&self, scene: &Scene) -> Vec<usize> {
        let follows = |index: &usize| self.axis_of(*index).is_ok() && Simulation::follows(scene).is_ok();
        (0..self.variables.len()).filter(follows).collect()
    }

    /// Change of an output at the end of the last communication step per unit change of an input at that end.
    pub fn derivative(
        &self,
        simulation: &mut Simulation,
        known: &mut Derivatives,
        [output, input]: [usize; 2],
    ) -> Result<f64, InterfaceError> {
        let (slopes, at) = self.slopes_of(output)?;
        self.axis_of(input)?;
        if !known.found.iter().any(|(inputs, _)| inputs.contains(&input)) {
            let beside = self
                .followed(simulation.scene())
                .into_iter()
                .filter(|other| *other != input && !known.found.iter().any(|(inputs, _)| inputs.contains(other)));
            let inputs: Vec<usize> = [input].into_iter().chain(beside).take(DIRECTIONS).collect();
            let axes = inputs.iter().map(|&input| self.axis_of(input)).collect::<Result<Vec<_>, _>>()?;
            let found = simulation.derivatives(&axes)?;
            known.found.push((inputs, found));
        }
        let place = |(inputs, found): &(Vec<usize>, Vec<BoundaryDerivatives>)| {
            let direction = inputs.iter().position(|other| *other == input)?;
            Some(slopes(found, at)[direction])
        };
        known.found.iter().find_map(place).ok_or_else(|| NoDerivative::NoStep.into())
    }

    /// Rate of an output at the present time, per second.
    pub fn rate(
        &self,
        simulation: &mut Simulation,
        known: &mut Derivatives,
        output: usize,
    ) -> Result<f64, InterfaceError> {
        let (slopes, at) = self.slopes_of(output)?;
        let has_rate = matches!(&self.variables[output].source, Source::Row(source) if source.row.has_rate);
        if !has_rate {
            return Err(InterfaceError::NoSlope { index: output, name: self.variables[output].name.clone() });
        }
        let rates = match &mut known.rates {
            Some(rates) => rates,
            rates => rates.insert(simulation.rates()?),
        };
        Ok(slopes(rates, at)[0])
    }

    /// How the derivatives of a variable are read.
    fn slopes_of(&self, index: usize) -> Result<(rows::ReadSlopes, rows::At), InterfaceError> {
        let variable = self.variable(index)?;
        match &variable.source {
            Source::Row(rows::Source { row: rows::Row { slopes: Some(slopes), .. }, at }) => Ok((*slopes, *at)),
            _ => Err(InterfaceError::NoSlope { index, name: variable.name.clone() }),
        }
    }

    /// The axis that an input is of.
    fn axis_of(&self, index: usize) -> Result<(BoundaryIndex, usize), InterfaceError> {
        let variable = self.variable(index)?;
        let no_input = || InterfaceError::NoInput { index, name: variable.name.clone() };
        match &variable.source {
            Source::Row(rows::Source { row: rows::Row { write: Some(write), .. }, at })
                if variable.causality == Causality::Input =>
            {
                (write.axis)(*at).ok_or_else(no_input)
            }
            _ => Err(no_input()),
        }
    }
}
