//! The particles, laid out for the loops that read them.

use super::check::{FINITE, StateFault, demand, demand_all};
use super::in_place::clone_in_place;
use super::{Row, plain};
use serde::{Deserialize, Serialize};

/// The slot of a particle that is no longer there.
pub const GONE: u32 = u32::MAX;

/// The owner of an image in a periodic cell: the particle of the same index moves it, and gets its loads.
pub const IMAGE: u32 = u32::MAX;

/// Particles in the order of the neighbour list, rows of 32 bytes.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Particles {
    /// x, y, z, radius \[m\].
    #[serde(with = "plain")]
    pub position: Vec<Row>,
    /// Velocity \[m/s\] and mass \[kg\].
    #[serde(with = "plain")]
    pub velocity: Vec<Row>,
    /// Angular velocity \[rad/s\] and moment of inertia \[kg m²\].
    #[serde(with = "plain")]
    pub angular_velocity: Vec<Row>,
    /// Force \[N\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub force: Vec<Row>,
    /// Torque \[N m\]; the fourth number is 0.
    #[serde(with = "plain")]
    pub torque: Vec<Row>,
    /// Orientation since time 0 as a unit quaternion: scalar, x, y, z. Empty where no bond needs it.
    #[serde(with = "plain")]
    pub orientation: Vec<Row>,
    /// Index of the material.
    #[serde(with = "plain")]
    pub material: Vec<u32>,
    /// Declared columns that the scene asks for, in its order, each in the unit of its declaration. The particles of a body, a
    /// group or a clump, have one value of a shared one.
    #[serde(with = "plain::lists")]
    pub declared: Vec<Vec<f64>>,
    /// What moves the particle: 0, the forces on it; k + 1, boundary k, to whose group it belongs, or, counted on behind the boundaries, a
    /// clump; [`IMAGE`], another particle.
    #[serde(with = "plain")]
    pub owner: Vec<u32>,
    /// Index of the particle in each slot here, of images that of their particle: into the scene's particles, and behind these into
    /// the places of those that come later. A place is taken again when its particle has gone; the scene's own never are.
    #[serde(with = "plain")]
    pub id: Vec<u32>,
    /// Slot here, by index; [`GONE`] where there is no such particle any more.
    #[serde(with = "plain")]
    pub slot: Vec<u32>,
    /// Bonds made and bonds broken so far, by index; empty in a scene without bonds.
    #[serde(with = "plain")]
    pub bonds: Vec<[u32; 2]>,
    /// Numbers in outputs of the particles that came later, by index less the number of the scene's own. None is used twice.
    #[serde(with = "plain")]
    pub numbers: Vec<u32>,
    /// Indices behind the scene's own that are free, the next to be taken last.
    #[serde(with = "plain")]
    pub free: Vec<u32>,
}

clone_in_place!(Particles {
    position,
    velocity,
    angular_velocity,
    force,
    torque,
    orientation,
    material,
    declared,
    owner,
    id,
    slot,
    bonds,
    numbers,
    free
});

/// What images have in a column.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum OfImages {
    /// What their particles have at the time.
    Followed,
    /// What their particles have ever.
    Constant,
    /// Nothing, until passes give them something, which goes on to their particles.
    Loads,
}

/// What an entry of a column is.
pub(crate) trait Entry: Copy + Default + Send + Sync {
    /// Whether it consists of finite numbers.
    fn is_finite(&self) -> bool;
}

impl Entry for Row {
    fn is_finite(&self) -> bool {
        self.iter().all(|number| number.is_finite())
    }
}

impl Entry for f64 {
    fn is_finite(&self) -> bool {
        f64::is_finite(*self)
    }
}

impl Entry for u32 {
    fn is_finite(&self) -> bool {
        true
    }
}

/// Does something with each column that has an entry for each slot: all that is done with them alike. Of each are known the name, what
/// images have in it, and the entries, with the type that they have there. A field of the particles that is not named here does not
/// compile.
macro_rules! each_column {
    ($particles:expr, |$name:ident, $images:ident, $column:ident| $work:expr) => {{
        use $crate::engine::state::particles::OfImages;
        let $crate::engine::state::Particles {
            position,
            velocity,
            angular_velocity,
            force,
            torque,
            orientation,
            material,
            declared,
            owner,
            id,
            slot: _,
            bonds: _,
            numbers: _,
            free: _,
        } = $particles;
        each_column!(@ position, OfImages::Followed, $name, $images, $column, $work);
        each_column!(@ velocity, OfImages::Followed, $name, $images, $column, $work);
        each_column!(@ angular_velocity, OfImages::Followed, $name, $images, $column, $work);
        each_column!(@ force, OfImages::Loads, $name, $images, $column, $work);
        each_column!(@ torque, OfImages::Loads, $name, $images, $column, $work);
        each_column!(@ orientation, OfImages::Followed, $name, $images, $column, $work);
        each_column!(@ material, OfImages::Constant, $name, $images, $column, $work);
        each_column!(@ owner, OfImages::Constant, $name, $images, $column, $work);
        each_column!(@ id, OfImages::Constant, $name, $images, $column, $work);
        for declared in declared {
            each_column!(@ declared, OfImages::Followed, $name, $images, $column, $work);
        }
    }};
    (@ $field:ident, $rule:expr, $name:ident, $images:ident, $column:ident, $work:expr) => {{
        let ($name, $images, $column) = (stringify!($field), $rule, $field);
        $work
    }};
}

