//! How outputs change with inputs.

use super::{Causality, Interface, Type, Variability};

impl Interface {
    /// Whether a variable is an output that changes continuously with the inputs: one that has derivatives by them.
    pub fn is_continuous_output(&self, index: usize) -> bool {
        let continuous = |it: &super::Variable| {
            it.causality == Causality::Output
                && it.variability == Variability::Continuous
                && it.quantity.of_type() == Type::Real
        };
        self.variables.get(index).is_some_and(continuous)
    }
}
