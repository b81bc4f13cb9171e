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

pub use choice::{LawChoice, remembered};
pub use coefficients::Coefficients;
pub(crate) use coefficients::coefficients;
pub use law::{CoefficientPlaces, HistoryPlaces, Law, Offset};
pub use material::{Material, MaterialPair, Missing, PairProperties};

use crate::number::{Number, Row, Vector};
use serde::Deserialize;

/// Geometry and relative motion of one contact.
#[derive(Clone, Copy, Debug)]
pub struct Contact<N = f64> {
    /// Overlap δ; below 0 only where a normal model holds bodies together beyond touch \[m\].
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
    /// 1/(R_i + R_j) of two spheres, 0 at a wall \[1/m\].
    pub per_reach: N,
    /// p q/(p + q), p = m_i R_i², q = m_j R_j², of two spheres; m_i R_i² at a wall \[kg m²\].
    pub rolling_inertia: N,
    /// What the normal model made of effective radius and mass when the pair was found
    /// ([`NormalForm::pair_constant`]).
    pub pair_constant: N,
}

impl<N: Number> Contact<N> {
    /// The contact with the slip that arms R instead of R − δ/2 give.
    #[inline(always)]
    pub fn with_undeformed_arms(&self) -> Self {
        let missing = (self.spin_sum * (N::splat(0.5) * self.overlap)).cross(self.normal);
        Self { slip: self.slip - missing, ..*self }
    }
}

/// What of a contact a sub-model looks at, beyond overlap, effective radius and mass, normal and normal velocity. What
/// no sub-model of a law looks at is not found.
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
}

impl Needs {
    /// Nothing.
    pub const NONE: Self = Self { torque: false, spin: false, section: false, bodies: false, spin_sum: false };

    /// What either of two looks at.
    pub fn and(self, other: Self) -> Self {
        Self {
            torque: self.torque || other.torque,
            spin: self.spin || other.spin,
            section: self.section || other.section,
            bodies: self.bodies || other.bodies,
            spin_sum: self.spin_sum || other.spin_sum,
        }
    }
}

/// Whether a normal model pulls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adhesion {
    /// It does not, but for its dashpot at the end of a contact.
    None,
    /// While the bodies touch.
    InTouch,
    /// Also beyond touch, once they have touched: up to [`NormalForm::reach`].
    BeyondTouch,
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

    /// Whether the normal force is kept from pulling.
    pub fn limits_force(&self) -> bool {
        self.least_force == 0.0
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

/// Why sub-models and switches do not go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Objection {
    /// The table of the key below `[contact.<law>]`: empty, or the kind of sub-model.
    pub table: &'static str,
    /// The key to change.
    pub key: &'static str,
    /// What was found and what would be right.
    pub reason: &'static str,
}

/// A normal model: from what the scene says of two materials to what the loop computes.
pub trait Normal: Copy + Send + Sync + 'static {
    /// What the scene writes under the model's name.
    type Keys: Copy + std::fmt::Debug + Send + Sync + 'static + for<'de> Deserialize<'de>;
    /// What the loop computes. Models that differ in their coefficients alone share it.
    type Form: NormalForm;
    /// What it remembers, if anything.
    const HISTORY: Option<HistoryRow> = <Self::Form as NormalForm>::HISTORY;
    /// The coefficients for two materials; what friction has no use for is not asked of the scene.
    fn between(pair: &MaterialPair, keys: &Self::Keys, friction: FrictionNeeds) -> Result<Self::Form, Missing>;
    /// What speaks against these keys, if anything.
    fn objection(_keys: &Self::Keys) -> Option<Objection> {
        None
    }
    /// Whether slip is that of the undeformed bodies, and torques at walls have their arms, as in the engine.
    fn has_undeformed_arms(_keys: &Self::Keys) -> bool {
        false
    }
}

/// Stiffness and damping of a contact, and the force that follows from them.
pub trait NormalForm: Coefficients {
    /// What it remembers, if anything.
    const HISTORY: Option<HistoryRow> = None;
    /// What of a contact it looks at.
    const NEEDS: Needs = Needs::NONE;
    /// Whether it pulls.
    const ADHESION: Adhesion = Adhesion::None;
    /// Whether `limit_force` cuts the pull of its dashpot alone, where nothing adheres.
    const LIMITS_ITSELF: bool = false;
    /// How far beyond touch it holds bodies of this effective radius \[m\] together, where it does \[m\]. The pair
    /// constant is that, too.
    fn reach(&self, _radius: f64) -> f64 {
        0.0
    }
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
    /// Stiffness and damping of the contact at hand: k_n and k_t are those that the other sub-models see.
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
    /// Work of the elastic force k_n(δ) (δ − δ₀) from an offset δ₀ to the overlap of the contact, by what is remembered
    /// \[J\].
    fn elastic_energy(&self, contact: &Contact, offset: f64, history: Row) -> f64;
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
    /// Stiffness of the spring where that of the normal model is k_t \[N/m\].
    fn stiffness(&self, from_normal_model: f64) -> f64 {
        from_normal_model
    }
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

/// Stiffness of a rolling spring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollingStiffness {
    /// Against rolling \[N m\].
    pub bending: f64,
    /// Against twisting about the normal \[N m\].
    pub torsion: f64,
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
    /// What of a contact it looks at.
    const NEEDS: Needs = Needs { torque: true, spin: true, ..Needs::NONE };
    /// Whether it takes k_n δ for the force that presses: then the bodies must overlap while they touch.
    const TAKES_OVERLAP: bool = false;
    /// Whether it takes k_t of the normal model, whatever the tangential model does.
    const TAKES_TANGENTIAL_STIFFNESS: bool = false;
    /// Stiffness of its spring against bending and against twisting, that of its dashpot included, for the stable time
    /// step \[N m\].
    fn stiffness(&self, _contact: &Contact, _response: &Response) -> RollingStiffness {
        RollingStiffness::default()
    }
    /// Energy of its spring \[J\].
    fn elastic_energy(&self, _contact: &Contact, _response: &Response, _history: Row) -> f64 {
        0.0
    }
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
    /// What it remembers: nothing.
    const HISTORY: Option<HistoryRow> = None;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self::Form, Missing>;
    /// Whether these keys let friction see the attraction (`tangential_reduce`).
    fn reduces_friction(keys: &Self::Keys) -> bool;
}

/// Attraction of touching bodies.
pub trait CohesionForm: Coefficients {
    /// Whether there is a force at all.
    const ACTIVE: bool;
    /// What of a contact it looks at.
    const NEEDS: Needs = Needs { section: true, ..Needs::NONE };
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
