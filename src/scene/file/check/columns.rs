//! Declared columns: what sets, their lists and files, and insertions say of them.

use super::named_tables::{Named, names};
use super::particles::ReadParticles;
use super::raw_tables::RawTables;
use super::set_reader::SetReader;
use crate::base::document::{Document, Faults, Mistake, Part};
use crate::base::quantity::Finite;
use crate::laws::column::Column;
use crate::scene::ColumnStart;
use crate::scene::exchange::InsertionKeys;
use crate::scene::file::tables::{ParticlesTable, WrittenColumn};
use std::collections::BTreeMap;

/// Columns that scenes may ask for.
type Declared = [&'static Column];

/// Values of columns by their name, each with one for every row of a set.
pub(super) type ByName = BTreeMap<String, Vec<f64>>;

/// All particle sets.
pub(super) fn particles(document: &Document, declared: &Declared, faults: &mut Faults) -> Named<ParticlesTable> {
    let keys: Vec<&str> = declared.iter().map(|column| column.name).collect();
    let mut sets = Vec::new();
    for name in names(document, "particles", faults) {
        let path = format!("particles.{name}");
        let table: Option<ParticlesTable> = document.read_part(&path, "", Part::ExceptInLists(&keys), faults);
        let Some(table) = table else { continue };
        let entries = table.list.as_ref().map_or(0, Vec::len);
        let mut columns = BTreeMap::new();
        for column in declared {
            let all = number(document, &path, column.name, column, faults);
            let entry = |row| number(document, &path, &format!("list.{row}.{}", column.name), column, faults);
            let listed = (1..=entries).map(entry).collect();
            columns.insert(column.name, WrittenColumn { all, listed });
        }
        sets.push((name, ParticlesTable { columns, ..table }));
    }
    sets
}

/// All insertions.
pub(super) fn insertions(document: &Document, declared: &Declared, faults: &mut Faults) -> Named<InsertionKeys> {
    let keys: Vec<&str> = declared.iter().map(|column| column.name).collect();
    let mut insertions = Vec::new();
    for name in names(document, "insertion", faults) {
        let path = format!("insertion.{name}");
        let table: Option<InsertionKeys> = document.read_part(&path, "", Part::Except(&keys), faults);
        let value =
            |column: &&'static Column| Some((column.name, number(document, &path, column.name, column, faults)?));
        let columns = declared.iter().filter_map(value).collect();
        if let Some(mut table) = table {
            table.columns = columns;
            insertions.push((name, table));
        }
    }
    insertions
}

/// The value of a column at a key of a table, if it is there.
fn number(document: &Document, table: &str, key: &str, column: &Column, faults: &mut Faults) -> Option<f64> {
    if !document.has(&format!("{table}.{key}")) {
        return None;
    }
    let value = document.read_key::<Finite>(table, key, faults)?.get();
    if !(column.takes)(value) {
        faults.add(table, key, unexpected(value, column));
    }
    Some(value)
}

/// A value that a column does not take.
fn unexpected(value: f64, column: &Column) -> Mistake {
    Mistake::Unexpected { found: format!("{value:?}"), expected: column.expected.to_owned() }
}

/// The columns that a scene asks for.
pub(super) fn asked(document: &Document, declared: &Declared) -> Vec<&'static Column> {
    let is_asked = |column: &&&'static Column| column.asked_by.iter().any(|path| document.has_any(path));
    declared.iter().filter(is_asked).copied().collect()
}

