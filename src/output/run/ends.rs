//! When a run ends, and whether one that has ended goes on.

use super::inputs::Inputs;
use super::order::RunOrder;
use crate::engine::state::State;
use crate::output::results::schedule::Schedule;
use crate::output::results::{Failure, Refusal, ResumeError};

/// When a run ends.
pub(super) struct Ends {
    /// The end that the scene or the table of inputs has: it says in which communication steps a run goes that names no interval \[s\].
    own: Option<f64>,
    /// The end \[s\].
    pub(super) end: f64,
}

impl Ends {
    /// Those of an order with this table of inputs.
    pub(super) fn of(order: &RunOrder<'_>, inputs: Option<&Inputs>) -> Result<Self, Refusal> {
        let table_end = inputs.map(Inputs::end);
        let own = table_end.into_iter().chain(order.scene.run.end).reduce(f64::min).filter(|end| *end > 0.0);
        if let (Some(end), Some(table_end)) = (order.end, table_end)
            && end > table_end
        {
            return Err(Refusal::BeyondInputs { end, table_end });
        }
        let no_end = || Refusal::NoEnd { scene: order.scene_name.to_owned() };
        Ok(Self { own, end: order.end.or(own).ok_or_else(no_end)? })
    }

    /// The communication points: beyond its own end a run goes on in the steps that it had.
    pub(super) fn schedule(&self, order: &RunOrder<'_>) -> Result<Schedule, Refusal> {
        let own = Schedule::new(order.scene, order.scene_name, self.own.unwrap_or(self.end))?;
        own.until(self.end, order.scene, order.scene_name)
    }

    /// The communication point at which a run goes on that was saved in this state, or within the step after it \[s\].
    pub(super) fn going_on(&self, order: &RunOrder<'_>, schedule: &Schedule, state: &State) -> Result<f64, Failure> {
        let saved = state.clock.time;
        if order.end.is_some() {
            order.expect_before(saved, self.end)?;
            if self.own.is_none() && !schedule.has_intervals() {
                return Err(Refusal::NoInterval { scene: order.scene_name.to_owned() }.into());
            }
        }
        let point = state.underway.map_or(saved, |underway| saved - underway.elapsed());
        let between = |nearest| ResumeError::Between { time: saved, nearest };
        let time = schedule.point_of(point).map_err(between)?;
        // A last communication step that was cut short is not on the way to another end.
        if order.end.is_some() && (point - time).abs() > schedule.drift(time, state.clock.step) {
            return Err(between(time).into());
        }
        Ok(time)
    }
}
