//! What a scene says of itself.

use serde::Deserialize;

/// `[about]`: what the unit tells of its model; nothing of it is computed with.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct About {
    /// One sentence: what it is.
    pub description: Option<String>,
    /// Who made it.
    pub author: Option<String>,
    /// Its version.
    pub version: Option<String>,
    /// Under which licence.
    pub license: Option<String>,
    /// Whose it is.
    pub copyright: Option<String>,
}
