//! When bonds are made: each way is one file and one row in the list below. And what the contact law does between bonded bodies.

mod always;
mod contact_policy;
mod file;
mod pairs;
mod start;
mod step;
mod time;

pub use contact_policy::ContactPolicy;

use crate::quantity::NonNegative;
use serde::Deserialize;

/// Declares the list of ways to make bonds: yields the choice as the scene writes it (`create = "<name>"`, or
/// `create = { <name> = <value> }`). A new way is one row.
macro_rules! creations {
    ($($(#[$default:meta])* $row:ident $(($value:ident: $type:ty))?: $file:ident,)+) => {
        /// `create`
        #[derive(Clone, Debug, Default, PartialEq, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Creation {
            $($(#[$default])* #[doc = concat!("`", stringify!($file), "`")] $row $(($type))?,)+
        }

        impl Creation {
            /// Whether near pairs are bonded at this moment. Listed pairs are not searched by distance.
            pub fn bonds_near_pairs(&self, moment: &Moment) -> bool {
                match self { $(Self::$row $(($value))? => $file::Way::bonds_near_pairs(($($value,)?), moment),)+ }
            }

            /// When near pairs are to be bonded.
            pub fn due(&self) -> Due {
                match self { $(Self::$row $(($value))? => $file::Way::due(($($value,)?)),)+ }
            }

            /// Whether near pairs are searched in every step.
            pub fn is_continual(&self) -> bool {
                match self { $(Self::$row { .. } => $file::Way::IS_CONTINUAL,)+ }
            }

            /// The pairs that are bonded before the first step, if they are listed.
            pub fn listed(&self) -> Option<Listed<'_>> {
                match self { $(Self::$row $(($value))? => $file::Way::listed(($($value,)?)),)+ }
            }

            /// Why the time step must be given, if it must.
            pub fn needs_given_step(&self) -> Option<&'static str> {
                match self { $(Self::$row $(($value))? => $file::Way::needs_given_step(($($value,)?)),)+ }
            }

            /// What is wrong with the value, if anything.
            pub fn contradiction(&self) -> Option<&'static str> {
                match self { $(Self::$row $(($value))? => $file::Way::contradiction(($($value,)?)),)+ }
            }
        }
    };
}

creations! {
    #[default]
    Start: start,
    Always: always,
    Step(number: u64): step,
    Time(time: NonNegative): time,
    Pairs(pairs: Vec<[u32; 2]>): pairs,
    File(file: String): file,
}

/// A way to make bonds.
trait CreationWay {
    /// The type that the scene writes for it: nothing, or one value.
    type Value<'a>;
    /// Whether near pairs are searched in every step.
    const IS_CONTINUAL: bool = false;
    /// Whether near pairs are bonded at this moment.
    fn bonds_near_pairs(value: Self::Value<'_>, moment: &Moment) -> bool;
    /// When near pairs are to be bonded.
    fn due(_value: Self::Value<'_>) -> Due {
        Due::AtStart
    }
    /// The pairs that are bonded before the first step, if they are listed.
    fn listed(_value: Self::Value<'_>) -> Option<Listed<'_>> {
        None
    }
    /// Why the time step must be given, if it must.
    fn needs_given_step(_value: Self::Value<'_>) -> Option<&'static str> {
        None
    }
    /// What is wrong with the value, if anything.
    fn contradiction(_value: Self::Value<'_>) -> Option<&'static str> {
        None
    }
}

/// Pairs that a scene lists, by the ids of their particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Listed<'a> {
    /// In the scene itself.
    Here(&'a [[u32; 2]]),
    /// In a file of this name.
    InFile(&'a str),
}

/// When near pairs are to be bonded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Due {
    /// Before the first step, or never.
    AtStart,
    /// In every step.
    Always,
    /// In the time step of this number.
    Step(u64),
    /// In the time step that ends at this time or later \[s\].
    Time(f64),
}

/// Time steps to come.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Number of the time step before the first of them.
    pub after: u64,
    /// Number of the last one.
    pub until: u64,
    /// Time at their beginning \[s\].
    pub from: f64,
    /// Time at their end \[s\].
    pub to: f64,
}

impl Creation {
    /// Whether near pairs may be bonded in a time step of this window.
    pub fn comes_within(&self, window: &Window) -> bool {
        match self.due() {
            Due::AtStart => false,
            Due::Always => true,
            Due::Step(number) => window.after < number && number <= window.until,
            Due::Time(time) => window.from < time && time <= window.to,
        }
    }
}

/// A moment at which bonds may be made.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Number of the time step just made; 0 in the evaluation before the first.
    pub number: u64,
    /// Time at its beginning \[s\].
    pub from: f64,
    /// Time at its end, which is now \[s\].
    pub to: f64,
}

impl Moment {
    /// Before the first step.
    pub const START: Self = Self { number: 0, from: 0.0, to: 0.0 };
}

impl Creation {
    /// Whether there is a distance to be given.
    pub fn needs_distance(&self) -> bool {
        self.listed().is_none()
    }

    /// Whether pairs that are near before they move get a bond, then or in the first step.
    pub fn bonds_at_start(&self) -> bool {
        self.bonds_near_pairs(&Moment::START) || self.is_continual()
    }
}

/// Whether two spheres are near enough, from the distance of their centres \[m\].
pub fn near_pair(distance: f64, create_distance: f64) -> bool {
    distance < create_distance
}

/// Whether a sphere is near enough to a plane, from the distance of its centre: the plane counts as a mirror
/// sphere \[m\].
pub fn near_plane(distance: f64, create_distance: f64) -> bool {
    2.0 * distance < create_distance
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The moment of this step number at steps of 1 s.
    fn moment(number: u64) -> Moment {
        Moment { number, from: number as f64 - 1.0, to: number as f64 }
    }

    #[test]
    fn each_rule_bonds_in_its_steps_alone() {
        let bonds = |creation: Creation| {
            (0..5).filter(|&number| creation.bonds_near_pairs(&moment(number))).collect::<Vec<_>>()
        };
        let time = |time| Creation::Time(crate::quantity::NonNegative::new(time).unwrap());
        assert_eq!(bonds(Creation::Start), [0]);
        assert_eq!(bonds(Creation::Always), [1, 2, 3, 4]);
        assert_eq!(bonds(Creation::Step(3)), [3]);
        assert_eq!(bonds(time(0.0)), [0]);
        assert_eq!(bonds(time(2.0)), [2]);
        assert_eq!(bonds(time(2.1)), [3]);
        assert_eq!(bonds(Creation::Pairs(vec![])), [0; 0]);
    }

    #[test]
    fn a_plane_counts_as_a_mirror_sphere_and_the_limit_is_outside() {
        assert!(near_plane(0.9, 2.0) && !near_plane(1.0, 2.0));
        assert!(near_pair(1.9, 2.0) && !near_pair(2.0, 2.0));
    }
}
