//! What the program knows of a rolling sub-model.

use super::{RollingModel, RollingRow, numbers};
use crate::base::number::Row;
use crate::laws::contact::batch::Run;
use crate::laws::contact::functions::RollingFunction;
use crate::laws::contact::{
    Contact, MaterialPair, Missing, Objection, Response, Rolling, RollingResponse, batch, functions,
};
use crate::laws::kept::{Kept, keep, own, read};
use std::any::TypeId;

/// What a rolling model does.
pub struct RollingFunctions {
    /// Whether it takes k_n δ for the force that presses.
    pub(in crate::laws::contact) takes_overlap: bool,
    /// Whether it takes k_t.
    pub(in crate::laws::contact) takes_tangential_stiffness: bool,
    /// [`Rolling::objection`].
    objection: fn(Kept) -> Option<Objection>,
    /// [`Rolling::is_engine_exact`].
    is_engine_exact: fn(Kept) -> bool,
    /// [`Rolling::between`].
    between: fn(Kept, &MaterialPair) -> Result<Vec<f64>, Missing>,
    /// [`Rolling::response`].
    pub(in crate::laws::contact) response: fn(&[f64], &Contact, &Response) -> RollingResponse,
    /// [`Rolling::elastic_energy`].
    pub(in crate::laws::contact) elastic_energy: fn(&[f64], &Contact, &Response, Row) -> f64,
    /// [`Rolling::torque`] of one contact.
    pub(in crate::laws::contact) torque: RollingFunction,
    /// What it does to a batch of contacts.
    pub(crate) run: Run,
    /// The same where springs are carried at mid-step.
    pub(crate) run_carried: Run,
}

impl RollingRow {
    /// The row of a rolling model.
    pub const fn of<M: Rolling>() -> &'static Self {
        const {
            &Self {
                name: M::NAME,
                active: M::ACTIVE,
                count: M::COUNT,
                history: M::HISTORY,
                needs: M::NEEDS,
                form: TypeId::of::<M>,
                keys: TypeId::of::<M::Keys>,
                properties: [M::PAIR_PROPERTIES, M::MATERIAL_PROPERTIES],
                read: read::<M::Keys>,
                does: RollingFunctions {
                    takes_overlap: M::TAKES_OVERLAP,
                    takes_tangential_stiffness: M::TAKES_TANGENTIAL_STIFFNESS,
                    objection: |keys| M::objection(own(keys)),
                    is_engine_exact: |keys| M::is_engine_exact(own(keys)),
                    between: |keys, pair| Ok(numbers(&M::between(pair, own(keys))?)),
                    response: |row, contact, response| M::read(row).response(contact, response),
                    elastic_energy: |row, contact, response, history| {
                        M::read(row).elastic_energy(contact, response, history)
                    },
                    torque: functions::rolling::<M>,
                    run: batch::rolling::<M, false>,
                    run_carried: if M::HISTORY.is_some() {
                        batch::rolling::<M, true>
                    } else {
                        batch::rolling::<M, false>
                    },
                },
            }
        }
    }
}

impl RollingModel {
    /// A rolling model with these keys.
    pub fn of<M: Rolling>(keys: M::Keys) -> Self {
        Self { row: RollingRow::of::<M>(), keys: keep(keys) }
    }

    /// The same, of keys that live as long as the program.
    pub const fn fixed<M: Rolling>(keys: &'static M::Keys) -> Self {
        Self { row: RollingRow::of::<M>(), keys }
    }

    /// What speaks against its keys, if anything.
    pub(in crate::laws::contact) fn objection(&self) -> Option<Objection> {
        (self.row.does.objection)(self.keys)
    }

    /// Whether its keys keep the direction of the torque as the engine does.
    pub(in crate::laws::contact) fn is_engine_exact(&self) -> bool {
        (self.row.does.is_engine_exact)(self.keys)
    }

    /// Its coefficients for two materials.
    pub(in crate::laws::contact) fn between(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair)
    }
}
