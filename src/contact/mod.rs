//! What touching bodies do to each other: pure functions of one contact and its own history.
//!
//! A contact law is composed of four sub-models: normal, tangential, rolling, cohesion. Each is one file
//! and one row in the list beside it. They are written over [`Number`], so the same source runs one
//! contact at a time or several in a vector register. No sub-model knows which others it is combined with: they
//! hand each other a [`NormalForce`], and what each of them remembers of a contact is a row of its own ([`HistoryRow`]).
//!
//! Signs: the normal points from body j to body i; a positive normal force pushes i along it. The
//! relative velocity is that of i seen from j; the normal velocity is negative while they approach.

mod choice;
mod coefficients;
pub mod cohesion;
#[cfg(test)]
pub(crate) mod fixtures;
mod law;
mod material;
pub mod normal;
pub mod rolling;
pub mod tangential;

pub use choice::{LawChoice, Objection};
pub use coefficients::Coefficients;
pub(crate) use coefficients::coefficients;
pub use law::{CoefficientPlaces, HistoryPlaces, Law, Offset};
pub use material::{Material, MaterialPair, Missing, PairProperties};

use crate::number::{Number, Row, Vector};
use serde::Deserialize;

/// Geometry and relative motion of one contact.
#[derive(Clone, Copy, Debug)]
pub struct Contact<N = f64> {
    /// Overlap δ, above 0 \[m\].
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
    /// What the normal model made of effective radius and mass when the pair was found
    /// ([`NormalForm::pair_constant`]).
    pub pair_constant: N,
}

/// What [`NormalForm::roots`] finds.
pub type Roots<N> = [N; 2];

/// What a normal model says of a contact: stiffnesses and damping coefficients.
#[derive(Clone, Copy, Debug)]
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

/// What the normal model, and cohesion after it, hand to the others.
#[derive(Clone, Copy, Debug)]
pub struct NormalForce<N = f64> {
    /// Stiffnesses and damping coefficients at the contact.
    pub response: Response<N>,
    /// Force along the normal on i \[N\].
    pub force: N,
    /// What of it friction and rolling see \[N\].
    pub seen: N,
}

/// Friction of one contact.
#[derive(Clone, Copy, Debug)]
pub struct Friction<N: Number = f64> {
    /// Force on i in the tangent plane \[N\].
    pub force: Vector<N>,
    /// What is to be remembered.
    pub history: [N; 4],
    /// Where it is at its limit.
    pub sliding: N::Mask,
}

/// Rows that a law remembers of a contact at most: one each of the normal, the tangential and the rolling model.
pub const MOST_HISTORY: usize = 3;

/// What a sub-model remembers of a contact from one evaluation to the next: a row of four numbers, zero at first touch
/// and gone with the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HistoryRow {
    /// What it is.
    pub name: &'static str,
    /// Which of the four numbers change sign when the two bodies change places.
    pub odd: [bool; 4],
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

    /// Whether γ_t acts.
    pub fn damps_slip(&self) -> bool {
        self.tangential_damping_factor != 0.0
    }
}

/// A sub-model without keys of its own: `[contact.<law>.<kind>.<model>]` stays empty.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoKeys {}

/// What friction takes from the normal model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrictionNeeds {
    /// k_t.
    pub stiffness: bool,
    /// γ_t.
    pub damping: bool,
}

/// A normal model: from what the scene says of two materials to what the loop computes.
pub trait Normal: Copy + Send + Sync + 'static {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + Send + Sync + 'static + for<'de> Deserialize<'de>;
    /// What the loop computes. Models that differ in their coefficients alone share it.
    type Form: NormalForm;
    /// The coefficients for two materials; what friction has no use for is not asked of the scene.
    fn between(pair: &MaterialPair, keys: &Self::Keys, friction: FrictionNeeds) -> Result<Self::Form, Missing>;
}

