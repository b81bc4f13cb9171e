//! The stable time step: when it is found again, and what follows from it.

use super::{RunError, Simulation};
use crate::bond::creation::{Creation, Due, Window};
use crate::boundaries::{RigidBody, course};
use crate::interactions::Ahead;
use crate::scene::{Scene, Step};
use crate::stability::{self, Limit, System};
use crate::state::State;
use crate::threads::Context;

/// Time steps in which the motion of a flow uses up what was foreseen, about.
const STEPS_BETWEEN_LOOKS: f64 = 500.0;

/// Time steps in which free fall may use up the speed that was foreseen.
const STEPS_OF_FALL: f64 = 50.0;

/// Way of both bodies that is always foreseen, over the mean overlap of the contacts.
const CERTAIN: f64 = 0.1;

/// The least of it over the smallest radius: with contacts that hardly touch, and without contacts.
const LEAST: [f64; 2] = [2e-6, 2e-3];

/// How much longer an automatic time step must have become possible before it is lengthened.
const LENGTHENING: f64 = 1.1;

/// The automatic time step of a scene in which nothing is stiff \[s\].
pub const LONGEST_AUTOMATIC_STEP: f64 = 1e-3;

/// What is foreseen.
struct Sight {
    /// How far.
    ahead: Ahead,
    /// Half of the speed at which bodies may meet that are not near each other \[m/s\].
    speed: f64,
}

impl Simulation {
    /// Mean overlap of the contacts that touch \[m\], if any do.
    pub fn mean_overlap(&self) -> Option<f64> {
        mean_overlap(&self.state, &self.scene)
    }

    /// The stable time step of the network of contacts and bonds as it may become soon, and of impacts to come; with what
    /// limits it.
    pub fn limit(&self) -> Limit {
        let sight = self.sight(self.state.clock.step);
        let mut counter = self.state.foresight.counter;
        let (system, context) = (self.system(), self.standing());
        let found = system.find(&sight.ahead, sight.speed, 0.0, &mut counter, &context);
        let by = system.limiter(&sight.ahead, sight.speed, &found, counter, &context);
        Limit { safe: found.safe(), by }
    }

