//! Which numbers of a scene's text are parameters of its unit: those of some tables, with unit and range of their keys.

use super::tables::{DampingTable, FluidTable, MaterialTable, RunTable};
use crate::base::document::{Document, Key, Table};
use crate::base::quantity::{NonNegative, Positive, Range};
use crate::laws::bond::breakage::{mohr_coulomb, stress};
use crate::laws::bond::damping::{Model, componentwise, opposing};
use crate::laws::bond::keys::{self as bond, PartKeys};
use crate::laws::contact::PropertyUnit;
use crate::scene::{Parameter, SceneDraft, Step};

/// Tables whose numbers are parameters, in their order, and their keys; `*` stands for a name. What is found here is fixed once the unit is
/// initialised; laws declare the properties of a pair, rules of breakage the strengths.
const TABLES: [(&str, &[Key]); 8] = [
    ("run", RunTable::KEYS),
    ("material.*", MaterialTable::KEYS),
    ("pair.*.*", &[]),
    ("damping.*", DampingTable::KEYS),
    ("bond.*", bond::Keys::KEYS),
    ("bond.*.breakage", stress::Keys::KEYS),
    ("bond.*.breakage.mohr_coulomb", mohr_coulomb::Keys::KEYS),
    ("fluid.*", FluidTable::KEYS),
];

/// Of `[run]` these; [`settings`] has others, and the rest is of no use in a unit.
const OF_RUN: [&str; 2] = ["skin", "max_overlap"];

/// Tables with a number for each part of a bond, which are such parameters, too: range, unit, what the numbers are.
const PARTS: [(&str, Range, &str, &str); 5] = [
    (
        "bond.*.damping.viscous",
        PartKeys::<NonNegative>::RANGE,
        "1",
        "damping of a part of the bond over its critical damping",
    ),
    ("bond.*.damping.opposing", <opposing::Opposing as Model>::Keys::RANGE, "1", SHARE),
    ("bond.*.damping.sign", <componentwise::Sign as Model>::Keys::RANGE, "1", SHARE),
    ("bond.*.damping.smooth", <componentwise::Smooth as Model>::Keys::RANGE, "1", SHARE),
    ("bond.*.relaxation", PartKeys::<Positive>::RANGE, "s", "relaxation time of a part of the bond"),
];

/// What the numbers are in a damping that takes a share.
const SHARE: &str = "damping of a part of the bond as a share of its load";