pub(crate) use each_column;

impl Particles {
    /// Counts a bond of these of the scene's particles as made.
    pub fn count_bond(&mut self, bodies: impl IntoIterator<Item = u32>) {
        self.count(0, bodies);
    }

    /// Counts a bond of these of the scene's particles as broken.
    pub fn count_break(&mut self, bodies: impl IntoIterator<Item = u32>) {
        self.count(1, bodies);
    }

    /// Adds one to a count of these of the scene's particles.
    fn count(&mut self, which: usize, bodies: impl IntoIterator<Item = u32>) {
        for body in bodies {
            if let Some(counts) = self.bonds.get_mut(body as usize) {
                counts[which] = counts[which].saturating_add(1);
            }
        }
    }

    /// Bonds broken over bonds made, of each particle by ascending index; 0 where none was made.
    pub fn damage(&self) -> Vec<f64> {
        let there = self.bonds.iter().zip(&self.slot).filter(|(_, slot)| **slot != GONE);
        there.map(|(&[made, broken], _)| f64::from(broken) / f64::from(made.max(1))).collect()
    }

    /// The slot of the particle that moves by the forces on one in this slot: itself, or that of which it is an image.
    pub(crate) fn original(&self, slot: u32) -> u32 {
        let image = self.owner[slot as usize] == IMAGE;
        if image { self.slot[self.id[slot as usize] as usize] } else { slot }
    }

    /// The number of the body of several parts to which the particle in a slot belongs.
    pub(crate) fn group(&self, slot: usize) -> Option<usize> {
        let owner = self.owner[slot];
        if owner == IMAGE { None } else { (owner as usize).checked_sub(1) }
    }

    /// How many of them are images.
    pub(crate) fn images(&self) -> usize {
        self.owner.iter().filter(|owner| **owner == IMAGE).count()
    }

    /// How many there are, images included.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}

impl Particles {
    /// Whether these can be particles, each in one slot.
    pub(super) fn check(&self) -> Result<(), StateFault> {
        let count = self.len();
        let expected = "one for each particle";
        let may_be_absent = self.orientation.is_empty();
        each_column!(self, |name, _images, column| {
            let is_absent = may_be_absent && name == "orientation";
            demand(column.len() == count || is_absent, name, column.len(), expected)?;
            demand_all(column.iter().map(Entry::is_finite), name, FINITE)?;
        });
        demand(self.bonds.is_empty() || self.bonds.len() == self.slot.len(), "bonds", self.bonds.len(), expected)?;
        self.check_places()?;
        let numbers = self.id.iter().enumerate().map(|(slot, &id)| match self.owner[slot] {
            IMAGE => self
                .slot
                .get(id as usize)
                .is_some_and(|&slot| self.owner.get(slot as usize).is_some_and(|&it| it != IMAGE)),
            _ => self.slot.get(id as usize) == Some(&(slot as u32)),
        });
        demand_all(numbers, "id", "each particle in one slot")?;
        self.check_energy()
    }

    /// Whether the kinetic energy of all is a number: a spin of 1e300 rad/s is one, its energy is none.
    pub(super) fn check_energy(&self) -> Result<(), StateFault> {
        let energy = |row: &Row| row[3] * (row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        let mut sum = 0.0;
        for (rows, part) in [(&self.velocity, "velocity"), (&self.angular_velocity, "angular_velocity")] {
            demand_all(
                rows.iter().map(|row| {
                    sum += energy(row);
                    sum.is_finite()
                }),
                part,
                "a kinetic energy that is a number",
            )?;
        }
        Ok(())
    }

    /// Whether places that no particle has are marked as such, and those of the later ones can be taken again.
    pub(super) fn check_places(&self) -> Result<(), StateFault> {
        let there = self.slot.iter().filter(|slot| **slot != GONE).count();
        demand(there + self.images() == self.len(), "slot", there, "a slot of each particle, and of no other")?;
        demand(
            self.numbers.len() <= self.slot.len(),
            "numbers",
            self.numbers.len(),
            "one for each particle that came",
        )?;
        let own = self.slot.len() - self.numbers.len();
        let mut free = self.free.clone();
        free.sort_unstable();
        let empty = (own..self.slot.len()).filter(|&index| self.slot[index] == GONE).map(|index| index as u32);
        demand(free.into_iter().eq(empty), "free", 0, "the places that are free, each once")
    }

    /// Whether they are these particles somewhere else. Both have been checked.
    pub(super) fn check_same(&self, other: &Self) -> Result<(), StateFault> {
        let expected = "one for each of the scene's particles";
        let own = |of: &Self| of.len() - of.images();
        demand(own(self) == own(other), "particles", own(self), expected)?;
        demand(self.bonds.len() == other.bonds.len(), "bonds", self.bonds.len(), expected)?;
        let same = |slot: usize| {
            let there = other.slot[self.id[slot] as usize] as usize;
            let constants = |of: &Self, at: usize| {
                [of.position[at][3], of.velocity[at][3], of.angular_velocity[at][3]].map(f64::to_bits)
            };
            constants(self, slot) == constants(other, there)
                && self.material[slot] == other.material[there]
                && [other.owner[there], IMAGE].contains(&self.owner[slot])
        };
        demand_all((0..self.len()).map(same), "particles", "the scene's radius, mass, inertia, material and group")
    }
}
