//! A contact and a pair of materials to try laws on.

use super::cohesion;
use super::normal::{eepa, hooke, hooke_stiffness, jkr, sticky};
use super::rolling::rocking;
use super::tangential::turned_history;
use super::{
    Cohesion, CohesionForm, CohesionModel, Contact, FrictionNeeds, HistoryRow, LawChoice, Material, MaterialPair,
    Missing, Needs, NoKeys, NormalForce, NormalModel, Properties, Response, RollingModel, Scheme, Switches,
    TangentialModel, coefficients, normal, rolling, tangential,
};
use crate::base::number::{Number, Vector};
use crate::base::quantity::Positive;
use crate::laws::contact::Thermal;
use crate::laws::contact::property;

/// Friction that takes all there is.
pub(super) const ALL: FrictionNeeds = FrictionNeeds { stiffness: true, damping: true };

/// No friction.
pub(super) const NOTHING: FrictionNeeds = FrictionNeeds { stiffness: false, damping: false };

/// A contact whose numbers have short square roots: √(R* δ) is 2⁻⁸ m.
pub(super) fn contact() -> Contact {
    Contact {
        overlap: 1.0 / 16384.0,
        radius: 0.25,
        mass: 4.0,
        section_area: 3.0,
        section_radius: 0.5,
        normal: Vector::new(0.0, 0.0, 1.0),
        normal_velocity: -0.5,
        slip: Vector::new(3.0, 4.0, 0.0),
        relative_spin: Vector::new(0.0, 5.0, 0.0),
        spin_sum: Vector::new(0.0, 7.0, 0.0),
        turning: Vector::new(0.0, 1.5, 0.25),
        per_distance: 1.0,
        per_reach: 1.0,
        rolling_inertia: 0.5,
        pair_constant: 0.0,
    }
}

/// What a normal model might have said of [`contact`].
pub(super) fn response() -> Response {
    Response { normal_stiffness: 1024.0, normal_damping: 3.0, tangential_stiffness: 8.0, tangential_damping: 2.0 }
}

/// The same with no force yet.
pub(super) fn normal_force() -> NormalForce {
    NormalForce { response: response(), force: 0.0, seen: 0.0 }
}

/// Every combination of sub-models and schemes.
pub(crate) fn every_law() -> Vec<LawChoice> {
    let speed = hooke::Keys { characteristic_velocity: Positive::new(2.0).unwrap() };
    let reduce = cohesion::sjkr::Keys { tangential_reduce: true };
    let mut all = Vec::new();
    for normal in [
        NormalModel::of::<normal::hertz::Hertz>(NoKeys {}),
        NormalModel::of::<normal::hertz_stiffness::HertzStiffness>(NoKeys {}),
        NormalModel::of::<normal::hooke::Hooke>(speed),
        NormalModel::of::<normal::hooke_stiffness::HookeStiffness>(hooke_stiffness::Keys::default()),
        NormalModel::of::<normal::hooke_viscous::HookeViscous>(speed),
        NormalModel::of::<normal::jkr::Jkr>(jkr::Keys { tear_off: jkr::TearOff::WholeBranch, ..jkr::Keys::default() }),
        NormalModel::of::<normal::jkr::Jkr>(jkr::Keys { engine_exact: true, ..jkr::Keys::default() }),
        NormalModel::of::<normal::dmt::Dmt>(sticky::Keys {
            damping: sticky::DampingKind::Velocity,
            ..sticky::Keys::default()
        }),
        dented(1.5, 5.0, eepa::AdhesionKind::Patch),
        dented(1.0, 1.0, eepa::AdhesionKind::Fixed),
    ] {
        for tangential in [
            TangentialModel::of::<tangential::none::None>(NoKeys {}),
            TangentialModel::of::<tangential::history::History>(NoKeys {}),
            TangentialModel::of::<tangential::no_history::NoHistory>(NoKeys {}),
            TangentialModel::of::<tangential::rescaled::Rescaled>(NoKeys {}),
            TangentialModel::of::<tangential::turned_history::TurnedHistory>(turned_history::Keys {
                rescale: true,
                ..Default::default()
            }),
            TangentialModel::of::<tangential::turned_history::TurnedHistory>(turned_history::Keys {
                backward_spring: Some(false),
                ..Default::default()
            }),
        ] {
            for rolling in [
                RollingModel::of::<rolling::none::None>(NoKeys {}),
                RollingModel::of::<rolling::cdt::Cdt>(NoKeys {}),
                RollingModel::of::<rolling::epsd::Epsd>(rocking::Keys::default()),
                RollingModel::of::<rolling::epsd2::Epsd2>(rocking::Keys {
                    torsion: true,
                    engine_exact: true,
                    set_up_step: None,
                }),
            ] {
                for cohesion in [
                    CohesionModel::of::<cohesion::none::None>(NoKeys {}),
                    CohesionModel::of::<cohesion::sjkr::Sjkr>(reduce),
                    CohesionModel::of::<cohesion::sjkr2::Sjkr2>(cohesion::sjkr::Keys::default()),
                    CohesionModel::of::<Holding>(NoKeys {}),
                ] {
                    let switches = Switches::of(false, true);
                    for scheme in Scheme::ALL {
                        let choice = LawChoice { normal, tangential, rolling, cohesion, switches, scheme };
                        if choice.objection().is_none_or(|objection| objection.key == "tangential_reduce") {
                            all.push(choice);
                        }
                    }
                }
            }
        }
    }
    all
}