/// The parameters of a scene that was read from this text.
pub(crate) fn of_scene(scene: &SceneDraft, document: &Document) -> Vec<Parameter> {
    let mut all = settings(scene);
    let mut leaves = Vec::new();
    let mut tables = TABLES.map(|(pattern, _)| pattern.split('.').next().unwrap_or_default()).to_vec();
    tables.dedup();
    for table in tables {
        find_numbers(document, table, &mut leaves);
    }
    for (name, value) in leaves {
        all.extend(property(scene, &name).or_else(|| strength(scene, &name, value)).or_else(|| fixed(&name, value)));
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
    let number = |name: &str, value, unit: Option<&str>, range, about: &str| {
        let (name, about, unit) = (name.to_owned(), about.to_owned(), unit.map(str::to_owned));
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

/// The parameter of this name, if it is a number of one of the tables.
fn fixed(name: &str, value: f64) -> Option<Parameter> {
    let (table, last) = name.rsplit_once('.')?;
    let (about, unit, range) = if let Some((_, range, unit, about)) = PARTS.iter().find(|part| is_of(table, part.0)) {
        ((*about).to_owned(), (*unit).to_owned(), *range)
    } else {
        let (_, keys) = TABLES.iter().find(|(pattern, _)| is_of(table, pattern))?;
        let key = keys.iter().find(|key| key.name == last && (table != "run" || OF_RUN.contains(&last)))?;
        let (about, unit) = key.meaning();
        (in_a_phrase(&about), unit, key.range()?)
    };
    Some(Parameter { name: name.to_owned(), value, unit: Some(unit), range, tunable: false, about })
}

/// A sentence as a phrase: without its capital, unless that is a symbol's or of a name (Young's).
fn in_a_phrase(sentence: &str) -> String {
    let word = sentence.split(' ').next().unwrap_or_default();
    let (first, rest) = sentence.split_at(sentence.chars().next().map_or(0, char::len_utf8));
    if word.chars().count() < 2 || word.contains('\'') { sentence.to_owned() } else { first.to_lowercase() + rest }
}

/// Whether a name is one of those that a pattern stands for.
fn is_of(name: &str, pattern: &str) -> bool {
    let mut pattern = pattern.split('.');
    name.split('.').all(|part| pattern.next().is_some_and(|key| key == "*" || key == part)) && pattern.next().is_none()
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
    Some(Parameter { name, value, unit: Some(unit.to_owned()), range: property.range, tunable, about })
}

/// The parameter of this name, if it is a strength of a bond law.
fn strength(scene: &SceneDraft, name: &str, value: f64) -> Option<Parameter> {
    let (bond, key) = scene.strength_of(name)?;
    let strengths = scene.bonds[bond].keys.breakage.iter().flat_map(|rule| rule.strengths());
    let (_, unit) = strengths.into_iter().find(|(name, _)| name == key)?;
    let about = format!("strength of bonds: {}", key.replace(['.', '_'], " "));
    Some(Parameter {
        name: name.to_owned(),
        value,
        unit: Some(unit.to_owned()),
        range: Range::POSITIVE,
        tunable: true,
        about,
    })
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
        let of_keys = TABLES.iter().flat_map(|(_, keys)| keys.iter().filter_map(Key::range));
        for range in of_keys.chain(PARTS.iter().map(|part| part.1)) {
            for bound in range.minimum.into_iter().chain(range.maximum) {
                assert_eq!(range.check(bound), Ok(()));
            }
        }
    }

    #[test]
    fn a_parameter_has_the_unit_and_the_range_of_its_key() {
        let of = |name: &str| {
            let found = fixed(name, 1.0)?;
            Some((found.unit?, found.range.minimum, found.range.maximum))
        };
        let least = Some(f64::MIN_POSITIVE);
        for (name, unit, minimum, maximum) in [
            ("run.skin", "m", least, None),
            ("material.glass.density", "kg/m3", least, None),
            ("material.glass.poissons_ratio", "1", Some(0.0), Some(0.5)),
            ("material.glass.conductivity", "W/(m.K)", least, None),
            ("fluid.water.viscosity", "Pa.s", least, None),
            ("fluid.water.porosity", "1", least, Some(1.0)),
            ("bond.glue.tangential_stiffness", "Pa/m", Some(0.0), None),
            ("bond.glue.breakage.friction_angle", "rad", Some(0.0), None),
            ("bond.glue.damping.viscous.normal_force", "1", Some(0.0), None),
            ("bond.glue.damping.sign.normal_force", "1", Some(0.0), Some(1.0)),
            ("bond.glue.relaxation.normal_torque", "s", least, None),
        ] {
            assert_eq!(of(name), Some((unit.to_owned(), minimum, maximum)), "{name}");
        }
        for name in ["run.end", "material.density", "fluid.water.velocity", "bond.glue.relaxation", "gravity"] {
            assert_eq!(of(name), None, "{name}");
        }
    }
    #[test]
    fn the_numbers_of_a_fluid_are_parameters_of_its_scene() {
        let text = "[fluid.water]\ndensity = 1000.0\nviscosity = 1.0e-3\n[fluid.water.drag.stokes]\n";
        let scene: crate::scene::Scene = text.parse().unwrap();
        for (name, value) in [("fluid.water.density", 1000.0), ("fluid.water.viscosity", 1e-3)] {
            let found = scene.parameters.iter().find(|parameter| parameter.name == name);
            assert_eq!(found.map(|parameter| parameter.value), Some(value), "{name}");
        }
    }
}
