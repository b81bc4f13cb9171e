//! Forces and torques between touching bodies: pure functions of one contact and its own history.
//!
//! A contact law is composed of four sub-models for forces (normal, tangential, rolling, cohesion) and one for heat. Each is one file
//! and one row in the list beside it. They are written over [`Number`], so the same source runs one
//! contact at a time or several in a vector register. No sub-model knows which others it is combined with: they
//! hand each other a [`NormalForce`], and each of them stores its history of a contact in a row of its own ([`HistoryRow`]).
//!
//! Signs: the normal points from body j to body i; a positive normal force pushes i along it. The
//! relative velocity is that of i seen from j; the normal velocity is negative while they approach.

pub(crate) mod batch;
mod choice;
mod coefficients;
pub mod cohesion;
#[cfg(test)]
pub(crate) mod fixtures;
mod functions;
pub mod heat;
pub(crate) mod impact;
mod law;
mod losses;
mod material;
mod model;
pub mod normal;
mod places;
pub mod property;
pub mod rolling;
mod scheme;
mod sub_model;
pub mod tangential;

pub use batch::SLIDING;
pub use choice::{LawChoice, remembered};
pub use coefficients::Coefficients;
pub(crate) use coefficients::coefficients;
#[cfg(test)]
pub use law::Offset;
pub use law::{Law, OFFSET};
pub(crate) use losses::parting;
pub use losses::{Booked, LossKind, Seen, Warming};
pub use material::{Material, MaterialPair, Missing, Thermal};
pub use model::{
    CohesionFunctions, CohesionModel, CohesionRow, HeatFunctions, HeatModel, HeatRow, Model, ModelRow, NormalFunctions,
    NormalModel, NormalRow, RollingFunctions, RollingModel, RollingRow, TangentialFunctions, TangentialModel,
    TangentialRow,
};
pub use places::{CoefficientPlaces, HistoryPlaces};
pub use property::{Properties, Property, PropertyUnit};
pub use scheme::{Carry, Foreseen, Scheme, SchemeMemory, foresee_normal};
pub(crate) use sub_model::pressing_force;
pub use sub_model::{
    Cohesion, CohesionForm, FrictionNeeds, Heat, Normal, NormalForm, Rolling, RollingResponse, Tangential,
};

pub use crate::laws::kept::ModelKeys;

use crate::base::number::{Number, Row, Vector};
use serde::Deserialize;

/// Geometry and relative motion of one contact.
#[derive(Clone, Copy, Debug)]
pub struct Contact<N = f64> {
    /// Overlap δ; below 0 only where a normal or cohesion model holds bodies together beyond touch \[m\].
    pub overlap: N,
    /// Effective radius R*: R_i R_j/(R_i + R_j) of two spheres, R_i at a wall \[m\].
    pub radius: N,
    /// Effective mass m*: m_i m_j/(m_i + m_j) of two spheres, m_i at a wall \[kg\].
    pub mass: N,
    /// Area of the circle in which the undeformed bodies intersect \[m²\].
    pub section_area: N,
    /// Radius in the linearised section area 2π · radius · δ: 2 R* of two spheres, R_i at a wall \[m\].
    pub section_radius: N,
    /// Unit normal, from j to i.
    pub normal: Vector<N>,
    /// Relative velocity along the normal, negative while approaching \[m/s\].
    pub normal_velocity: N,
    /// Velocity of i over j at the point of contact, in the tangent plane \[m/s\].
    pub slip: Vector<N>,
    /// Angular velocity of i less that of j \[rad/s\].
    pub relative_spin: Vector<N>,
    /// Angular velocity of i and that of j together \[rad/s\].
    pub spin_sum: Vector<N>,
    /// Angular velocities times the arms, of i and j together \[m/s\].
    pub turning: Vector<N>,
    /// 1/distance of the centres of two spheres, 0 at a wall \[1/m\].
    pub per_distance: N,
    /// 1/(R_i + R_j) of two spheres, 0 at a wall \[1/m\].
    pub per_reach: N,
    /// p q/(p + q), p = m_i R_i², q = m_j R_j², of two spheres; m_i R_i² at a wall \[kg m²\].
    pub rolling_inertia: N,
    /// Constant of effective radius and mass, computed when the pair was found: how far the law holds it together beyond touch, or
    /// [`NormalForm::pair_constant`].
    pub pair_constant: N,
}

