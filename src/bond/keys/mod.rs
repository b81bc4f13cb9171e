//! `[bond.<name>]` as the scene writes it, and the law that it means.

mod check;

use super::breakage::{distance::Distance, stress::ByStress};
use super::coefficients::Law;
use super::creation::{ContactPolicy, Creation};
use super::damping::{componentwise::Componentwise, none::Undamped, opposing::Opposing, viscous::Viscous};
use super::engine_exact::EngineExact;
use super::finite_rotation::FiniteRotation;
use super::incremental::Incremental;
use super::{BondLaw, Breakage, Composed, Damping, Formulation};
use crate::quantity::{Fraction, NonNegative, Positive};
use check::contradictions;
use serde::{Deserialize, Deserializer};

/// How forces and moments follow from the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FormulationChoice {
    /// [`FiniteRotation`]
    #[default]
    FiniteRotation,
    /// [`Incremental`]
    Incremental,
    /// [`EngineExact`]
    EngineExact,
}

impl FormulationChoice {
    /// The formulation that the scene file calls this.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "finite_rotation" => Some(Self::FiniteRotation),
            "incremental" => Some(Self::Incremental),
            "engine_exact" => Some(Self::EngineExact),
            _ => None,
        }
    }
}

/// One number for each part of a bond; what is absent is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartKeys<T> {
    /// Normal force.
    pub normal_force: Option<T>,
    /// Shear force.
    pub tangential_force: Option<T>,
    /// Torsion.
    pub normal_torque: Option<T>,
    /// Bending torque.
    pub tangential_torque: Option<T>,
}

impl<T: Copy> PartKeys<T> {
    /// In order, 0 where absent.
    fn parts(&self, number: impl Fn(T) -> f64) -> [f64; 4] {
        [self.normal_force, self.tangential_force, self.normal_torque, self.tangential_torque]
            .map(|part| part.map_or(0.0, &number))
    }
}

/// `[bond.<name>.damping.<model>]`
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampingChoice {
    /// α: each part is opposed to its rate by this share of itself ([`Opposing`]).
    Opposing(PartKeys<Fraction>),
    /// ζ: dashpots of this share of critical damping ([`Viscous`]).
    Viscous(PartKeys<NonNegative>),
    /// α: the engine's `dampingBond`, axis by axis of the scene ([`Componentwise`]).
    Sign(PartKeys<Fraction>),
    /// α: the engine's `dampingBondSmooth` ([`Componentwise`]).
    Smooth(PartKeys<Fraction>),
}

/// `[bond.<name>.breakage]`
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BreakageKeys {
    /// Distance of the centres beyond which the bond breaks \[m\].
    pub max_distance: Option<Positive>,
    /// Largest normal stress \[Pa\].
    pub max_normal_stress: Option<Positive>,
    /// Largest shear stress without normal force \[Pa\].
    pub max_shear_stress: Option<Positive>,
    /// Strength in tension over that in compression.
    pub tension_ratio: Option<Positive>,
    /// φ of the growth of shear strength with compression, from 0 to below π/2 \[rad\].
    pub friction_angle: Option<NonNegative>,
    /// Whether compression adds to the normal stress (as in the engine) or relieves it.
    pub compression_breaks: Option<bool>,
}

/// A key of the document that no program has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Never {}

impl<'de> Deserialize<'de> for Never {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(serde::de::Error::custom(
            "breakage by heat is named in the document as not implemented, and not defined; leave the key out",
        ))
    }
}

/// Says yes where a key is absent.
fn yes() -> bool {
    true
}