/// Stiffness and damping of a contact, and the force that follows from them.
pub trait NormalForm: Coefficients {
    /// What it remembers, if anything.
    const HISTORY: Option<HistoryRow> = None;
    /// Whether [`NormalForm::pair_constant`] says anything.
    const HAS_PAIR_CONSTANT: bool = false;
    /// What depends on effective radius \[m\] and mass \[kg\] alone and is too dear for the loop
    /// (a fractional power): found once, when the pair comes near.
    fn pair_constant(&self, _radius: f64, _mass: f64) -> f64 {
        0.0
    }
    /// Whether [`NormalForm::roots`] says anything.
    const HAS_ROOTS: bool = false;
    /// Roots of overlap \[m\], effective radius \[m\] and mass \[kg\] alone: they take the processor long, and the loop
    /// finds them ahead.
    #[inline(always)]
    fn roots<N: Number>(_overlap: N, _radius: N, _mass: N) -> Roots<N> {
        [N::zero(); 2]
    }
    /// Stiffness and damping of the contact at hand.
    fn response_at<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>, roots: Roots<N>) -> Response<N>;
    /// The same when the roots are not known.
    #[inline(always)]
    fn response<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>) -> Response<N> {
        Self::response_at(law, contact, Self::roots(contact.overlap, contact.radius, contact.mass))
    }
    /// Force along the normal and what is to be remembered: spring and dashpot, k_n δ − γ_n v_n, unless the model says
    /// otherwise. `step` is the time since the history was last advanced \[s\] (0 in the evaluation before the first
    /// step).
    #[inline(always)]
    fn force<N: Number>(
        law: Self::Lanes<N>,
        switches: Switches<N>,
        contact: &Contact<N>,
        roots: Roots<N>,
        history: [N; 4],
        _step: N,
    ) -> (NormalForce<N>, [N; 4]) {
        let mut response = Self::response_at(law, contact, roots);
        response.tangential_damping = response.tangential_damping * switches.tangential_damping_factor;
        let elastic = response.normal_stiffness * contact.overlap;
        let force = (elastic - response.normal_damping * contact.normal_velocity).max(switches.least_force);
        (NormalForce { response, force, seen: force }, history)
    }
    /// Work of the elastic force k_n(δ) (δ − δ₀) from an offset δ₀ to the overlap of the contact \[J\].
    fn elastic_energy(&self, contact: &Contact, offset: f64) -> f64;
    /// d(force)/d(overlap) of the elastic part at this overlap, for the stable time step \[N/m\].
    fn tangent_stiffness(&self, contact: &Contact) -> f64;
}

/// Friction: force in the tangent plane.
pub trait Tangential: Coefficients {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + Send + Sync + 'static + for<'de> Deserialize<'de>;
    /// Whether there is a force at all; without one nothing tangential is evaluated.
    const ACTIVE: bool;
    /// What it remembers, if anything.
    const HISTORY: Option<HistoryRow> = None;
    /// Whether a spring of stiffness k_t is stretched by slip; its first three remembered numbers are its vector.
    const HAS_SPRING: bool;
    /// Whether slip is damped by γ_t.
    const HAS_DASHPOT: bool;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// Force on i, its limit, and what is to be remembered. `step` is the time since the history was last advanced
    /// \[s\] (0 in the evaluation before the first step).
    fn force<N: Number>(
        law: Self::Lanes<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        step: N,
    ) -> Friction<N>;
}

/// Resistance against rolling.
pub trait Rolling: Coefficients {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + Send + Sync + 'static + for<'de> Deserialize<'de>;
    /// Whether there is a torque at all.
    const ACTIVE: bool;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// What it remembers, if anything.
    const HISTORY: Option<HistoryRow> = None;
    /// Torque taken from i and given to j \[N m\], and what is to be remembered. `step` as for friction.
    fn torque<N: Number>(
        law: Self::Lanes<N>,
        contact: &Contact<N>,
        normal: &NormalForce<N>,
        history: [N; 4],
        step: N,
    ) -> (Vector<N>, [N; 4]);
}

/// A cohesion model: from what the scene says of two materials to what the loop computes.
pub trait Cohesion: Copy + Send + Sync + 'static {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + Send + Sync + 'static + for<'de> Deserialize<'de>;
    /// What the loop computes. Models that differ in their coefficients alone share it.
    type Form: CohesionForm;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self::Form, Missing>;
    /// Whether these keys let friction see the attraction (`tangential_reduce`).
    fn reduces_friction(keys: &Self::Keys) -> bool;
}

/// Attraction of touching bodies.
pub trait CohesionForm: Coefficients {
    /// Whether there is a force at all.
    const ACTIVE: bool;
    /// Force along the normal, negative for a pull \[N\].
    fn force<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>) -> N;
    /// The part of that force which the friction limit sees \[N\].
    fn seen_by_friction<N: Number>(law: Self::Lanes<N>, force: N) -> N;
    /// Adds an attraction to the force of the normal model.
    #[inline(always)]
    fn add<N: Number>(law: Self::Lanes<N>, pull: N, normal: &mut NormalForce<N>) {
        normal.force = normal.force + pull;
        normal.seen = normal.seen + Self::seen_by_friction(law, pull);
    }
}

/// What one contact does to its two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector,
    /// n × F_t, which turns both bodies against their arms \[N\].
    pub couple: Vector,
    /// Rolling torque taken from i and given to j \[N m\].
    pub rolling: Vector,
    /// Whether friction is at its limit.
    pub sliding: bool,
}
