//! How springs and dashpots of contacts go on in time: what a law does not say.
//!
//! Sub-models know no scheme. Where springs are carried at mid-step, the pass turns and stretches what is remembered
//! ([`Carry`]) and calls the sub-model with a step of 0; where dashpots are foreseen, it hands them velocities of the end of
//! the step ([`Carry::foresee`], or [`foresee_normal`] where springs are not carried).

mod carry;
mod foreseen;
mod touch;

use super::HistoryRow;
pub use carry::Carry;
pub use foreseen::{Foreseen, foresee_normal};
use serde::Deserialize;

/// `[run] scheme`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// As in the documents and in the engines: springs grow by the slip at the end of the step, dashpots see the velocities of
    /// its middle. First order.
    Engine,
    /// As in `engine`, but dashpots along the normal see the velocity extrapolated to the end of the step, and dashpots count for
    /// the part of the step in which the bodies touch: impacts along the normal are of second order.
    #[default]
    PredictedNormal,
    /// Springs are turned and stretched at mid-step, by the part of it in which the bodies touched: second order without
    /// dashpots, which are as before.
    Midway,
    /// Springs as in `midway`; dashpots see velocities extrapolated to the end of the step: second order.
    Predicted,
}

impl Scheme {
    /// The word in the scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::Engine => "engine",
            Self::PredictedNormal => "predicted_normal",
            Self::Midway => "midway",
            Self::Predicted => "predicted",
        }
    }

    /// All, from the coarsest on.
    pub const ALL: [Self; 4] = [Self::Engine, Self::PredictedNormal, Self::Midway, Self::Predicted];

    /// Whether springs are carried at mid-step.
    pub fn carries(self) -> bool {
        matches!(self, Self::Midway | Self::Predicted)
    }

    /// Whether all dashpots see velocities of the end of the step.
    pub fn predicts(self) -> bool {
        self == Self::Predicted
    }

    /// Whether dashpots along the normal see velocities of the end of the step.
    pub fn predicts_normal(self) -> bool {
        matches!(self, Self::PredictedNormal | Self::Predicted)
    }

    /// By how much dashpots along the normal and in the tangent plane shorten the stable step, over those that see the
    /// velocities of mid-step: z³M + … has the root −1 where 4 M − 4 Δt C − Δt² K is singular, not 4 M − 2 Δt C − Δt² K.
    pub fn damping_factors(self) -> [f64; 2] {
        [self.predicts_normal(), self.predicts()].map(|predicts| if predicts { 2.0 } else { 1.0 })
    }

    /// What it remembers of a contact beside what sub-models do.
    pub fn memory(self) -> SchemeMemory {
        match self {
            Self::Engine | Self::Midway => SchemeMemory::Nothing,
            Self::PredictedNormal => SchemeMemory::FourthNumber(HistoryRow {
                name: "normal velocity before",
                odd: [false; 4],
                fourth_is_free: true,
            }),
            Self::Predicted => SchemeMemory::Row(HistoryRow {
                name: "normal velocity and slip before",
                odd: [false, true, true, true],
                fourth_is_free: false,
            }),
        }
    }
}

/// What a scheme remembers of a contact beside what sub-models do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SchemeMemory {
    /// Nothing.
    Nothing,
    /// The fourth number of a row: of a sub-model's row whose fourth number is free; of this one where there is none.
    FourthNumber(HistoryRow),
    /// A row of its own.
    Row(HistoryRow),
}

impl SchemeMemory {
    /// The row that is remembered for the scheme alone, if there is one.
    pub fn row(&self) -> Option<HistoryRow> {
        match *self {
            Self::Nothing => None,
            Self::FourthNumber(row) | Self::Row(row) => Some(row),
        }
    }
}
