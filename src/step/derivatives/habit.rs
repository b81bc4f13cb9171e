//! Which slopes a communication step carries along: those that the host will probably ask for after it.
//!
//! A host asks after the step. If slopes went along, the answer is there already; otherwise the step is made again. Slopes that
//! nobody asks for are made in vain. Hosts are regular: some ask after each step, others after each trial of a step but the last.
//! So what a host did the last time in the same situation is taken for what it will do, and the situation is whether it asked after
//! each of the two steps before.

use super::answer::BoundaryDerivatives;
use crate::quantity::BoundaryIndex;

/// An axis of a boundary that derivatives are taken by.
pub(in crate::step) type Input = (BoundaryIndex, usize);

/// How the boundaries change with an input.
type Found = (Input, Vec<BoundaryDerivatives>);

/// When and for what a host asks, and what it finds already there.
#[derive(Debug, Default)]
pub(in crate::step) struct Habit {
    /// Inputs that it asked for after the last communication step of which it asked for any.
    inputs: Vec<Input>,
    /// Whether it has asked since the last communication step.
    asks: bool,
    /// The situation: a bit for each of the two steps before, whether it asked after it, the later one lowest.
    situation: usize,
    /// Whether it asked the last time in each situation.
    asked: [bool; 4],
    /// What the last communication step carried along.
    found: Vec<Found>,
}

impl Habit {
    /// A communication step begins. Returns the inputs by which slopes are to go along, none where nobody is expected to ask.
    pub(in crate::step) fn expect(&mut self) -> Vec<Input> {
        self.found.clear();
        let asks = std::mem::take(&mut self.asks);
        self.asked[self.situation] = asks;
        self.situation = (self.situation << 1 | usize::from(asks)) & 3;
        if self.asked[self.situation] { self.inputs.clone() } else { Vec::new() }
    }

    /// The host asks for the derivatives by these inputs.
    pub(in crate::step) fn ask(&mut self, inputs: &[Input]) {
        if !std::mem::replace(&mut self.asks, true) {
            self.inputs.clear();
        }
        let new: Vec<Input> = inputs.iter().filter(|input| !self.inputs.contains(input)).copied().collect();
        self.inputs.extend(new);
    }

    /// What the last communication step carried along.
    pub(in crate::step) fn keep(&mut self, found: impl Iterator<Item = Found>) {
        self.found.extend(found);
    }

    /// How the boundaries change with an input, if that was carried along.
    pub(in crate::step) fn by(&self, input: Input) -> Option<&Vec<BoundaryDerivatives>> {
        self.found.iter().find(|(known, _)| *known == input).map(|(_, found)| found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lets a host ask after some steps, again and again, and tells in how many of the last ones slopes went along in vain, and in
    /// how many they were missing.
    fn misjudged(asks: &[bool]) -> [usize; 2] {
        let (mut habit, input, mut wrong) = (Habit::default(), (BoundaryIndex(0), 2), [0; 2]);
        for round in 0..6 {
            for &asks in asks {
                let carries = !habit.expect().is_empty();
                if asks {
                    habit.ask(&[input]);
                }
                if round > 2 {
                    wrong[0] += usize::from(carries && !asks);
                    wrong[1] += usize::from(!carries && asks);
                }
            }
        }
        wrong
    }

    #[test]
    fn regular_hosts_are_known_and_rare_ones_cost_one_step_each_time() {
        assert_eq!(misjudged(&[false]), [0, 0]);
        assert_eq!(misjudged(&[true]), [0, 0]);
        assert_eq!(misjudged(&[true, false]), [0, 0]);
        assert_eq!(misjudged(&[true, true, false]), [0, 0]);
        assert_eq!(misjudged(&[true, false, false, false, false, false, false]), [3, 3]);
    }

    #[test]
    fn the_inputs_are_those_asked_for_last() {
        let [one, two, three] = [0, 1, 2].map(|axis| (BoundaryIndex(0), axis));
        let mut habit = Habit::default();
        for _ in 0..4 {
            habit.expect();
            habit.ask(&[one, two]);
        }
        assert_eq!(habit.expect(), [one, two]);
        habit.ask(&[two]);
        habit.ask(&[two, three]);
        assert_eq!(habit.expect(), [two, three]);
    }
}
