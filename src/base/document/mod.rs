//! The text of a scene as tables whose lines are known, and from tables to typed values.

mod attempt;
mod error;
mod faults;
mod foreign;
mod forms;
mod keys;
pub(crate) mod messages;
mod mistake;
mod nearest;
mod phrases;
mod setting;
mod single;
mod value;

pub use error::{SceneError, SceneErrors};
pub(crate) use faults::Faults;
pub(crate) use forms::{Forms, any_form, several_forms};
pub(crate) use keys::{Key, Table, keys};
#[cfg(test)]
pub(crate) use keys::{printed, printed_by_model, printed_together};
pub use mistake::Mistake;
pub(crate) use phrases::{proposal, told_columns};
pub(crate) use setting::apply;
pub use setting::{Setting, SettingError};

use attempt::Attempt;
use foreign::{list_without_commas, looks_like};
use serde::de::DeserializeOwned;
use single::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Which keys of a table are read together.
#[derive(Clone, Copy)]
pub(crate) enum Part<'k> {
    /// These.
    Only(&'k [&'k str]),
    /// All but these, which are read on their own.
    Except(&'k [&'k str]),
    /// All but these, of the table and of the entries of its lists.
    ExceptInLists(&'k [&'k str]),
}

/// A scene's text, parsed.
pub(crate) struct Document<'a> {
    /// The scene's name, for messages.
    name: &'a str,
    /// The text.
    text: &'a str,
    /// Where each line begins.
    lines: Vec<usize>,
    /// The top table.
    root: Spanned<DeValue<'a>>,
}