/// `[bond.<name>]`
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys {
    /// The formulation; `finite_rotation` where absent.
    #[serde(default)]
    pub formulation: FormulationChoice,
    /// Two particle sets (or one twice), or a particle set and a plane.
    pub between: [String; 2],
    /// When bonds are made; `"start"` where absent.
    #[serde(default)]
    pub create: Creation,
    /// Distance of the centres below which they are made; at a plane, half of it from the centre \[m\].
    pub create_distance: Option<Positive>,
    /// λ: bond radius over the smaller radius; 1 where absent.
    pub radius_multiplier: Option<Positive>,
    /// k_n, per unit area \[Pa/m\].
    pub normal_stiffness: Positive,
    /// k_t, per unit area \[Pa/m\].
    pub tangential_stiffness: NonNegative,
    /// Whether a stretched bond pulls.
    #[serde(default = "yes")]
    pub tension: bool,
    /// Whether a compressed bond pushes.
    #[serde(default = "yes")]
    pub compression: bool,
    /// Whether it bears shear.
    #[serde(default = "yes")]
    pub shear: bool,
    /// Whether it bears torsion.
    #[serde(default = "yes")]
    pub torsion: bool,
    /// Whether it bears bending.
    #[serde(default = "yes")]
    pub bending: bool,
    /// What the contact law does between the bonded bodies.
    #[serde(default)]
    pub contact: ContactPolicy,
    /// When bonds break; never where absent.
    pub breakage: Option<BreakageKeys>,
    /// Damping; none where absent.
    pub damping: Option<DampingChoice>,
    /// τ: relaxation times \[s\]; none where absent.
    pub relaxation: Option<PartKeys<Positive>>,
    /// Refused.
    pub temperature_break: Option<Never>,
}

/// What is wrong with the keys of one bond table among themselves.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key}: {message}")]
pub struct KeyError {
    /// The key, as `breakage.tension_ratio`.
    pub key: &'static str,
    /// What was found and what would be right.
    pub message: String,
}

/// Threshold of the engine's smooth damping over R_min/Δt.
const SMOOTH_THRESHOLD: f64 = 1e-5;
/// Threshold of the engine's smooth damping over force times Δt.
const SMOOTH_THRESHOLD_BY_FORCE: f64 = 0.01;
/// |u| up to which the engine's bond bears no normal force \[m\].
const ENGINE_DEAD_BAND: f64 = 1e-15;

/// What to do with the law once its type is known.
pub trait TakeLaw {
    /// What comes of it.
    type Output;
    /// Called once, with the type that the keys name.
    fn take<L: BondLaw>(self) -> Self::Output;
}

impl Keys {
    /// Whether a stress can break the bond.
    fn breaks_by_stress(&self) -> bool {
        self.breakage.is_some_and(|keys| keys.max_normal_stress.is_some() || keys.max_shear_stress.is_some())
    }

    /// The law in numbers, or every contradiction among the keys.
    pub fn law(&self) -> Result<Law, Vec<KeyError>> {
        let errors = contradictions(self);
        if !errors.is_empty() {
            return Err(errors);
        }
        let exact = self.formulation == FormulationChoice::EngineExact;
        let breakage = self.breakage.unwrap_or_default();
        let part = |bears: bool, stiffness: f64| if bears { stiffness } else { 0.0 };
        let (normal, tangential) = (self.normal_stiffness.get(), self.tangential_stiffness.get());
        let strength = breakage.max_normal_stress.map_or(f64::INFINITY, Positive::get);
        let smooth = matches!(self.damping, Some(DampingChoice::Smooth(_)));
        Ok(Law {
            radius_multiplier: self.radius_multiplier.map_or(1.0, Positive::get),
            tension: part(self.tension, normal),
            compression: part(self.compression, normal),
            shear: part(self.shear, tangential),
            torsion: part(self.torsion, tangential),
            bending: part(self.bending, normal),
            dead_band: if exact { ENGINE_DEAD_BAND } else { 0.0 },
            max_distance: breakage.max_distance.map_or(f64::INFINITY, Positive::get),
            compression_strength: strength,
            tension_strength: strength * breakage.tension_ratio.map_or(1.0, Positive::get),
            shear_strength: breakage.max_shear_stress.map_or(f64::INFINITY, Positive::get),
            friction: breakage.friction_angle.map_or(0.0, |angle| libm::tan(angle.get())),
            compression_share: if breakage.compression_breaks.unwrap_or(exact) { 1.0 } else { -1.0 },
            damping: self.damping.map_or([0.0; 4], |choice| match choice {
                DampingChoice::Viscous(keys) => keys.parts(NonNegative::get),
                DampingChoice::Opposing(keys) | DampingChoice::Sign(keys) | DampingChoice::Smooth(keys) => {
                    keys.parts(Fraction::get)
                }
            }),
            threshold: if smooth { SMOOTH_THRESHOLD } else { 0.0 },
            threshold_by_force: if smooth { SMOOTH_THRESHOLD_BY_FORCE } else { 0.0 },
            relaxation_rate: self.relaxation.map_or([0.0; 4], |keys| keys.parts(|time| 1.0 / time.get())),
        })
    }

