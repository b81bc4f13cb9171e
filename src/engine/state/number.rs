//! Adds particles to the state and removes them from it, with their entries in every list.

use super::particles::each_column;
use super::{BondList, Columns, ContactList, GONE, IMAGE, NearParts, Particles, Row, State, WallContacts};
use crate::base::geometry::Quaternion;

/// A particle to be added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsertedParticle<'a> {
    /// Centre \[m\] and radius \[m\].
    pub position: Row,
    /// Velocity \[m/s\] and mass \[kg\].
    pub velocity: Row,
    /// Moment of inertia \[kg m²\].
    pub inertia: f64,
    /// Index of its material.
    pub material: u32,
    /// Its number in outputs.
    pub number: u32,
    /// Its values of the declared columns.
    pub declared: &'a [f64],
}

impl Particles {
    /// Keeps the rows of slots for which this holds, in their order. Which slot a particle has is to be found again.
    pub(crate) fn keep_rows(&mut self, stays: impl Fn(usize) -> bool) {
        each_column!(self, |_name, _images, column| keep(column, &stays));
    }

    /// Adds an image of the particle in each of these slots.
    pub(crate) fn add_images(&mut self, originals: &[u32]) {
        let first = self.len();
        each_column!(&mut *self, |_name, images, column| if !column.is_empty() {
            match images {
                OfImages::Loads => column.resize(first + originals.len(), Default::default()),
                OfImages::Followed | OfImages::Constant => {
                    column.reserve(originals.len());
                    for &slot in originals {
                        column.push(column[slot as usize]);
                    }
                }
            }
        });
        self.owner[first..].fill(IMAGE);
    }

    /// How many particles the scene itself has: the index of the first one that was inserted.
    fn own(&self) -> usize {
        self.slot.len() - self.numbers.len()
    }

    /// The number in outputs of an inserted particle, by its index; none for the scene's own.
    pub fn number_of_inserted(&self, index: u32) -> Option<u32> {
        self.numbers.get((index as usize).checked_sub(self.own())?).copied()
    }

    /// Slots of the present particles, by ascending index.
    pub fn slots(&self) -> impl Iterator<Item = usize> + '_ {
        self.slot.iter().filter(|slot| **slot != GONE).map(|&slot| slot as usize)
    }

    /// The slot of a particle by its index, if it is present.
    pub fn slot_of(&self, index: u32) -> Option<usize> {
        self.slot.get(index as usize).filter(|slot| **slot != GONE).map(|&slot| slot as usize)
    }

    /// Appends a particle of this owner. `turning`: whether particles have an orientation. Returns its index.
    pub(crate) fn add(&mut self, newcomer: &InsertedParticle, owner: u32, turning: bool) -> u32 {
        let slot = self.len() as u32;
        let index = self.free.pop().unwrap_or_else(|| {
            self.slot.push(GONE);
            self.numbers.push(0);
            if !self.bonds.is_empty() {
                self.bonds.push([0; 2]);
            }
            self.slot.len() as u32 - 1
        });
        let place = index as usize - self.own();
        self.numbers[place] = newcomer.number;
        self.slot[index as usize] = slot;
        self.position.push(newcomer.position);
        self.velocity.push(newcomer.velocity);
        self.angular_velocity.push([0.0, 0.0, 0.0, newcomer.inertia]);
        self.force.push([0.0; 4]);
        self.torque.push([0.0; 4]);
        if turning || !self.orientation.is_empty() {
            self.orientation.push(Quaternion::identity().to_row());
        }
        self.material.push(newcomer.material);
        for (column, &value) in self.declared.iter_mut().zip(newcomer.declared) {
            column.push(value);
        }
        self.owner.push(owner);
        self.id.push(index);
        index
    }

    /// Removes particles (slots).
    fn remove(&mut self, goes: &[bool]) {
        let own = self.own();
        for slot in (0..goes.len()).filter(|&slot| goes[slot] && self.owner[slot] != IMAGE) {
            let index = self.id[slot] as usize;
            self.slot[index] = GONE;
            if index >= own {
                self.free.push(index as u32);
                if let Some(counts) = self.bonds.get_mut(index) {
                    *counts = [0; 2];
                }
            }
        }
        self.keep_rows(|slot| !goes[slot]);
        for (slot, (&index, _)) in
            self.id.iter().zip(&self.owner).enumerate().filter(|(_, (_, owner))| **owner != IMAGE)
        {
            self.slot[index as usize] = slot as u32;
        }
    }
}

