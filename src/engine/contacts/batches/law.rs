//! Phase 3: what a law does to a batch, sub-model by sub-model or as one.

use super::whole_laws;
use crate::base::lanes::Width;
use crate::laws::contact::batch::{
    CoefficientRows, Conducting, EntryEvaluation, MOST_COEFFICIENTS, Run, Stage, before_sub_models, book_bonded,
    book_open, book_released, keep_before, part, undeform_arms,
};
use crate::laws::contact::{Adhesion, Booked, Law, Needs};
use crate::scene::Scene;

/// A contact law and its functions over batches.
pub(crate) struct BatchLaw {
    /// The law of one contact.
    pub law: Law,
    /// What of a contact its sub-models look at.
    pub needs: Needs,
    /// What its sub-models do to a batch, in the order in which they work.
    open: Vec<Run>,
    /// The same while a bond suppresses the normal force.
    bonded: Vec<Run>,
    /// The same when the bond is gone, and the normal force is taken from an offset.
    released: Vec<Run>,
    /// What a book of losses has to know of it.
    pub(super) booked: Booked,
    /// What conducts heat, if anything does.
    heat: Option<Conduction>,
}

/// A heat model as batches see it.
struct Conduction {
    /// Its functions and those of the normal model.
    runs: [Run; 2],
    /// Its coefficients for each two materials, row by row.
    numbers: Vec<f64>,
    /// How many a row has.
    count: usize,
    /// Whether bodies that have touched conduct as long as they hold together.
    beyond_touch: bool,
}

impl BatchLaw {
    /// This law.
    pub(crate) fn of(law: Law) -> Self {
        let whole = whole_laws::find(law.choice(), law.is_booked());
        let mut batch_law = Self::sub_models(law);
        if let Some(run) = whole {
            batch_law.open = vec![run];
        }
        batch_law
    }

    /// The law of this index in a scene, and what it conducts.
    pub(crate) fn of_scene(scene: &Scene, index: usize) -> Self {
        let (mut batch_law, contact) = (Self::of(scene.law(index)), &scene.contacts[index]);
        if let Some(model) = contact.heat {
            let (normal, heat) = (&contact.choice.normal.row().does, model.row());
            batch_law.needs = batch_law.needs.and(heat.needs);
            batch_law.heat = Some(Conduction {
                runs: [normal.run_contact_radius, heat.does.run],
                numbers: contact.heat_rows(scene).concat(),
                count: model.count(),
                beyond_touch: normal.adhesion() == Adhesion::BeyondTouch,
            });
        }
        batch_law
    }

    /// What it conducts between bodies, whose row of coefficients is this one where all entries have the same.
    pub(crate) fn conducting(&self, uniform: Option<u32>) -> Option<Conducting<'_>> {
        let Conduction { runs, numbers, count, beyond_touch } = self.heat.as_ref()?;
        let uniform = uniform.map(|row| &numbers[row as usize * count..(row as usize + 1) * count]);
        let table = CoefficientRows { numbers, count: *count };
        Some(Conducting { runs: *runs, table, uniform, beyond_touch: *beyond_touch })
    }

    /// The same, sub-model by sub-model even where the law is compiled whole.
    pub(crate) fn sub_models(law: Law) -> Self {
        assert!(law.places().count <= MOST_COEFFICIENTS, "a law has at most {MOST_COEFFICIENTS} coefficients");
        let (needs, booked) = (law.needs(), law.booking());
        let [mut open, mut bonded, mut released] =
            [EntryEvaluation::Open, EntryEvaluation::Bonded, EntryEvaluation::Released]
                .map(|manner| composed(&law, manner));
        if law.is_booked() {
            let books = [book_open as Run, book_bonded, book_released];
            for (runs, book) in [&mut open, &mut bonded, &mut released].into_iter().zip(books) {
                if !runs.is_empty() {
                    runs.splice(0..0, booked.keeps_before().then_some(keep_before as Run));
                    runs.push(book);
                }
            }
        }
        Self { open, bonded, released, booked, law, needs, heat: None }
    }

    /// Whether it is compiled whole.
    #[cfg(test)]
    pub(super) fn is_fused(&self) -> bool {
        self.open.len() == 1
    }

    /// What is done with a batch of contacts in this manner, one after another, and what of the contacts that looks at.
    pub(super) fn runs(&self, manner: Option<EntryEvaluation>) -> (Needs, &[Run]) {
        match manner {
            None | Some(EntryEvaluation::Open) => (self.needs, &self.open),
            Some(EntryEvaluation::Bonded) => (Needs { spin: false, ..self.needs }, &self.bonded),
            Some(EntryEvaluation::Released) => (self.needs, &self.released),
            Some(EntryEvaluation::Followed) => (Needs::NONE, &[follow as Run]),
        }
    }
}

