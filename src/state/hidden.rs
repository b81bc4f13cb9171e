//! Contacts that a bond hides or has hidden. They stand apart from the near pairs of their law.

use super::Row;
use super::contacts::TOUCHING;
use super::in_place::clone_in_place;
use crate::contact::MOST_HISTORY;
use serde::{Deserialize, Serialize};

/// The bond was made in the present time step: the contact still acts as it did before.
pub const FRESH: u8 = 4;

/// While bonded nothing of the contact acts, not even friction.
pub const SILENT: u8 = 8;

/// The offset outlives the parting of the bodies, as in the engine.
pub const LASTING: u8 = 16;

/// One contact that a bond hides or has hidden.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HiddenContact {
    /// The particle, the one with the smaller index of two: index into the scene's particles.
    pub first: u32,
    /// The other particle: index into the scene's particles; none at a plane.
    pub second: Option<u32>,
    /// How many living bonds hide it.
    pub bonds: u32,
    /// [`TOUCHING`], [`SLIDING`](super::contacts::SLIDING), [`FRESH`], [`SILENT`] and
    /// [`LASTING`].
    pub flags: u8,
    /// Overlap from which the normal force is taken once the bond is gone \[m\].
    pub offset: f64,
    /// What the law remembers of the contact, as `first` sees the other body.
    pub history: [Row; MOST_HISTORY],
    /// What the normal model keeps of each pair.
    pub pair_constant: f64,
    /// Force on `first` in the last evaluation \[N\].
    pub force: Row,
}

impl HiddenContact {
    /// Whether a bond hides it in the present evaluation: by how the pair stood before this step's creations.
    pub fn is_hidden(&self) -> bool {
        self.bonds > 0 && self.flags & FRESH == 0
    }

    /// Whether nothing at all of the contact acts.
    pub fn is_silent(&self) -> bool {
        self.is_hidden() && self.flags & SILENT != 0
    }

    /// Whether there is nothing to do for it until its bond breaks: what it remembers follows from where the bodies are
    /// then. A lasting offset is that of the last touch, which has to be followed.
    pub fn is_resting(&self) -> bool {
        self.is_silent() && self.flags & LASTING == 0
    }

    /// Whether it is one of the contacts that are counted and told.
    pub fn is_told(&self) -> bool {
        self.flags & TOUCHING != 0 && !self.is_silent()
    }

    /// Whether it has become a contact like any other.
    pub fn is_over(&self) -> bool {
        self.bonds == 0 && self.offset == 0.0
    }
}

/// The hidden contacts, each list ascending by its bodies. Without a bond that hides contacts there is no list.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Between particles, a list for each contact law.
    pub pairs: Vec<Vec<HiddenContact>>,
    /// Places in these lists of the contacts that do not rest, ascending.
    pub active: Vec<Vec<u32>>,
    /// Whether some of them rest after the present evaluation.
    pub settling: bool,
    /// At planes, a list for each of [`State::walls`](super::State::walls).
    pub planes: Vec<Vec<HiddenContact>>,
}

clone_in_place!(Hidden { pairs, active, settling, planes });

impl Hidden {
    /// All of them, between particles first.
    pub fn all(&self) -> impl Iterator<Item = &HiddenContact> {
        self.pairs.iter().chain(&self.planes).flatten()
    }

    /// Finds the contacts that do not rest, after entries came, went or changed.
    pub fn find_active(&mut self) {
        let awake = |list: &Vec<HiddenContact>| {
            let places = (0..).zip(list).filter(|(_, entry)| !entry.is_resting());
            places.map(|(place, _)| place).collect()
        };
        self.active = self.pairs.iter().map(awake).collect();
        self.settling = false;
    }

    /// The contact of these bodies in a list, or where it would stand.
    pub fn find(list: &[HiddenContact], first: u32, second: Option<u32>) -> Result<usize, usize> {
        list.binary_search_by_key(&(first, second), |entry| (entry.first, entry.second))
    }
}
