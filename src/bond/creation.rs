//! When bonds are made, and what the contact law does between bonded bodies.

use serde::Deserialize;

/// When bonds are made.
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
    /// In the first time step that ends at this time or later \[s\].
    Time(crate::quantity::NonNegative),
    /// Before the first step, between the particles with these ids; a pair further apart than
    /// `create_distance`, where that is given, is an error.
    Pairs(Vec<[u32; 2]>),
    /// As `pairs`, from a file: CSV with columns `id1`, `id2`, or a LIGGGHTS or LAMMPS bond list.
    File(String),
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

impl Creation {
    /// Whether near pairs are bonded at this moment. Listed pairs are not looked for by distance.
    pub fn bonds_near_pairs(&self, moment: &Moment) -> bool {
        match *self {
            Self::Start => moment.number == 0,
            Self::Always => moment.number > 0,
            Self::Step(number) => moment.number == number,
            Self::Time(time) if time.get() <= 0.0 => moment.number == 0,
            Self::Time(time) => moment.number > 0 && moment.from < time.get() && time.get() <= moment.to,
            Self::Pairs(_) | Self::File(_) => false,
        }
    }

    /// Whether there is a distance to be given.
    pub fn needs_distance(&self) -> bool {
        !matches!(self, Self::Pairs(_) | Self::File(_))
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

/// Contact of a pair whose bond hides, or has hidden, the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hidden {
    /// Overlap from which the elastic normal force is taken; stiffness and damping are those of the whole overlap \[m\].
    pub pressing: f64,
    /// Whether that normal force acts. The friction limit sees it in both cases, as in the engine.
    pub acts: bool,
    /// Offset to remember; 0 once the bodies part \[m\].
    pub offset: f64,
}

/// What is hidden of an overlap, from the offset remembered \[m\] and how the pair stood before the creations of this
/// step.
///
/// While bonded, the overlap becomes the offset. Afterwards what goes beyond the offset presses, and the offset shrinks with
/// the overlap.
pub fn hidden(overlap: f64, offset: f64, bonded: bool) -> Hidden {
    let offset = offset.min(overlap);
    Hidden { pressing: overlap - offset, acts: !bonded, offset: if bonded { overlap } else { offset } }
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

    #[test]
    fn a_hidden_contact_presses_from_where_the_bond_left_it() {
        let found = hidden(3.0, 0.0, true);
        assert_eq!((found.acts, found.offset), (false, 3.0));
        assert_eq!(hidden(3.5, found.offset, false), Hidden { pressing: 0.5, acts: true, offset: 3.0 });
        assert_eq!(hidden(2.0, found.offset, false), Hidden { pressing: 0.0, acts: true, offset: 2.0 });
        assert_eq!(hidden(2.5, 2.0, false), Hidden { pressing: 0.5, acts: true, offset: 2.0 });
    }
}
