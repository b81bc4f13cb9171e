//! Tables of a kind, each with a name of the user's.

use crate::base::document::{Document, Faults, Mistake};
use serde::de::DeserializeOwned;

/// Tables by name, in the order of the text.
pub(super) type Named<T> = Vec<(String, T)>;

/// The names of the tables below a table; each must be a name.
pub(super) fn names(document: &Document, kind: &str, faults: &mut Faults) -> Vec<String> {
    if document.has(kind) && !document.is_table(kind) {
        let (found, expected) = (document.written(kind).to_owned(), format!("a table [{kind}.<name>]"));
        faults.add("", kind, Mistake::Unexpected { found, expected });
    }
    let (names, others): (Vec<String>, Vec<String>) = document.names(kind).into_iter().partition(|name| is_name(name));
    for found in others {
        let line = document.line_of_name(kind, &found);
        let bare = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
        let shown = if !found.is_empty() && found.chars().all(bare) { found.clone() } else { format!("{found:?}") };
        faults.at_line(line, &format!("{kind}.{shown}"), "", Mistake::Name { found });
    }
    names
}

/// `[A-Za-z_][A-Za-z0-9_]*`
pub(super) fn is_name(text: &str) -> bool {
    let starts = text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
    starts && text.chars().all(|character| character.is_ascii_alphanumeric() || character == '_')
}

/// All tables of a kind.
pub(super) fn all<T: DeserializeOwned>(document: &Document, kind: &str, faults: &mut Faults) -> Named<T> {
    let mut tables = Vec::new();
    for name in names(document, kind, faults) {
        if let Some(table) = document.read(&format!("{kind}.{name}"), faults) {
            tables.push((name, table));
        }
    }
    tables
}
