//! What the program knows of a sub-model: one static row for each, made from its type. A law that a scene composes is four of
//! them with their keys.

use super::batch::{self, Run};
use super::functions::{self, CohesionFunction, NormalFunction, RollingFunction, TangentialFunction};
use super::heat::Spot;
use super::{
    Adhesion, Coefficients, Cohesion, CohesionForm, Contact, FrictionNeeds, Heat, HistoryRow, MaterialPair, Missing,
    Needs, Normal, NormalForm, Objection, Onset, Property, Response, Rolling, RollingResponse, Tangential,
};
use crate::base::document::{Document, Faults};
use crate::base::number::Row;
use crate::laws::kept::{Kept, ModelKeys, keep, of_kind, own, read};
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

/// What a normal model does.
pub struct NormalFunctions {
    /// Whether it pulls.
    pub(super) adhesion: Adhesion,
    /// [`NormalForm::LIMITS_ITSELF`].
    pub(super) limits_itself: bool,
    /// [`Normal::onset`].
    onset: fn(Kept) -> Onset,
    /// [`Normal::DAMPED_AT_TOUCH`].
    pub(super) damped_at_touch: bool,
    /// Whether it keeps a number of each pair.
    pub(super) has_pair_constant: bool,
    /// [`Normal::objection`].
    objection: fn(Kept) -> Option<Objection>,
    /// [`Normal::has_undeformed_arms`].
    has_undeformed_arms: fn(Kept) -> bool,
    /// [`Normal::between`].
    between: fn(Kept, &MaterialPair, FrictionNeeds) -> Result<Vec<f64>, Missing>,
    /// [`NormalForm::force`] of one contact.
    pub(super) force: NormalFunction,
    /// [`NormalForm::response`] of one contact.
    pub(super) response: fn(&[f64], &Contact) -> Response,
    /// [`NormalForm::pair_constant`].
    pub(super) pair_constant: fn(&[f64], f64, f64) -> f64,
    /// [`NormalForm::elastic_energy`].
    pub(super) elastic_energy: fn(&[f64], &Contact, f64, Row) -> f64,
    /// [`NormalForm::reach`].
    pub(super) reach: fn(&[f64], f64) -> f64,
    /// [`NormalForm::tangent_stiffness`].
    pub(super) tangent_stiffness: fn(&[f64], &Contact) -> f64,
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
    pub(super) fn objection(&self) -> Option<Objection> {
        (self.row.does.objection)(self.keys)
    }

    /// How its dashpots begin.
    pub(super) fn onset(&self) -> Onset {
        (self.row.does.onset)(self.keys)
    }

    /// Whether slip is that of the undeformed bodies, and torques at walls have their arms.
    pub(super) fn has_undeformed_arms(&self) -> bool {
        (self.row.does.has_undeformed_arms)(self.keys)
    }

    /// Its coefficients for two materials, beside friction that takes this.
    pub(super) fn between(&self, pair: &MaterialPair, friction: FrictionNeeds) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair, friction)
    }
}

/// What a tangential model does.
pub struct TangentialFunctions {
    /// Whether there is a spring.
    pub(super) has_spring: bool,
    /// Whether there is a dashpot.
    pub(super) has_dashpot: bool,
    /// [`Tangential::KEEPS_STIFFNESS`].
    pub(super) keeps_stiffness: bool,
    /// [`Tangential::LIMITS_DASHPOT`].
    pub(super) limits_dashpot: bool,
    /// [`Tangential::PROJECTS`].
    pub(super) projects: bool,
    /// [`Tangential::stretches_backwards`].
    stretches_backwards: fn(Kept, bool) -> bool,
    /// [`Tangential::between`].
    between: fn(Kept, &MaterialPair, bool) -> Result<Vec<f64>, Missing>,
    /// [`Tangential::stiffness`].
    pub(super) stiffness: fn(&[f64], f64) -> f64,
    /// [`Tangential::damping`].
    pub(super) damping: fn(&[f64], f64) -> f64,
    /// [`Tangential::force`] of one contact.
    pub(super) force: TangentialFunction,
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
    pub(super) fn stretches_backwards(&self, damped_at_touch: bool) -> bool {
        (self.row.does.stretches_backwards)(self.keys, damped_at_touch)
    }

    /// Its coefficients for two materials, beside a normal model of this kind.
    pub(super) fn between(&self, pair: &MaterialPair, damped_at_touch: bool) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair, damped_at_touch)
    }
}

/// What a rolling model does.
pub struct RollingFunctions {
    /// Whether it takes k_n δ for the force that presses.
    pub(super) takes_overlap: bool,
    /// Whether it takes k_t.
    pub(super) takes_tangential_stiffness: bool,
    /// [`Rolling::is_engine_exact`].
    is_engine_exact: fn(Kept) -> bool,
    /// [`Rolling::between`].
    between: fn(Kept, &MaterialPair) -> Result<Vec<f64>, Missing>,
    /// [`Rolling::response`].
    pub(super) response: fn(&[f64], &Contact, &Response) -> RollingResponse,
    /// [`Rolling::elastic_energy`].
    pub(super) elastic_energy: fn(&[f64], &Contact, &Response, Row) -> f64,
    /// [`Rolling::torque`] of one contact.
    pub(super) torque: RollingFunction,
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

    /// Whether its keys keep the direction of the torque as the engine does.
    pub(super) fn is_engine_exact(&self) -> bool {
        (self.row.does.is_engine_exact)(self.keys)
    }

    /// Its coefficients for two materials.
    pub(super) fn between(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair)
    }
}

/// What a cohesion model does.
pub struct CohesionFunctions {
    /// [`CohesionForm::BEYOND_TOUCH`].
    pub(super) beyond_touch: bool,
    /// [`Cohesion::reduces_friction`].
    reduces_friction: fn(Kept) -> bool,
    /// [`Cohesion::between`].
    between: fn(Kept, &MaterialPair) -> Result<Vec<f64>, Missing>,
    /// [`CohesionForm::reach`].
    pub(super) reach: fn(&[f64], f64) -> f64,
    /// [`CohesionForm::force`] of one contact.
    #[cfg(test)]
    pub(super) force: fn(&[f64], &Contact) -> f64,
    /// [`CohesionForm::add`] to one contact.
    #[cfg(test)]
    pub(super) add: fn(&[f64], f64, &mut super::NormalForce),
    /// [`CohesionForm::pull`] of one contact, added.
    pub(super) pull: CohesionFunction,
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
    pub(super) fn reduces_friction(&self) -> bool {
        (self.row.does.reduces_friction)(self.keys)
    }

    /// Its coefficients for two materials.
    pub(super) fn between(&self, pair: &MaterialPair) -> Result<Vec<f64>, Missing> {
        (self.row.does.between)(self.keys, pair)
    }
}

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
