//! What is remembered of contacts beside what their law remembers: for books of losses, records and impacts.

use super::Law;
use crate::base::number::Row;
use crate::laws::contact::{Booked, Contact, HistoryRow, LossKind, Warming};

/// What is kept of a contact beside what its law remembers, where bonds suppress contacts: the force on the first body in
/// the last evaluation, if the contact was then suppressed \[N\], and the overlap from which its normal force is taken \[m\].
pub const OFFSET: HistoryRow = HistoryRow { name: "offset", odd: [true, true, true, false], fourth_is_free: false };

/// What records of contacts remember where dashpots see what cannot be found from the state: the velocity along the normal \[m/s\],
/// the weight of the dashpot across it, and 1.
const SEEN: HistoryRow = HistoryRow { name: "dashpots seen", odd: [false; 4], fourth_is_free: false };

/// The same where springs are carried: the velocity along the normal and the slip.
const SEEN_CARRIED: HistoryRow = HistoryRow { odd: [false, true, true, true], ..SEEN };

/// What a book of losses remembers of a contact: k_t \[N/m\] and the force of both dashpots on the first body \[N\] in the last
/// evaluation.
const LOADS: HistoryRow = HistoryRow { name: "dashpots before", odd: [false, true, true, true], fourth_is_free: false };

/// What it remembers where there is more: the normal force that is neither spring nor dashpot \[N\] and the rolling torque \[N m\].
const OTHER_LOADS: HistoryRow =
    HistoryRow { name: "other loads before", odd: [false, true, true, true], fourth_is_free: false };

/// What is remembered where losses warm the bodies: what the contact holds of them, along the normal and against rolling, as often as its
/// forces count \[J\].
const HELD: HistoryRow = HistoryRow { name: "energy held", odd: [false; 4], fourth_is_free: false };

/// What is remembered of an impact: loss along the normal and across it \[J\], largest normal force \[N\], duration so far \[s\].
const IMPACT: HistoryRow = HistoryRow { name: "impact", odd: [false; 4], fourth_is_free: false };

/// How it began: speeds along the normal and across it \[m/s\], and whether it has begun.
const TOUCH: HistoryRow = HistoryRow { name: "touch", ..IMPACT };

impl Law {
    /// The same law, of whose contacts a book of losses remembers more: the rows stand behind all others.
    pub fn booked(mut self) -> Self {
        self.history_places.loads = Some(self.history.len());
        self.history.push(LOADS);
        if self.has_rolling() || self.has_other_force() {
            self.history_places.other_loads = Some(self.history.len());
            self.history.push(OTHER_LOADS);
        }
        self
    }

    /// The same law, of which these losses warm the bodies: work against attraction does not, for it comes back.
    pub fn warming(mut self, mut warming: Warming) -> Self {
        warming[LossKind::Other as usize] &= self.is_plastic();
        self.warming = warming;
        if self.holds().contains(&true) {
            self.history_places.held = Some(self.history.len());
            self.history.push(HELD);
        }
        self
    }

    /// Whether its plastic normal force, and whether its rolling spring, holds part of what warms the bodies.
    fn holds(&self) -> [bool; 2] {
        let rolls = self.choice.rolling.row().history().is_some();
        [self.warming[LossKind::Other as usize], self.warming[LossKind::Rolling as usize] && rolls]
    }

    /// What a contact holds of losses that warm the bodies, along the normal and against rolling \[J\].
    pub(crate) fn held(&self, row: &[f64], contact: &Contact, history: &[Row]) -> [f64; 2] {
        let [plastic, rolling] = self.holds();
        let plastic = if plastic { self.normal_energy(row, contact, 0.0, history) } else { 0.0 };
        [plastic, if rolling { self.rolling_energy(row, contact, history) } else { 0.0 }]
    }

    /// The same law, of whose contacts records show exactly what the last evaluation saw.
    pub fn recorded(mut self) -> Self {
        let carries = self.scheme().carries();
        if carries || self.history_places.normal_velocity.is_some() {
            self.history_places.seen = Some(self.history.len());
            self.history.push(if carries { SEEN_CARRIED } else { SEEN });
        }
        self
    }

    /// The same law, whose contacts are followed one by one from touch to parting.
    pub fn followed(mut self) -> Self {
        self.history_places.impact = Some(self.history.len());
        self.history.extend([IMPACT, TOUCH]);
        self
    }

    /// Whether its losses are booked.
    pub fn is_booked(&self) -> bool {
        self.history_places.loads.is_some()
    }

    /// What a book of losses has to know of it.
    pub(crate) fn booking(&self) -> Booked {
        let (friction, carries) = (self.tangential(), self.scheme().carries());
        Booked {
            friction: self.has_friction(),
            spring: friction.has_spring,
            keeps_stiffness: friction.keeps_stiffness,
            limits_dashpot: friction.limits_dashpot,
            projects: friction.projects && !carries,
            rolling: self.has_rolling(),
            presses: self.presses(),
            other: self.has_other_force(),
            carries,
            predicts_normal_alone: self.history_places.normal_velocity.is_some(),
            least_force: self.choice.normal.row().count,
            warming: self.warming,
            follows: self.history_places.impact.is_some(),
        }
    }
}
