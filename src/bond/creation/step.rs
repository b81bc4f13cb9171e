//! In the time step of a number; the first is 1.

use super::{CreationWay, Due, Moment};

/// `step`
pub(super) struct Way;

impl CreationWay for Way {
    type Value<'a> = (&'a u64,);

    fn needs_given_step(_: (&u64,)) -> Option<&'static str> {
        Some("bonds are made at a step number")
    }

    fn contradiction((number,): (&u64,)) -> Option<&'static str> {
        (*number == 0).then_some("expected a step from 1 on, found 0; \"start\" bonds before the first step")
    }

    fn due((number,): (&u64,)) -> Due {
        Due::Step(*number)
    }

    fn bonds_near_pairs((number,): (&u64,), moment: &Moment) -> bool {
        moment.number == *number
    }
}
