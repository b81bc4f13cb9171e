//! Reading a value again without what is wrong in it, so that all its mistakes are reported.

use super::single::Error;
use super::{Document, Faults, Mistake, Part, child, messages, segments};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// How often one table is read again at most, so that a text full of different mistakes costs no quadratic time.
const READINGS: usize = 100;

/// A value that is read until nothing in it is wrong. What does not depend on the wanted type stands here, so that it is
/// compiled once.
pub(super) struct Attempt<'d, 'a> {
    /// The text.
    document: &'d Document<'a>,
    /// The table that the value is in.
    table: &'d str,
    /// Its key.
    key: &'d str,
    /// Which of its keys are read.
    part: Part<'d>,
    /// What is left of it.
    pub(super) value: Spanned<DeValue<'a>>,
    /// Mistakes that were known before.
    pub(super) before: usize,
    /// Keys that were taken out.
    wrong: Vec<String>,
    /// How often it was read in vain.
    readings: usize,
}

impl<'d, 'a> Attempt<'d, 'a> {
    /// A value as it stands in the text; one that is absent is an empty table.
    pub(super) fn of(
        document: &'d Document<'a>,
        (table, key): (&'d str, &'d str),
        part: Part<'d>,
        faults: &Faults,
    ) -> Self {
        let empty = || Spanned::new(0..0, DeValue::Table(DeTable::new()));
        let mut value = document.find(&format!("{table}.{key}")).cloned().unwrap_or_else(empty);
        leave(&mut value, part);
        Self { document, table, key, part, value, before: faults.count(), wrong: Vec::new(), readings: 0 }
    }

    /// Reports a mistake and takes out what is unknown or wrong; whether the rest is worth another reading.
    pub(super) fn goes_on_without(&mut self, error: &Error, faults: &mut Faults) -> bool {
        let mut path = error.span().map(|span| path_to(&self.value, &span)).unwrap_or_default();
        // A table that only its sub-tables name lies in their headers; the unknown key is where the way ends.
        if let Some(end) = messages::unknown_field(error).and_then(|field| path.iter().position(|key| key == field)) {
            path.truncate(end + 1);
        }
        let mut mistake = messages::mistake(error, path.last().map_or("", String::as_str));
        if let Mistake::UnknownKey { known, .. } = &mut mistake {
            let others = match (self.part, &path[..]) {
                (Part::Except(others), [_]) | (Part::ExceptInLists(others), [_] | [_, _, _]) => others,
                _ => &[],
            };
            known.splice(0..0, others.iter().map(|key| (*key).to_owned()));
        }
        let unknown = matches!(mistake, Mistake::UnknownKey { .. } | Mistake::Unsupported { .. });
        // What was taken out as wrong is not missing, nor is the sub-model that it was.
        let missing = messages::missing_field(error);
        let taken_before = |field| self.wrong.iter().any(|key| key == field);
        if !self.wrong.is_empty() && path.is_empty() && missing.is_none_or(taken_before) {
            return false;
        }
        let ways = if unknown { alike(&self.value, &path) } else { vec![path] };
        let mut taken = false;
        for way in ways {
            let whole = segments(self.key).map(str::to_owned).chain(way.iter().cloned()).collect();
            self.document.report(self.table, whole, error, mistake.clone(), faults);
            let out = if unknown { &way[..] } else { way.get(..1).unwrap_or_default() };
            self.wrong.extend(out.first().filter(|first| self.wrong.last() != Some(*first)).cloned());
            taken = take_out(&mut self.value, out);
        }
        self.readings += 1;
        taken && self.readings < READINGS
    }
}

impl Part<'_> {
    /// Whether it has this key.
    fn has(self, key: &str) -> bool {
        match self {
            Self::Only(keys) => keys.contains(&key),
            Self::Except(keys) | Self::ExceptInLists(keys) => !keys.contains(&key),
        }
    }
}

/// Leaves this part of a table.
fn leave(value: &mut Spanned<DeValue>, part: Part) {
    let DeValue::Table(table) = value.get_mut() else { return };
    let others = table.keys().filter(|key| !part.has(key.get_ref()));
    for other in others.map(|key| key.get_ref().to_string()).collect::<Vec<_>>() {
        table.remove(other.as_str());
    }
    let Part::ExceptInLists(keys) = part else { return };
    for (_, below) in table.iter_mut() {
        if let DeValue::Array(list) = below.get_mut() {
            list.iter_mut().for_each(|entry| leave(entry, Part::Except(keys)));
        }
    }
}

/// The way from a value down to the key or entry at a place of the text.
fn path_to(value: &Spanned<DeValue>, place: &Range<usize>) -> Vec<String> {
    let holds = |span: Range<usize>| span.start <= place.start && place.end <= span.end;
    let nested = |name: String, spans: bool, below: &Spanned<DeValue>| {
        let rest = path_to(below, place);
        (spans || !rest.is_empty()).then(|| [vec![name], rest].concat())
    };
    let path = match value.get_ref() {
        DeValue::Table(table) => table.iter().find_map(|(key, value)| {
            nested(key.get_ref().to_string(), holds(key.span()) || holds(value.span()), value)
        }),
        DeValue::Array(list) => {
            let entry = list.iter().position(|value| holds(value.span()));
            entry.and_then(|entry| nested((entry + 1).to_string(), true, &list[entry]))
        }
        _ => None,
    };
    path.unwrap_or_default()
}

/// The ways to a key of an entry of a list, and to the same key of the list's other entries.
fn alike(value: &Spanned<DeValue>, path: &[String]) -> Vec<Vec<String>> {
    let mut below = value;
    for (depth, name) in path.iter().enumerate() {
        if let (DeValue::Array(list), [key]) = (below.get_ref(), &path[depth + 1..]) {
            let has = |entry: &Spanned<DeValue>| child(entry, key).is_some();
            let entries = (1..).zip(list.iter()).filter(|(_, entry)| has(entry));
            return entries.map(|(entry, _)| [&path[..depth], &[entry.to_string(), key.clone()]].concat()).collect();
        }
        match child(below, name) {
            Some((_, next)) => below = next,
            None => break,
        }
    }
    vec![path.to_vec()]
}

/// Removes the key at the path; whether it was there.
fn take_out(value: &mut Spanned<DeValue>, path: &[String]) -> bool {
    match (value.get_mut(), path) {
        (DeValue::Table(table), [key]) => table.remove(key.as_str()).is_some(),
        (DeValue::Table(table), [key, rest @ ..]) => {
            table.get_mut(key.as_str()).is_some_and(|value| take_out(value, rest))
        }
        (DeValue::Array(list), [entry, rest @ ..]) => entry
            .parse::<usize>()
            .ok()
            .and_then(|entry| list.get_mut(entry.checked_sub(1)?))
            .is_some_and(|value| take_out(value, rest)),
        _ => false,
    }
}