    /// Why the time step must be given, if it must: what the law does depends on the step, or counts steps.
    pub fn needs_given_step(&self) -> Option<&'static str> {
        if self.formulation == FormulationChoice::EngineExact {
            Some("the forces of engine_exact depend on the step")
        } else if matches!(self.create, Creation::Step(_)) {
            Some("bonds are made at a step number")
        } else if self.relaxation.is_some() {
            Some("relaxation takes Δt/τ in each step")
        } else if matches!(self.damping, Some(DampingChoice::Smooth(_))) {
            Some("the threshold of smooth damping depends on the step")
        } else {
            None
        }
    }

    /// The shortest relaxation time, below which no time step may lie \[s\].
    pub fn shortest_relaxation(&self) -> Option<f64> {
        let keys = self.relaxation?;
        [keys.normal_force, keys.tangential_force, keys.normal_torque, keys.tangential_torque]
            .into_iter()
            .flatten()
            .map(Positive::get)
            .reduce(f64::min)
    }

    /// Goes from the keys to the type of the law.
    pub fn visit<V: TakeLaw>(&self, visitor: V) -> V::Output {
        match (self.formulation, self.relaxation) {
            (FormulationChoice::FiniteRotation, None) => self.any::<FiniteRotation<false>, V>(visitor),
            (FormulationChoice::FiniteRotation, Some(_)) => self.any::<FiniteRotation<true>, V>(visitor),
            (FormulationChoice::Incremental, None) => self.any::<Incremental<false>, V>(visitor),
            (FormulationChoice::Incremental, Some(_)) => self.any::<Incremental<true>, V>(visitor),
            (FormulationChoice::EngineExact, _) => match self.damping {
                None => self.with::<EngineExact, Undamped, V>(visitor),
                Some(_) => self.with::<EngineExact, Componentwise, V>(visitor),
            },
        }
    }

    /// With a formulation that takes every damping.
    fn any<F: Formulation, V: TakeLaw>(&self, visitor: V) -> V::Output {
        match self.damping {
            None => self.with::<F, Undamped, V>(visitor),
            Some(DampingChoice::Opposing(_)) => self.with::<F, Opposing, V>(visitor),
            Some(DampingChoice::Viscous(_)) => self.with::<F, Viscous, V>(visitor),
            Some(DampingChoice::Sign(_) | DampingChoice::Smooth(_)) => self.with::<F, Componentwise, V>(visitor),
        }
    }

    /// With formulation and damping known.
    fn with<F: Formulation, D: Damping, V: TakeLaw>(&self, visitor: V) -> V::Output {
        if self.breaks_by_stress() {
            Self::whole::<F, D, ByStress, V>(visitor)
        } else {
            Self::whole::<F, D, Distance, V>(visitor)
        }
    }

    /// With all three known.
    fn whole<F: Formulation, D: Damping, B: Breakage, V: TakeLaw>(visitor: V) -> V::Output {
        visitor.take::<Composed<F, D, B>>()
    }
}
