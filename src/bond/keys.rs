//! `[bond.<name>]` as the scene writes it, and the law that it means.

pub use super::breakage::BreakageKeys;
pub use super::damping::DampingChoice;
pub use super::formulation::FormulationChoice;

use super::creation::{ContactPolicy, Creation};
use super::{Elasticity, Law};
use crate::quantity::{NonNegative, Positive};
use serde::{Deserialize, Deserializer};

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
    pub fn parts(&self, number: impl Fn(T) -> f64) -> [f64; 4] {
        [self.normal_force, self.tangential_force, self.normal_torque, self.tangential_torque]
            .map(|part| part.map_or(0.0, &number))
    }
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

impl KeyError {
    /// Adds one where it is there.
    pub(super) fn add(wrong: &mut Vec<Self>, there: bool, key: &'static str, message: &str) {
        if there {
            wrong.push(Self { key, message: message.to_owned() });
        }
    }
}

/// |u| up to which the engine's bond bears no normal force \[m\].
const ENGINE_DEAD_BAND: f64 = 1e-15;

impl Keys {
    /// What compression adds to the normal stress over |N|/A: 1 where compression breaks, −1 where it relieves.
    pub(super) fn compression_share(&self) -> f64 {
        let said = self.breakage.and_then(|keys| keys.stress.compression_breaks);
        if said.unwrap_or(self.formulation.is_engine()) { 1.0 } else { -1.0 }
    }

    /// Every contradiction among the keys.
    fn contradictions(&self) -> Vec<KeyError> {
        let mut wrong = Vec::new();
        let mut add = |there: bool, key: &'static str, message: &str| KeyError::add(&mut wrong, there, key, message);
        add(
            self.create.needs_distance() && self.create_distance.is_none(),
            "create_distance",
            "missing; the distance of the centres below which bonds are made is needed, unless they are listed",
        );
        if let Some(message) = self.create.contradiction() {
            add(true, "create", message);
        }
        add(
            self.formulation.is_engine() && self.damping.is_some_and(|damping| !damping.is_the_engines()),
            "damping",
            "engine_exact has only the engine's damping; sign, smooth or none is right",
        );
        if let Some(breakage) = &self.breakage {
            breakage.check(self, &mut wrong);
        }
        wrong
    }

    /// The law in numbers, or every contradiction among the keys.
    pub fn law(&self) -> Result<Law, Vec<KeyError>> {
        let wrong = self.contradictions();
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let part = |bears: bool, stiffness: f64| if bears { stiffness } else { 0.0 };
        let (normal, tangential) = (self.normal_stiffness.get(), self.tangential_stiffness.get());
        Ok(Law {
            formulation: self.formulation,
            elasticity: Elasticity {
                radius_multiplier: self.radius_multiplier.map_or(1.0, Positive::get),
                tension: part(self.tension, normal),
                compression: part(self.compression, normal),
                shear: part(self.shear, tangential),
                torsion: part(self.torsion, tangential),
                bending: part(self.bending, normal),
                dead_band: if self.formulation.is_engine() { ENGINE_DEAD_BAND } else { 0.0 },
                relaxation_rate: self.relaxation.map_or([0.0; 4], |keys| keys.parts(|time| 1.0 / time.get())),
            },
            damping: self.damping,
            breakage: self.breakage.map_or_else(Vec::new, |keys| keys.rules(self)),
            compression_share: self.compression_share(),
        })
    }

    /// Why the time step must be given, if it must: what the law does depends on the step, or counts steps.
    pub fn needs_given_step(&self) -> Option<&'static str> {
        let formulation = self.formulation.is_engine().then_some("the forces of engine_exact depend on the step");
        let relaxation = self.relaxation.map(|_| "relaxation takes Δt/τ in each step");
        let damping = self.damping.and_then(|damping| damping.needs_given_step());
        formulation.or(self.create.needs_given_step()).or(relaxation).or(damping)
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
}
