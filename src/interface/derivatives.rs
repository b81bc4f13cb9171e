//! How outputs change with inputs and in time.

use super::{Causality, Interface, InterfaceError, Source, rows};
use crate::quantity::BoundaryIndex;
use crate::scene::Scene;
use crate::step::{BoundaryDerivatives, Simulation};

/// What has been found of the derivatives of the last communication step. As [`super::Findings`] it is part of no state: whoever
/// changes the simulation forgets it.
#[derive(Debug, Default)]
pub struct Derivatives {
    /// Inputs, by index, and how the boundaries change with each.
    found: Vec<(usize, Vec<BoundaryDerivatives>)>,
    /// Inputs that the host has asked for since the last communication step.
    asked: Vec<usize>,
    /// Inputs that the host asked for after an earlier communication step, the last one of which it asked for any. It will
    /// probably ask for them again, so they are followed together with those that it asks for now.
    before: Vec<usize>,
    /// Rates of the loads at the present time.
    rates: Option<Vec<BoundaryDerivatives>>,
}

impl Derivatives {
    /// Forgets what has been found, for the simulation is another one now.
    pub fn forget(&mut self) {
        if !self.asked.is_empty() {
            self.before = std::mem::take(&mut self.asked);
        }
        self.found.clear();
        self.rates = None;
    }

    /// What was found of an input.
    fn by(&self, input: usize) -> Option<&[BoundaryDerivatives]> {
        self.found.iter().find(|(known, _)| *known == input).map(|(_, found)| &**found)
    }
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

    /// Finds how the boundaries change with some inputs, all together, as far as that is not known.
    pub fn find_derivatives(
        &self,
        simulation: &mut Simulation,
        known: &mut Derivatives,
        inputs: &[usize],
    ) -> Result<(), InterfaceError> {
        for &input in inputs {
            self.axis_of(input)?;
            if !known.asked.contains(&input) {
                known.asked.push(input);
            }
        }
        if inputs.iter().all(|&input| known.by(input).is_some()) {
            return Ok(());
        }
        let mut missing: Vec<usize> = known.asked.iter().chain(&known.before).copied().collect();
        missing.retain(|&input| known.by(input).is_none());
        missing.sort_unstable();
        missing.dedup();
        let axes = missing.iter().map(|&input| self.axis_of(input)).collect::<Result<Vec<_>, _>>()?;
        known.found.extend(missing.into_iter().zip(simulation.derivatives(&axes)?));
        Ok(())
    }

    /// Change of an output at the end of the last communication step per unit change of an input at that end.
    pub fn derivative(
        &self,
        simulation: &mut Simulation,
        known: &mut Derivatives,
        [output, input]: [usize; 2],
    ) -> Result<f64, InterfaceError> {
        let (slopes, at) = self.slopes_of(output)?;
        self.find_derivatives(simulation, known, &[input])?;
        Ok(known.by(input).map_or(0.0, |found| slopes(found, at)))
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
        Ok(slopes(rates, at))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Source as Text;
    use std::sync::Arc;

    /// A sphere on a plate that is driven along three axes.
    const SCENE: &str = r#"
[run]
step = 1.0e-5
[material.a]
density = 2500.0
[pair.a.a]
normal_stiffness = 1.0e4
normal_damping = 1.0
[contact.touch.normal.hooke_stiffness]
[particles.all]
material = "a"
list = [{ position = [0.0, 0.0, 0.0049], radius = 0.005 }]
[boundary.plate]
material = "a"
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
motion = { driven = ["x", "y", "z"] }
"#;

    #[test]
    fn inputs_that_were_asked_for_before_are_followed_together() {
        let text = Text { name: "scene.toml".into(), text: SCENE.into(), files: Default::default() };
        let scene = Scene::from_source(&text).unwrap_or_else(|errors| panic!("{errors}"));
        let interface = Interface::of(&scene);
        let inputs = interface.followed(&scene);
        assert_eq!(inputs.len(), 3);
        let mut simulation = Simulation::new(Arc::new(scene)).unwrap_or_else(|error| panic!("{error}"));
        let mut known = Derivatives::default();
        let mut follow = |asked: &[usize], expected: &[usize]| {
            known.forget();
            simulation.advance_or_return(1.0e-4).unwrap_or_else(|error| panic!("{error}"));
            interface
                .find_derivatives(&mut simulation, &mut known, asked)
                .unwrap_or_else(|refusal| panic!("{refusal}"));
            let found: Vec<usize> = known.found.iter().map(|(input, _)| *input).collect();
            assert_eq!(found, expected);
        };
        follow(&inputs[2..], &inputs[2..]);
        follow(&inputs[..2], &inputs);
        follow(&inputs[1..2], &inputs[..2]);
        follow(&inputs[1..2], &inputs[1..2]);
    }
}
