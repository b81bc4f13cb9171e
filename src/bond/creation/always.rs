//! In every step, between pairs near enough that have no bond.

use super::{CreationWay, Due, Moment};

/// `always`
pub(super) struct Way;

impl CreationWay for Way {
    type Value<'a> = ();
    const IS_CONTINUAL: bool = true;

    fn due((): ()) -> Due {
        Due::Always
    }

    fn bonds_near_pairs((): (), moment: &Moment) -> bool {
        moment.number > 0
    }
}