impl SetReader<'_> {
    /// Names of the columns that a file may have.
    pub(super) fn names_in_files(&self) -> impl Iterator<Item = String> {
        let names = |column: &&'static Column| [column.name].into_iter().chain(column.aliases.iter().copied());
        self.columns.iter().flat_map(names).map(str::to_owned)
    }

    /// Columns of which particles of the list have values of their own.
    pub(super) fn listed_columns(&self, faults: &mut Faults) -> ByName {
        let mut columns = BTreeMap::new();
        for column in self.columns {
            let Some(WrittenColumn { all, listed }) = self.written.columns.get(column.name) else { continue };
            if listed.iter().all(Option::is_none) {
                continue;
            }
            let mut values = Vec::with_capacity(listed.len());
            for (row, own) in listed.iter().enumerate() {
                values.extend(own.or(*all).or(column.start));
                if values.len() == row {
                    faults.add(&self.table, &format!("list.{}.{}", row + 1, column.name), missing(column));
                    break;
                }
            }
            self.tell_unread_column(column, listed.iter().all(Option::is_some), faults);
            columns.insert(column.name.to_owned(), values);
        }
        columns
    }

    /// Gives columns of a file their own names, and refuses what they do not take; `report` tells a mistake in a row.
    pub(super) fn filed_columns(&self, columns: &mut ByName, report: &mut dyn FnMut(usize, &str, Mistake)) {
        for column in self.columns {
            let named = |name: &&str| columns.contains_key(*name);
            let Some(there) = [column.name].iter().chain(column.aliases).copied().find(named) else { continue };
            let Some(values) = columns.remove(there) else { continue };
            if let Some(row) = values.iter().position(|value| !(column.takes)(*value)) {
                report(row, there, unexpected(values[row], column));
            }
            columns.insert(column.name.to_owned(), values);
        }
    }

    /// Tells a value for particles that have none of their own, where each has.
    pub(super) fn tell_unread_column(&self, column: &Column, each_has: bool, faults: &mut Faults) {
        let written = self.written.columns.get(column.name);
        if each_has && written.is_some_and(|written| written.all.is_some()) {
            faults.unread(&self.table, column.name, "each of its particles has its own");
        }
    }
}

/// A column of which a particle has no value.
fn missing(column: &Column) -> Mistake {
    Mistake::Missing { expected: format!("{} [{}]: this scene asks for it", column.about, column.unit) }
}

/// The columns with what they begin with. Tells values that it does not ask for.
pub(super) fn starts(
    written: &RawTables,
    asked: &Declared,
    born: &ReadParticles,
    faults: &mut Faults,
) -> Vec<ColumnStart> {
    for column in written.columns.iter().filter(|column| !asked.iter().any(|it| it.name == column.name)) {
        tell_unneeded(written, column, faults);
    }
    let mut starts = Vec::new();
    for &column in asked {
        let of_set = |set: usize| written.particles[set].1.columns.get(column.name)?.all.or(column.start);
        let otherwise: Vec<Option<f64>> = (0..born.sets.len()).map(of_set).collect();
        let mut lacking = vec![false; born.sets.len()];
        let mut particles = Vec::with_capacity(born.particles.len());
        for (particle, &row) in born.particles.iter().zip(&born.rows) {
            let set = particle.set.index();
            let own = born.columns[set].get(column.name).map(|values| values[row as usize]);
            lacking[set] |= own.or(otherwise[set]).is_none();
            particles.extend(own.or(otherwise[set]));
        }
        for (name, _) in born.sets.iter().zip(lacking).filter(|(_, lacking)| *lacking) {
            faults.add(&format!("particles.{name}"), column.name, missing(column));
        }
        let mut insertions = Vec::with_capacity(written.insertions.len());
        for (name, keys) in &written.insertions {
            let value = keys.columns.get(column.name).copied().or(column.start);
            if value.is_none() {
                faults.add(&format!("insertion.{name}"), column.name, missing(column));
            }
            insertions.extend(value);
        }
        starts.push(ColumnStart { column, particles, insertions });
    }
    starts
}

/// Tells the values of a column that the scene does not ask for.
fn tell_unneeded(written: &RawTables, column: &Column, faults: &mut Faults) {
    let has = |written: &WrittenColumn| written.all.is_some() || written.listed.iter().any(Option::is_some);
    let sets = written.particles.iter().filter(|(_, set)| set.columns.get(column.name).is_some_and(has));
    let sets = sets.map(|(name, _)| format!("particles.{name}"));
    let insertions = written.insertions.iter().filter(|(_, keys)| keys.columns.contains_key(column.name));
    for table in sets.chain(insertions.map(|(name, _)| format!("insertion.{name}"))) {
        let why = format!("this scene does not ask for it, as any of {} would", column.asked_by.join(", "));
        faults.unread(&table, column.name, &why);
    }
}
