//! What a sub-model of each kind has to say.

use super::heat::Spot;
use super::{
    Adhesion, Coefficients, Contact, Friction, HistoryRow, MaterialPair, Missing, ModelKeys, Needs, NormalForce,
    Objection, Onset, Property, Response, Roots, Switches,
};
use crate::base::number::{Number, Row, Vector};

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
    /// Its name in a scene.
    const NAME: &'static str;
    /// What the scene writes under the model's name.
    type Keys: ModelKeys;
    /// Properties of two materials that the model declares of its own.
    const PAIR_PROPERTIES: &'static [&'static Property] = &[];
    /// Properties of one material that the model declares of its own.
    const MATERIAL_PROPERTIES: &'static [&'static Property] = &[];
    /// What the loop computes. Models that differ in their coefficients alone share it.
    type Form: NormalForm;
    /// The coefficients for two materials; what friction has no use for is not asked of the scene.
    fn between(pair: &MaterialPair, keys: &Self::Keys, friction: FrictionNeeds) -> Result<Self::Form, Missing>;
    /// What speaks against these keys, if anything.
    fn objection(_keys: &Self::Keys) -> Option<Objection> {
        None
    }
    /// How γ_n and γ_t begin as the bodies touch.
    fn onset(_keys: &Self::Keys) -> Onset {
        Onset::Unweighed
    }
    /// Whether γ_t has its full strength as the bodies touch, where k_t is still 0: a spring that the dashpot stretches backwards then has
    /// no bound. Models that an engine combines with such springs do not declare it.
    const DAMPED_AT_TOUCH: bool = false;
    /// Whether slip is that of the undeformed bodies, and torques at walls have their arms, as in the engine.
    fn has_undeformed_arms(_keys: &Self::Keys) -> bool {
        false
    }
    /// Whether the contact radius of a force goes with E*^(−1/3), E* being that of the two materials: then bodies with a
    /// `real_youngs_modulus` have a known area of contact.
    const ELASTIC_SPHERES: bool = false;
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
        let response = Self::response_at(law, contact, roots);
        (pressing_force(response, switches, contact.overlap, contact.normal_velocity), history)
    }
    /// Work of the elastic force k_n(δ) (δ − δ₀) from an offset δ₀ to the overlap of the contact, by what is remembered
    /// \[J\].
    fn elastic_energy(&self, contact: &Contact, offset: f64, history: Row) -> f64;
    /// d(force)/d(overlap) of the elastic part at this overlap, for the stable time step \[N/m\].
    fn tangent_stiffness(&self, contact: &Contact) -> f64;
    /// Radius of the circle of contact of this overlap \[m\] and effective radius \[m\], through which heat flows \[m\].
    #[inline(always)]
    fn contact_radius<N: Number>(_law: Self::Lanes<N>, overlap: N, radius: N) -> N {
        (radius * overlap.max(N::zero())).sqrt()
    }
}

/// Force of spring and dashpot, of so much overlap \[m\] and this velocity along the normal \[m/s\].
#[inline(always)]
pub(crate) fn pressing_force<N: Number>(
    mut response: Response<N>,
    switches: Switches<N>,
    overlap: N,
    normal_velocity: N,
) -> NormalForce<N> {
    response.tangential_damping = response.tangential_damping * switches.tangential_damping_factor;
    let elastic = response.normal_stiffness * overlap;
    let force = (elastic - response.normal_damping * normal_velocity).max(switches.least_force);
    NormalForce { response, force, seen: force }
}

/// Friction: force in the tangent plane.
pub trait Tangential: Coefficients {
    /// Its name in a scene.
    const NAME: &'static str;
    /// What the scene writes under the model's name.
    type Keys: ModelKeys;
    /// Properties of two materials that the model declares of its own.
    const PAIR_PROPERTIES: &'static [&'static Property] = &[];
    /// Properties of one material that the model declares of its own.
    const MATERIAL_PROPERTIES: &'static [&'static Property] = &[];
    /// Whether there is a force at all; without one nothing tangential is evaluated.
    const ACTIVE: bool;
    /// What it remembers, if anything.
    const HISTORY: Option<HistoryRow> = None;
    /// Whether a spring of stiffness k_t is stretched by slip; its first three remembered numbers are its vector.
    const HAS_SPRING: bool;
    /// Whether slip is damped by γ_t of the normal model. A dashpot of its own is told by [`Tangential::damping`] alone.
    const HAS_DASHPOT: bool;
    /// Whether the fourth remembered number is the stiffness of the spring \[N/m\]; otherwise it is k_t.
    const KEEPS_STIFFNESS: bool = false;
    /// Whether spring and dashpot together stand at the limit while it slides, not the spring alone.
    const LIMITS_DASHPOT: bool = false;
    /// Whether a dashpot beyond the limit stretches the spring backwards, where γ_t has its full strength at first touch or has not.
    fn stretches_backwards(_keys: &Self::Keys, _damped_at_touch: bool) -> bool {
        false
    }
    /// Whether the part of the spring along the normal is lost as the contact turns.
    const PROJECTS: bool = false;
    /// Stiffness of the spring where that of the normal model is k_t \[N/m\].
    fn stiffness(&self, from_normal_model: f64) -> f64 {
        from_normal_model
    }
    /// The largest coefficient of its dashpot, where that of the normal model is γ_t (0 where slip is not damped by it): for the stable
    /// time step \[kg/s\].
    fn damping(&self, from_normal_model: f64) -> f64 {
        from_normal_model
    }
    /// The coefficients for two materials, beside a normal model that says [`Normal::DAMPED_AT_TOUCH`] or does not.
    fn between(pair: &MaterialPair, keys: &Self::Keys, damped_at_touch: bool) -> Result<Self, Missing>;
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

