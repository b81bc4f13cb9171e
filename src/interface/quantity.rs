//! What variables measure, and their units.

/// Exponents of the SI base units in a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BaseUnits {
    /// Of the kilogram.
    pub kilogram: i32,
    /// Of the metre.
    pub metre: i32,
    /// Of the second.
    pub second: i32,
    /// Of the kelvin.
    pub kelvin: i32,
    /// Of the radian.
    pub radian: i32,
}

/// The type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// A real number.
    Real,
    /// A whole number.
    Integer,
    /// A text.
    String,
}

/// Declares the quantities: name, symbol of the unit, exponents of kilogram, metre, second and radian, and of the
/// kelvin where it is in the unit.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident $unit:expr, $kilogram:literal $metre:literal $second:literal $radian:literal $($kelvin:literal)?;)+) => {
        /// What a variable measures.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Quantity {
            $($(#[$doc])* $name,)+
        }

        impl Quantity {
            /// All of them.
            const ALL: &'static [Self] = &[$(Self::$name),+];

            /// Its name.
            pub fn name(self) -> &'static str {
                match self { $(Self::$name => stringify!($name),)+ }
            }

            /// Symbol of its unit; none for a count, which is an integer, and for a text.
            pub fn unit(self) -> Option<&'static str> {
                match self { $(Self::$name => $unit,)+ }
            }

            /// Its unit in SI base units.
            pub fn base_units(self) -> BaseUnits {
                let (kilogram, metre, second, radian, kelvin) =
                    match self { $(Self::$name => ($kilogram, $metre, $second, $radian, 0 $(+ $kelvin)?),)+ };
                BaseUnits { kilogram, metre, second, kelvin, radian }
            }
        }
    };
}

quantities! {
    /// \[m\]
    Length Some("m"), 0 1 0 0;
    /// \[m³\]
    Volume Some("m3"), 0 3 0 0;
    /// \[m/s\]
    Velocity Some("m/s"), 0 1 -1 0;
    /// \[rad\]
    Angle Some("rad"), 0 0 0 1;
    /// \[rad/s\]
    AngularVelocity Some("rad/s"), 0 0 -1 1;
    /// \[N\]
    Force Some("N"), 1 1 -2 0;
    /// \[N/s\]
    ForceRate Some("N/s"), 1 1 -3 0;
    /// Moment of forces \[N m\]
    Torque Some("N.m"), 1 2 -2 0;
    /// Mean square of velocities \[m²/s²\]
    GranularTemperature Some("m2/s2"), 0 2 -2 0;
    /// \[J\]
    Energy Some("J"), 1 2 -2 0;
    /// \[kg\]
    Mass Some("kg"), 1 0 0 0;
    /// \[s\]
    Time Some("s"), 0 0 1 0;
    /// One length over another \[1\]
    Ratio Some("1"), 0 0 0 0;
    /// \[kg/m³\]
    Density Some("kg/m3"), 1 -3 0 0;
    /// \[Pa\]
    Pressure Some("Pa"), 1 -1 -2 0;
    /// Force over length \[N/m\]
    Stiffness Some("N/m"), 1 0 -2 0;
    /// Pressure over length \[Pa/m\]
    StiffnessPerArea Some("Pa/m"), 1 -2 -2 0;
    /// Gradient of a pressure \[Pa/m\]
    PressureGradient Some("Pa/m"), 1 -2 -2 0;
    /// Energy over volume \[J/m³\]
    EnergyDensity Some("J/m3"), 1 -1 -2 0;
    /// Energy over area \[J/m²\]
    SurfaceEnergy Some("J/m2"), 1 0 -2 0;
    /// Viscosity of a fluid \[Pa s\]
    Viscosity Some("Pa.s"), 1 -1 -1 0;
    /// Force over velocity \[kg/s\]
    Damping Some("kg/s"), 1 0 -1 0;
    /// Mass over time \[kg/s\]
    MassFlow Some("kg/s"), 1 0 -1 0;
    /// Force over velocity and mass \[1/s\]
    DampingRate Some("1/s"), 0 0 -1 0;
    /// Temperature \[K\]
    Temperature Some("K"), 0 0 0 0 1;
    /// Heat over time \[W\]
    HeatFlow Some("W"), 1 2 -3 0;
    /// Conductivity \[W/(m K)\]
    Conductivity Some("W/(m.K)"), 1 1 -3 0 -1;
    /// Heat over mass and temperature \[J/(kg K)\]
    SpecificHeat Some("J/(kg.K)"), 0 2 -2 0 -1;
    /// Heat flow over area and temperature \[W/(m² K)\]
    HeatTransferCoefficient Some("W/(m2.K)"), 1 0 -3 0 -1;
    /// Heat flow over temperature \[W/K\]
    Conductance Some("W/K"), 1 2 -3 0 -1;
    /// A number of things over time \[1/s\]
    CountRate Some("1/s"), 0 0 -1 0;
    /// Force over velocity, mass and length \[1/(m s)\]
    DampingRatePerLength Some("1/(m.s)"), 0 -1 -1 0;
    /// A whole number of things
    Count None, 0 0 0 0;
    /// A text
    Text None, 0 0 0 0;
}

impl Quantity {
    /// The type of what has it.
    pub fn of_type(self) -> Type {
        match self {
            Self::Count => Type::Integer,
            Self::Text => Type::String,
            _ => Type::Real,
        }
    }

    /// The quantity of a parameter with this unit; a whole number without one.
    pub(super) fn of_unit(unit: Option<&str>) -> Self {
        Self::ALL.iter().copied().find(|quantity| quantity.unit() == unit).unwrap_or(Self::Ratio)
    }
}
