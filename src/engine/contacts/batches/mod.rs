//! Evaluates a contact law on the touching entries of a list, whatever the bodies are.
//!
//! Batches of entries, with buffers that stay in the first-level cache, go through four phases:
//!
//! 1. *touch*: which entries touch, several at a time; they are compacted without a branch, and where their bodies
//!    are to each other with them;
//! 2. *meet*: geometry and relative motion, written as columns;
//! 3. *react*: the sub-models of the law, one after another on the columns; forces and torques as rows;
//! 4. *spread*: the rows are added to the bodies, one by one, in the order of the list.
//!
//! Phases 1, 2 and 4 know the bodies but not the law, phase 3 knows the law but not the bodies ([`law`]): each is compiled
//! once for each kind of what it knows. Short phases also let the processor work on several registers' worth of contacts at once.
//! Roots and quotients, for which later instructions would wait, are computed one register ahead.
//!
//! A new kind of body needs an implementation of [`Bodies`]; its pass fills [`Batches`] and calls [`Batches::run`] on pieces
//! of the list. Pieces that run at the same time must not write to the same body.

mod deepest;
mod held;
mod law;
mod lost;
mod parting;
mod phases;
mod tracing;
mod whole_laws;

use crate::base::lanes::{self, Lane, Width};
use crate::base::number::Number;
use crate::engine::contacts::coefficients::CoefficientTable;
use crate::engine::state::contacts::{BONDED, LASTING, RELEASED, SILENT};
use crate::laws::contact::Needs;
pub(crate) use crate::laws::contact::batch::{
    Buffer, ContactGeometry, Entries, FOUND, Followed, Parted, SpherePair, Touching, Trace,
};
use crate::laws::contact::batch::{Conducting, EntryEvaluation, Stage};
pub(crate) use deepest::DeepestSearch;
pub(crate) use law::BatchLaw;
pub(crate) use lost::Lost;
use phases::{GeometryPhase, ScatterPhase, TouchPhase};
use std::ops::Range;

/// Which bodies an entry of a list brings together.
pub(crate) trait Bodies: Copy {
    /// What is summed in addition to the loads on particles.
    type Sum: Default;

    /// How many numbers [`Bodies::touch`] hands to [`Bodies::meet`].
    const FOUND: usize;

    /// The first body of each entry (slot).
    fn first(&self) -> &[u32];

    /// The second body of each entry (slot); where the second body is always the same, anything.
    fn second(&self) -> &[u32];

    /// Which entries touch, a bit for each, and what [`Bodies::meet`] has to know of their places. `beyond` is how far
    /// apart each may be to count as touching \[m\], for laws that hold bodies together beyond touch.
    ///
    /// # Safety
    /// Both point to [`Lane::WIDTH`] slots of the lists.
    unsafe fn touch<N: Lane>(
        &self,
        first: *const u32,
        second: *const u32,
        beyond: Option<N>,
        sum: &mut Self::Sum,
    ) -> (u32, [N; FOUND]);

    /// Computes ahead what takes the processor long and follows from the positions alone: roots and quotients.
    fn roots<N: Lane>(found: &[N; FOUND]) -> [N; 2];

    /// Geometry and relative motion; slip, spin and arms where there is torque.
    ///
    /// # Safety
    /// As for [`Bodies::touch`].
    unsafe fn meet<N: Lane, const TORQUE: bool>(
        &self,
        first: *const u32,
        second: *const u32,
        found: [N; FOUND],
        roots: [N; 2],
    ) -> ContactGeometry<N>;

    /// The radius of the smaller body, by what was found and the effective radius \[m\].
    fn smaller_radius<N: Number>(_found: [N; FOUND], effective: N) -> N {
        effective
    }

    /// The weight of the normal force of each entry, its share of friction and the weight of its energy, if they are not 1.
    fn weights(&self) -> Option<&[[f64; 3]]> {
        None
    }

    /// The row of the law's table for two bodies.
    fn row(&self, table: &CoefficientTable, first: u32, second: u32) -> u32;

    /// Tells the processor that these particles (slots) will be needed soon, with what the law looks at.
    fn prefetch(&self, _slots: Range<usize>, _needs: Needs) {}