coefficients! {
    /// Holds bodies beyond touch with a force that grows as it is remembered, for tests.
    pub(crate) struct Holding {
        /// How far \[m\].
        reach,
    }
}

impl Cohesion for Holding {
    const NAME: &'static str = "holding";
    type Keys = NoKeys;
    type Form = Self;

    fn between(_pair: &MaterialPair, _keys: &NoKeys) -> Result<Self, Missing> {
        Ok(Self::new(0.25))
    }
}

impl CohesionForm for Holding {
    const NEEDS: Needs = Needs::NONE;
    const BEYOND_TOUCH: bool = true;
    const HISTORY: Option<HistoryRow> =
        Some(HistoryRow { name: "pull before", odd: [false; 4], fourth_is_free: false });

    fn reach(&self, _radius: f64) -> f64 {
        self.reach
    }

    #[inline(always)]
    fn force<N: Number>(law: Holding<N>, contact: &Contact<N>) -> N {
        -(law.reach + contact.overlap)
    }

    #[inline(always)]
    fn pull<N: Number>(law: Holding<N>, contact: &Contact<N>, [before, ..]: [N; 4], step: N) -> (N, [N; 4]) {
        let pull = Self::force(law, contact) + before * step;
        (pull, [pull, N::zero(), N::zero(), N::zero()])
    }
}

/// An elasto-plastic model.
fn dented(overlap_exponent: f64, adhesion_exponent: f64, adhesion: eepa::AdhesionKind) -> NormalModel {
    NormalModel::of::<normal::eepa::Eepa>(eepa::Keys {
        overlap_exponent,
        adhesion_exponent,
        adhesion,
        engine_exact: false,
    })
}

/// Contacts at the corners of what can be: no motion, no spin, no overlap, receding.
pub(crate) fn corners() -> Vec<Contact> {
    let still = Contact {
        normal_velocity: 0.0,
        slip: Vector::zero(),
        relative_spin: Vector::zero(),
        pair_constant: 5.0,
        ..contact()
    };
    vec![
        Contact { pair_constant: 5.0, ..contact() },
        Contact { normal_velocity: 0.25, pair_constant: 5.0, ..contact() },
        still,
        Contact { overlap: 0.0, section_area: 0.0, ..still },
        Contact { pair_constant: 0.0, ..still },
    ]
}

/// A material with E = 2 Pa and ν = 0: two of them have E* = 1 Pa and G* = ¼ Pa.
pub(super) fn material() -> Material {
    let thermal = Thermal::default();
    Material {
        name: "soft".into(),
        density: 1.0,
        youngs_modulus: Some(2.0),
        poissons_ratio: Some(0.0),
        thermal,
        properties: Properties::default(),
    }
}

/// All properties of two materials, each another number.
pub(crate) fn properties() -> Properties {
    Properties::default()
        .with(&property::RESTITUTION, 0.5)
        .with(&property::FRICTION, 0.25)
        .with(&property::ROLLING_FRICTION, 0.125)
        .with(&property::COHESION_ENERGY_DENSITY, 7.0)
        .with(&property::NORMAL_STIFFNESS, 100.0)
        .with(&property::TANGENTIAL_STIFFNESS, 50.0)
        .with(&property::NORMAL_DAMPING, 6.0)
        .with(&property::TANGENTIAL_DAMPING, 3.0)
        .with(&property::ABSOLUTE_NORMAL_DAMPING, 11.0)
        .with(&property::ABSOLUTE_TANGENTIAL_DAMPING, 9.0)
        .with(&property::FLUID_VISCOSITY, 0.5)
        .with(&property::CRITICAL_STOKES_NUMBER, 30.0)
        .with(&property::MAXIMUM_RESTITUTION, 0.875)
        .with(&property::ROLLING_VISCOUS_DAMPING, 0.5)
        .with(&property::SURFACE_ENERGY, 1e-6)
        .with(&property::DAMPING_COEFFICIENT, 2.0)
        .with(&property::TANGENTIAL_DAMPING_RATIO, 0.5)
        .with(&property::UNLOADING_STIFFNESS_RATIO, 4.0)
        .with(&property::PULL_OFF_FORCE, 0.0)
        .with(&property::ADHESION_STIFFNESS_RATIO, 0.5)
        .with(&property::HEAT_TRANSFER_COEFFICIENT, 2000.0)
}

/// Calls `with` for two pieces of one material that have these properties in common.
pub(crate) fn with_pair<T>(properties: &Properties, with: impl FnOnce(&MaterialPair) -> T) -> T {
    let material = material();
    with(&MaterialPair { a: &material, b: &material, properties })
}

/// Fails, with both values, unless they agree to `tolerance` of the expected one.
#[track_caller]
pub(in crate::laws) fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found:e} found, {expected:e} expected");
}
