//! `[bond.<name>]` as the scene writes it, and the law that it means.

pub use super::breakage::BreakageChoice;
pub use super::damping::DampingChoice;
pub use super::formulation::FormulationChoice;
pub use super::key_error::KeyError;
pub use super::part_keys::PartKeys;

use super::creation::{ContactPolicy, Creation};
use crate::base::document::keys;
use crate::base::quantity::{NonNegative, Positive};
use serde::{Deserialize, Deserializer};

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

keys! {
    /// `[bond.<name>]`
    #[derive(Clone, Debug)]
    pub struct Keys {
        /// `"finite_rotation"`, `"incremental"`, `"engine_exact"`.
        #[serde(default)]
        pub formulation: FormulationChoice = "`\"finite_rotation\"`",
        /// Two particle sets (the same set twice bonds particles within it), or a particle set and a plane boundary.
        pub between: [String; 2] = "required",
        /// When bonds are made: see below.
        #[serde(default)]
        pub create: Creation = "`\"start\"`",
        /// Two particles are bonded if their centres are nearer than this; a particle and a plane, if twice the distance of the centre
        /// from the plane is below it \[m\].
        pub create_distance: Option<Positive> = "required unless the pairs are listed",
        /// λ: bond radius r_b = λ min(R_i, R_j), at a plane λ R_i.
        pub radius_multiplier: Option<Positive> = "1",
        /// Normal stiffness k_n, per unit area \[Pa/m\].
        pub normal_stiffness: Positive = "required",
        /// Tangential stiffness k_t, per unit area \[Pa/m\].
        pub tangential_stiffness: NonNegative = "required",
        /// Whether a stretched bond pulls.
        #[serde(default = "yes")]
        pub tension: bool = "`true`",
        /// Whether a compressed bond pushes.
        #[serde(default = "yes")]
        pub compression: bool = "`true`",
        /// Whether the bond bears shear.
        #[serde(default = "yes")]
        pub shear: bool = "`true`",
        /// Whether the bond bears torsion.
        #[serde(default = "yes")]
        pub torsion: bool = "`true`",
        /// Whether the bond bears bending.
        #[serde(default = "yes")]
        pub bending: bool = "`true`",
        /// What the contact law does between bonded bodies: see below.
        #[serde(default)]
        pub contact: ContactPolicy = "`\"parallel\"`",
        /// A table of one damping model: see below.
        pub damping: Option<DampingChoice> = "none",
        /// Relaxation times τ of its parts \[s\]: see below.
        pub relaxation: Option<PartKeys<Positive>> = "none",
        /// Conductivity of its material, in parallel to the contact \[W/(m K)\].
        pub conductivity: Option<Positive> = "conducts nothing",
    } beside {
        /// When bonds break, in the order of the rules; never where there is none. The reader of scenes reads each by its row.
        #[serde(skip)]
        pub breakage: Vec<BreakageChoice>,
        /// Refused.
        pub temperature_break: Option<Never>,
    }
}

impl Keys {
    /// Every contradiction among the keys.
    pub(super) fn contradictions(&self) -> Vec<KeyError> {
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
            "expected sign, smooth or none in engine_exact, which has only the engine's damping, found another one",
        );
        wrong
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
