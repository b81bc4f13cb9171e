//! The stable time step: when it is found again, and what follows from it.

use super::sight::{Horizon, LookAhead};
use crate::base::threads::Context;
use crate::engine::contacts::FASTER;
use crate::engine::simulation::{RunError, Simulation};
use crate::engine::stability::{self, Limit, Limiter, System};
use crate::engine::state::State;
use crate::engine::transfer;
use crate::scene::Step;

/// Stable time steps over a given one from which more is foreseen, and a quick bound suffices.
const FAR_BELOW: f64 = 1.5;

/// The most that is foreseen of the growth of speeds then.
const MOST_FORESEEN: f64 = 10.0;

/// How much longer the automatic time step may be than that for which it was foreseen.
const MUCH_LONGER: f64 = 20.0;

/// How much shorter it may be than that.
const MUCH_SHORTER: f64 = 4.0;

/// How often it is foreseen at a time.
const MOST_TRIES: usize = 4;

/// The automatic time step where nothing limits it and no end is known, until the first communication step does \[s\].
const UNLIMITED: f64 = 1.0;

/// The stable time step, and the network that it was found from, unless a quick bound sufficed.
type Found<'a> = (stability::StableStep, Option<stability::Network<'a>>);

impl Simulation {
    /// The stable time step of contacts and bonds as they may become soon, and of impacts to come; with what limits it.
    pub fn limit(&self) -> Limit {
        self.workers.lend(|threads| {
            let context = Context { threads, ..self.standing() };
            let (sight, (found, network), counter) = self.present_bound(&context);
            if let Some(safe) = self.limited_by_heat(&found) {
                return Limit { safe, by: Some(Limiter::HEAT) };
            }
            let by = self.system().limiter(&sight.ahead, sight.speed, (&found, network), counter, &context);
            Limit { safe: found.safe(), by }
        })
    }

    /// The stable time step alone \[s\].
    pub fn stable_step(&self) -> f64 {
        self.workers.lend(|threads| {
            let (_, (found, _), _) = self.present_bound(&Context { threads, ..self.standing() });
            self.safe(&found)
        })
    }

    /// The stable time step of the last look, or of the hardest impact once particles are this fast \[m/s\], where that is shorter \[s\].
    pub(crate) fn stable_step_at(&self, speed: f64) -> f64 {
        let foreseen = stability::foreseen_speed(speed, self.boundary_speed(), FASTER);
        let root = self.system().impact(foreseen, self.acceleration_of_fields()).unwrap_or(0.0);
        self.state.clock.stable.min(2.0 / root)
    }

    /// The longest time step that heat allows, where it allows less than what was found \[s\].
    fn limited_by_heat(&self, found: &stability::StableStep) -> Option<f64> {
        let longest = transfer::longest_step(self.state.heat.as_ref());
        (self.scene.heat.frozen || longest < found.safe()).then_some(longest)
    }

    /// The stable time step by what was found, and by heat \[s\].
    fn safe(&self, found: &stability::StableStep) -> f64 {
        self.limited_by_heat(found).unwrap_or(found.safe())
    }

    /// The stable time step, what it was foreseen for, and how many iterations have been started.
    fn present_bound(&self, context: &Context) -> (LookAhead, Found<'_>, u64) {
        let mut counter = self.state.foresight.counter;
        let (step, near) = (self.state.clock.step, Horizon::NEAR);
        let (sight, found) = self.foresee(step, near, (0.0, f64::INFINITY), &mut counter, context);
        (sight, found, counter)
    }

