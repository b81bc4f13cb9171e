//! Values of variables and their derivatives: read and set.

use super::Instance;
use crate::calls::Phase;
use crate::host_memory::Items;
use crate::refusal::Refusal;
use crate::types::Reference;
use cograin::interface::{Causality, InterfaceError, Type, Value, Variable};
use std::ffi::{CStr, CString};

impl Instance {
    /// The variable with a reference, if it is of the type that the function is for.
    fn variable(&self, reference: Reference, expected: &'static str) -> Result<(usize, &Variable), Refusal> {
        let index = reference as usize;
        let variable = self.unit.interface.variable(index)?;
        let found = variable.quantity.of_type().name();
        if found == expected {
            Ok((index, variable))
        } else {
            Err(Refusal::Type { reference, name: variable.name.clone(), found, expected })
        }
    }

    /// Values of variables of one type.
    pub(crate) fn values(&mut self, references: Items<Reference>, kind: &'static str) -> Result<&[Value], Refusal> {
        if !self.course.placed {
            for reference in references.iter() {
                self.variable(reference, kind)?;
            }
            self.place()?;
        }
        let wanted = [Type::Real, Type::Integer].into_iter().find(|known| known.name() == kind);
        let mut values = std::mem::take(&mut self.values);
        values.clear();
        for reference in references.iter() {
            let index = reference as usize;
            if wanted.is_none() || self.unit.interface.type_of(index) != wanted {
                self.variable(reference, kind)?;
            }
            let value = self.unit.interface.value_with(&self.simulation, &self.findings, index);
            if !value.number().is_finite() {
                let name = self.unit.interface.variables()[index].name.clone();
                return Err(Refusal::NoNumber { reference, name, value: value.number() });
            }
            values.push(value);
        }
        self.values = values;
        Ok(&self.values)
    }

    /// `fmi2SetReal` and `fmi2SetInteger`: all or nothing.
    pub(crate) fn set<T: Copy + Into<f64>>(
        &mut self,
        references: Items<Reference>,
        values: Items<T>,
        kind: &'static str,
    ) -> Result<(), Refusal> {
        let starting = matches!(self.course.phase, Phase::Instantiated | Phase::Initialization);
        let mut tuned = Vec::new();
        for (reference, value) in references.iter().zip(values.iter()) {
            let (index, variable) = self.variable(reference, kind)?;
            self.unit.interface.check(index, value.into())?;
            if variable.causality == Causality::Parameter && !starting {
                tuned.push((index, value.into()));
            }
        }
        if !tuned.is_empty() {
            self.frames.pass(&self.simulation, None);
            self.unit.interface.tune(&mut self.simulation, &tuned)?;
            self.changed();
        }
        for (reference, value) in references.iter().zip(values.iter()) {
            let (index, value) = (reference as usize, value.into());
            if starting {
                self.course.placed = false;
                self.give(index, value);
            }
            self.unit.interface.set(&mut self.simulation, index, Value::Real(value))?;
        }
        Ok(())
    }

    /// Notes the value of a parameter that the simulation is to be made with.
    fn give(&mut self, index: usize, value: f64) {
        let variable = &self.unit.interface.variables()[index];
        if variable.start == Some(value) {
            self.given.remove(&index);
        } else if variable.causality == Causality::Parameter {
            self.given.insert(index, value);
        }
    }

    /// `fmi2GetString`
    pub(crate) fn texts(&self, references: Items<Reference>) -> Result<Vec<&CStr>, Refusal> {
        let text = |reference| self.variable(reference, "String").map(|(index, _)| self.frames.text(index));
        references.iter().map(text).collect()
    }

    /// Whether all of these are texts that may be set now.
    pub(crate) fn check_texts(&self, references: Items<Reference>) -> Result<(), Refusal> {
        let starting = matches!(self.course.phase, Phase::Instantiated | Phase::Initialization);
        for reference in references.iter() {
            let (index, variable) = self.variable(reference, "String")?;
            if !starting {
                return Err(InterfaceError::Fixed { index, name: variable.name.clone() }.into());
            }
        }
        Ok(())
    }

    /// `fmi2SetString`, once the references are checked: all or nothing.
    pub(crate) fn set_texts(&mut self, references: Items<Reference>, values: Vec<CString>) {
        for (reference, value) in references.iter().zip(values) {
            self.frames.set_text(reference as usize, value);
        }
    }

    /// The other setters: there are no inputs of these types, so every reference is a wrong one.
    pub(crate) fn refuse_to_set(&self, references: Items<Reference>, kind: &'static str) -> Result<(), Refusal> {
        for reference in references.iter() {
            let (index, _) = self.variable(reference, kind)?;
            self.unit.interface.check(index, 0.0)?;
        }
        Ok(())
    }

    /// `fmi2SetRealInputDerivatives`, of order 1, or 2 where the motion is quadratic: all or nothing.
    pub(crate) fn set_rates(
        &mut self,
        references: Items<Reference>,
        orders: Items<i32>,
        rates: Items<f64>,
    ) -> Result<(), Refusal> {
        for ((reference, order), rate) in references.iter().zip(orders.iter()).zip(rates.iter()) {
            let (index, variable) = self.variable(reference, "Real")?;
            match order {
                1 => self.unit.interface.check_rate(index, rate)?,
                2 => drop(self.unit.interface.check_acceleration(&self.unit.scene, index, rate)?),
                _ => {
                    let expected = "order 1, or order 2 of quadratic motion";
                    return Err(Refusal::Order { order, expected, reference, name: variable.name.clone() });
                }
            }
        }
        for ((reference, order), rate) in references.iter().zip(orders.iter()).zip(rates.iter()) {
            let (interface, index) = (&self.unit.interface, reference as usize);
            if order == 1 {
                interface.set_rate(&mut self.simulation, index, rate)?;
            } else {
                let (boundary, axis) = interface.check_acceleration(&self.unit.scene, index, rate)?;
                self.simulation.set_input_acceleration(boundary, axis, rate);
            }
        }
        Ok(())
    }

    /// `fmi2GetDirectionalDerivative`: change of each unknown, an output, per unit of a direction of inputs.
    pub(crate) fn directional_derivatives(
        &mut self,
        unknowns: Items<Reference>,
        knowns: Items<Reference>,
        direction: Items<f64>,
    ) -> Result<Vec<f64>, Refusal> {
        let index = |reference| Ok(self.variable(reference, "Real")?.0);
        let inputs = knowns.iter().map(index).collect::<Result<Vec<usize>, Refusal>>()?;
        let outputs = unknowns.iter().map(index).collect::<Result<Vec<usize>, Refusal>>()?;
        let direction: Vec<(usize, f64)> = inputs.into_iter().zip(direction.iter()).collect();
        let Self { unit, simulation, derivatives, .. } = self;
        Ok(unit.interface.derivatives(simulation, derivatives, (&outputs, &direction))?)
    }

    /// `fmi2GetRealOutputDerivatives`: of order 1.
    pub(crate) fn output_derivatives(
        &mut self,
        references: Items<Reference>,
        orders: Items<i32>,
    ) -> Result<Vec<f64>, Refusal> {
        let mut rates = Vec::new();
        for (reference, order) in references.iter().zip(orders.iter()) {
            let (index, variable) = self.variable(reference, "Real")?;
            if order != 1 {
                return Err(Refusal::Order { order, expected: "order 1", reference, name: variable.name.clone() });
            }
            rates.push(self.unit.interface.rate(&self.simulation, index)?);
        }
        Ok(rates)
    }
}
