//! The variables of FMI 3.0: components of one quantity of one thing, and of all its nodes, are one array.

use super::{Interface, Source, Variable, rows};
use crate::scene::Scene;

/// A variable of FMI 3.0: one of the table, or several that stand side by side in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Array {
    /// Its name: that of its elements, without what tells them apart.
    pub name: String,
    /// What it is, with its sign.
    pub description: String,
    /// Index of its first element in the table.
    pub first: usize,
    /// Its dimensions, row-major; none for a single value.
    pub dimensions: Vec<usize>,
}

impl Array {
    /// Number of its elements.
    pub fn count(&self) -> usize {
        self.dimensions.iter().product()
    }
}

impl Interface {
    /// All variables of the table in its order. Components are gathered where all of them are there; the others stay single.
    pub fn arrays(&self, scene: &Scene) -> Vec<Array> {
        let mut arrays: Vec<Array> = Vec::new();
        let mut first = 0;
        while let Some(rest) = self.variables.get(first..).filter(|rest| !rest.is_empty()) {
            let array = gathered(scene, rest, first);
            first += array.count();
            arrays.push(array);
        }
        arrays
    }
}

/// The array that begins these variables, the first of which has this index.
fn gathered(scene: &Scene, variables: &[Variable], first: usize) -> Array {
    let row = |variable: &Variable| match &variable.source {
        Source::Row(source) => Some(*source),
        Source::Parameter(_) | Source::Text(_) | Source::Derived(_) => None,
    };
    let whole = row(&variables[0]).and_then(|source| {
        let alike = |variable: &&Variable| row(variable).is_some_and(|other| other.is_of_one_array_with(&source));
        source.array_of(scene, &variables[0].name, variables.iter().take_while(alike).count())
    });
    let single = |variable: &Variable| rows::ArrayForm {
        name: variable.name.clone(),
        description: variable.description.clone(),
        dimensions: Vec::new(),
    };
    let rows::ArrayForm { name, description, dimensions } = whole.unwrap_or_else(|| single(&variables[0]));
    Array { name, description, first, dimensions }
}
