//! When bonds are made, and what the contact law does between bonded bodies.

use crate::base::quantity::NonNegative;
use serde::Deserialize;

/// When bonds are made, as the scene writes it: `create = "<name>"`, or `create = { <name> = <value> }`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Creation {
    /// Before the first step, between all pairs near enough.
    #[default]
    Start,
    /// In every step, between pairs near enough that have no bond.
    Always,
    /// In the time step of this number; the first is 1.
    Step(u64),
    /// In the first time step that ends at this time or later; time 0 is before the first step \[s\].
    Time(NonNegative),
    /// Before the first step, between the particles with these ids; a pair further apart than `create_distance`, where that
    /// is given, is an error.
    Pairs(Vec<[u32; 2]>),
    /// As `pairs`, from a file: CSV with columns `id1`, `id2`, or a LIGGGHTS or LAMMPS bond list.
    File(String),
}

/// What the contact law does between bonded bodies that overlap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactPolicy {
    /// Contact and bond act side by side (as in the engine).
    #[default]
    Parallel,
    /// No normal force of the contact while bonded; afterwards it grows from 0 at the overlap that is left
    /// (`disableNormalWhenBonded`).
    WithoutNormal,
    /// No contact at all while bonded; afterwards as `without_normal`, with a fresh spring.
    None,
}

/// Pairs that a scene lists, by the ids of their particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ListedPairs<'a> {
    /// In the scene itself.
    Here(&'a [[u32; 2]]),
    /// In a file of this name.
    InFile(&'a str),
}

/// When near pairs are to be bonded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CreationTime {
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
    /// Whether near pairs are bonded at this moment. Listed pairs are not searched by distance.
    pub fn bonds_near_pairs(&self, moment: &Moment) -> bool {
        match self {
            Self::Start => moment.number == 0,
            Self::Always => moment.number > 0,
            Self::Step(number) => moment.number == *number,
            Self::Time(time) if time.get() <= 0.0 => moment.number == 0,
            Self::Time(time) => moment.number > 0 && moment.from < time.get() && time.get() <= moment.to,
            Self::Pairs(_) | Self::File(_) => false,
        }
    }

    /// When near pairs are to be bonded.
    pub fn due(&self) -> CreationTime {
        match self {
            Self::Always => CreationTime::Always,
            Self::Step(number) => CreationTime::Step(*number),
            Self::Time(time) => CreationTime::Time(time.get()),
            Self::Start | Self::Pairs(_) | Self::File(_) => CreationTime::AtStart,
        }
    }

    /// Whether near pairs may be bonded in a time step of this window.
    pub fn comes_within(&self, window: &Window) -> bool {
        match self.due() {
            CreationTime::AtStart => false,
            CreationTime::Always => true,
            CreationTime::Step(number) => window.after < number && number <= window.until,
            CreationTime::Time(time) => window.from < time && time <= window.to,
        }
    }

    /// Whether near pairs are searched in every step.
    pub fn is_continual(&self) -> bool {
        matches!(self, Self::Always)
    }

    /// Whether pairs that are near before they move get a bond, then or in the first step.
    pub fn bonds_at_start(&self) -> bool {
        self.bonds_near_pairs(&Moment::START) || self.is_continual()
    }

    /// The pairs that are bonded before the first step, if they are listed.
    pub fn listed(&self) -> Option<ListedPairs<'_>> {
        match self {
            Self::Pairs(pairs) => Some(ListedPairs::Here(pairs)),
            Self::File(file) => Some(ListedPairs::InFile(file)),
            Self::Start | Self::Always | Self::Step(_) | Self::Time(_) => None,
        }
    }

    /// Whether there is a distance to be given.
    pub fn needs_distance(&self) -> bool {
        self.listed().is_none()
    }

    /// Why the time step must be given, if it must.
    pub fn needs_given_step(&self) -> Option<&'static str> {
        matches!(self, Self::Step(_)).then_some("bonds are made at a step number")
    }

    /// What is wrong with the value, if anything.
    pub fn contradiction(&self) -> Option<&'static str> {
        (*self == Self::Step(0)).then_some("expected a step from 1 on, found 0; \"start\" bonds before the first step")
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
        let time = |time| Creation::Time(crate::base::quantity::NonNegative::new(time).unwrap());
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
