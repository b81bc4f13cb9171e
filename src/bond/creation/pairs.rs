//! Before the first step, between the particles with listed ids; a pair further apart than `create_distance`, where
//! that is given, is an error.

use super::{CreationWay, Listed, Moment};

/// `pairs`
pub(super) struct Way;

impl CreationWay for Way {
    type Value<'a> = (&'a Vec<[u32; 2]>,);

    fn listed((pairs,): Self::Value<'_>) -> Option<Listed<'_>> {
        Some(Listed::Here(pairs))
    }

    fn bonds_near_pairs(_: (&Vec<[u32; 2]>,), _: &Moment) -> bool {
        false
    }
}
