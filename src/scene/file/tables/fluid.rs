//! A fluid, as the scene writes it.

use super::TemperatureKey;
use crate::base::document::{Forms, keys, several_forms};
use crate::base::quantity::{Porosity, Positive, Triple};
use crate::laws::motion::{Axis, PrescribedMotion};
use crate::scene::Pressure;
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess};
use std::collections::BTreeMap;

keys! {
    /// `[fluid.<name>]`, without its laws.
    #[derive(Debug)]
    pub(in crate::scene::file) struct FluidTable {
        /// Density ρ \[kg/m³\].
        pub(in crate::scene::file) density: Positive = "required",
        /// Dynamic viscosity µ \[Pa s\].
        pub(in crate::scene::file) viscosity: Positive = "required",
        /// Velocity between the particles \[m/s\]: `[x, y, z]`; `"driven"` (by inputs, from rest on) or `{ driven = [x, y, z] }`;
        /// `{ prescribed = { x = .. } }`, that of [motions](#boundaryname) of boundaries.
        pub(in crate::scene::file) velocity: Option<VelocityKey> = "rest",
        /// [Grid](#gridname) in whose box it is, with velocity, pressure gradient and porosity in each cell.
        pub(in crate::scene::file) grid: Option<String> = "everywhere",
        /// The pressure gradient is an input: `"total"`, or `"dynamic"` without ρ g.
        pub(in crate::scene::file) pressure: Option<Pressure> = "ρ g, no input",
        /// Part of space that the particles leave to it.
        pub(in crate::scene::file) porosity: Option<Porosity> = "1; laws of beds need it, or a grid",
        /// Added mass of a sphere over the mass of the fluid in its volume: 0.5 for one sphere.
        pub(in crate::scene::file) added_mass: Option<Positive> = "none",
        /// Whether it brakes rotation.
        #[serde(default)]
        pub(in crate::scene::file) torque: bool = "`false`",
        /// Temperature \[K\]: a number; `"driven"` from the mean of the particles on, or `{ driven = 300.0 }`.
        pub(in crate::scene::file) temperature: Option<TemperatureKey> = "required by convection",
        /// Conductivity \[W/(m K)\].
        pub(in crate::scene::file) conductivity: Option<Positive> = "required by convection",
        /// Specific heat \[J/(kg K)\].
        pub(in crate::scene::file) specific_heat: Option<Positive> = "required by convection",
    } beside {
        /// Read on its own.
        #[serde(rename = "drag")]
        _drag: Option<IgnoredAny>,
        /// Read on its own.
        #[serde(rename = "lift")]
        _lift: Option<IgnoredAny>,
        /// Read on its own.
        #[serde(rename = "heat")]
        _heat: Option<IgnoredAny>,
    }
}

/// `velocity` of a fluid.
#[derive(Clone, Debug)]
pub(in crate::scene::file) enum VelocityKey {
    /// A vector \[m/s\].
    Given(Triple),
    /// `"driven"`: from rest on.
    Driven,
    /// `{ driven = [0.1, 0.0, 0.0] }`: from this one on \[m/s\].
    DrivenFrom(Triple),
    /// `{ prescribed = { x = .. } }`: that of motions.
    Prescribed(BTreeMap<Axis, PrescribedMotion>),
}

/// What may stand in the braces.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Braces {
    /// The velocity at the start follows \[m/s\].
    Driven,
    /// Motions of axes follow.
    Prescribed,
}

impl Forms for VelocityKey {
    const EXPECTED: &'static str =
        "[x, y, z] [m/s], \"driven\", { driven = [x, y, z] } with that at the start, or { prescribed = { x = .. } }";

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        Triple::deserialize(SeqAccessDeserializer::new(list)).map(Self::Given)
    }

    fn word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "driven" => Ok(Self::Driven),
            _ => Err(Self::refused(word)),
        }
    }

    fn table<'de, A: MapAccess<'de>>(mut map: A) -> Result<Self, A::Error> {
        let Some(kind) = map.next_key()? else {
            return Err(A::Error::custom(format!("expected {}, found an empty table", Self::EXPECTED)));
        };
        let velocity = match kind {
            Braces::Driven => Self::DrivenFrom(map.next_value()?),
            Braces::Prescribed => Self::Prescribed(map.next_value()?),
        };
        match map.next_key::<String>()? {
            None => Ok(velocity),
            Some(more) => Err(A::Error::custom(format!("expected one of the two, found {more} beside it"))),
        }
    }
}
several_forms!(VelocityKey);
