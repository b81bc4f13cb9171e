//! What a scene says of itself.

use crate::base::document::keys;
use serde::de::Error;
use serde::{Deserialize, Deserializer};

keys! {
    /// `[about]`: what the unit tells of its model; nothing of it is computed with.
    #[derive(Clone, Debug, Default, PartialEq, Eq)]
    #[serde(default)]
    pub struct About {
        /// One line of text: what it is.
        #[serde(deserialize_with = "line")]
        pub description: Option<String> = "none",
        /// Who made it.
        #[serde(deserialize_with = "line")]
        pub author: Option<String> = "none",
        /// Its version.
        #[serde(deserialize_with = "line")]
        pub version: Option<String> = "none",
        /// Under which licence.
        #[serde(deserialize_with = "line")]
        pub license: Option<String> = "none",
        /// Whose it is.
        #[serde(deserialize_with = "line")]
        pub copyright: Option<String> = "none",
    }
}

/// One line of text, where one is given. The unit's description, an XML file, can hold no control characters.
fn line<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<String>, D::Error> {
    let text = String::deserialize(deserializer)?;
    match text.chars().find(|letter| letter.is_control() || matches!(letter, '\u{FFFE}' | '\u{FFFF}')) {
        Some(letter) => Err(D::Error::custom(format!("expected one line of text, found the character {letter:?}"))),
        None => Ok(Some(text)),
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    #[test]
    fn texts_are_lines_without_control_characters() {
        let read = |text: &str| format!("[about]\nauthor = \"{text}\"\n").parse::<Scene>();
        let scene = read("Ada \\u00e9 <&>").unwrap();
        assert_eq!(scene.about.author.as_deref(), Some("Ada é <&>"));
        for text in ["two\\nlines", "a\\u0001", "\\uffff"] {
            let message = read(text).unwrap_err().to_string();
            assert!(
                message.contains("line 2, [about] author: expected one line of text, found the character"),
                "{message}"
            );
        }
    }
}