/// What the sub-models of a law do to a batch in this manner.
///
/// Where a bond suppresses contacts or has suppressed them, the normal force is taken from the overlap beyond an offset, and friction
/// sees it even where it does not act. While bonded, the overlap becomes the offset. Afterwards what goes beyond the offset presses, and
/// the offset shrinks with the overlap: nothing jumps when a bond breaks.
fn composed(law: &Law, manner: EntryEvaluation) -> Vec<Run> {
    let (choice, is_open) = (law.choice(), matches!(manner, EntryEvaluation::Open));
    if !is_open && !law.takes_offset() {
        return Vec::new();
    }
    let (normal, cohesion) = (&choice.normal.row().does, &choice.cohesion.row().does);
    let (friction, rolling) = (&choice.tangential.row().does, &choice.rolling.row().does);
    let carries = choice.scheme.carries();
    let rolls = if carries { rolling.run_carried } else { rolling.run };
    let mut runs: Vec<Run> = Vec::new();
    if is_open && law.undeformed_arms() {
        runs.push(undeform_arms);
    }
    runs.extend(before_sub_models(choice.scheme));
    runs.push(if is_open { normal.run } else { normal.run_from_offset });
    if law.has_cohesion() {
        runs.push(if is_open { cohesion.run } else { cohesion.run_from_offset });
    }
    if let EntryEvaluation::Bonded = manner {
        runs.push(|_, stage| stage.buffer.mute());
    }
    runs.push(if carries { friction.run_carried } else { friction.run });
    match manner {
        EntryEvaluation::Open => {
            runs.extend(law.has_rolling().then_some(rolls));
            runs.extend(law.parts().then_some(part as Run));
        }
        EntryEvaluation::Released => {
            if law.has_rolling() {
                runs.push(|_, stage| stage.buffer.press());
                runs.push(rolls);
            }
            runs.push(|_, stage| keep(stage, false));
        }
        EntryEvaluation::Bonded | EntryEvaluation::Followed => runs.push(|_, stage| keep(stage, true)),
    }
    runs
}

/// Keeps the force on the first body and, as time goes on, the offset.
fn keep(stage: &mut Stage, bonded: bool) {
    for place in 0..stage.buffer.ready {
        // SAFETY: the entries belong to this piece of the list, which keeps offsets.
        let row = unsafe { &mut stage.entries.history(stage.buffer.entry[place] as usize)[stage.offset] };
        let [x, y, z, _] = stage.buffer.force[place];
        let [overlap, offset] = stage.buffer.overlap_and_offset(place);
        let next = if bonded { overlap } else { offset };
        *row = [x, y, z, if stage.step > 0.0 { next } else { row[3] }];
    }
}

/// Keeps the overlap as the offset, where nothing acts.
fn follow(_: Width, stage: &mut Stage) {
    for place in 0..stage.buffer.ready {
        let [overlap, _] = stage.buffer.overlap_and_offset(place);
        if stage.step > 0.0 {
            // SAFETY: as above.
            let row = unsafe { &mut stage.entries.history(stage.buffer.entry[place] as usize)[stage.offset] };
            *row = [0.0, 0.0, 0.0, overlap];
        }
    }
}
