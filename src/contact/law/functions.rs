//! Each sub-model as functions of a row of coefficients: what a law keeps of it.

use crate::contact::{
    Adhesion, Coefficients, Cohesion, CohesionForm, Contact, HistoryRow, Needs, Normal, NormalForce, NormalForm, Onset,
    Response, Rolling, RollingStiffness, Switches, Tangential, cohesion::TakeCohesion, normal::TakeNormal,
    rolling::TakeRolling, tangential::TakeTangential,
};
use crate::number::{Row, Vector};

/// Normal force of coefficients, contact, history and step; the history goes on, where there is one.
pub(super) type NormalFunction = fn(&[f64], &Contact, &mut Row, f64) -> NormalForce;

/// Friction of coefficients, contact, normal force, history and step, and whether it is at its limit; the history goes on.
pub(super) type TangentialFunction = fn(&[f64], &Contact, &NormalForce, &mut Row, f64) -> (Vector, bool);

/// Rolling torque of coefficients, contact, normal force, history and step; the history goes on.
pub(super) type RollingFunction = fn(&[f64], &Contact, &NormalForce, &mut Row, f64) -> Vector;

/// Adds the attraction of coefficients and contact to a normal force.
pub(super) type CohesionFunction = fn(&[f64], &Contact, &mut NormalForce);

/// [`NormalForm::force`] of one contact.
#[inline(always)]
pub(super) fn normal<A: NormalForm>(row: &[f64], contact: &Contact, history: &mut Row, step: f64) -> NormalForce {
    let roots = A::roots(contact.overlap, contact.radius, contact.mass);
    let switches = Switches::lanes(&row[A::COUNT..]);
    let before = if A::HISTORY.is_some() { *history } else { [0.0; 4] };
    let (force, after) = A::force(A::lanes(row), switches, contact, roots, before, step);
    if A::HISTORY.is_some() {
        *history = after;
    }
    force
}

/// [`Tangential::force`] of one contact.
#[inline(always)]
pub(super) fn tangential<B: Tangential>(
    row: &[f64],
    contact: &Contact,
    normal: &NormalForce,
    history: &mut Row,
    step: f64,
) -> (Vector, bool) {
    let friction = B::force(B::lanes(row), contact, normal, *history, step);
    *history = friction.history;
    (friction.force, friction.sliding)
}

/// [`Rolling::torque`] of one contact.
#[inline(always)]
pub(super) fn rolling<C: Rolling>(
    row: &[f64],
    contact: &Contact,
    normal: &NormalForce,
    history: &mut Row,
    step: f64,
) -> Vector {
    let (torque, after) = C::torque(C::lanes(row), contact, normal, *history, step);
    *history = after;
    torque
}

/// [`CohesionForm::force`] of one contact, added.
#[inline(always)]
pub(super) fn cohesion<D: CohesionForm>(row: &[f64], contact: &Contact, normal: &mut NormalForce) {
    let law = D::lanes(row);
    D::add(law, D::force(law, contact), normal);
}

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
            force: normal::<A>,
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
    pub(super) force: TangentialFunction,
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
            force: tangential::<B>,
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
            torque: rolling::<C>,
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
    #[cfg(test)]
    pub(super) force: fn(&[f64], &Contact) -> f64,
    /// [`CohesionForm::add`].
    #[cfg(test)]
    pub(super) add: fn(&[f64], f64, &mut NormalForce),
    /// Both.
    pub(super) pull: CohesionFunction,
}

impl CohesionModel {
    /// That of a form.
    fn of<D: CohesionForm>() -> Self {
        Self {
            count: D::COUNT,
            active: D::ACTIVE,
            needs: D::NEEDS,
            #[cfg(test)]
            force: |row, contact| D::force(D::lanes(row), contact),
            #[cfg(test)]
            add: |row, pull, normal| D::add(D::lanes(row), pull, normal),
            pull: cohesion::<D>,
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
