//! What speaks against the keys of a bond table.

/// What is wrong with the keys of one bond table among themselves.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key}: {message}")]
pub struct KeyError {
    /// The key, as `breakage.tension_ratio`.
    pub key: &'static str,
    /// What was found and what was expected.
    pub message: String,
}

impl KeyError {
    /// Adds one where it is there.
    pub(super) fn add(wrong: &mut Vec<Self>, there: bool, key: &'static str, message: &str) {
        if there {
            wrong.push(Self { key, message: message.to_owned() });
        }
    }
}