impl<N: Number> Contact<N> {
    /// One of nothing: tests of a law say what it looks at.
    pub fn zero() -> Self {
        let (zero, none) = (N::zero(), Vector::zero());
        Self {
            overlap: zero,
            radius: zero,
            mass: zero,
            section_area: zero,
            section_radius: zero,
            normal: none,
            normal_velocity: zero,
            slip: none,
            relative_spin: none,
            spin_sum: none,
            turning: none,
            per_distance: zero,
            per_reach: zero,
            rolling_inertia: zero,
            pair_constant: zero,
        }
    }

    /// The contact with the slip that arms R instead of R − δ/2 give.
    #[inline(always)]
    pub fn with_undeformed_arms(&self) -> Self {
        let missing = self.spin_sum * (N::splat(0.5) * self.overlap);
        Self { slip: self.slip - missing.cross(self.normal), turning: self.turning + missing, ..*self }
    }
}

/// Which values of a contact a sub-model uses, beyond overlap, effective radius and mass, normal and normal velocity. A
/// value that no sub-model of a law uses is not computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Slip; there are torques.
    pub torque: bool,
    /// [`Contact::relative_spin`].
    pub spin: bool,
    /// [`Contact::section_area`] and [`Contact::section_radius`].
    pub section: bool,
    /// [`Contact::per_reach`] and [`Contact::rolling_inertia`].
    pub bodies: bool,
    /// [`Contact::spin_sum`].
    pub spin_sum: bool,
    /// [`Contact::turning`] and [`Contact::per_distance`]; slip even without torques.
    pub carry: bool,
}

impl Needs {
    /// Nothing.
    pub const NONE: Self =
        Self { torque: false, spin: false, section: false, bodies: false, spin_sum: false, carry: false };

    /// Whether any value is used that few laws look at.
    pub fn rare(self) -> bool {
        self.bodies || self.spin_sum || self.carry
    }

    /// The others.
    #[inline(always)]
    pub fn without_rare(self) -> Self {
        Self { bodies: false, spin_sum: false, carry: false, ..self }
    }

    /// The values that at least one of two uses.
    pub fn and(self, other: Self) -> Self {
        Self {
            torque: self.torque || other.torque,
            spin: self.spin || other.spin,
            section: self.section || other.section,
            bodies: self.bodies || other.bodies,
            spin_sum: self.spin_sum || other.spin_sum,
            carry: self.carry || other.carry,
        }
    }
}

/// How the damping coefficient of a contact begins, as a power of the overlap: what the first force of a dashpot stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Onset {
    /// Nothing is weighed: the contact may begin and end away from touch.
    Unweighed,
    /// A constant.
    Constant,
    /// The fourth root.
    FourthRoot,
    /// The square root.
    SquareRoot,
}

/// Whether a normal model pulls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adhesion {
    /// It does not, except for its dashpot at the end of a contact.
    None,
    /// While the bodies touch.
    InTouch,
    /// Also beyond touch, once they have touched: up to [`NormalForm::reach`].
    BeyondTouch,
}

/// The result of [`NormalForm::roots`].
pub type Roots<N> = [N; 2];

/// Stiffnesses and damping coefficients of a contact, by its normal model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response<N = f64> {
    /// k_n in the normal force k_n δ − γ_n v_n \[N/m\].
    pub normal_stiffness: N,
    /// γ_n \[kg/s\].
    pub normal_damping: N,
    /// k_t of the tangential spring \[N/m\].
    pub tangential_stiffness: N,
    /// γ_t \[kg/s\].
    pub tangential_damping: N,
}

impl Response {
    /// Of nothing.
    pub(crate) const NONE: Self =
        Self { normal_stiffness: 0.0, normal_damping: 0.0, tangential_stiffness: 0.0, tangential_damping: 0.0 };
}

