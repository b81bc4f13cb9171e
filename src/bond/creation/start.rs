//! Before the first step, between all pairs near enough.

use super::{CreationWay, Moment};

/// `start`
pub(super) struct Way;

impl CreationWay for Way {
    type Value<'a> = ();

    fn bonds_near_pairs((): (), moment: &Moment) -> bool {
        moment.number == 0
    }
}