    /// Adds heat \[J\] that two bodies share to them.
    fn warm(&self, first: u32, second: u32, heat: f64, sum: &mut Self::Sum);

    /// Lets heat flow between the bodies of some entries over these conductances \[W/K\], one by one.
    fn conduct(&self, entries: [&[u32]; 2], conductance: &[f64], sum: &mut Self::Sum);

    /// Adds the loads of touching entries to their bodies, one by one.
    fn spread(&self, touching: &Touching, needs: Needs, sum: &mut Self::Sum);
}

/// Which entries of a list are evaluated: those whose flags, among some bits, have exactly these.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chosen {
    /// The bits that are compared.
    pub mask: u8,
    /// The values that these bits must have.
    pub value: u8,
}

impl EntryEvaluation {
    /// The entries that are evaluated in this manner.
    fn chosen(self) -> Chosen {
        let silent = BONDED | SILENT | LASTING;
        match self {
            Self::Open => Chosen { mask: BONDED | RELEASED, value: 0 },
            Self::Bonded => Chosen { mask: BONDED | SILENT, value: BONDED },
            Self::Released => Chosen { mask: RELEASED, value: RELEASED },
            Self::Followed => Chosen { mask: silent, value: silent },
        }
    }
}

/// A list that is evaluated in pieces.
#[derive(Clone, Copy)]
pub(crate) struct Batches<'a, B> {
    /// Which bodies meet.
    pub bodies: B,
    /// What the list stores.
    pub entries: Entries,
    /// The law.
    pub law: &'a BatchLaw,
    /// Coefficients of the law.
    pub table: &'a CoefficientTable,
    /// The coefficients of all entries, if they are the same.
    pub uniform: Option<&'a [f64]>,
    /// Time since the history was last advanced \[s\].
    pub step: f64,
    /// Lane width.
    pub width: Width,
    /// Who looks for the deepest contact.
    pub deepest: &'a DeepestSearch,
    /// Whether contacts are followed one by one.
    pub follows: bool,
    /// What conducts heat, if anything does.
    pub conducting: Option<Conducting<'a>>,
}

