//! As `pairs`, from a file: CSV with columns `id1`, `id2`, or a LIGGGHTS or LAMMPS bond list.

use super::{CreationWay, Listed, Moment};

/// `file`
pub(super) struct Way;

impl CreationWay for Way {
    type Value<'a> = (&'a String,);

    fn listed((file,): Self::Value<'_>) -> Option<Listed<'_>> {
        Some(Listed::InFile(file))
    }

    fn bonds_near_pairs(_: (&String,), _: &Moment) -> bool {
        false
    }
}