    /// What the stable time step is found from.
    pub(in crate::engine::simulation) fn system(&self) -> System<'_> {
        let Self { scene, state, bodies, fields, passes, .. } = self;
        System { scene, state, bodies, strikers: self.strikers(), fields, passes }
    }

    /// Foresees for time steps of this length \[s\], or of the automatic one that follows, where that is much longer: from a root found
    /// earlier \[1/s\], and until it is known that a time step that is `enough` \[s\] is stable.
    fn foresee(
        &self,
        step: f64,
        horizon: Horizon,
        (guess, enough): (f64, f64),
        counter: &mut u64,
        context: &Context,
    ) -> (LookAhead, Found<'_>) {
        let (mut step, mut tries) = (step, 0);
        loop {
            let sight = self.sight(step, horizon, guess);
            let (mut found, network) = self.system().find(&sight.ahead, sight.speed, guess, enough, counter, context);
            // Without a network impacts to come are all that there is: the stable step is finite where anything can touch.
            if found.network > 0.0 && !self.may_strangers_meet(&sight, &found, step) {
                found.impacts = 0.0;
            }
            let next = self.automatic_step(found.safe()).unwrap_or(step);
            tries += 1;
            let fits = next <= MUCH_LONGER * step && step <= MUCH_SHORTER * next;
            if fits || sight.rests || tries == MOST_TRIES {
                return (sight, (found, network));
            }
            // Where too much was foreseen, the step is between: the one that follows from it foresees too little.
            step = if next < step { (step * next).sqrt() } else { next };
        }
    }

    /// Whether bodies that are in no list may meet before the next look, at time steps of this length \[s\] or of the one that
    /// follows from the network alone.
    fn may_strangers_meet(&self, sight: &LookAhead, found: &stability::StableStep, step: f64) -> bool {
        let step = self.automatic_step(2.0 / found.network).unwrap_or(step).max(step);
        let way = sight.ahead.way.max(sight.way(step));
        !self.search.holds_all_within(&self.state, way)
    }

    /// How far is to be foreseen at the next look, for time steps of this length \[s\]. The farther they are below the stable one, the
    /// more is foreseen, and the fewer looks a bed takes that begins to move.
    fn horizon(&self, step: f64) -> Horizon {
        let (stable, looks) = (self.state.clock.stable, self.state.foresight.looks);
        let is_far = looks > 0 && stable > FAR_BELOW * step;
        match self.scene.run.step {
            _ if !is_far => Horizon::NEAR,
            Step::Given(step) => Horizon { faster: (FASTER * (stable / step).powi(2)).min(MOST_FORESEEN), is_far },
            Step::Automatic { .. } | Step::Following => Horizon { faster: FASTER, is_far },
        }
    }

    /// Finds the stable time step, for time steps of this length \[s\] or shorter. With a given step that is longer, an error.
    pub(in crate::engine::simulation) fn look(&mut self, step: f64, context: &Context) -> Result<(), RunError> {
        let (mut counter, horizon) = (self.state.foresight.counter, self.horizon(step));
        let enough = if let Step::Given(step) = self.scene.run.step { FAR_BELOW * step } else { f64::INFINITY };
        let from = (self.state.foresight.root, enough);
        let (mut sight, (mut found, _)) = self.foresee(step, horizon, from, &mut counter, context);
        if horizon.is_far && found.safe() < FAR_BELOW * step {
            (sight, (found, _)) = self.foresee(step, Horizon::NEAR, from, &mut counter, context);
        }
        let (bonds, looks) = (bonds_so_far(&self.state), self.state.foresight.looks + 1);
        let window = sight.ahead.window.as_ref();
        // Where speed makes nothing stiffer, the way alone tells when to look again.
        let follows_speed = !sight.is_dense || self.system().stiffens(sight.speed, MOST_FORESEEN);
        let growth = if follows_speed { 1.0 } else { MOST_FORESEEN };
        self.state.foresight = crate::engine::state::Foresight {
            root: found.network,
            counter,
            looks,
            travel: 0.0,
            reach: 0.5 * sight.ahead.way,
            strained: 0.0,
            strain_reach: sight.strained,
            speed: growth * sight.speed,
            fastest: self.state.clock.speed,
            bonds,
            until: window.map_or(0, |window| window.until),
            to: window.map_or(0.0, |window| window.to),
        };
        let safe = self.safe(&found);
        self.state.clock.stable = safe;
        let is_given = matches!(self.scene.run.step, Step::Given(_));
        if step > safe && is_given && !self.divides() && !self.scene.run.allow_unstable {
            let by = match self.limited_by_heat(&found) {
                Some(_) => Some(Limiter::HEAT),
                None => self.system().limiter(&sight.ahead, sight.speed, (&found, None), counter, context),
            };
            let by = by.map_or_else(String::new, |by| self.words(&by));
            return Err(RunError::StepTooLong { step, stable: safe, by, time: self.time() });
        }
        self.check_contacts()
    }

    /// Looks at what servos press on, and at how stiff a cell is whose strains reach stresses, where that is due.
    pub(in crate::engine::simulation) fn follow_contacts(&mut self) {
        if self.cell_is_due() {
            self.look_at_cell();
        }
        if self.servos_are_due() {
            self.look_at_pressed();
        }
    }

    /// Looks at how stiff a cell is whose strains reach stresses.
    pub(in crate::engine::simulation) fn look_at_cell(&mut self) {
        if let Some(cell) = self.cell.as_ref().filter(|cell| cell.serves()) {
            cell.find_stiffness(&mut self.state, &self.passes);
        }
    }

    /// Looks at what servos press on.
    pub(in crate::engine::simulation) fn look_at_pressed(&mut self) {
        if !self.serves {
            return;
        }
        let resistances = self.system().resistances();
        for (moved, [stiffness, impedance]) in self.state.boundaries.iter_mut().zip(resistances) {
            for axis in 0..3 {
                let found = [stiffness[axis], impedance[axis], moved.force[axis]];
                moved.pressed[axis].take(found, moved.target[axis]);
            }
        }
    }

    /// What limits the time step, in words.
    pub fn words(&self, by: &stability::Limiter) -> String {
        let boundaries = &self.scene.boundaries;
        let name = |index: u32| boundaries.get(index as usize).map_or_else(String::new, |it| it.name.clone());
        by.words(|index| self.number(index), name)
    }

    /// The time step of the start, by what was found.
    pub(in crate::engine::simulation) fn first_step(&mut self, context: &Context) -> Result<(), RunError> {
        let given = if let Step::Given(step) = self.scene.run.step { step } else { 0.0 };
        self.look(given, context)?;
        let unlimited = self.scene.run.end.unwrap_or(UNLIMITED);
        let limited = |step: f64| if step.is_finite() { step } else { unlimited };
        self.state.clock.step = self.automatic_step(self.state.clock.stable).map_or(given, limited);
        self.divide_given();
        Ok(())
    }
}

/// Bonds made and bonds broken so far.
pub(super) fn bonds_so_far(state: &State) -> [u64; 2] {
    state.bonds.iter().fold([0; 2], |[made, broken], list| [made + list.made, broken + list.broken])
}
