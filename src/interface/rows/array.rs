//! Variables of a row that are gathered to an array.

use super::Source;
use crate::scene::Scene;

/// What an array is.
pub(in crate::interface) struct ArrayForm {
    /// Its name.
    pub(in crate::interface) name: String,
    /// What it is, with its sign.
    pub(in crate::interface) description: String,
    /// Its dimensions, row-major.
    pub(in crate::interface) dimensions: Vec<usize>,
}

/// Components of a tensor of second order.
const OF_TENSOR: usize = 36;

/// Components that a description names one by one.
const MOST_NAMED: usize = 6;

impl Source {
    /// Whether another variable is of the same row and the same thing, and so may be of one array with this.
    pub(in crate::interface) fn is_of_one_array_with(&self, other: &Self) -> bool {
        let place = |source: &Self| (source.at.boundary, source.at.place());
        std::ptr::eq(self.row, other.row) && place(self) == place(other)
    }

    /// The array of so many variables from this one on, the first of which has this name; none where components are missing or there is
    /// nothing to gather.
    pub(in crate::interface) fn array_of(&self, scene: &Scene, first: &str, count: usize) -> Option<ArrayForm> {
        let components = self.row.each.names(scene);
        let numbered = self.row.each.element().is_some();
        let is_whole = count > 0 && count.is_multiple_of(components.len()) && (numbered || components.len() > 1);
        if !is_whole {
            return None;
        }
        let stem = first.replacen("[1]", "", 1);
        let own = format!(".{}", components[0]);
        let name = if components.len() > 1 { stem.strip_suffix(&own).unwrap_or(&stem).to_owned() } else { stem };
        let named = match components[..] {
            [one, two, .., last] if components.len() > MOST_NAMED => format!("{one}, {two}, .., {last}"),
            _ => components.join(", "),
        };
        let inner = match components.len() {
            1 => vec![],
            OF_TENSOR => vec![6, 6],
            length => vec![length],
        };
        let elements = numbered.then_some(count / components.len());
        let dimensions = elements.into_iter().chain(inner).collect();
        Some(ArrayForm { name, description: self.description(scene, &named, "n"), dimensions })
    }
}
