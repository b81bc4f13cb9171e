//! Which numbers of a scene's text are parameters of its unit.

mod rows;

use crate::base::document::Document;
use crate::base::quantity::Range;
use crate::laws::contact::PropertyUnit;
use crate::scene::{Parameter, SceneDraft, Step};
use rows::{ROWS, is_of};

/// The parameters of a scene that was read from this text.
pub(crate) fn of_scene(scene: &SceneDraft, document: &Document) -> Vec<Parameter> {
    let mut all = settings(scene);
    let mut leaves = Vec::new();
    for table in ["run", "material", "pair", "damping", "bond"] {
        find_numbers(document, table, &mut leaves);
    }
    for (name, value) in leaves {
        all.extend(row(&name, value).or_else(|| property(scene, &name)).or_else(|| strength(scene, &name, value)));
    }
    all.retain(|parameter| !is_written_twice(document, &parameter.name));
    all
}

/// Settings of the run that every scene has.
fn settings(scene: &SceneDraft) -> Vec<Parameter> {
    let (step, safety) = match scene.run.step {
        Step::Given(step) => (step, 0.0),
        Step::Automatic { safety } => (0.0, safety),
        Step::Following => (0.0, 0.0),
    };
    let threads = scene.run.threads.unwrap_or(0) as f64;
    let number = |name: &str, value, unit, range, about: &str| {
        let (name, about) = (name.to_owned(), about.to_owned());
        Parameter { name, value, unit, range, tunable: false, about }
    };
    vec![
        number(TIME_STEP, step, Some("s"), Range::NON_NEGATIVE, "time step; 0: automatic"),
        number(
            SAFETY,
            safety,
            Some("1"),
            Range::PART_OR_NONE,
            "fraction of the stable step that an automatic time step takes; 0: as long as run.accuracy allows",
        ),
        number(
            "run.accuracy",
            scene.run.accuracy.error(),
            Some("1"),
            Range::PART,
            "largest error of the coefficient of restitution that an automatic time step allows",
        ),
        number(THREADS, threads, None, Range::COUNT, "threads; 0: as many as the machine offers"),
        number(
            CENTRAL_DERIVATIVES,
            f64::from(u8::from(scene.run.central_derivatives)),
            None,
            Range::SWITCH,
            "whether directional derivatives are differences of both sides: two steps in place of one; 0: no, 1: yes",
        ),
        number(
            "run.derivative_displacement",
            scene.run.derivative_displacement,
            Some("1"),
            Range::POSITIVE,
            "how far directional derivatives displace inputs, over what the program chooses",
        ),
    ]
}

/// The time step, 0 where it is automatic.
pub(crate) const TIME_STEP: &str = "run.time_step";
/// The fraction of the stable step, 0 where the time step follows the accuracy.
pub(crate) const SAFETY: &str = "run.safety";
/// The number of threads, 0 where the machine decides.
pub(crate) const THREADS: &str = "run.threads";
/// Whether derivatives are differences of both sides, 0 or 1.
pub(crate) const CENTRAL_DERIVATIVES: &str = "run.central_derivatives";

/// All numbers at or below a key, with their dotted keys, in the order of the text.
fn find_numbers(document: &Document, path: &str, found: &mut Vec<(String, f64)>) {
    if document.is_table(path) {
        for name in document.names(path) {
            find_numbers(document, &format!("{path}.{name}"), found);
        }
    } else if let Ok(value) = document.written(path).replace('_', "").parse() {
        found.push((path.to_owned(), value));
    }
}

/// Whether the properties of a pair of materials stand in the text in both orders: neither can be changed alone.
fn is_written_twice(document: &Document, name: &str) -> bool {
    match name.split('.').collect::<Vec<_>>()[..] {
        ["pair", a, b, _] => a != b && document.has(&format!("pair.{b}.{a}")),
        _ => false,
    }
}

/// The parameter of this name, if it is one of the rows.
fn row(name: &str, value: f64) -> Option<Parameter> {
    let row = ROWS.iter().find(|row| is_of(name, row.keys))?;
    let (name, about) = (name.to_owned(), row.about.to_owned());
    Some(Parameter { name, value, unit: Some(row.unit), range: row.range, tunable: false, about })
}

/// The parameter of this name, if it is a property of a material or of two that laws declare.
fn property(scene: &SceneDraft, name: &str) -> Option<Parameter> {
    let (table, key) = name.rsplit_once('.')?;
    let entry = scene.pair_of(name).map(|[a, b]| a.index() * scene.materials.len() + b.index());
    let (property, value) = match entry {
        Some(entry) => scene.pairs[entry].named(key)?,
        None => {
            let name = table.strip_prefix("material.")?;
            scene.materials.iter().find(|material| material.name == name)?.properties.named(key)?
        }
    };
    let unit = match property.unit {
        PropertyUnit::Always(unit) => unit,
        PropertyUnit::ByLaw(unit) => unit(&scene.contacts.iter().find(|law| law.between[entry.unwrap_or(0)])?.choice),
    };
    let (name, about) = (name.to_owned(), property.about.to_owned());
    let tunable = property.tunable && entry.is_some();
    Some(Parameter { name, value, unit: Some(unit), range: property.range, tunable, about })
}

/// The parameter of this name, if it is a strength of a bond law.
fn strength(scene: &SceneDraft, name: &str, value: f64) -> Option<Parameter> {
    let (bond, key) = scene.strength_of(name)?;
    let strengths = scene.bonds[bond].keys.breakage.iter().flat_map(|rule| rule.strengths());
    let (_, unit) = strengths.into_iter().find(|(name, _)| name == key)?;
    let about = format!("strength of bonds: {}", key.replace(['.', '_'], " "));
    Some(Parameter { name: name.to_owned(), value, unit: Some(unit), range: Range::POSITIVE, tunable: true, about })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_out_of_range_is_refused_in_the_words_of_the_scene() {
        let refused = |range: &Range, value: f64| range.check(value).unwrap_err();
        assert_eq!(refused(&Range::NON_NEGATIVE, -0.1), "expected a number of 0 or above, found -0.1");
        assert_eq!(refused(&Range::PART, 1.0), "expected a number above 0 and below 1, found 1.0");
        assert_eq!(refused(&Range::PART_OR_NONE, 1.0), "expected a number from 0 to below 1, found 1.0");
        for row in ROWS {
            let Range { minimum, maximum, .. } = row.range;
            for bound in minimum.into_iter().chain(maximum) {
                assert_eq!(row.range.check(bound), Ok(()), "{}", row.keys);
            }
        }
    }
}
