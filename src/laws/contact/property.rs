//! Numbers that laws take from materials and from pairs of them: each is declared once.

use super::LawChoice;
use super::normal::sticky::{self, DampingKind};
use crate::base::quantity::Range;
use std::fmt;

/// A number that laws take from two materials in contact, or from one, declared once: its key in `[pair.<a>.<b>]` or `[material.<name>]`,
/// which is a parameter of units, too.
///
/// A law of another crate declares its own, and names them in `PAIR_PROPERTIES` and `MATERIAL_PROPERTIES` of its trait.
#[derive(Clone, Copy)]
pub struct Property {
    /// Its key.
    pub name: &'static str,
    /// Its unit, as variables of a unit have it.
    pub unit: PropertyUnit,
    /// Which numbers it takes.
    pub range: Range,
    /// Whether it may be changed between communication steps, as that of a pair may.
    pub tunable: bool,
    /// What it is, in a few words.
    pub about: &'static str,
}

/// The unit of a property.
#[derive(Clone, Copy)]
pub enum PropertyUnit {
    /// Always this.
    Always(&'static str),
    /// By the law that governs two materials.
    ByLaw(fn(&LawChoice) -> &'static str),
}
use PropertyUnit::{Always, ByLaw};

impl fmt::Debug for Property {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// Declares the properties of the program, the list of them, and the table of the documentation: of each the meaning, and what needs it.
macro_rules! standard {
    ($(
        $(#[doc = $meaning:literal])+
        $place:ident: $name:literal, $unit:expr, $range:expr, $tunable:expr, $about:literal, $needed_by:literal;
    )+) => {
        $(
            $(#[doc = $meaning])+
            pub static $place: Property = Property {
                name: $name, unit: $unit, range: $range, tunable: $tunable, about: $about,
            };
        )+
        /// The properties of two materials that the program has.
        pub const STANDARD: &[&Property] = &[$(&$place),+];

        #[cfg(test)]
        const DOCUMENTED: &[(&str, &str)] = &[$((concat!($($meaning),+), $needed_by)),+];
    };
}

/// Whether a property may be changed between communication steps.
const TUNABLE: bool = true;
/// It stays once the unit is initialised.
const FIXED: bool = false;

standard! {
    /// Coefficient of restitution e.
    RESTITUTION: "restitution", Always("1"), Range::RESTITUTION, TUNABLE, "coefficient of restitution", "`hertz`, `hooke`, `eepa`";
    /// Coefficient of friction µ.
    FRICTION: "friction", Always("1"), Range::NON_NEGATIVE, TUNABLE, "coefficient of friction", "`history`, `no_history`, `rescaled`, `turned_history`";
    /// Coefficient of rolling friction µ_r.
    ROLLING_FRICTION: "rolling_friction", Always("1"), Range::NON_NEGATIVE, TUNABLE, "coefficient of rolling friction", "`cdt`, `epsd`, `epsd2`";
    /// Cohesion energy density c \[J/m³\].
    COHESION_ENERGY_DENSITY: "cohesion_energy_density", Always("J/m3"), Range::NON_NEGATIVE, TUNABLE, "cohesion energy density", "`sjkr`, `sjkr2`";
    /// Given normal stiffness κ_n: of `hooke_stiffness` \[N/m\], of `hertz_stiffness` \[Pa\].
    NORMAL_STIFFNESS: "normal_stiffness", ByLaw(stiffness), Range::NON_NEGATIVE, FIXED, "given normal stiffness", "`hooke_stiffness`, `hertz_stiffness`";
    /// Given tangential stiffness κ_t: of `hooke_stiffness` \[N/m\], of `hertz_stiffness`, `jkr`, `dmt` \[Pa\].
    TANGENTIAL_STIFFNESS: "tangential_stiffness", ByLaw(stiffness), Range::NON_NEGATIVE, FIXED, "given tangential stiffness", "`hooke_stiffness`, `hertz_stiffness` with friction; `jkr`, `dmt` with `given_tangential_modulus`; `turned_history` with `given_stiffness`";
    /// Given normal damping for each effective mass: of `hooke_stiffness` \[1/s\], of `hertz_stiffness` \[1/(m s)\].
    NORMAL_DAMPING: "normal_damping", ByLaw(damping), Range::NON_NEGATIVE, TUNABLE, "given normal damping over the effective mass", "`hooke_stiffness`, `hertz_stiffness`";
    /// Given tangential damping for each effective mass: of `hooke_stiffness` \[1/s\], of `hertz_stiffness` \[1/(m s)\].
    TANGENTIAL_DAMPING: "tangential_damping", ByLaw(damping), Range::NON_NEGATIVE, TUNABLE, "given tangential damping over the effective mass", "the same, with friction";
    /// Given normal damping whatever the masses \[kg/s\].
    ABSOLUTE_NORMAL_DAMPING: "absolute_normal_damping", Always("kg/s"), Range::NON_NEGATIVE, TUNABLE, "given normal damping", "`hooke_stiffness` with `absolute_damping`";
    /// Given tangential damping whatever the masses \[kg/s\].
    ABSOLUTE_TANGENTIAL_DAMPING: "absolute_tangential_damping", Always("kg/s"), Range::NON_NEGATIVE, TUNABLE, "given tangential damping", "the same, with friction";
    /// Viscosity of the fluid between the bodies, η \[Pa s\].
    FLUID_VISCOSITY: "fluid_viscosity", Always("Pa.s"), Range::POSITIVE, TUNABLE, "viscosity of the fluid between the bodies", "`hooke_viscous`";
    /// Critical Stokes number of the fluid between the bodies.
    CRITICAL_STOKES_NUMBER: "critical_stokes_number", Always("1"), Range::POSITIVE, TUNABLE, "critical Stokes number of the fluid between the bodies", "`hooke_viscous`";
    /// Largest coefficient of restitution, without fluid.
    MAXIMUM_RESTITUTION: "maximum_restitution", Always("1"), Range::RESTITUTION, TUNABLE, "largest coefficient of restitution", "`hooke_viscous`";
    /// Damping of a rolling spring over its critical damping, η_r.
    ROLLING_VISCOUS_DAMPING: "rolling_viscous_damping", Always("1"), Range::NON_NEGATIVE, TUNABLE, "damping of the rolling spring over its critical damping", "`epsd`";
    /// Surface energy γ, half the work of adhesion of `jkr` and `dmt` \[J/m²\].
    SURFACE_ENERGY: "surface_energy", Always("J/m2"), Range::NON_NEGATIVE, TUNABLE, "surface energy, half the work of adhesion", "`jkr`, `dmt`, `eepa` with `adhesion = \"patch\"`";
    /// Damping η: \[1/(m s)\], \[1/s\] or \[kg/s\], as the key `damping` says.
    DAMPING_COEFFICIENT: "damping_coefficient", ByLaw(sticky_damping), Range::NON_NEGATIVE, TUNABLE, "damping of jkr and dmt", "`jkr`, `dmt`";
    /// Tangential damping over normal damping, x_t.
    TANGENTIAL_DAMPING_RATIO: "tangential_damping_ratio", Always("1"), Range::NON_NEGATIVE, TUNABLE, "tangential damping over normal damping", "`jkr`, `dmt` with friction";
    /// Stiffness of unloading over that of loading, k₂/k₁.
    UNLOADING_STIFFNESS_RATIO: "unloading_stiffness_ratio", Always("1"), Range::AT_LEAST_ONE, FIXED, "stiffness of unloading over that of loading", "`eepa`";
    /// Constant attraction of touching bodies, f₀ \[N\].
    PULL_OFF_FORCE: "pull_off_force", Always("N"), Range::NON_NEGATIVE, TUNABLE, "constant attraction of touching bodies", "`eepa`";
    /// Stiffness of the adhesion branch over that of loading, k_a/k₁.
    ADHESION_STIFFNESS_RATIO: "adhesion_stiffness_ratio", Always("1"), Range::NON_NEGATIVE, FIXED, "stiffness of the adhesion branch over that of loading", "`eepa` with `adhesion = \"fixed\"`";
    /// Conductivity of both, in place of those of the materials, k \[W/(m K)\].
    CONDUCTIVITY: "conductivity", Always("W/(m.K)"), Range::POSITIVE, FIXED, "conductivity of both materials", "`constriction`, `overlap_area`, unless both materials have one";
    /// Heat transfer coefficient of the area of contact, h \[W/(m² K)\].
    HEAT_TRANSFER_COEFFICIENT: "heat_transfer_coefficient", Always("W/(m2.K)"), Range::NON_NEGATIVE, FIXED, "heat transfer coefficient of the area of contact", "`transfer`";
}

/// Of a given stiffness: a force over a length, or a pressure where the overlap or the contact radius is a factor.
fn stiffness(law: &LawChoice) -> &'static str {
    let is_pressure = law.normal.name() == "hertz_stiffness" || law.normal.keys::<sticky::Keys>().is_some();
    if is_pressure { "Pa" } else { "N/m" }
}

/// Of a given damping over the effective mass.
fn damping(law: &LawChoice) -> &'static str {
    if law.normal.name() == "hertz_stiffness" { "1/(m.s)" } else { "1/s" }
}

/// Of the damping of `jkr` and `dmt`.
fn sticky_damping(law: &LawChoice) -> &'static str {
    match law.normal.keys::<sticky::Keys>().map(|keys| keys.damping) {
        Some(DampingKind::MassVelocity) => "1/s",
        Some(DampingKind::Velocity) => "kg/s",
        Some(DampingKind::Viscoelastic) | None => "1/(m.s)",
    }
}

/// Properties as far as a scene gives them: of two materials in contact, `[pair.<a>.<b>]`, or of one.
#[derive(Clone, Debug, Default)]
pub struct Properties(Vec<(&'static Property, f64)>);

impl PartialEq for Properties {
    /// Whatever the order in which they were given.
    fn eq(&self, other: &Self) -> bool {
        self.0.len() == other.0.len() && self.iter().all(|(property, value)| other.get(property) == Some(value))
    }
}

impl Properties {
    /// The value of a property, if it is given.
    pub fn get(&self, property: &Property) -> Option<f64> {
        self.named(property.name).map(|(_, value)| value)
    }

    /// The property of this key and its value, if it is given.
    pub fn named(&self, key: &str) -> Option<(&'static Property, f64)> {
        self.iter().find(|(own, _)| own.name == key)
    }

    /// The same with this value of a property.
    pub fn with(mut self, property: &'static Property, value: f64) -> Self {
        self = self.without(property);
        self.0.push((property, value));
        self
    }

    /// The same without a property.
    pub fn without(mut self, property: &Property) -> Self {
        self.0.retain(|(own, _)| own.name != property.name);
        self
    }

    /// Those that are given, and their values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Property, f64)> + '_ {
        self.0.iter().copied()
    }

    /// For each property that is given: its key, and these properties without it and with another value of it. What reads it can
    /// tell them apart.
    pub(crate) fn variants(&self) -> impl Iterator<Item = (&'static str, Vec<Self>)> + '_ {
        self.iter().map(|(property, value)| {
            let others = [0.37, 1.37, 0.5 * value, 2.0 * value];
            let another = others.into_iter().find(|other| *other != value && property.range.check(*other).is_ok());
            let without = self.clone().without(property);
            let with = another.map(|other| without.clone().with(property, other));
            (property.name, [without].into_iter().chain(with).collect())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of the documentation.
    fn table() -> String {
        let line = |(property, (meaning, needed_by)): (&&Property, &(&str, &str))| {
            let (meaning, range) = (meaning.trim().trim_end_matches('.'), property.range.words());
            format!("| `{}` | {meaning}, {range} | {needed_by} |\n", property.name)
        };
        let lines: String = STANDARD.iter().zip(DOCUMENTED).map(line).collect();
        format!("| key | meaning | needed by |\n|---|---|---|\n{lines}")
    }

    #[test]
    fn the_properties_of_a_pair_stand_in_the_documentation_as_they_are_declared() {
        let page = include_str!("../../../docs/scene.md");
        assert!(page.contains(&table()), "docs/scene.md lacks the table\n\n{}", table());
    }

    #[test]
    fn equal_properties_are_equal_in_any_order() {
        let one = Properties::default().with(&FRICTION, 0.1).with(&RESTITUTION, 0.2);
        let other = Properties::default().with(&RESTITUTION, 0.2).with(&FRICTION, 0.3).with(&FRICTION, 0.1);
        assert_eq!(one, other);
        assert_ne!(one, other.clone().without(&FRICTION));
        assert_ne!(one, other.with(&FRICTION, 0.2));
    }

    #[test]
    fn another_value_is_one_that_the_property_takes() {
        for value in [0.37, 1.0] {
            let given = Properties::default().with(&RESTITUTION, value);
            let (key, variants) = given.variants().next().unwrap();
            assert_eq!((key, variants[0].get(&RESTITUTION)), ("restitution", None));
            let another = variants[1].get(&RESTITUTION).unwrap();
            assert!(another != value && RESTITUTION.range.check(another).is_ok(), "{another}");
        }
    }
}
