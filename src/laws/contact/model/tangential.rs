//! What the program knows of a tangential sub-model.

use super::{TangentialModel, TangentialRow, numbers};
use crate::laws::contact::batch::Run;
use crate::laws::contact::functions::TangentialFunction;
use crate::laws::contact::{MaterialPair, Missing, Needs, Tangential, batch, functions};
use crate::laws::kept::{Kept, keep, own, read};
use std::any::TypeId;

/// What a tangential model does.
pub struct TangentialFunctions {
    /// Whether there is a spring.
    pub(in crate::laws::contact) has_spring: bool,
    /// Whether there is a dashpot.
    pub(in crate::laws::contact) has_dashpot: bool,
    /// [`Tangential::KEEPS_STIFFNESS`].
    pub(in crate::laws::contact) keeps_stiffness: bool,
    /// [`Tangential::LIMITS_DASHPOT`].
    pub(in crate::laws::contact) limits_dashpot: bool,
    /// [`Tangential::PROJECTS`].
    pub(in crate::laws::contact) projects: bool,
    /// [`Tangential::stretches_backwards`].
    stretches_backwards: fn(Kept, bool) -> bool,
    /// [`Tangential::between`].
    between: fn(Kept, &MaterialPair, bool) -> Result<Vec<f64>, Missing>,
    /// [`Tangential::stiffness`].
    pub(in crate::laws::contact) stiffness: fn(&[f64], f64) -> f64,
    /// [`Tangential::damping`].
    pub(in crate::laws::contact) damping: fn(&[f64], f64) -> f64,
    /// [`Tangential::force`] of one contact.
    pub(in crate::laws::contact) force: TangentialFunction,
    /// What it does to a batch of contacts.
    pub(crate) run: Run,
    /// The same where springs are carried at mid-step.
    pub(crate) run_carried: Run,
}

impl TangentialRow {
    /// The row of a tangential model.
    pub const fn of<M: Tangential>() -> &'static Self {
        const {
            &Self {
                name: M::NAME,
                active: M::ACTIVE,
                count: M::COUNT,
                history: M::HISTORY,
                needs: Needs { torque: M::ACTIVE, ..Needs::NONE },
                form: TypeId::of::<M>,
                keys: TypeId::of::<M::Keys>,
                properties: [M::PAIR_PROPERTIES, M::MATERIAL_PROPERTIES],
                read: read::<M::Keys>,
                does: TangentialFunctions {
                    has_spring: M::HAS_SPRING,
                    has_dashpot: M::HAS_DASHPOT,
                    keeps_stiffness: M::KEEPS_STIFFNESS,
                    limits_dashpot: M::LIMITS_DASHPOT,
                    projects: M::PROJECTS,
                    stretches_backwards: |keys, damped_at_touch| M::stretches_backwards(own(keys), damped_at_touch),
                    between: |keys, pair, damped_at_touch| Ok(numbers(&M::between(pair, own(keys), damped_at_touch)?)),
                    stiffness: |row, from_normal_model| M::read(row).stiffness(from_normal_model),
                    damping: |row, from_normal_model| M::read(row).damping(from_normal_model),
                    force: functions::tangential::<M>,
                    run: batch::tangential::<M, false>,
                    run_carried: if M::HAS_SPRING {
                        batch::tangential::<M, true>
                    } else {
                        batch::tangential::<M, false>
                    },
                },
            }
        }
    }
}

impl TangentialModel {
    /// A tangential model with these keys.
    pub fn of<M: Tangential>(keys: M::Keys) -> Self {
        Self { row: TangentialRow::of::<M>(), keys: keep(keys) }
    }

    /// The same, of keys that live as long as the program.
    pub const fn fixed<M: Tangential>(keys: &'static M::Keys) -> Self {
        Self { row: TangentialRow::of::<M>(), keys }
    }

    /// Whether a dashpot beyond the limit stretches the spring backwards, beside a normal model of this kind.
    pub(in crate::laws::contact) fn stretches_backwards(&self, damped_at_touch: bool) -> bool {
        (self.row.does.stretches_backwards)(self.keys, damped_at_touch)
    }

    /// Its coefficients for two materials, beside a normal model of this kind.
    pub(in crate::laws::contact) fn between(
        &self,
        pair: &MaterialPair,
        damped_at_touch: bool,
    ) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair, damped_at_touch)
    }
}
