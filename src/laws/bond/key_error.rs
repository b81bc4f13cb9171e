//! What speaks against the keys of a bond table.

use std::borrow::Cow;

/// What is wrong with the keys of one bond table among themselves.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key}: {message}")]
pub struct KeyError {
    /// The key, as `breakage.tension_ratio`.
    pub key: Cow<'static, str>,
    /// What was found and what was expected.
    pub message: String,
}

impl KeyError {
    /// One at a key.
    pub fn at(key: impl Into<Cow<'static, str>>, message: &str) -> Self {
        Self { key: key.into(), message: message.to_owned() }
    }

    /// Adds one where it is there.
    pub fn add(wrong: &mut Vec<Self>, there: bool, key: &'static str, message: &str) {
        if there {
            wrong.push(Self::at(key, message));
        }
    }
}