/// Keeps the entries of a list for whose places this holds.
pub(super) fn keep<T>(list: &mut Vec<T>, stays: impl Fn(usize) -> bool) {
    let mut place = 0;
    list.retain(|_| {
        place += 1;
        stays(place - 1)
    });
}

/// New slots and new ends of slabs after a removal.
struct Moved<'a> {
    /// Whether the particle in each slot is removed.
    goes: &'a [bool],
    /// How many particles stay before each slot, and as the last entry how many in all.
    stay_before: Vec<u32>,
}

impl Moved<'_> {
    /// Whether the particle of a slot stays.
    fn stays(&self, slot: u32) -> bool {
        !self.goes[slot as usize]
    }

    /// Renumbers slots of particles that stay.
    fn renumber(&self, slots: &mut [u32]) {
        slots.iter_mut().for_each(|slot| *slot = self.stay_before[*slot as usize]);
    }
}

/// Updates the ends of the pieces of a list of which these entries stay.
fn shorten(ends: &mut [u32], stays: &[bool]) {
    let (mut place, mut count) = (0, 0);
    for end in ends {
        while place < *end as usize {
            count += u32::from(stays[place]);
            place += 1;
        }
        *end = count;
    }
}

impl State {
    /// Adds a particle of this owner where it is. `turning`: whether particles have an orientation. Returns its index.
    pub(crate) fn add_particle(&mut self, newcomer: &InsertedParticle, owner: u32, turning: bool) -> u32 {
        let index = self.particles.add(newcomer, owner, turning);
        if let Some(cell) = &mut self.cell {
            cell.begin_at(index);
        }
        index
    }

    /// What goes in all where of the particles these go (slots): all spheres of their clumps, and images in a periodic cell.
    pub(crate) fn with_all(&self, goes: &[bool]) -> Vec<bool> {
        let mut goes = goes.to_vec();
        for clump in 0..self.clumps.len() {
            let slots =
                self.clumps.spheres_of(clump).iter().map(|&sphere| self.particles.slot[sphere as usize] as usize);
            if slots.clone().any(|slot| goes[slot]) {
                slots.for_each(|slot| goes[slot] = true);
            }
        }
        for (&image, &original) in self.cell.iter().flat_map(|cell| cell.images.iter().zip(&cell.originals)) {
            goes[image as usize] |= goes[original as usize];
        }
        goes
    }

    /// Removes particles (slots), all spheres of their clumps, their images in a periodic cell, and their entries in every list. The caller
    /// makes anew what depends on positions.
    pub(crate) fn remove(&mut self, goes: &[bool]) {
        let goes = &self.with_all(goes)[..];
        let (mut stay_before, mut count) = (Vec::with_capacity(goes.len() + 1), 0);
        for goes in goes {
            stay_before.push(count);
            count += u32::from(!goes);
        }
        stay_before.push(count);
        let moved = Moved { goes, stay_before };
        self.particles.remove(goes);
        self.remove_clumps();
        if let Some(cell) = &mut self.cell {
            let stays: Vec<bool> = cell.images.iter().map(|&image| moved.stays(image)).collect();
            keep(&mut cell.displaced, |image| stays[image]);
            for slots in [&mut cell.images, &mut cell.originals] {
                keep(slots, |image| stays[image]);
                moved.renumber(slots);
            }
        }
        let Columns { x, y, z, radius } = &mut self.neighbours.reference;
        for column in [x, y, z, radius] {
            keep(column, |slot| goes.get(slot).is_none_or(|goes| !goes));
        }
        self.neighbours.slabs.iter_mut().for_each(|end| *end = moved.stay_before[*end as usize]);
        self.contacts.iter_mut().for_each(|list| list.remove(&moved));
        self.walls.iter_mut().for_each(|list| list.remove(&moved));
        self.bonds.iter_mut().for_each(|list| list.remove(&moved));
    }
}

