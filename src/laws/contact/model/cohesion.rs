//! What the program knows of a cohesion sub-model.

use super::{CohesionModel, CohesionRow, numbers};
use crate::laws::contact::batch::Run;
use crate::laws::contact::functions::CohesionFunction;
use crate::laws::contact::{Coefficients, Cohesion, CohesionForm, MaterialPair, Missing, batch, functions};
#[cfg(test)]
use crate::laws::contact::{Contact, NormalForce};
use crate::laws::kept::{Kept, keep, own, read};
use std::any::TypeId;

/// What a cohesion model does.
pub struct CohesionFunctions {
    /// [`CohesionForm::BEYOND_TOUCH`].
    pub(in crate::laws::contact) beyond_touch: bool,
    /// [`Cohesion::reduces_friction`].
    reduces_friction: fn(Kept) -> bool,
    /// [`Cohesion::between`].
    between: fn(Kept, &MaterialPair) -> Result<Vec<f64>, Missing>,
    /// [`CohesionForm::reach`].
    pub(in crate::laws::contact) reach: fn(&[f64], f64) -> f64,
    /// [`CohesionForm::force`] of one contact.
    #[cfg(test)]
    pub(in crate::laws::contact) force: fn(&[f64], &Contact) -> f64,
    /// [`CohesionForm::add`] to one contact.
    #[cfg(test)]
    pub(in crate::laws::contact) add: fn(&[f64], f64, &mut NormalForce),
    /// [`CohesionForm::pull`] of one contact, added.
    pub(in crate::laws::contact) pull: CohesionFunction,
    /// What it does to a batch of contacts.
    pub(crate) run: Run,
    /// The same where the force is taken from an offset.
    pub(crate) run_from_offset: Run,
}

impl CohesionRow {
    /// The row of a cohesion model.
    pub const fn of<M: Cohesion>() -> &'static Self {
        const {
            &Self {
                name: M::NAME,
                active: M::Form::ACTIVE,
                count: M::Form::COUNT,
                history: M::Form::HISTORY,
                needs: M::Form::NEEDS,
                form: TypeId::of::<M::Form>,
                keys: TypeId::of::<M::Keys>,
                properties: [M::PAIR_PROPERTIES, M::MATERIAL_PROPERTIES],
                read: read::<M::Keys>,
                does: CohesionFunctions {
                    beyond_touch: M::Form::BEYOND_TOUCH,
                    reduces_friction: |keys| M::reduces_friction(own(keys)),
                    between: |keys, pair| Ok(numbers(&M::between(pair, own(keys))?)),
                    reach: |row, radius| M::Form::read(row).reach(radius),
                    #[cfg(test)]
                    force: |row, contact| M::Form::force(M::Form::lanes(row), contact),
                    #[cfg(test)]
                    add: |row, pull, normal| M::Form::add(M::Form::lanes(row), pull, normal),
                    pull: functions::cohesion::<M::Form>,
                    run: batch::cohesion::<M::Form, false>,
                    run_from_offset: batch::cohesion::<M::Form, true>,
                },
            }
        }
    }
}

impl CohesionModel {
    /// A cohesion model with these keys.
    pub fn of<M: Cohesion>(keys: M::Keys) -> Self {
        Self { row: CohesionRow::of::<M>(), keys: keep(keys) }
    }

    /// The same, of keys that live as long as the program.
    pub const fn fixed<M: Cohesion>(keys: &'static M::Keys) -> Self {
        Self { row: CohesionRow::of::<M>(), keys }
    }

    /// Whether its keys let friction see the attraction.
    pub(in crate::laws::contact) fn reduces_friction(&self) -> bool {
        (self.row.does.reduces_friction)(self.keys)
    }

    /// Its coefficients for two materials.
    pub(in crate::laws::contact) fn between(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair)
    }
}
