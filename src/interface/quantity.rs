//! What variables measure, and their units.

/// What a variable measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// \[m\]
    Length,
    /// \[m/s\]
    Velocity,
    /// \[rad\]
    Angle,
    /// \[rad/s\]
    AngularVelocity,
    /// \[N\]
    Force,
    /// Moment of forces \[N m\]
    Torque,
    /// \[J\]
    Energy,
    /// \[kg\]
    Mass,
    /// \[s\]
    Time,
    /// One length over another \[1\]
    Ratio,
    /// A whole number of things
    Count,
}

/// Exponents of the SI base units in a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BaseUnits {
    /// Of the kilogram.
    pub kilogram: i32,
    /// Of the metre.
    pub metre: i32,
    /// Of the second.
    pub second: i32,
    /// Of the radian.
    pub radian: i32,
}

impl Quantity {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "Length",
            Self::Velocity => "Velocity",
            Self::Angle => "Angle",
            Self::AngularVelocity => "AngularVelocity",
            Self::Force => "Force",
            Self::Torque => "Torque",
            Self::Energy => "Energy",
            Self::Mass => "Mass",
            Self::Time => "Time",
            Self::Ratio => "Ratio",
            Self::Count => "Count",
        }
    }

    /// Symbol of its unit; none for a count, which is an integer.
    pub fn unit(self) -> Option<&'static str> {
        match self {
            Self::Length => Some("m"),
            Self::Velocity => Some("m/s"),
            Self::Angle => Some("rad"),
            Self::AngularVelocity => Some("rad/s"),
            Self::Force => Some("N"),
            Self::Torque => Some("N.m"),
            Self::Energy => Some("J"),
            Self::Mass => Some("kg"),
            Self::Time => Some("s"),
            Self::Ratio => Some("1"),
            Self::Count => None,
        }
    }

    /// Its unit in SI base units.
    pub fn base_units(self) -> BaseUnits {
        let (kilogram, metre, second, radian) = match self {
            Self::Length => (0, 1, 0, 0),
            Self::Velocity => (0, 1, -1, 0),
            Self::Angle => (0, 0, 0, 1),
            Self::AngularVelocity => (0, 0, -1, 1),
            Self::Force => (1, 1, -2, 0),
            Self::Torque | Self::Energy => (1, 2, -2, 0),
            Self::Mass => (1, 0, 0, 0),
            Self::Time => (0, 0, 1, 0),
            Self::Ratio | Self::Count => (0, 0, 0, 0),
        };
        BaseUnits { kilogram, metre, second, radian }
    }
}
