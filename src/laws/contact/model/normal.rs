//! What the program knows of a normal sub-model.

use super::{NormalModel, NormalRow, numbers};
use crate::base::number::Row;
use crate::laws::contact::batch::Run;
use crate::laws::contact::functions::NormalFunction;
use crate::laws::contact::{
    Adhesion, Coefficients, Contact, FrictionNeeds, MaterialPair, Missing, Normal, NormalForm, Objection, Onset,
    Response, batch, functions,
};
use crate::laws::kept::{Kept, keep, own, read};
use std::any::TypeId;

/// What a normal model does.
pub struct NormalFunctions {
    /// Whether it pulls.
    pub(in crate::laws::contact) adhesion: Adhesion,
    /// [`NormalForm::LIMITS_ITSELF`].
    pub(in crate::laws::contact) limits_itself: bool,
    /// [`Normal::onset`].
    onset: fn(Kept) -> Onset,
    /// [`Normal::DAMPED_AT_TOUCH`].
    pub(in crate::laws::contact) damped_at_touch: bool,
    /// Whether it keeps a number of each pair.
    pub(in crate::laws::contact) has_pair_constant: bool,
    /// [`Normal::objection`].
    objection: fn(Kept) -> Option<Objection>,
    /// [`Normal::has_undeformed_arms`].
    has_undeformed_arms: fn(Kept) -> bool,
    /// [`Normal::between`].
    between: fn(Kept, &MaterialPair, FrictionNeeds) -> Result<Vec<f64>, Missing>,
    /// [`NormalForm::force`] of one contact.
    pub(in crate::laws::contact) force: NormalFunction,
    /// [`NormalForm::response`] of one contact.
    pub(in crate::laws::contact) response: fn(&[f64], &Contact) -> Response,
    /// [`NormalForm::pair_constant`].
    pub(in crate::laws::contact) pair_constant: fn(&[f64], f64, f64) -> f64,
    /// [`NormalForm::elastic_energy`].
    pub(in crate::laws::contact) elastic_energy: fn(&[f64], &Contact, f64, Row) -> f64,
    /// [`NormalForm::reach`].
    pub(in crate::laws::contact) reach: fn(&[f64], f64) -> f64,
    /// [`NormalForm::tangent_stiffness`].
    pub(in crate::laws::contact) tangent_stiffness: fn(&[f64], &Contact) -> f64,
    /// [`Normal::ELASTIC_SPHERES`].
    pub(crate) elastic_spheres: bool,
    /// [`NormalForm::contact_radius`].
    pub(crate) contact_radius: fn(&[f64], f64, f64) -> f64,
    /// The same of a batch of contacts.
    pub(crate) run_contact_radius: Run,
    /// What it does to a batch of contacts.
    pub(crate) run: Run,
    /// The same where the force is taken from an offset.
    pub(crate) run_from_offset: Run,
}

impl NormalFunctions {
    /// Whether it pulls.
    pub(crate) fn adhesion(&self) -> Adhesion {
        self.adhesion
    }
}

impl NormalRow {
    /// The row of a normal model.
    pub const fn of<M: Normal>() -> &'static Self {
        const {
            &Self {
                name: M::NAME,
                active: true,
                count: M::Form::COUNT,
                history: M::Form::HISTORY,
                needs: M::Form::NEEDS,
                form: TypeId::of::<M::Form>,
                keys: TypeId::of::<M::Keys>,
                properties: [M::PAIR_PROPERTIES, M::MATERIAL_PROPERTIES],
                read: read::<M::Keys>,
                does: NormalFunctions {
                    adhesion: M::Form::ADHESION,
                    limits_itself: M::Form::LIMITS_ITSELF,
                    onset: |keys| M::onset(own(keys)),
                    damped_at_touch: M::DAMPED_AT_TOUCH,
                    has_pair_constant: M::Form::HAS_PAIR_CONSTANT,
                    objection: |keys| M::objection(own(keys)),
                    has_undeformed_arms: |keys| M::has_undeformed_arms(own(keys)),
                    between: |keys, pair, friction| Ok(numbers(&M::between(pair, own(keys), friction)?)),
                    force: functions::normal::<M::Form>,
                    response: |row, contact| M::Form::response(M::Form::lanes(row), contact),
                    pair_constant: |row, radius, mass| M::Form::read(row).pair_constant(radius, mass),
                    elastic_energy: |row, contact, offset, history| {
                        M::Form::read(row).elastic_energy(contact, offset, history)
                    },
                    reach: |row, radius| M::Form::read(row).reach(radius),
                    tangent_stiffness: |row, contact| M::Form::read(row).tangent_stiffness(contact),
                    elastic_spheres: M::ELASTIC_SPHERES,
                    contact_radius: |row, overlap, radius| {
                        M::Form::contact_radius(M::Form::lanes(row), overlap, radius)
                    },
                    run_contact_radius: batch::contact_radius::<M::Form>,
                    run: batch::normal::<M::Form, false>,
                    run_from_offset: batch::normal::<M::Form, true>,
                },
            }
        }
    }
}

impl NormalModel {
    /// A normal model with these keys.
    pub fn of<M: Normal>(keys: M::Keys) -> Self {
        Self { row: NormalRow::of::<M>(), keys: keep(keys) }
    }

    /// The same, of keys that live as long as the program.
    pub const fn fixed<M: Normal>(keys: &'static M::Keys) -> Self {
        Self { row: NormalRow::of::<M>(), keys }
    }

    /// What speaks against its keys, if anything.
    pub(in crate::laws::contact) fn objection(&self) -> Option<Objection> {
        (self.row.does.objection)(self.keys)
    }

    /// How its dashpots begin.
    pub(in crate::laws::contact) fn onset(&self) -> Onset {
        (self.row.does.onset)(self.keys)
    }

    /// Whether slip is that of the undeformed bodies, and torques at walls have their arms.
    pub(in crate::laws::contact) fn has_undeformed_arms(&self) -> bool {
        (self.row.does.has_undeformed_arms)(self.keys)
    }

    /// Its coefficients for two materials, beside friction that takes this.
    pub(in crate::laws::contact) fn between(
        &self,
        pair: &MaterialPair,
        friction: FrictionNeeds,
    ) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair, friction)
    }
}