impl<B: Bodies> Batches<'_, B> {
    /// Evaluates the law on a piece of the list. Pieces that run at the same time must not write to the same body. `ahead`
    /// are particles (slots) that a later piece will need; they are fetched into the cache bit by bit.
    pub(crate) fn run(&self, from: usize, to: usize, ahead: Range<usize>) -> B::Sum {
        Buffer::with(|buffer| self.run_in(buffer, from..to, ahead))
    }

    /// The same, and what was lost, for a law whose losses are booked.
    pub(crate) fn run_booked(&self, from: usize, to: usize, ahead: Range<usize>) -> (B::Sum, Lost) {
        Buffer::with(|buffer| {
            buffer.losses.begin();
            let sum = self.run_in(buffer, from..to, ahead);
            (sum, Lost::of(buffer.losses.end()))
        })
    }

    /// The same, and what single contacts did.
    pub(crate) fn run_followed(
        &self,
        from: usize,
        to: usize,
        ahead: Range<usize>,
        found: &mut Followed,
    ) -> (B::Sum, Lost) {
        Buffer::with(|buffer| {
            buffer.losses.begin();
            let sum = self.run_in(buffer, from..to, ahead);
            found.take(&buffer.losses.followed);
            (sum, Lost::of(buffer.losses.end()))
        })
    }

    /// The same, in this room. Where bonds suppress contacts, those of each manner are done one after the other.
    fn run_in(&self, buffer: &mut Buffer, entries: Range<usize>, ahead: Range<usize>) -> B::Sum {
        let mut sum = B::Sum::default();
        let offset = self.law.law.history().len();
        if self.entries.kept <= offset {
            self.run_chosen(buffer, entries, ahead, None, &mut sum);
            return sum;
        }
        let present = self.entries.present(entries.clone());
        for manner in EntryEvaluation::ALL {
            let ahead = if matches!(manner, EntryEvaluation::Open) { ahead.clone() } else { 0..0 };
            if present & manner.chosen().value == manner.chosen().value {
                self.run_chosen(buffer, entries.clone(), ahead, Some(manner), &mut sum);
            }
        }
        sum
    }

    /// The same for the entries that are done in one manner, or for all.
    fn run_chosen(
        &self,
        buffer: &mut Buffer,
        entries: Range<usize>,
        ahead: Range<usize>,
        manner: Option<EntryEvaluation>,
        sum: &mut B::Sum,
    ) {
        let Self { width, law, bodies, .. } = *self;
        let (needs, runs) = law.runs(manner);
        let Range { start: from, end: to } = entries;
        let (mut next, mut fetched) = (from, ahead.start);
        while next < to {
            let share = ahead.start + ahead.len() * (next - from) / (to - from);
            bodies.prefetch(fetched..share, needs);
            fetched = share;
            let chosen = manner.map_or(Chosen { mask: 0, value: 0 }, EntryEvaluation::chosen);
            let work = self;
            if manner.is_some() {
                lanes::run(width, TouchPhase::<B, false, true> { work, chosen, to, next: &mut next, buffer, sum });
            } else if law.law.holds_beyond_touch() {
                lanes::run(width, TouchPhase::<B, true, false> { work, chosen, to, next: &mut next, buffer, sum });
            } else {
                lanes::run(width, TouchPhase::<B, false, false> { work, chosen, to, next: &mut next, buffer, sum });
            }
            buffer.complete(next == to, B::FOUND);
            let is_suppressed = matches!(manner, Some(EntryEvaluation::Followed));
            if self.meet(needs, buffer) && !is_suppressed {
                self.deepest.look(&bodies, buffer);
            }
            // What a bond suppresses conducts in the stage of heat: few of it are evaluated here.
            if let Some(conducting) = &self.conducting
                && !matches!(manner, Some(EntryEvaluation::Bonded | EntryEvaluation::Followed))
            {
                conducting.find(width, self.stage(buffer));
                let ends = [&buffer.first[..buffer.ready], &buffer.second[..buffer.ready]];
                bodies.conduct(ends, buffer.conductance(), sum);
            }
            let stage = &mut self.stage(buffer);
            for run in runs {
                run(width, stage);
            }
            if !is_suppressed {
                lanes::run(width, ScatterPhase { bodies, needs, buffer, sum });
                if law.booked.warms() && !runs.is_empty() {
                    self.hold(buffer);
                    for (place, &heat) in buffer.heat().iter().enumerate() {
                        bodies.warm(buffer.first[place], buffer.second[place], heat, sum);
                    }
                }
            }
            if self.follows && !is_suppressed && !runs.is_empty() {
                self.trace(buffer);
            }
            buffer.proceed(B::FOUND);
        }
    }

    /// The columns on which the sub-models work.
    fn stage<'b>(&'b self, buffer: &'b mut Buffer) -> Stage<'b> {
        let Self { entries, table, uniform, step, law: BatchLaw { law, booked, .. }, .. } = self;
        let (places, history, offset) = (law.places(), law.history_places(), law.history().len());
        let (touches, onset, table) = (!law.pulls_beyond_touch(), law.onset(), table.rows());
        let weights = self.bodies.weights();
        Stage {
            entries,
            table,
            uniform: *uniform,
            places,
            history,
            offset,
            step: *step,
            touches,
            onset,
            weights,
            booked,
            buffer,
        }
    }

    /// Phase 2, and the rows of the table where they differ. Returns whether some entry is deeper than all before.
    fn meet(&self, needs: Needs, buffer: &mut Buffer) -> bool {
        let (bodies, so_far, mut deeper) = (self.bodies, self.deepest.so_far, 0);
        let deeper_here = &mut deeper;
        if self.uniform.is_none() {
            for place in 0..buffer.ready.next_multiple_of(8) {
                buffer.row[place] = bodies.row(self.table, buffer.first[place], buffer.second[place]);
            }
        }
        if !needs.torque {
            lanes::run(
                self.width,
                GeometryPhase::<B, false, true> { bodies, needs, buffer, so_far, deeper: deeper_here },
            );
        } else if needs.rare() {
            lanes::run(
                self.width,
                GeometryPhase::<B, true, true> { bodies, needs, buffer, so_far, deeper: deeper_here },
            );
        } else {
            lanes::run(
                self.width,
                GeometryPhase::<B, true, false> { bodies, needs, buffer, so_far, deeper: deeper_here },
            );
        }
        deeper != 0
    }
}

#[cfg(test)]
mod tests;
