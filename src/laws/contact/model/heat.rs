//! What the program knows of a heat sub-model.

use super::{HeatModel, HeatRow, numbers};
use crate::laws::contact::batch::Run;
use crate::laws::contact::heat::Spot;
use crate::laws::contact::{Heat, MaterialPair, Missing, batch};
use crate::laws::kept::{Kept, keep, own, read};
use std::any::TypeId;

/// What a heat model does.
pub struct HeatFunctions {
    /// [`Heat::between`].
    between: fn(Kept, &MaterialPair) -> Result<Vec<f64>, Missing>,
    /// [`Heat::conductance`].
    pub(crate) conductance: fn(&[f64], &Spot) -> f64,
    /// The same of a batch of contacts.
    pub(crate) run: Run,
}

impl HeatRow {
    /// That of a heat model.
    pub const fn of<M: Heat>() -> &'static Self {
        const {
            &Self {
                name: M::NAME,
                active: true,
                count: M::COUNT,
                history: None,
                needs: M::NEEDS,
                form: TypeId::of::<M>,
                keys: TypeId::of::<M::Keys>,
                properties: [M::PAIR_PROPERTIES, M::MATERIAL_PROPERTIES],
                read: read::<M::Keys>,
                does: HeatFunctions {
                    between: |keys, pair| Ok(numbers(&M::between(pair, own(keys))?)),
                    conductance: |row, spot| M::conductance(M::lanes(row), spot),
                    run: batch::conductance::<M>,
                },
            }
        }
    }
}

impl HeatModel {
    /// A heat model with these keys.
    pub fn of<M: Heat>(keys: M::Keys) -> Self {
        Self { row: HeatRow::of::<M>(), keys: keep(keys) }
    }

    /// How many coefficients it has.
    pub(crate) fn count(&self) -> usize {
        self.row.count
    }

    /// Its coefficients for two materials.
    pub(crate) fn between(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair)
    }
}
