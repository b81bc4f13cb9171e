//! `motion` of a boundary as the scene writes it.

use super::{AxisMotion, Schedule, Servo, Table, TableKeys};
use crate::base::document::{Forms, several_forms};
use crate::base::quantity::Finite;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Unexpected};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A way to move: along a coordinate axis, or about one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Axis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
    /// Rotation about x
    #[serde(rename = "rotation.x")]
    RotationX,
    /// Rotation about y
    #[serde(rename = "rotation.y")]
    RotationY,
    /// Rotation about z
    #[serde(rename = "rotation.z")]
    RotationZ,
}

/// `motion` of a boundary; an axis not named is fixed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Keys(Names);

/// A constant velocity \[m/s\] or angular velocity \[rad/s\], a schedule, or a table of a file.
#[derive(Clone, Debug)]
pub(crate) enum PrescribedMotion {
    /// It stands in the scene.
    Here(AxisMotion),
    /// It stands in a file.
    Table(TableKeys),
}

impl PrescribedMotion {
    /// The motion; `read` finds its table.
    pub(crate) fn of_axis(&self, read: impl FnOnce(&TableKeys) -> Option<Table>) -> AxisMotion {
        match self {
            Self::Here(motion) => motion.clone(),
            Self::Table(keys) => {
                read(keys).map_or(AxisMotion::Prescribed(0.0), |table| AxisMotion::Tabulated(Arc::new(table)))
            }
        }
    }
}

/// What may stand in the braces of a prescribed motion.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Law {
    /// To and fro.
    Sine,
    /// To another place and there it stays.
    Trapezoid,
    /// Point by point.
    Table,
}

impl Forms for PrescribedMotion {
    const EXPECTED: &'static str = "a velocity, { sine = { amplitude, frequency } }, { trapezoid = { distance, speed, acceleration } } or { table = \"motion.csv\" }";

    fn number<E: Error>(value: f64, _written: Unexpected) -> Result<Self, E> {
        let velocity = Finite::new(value).map(|velocity| Self::Here(AxisMotion::Prescribed(velocity.get())));
        velocity.ok_or_else(|| E::custom(format!("expected a finite number, found {value:?}")))
    }

    fn table<'de, A: MapAccess<'de>>(mut map: A) -> Result<Self, A::Error> {
        let scheduled = |schedule| Self::Here(AxisMotion::Scheduled(schedule));
        let Some(law) = map.next_key()? else {
            return Err(A::Error::custom(format!("expected {}, found an empty table", Self::EXPECTED)));
        };
        let motion = match law {
            Law::Sine => scheduled(Schedule::Sine(map.next_value()?)),
            Law::Trapezoid => scheduled(Schedule::Trapezoid(map.next_value()?)),
            Law::Table => Self::Table(map.next_value()?),
        };
        match map.next_key::<String>()? {
            None => Ok(motion),
            Some(more) => Err(A::Error::custom(format!("expected one law, found {more} beside another one"))),
        }
    }
}
several_forms!(PrescribedMotion);

/// The axes by what they do.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Names {
    /// Those that stay.
    #[serde(default)]
    fixed: Vec<Axis>,
    /// Those along which the surface runs in itself, and how fast \[m/s\].
    #[serde(default)]
    conveying: BTreeMap<Axis, Finite>,
    /// Those that follow an input.
    #[serde(default)]
    driven: Vec<Axis>,
    /// What the inputs of those are.
    #[serde(default)]
    by: By,
    /// Those that move as the scene says.
    #[serde(default)]
    prescribed: BTreeMap<Axis, PrescribedMotion>,
    /// Those that move by the forces on the boundary.
    #[serde(default)]
    free: Vec<Axis>,
    /// Those that move by the forces on the boundary and a given one.
    #[serde(default)]
    loaded: Loads,
    /// Those that reach a force.
    #[serde(default)]
    servo: BTreeMap<Axis, Servo>,
}

/// What the inputs of driven axes are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum By {
    /// Displacements and rotations.
    #[default]
    Displacement,
    /// Velocities and angular velocities.
    Velocity,
}

/// Axes with a load: a list, or a table of what each load starts with \[N, N m\].
#[derive(Clone, Debug, Default)]
struct Loads(BTreeMap<Axis, Finite>);

impl Forms for Loads {
    const EXPECTED: &'static str = "a list of axes, or a table of axes and the load [N, N m] that each starts with";

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let axes = Vec::<Axis>::deserialize(SeqAccessDeserializer::new(list))?;
        let mut loads = BTreeMap::new();
        for axis in axes {
            if loads.insert(axis, Finite::default()).is_some() {
                let axis = AxisMotion::WORDS[axis as usize];
                return Err(A::Error::custom(format!("expected each axis once, found {axis} twice")));
            }
        }
        Ok(Self(loads))
    }

    fn table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        BTreeMap::deserialize(MapAccessDeserializer::new(map)).map(Self)
    }
}
several_forms!(Loads);

impl Keys {
    /// What each axis does, and those that are named twice; `read` finds the table of an axis.
    pub(crate) fn axes(
        &self,
        mut read: impl FnMut(usize, &TableKeys) -> Option<Table>,
    ) -> ([AxisMotion; 6], Vec<usize>) {
        let Names { fixed, conveying, driven, by, prescribed, free, loaded, servo } = &self.0;
        let leads = match by {
            By::Displacement => AxisMotion::Driven,
            By::Velocity => AxisMotion::VelocityDriven,
        };
        let named = (fixed.iter().map(|axis| (*axis, AxisMotion::Fixed)))
            .chain(conveying.iter().map(|(axis, velocity)| (*axis, AxisMotion::Conveying(velocity.get()))))
            .chain(driven.iter().map(|axis| (*axis, leads.clone())))
            .chain(prescribed.iter().map(|(axis, motion)| (*axis, motion.of_axis(|keys| read(*axis as usize, keys)))))
            .chain(free.iter().map(|axis| (*axis, AxisMotion::Free)))
            .chain(loaded.0.iter().map(|(axis, start)| (*axis, AxisMotion::Loaded(start.get()))))
            .chain(servo.iter().map(|(axis, servo)| (*axis, AxisMotion::Servo(*servo))));
        let (mut axes, mut twice) = ([const { None }; 6], Vec::new());
        for (axis, motion) in named {
            if axes[axis as usize].replace(motion).is_some() {
                twice.push(axis as usize);
            }
        }
        (axes.map(|motion| motion.unwrap_or(AxisMotion::Fixed)), twice)
    }

    /// Whether a way is said in which no axis is driven.
    pub(crate) fn drives_nothing_by_velocity(&self) -> bool {
        self.0.by == By::Velocity && self.0.driven.is_empty()
    }
}

impl Forms for Keys {
    const EXPECTED: &'static str = "\"fixed\" or a table of conveying, driven, prescribed, free, loaded and servo axes";

    fn word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "fixed" => Ok(Self::default()),
            _ => Err(Self::refused(word)),
        }
    }

    fn table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        Names::deserialize(MapAccessDeserializer::new(map)).map(Self)
    }
}
several_forms!(Keys);
