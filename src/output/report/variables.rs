//! What `cograin variables` tells: inputs, outputs and parameters of a scene, as its unit and its tables have them.

use crate::interface::{Causality, Interface, Standard, Type, Variability, Variable};
use crate::output::results::Refusal;
use crate::scene::Scene;
use serde::Serialize;
use std::fmt;

/// The variables of a scene. Displays as a table for a person.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Variables {
    /// All of them, in the order of their references.
    rows: Vec<Row>,
}

/// One variable.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Row {
    /// Its value reference in the unit.
    reference: usize,
    /// Its name.
    name: String,
    /// `input`, `output` or `parameter`.
    causality: &'static str,
    /// `constant`, `fixed`, `tunable`, `discrete` or `continuous`.
    variability: &'static str,
    /// `Real`, `Integer` or `String`.
    #[serde(rename = "type")]
    kind: &'static str,
    /// Its unit, if it has one.
    unit: Option<&'static str>,
    /// Its value before anything is set, of inputs and parameters.
    start: Option<f64>,
    /// Its lower bound.
    minimum: Option<f64>,
    /// Its upper bound.
    maximum: Option<f64>,
    /// What it is, with its sign.
    meaning: String,
}

/// The inputs, outputs and parameters of a scene.
///
/// # Errors
/// A name in the scene that stands for no variable of it.
pub fn variables(scene: &Scene, scene_name: &str) -> Result<Variables, Refusal> {
    let interface = Interface::of(scene);
    let chosen = interface.check_names(scene);
    chosen.map_err(|source| Refusal::Chosen { scene: scene_name.to_owned(), source: Box::new(source) })?;
    Ok(Variables { rows: interface.variables().iter().enumerate().map(Row::of).collect() })
}

impl Row {
    /// The variable with this reference.
    fn of((reference, variable): (usize, &Variable)) -> Self {
        Self {
            reference,
            name: variable.name.clone(),
            causality: match variable.causality {
                Causality::Input => "input",
                Causality::Output => "output",
                Causality::Parameter => "parameter",
            },
            variability: match variable.variability {
                Variability::Constant => "constant",
                Variability::Fixed => "fixed",
                Variability::Tunable => "tunable",
                Variability::Discrete => "discrete",
                Variability::Continuous => "continuous",
            },
            kind: variable.quantity.of_type().name(Standard::Fmi2),
            unit: variable.quantity.unit(),
            start: variable.start,
            minimum: variable.minimum,
            maximum: variable.maximum,
            meaning: variable.description.clone(),
        }
    }

    /// Unit, or what it is without one; `1` of a pure number.
    fn unit(&self) -> &'static str {
        self.unit.unwrap_or(if self.kind == Type::Real.name(Standard::Fmi2) { "1" } else { self.kind })
    }
}

impl Variables {
    /// The list as JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: writing them to memory has no way to fail.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

impl fmt::Display for Variables {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widest = |of: &dyn Fn(&Row) -> usize| self.rows.iter().map(of).max().unwrap_or(0);
        let (name, unit) = (widest(&|row| row.name.len()), widest(&|row| row.unit().len()));
        let mut first = true;
        for (causality, heading) in [("input", "inputs"), ("output", "outputs"), ("parameter", "parameters")] {
            let rows: Vec<&Row> = self.rows.iter().filter(|row| row.causality == causality).collect();
            write!(formatter, "{}{heading}: {}", if first { "" } else { "\n" }, rows.len())?;
            first = false;
            for row in rows {
                write!(
                    formatter,
                    "\n  {:>5}  {:name$}  {:unit$}  {}",
                    row.reference,
                    row.name,
                    row.unit(),
                    row.meaning
                )?;
                if let Some(start) = row.start.filter(|_| causality != "output") {
                    write!(formatter, "; starts with {start:?}")?;
                }
                if row.variability == "tunable" && causality == "parameter" {
                    write!(formatter, "; tunable")?;
                }
            }
        }
        Ok(())
    }
}
