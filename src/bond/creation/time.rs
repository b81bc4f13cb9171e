//! In the first time step that ends at a time or later; time 0 is before the first step.

use super::{CreationWay, Due, Moment};
use crate::quantity::NonNegative;

/// `time`
pub(super) struct Way;

impl CreationWay for Way {
    type Value<'a> = (&'a NonNegative,);

    fn due((time,): (&NonNegative,)) -> Due {
        Due::Time(time.get())
    }

    fn bonds_near_pairs((time,): (&NonNegative,), moment: &Moment) -> bool {
        let time = time.get();
        if time <= 0.0 {
            return moment.number == 0;
        }
        moment.number > 0 && moment.from < time && time <= moment.to
    }
}
