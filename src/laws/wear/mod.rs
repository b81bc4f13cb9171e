//! What particles wear off a surface. Each model is one file and one row in the list below.
//!
//! A model says what volume one contact takes in one time step. Which facet of the surface loses it, and what is summed up, is not its
//! business.

pub mod archard;
pub mod finnie;

pub use super::kept::ModelKeys;

use super::kept::{self, Kept, keep, of_kind, own};
use crate::base::document::{Document, Faults};
use std::fmt;

/// The models of the program.
pub(crate) const STANDARD: &[&WearRow] = &[WearRow::of::<archard::Archard>(), WearRow::of::<finnie::Finnie>()];

/// What a particle did to a surface in a time step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rubbing {
    /// Normal force by which it is pressed to the surface, 0 or above \[N\]. In a bend of a mesh a part may be taken off again: below 0.
    pub force: f64,
    /// How far it slid along the surface \[m\].
    pub sliding: f64,
    /// How it came, in the time step in which it touches first.
    pub touch: Option<Touch>,
}

/// How a particle comes to a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// Its mass; the effective one where forces move the surface \[kg\].
    pub mass: f64,
    /// Its speed towards the surface, 0 or above \[m/s\].
    pub normal_speed: f64,
    /// Its speed along the surface, as the point of contact has it \[m/s\].
    pub tangential_speed: f64,
}

/// A model of wear, in numbers.
pub trait Wear: Copy + fmt::Debug + Send + Sync + 'static {
    /// Its name: that of its table `[boundary.<name>.wear.<model>]`.
    const NAME: &'static str;
    /// What the scene writes of it.
    type Keys: ModelKeys;
    /// Whether it looks at how particles come. What contacts remember for that costs memory.
    const LOOKS_AT_TOUCH: bool;
    /// The model that the keys mean.
    fn of(keys: &Self::Keys) -> Self;
    /// The volume that a particle takes in a time step \[m³\].
    fn volume(&self, rubbing: &Rubbing) -> f64;
}

/// What the program knows of a model of wear.
pub struct WearRow {
    /// [`Wear::NAME`]
    name: &'static str,
    /// [`Wear::LOOKS_AT_TOUCH`]
    looks_at_touch: bool,
    /// Reads its keys below a table.
    read: fn(&Document, &str, &str, &mut Faults) -> Option<Kept>,
    /// [`Wear::volume`]
    volume: fn(Kept, &Rubbing) -> f64,
}

impl WearRow {
    /// The row of a model.
    pub const fn of<W: Wear>() -> &'static Self {
        const {
            &Self {
                name: W::NAME,
                looks_at_touch: W::LOOKS_AT_TOUCH,
                read: kept::read::<W::Keys>,
                volume: |keys, rubbing| W::of(own(keys)).volume(rubbing),
            }
        }
    }

    /// Its name in a scene.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Reads the model from its table, which stands below this one.
    pub(crate) fn read(&'static self, document: &Document, table: &str, faults: &mut Faults) -> Option<WearModel> {
        (self.read)(document, table, self.name, faults).map(|keys| WearModel { row: self, keys })
    }
}

impl fmt::Debug for WearRow {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// A model of wear as a scene chose it: its row and its keys.
#[derive(Clone, Copy, Debug)]
pub struct WearModel {
    /// What the program knows of it.
    row: &'static WearRow,
    /// What the scene writes of it.
    keys: Kept,
}

impl WearModel {
    /// A model with these keys.
    pub fn of<W: Wear>(keys: W::Keys) -> Self {
        Self { row: WearRow::of::<W>(), keys: keep(keys) }
    }

    /// Its name in a scene.
    pub fn name(&self) -> &'static str {
        self.row.name
    }

    /// Its keys, if they are of this type.
    pub fn keys<K: 'static>(&self) -> Option<&'static K> {
        of_kind(self.keys)
    }

    /// Whether it looks at how particles come.
    pub(crate) fn looks_at_touch(&self) -> bool {
        self.row.looks_at_touch
    }

    /// The volume that a particle takes in a time step \[m³\].
    pub(crate) fn volume(&self, rubbing: &Rubbing) -> f64 {
        (self.row.volume)(self.keys, rubbing)
    }
}