/// Results of the normal model, and of cohesion after it, for the other sub-models.
#[derive(Clone, Copy, Debug)]
pub struct NormalForce<N = f64> {
    /// Stiffnesses and damping coefficients at the contact.
    pub response: Response<N>,
    /// Force along the normal on i \[N\].
    pub force: N,
    /// The part of it from which friction and rolling take their limits \[N\].
    pub seen: N,
}

impl<N: Number> NormalForce<N> {
    /// What is left of it at this overlap \[m\] where it acts in touch alone: below 0, nothing.
    #[inline(always)]
    pub(crate) fn in_touch(&self, overlap: N) -> Self {
        let (apart, zero) = (N::zero().greater(overlap), N::zero());
        let Self { response, force, seen } = *self;
        Self {
            response: Response {
                normal_stiffness: N::select(apart, zero, response.normal_stiffness),
                normal_damping: N::select(apart, zero, response.normal_damping),
                tangential_stiffness: N::select(apart, zero, response.tangential_stiffness),
                tangential_damping: N::select(apart, zero, response.tangential_damping),
            },
            force: N::select(apart, zero, force),
            seen: N::select(apart, zero, seen),
        }
    }
}

/// Friction of one contact.
#[derive(Clone, Copy, Debug)]
pub struct Friction<N: Number = f64> {
    /// Force on i in the tangent plane \[N\].
    pub force: Vector<N>,
    /// The new history.
    pub history: [N; 4],
    /// Whether it is at its limit.
    pub sliding: N::Mask,
}

/// Rows that a law remembers of a contact at most: one each of its four sub-models and of the scheme, one of records, two of a
/// book of losses, one of what it holds, and two of single impacts.
pub const MOST_HISTORY: usize = 11;

/// The history that a sub-model stores of a contact from one evaluation to the next: a row of four numbers, zero at first
/// touch and removed with the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HistoryRow {
    /// What it is.
    pub name: &'static str,
    /// Which of the four numbers change sign when the two bodies change places.
    pub odd: [bool; 4],
    /// Whether the fourth number is none of its own and handed on as it is, so that a scheme may keep there what does not
    /// change sign.
    pub fourth_is_free: bool,
}

impl HistoryRow {
    /// The row as the other body sees it.
    #[inline(always)]
    pub fn reversed(&self, row: Row) -> Row {
        [0, 1, 2, 3].map(|place| if self.odd[place] { -row[place] } else { row[place] })
    }
}

coefficients! {
    /// Switches that every normal model takes, as numbers so that the loop has no branch.
    pub struct Switches {
        /// Lower bound of the normal force \[N\]: −∞, or 0 with `limit_force`.
        least_force,
        /// Factor on γ_t: 1, or 0 without `tangential_damping`.
        tangential_damping_factor,
    }
}

impl Switches {
    /// With or without an attractive end of contact, with or without tangential damping.
    pub fn of(limit_force: bool, tangential_damping: bool) -> Self {
        Self::new(if limit_force { 0.0 } else { f64::NEG_INFINITY }, if tangential_damping { 1.0 } else { 0.0 })
    }

    /// Whether the normal force is limited so that it never pulls.
    pub fn limits_force(&self) -> bool {
        self.least_force == 0.0
    }

    /// Whether γ_t acts.
    pub fn damps_slip(&self) -> bool {
        self.tangential_damping_factor != 0.0
    }
}

/// A sub-model without keys of its own: `[contact.<law>.<kind>.<model>]` stays empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoKeys {}

/// Why sub-models and switches cannot be combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Objection {
    /// The table of the key below `[contact.<law>]`: empty, or the kind of sub-model.
    pub table: &'static str,
    /// The key to change.
    pub key: &'static str,
    /// What was found and what was expected.
    pub reason: &'static str,
}

/// Force and torques of one contact on its two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction<N: Number = f64> {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<N>,
    /// n × F_t, which turns both bodies against their arms \[N\].
    pub couple: Vector<N>,
    /// Rolling torque taken from i and given to j \[N m\].
    pub rolling: Vector<N>,
    /// Whether friction is at its limit.
    pub sliding: N::Mask,
}
