//! What single contacts do while a piece of a list is worked on, for those who follow them.

use crate::base::number::Row;

/// What a contact does at the end of a time step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Trace {
    /// Its entry.
    pub(crate) entry: u32,
    /// The first body (slot).
    pub(crate) first: u32,
    /// The second body.
    pub(crate) second: u32,
    /// Normal force, as often as it counts, where it presses \[N\].
    pub(crate) force: f64,
    /// Effective mass \[kg\].
    pub(crate) mass: f64,
    /// Speed at which the bodies come nearer, and that at which they slide, in the time step \[m/s\].
    pub(crate) speed: [f64; 2],
    /// What it lost in the time step, along the normal and across it \[J\]; 0 where no losses are booked.
    pub(crate) lost: [f64; 2],
}

/// A contact whose bodies have parted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Parted {
    /// The first body (slot).
    pub(crate) first: u32,
    /// The second body.
    pub(crate) second: u32,
    /// What it remembered.
    pub(crate) rows: [Row; 2],
    /// What was lost with it, along the normal and across it \[J\].
    pub(crate) lost: [f64; 2],
}

/// What the contacts of a piece of a list did.
#[derive(Clone, Debug, Default)]
pub(crate) struct Followed {
    /// Those that touch.
    pub(crate) touching: Vec<Trace>,
    /// Those that ended.
    pub(crate) parted: Vec<Parted>,
}

impl Followed {
    /// Forgets all; the room stays.
    pub(crate) fn clear(&mut self) {
        self.touching.clear();
        self.parted.clear();
    }

    /// Takes what another one holds.
    pub(crate) fn take(&mut self, other: &Self) {
        self.clear();
        self.touching.extend_from_slice(&other.touching);
        self.parted.extend_from_slice(&other.parted);
    }
}
