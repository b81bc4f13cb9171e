//! From what the readers of TOML and of single values say to messages in the scene's own words.

use super::mistake::Mistake;
use super::single::Error;

/// What people look for under these names and this program does not have.
const ABSENT: [(&[&str], &str, &str); 5] = [
    (&["coarse_graining", "coarsegraining", "coarse_grain"], "coarse graining factors", "real radii"),
    (
        &["shape", "multisphere", "superquadric", "polyhedron", "ellipsoid", "aspect_ratio"],
        "non-spherical bodies but clumps",
        "spheres or [clump.<name>]",
    ),
    (
        &["emissivity", "radiation"],
        "radiation between bodies",
        "a [heat_source.<name>] with an ambient temperature and conductance",
    ),
    (
        &[
            "gap",
            "gap_conduction",
            "gas_conductivity",
            "fluid_conductivity",
            "surround_layer",
            "minimum_conduction_distance",
        ],
        "conduction through the fluid in gaps",
        "the heat sub-models of a contact law, which act where bodies touch",
    ),
    (
        &["thermal_expansion", "thermal_expansion_coefficient", "expansion_coefficient"],
        "thermal expansion",
        "radii that stay",
    ),
];

/// The refusal of something that this program does not have.
pub(crate) fn absent(key: &str) -> Option<Mistake> {
    let (_, what, instead) = ABSENT.iter().find(|(keys, ..)| keys.contains(&key))?;
    Some(Mistake::Unsupported { what, instead })
}

/// The field that serde misses.
pub(crate) fn missing_field(error: &Error) -> Option<&str> {
    error.message().strip_prefix("missing field `")?.strip_suffix('`')
}

/// The field that serde does not know.
pub(crate) fn unknown_field(error: &Error) -> Option<&str> {
    error.message().strip_prefix("unknown field `")?.split('`').next()
}

/// The mistake that an error of serde means; `key` is where it stands.
pub(crate) fn mistake(error: &Error, key: &str) -> Mistake {
    let message = error.message();
    let mut quoted = message.split('`').skip(1).step_by(2).map(str::to_owned);
    if missing_field(error).is_some() {
        return Mistake::Missing { expected: "this table needs it".to_owned() };
    }
    if message.starts_with("unknown field") {
        let found = quoted.next().unwrap_or_else(|| key.to_owned());
        return absent(&found).unwrap_or_else(|| Mistake::UnknownKey { found, known: quoted.collect() });
    }
    if message.starts_with("unknown variant") {
        let found = quoted.next().unwrap_or_default();
        return absent(&found).unwrap_or_else(|| Mistake::Choice { found, known: quoted.collect() });
    }
    if message.ends_with("number overflowed") {
        let found = "a number that 64 bits do not hold".to_owned();
        let expected =
            "a whole number up to 9223372036854775807, or one with a decimal point up to 1.79e308".to_owned();
        return Mistake::Unexpected { found, expected };
    }
    if let Some(number) = message.strip_prefix("wanted exactly 1 element, ") {
        let found = if number.starts_with("more") { "several" } else { "none" }.to_owned();
        return Mistake::Unexpected { found, expected: "one table, named as the model".to_owned() };
    }
    if message.starts_with("expected ") {
        return Mistake::Refused { message: message.to_owned() };
    }
    if let Some((found, expected)) = message.split_once(", expected ") {
        return Mistake::Unexpected { found: found_in(found), expected: expected_in(expected) };
    }
    Mistake::Refused { message: message.to_owned() }
}

/// What was found, from serde's "invalid type: integer `1`".
fn found_in(message: &str) -> String {
    let found = message.split_once(": ").map_or(message, |(_, found)| found);
    let quoted = found.split_once('`').and_then(|(_, rest)| rest.split_once('`')).map(|(value, _)| value);
    match (found, quoted) {
        (_, Some(value)) => value.to_owned(),
        ("map", _) => "a table".to_owned(),
        ("sequence", _) => "a list".to_owned(),
        (text, _) => text.strip_prefix("string ").unwrap_or(text).to_owned(),
    }
}

/// What was expected, from the type that serde expected.
fn expected_in(message: &str) -> String {
    let words = match message {
        "f64" => "a number",
        "a string" | "string" => "a text in quotes",
        "a sequence" => "a list",
        "a boolean" => "true or false",
        "a map" => "a table",
        "u32" => "a whole number from 0 to 4294967295",
        "u64" | "usize" => "a whole number from 0 to 18446744073709551615",
        "a nonzero u32" => "a whole number from 1 to 4294967295",
        text if text.starts_with("struct ") => "a table",
        text => text,
    };
    words.to_owned()
}
