//! A scene as text, with every file it names.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

/// Everything that is needed to read a scene again, elsewhere: its text and the files that it names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// The scene's file name, for messages.
    pub name: String,
    /// The scene's text.
    pub text: String,
    /// Bytes of each file, by the name that the scene has for it.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Source {
    /// Fingerprint of text, files and the program's version, to which saved states belong. Never 0.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Xxh3::new();
        let mut part = |bytes: &[u8]| {
            hash.update(&(bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        };
        part(env!("CARGO_PKG_VERSION").as_bytes());
        part(self.text.as_bytes());
        for (name, bytes) in &self.files {
            part(name.as_bytes());
            part(bytes);
        }
        hash.digest().max(1)
    }

    /// What it consists of, each part with a fingerprint of its own: so that a message can say which differs.
    pub(crate) fn parts(&self) -> Vec<(String, u64)> {
        let text = ("its text or settings".to_owned(), xxh3_64(self.text.as_bytes()));
        let files = self.files.iter().map(|(name, bytes)| (format!("the file {name}"), xxh3_64(bytes)));
        std::iter::once(text).chain(files).collect()
    }
}
