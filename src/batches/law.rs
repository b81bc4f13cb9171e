//! Phase 3: what a law does to a batch, sub-model by sub-model or as one.

use super::Manner;
use super::sub_models::{ArmsRun, Run, RunOf, before_sub_models};
use super::suppressed::Suppressed;
use super::{losses, whole_laws};
use crate::coefficients::MOST_COEFFICIENTS;
use crate::contact::{Booked, Law, Needs};
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
    /// This law.
    pub(crate) fn of(law: Law) -> Self {
        let whole = whole_laws::find(law.choice(), law.is_booked());
        let mut batch_law = Self::sub_models(law);
        if let Some(run) = whole {
            batch_law.runs = vec![run];
        }
        batch_law
    }

    /// The same, sub-model by sub-model even where the law is compiled whole.
    pub(crate) fn sub_models(law: Law) -> Self {
        let choice = *law.choice();
        assert!(law.places().count <= MOST_COEFFICIENTS, "a law has at most {MOST_COEFFICIENTS} coefficients");
        let needs = law.needs();
        let (mut runs, run_of): (Vec<Run>, _) = (Vec::new(), RunOf { carries: choice.scheme.carries() });
        if law.undeformed_arms() {
            runs.push(|width, stage| lanes::run(width, ArmsRun(stage)));
        }
        runs.extend(before_sub_models(choice.scheme));
        runs.push(choice.normal.visit(run_of));
        if law.has_cohesion() {
            runs.push(choice.cohesion.visit(run_of));
        }
        runs.push(choice.tangential.visit(run_of));
        if law.has_rolling() {
            runs.push(choice.rolling.visit(run_of));
        }
        let (mut suppressed, booked) = (Suppressed::of(&choice, &law), law.booking());
        if law.is_booked() {
            runs.splice(0..0, booked.keeps_before().then_some(losses::keep_before as Run));
            runs.push(losses::book_open);
            suppressed.book(&booked);
        }
        Self { suppressed, booked, law, needs, runs }
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