impl ContactList {
    /// Removes the pairs of removed particles.
    fn remove(&mut self, moved: &Moved) {
        let pairs = self.first.iter().zip(&self.second);
        let stays: Vec<bool> = pairs.map(|(&a, &b)| moved.stays(a) && moved.stays(b)).collect();
        for slots in [&mut self.first, &mut self.second] {
            keep(slots, |pair| stays[pair]);
            moved.renumber(slots);
        }
        keep(&mut self.flags, |pair| stays[pair]);
        self.history.keep(|pair| stays[pair]);
        keep(&mut self.pair_constant, |pair| stays[pair]);
        shorten(&mut self.slabs, &stays);
    }
}

impl WallContacts {
    /// Removes the contacts of removed particles.
    fn remove(&mut self, moved: &Moved) {
        let stays: Vec<bool> = self.particle.iter().map(|&slot| moved.stays(slot)).collect();
        // At a surface of features constants belong to near particles.
        let near: Vec<bool> = self.near.particle.iter().map(|&slot| moved.stays(slot)).collect();
        let of_constants = if self.near.starts.is_empty() { &stays } else { &near };
        keep(&mut self.pair_constant, |place| of_constants.get(place).copied().unwrap_or(false));
        keep(&mut self.particle, |entry| stays[entry]);
        moved.renumber(&mut self.particle);
        keep(&mut self.flags, |entry| stays[entry]);
        keep(&mut self.feature, |entry| stays[entry]);
        self.history.keep(|entry| stays[entry]);
        self.near.remove(&near, moved);
    }
}

impl NearParts {
    /// Removes particles; `stays` says of each whether it stays.
    fn remove(&mut self, stays: &[bool], moved: &Moved) {
        if self.starts.is_empty() {
            return;
        }
        let (mut starts, mut parts) = (Vec::new(), Vec::new());
        for entry in (0..stays.len()).filter(|&entry| stays[entry]) {
            starts.push(parts.len() as u32);
            parts.extend_from_slice(&self.parts[self.starts[entry] as usize..self.starts[entry + 1] as usize]);
        }
        starts.push(parts.len() as u32);
        (self.starts, self.parts) = (starts, parts);
        keep(&mut self.particle, |entry| stays[entry]);
        keep(&mut self.plane, |entry| stays[entry]);
        moved.renumber(&mut self.particle);
    }
}

impl BondList {
    /// Removes the bonds of removed particles. They did not break, and have a count of their own.
    fn remove(&mut self, moved: &Moved) {
        let second = |bond: usize| self.second.get(bond).is_none_or(|&slot| moved.stays(slot));
        let stays: Vec<bool> =
            self.first.iter().enumerate().map(|(bond, &slot)| moved.stays(slot) && second(bond)).collect();
        self.removed += stays.iter().filter(|stays| !**stays).count() as u64;
        for slots in [&mut self.first, &mut self.second] {
            keep(slots, |bond| stays[bond]);
            moved.renumber(slots);
        }
        keep(&mut self.foot, |bond| stays[bond]);
        self.rows.iter_mut().chain(&mut self.damping).for_each(|rows| keep(rows, |bond| stays[bond]));
        keep(&mut self.lost, |bond| stays[bond]);
        shorten(&mut self.slabs, &stays);
    }
}
