//! Sub-models of one contact, as functions of a row of coefficients.

use super::{Coefficients, CohesionForm, Contact, NormalForce, NormalForm, Rolling, Switches, Tangential};
use crate::base::number::{Row, Vector};

/// Normal force of coefficients with the switches behind them, contact, history and step; the history goes on, where there is one.
pub(super) type NormalFunction = fn(&[f64], &Contact, &mut Row, f64) -> NormalForce;

/// Friction of coefficients, contact, normal force, history and step, and whether it is at its limit; the history goes on.
pub(super) type TangentialFunction = fn(&[f64], &Contact, &NormalForce, &mut Row, f64) -> (Vector, bool);

/// Rolling torque of coefficients, contact, normal force, history and step; the history goes on.
pub(super) type RollingFunction = fn(&[f64], &Contact, &NormalForce, &mut Row, f64) -> Vector;

/// Adds the attraction of coefficients, contact, history and step to a normal force; the history goes on, where there is one.
pub(super) type CohesionFunction = fn(&[f64], &Contact, &mut Row, f64, &mut NormalForce);

/// [`NormalForm::force`] of one contact.
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

/// [`CohesionForm::pull`] of one contact, added.
pub(super) fn cohesion<D: CohesionForm>(
    row: &[f64],
    contact: &Contact,
    history: &mut Row,
    step: f64,
    normal: &mut NormalForce,
) {
    let law = D::lanes(row);
    if D::BEYOND_TOUCH {
        *normal = normal.in_touch(contact.overlap);
    }
    let (pull, after) = D::pull(law, contact, *history, step);
    if D::HISTORY.is_some() {
        *history = after;
    }
    D::add(law, pull, normal);
}
