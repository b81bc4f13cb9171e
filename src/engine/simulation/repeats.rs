//! How communication steps were divided into time steps, so that one that is made again is divided alike.
//!
//! A master that iterates makes a communication step again and again from one state with other inputs, and differences are taken of two
//! such steps. Where an automatic time step were chosen anew each time, a small change of an input could change the number of time
//! steps, and outputs would jump. So the division is that of the first trial, as long as it is stable.

use super::Simulation;
use crate::engine::state::{Clock, Underway};

/// Communication steps that are remembered.
const MOST: usize = 64;

/// Some equal time steps of a communication step.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// What was left when they began.
    underway: Underway,
    /// The time step that was chosen \[s\].
    step: f64,
    /// How many were made before the rest was divided anew.
    made: u64,
}

/// How a communication step was divided.
#[derive(Clone, Debug)]
struct Division {
    /// The clock when it began, whose speed and steps tell one state from others of the same time, and its length \[s\].
    begun: (Clock, f64),
    /// Its parts.
    parts: Vec<Part>,
}

/// The communication steps that may be made again.
#[derive(Debug, Default)]
pub(super) struct Repeats {
    /// How they were divided.
    known: Vec<Division>,
    /// Whether the next one is to be remembered.
    records: bool,
    /// The one that is being recorded or made again, and which part of it.
    current: Option<(usize, usize)>,
    /// Whether it is made again.
    repeats: bool,
    /// Whether it went on with time steps that would have been shortened.
    late: bool,
}

impl Repeats {
    /// Remembers the next communication step, which begins now.
    pub(super) fn record(&mut self, clock: &Clock) {
        self.records = true;
        self.known.retain(|division| division.begun.0.steps + MOST as u64 >= clock.steps);
        if self.known.len() >= MOST {
            self.known.remove(0);
        }
    }

    /// Begins a communication step of this length \[s\]. Returns whether it is one that was made before.
    pub(super) fn begin(&mut self, clock: &Clock, interval: f64) -> bool {
        let begun = (*clock, interval);
        let place = self.known.iter().position(|division| division.begun == begun && !division.parts.is_empty());
        self.repeats = place.is_some();
        self.late = false;
        self.current = place.map(|place| (place, 0));
        if std::mem::take(&mut self.records) && place.is_none() {
            self.known.push(Division { begun, parts: Vec::new() });
            self.current = Some((self.known.len() - 1, 0));
        }
        self.repeats
    }
}

impl Simulation {
    /// Whether the present communication step is made again.
    pub(super) fn is_repeated(&self) -> bool {
        self.repeats.repeats
    }

    /// Notes that what is left of the present communication step was divided so, after so many time steps of the division before.
    pub(super) fn note_division(&mut self, made: u64, underway: &Underway) {
        let Some((place, _)) = self.repeats.current.filter(|_| !self.repeats.repeats) else { return };
        let parts = &mut self.repeats.known[place].parts;
        if let Some(last) = parts.last_mut() {
            last.made = made;
        }
        parts.push(Part { underway: *underway, step: self.state.clock.step, made: u64::MAX });
    }

    /// The next part of it, if it is due.
    pub(super) fn next_part(&mut self, underway: &Underway) -> Option<Underway> {
        let (place, number) = self.repeats.current.filter(|_| self.repeats.repeats)?;
        let parts = &self.repeats.known[place].parts;
        if parts[number].made != underway.done || number + 1 == parts.len() {
            return None;
        }
        self.repeats.current = Some((place, number + 1));
        self.part(underway.boundary_speed)
    }

    /// The present part, if its time steps are stable; otherwise the division is chosen anew from here.
    pub(super) fn part(&mut self, boundary_speed: f64) -> Option<Underway> {
        let (place, number) = self.repeats.current.filter(|_| self.repeats.repeats)?;
        let Part { underway, step, .. } = self.repeats.known[place].parts[number];
        if underway.step > self.state.clock.stable {
            self.repeats.repeats = false;
            self.repeats.known[place].parts.truncate(number);
            return None;
        }
        self.state.clock.step = step;
        Some(Underway { boundary_speed, ..underway })
    }

    /// Whether a time step of a communication step that is made again goes on as it was, though a shorter one would have been chosen.
    pub(super) fn goes_on(&mut self, underway: &Underway) -> bool {
        let Some((place, number)) = self.repeats.current.filter(|_| self.repeats.repeats) else { return false };
        let parts = &mut self.repeats.known[place].parts;
        if underway.step > self.state.clock.stable {
            parts.truncate(number + 1);
            self.repeats.repeats = false;
            return false;
        }
        self.repeats.late |= parts[number].made != underway.done;
        true
    }

    /// Ends a communication step: what was not shortened in it is now.
    pub(super) fn end_repeat(&mut self) {
        if std::mem::take(&mut self.repeats.late) {
            self.shorten_step();
        }
        (self.repeats.repeats, self.repeats.current) = (false, None);
    }
}
