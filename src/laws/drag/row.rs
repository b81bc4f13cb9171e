//! What the program knows of a drag law: one static row for each, made from its type.

use super::Drag;
use crate::base::document::{Document, Faults};
use crate::laws::kept::{self, Kept, ModelKeys, keep, of_kind, own};
use std::fmt;
use std::sync::Arc;

/// A drag law whose type is forgotten.
pub(crate) trait Factor: fmt::Debug + Send + Sync {
    /// [`Drag::factor`]
    fn factor(&self, porosity: f64, reynolds: f64) -> f64;
}

impl<D: Drag> Factor for D {
    fn factor(&self, porosity: f64, reynolds: f64) -> f64 {
        Drag::factor(self, porosity, reynolds)
    }
}

/// What the program knows of a drag law.
pub struct DragRow {
    /// Its name.
    name: &'static str,
    /// [`Drag::OF_ONE_SPHERE`]
    of_one_sphere: bool,
    /// Reads its keys below a table.
    read: fn(&Document, &str, &str, &mut Faults) -> Option<Kept>,
    /// The law in numbers.
    law: fn(Kept) -> Arc<dyn Factor>,
}

impl DragRow {
    /// The row of a law.
    pub const fn of<D: Drag>() -> &'static Self {
        const {
            &Self {
                name: D::NAME,
                of_one_sphere: D::OF_ONE_SPHERE,
                read: kept::read::<D::Keys>,
                law: |keys| Arc::new(D::of(own::<D::Keys>(keys))),
            }
        }
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Reads the law from its table, which stands below this one.
    pub(crate) fn read(&'static self, document: &Document, table: &str, faults: &mut Faults) -> Option<DragModel> {
        (self.read)(document, table, self.name, faults).map(|keys| DragModel { row: self, keys })
    }
}

impl fmt::Debug for DragRow {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// A drag law as a scene chose it: its row and its keys.
#[derive(Clone, Copy, Debug)]
pub struct DragModel {
    /// What the program knows of it.
    row: &'static DragRow,
    /// What the scene writes of it.
    keys: Kept,
}

impl DragModel {
    /// A law with these keys.
    pub fn of<D: Drag>(keys: D::Keys) -> Self
    where
        D::Keys: ModelKeys,
    {
        Self { row: DragRow::of::<D>(), keys: keep(keys) }
    }

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
    pub(crate) fn law(&self) -> Arc<dyn Factor> {
        (self.row.law)(self.keys)
    }
}