impl<'a> Document<'a> {
    /// Parses the text; all mistakes of syntax are reported.
    pub(crate) fn parse(name: &'a str, text: &'a str) -> Result<Self, SceneErrors> {
        let (root, errors) = DeTable::parse_recoverable(text);
        let root = Spanned::new(root.span(), DeValue::Table(root.into_inner()));
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(place, _)| place + 1)).collect();
        let document = Self { name, text, lines, root };
        if errors.is_empty() {
            return Ok(document);
        }
        let mut faults = Faults::new(&document);
        if let Some(mistake) = looks_like(text) {
            faults.at_line(None, "", "", mistake);
            return faults.finish().map(|()| document);
        }
        let mut told = None;
        for error in errors {
            let line = error.span().map(|span| document.line(span.start));
            let list = line.and_then(|line| list_without_commas(text.lines().nth(line - 1)?));
            // All that is said of such a line follows from the one mistake.
            if line.is_some() && line == told {
                continue;
            }
            told = line.filter(|_| list.is_some());
            let mistake = list.unwrap_or_else(|| Mistake::Syntax { message: error.message().to_owned() });
            faults.at_line(line, "", "", mistake);
        }
        faults.finish().map(|()| document)
    }

    /// The line, counted from 1, of a byte of the text.
    fn line(&self, offset: usize) -> usize {
        self.lines.partition_point(|start| *start <= offset)
    }

    /// The value at a dotted path; the empty path is the top.
    fn find(&self, path: &str) -> Option<&Spanned<DeValue<'a>>> {
        let mut value = &self.root;
        for segment in segments(path) {
            value = child(value, segment)?.1;
        }
        Some(value)
    }

    /// Whether the scene has this table or key.
    pub(crate) fn has(&self, path: &str) -> bool {
        self.find(path).is_some()
    }

    /// Whether the scene has a table or key at this dotted path, in which `*` stands for any name.
    pub(crate) fn has_any(&self, path: &str) -> bool {
        let Some((before, after)) = path.split_once('*') else { return self.has(path) };
        let names = self.names(before.trim_end_matches('.'));
        names.iter().any(|name| self.has_any(&format!("{before}{name}{after}")))
    }

    /// The keys of a table, in the order in which the text has them.
    pub(crate) fn names(&self, table: &str) -> Vec<String> {
        let Some(DeValue::Table(table)) = self.find(table).map(Spanned::get_ref) else { return Vec::new() };
        let mut names: Vec<(usize, String)> =
            table.iter().map(|(key, _)| (key.span().start, key.get_ref().to_string())).collect();
        names.sort_unstable();
        names.into_iter().map(|(_, name)| name).collect()
    }

    /// Whether the value at the path is a table.
    pub(crate) fn is_table(&self, path: &str) -> bool {
        matches!(self.find(path).map(Spanned::get_ref), Some(DeValue::Table(_)))
    }

    /// The text at the path, if that is what stands there.
    pub(crate) fn text(&self, path: &str) -> Option<&str> {
        self.find(path)?.get_ref().as_str()
    }

    /// The text at the path, or those of the list there.
    pub(crate) fn texts(&self, path: &str) -> Vec<&str> {
        match self.find(path).map(Spanned::get_ref) {
            Some(DeValue::Array(list)) => list.iter().filter_map(|value| value.get_ref().as_str()).collect(),
            value => value.and_then(DeValue::as_str).into_iter().collect(),
        }
    }

    /// The value at the path, as the scene has it.
    pub(crate) fn written(&self, path: &str) -> &str {
        self.find(path).and_then(|value| self.text.get(value.span())).unwrap_or_default()
    }

    /// The line of a key, or of the deepest table above it that the text has.
    pub(crate) fn line_of(&self, table: &str, key: &str) -> Option<usize> {
        let mut value = &self.root;
        let mut offset = None;
        for segment in segments(table).chain(segments(key)) {
            let Some((key_start, below)) = child(value, segment) else { break };
            offset = Some(if self.has_header(below) { below.span().start } else { key_start });
            value = below;
        }
        offset.map(|offset| self.line(offset))
    }

    /// Whether a table stands below a table; its name may hold any characters.
    pub(crate) fn is_table_below(&self, table: &str, name: &str) -> bool {
        let below = self.find(table).and_then(|above| child(above, name));
        matches!(below.map(|(_, value)| value.get_ref()), Some(DeValue::Table(_)))
    }

    /// The line of a table or key whose name may hold any characters, below a table.
    pub(crate) fn line_of_name(&self, table: &str, name: &str) -> Option<usize> {
        let (key_start, below) = child(self.find(table)?, name)?;
        Some(self.line(if self.has_header(below) { below.span().start } else { key_start }))
    }

    /// Whether a table has a `[header]` of its own.
    fn has_header(&self, value: &Spanned<DeValue>) -> bool {
        matches!(value.get_ref(), DeValue::Table(_)) && self.text[value.span()].starts_with('[')
    }

    /// Reads a table into a type; an absent table is read as an empty one.
    ///
    /// All mistakes are reported: what is unknown or wrong is taken out and the table read again. A key that an entry
    /// of a list may not have is taken out of all its entries at once, as those are of one type.
    pub(crate) fn read<T: DeserializeOwned>(&self, table: &str, faults: &mut Faults) -> Option<T> {
        self.read_key(table, "", faults)
    }

    /// Reads the value of a key of a table into a type.
    pub(crate) fn read_key<T: DeserializeOwned>(&self, table: &str, key: &str, faults: &mut Faults) -> Option<T> {
        self.read_part(table, key, Part::Except(&[]), faults)
    }

    /// Reads a part of the value of a key of a table into a type.
    pub(crate) fn read_part<T: DeserializeOwned>(
        &self,
        table: &str,
        key: &str,
        part: Part,
        faults: &mut Faults,
    ) -> Option<T> {
        let mut attempt = Attempt::of(self, (table, key), part, faults);
        loop {
            match value::read(&attempt.value) {
                Ok(read) => return (faults.count() == attempt.before).then_some(read),
                Err(error) if attempt.goes_on_without(&error, faults) => {}
                Err(_) => return None,
            }
        }
    }

    /// Reports what serde found, at the innermost table that has a header.
    fn report(&self, table: &str, mut path: Vec<String>, error: &Error, mistake: Mistake, faults: &mut Faults) {
        let mut table = table.to_owned();
        while let Some(first) = path.first() {
            let below = format!("{table}.{first}");
            if !self.find(&below).is_some_and(|value| self.has_header(value)) {
                break;
            }
            table = below;
            path.remove(0);
        }
        let key = match messages::missing_field(error) {
            Some(field) => path.iter().map(String::as_str).chain([field]).collect::<Vec<_>>().join("."),
            None => path.join("."),
        };
        faults.add(&table, &key, mistake);
    }
}

/// The names in a dotted path.
fn segments(path: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    let ends = move |letter: char| {
        quoted ^= letter == '"';
        letter == '.' && !quoted
    };
    path.split(ends).map(|segment| segment.trim_matches('"')).filter(|segment| !segment.is_empty())
}

/// Where a key or entry stands, and its value. Entries of lists count from 1.
fn child<'v, 'a>(value: &'v Spanned<DeValue<'a>>, segment: &str) -> Option<(usize, &'v Spanned<DeValue<'a>>)> {
    match value.get_ref() {
        DeValue::Table(table) => table.get_key_value(segment).map(|(key, value)| (key.span().start, value)),
        DeValue::Array(list) => {
            let value = list.get(segment.parse::<usize>().ok()?.checked_sub(1)?)?;
            Some((value.span().start, value))
        }
        _ => None,
    }
}
