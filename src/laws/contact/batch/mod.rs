//! Contacts side by side in columns, and what sub-models do to them: the functions of one contact, in each lane width.
//!
//! Each sub-model is compiled once for each lane width, whatever it is combined with: sub-models add, they do not
//! multiply. What one hands to the next stands in columns of the buffer, which the first-level cache holds.

mod buffer;
mod entries;
mod gathered;
mod heat;
mod losses;
mod sphere_pair;
mod stage;
mod sub_models;
mod sums;
mod trace;

use super::Contact;
use crate::base::lanes::{Lane, Width};
use crate::base::number::Row;
pub(crate) use buffer::{BATCH, Buffer};
pub(crate) use entries::Entries;
pub(crate) use gathered::Gathered;
pub(crate) use heat::{Conducting, conductance, contact_radius};
pub(crate) use losses::{book, book_bonded, book_open, book_released, keep_before};
pub(crate) use sphere_pair::SpherePair;
pub(crate) use stage::{FrictionResult, Stage};
pub(crate) use sub_models::{before_sub_models, cohesion, normal, part, rolling, tangential, undeform_arms};
pub(crate) use sums::Sums;
pub(crate) use trace::{Followed, Parted, Trace};

/// Most coefficients that a composed law may have.
pub(crate) const MOST_COEFFICIENTS: usize = 32;

/// Bit of an entry whose friction is at its limit.
pub const SLIDING: u8 = 2;

/// The most numbers that are known of the places of the bodies of a touching entry, before its geometry is.
pub(crate) const FOUND: usize = 5;

/// A sub-model, or several as one, over a batch.
pub(crate) type Run = fn(Width, &mut Stage);

/// A contact and the arms of its bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactGeometry<N = f64> {
    /// The contact.
    pub contact: Contact<N>,
    /// Arm at the first body \[m\].
    pub first_arm: N,
    /// Arm at the second body; 0 where it has none \[m\].
    pub second_arm: N,
}

/// What the law does at an entry, depending on a bond that may suppress its contact.
#[derive(Clone, Copy, Debug)]
pub(crate) enum EntryEvaluation {
    /// The whole law acts.
    Open,
    /// A bond suppresses the normal force.
    Bonded,
    /// The normal force is taken from an offset.
    Released,
    /// Nothing acts, but the offset is followed.
    Followed,
}

impl EntryEvaluation {
    /// All, in the order in which they are done.
    pub(crate) const ALL: [Self; 4] = [Self::Open, Self::Bonded, Self::Released, Self::Followed];
}

/// Coefficients of a law: a row for each two materials.
#[derive(Clone, Copy)]
pub(crate) struct CoefficientRows<'a> {
    /// Row by row.
    pub numbers: &'a [f64],
    /// How many a row has.
    pub count: usize,
}

impl CoefficientRows<'_> {
    /// The coefficient of each lane that stands at this place in the rows with these numbers.
    ///
    /// # Safety
    /// `place` is below the number of coefficients; `entry` points to [`Lane::WIDTH`] numbers of rows.
    #[inline(always)]
    pub(crate) unsafe fn gather<N: Lane>(&self, place: usize, entry: *const u32) -> N {
        // SAFETY: the caller's promise.
        unsafe { N::gather(self.numbers.as_ptr().add(place), entry, self.count) }
    }
}

/// Touching entries of a batch with what they do to their bodies, in the order of the list.
#[derive(Clone, Copy)]
pub(crate) struct Touching<'a> {
    /// First body.
    pub first: &'a [u32],
    /// Second body.
    pub second: &'a [u32],
    /// Force on the first body \[N\].
    pub force: &'a [Row],
    /// What friction turns both bodies by, over its arm \[N\]; anything where there is no torque.
    pub couple: &'a [Row],
    /// Rolling torque from the first body to the second \[N m\]; anything where there is none.
    pub rolling: &'a [Row],
    /// Arm at the first body \[m\].
    pub first_arm: &'a [f64],
    /// Arm at the second body \[m\].
    pub second_arm: &'a [f64],
}

impl Touching<'_> {
    /// Torque of friction on the two bodies of an entry \[N m\].
    #[inline(always)]
    pub(crate) fn torques(&self, place: usize) -> [Row; 2] {
        let [x, y, z, rest] = self.couple[place];
        let turned = |arm: f64| [-(x * arm), -(y * arm), -(z * arm), -(rest * arm)];
        [turned(self.first_arm[place]), turned(self.second_arm[place])]
    }
}
