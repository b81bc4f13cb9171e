//! Phase 3: what a law does to a batch, sub-model by sub-model or as one.

use super::Manner;
use super::coefficients::MOST_COEFFICIENTS;
use super::sub_models::{ArmsRun, CarryRun, Run, RunOf};
use super::suppressed::Suppressed;
use super::{losses, whole_laws};
use crate::contact::{Booked, Law, LawChoice, Needs};
use crate::lanes;

/// A contact law and its functions over batches.
pub(crate) struct BatchLaw {
    /// The law of one contact.
    pub law: Law,
    /// What of a contact its sub-models look at.
    pub needs: Needs,
    /// Its sub-models over a batch, in the order in which they work.
    runs: Vec<Run>,
    /// The same where bonds suppress contacts.
    suppressed: Suppressed,
    /// What a book of losses has to know of it.
    pub(super) booked: Booked,
}

impl BatchLaw {
    /// The law that a scene composed.
    pub(crate) fn of(choice: &LawChoice) -> Self {
        let mut law = Self::sub_models(choice);
        if let Some(run) = whole_laws::find(choice) {
            law.runs = vec![run];
        }
        law
    }

    /// The law that a scene composed; where asked, its losses are booked.
    pub(crate) fn booked_where(choice: &LawChoice, losses: bool) -> Self {
        if !losses {
            return Self::of(choice);
        }
        let Self { law, needs, mut runs, mut suppressed, .. } = Self::sub_models(choice);
        let law = law.booked();
        let booked = law.booking();
        if booked.spring || booked.carries {
            runs.insert(0, losses::keep_before);
        }
        runs.push(losses::book_open);
        suppressed.book(&booked);
        Self { law, needs, runs, suppressed, booked }
    }

    /// Whether its losses are booked.
    pub(crate) fn books(&self) -> bool {
        self.law.history_places().loads.is_some()
    }

    /// The same, sub-model by sub-model even where the law is compiled whole.
    pub(crate) fn sub_models(choice: &LawChoice) -> Self {
        let law = Law::of(choice);
        assert!(law.places().count <= MOST_COEFFICIENTS, "a law has at most {MOST_COEFFICIENTS} coefficients");
        let needs = law.needs();
        let (mut runs, run_of): (Vec<Run>, _) = (Vec::new(), RunOf { carries: choice.scheme.carries() });
        if law.undeformed_arms() {
            runs.push(|width, stage| lanes::run(width, ArmsRun(stage)));
        }
        if choice.scheme.carries() {
            runs.push(|width, stage| lanes::run(width, CarryRun(stage)));
        }
        runs.push(choice.normal.visit(run_of));
        if law.has_cohesion() {
            runs.push(choice.cohesion.visit(run_of));
        }
        runs.push(choice.tangential.visit(run_of));
        if law.has_rolling() {
            runs.push(choice.rolling.visit(run_of));
        }
        Self { suppressed: Suppressed::of(choice, &law), booked: law.booking(), law, needs, runs }
    }

    /// Whether it is compiled whole.
    #[cfg(test)]
    pub(super) fn is_fused(&self) -> bool {
        self.runs.len() == 1
    }

    /// What is done with a batch of contacts in this manner, one after another, and what of the contacts that looks at.
    pub(super) fn runs(&self, manner: Option<Manner>) -> (Needs, &[Run]) {
        match manner {
            None | Some(Manner::Open) => (self.needs, &self.runs),
            Some(Manner::Bonded) => (Needs { spin: false, ..self.needs }, &self.suppressed.bonded),
            Some(Manner::Released) => (self.needs, &self.suppressed.released),
            Some(Manner::Followed) => (Needs::NONE, &self.suppressed.followed),
        }
    }
}
