//! Values of variables and their derivatives: read and set.

use super::Instance;
use crate::calls::Phase;
use crate::host_memory::Items;
use crate::refusal::Refusal;
use crate::types::Reference;
use cograin::interface::{Causality, InterfaceError, Standard, Type, Value, Variable};
use std::ffi::{CStr, CString};
use std::ops::Range;
use std::sync::Arc;

/// Where the elements of the variables of FMI 3.0 stand in the table, by their value references: from a place to the next one. The
/// last variable is the time, which stands behind the table.
pub(super) type Places = Arc<[usize]>;

impl Instance {
    /// Places of the variables of FMI 3.0.
    pub(super) fn places(unit: &super::Unit) -> Places {
        if unit.standard == Standard::Fmi2 {
            return Places::default();
        }
        let behind = unit.interface.variables().len();
        let arrays = unit.interface.arrays(&unit.scene);
        arrays.iter().map(|array| array.first).chain([behind, behind + 1]).collect()
    }

    /// Indices of the elements of a variable of FMI 3.0.
    pub(crate) fn elements_of(&self, reference: Reference) -> Result<Range<usize>, Refusal> {
        let place = reference as usize;
        match self.places.get(place..place + 2) {
            Some(&[first, next]) => Ok(first..next),
            _ => Err(Refusal::Reference { reference, last: self.places.len().saturating_sub(2) }),
        }
    }

    /// The same of several, array after array.
    pub(crate) fn elements(
        &self,
        references: Items<Reference>,
    ) -> Result<impl Iterator<Item = usize> + Clone + use<>, Refusal> {
        for reference in references.iter() {
            self.elements_of(reference)?;
        }
        let places = Arc::clone(&self.places);
        Ok(references.iter().flat_map(move |reference| places[reference as usize]..places[reference as usize + 1]))
    }

    /// Whether an index is that of the time.
    fn is_time(&self, index: usize) -> bool {
        self.unit.standard == Standard::Fmi3 && index == self.unit.interface.variables().len()
    }

    /// The variable at an index, if it is of the type that the function is for.
    fn variable(&self, index: usize, expected: &'static str) -> Result<&Variable, Refusal> {
        if self.is_time(index) {
            return Err(Refusal::Independent { expected });
        }
        let variable = self.unit.interface.variable(index)?;
        let found = variable.quantity.of_type().name(self.unit.standard);
        if found == expected {
            Ok(variable)
        } else {
            Err(Refusal::Type { name: variable.name.clone(), found, expected })
        }
    }

    /// Values of variables of one type.
    pub(crate) fn values(
        &mut self,
        indices: impl Iterator<Item = usize> + Clone,
        kind: &'static str,
    ) -> Result<&[Value], Refusal> {
        let wanted = [Type::Real, Type::Integer].into_iter().find(|known| known.name(self.unit.standard) == kind);
        if !self.course.placed {
            for index in indices.clone().filter(|index| !self.is_time(*index)) {
                self.variable(index, kind)?;
            }
            self.place()?;
        }
        let mut values = std::mem::take(&mut self.values);
        values.clear();
        for index in indices {
            if wanted.is_none() || self.unit.interface.type_of(index) != wanted {
                if self.is_time(index) && wanted == Some(Type::Real) {
                    values.push(Value::Real(self.time()));
                    continue;
                }
                self.variable(index, kind)?;
            }
            let value = self.unit.interface.value_with(&self.simulation, &self.findings, index);
            if !value.number().is_finite() {
                let name = self.unit.interface.variables()[index].name.clone();
                return Err(Refusal::NoNumber { name, value: value.number() });
            }
            values.push(value);
        }
        self.values = values;
        Ok(&self.values)
    }

    /// Sets numbers: all or nothing.
    pub(crate) fn set<T: Copy + Into<f64>>(
        &mut self,
        indices: impl Iterator<Item = usize> + Clone,
        values: Items<T>,
        kind: &'static str,
    ) -> Result<(), Refusal> {
        let starting = matches!(self.course.phase, Phase::Instantiated | Phase::Initialization);
        let mut tuned = Vec::new();
        for (index, value) in indices.clone().zip(values.iter()) {
            let variable = self.variable(index, kind)?;
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
        for (index, value) in indices.zip(values.iter()) {
            let value = value.into();
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

    /// Texts of variables.
    pub(crate) fn texts(&self, indices: impl Iterator<Item = usize>) -> Result<Vec<&CStr>, Refusal> {
        let text = |index| self.variable(index, "String").map(|_| self.frames.text(index));
        indices.map(text).collect()
    }

    /// Whether all of these are texts that may be set now.
    pub(crate) fn check_texts(&self, indices: impl Iterator<Item = usize>) -> Result<(), Refusal> {
        let starting = matches!(self.course.phase, Phase::Instantiated | Phase::Initialization);
        for index in indices {
            let variable = self.variable(index, "String")?;
            if !starting {
                return Err(InterfaceError::Fixed { name: variable.name.clone() }.into());
            }
        }
        Ok(())
    }

    /// Sets texts, once they are checked: all or nothing.
    pub(crate) fn set_texts(&mut self, indices: impl Iterator<Item = usize>, values: Vec<CString>) {
        for (index, value) in indices.zip(values) {
            self.frames.set_text(index, value);
        }
    }

    /// What concerns a type that no variable has: every index is a wrong one.
    pub(crate) fn refuse_type(&self, indices: impl Iterator<Item = usize>, kind: &'static str) -> Result<(), Refusal> {
        for index in indices {
            self.variable(index, kind)?;
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
            let index = reference as usize;
            let variable = self.variable(index, "Real")?;
            match order {
                1 => self.unit.interface.check_rate(index, rate)?,
                2 => drop(self.unit.interface.check_acceleration(&self.unit.scene, index, rate)?),
                _ => {
                    let expected = "order 1, or order 2 of quadratic motion";
                    return Err(Refusal::Order { order, expected, name: variable.name.clone() });
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

    /// Change of each unknown, an output, per unit of a direction of inputs.
    pub(crate) fn directional_derivatives(
        &mut self,
        unknowns: impl Iterator<Item = usize>,
        knowns: impl Iterator<Item = usize>,
        direction: Items<f64>,
    ) -> Result<Vec<f64>, Refusal> {
        let real = Type::Real.name(self.unit.standard);
        let index = |index| self.variable(index, real).map(|_| index);
        let inputs = knowns.map(index).collect::<Result<Vec<usize>, Refusal>>()?;
        let outputs = unknowns.map(index).collect::<Result<Vec<usize>, Refusal>>()?;
        let direction: Vec<(usize, f64)> = inputs.into_iter().zip(direction.iter()).collect();
        let Self { unit, simulation, derivatives, .. } = self;
        Ok(unit.interface.derivatives(simulation, derivatives, (&outputs, &direction))?)
    }

    /// Derivatives of outputs in time, each of an order: of order 1.
    pub(crate) fn output_derivatives(
        &mut self,
        wanted: impl Iterator<Item = (usize, i32)>,
    ) -> Result<Vec<f64>, Refusal> {
        let real = Type::Real.name(self.unit.standard);
        let mut rates = Vec::new();
        for (index, order) in wanted {
            let variable = self.variable(index, real)?;
            if order != 1 {
                return Err(Refusal::Order { order, expected: "order 1", name: variable.name.clone() });
            }
            rates.push(self.unit.interface.rate(&self.simulation, index)?);
        }
        Ok(rates)
    }
}