/// Stiffnesses and damping coefficients of a contact against rolling and twisting.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollingResponse {
    /// Spring against rolling \[N m\].
    pub bending_stiffness: f64,
    /// Dashpot against rolling \[N m s\].
    pub bending_damping: f64,
    /// Spring against twisting about the normal \[N m\].
    pub torsional_stiffness: f64,
    /// Dashpot against twisting about the normal \[N m s\].
    pub torsional_damping: f64,
}

/// Resistance against rolling.
pub trait Rolling: Coefficients {
    /// Its name in a scene.
    const NAME: &'static str;
    /// What the scene writes under the model's name.
    type Keys: ModelKeys;
    /// Properties of two materials that the model declares of its own.
    const PAIR_PROPERTIES: &'static [&'static Property] = &[];
    /// Properties of one material that the model declares of its own.
    const MATERIAL_PROPERTIES: &'static [&'static Property] = &[];
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
    /// What speaks against these keys, if anything.
    fn objection(_keys: &Self::Keys) -> Option<Objection> {
        None
    }
    /// Whether these keys keep the direction of the torque as the engine does.
    fn is_engine_exact(_keys: &Self::Keys) -> bool {
        false
    }
    /// Its springs and dashpots below the limit, by the response of the normal model: for the stable time step.
    fn response(&self, _contact: &Contact, _response: &Response) -> RollingResponse {
        RollingResponse::default()
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
    /// Its name in a scene.
    const NAME: &'static str;
    /// What the scene writes under the model's name.
    type Keys: ModelKeys;
    /// Properties of two materials that the model declares of its own.
    const PAIR_PROPERTIES: &'static [&'static Property] = &[];
    /// Properties of one material that the model declares of its own.
    const MATERIAL_PROPERTIES: &'static [&'static Property] = &[];
    /// What the loop computes. Models that differ in their coefficients alone share it.
    type Form: CohesionForm;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self::Form, Missing>;
    /// Whether these keys let friction see the attraction (`tangential_reduce`).
    fn reduces_friction(_keys: &Self::Keys) -> bool {
        false
    }
}

/// Attraction of bodies that touch or, beyond touch, have touched.
pub trait CohesionForm: Coefficients {
    /// Whether there is a force at all.
    const ACTIVE: bool = true;
    /// What it remembers, if anything.
    const HISTORY: Option<HistoryRow> = None;
    /// Whether it also pulls beyond touch, once the bodies have touched: up to [`CohesionForm::reach`]. It then acts alone, and the
    /// overlap is below 0; what other sub-models remember ends at touch.
    const BEYOND_TOUCH: bool = false;
    /// How far beyond touch it holds bodies of this effective radius \[m\] together, where it does \[m\]. The pair
    /// constant is that.
    fn reach(&self, _radius: f64) -> f64 {
        0.0
    }
    /// What of a contact it looks at.
    const NEEDS: Needs = Needs { section: true, ..Needs::NONE };
    /// Force along the normal, negative for a pull \[N\].
    fn force<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>) -> N;
    /// The same of a model that remembers, and what is to be remembered. `step` is the time since the history was last advanced
    /// \[s\] (0 in the evaluation before the first step).
    #[inline(always)]
    fn pull<N: Number>(law: Self::Lanes<N>, contact: &Contact<N>, history: [N; 4], _step: N) -> (N, [N; 4]) {
        (Self::force(law, contact), history)
    }
    /// The part of that force which the friction limit sees \[N\].
    #[inline(always)]
    fn seen_by_friction<N: Number>(_law: Self::Lanes<N>, _force: N) -> N {
        N::zero()
    }
    /// Adds an attraction to the force of the normal model.
    #[inline(always)]
    fn add<N: Number>(law: Self::Lanes<N>, pull: N, normal: &mut NormalForce<N>) {
        normal.force = normal.force + pull;
        normal.seen = normal.seen + Self::seen_by_friction(law, pull);
    }
}

/// Heat that flows where two bodies touch.
pub trait Heat: Coefficients {
    /// Its name in a scene.
    const NAME: &'static str;
    /// What the scene writes under the model's name.
    type Keys: ModelKeys;
    /// Properties of two materials that the model declares of its own.
    const PAIR_PROPERTIES: &'static [&'static Property] = &[];
    /// Properties of one material that the model declares of its own.
    const MATERIAL_PROPERTIES: &'static [&'static Property] = &[];
    /// What of a contact it looks at: `section` where it wants the radii of both bodies.
    const NEEDS: Needs = Needs::NONE;
    /// The coefficients for two materials.
    fn between(pair: &MaterialPair, keys: &Self::Keys) -> Result<Self, Missing>;
    /// Heat flow from the warmer body to the colder over the difference of their temperatures \[W/K\].
    fn conductance<N: Number>(law: Self::Lanes<N>, spot: &Spot<N>) -> N;
}
