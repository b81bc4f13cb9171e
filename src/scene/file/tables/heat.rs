//! Temperatures and heat sources, as the scene writes them.

use crate::base::document::{Forms, keys, several_forms};
use crate::base::quantity::{Finite, NonNegative, Positive};
use crate::laws::contact::LossKind;
use crate::laws::surface::Selection;
use crate::scene::HeatSettings;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Unexpected};

/// `temperature` of a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scene::file) enum TemperatureKey {
    /// A number \[K\].
    Given(f64),
    /// `"driven"`: from the mean temperature of the particles on.
    Driven,
    /// `{ driven = 300.0 }`: from this one on \[K\].
    DrivenFrom(f64),
}

impl Forms for TemperatureKey {
    const EXPECTED: &'static str = "a number above 0 [K], \"driven\", or { driven = .. } with that at the start";

    fn number<E: Error>(value: f64, _written: Unexpected) -> Result<Self, E> {
        Positive::new(value).map(|it| Self::Given(it.get())).ok_or_else(|| Self::refused(value))
    }

    fn word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "driven" => Ok(Self::Driven),
            _ => Err(Self::refused(word)),
        }
    }

    fn table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        /// `{ driven = 300.0 }`
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct From {
            /// Temperature at the start \[K\].
            driven: Positive,
        }
        let from = From::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Self::DrivenFrom(from.driven.get()))
    }
}
several_forms!(TemperatureKey);

keys! {
    /// `[heat]`
    #[derive(Debug, Default)]
    pub(in crate::scene::file) struct HeatTable {
        /// Whether heat flows while nothing moves.
        #[serde(default)]
        frozen: bool = "`false`",
        /// Losses that warm both bodies of a contact or bond: `normal_damping`, `tangential_damping`, `sliding`, `rolling`, `plastic`,
        /// `bond_damping`, `bond_release` ([heat.md](heat.md)).
        #[serde(default)]
        from_losses: Vec<WarmingLoss> = "none",
    }
}

impl HeatTable {
    /// What it says.
    pub(in crate::scene::file) fn settings(&self) -> HeatSettings {
        let mut settings = HeatSettings { frozen: self.frozen, ..HeatSettings::default() };
        for loss in &self.from_losses {
            match loss {
                WarmingLoss::BondDamping => settings.from_bonds.damping = true,
                WarmingLoss::BondRelease => settings.from_bonds.release = true,
                loss => loss.kind().into_iter().for_each(|kind| settings.from_losses[kind as usize] = true),
            }
        }
        settings
    }
}

/// A loss that is heat.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum WarmingLoss {
    /// Dashpots along the normal.
    NormalDamping,
    /// Dashpots in the tangent plane.
    TangentialDamping,
    /// Friction at its limit.
    Sliding,
    /// Work against rolling torque that its spring does not hold.
    Rolling,
    /// Work against plastic normal forces that they do not hold.
    Plastic,
    /// Damping and relaxation of bonds.
    BondDamping,
    /// What bonds hold that break.
    BondRelease,
}

impl WarmingLoss {
    /// Its kind among those of contacts.
    fn kind(self) -> Option<LossKind> {
        match self {
            Self::NormalDamping => Some(LossKind::Normal),
            Self::TangentialDamping => Some(LossKind::Tangential),
            Self::Sliding => Some(LossKind::Sliding),
            Self::Rolling => Some(LossKind::Rolling),
            Self::Plastic => Some(LossKind::Other),
            Self::BondDamping | Self::BondRelease => None,
        }
    }
}

keys! {
    /// `[heat_source.<name>]`
    #[derive(Debug)]
    pub(in crate::scene::file) struct HeatSourceTable {
        /// The [particles](#choosing-particles), none of a group.
        pub(in crate::scene::file) particles: Selection = "required",
        /// Heat flow into each \[W\].
        pub(in crate::scene::file) power: Option<Finite> = "one of the two",
        /// `{ temperature, conductance }`: surroundings \[K\] and conductance to each \[W/K\].
        pub(in crate::scene::file) ambient: Option<AmbientTable> = "one of the two",
    }
}

/// `ambient` of a heat source.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene::file) struct AmbientTable {
    /// Their temperature \[K\].
    pub(in crate::scene::file) temperature: Positive,
    /// Conductance to each particle \[W/K\].
    pub(in crate::scene::file) conductance: NonNegative,
}
