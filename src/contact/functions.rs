//! Each sub-model as functions of a row of coefficients: what a law keeps of it.

use super::cohesion::TakeCohesion;
use super::normal::TakeNormal;
use super::rolling::TakeRolling;
use super::tangential::TakeTangential;
use super::{
    Adhesion, Cohesion, CohesionForm, Contact, Friction, HistoryRow, Needs, Normal, NormalForce, NormalForm, Onset,
    Response, Rolling, RollingStiffness, Switches, Tangential,
};
use crate::number::{Row, Vector};

/// Normal force of coefficients, switches, contact, history and step, and what is to be remembered.
type NormalFunction = fn(&[f64], Switches, &Contact, Row, f64) -> (NormalForce, Row);

/// Rolling torque of coefficients, contact, normal force, history and step, and what is to be remembered.
type RollingFunction = fn(&[f64], &Contact, &NormalForce, Row, f64) -> (Vector, Row);

/// A normal model as functions of its coefficients.
#[derive(Clone, Copy)]
pub(super) struct NormalModel {
    /// How many coefficients it has.
    pub(super) count: usize,
    /// What it remembers.
    pub(super) history: Option<HistoryRow>,
    /// What of a contact it looks at.
    pub(super) needs: Needs,
    /// Whether it pulls.
    pub(super) adhesion: Adhesion,
    /// Whether slip is that of the undeformed bodies.
    pub(super) undeformed_arms: bool,
    /// How its dashpots begin.
    pub(super) onset: Onset,
    /// Whether it keeps a number of each pair.
    pub(super) has_pair_constant: bool,
    /// [`NormalForm::force`].
    pub(super) force: NormalFunction,
    /// [`NormalForm::response`].
    pub(super) response: fn(&[f64], &Contact) -> Response,
    /// [`NormalForm::pair_constant`].
    pub(super) pair_constant: fn(&[f64], f64, f64) -> f64,
    /// [`NormalForm::elastic_energy`].
    pub(super) elastic_energy: fn(&[f64], &Contact, f64, Row) -> f64,
    /// [`NormalForm::reach`].
    pub(super) reach: fn(&[f64], f64) -> f64,
    /// [`NormalForm::tangent_stiffness`].
    pub(super) tangent_stiffness: fn(&[f64], &Contact) -> f64,
}

impl NormalModel {
    /// That of a form.
    fn of<A: NormalForm>(undeformed_arms: bool, onset: Onset) -> Self {
        Self {
            count: A::COUNT,
            history: A::HISTORY,
            needs: A::NEEDS,
            adhesion: A::ADHESION,
            undeformed_arms,
            onset,
            has_pair_constant: A::HAS_PAIR_CONSTANT,
            force: |row, switches, contact, history, step| {
                let roots = A::roots(contact.overlap, contact.radius, contact.mass);
                A::force(A::lanes(row), switches, contact, roots, history, step)
            },
            response: |row, contact| A::response(A::lanes(row), contact),
            pair_constant: |row, radius, mass| A::read(row).pair_constant(radius, mass),
            elastic_energy: |row, contact, offset, history| A::read(row).elastic_energy(contact, offset, history),
            reach: |row, radius| A::read(row).reach(radius),
            tangent_stiffness: |row, contact| A::read(row).tangent_stiffness(contact),
        }
    }
}

/// A tangential model as functions of its coefficients.
#[derive(Clone, Copy)]
pub(super) struct TangentialModel {
    /// How many coefficients it has.
    pub(super) count: usize,
    /// Whether there is a force at all.
    pub(super) active: bool,
    /// What it remembers.
    pub(super) history: Option<HistoryRow>,
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
    /// [`Tangential::stiffness`].
    pub(super) stiffness: fn(&[f64], f64) -> f64,
    /// [`Tangential::force`].
    pub(super) force: fn(&[f64], &Contact, &NormalForce, Row, f64) -> Friction,
}

