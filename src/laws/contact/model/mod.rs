//! What the program knows of a sub-model: one static row for each, made from its type. A law that a scene composes is four of
//! them with their keys.

mod cohesion;
mod heat;
mod normal;
mod rolling;
mod tangential;

pub use cohesion::CohesionFunctions;
pub use heat::HeatFunctions;
pub use normal::NormalFunctions;
pub use rolling::RollingFunctions;
pub use tangential::TangentialFunctions;

use super::{Coefficients, HistoryRow, Needs, Property};
use crate::base::document::{Document, Faults};
use crate::laws::kept::{Kept, ModelKeys, keep, of_kind};
use std::any::TypeId;
use std::fmt;

/// What the program knows of a sub-model, the functions of its kind among it.
pub struct ModelRow<F> {
    /// Its name in a scene.
    name: &'static str,
    /// Whether it does anything.
    active: bool,
    /// How many coefficients it has.
    pub(super) count: usize,
    /// What it remembers of a contact.
    pub(super) history: Option<HistoryRow>,
    /// What of a contact it looks at.
    pub(crate) needs: Needs,
    /// The type of what it computes.
    form: fn() -> TypeId,
    /// The type of its keys.
    keys: fn() -> TypeId,
    /// Properties of two materials and of one that it declares.
    pub(crate) properties: [&'static [&'static Property]; 2],
    /// Reads its keys below a table.
    read: fn(&Document, &str, &str, &mut Faults) -> Option<Kept>,
    /// What its kind does.
    pub(crate) does: F,
}

impl<F> ModelRow<F> {
    /// Its name in a scene.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Whether it does anything.
    pub fn is_active(&self) -> bool {
        self.active
    }

    /// What it remembers of a contact.
    pub fn history(&self) -> Option<&HistoryRow> {
        self.history.as_ref()
    }

    /// The type of what it computes: models that differ in their coefficients alone share it.
    pub(crate) fn form(&self) -> TypeId {
        (self.form)()
    }

    /// The type of its keys.
    #[cfg(test)]
    pub(crate) fn keys(&self) -> TypeId {
        (self.keys)()
    }

    /// The sub-model with these keys, if they are of its type.
    pub fn with<K: ModelKeys>(&'static self, keys: K) -> Option<Model<F>> {
        ((self.keys)() == TypeId::of::<K>()).then(|| Model { row: self, keys: keep(keys) })
    }

    /// Reads the sub-model from its table, which stands below this one.
    pub(crate) fn read(&'static self, document: &Document, table: &str, faults: &mut Faults) -> Option<Model<F>> {
        (self.read)(document, table, self.name, faults).map(|keys| Model { row: self, keys })
    }
}

impl<F> fmt::Debug for ModelRow<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// A sub-model as a scene chose it: its row and its keys.
pub struct Model<F: 'static> {
    /// What the program knows of it.
    row: &'static ModelRow<F>,
    /// What the scene writes under its name.
    keys: Kept,
}

impl<F> Clone for Model<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Model<F> {}

impl<F> fmt::Debug for Model<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {:?}", self.row.name, self.keys)
    }
}

impl<F> Model<F> {
    /// Its name in a scene.
    pub fn name(&self) -> &'static str {
        self.row.name
    }

    /// What the program knows of it.
    pub fn row(&self) -> &'static ModelRow<F> {
        self.row
    }

    /// Its keys, if they are of this type.
    pub fn keys<K: 'static>(&self) -> Option<&'static K> {
        of_kind(self.keys)
    }
}

/// What the program knows of a normal sub-model.
pub type NormalRow = ModelRow<NormalFunctions>;

/// What the program knows of a tangential sub-model.
pub type TangentialRow = ModelRow<TangentialFunctions>;

/// What the program knows of a rolling sub-model.
pub type RollingRow = ModelRow<RollingFunctions>;

/// What the program knows of a cohesion sub-model.
pub type CohesionRow = ModelRow<CohesionFunctions>;

/// A normal sub-model of a scene.
pub type NormalModel = Model<NormalFunctions>;

/// A tangential sub-model of a scene.
pub type TangentialModel = Model<TangentialFunctions>;

/// A rolling sub-model of a scene.
pub type RollingModel = Model<RollingFunctions>;

/// A cohesion sub-model of a scene.
pub type CohesionModel = Model<CohesionFunctions>;

/// What the program knows of a heat sub-model.
pub type HeatRow = ModelRow<HeatFunctions>;

/// A heat sub-model of a scene.
pub type HeatModel = Model<HeatFunctions>;

/// Coefficients as a row.
pub(super) fn numbers<T: Coefficients>(coefficients: &T) -> Vec<f64> {
    let mut row = Vec::with_capacity(T::COUNT);
    coefficients.write(&mut row);
    row
}
