//! Outputs that a scene names: columns of `history.csv`, and sums of outputs.

use super::{Causality, Interface, Quantity, Source, Variability, Variable};
use crate::base::document::proposal;
use crate::scene::Scene;

/// Columns that a run writes of a scene which chooses none; where there are more, those of groups of particles are left out.
pub const MOST_COLUMNS: usize = 1000;

/// Names in a scene that stand for no output, or for several that have no sum.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChosenError {
    /// A name that is that of no output.
    #[error("{place}: expected an output of this scene, found {found:?}; {}", proposal(found, known, "there are"))]
    Unknown {
        /// Table and key.
        place: String,
        /// The name.
        found: String,
        /// Those that there are.
        known: Vec<String>,
    },
    /// A sum of different things.
    #[error("{place}: expected outputs of one unit, found {} and {}", in_unit(first), in_unit(other))]
    Units {
        /// Table and key.
        place: String,
        /// Name and unit of the first output.
        first: (String, &'static str),
        /// Name and unit of another one.
        other: (String, &'static str),
    },
}

/// `name [unit]`
fn in_unit((name, unit): &(String, &str)) -> String {
    format!("{name} [{unit}]")
}

/// Whether a name is one of those that a pattern stands for: `*` is any characters.
fn stands_for(pattern: &str, name: &str) -> bool {
    let Some((begins, mut rest)) = pattern.split_once('*') else { return pattern == name };
    let Some(mut left) = name.strip_prefix(begins) else { return false };
    while let Some((part, more)) = rest.split_once('*') {
        let Some(place) = left.find(part) else { return false };
        (left, rest) = (&left[place + part.len()..], more);
    }
    left.ends_with(rest)
}

/// What a run may record.
const RECORDED: [Causality; 2] = [Causality::Output, Causality::Input];

/// What may be summed.
const SUMMED: [Causality; 1] = [Causality::Output];

/// Indices of the variables of these kinds that names stand for, in the order of the names, each once.
fn meant(variables: &[Variable], kinds: &[Causality], names: &[String]) -> Vec<usize> {
    let mut taken = vec![false; variables.len()];
    let mut chosen = Vec::new();
    for name in names {
        for (index, variable) in variables.iter().enumerate() {
            let is_meant = kinds.contains(&variable.causality) && stands_for(name, &variable.name);
            if is_meant && !std::mem::replace(&mut taken[index], true) {
                chosen.push(index);
            }
        }
    }
    chosen
}

/// The sums that a scene asks for, of these variables.
pub(super) fn derived(scene: &Scene, variables: &[Variable]) -> Vec<Variable> {
    let derived = scene.derived.iter().map(|derived| {
        let terms = meant(variables, &SUMMED, &derived.sum);
        let quantity = terms.first().map_or(Quantity::Ratio, |&first| variables[first].quantity);
        let names: Vec<&str> = terms.iter().take(3).map(|&term| variables[term].name.as_str()).collect();
        let more = if terms.len() > names.len() { ", .." } else { "" };
        Variable {
            name: derived.name.clone(),
            description: format!("sum of {} outputs: {}{more}", terms.len(), names.join(", ")),
            quantity,
            causality: Causality::Output,
            variability: if quantity == Quantity::Count { Variability::Discrete } else { Variability::Continuous },
            start: None,
            minimum: None,
            maximum: None,
            follows_inputs_at_start: terms.iter().any(|&term| variables[term].follows_inputs_at_start),
            source: Source::Derived(terms),
        }
    });
    derived.collect()
}

/// Indices of what a run records: the outputs and inputs that the scene names, or all outputs but those of single nodes and cells of grids and, where there are
/// very many, of groups of particles.
pub(super) fn recorded(scene: &Scene, variables: &[Variable]) -> Vec<usize> {
    if let Some(columns) = &scene.output.columns {
        return meant(variables, &RECORDED, columns);
    }
    let all = |with_groups: bool| {
        let is_recorded = |variable: &Variable| {
            let of_group = |boundary: usize| !scene.boundaries[boundary].shape.members().is_empty();
            let counts = with_groups || !variable.boundary().is_some_and(of_group);
            variable.causality == Causality::Output && variable.element().is_none() && counts
        };
        (0..variables.len()).filter(|&index| is_recorded(&variables[index])).collect::<Vec<_>>()
    };
    Some(all(true)).filter(|all| all.len() <= MOST_COLUMNS).unwrap_or_else(|| all(false))
}

impl Interface {
    /// Refuses names in the scene that stand for no output.
    pub fn check_names(&self, scene: &Scene) -> Result<(), ChosenError> {
        let all = self.variables();
        let simple: Vec<Variable> =
            all.iter().filter(|variable| !matches!(variable.source, Source::Derived(_))).cloned().collect();
        for derived in &scene.derived {
            let place = format!("[derived.{}] sum", derived.name);
            known(&place, &derived.sum, (&simple, &SUMMED))?;
            let unit = |index: usize| (simple[index].name.clone(), simple[index].quantity.unit().unwrap_or("count"));
            let terms = meant(&simple, &SUMMED, &derived.sum);
            let (first, others) = terms.split_first().map_or((None, &[][..]), |(first, others)| (Some(*first), others));
            let Some(first) = first else { continue };
            let differs = |term: &&usize| simple[**term].quantity.unit() != simple[first].quantity.unit();
            if let Some(&other) = others.iter().find(differs) {
                return Err(ChosenError::Units { place, first: unit(first), other: unit(other) });
            }
        }
        known("[output] columns", scene.output.columns.as_deref().unwrap_or_default(), (all, &RECORDED))
    }
}

/// Refuses names that stand for none of these variables of these kinds.
fn known(place: &str, names: &[String], (variables, kinds): (&[Variable], &[Causality])) -> Result<(), ChosenError> {
    let able = || variables.iter().filter(|variable| kinds.contains(&variable.causality));
    match names.iter().find(|name| !able().any(|variable| stands_for(name, &variable.name))) {
        None => Ok(()),
        Some(found) => {
            let known = able().map(|variable| variable.name.clone()).collect();
            Err(ChosenError::Unknown { place: place.to_owned(), found: found.clone(), known })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_any_characters() {
        for (pattern, name, meant) in [
            ("floor.force.z", "floor.force.z", true),
            ("floor.force.z", "floor.force.zz", false),
            ("floor.*", "floor.force.z", true),
            ("*.z", "floor.force.z", true),
            ("*.force.*", "floor.force.z", true),
            ("*.force.*", "floor.mean_force.z", false),
            ("f*r.f*z", "floor.force.z", true),
            ("*", "", true),
            ("ab*bc", "abc", false),
            ("**", "x", true),
        ] {
            assert_eq!(stands_for(pattern, name), meant, "{pattern} {name}");
        }
    }
}