impl TangentialModel {
    /// That of a model.
    fn of<B: Tangential>() -> Self {
        Self {
            count: B::COUNT,
            active: B::ACTIVE,
            history: B::HISTORY,
            has_spring: B::HAS_SPRING,
            has_dashpot: B::HAS_DASHPOT,
            keeps_stiffness: B::KEEPS_STIFFNESS,
            limits_dashpot: B::LIMITS_DASHPOT,
            projects: B::PROJECTS,
            stiffness: |row, from_normal_model| B::read(row).stiffness(from_normal_model),
            force: |row, contact, normal, history, step| B::force(B::lanes(row), contact, normal, history, step),
        }
    }
}

/// A rolling model as functions of its coefficients.
#[derive(Clone, Copy)]
pub(super) struct RollingModel {
    /// How many coefficients it has.
    pub(super) count: usize,
    /// Whether there is a torque at all.
    pub(super) active: bool,
    /// What it remembers.
    pub(super) history: Option<HistoryRow>,
    /// What of a contact it looks at.
    pub(super) needs: Needs,
    /// [`Rolling::stiffness`].
    pub(super) stiffness: fn(&[f64], &Contact, &Response) -> RollingStiffness,
    /// [`Rolling::elastic_energy`].
    pub(super) elastic_energy: fn(&[f64], &Contact, &Response, Row) -> f64,
    /// [`Rolling::torque`].
    pub(super) torque: RollingFunction,
}

impl RollingModel {
    /// That of a model.
    fn of<C: Rolling>() -> Self {
        Self {
            count: C::COUNT,
            active: C::ACTIVE,
            history: C::HISTORY,
            needs: C::NEEDS,
            stiffness: |row, contact, response| C::read(row).stiffness(contact, response),
            elastic_energy: |row, contact, response, history| C::read(row).elastic_energy(contact, response, history),
            torque: |row, contact, normal, history, step| C::torque(C::lanes(row), contact, normal, history, step),
        }
    }
}

/// A cohesion model as functions of its coefficients.
#[derive(Clone, Copy)]
pub(super) struct CohesionModel {
    /// How many coefficients it has.
    pub(super) count: usize,
    /// Whether there is a force at all.
    pub(super) active: bool,
    /// What of a contact it looks at.
    pub(super) needs: Needs,
    /// [`CohesionForm::force`].
    pub(super) force: fn(&[f64], &Contact) -> f64,
    /// [`CohesionForm::add`].
    pub(super) add: fn(&[f64], f64, &mut NormalForce),
}

impl CohesionModel {
    /// That of a form.
    fn of<D: CohesionForm>() -> Self {
        Self {
            count: D::COUNT,
            active: D::ACTIVE,
            needs: D::NEEDS,
            force: |row, contact| D::force(D::lanes(row), contact),
            add: |row, pull, normal| D::add(D::lanes(row), pull, normal),
        }
    }
}

/// Goes from the name of a sub-model to its functions.
#[derive(Clone, Copy)]
pub(super) struct Functions;

impl TakeNormal for Functions {
    type Output = NormalModel;
    fn take<M: Normal>(self, keys: &M::Keys) -> NormalModel {
        NormalModel::of::<M::Form>(M::has_undeformed_arms(keys), M::ONSET)
    }
}

impl TakeTangential for Functions {
    type Output = TangentialModel;
    fn take<M: Tangential>(self, _keys: &M::Keys) -> TangentialModel {
        TangentialModel::of::<M>()
    }
}

impl TakeRolling for Functions {
    type Output = RollingModel;
    fn take<M: Rolling>(self, _keys: &M::Keys) -> RollingModel {
        RollingModel::of::<M>()
    }
}

impl TakeCohesion for Functions {
    type Output = CohesionModel;
    fn take<M: Cohesion>(self, _keys: &M::Keys) -> CohesionModel {
        CohesionModel::of::<M::Form>()
    }
}
