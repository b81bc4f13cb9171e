//! What a case says by leaving it out, and how it writes flags.

use serde::{Deserialize, Deserializer, de::Error};

/// The default of `sample_every`.
pub(super) fn one() -> u64 {
    1
}

/// The default of sub-models.
pub(super) fn off() -> String {
    "off".into()
}

/// The default of `mixing`.
pub(super) fn none() -> String {
    "none".into()
}

/// The default of `arms`.
pub(super) fn overlap() -> String {
    "overlap".into()
}

/// The default of `tangential_damping`.
pub(super) fn on() -> bool {
    true
}

/// The default kind of wall.
pub(super) fn plane() -> String {
    "plane".into()
}

/// The default kind of damping.
pub(super) fn cundall() -> String {
    "cundall".into()
}

/// A flag: true or false, or `"on"`, `"off"` and `"stokes"` as input files have them.
pub(super) fn switch<'de, D: Deserializer<'de>>(deserializer: D) -> Result<bool, D::Error> {
    match serde_json::Value::deserialize(deserializer)? {
        serde_json::Value::Bool(value) => Ok(value),
        serde_json::Value::String(word) if word == "on" || word == "stokes" => Ok(true),
        serde_json::Value::String(word) if word == "off" => Ok(false),
        other => Err(D::Error::custom(format!("expected true, false, \"on\" or \"off\", found {other}"))),
    }
}
