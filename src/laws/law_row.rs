//! What the program knows of the laws of a kind that a fluid has: one static row for each, made from its type.

use super::kept::{Kept, of_kind};
use crate::base::document::{Document, Faults};
use std::fmt;
use std::sync::Arc;

/// What the program knows of a law, whose numbers are an `F`.
pub struct LawRow<F: ?Sized + 'static> {
    /// Its name.
    pub(super) name: &'static str,
    /// Reads its keys below a table.
    pub(super) read: fn(&Document, &str, &str, &mut Faults) -> Option<Kept>,
    /// The law in numbers.
    pub(super) law: fn(Kept) -> Arc<F>,
    /// Whether it holds for one sphere in much fluid alone.
    pub(super) of_one_sphere: bool,
}

impl<F: ?Sized> LawRow<F> {
    /// Its name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Reads the law from its table, which stands below this one.
    pub(crate) fn read(&'static self, document: &Document, table: &str, faults: &mut Faults) -> Option<LawModel<F>> {
        (self.read)(document, table, self.name, faults).map(|keys| LawModel { row: self, keys })
    }
}

impl<F: ?Sized> fmt::Debug for LawRow<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// A law as a scene chose it: its row and its keys.
pub struct LawModel<F: ?Sized + 'static> {
    /// What the program knows of it.
    pub(super) row: &'static LawRow<F>,
    /// What the scene writes of it.
    pub(super) keys: Kept,
}

impl<F: ?Sized> Clone for LawModel<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: ?Sized> Copy for LawModel<F> {}

impl<F: ?Sized> fmt::Debug for LawModel<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("LawModel").field("row", &self.row).field("keys", &self.keys).finish()
    }
}

impl<F: ?Sized> LawModel<F> {
    /// Its name in a scene.
    pub fn name(&self) -> &'static str {
        self.row.name
    }

    /// Whether it holds for one sphere in much fluid alone.
    pub fn is_of_one_sphere(&self) -> bool {
        self.row.of_one_sphere
    }

    /// Its keys, if they are of this type.
    pub fn keys<K: 'static>(&self) -> Option<&'static K> {
        of_kind(self.keys)
    }

    /// The law in numbers.
    pub(crate) fn law(&self) -> Arc<F> {
        (self.row.law)(self.keys)
    }
}