    /// What the stable time step is found from.
    fn system(&self) -> System<'_> {
        let Self { scene, state, bodies, fields, passes, .. } = self;
        System { scene, state, bodies, fields, passes }
    }

    /// What is to be foreseen at time steps of about this length \[s\].
    fn sight(&self, step: f64) -> Sight {
        let fastest = self.system().fastest();
        let boundaries = course::speeds(&self.scene, &self.bodies, &self.state).collect::<Vec<_>>();
        let driven = boundaries.iter().copied().fold(0.0, f64::max);
        let acceleration = self.fields.acceleration(&self.state.particles);
        let least = self.search.smallest_radius().min(f64::MAX);
        let margin = match mean_overlap(&self.state, &self.scene) {
            Some(mean) => (CERTAIN * mean).max(LEAST[0] * least),
            None => LEAST[1] * least,
        };
        let way = margin.max(2.0 * fastest.max(driven) * STEPS_BETWEEN_LOOKS * step);
        let rest = if step > 0.0 { 0.5 * margin / (STEPS_BETWEEN_LOOKS * step) } else { 0.0 };
        let falling = fastest + acceleration * STEPS_OF_FALL * step;
        let speed = stability::foreseen_speed(fastest, driven).max(rest).max(falling);
        let clock = &self.state.clock;
        let window = Window {
            after: clock.steps,
            until: clock.steps + STEPS_BETWEEN_LOOKS as u64,
            from: clock.time,
            to: clock.time + STEPS_BETWEEN_LOOKS * step,
        };
        let window = (!self.scene.bonds.is_empty()).then_some(window);
        Sight { ahead: Ahead { margin, way, acceleration, boundaries, window }, speed }
    }

    /// Finds the stable time step, for time steps of this length \[s\] or shorter. With a given step that is longer, an error.
    pub(super) fn look(&mut self, step: f64, context: &Context) -> Result<(), RunError> {
        let sight = self.sight(step);
        let mut counter = self.state.foresight.counter;
        let guess = self.state.foresight.root;
        let found = self.system().find(&sight.ahead, sight.speed, guess, &mut counter, context);
        let (bonds, looks) = (bonds_so_far(&self.state), self.state.foresight.looks + 1);
        let window = sight.ahead.window.as_ref();
        self.state.foresight = crate::state::Foresight {
            root: found.network,
            counter,
            looks,
            travel: 0.0,
            reach: 0.5 * sight.ahead.way,
            speed: sight.speed,
            bonds,
            until: window.map_or(0, |window| window.until),
            to: window.map_or(0.0, |window| window.to),
        };
        self.state.clock.stable = found.safe();
        let blocks = self.system().blocks(&sight.ahead);
        stability::put_blocks(&mut self.state, blocks);
        if step > found.safe() && matches!(self.scene.run.step, Step::Given(_)) && !self.scene.run.allow_unstable {
            let by = self.system().limiter(&sight.ahead, sight.speed, &found, counter, context);
            let by = by.map_or_else(String::new, |by| self.words(&by));
            return Err(RunError::StepTooLong { step, stable: found.safe(), by, time: self.time() });
        }
        self.check_contacts()
    }

    /// Finds anew what contacts offer to surfaces that forces move, where one has come to more contacts than it had.
    pub(super) fn follow_contacts(&mut self, step: f64) {
        let light = |(_, body): &(usize, &Option<RigidBody>)| body.as_ref().is_some_and(RigidBody::is_implicit);
        let bodies = self.bodies.iter().enumerate().filter(light);
        if bodies.map(|(index, _)| index).any(|index| stability::has_more_contacts(&self.state, index)) {
            let sight = self.sight(step);
            let blocks = self.system().blocks(&sight.ahead);
            stability::put_blocks(&mut self.state, blocks);
        }
    }

    /// What limits the time step, in words.
    pub fn words(&self, by: &stability::Limiter) -> String {
        let number = |index: u32| self.number(index);
        let with = match (by.second, by.boundary) {
            (Some(second), _) => format!("s {} and {}", number(by.first), number(second)),
            (None, Some(boundary)) => {
                let name = self.scene.boundaries.get(boundary as usize).map_or("", |boundary| &boundary.name);
                format!(" {} and boundary {name}", number(by.first))
            }
            (None, None) => format!(" {}", number(by.first)),
        };
        format!("{} of particle{with}, {}", by.kind.words(), by.mode.words())
    }

    /// Whether what was foreseen has been used up: by motion, by speed, by bonds. Boundaries are this fast \[m/s\], the next
    /// time step has this length \[s\].
    pub(super) fn is_due(&self, boundaries: f64, step: f64) -> bool {
        let (foresight, clock) = (&self.state.foresight, &self.state.clock);
        let speed = clock.speed.max(0.5 * (clock.speed + boundaries));
        if foresight.travel > foresight.reach || speed > foresight.speed {
            return true;
        }
        if self.scene.bonds.is_empty() {
            return false;
        }
        let [made, broken] = bonds_so_far(&self.state);
        let next = Window { after: clock.steps, until: clock.steps + 1, from: clock.time, to: clock.time + step };
        let unforeseen = |creation: &Creation| match creation.due() {
            Due::Step(number) => number > foresight.until,
            Due::Time(time) => time > foresight.to,
            Due::AtStart | Due::Always => false,
        };
        let coming = self.scene.bonds.iter().any(|bond| bond.create.comes_within(&next) && unforeseen(&bond.create));
        let uncovered = broken > foresight.bonds[1] && self.suppression.any();
        let unexpected = made > foresight.bonds[0] && clock.steps > foresight.until;
        coming || uncovered || unexpected
    }

    /// Largest speed of a boundary, as it is about to move \[m/s\].
    pub(super) fn boundary_speed(&self) -> f64 {
        course::speeds(&self.scene, &self.bodies, &self.state).fold(0.0, f64::max)
    }

    /// Shortens an automatic time step when the stable one has become shorter. Returns whether it has.
    pub(super) fn shorten_step(&mut self) -> bool {
        let Step::Automatic { safety } = self.scene.run.step else { return false };
        let step = (safety * self.state.clock.stable).min(LONGEST_AUTOMATIC_STEP);
        // A bound of 0 is that of numbers beyond what is finite; no time step mends them.
        let shorter = step < self.state.clock.step && step > 0.0;
        if shorter {
            self.state.clock.step = step;
        }
        shorter
    }

    /// Lengthens an automatic time step, between communication steps, where the packing allows a good deal more.
    pub(super) fn lengthen_step(&mut self) {
        let Step::Automatic { safety } = self.scene.run.step else { return };
        let step = (safety * self.state.clock.stable).min(LONGEST_AUTOMATIC_STEP);
        if step > LENGTHENING * self.state.clock.step {
            self.state.clock.step = step;
        }
    }

    /// The time step of the start, by what was found.
    pub(super) fn first_step(&mut self, context: &Context) -> Result<(), RunError> {
        let given = match self.scene.run.step {
            Step::Given(step) => step,
            Step::Automatic { .. } => 0.0,
        };
        self.look(given, context)?;
        self.state.clock.step = match self.scene.run.step {
            Step::Given(step) => step,
            Step::Automatic { safety } => (safety * self.state.clock.stable).min(LONGEST_AUTOMATIC_STEP),
        };
        Ok(())
    }
}

/// Bonds made and bonds broken so far.
fn bonds_so_far(state: &State) -> [u64; 2] {
    state.bonds.iter().fold([0; 2], |[made, broken], list| [made + list.made, broken + list.broken])
}

/// Mean overlap of the contacts that touch \[m\], if any do.
fn mean_overlap(state: &State, scene: &Scene) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_usize);
    super::observe::each_overlap(state, scene, &mut |overlap, _| {
        sum += overlap;
        count += 1;
    });
    (count > 0).then(|| sum / count as f64)
}
