//! What touching bodies do to each other: pure functions of one contact and its own history.
//!
//! A contact law is composed of four sub-models: normal, tangential, rolling, cohesion. Each is one file
//! and one row in the list beside it. Laws are written over [`Number`], so the same source runs one
//! contact at a time or several in a vector register.
//!
//! Signs: the normal points from body j to body i; a positive normal force pushes i along it. The
//! relative velocity is that of i seen from j; the normal velocity is negative while they approach.

mod choice;
mod coefficients;
pub mod cohesion;
mod composed;
#[cfg(test)]
mod fixtures;
mod material;
pub mod normal;
pub mod rolling;
pub mod tangential;

pub use choice::{LawChoice, TakeLaw};
pub use coefficients::Coefficients;
pub(crate) use coefficients::coefficients;
pub use composed::{Composed, Law, Objection, Switches};
pub use material::{Material, MaterialPair, Missing, PairProperties};

use crate::number::{Number, Vector};
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

/// How much of a contact is left where a bond hides it, or has hidden it.
#[derive(Clone, Copy, Debug)]
pub struct Beyond {
    /// Overlap beyond the offset: what the elastic force is taken from \[m\].
    pub pressing: f64,
    /// Whether the normal force acts. Friction sees it in either case.
    pub acts: bool,
    /// The contact of these bodies at an overlap of the offset alone.
    pub offset: Contact,
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

/// Stiffness and damping of a contact; the force k_n δ − γ_n v_n follows from them.
pub trait NormalForm: Coefficients {
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
    /// Whether a tangential spring is carried from step to step.
    const HAS_SPRING: bool;
    /// Whether slip is damped by γ_t.
    const HAS_DASHPOT: bool;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// Force on i \[N\], the new spring \[m\], and where friction is at its limit. `pressure` is the normal force that friction sees \[N\],
    /// `step` the time since the spring was last seen \[s\] (0 in the evaluation before the first step).
    fn force<N: Number>(
        law: Self::Lanes<N>,
        contact: &Contact<N>,
        response: &Response<N>,
        pressure: N,
        spring: Vector<N>,
        step: N,
    ) -> (Vector<N>, Vector<N>, N::Mask);
}

/// Resistance against rolling.
pub trait Rolling: Coefficients {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + Send + Sync + 'static + for<'de> Deserialize<'de>;
    /// Whether there is a torque at all.
    const ACTIVE: bool;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// Torque taken from i and given to j \[N m\].
    fn torque<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>, response: &Response<N>) -> Vector<N>;
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
}

/// What one contact does to its two bodies.
#[derive(Clone, Copy)]
pub struct Reaction<N: Number = f64> {
    /// Force on i; j gets the opposite \[N\].
    pub force: Vector<N>,
    /// n × F_t, which turns both bodies against their arms \[N\].
    pub couple: Vector<N>,
    /// Rolling torque taken from i and given to j \[N m\].
    pub rolling: Vector<N>,
    /// The tangential spring to remember \[m\].
    pub spring: Vector<N>,
    /// Where friction is at its limit.
    pub sliding: N::Mask,
}
