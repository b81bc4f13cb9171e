//! How long the next time steps are, by the stable one, by motion and by what the scene asks for.

use crate::engine::fluid::Stream;
use crate::engine::simulation::Simulation;
use crate::engine::transfer;
use crate::laws::contact::impact::LONGEST_PART;
use crate::scene::{Bond, Insertion, Run, Step};

/// How much longer an automatic time step must have become possible before it is lengthened.
const LENGTHENING: f64 = 1.1;

/// How much longer than it would be chosen now an automatic time step may be in the first [`BETWEEN_LOOKS`] time steps of a
/// communication step: with 0.8 of the stable one it is then stable all the same.
///
/// [`BETWEEN_LOOKS`]: super::due::BETWEEN_LOOKS
const SLACK: f64 = 1.25;

/// By which factor an automatic time step changes within a communication step, or by powers of it.
const RUNG: f64 = 1.02;

/// Way in one automatic time step over the smallest radius; a step becomes shorter where what moves fastest goes a quarter farther.
const MOST_WAY: [f64; 2] = [0.1, 0.125];

impl Simulation {
    /// The automatic time step that belongs to a stable one \[s\], infinite where nothing limits it; none where it is given.
    pub(in crate::engine::simulation) fn automatic_step(&self, stable: f64) -> Option<f64> {
        if self.scene.heat.frozen {
            return self.stride();
        }
        let part = self.part_of_stable()? * stable;
        Some(part.min(self.longest_by_motion()).min(self.longest_by_springs()).min(self.longest_by_vibration()))
    }

    /// The time step of heat while nothing moves \[s\], infinite where nothing limits it; none where it is given.
    pub(in crate::engine::simulation) fn stride(&self) -> Option<f64> {
        let heat = self.state.heat.as_ref().filter(|_| self.scene.run.step.is_automatic())?;
        Some(if heat.stride > 0.0 { heat.stride } else { transfer::longest_step(Some(heat)) })
    }

    /// The time step in which nothing moves farther than a part of the smallest radius: as fast as it is and as particles come, and
    /// with what gravity, applied forces and the loads of bodies add in it \[s\].
    fn longest_by_motion(&self) -> f64 {
        let Self { scene, state, bodies, .. } = self;
        let way = MOST_WAY[0] * self.search.smallest_radius();
        let coming = scene.insertions.iter().map(Insertion::fastest).fold(0.0, f64::max);
        let speed = state.clock.speed.max(self.boundary_speed()).max(coming);
        let free = bodies.iter().zip(&state.boundaries).filter_map(|(body, moved)| {
            let body = body.as_ref().filter(|body| body.is_free())?;
            Some(body.acceleration(moved, body.farthest))
        });
        let acceleration = free.fold(self.acceleration_of_fields(), f64::max);
        let strained = self.cell.as_ref().map_or(f64::INFINITY, |cell| cell.longest_step(state));
        strained.min(2.0 * way / (speed + (speed * speed + 2.0 * acceleration * way).sqrt()))
    }

    /// Largest acceleration that gravity, applied forces and the fluid give \[m/s²\].
    pub(super) fn acceleration_of_fields(&self) -> f64 {
        let stream = self.medium.as_ref().zip(self.state.fluid.as_ref());
        let fluid = stream.map_or(0.0, |(medium, fluid)| Stream::of(medium, fluid).acceleration(&self.state));
        self.fields.acceleration(&self.state.particles) + fluid
    }

    /// Whether what moves fastest goes too far in an automatic time step of this length \[s\].
    pub(in crate::engine::simulation) fn outruns(&self, step: f64) -> bool {
        self.scene.run.step.is_automatic()
            && self.state.clock.speed * step > MOST_WAY[1] * self.search.smallest_radius()
    }

    /// Whether a given time step is divided where the stable one is below it. What knows the step by its number, or relaxes in it, needs
    /// the very step that was given.
    pub(in crate::engine::simulation) fn divides(&self) -> bool {
        let Run { step, allow_unstable, strict_step, .. } = self.scene.run;
        let needs =
            |bond: &Bond| bond.keys.needs_given_step().or(bond.keys.shortest_relaxation().map(|_| "")).is_some();
        matches!(step, Step::Given(_)) && !allow_unstable && !strict_step && !self.scene.bonds.iter().any(needs)
    }

    /// The longest whole part of a given time step that is a good deal below the stable one \[s\]; none where it is not divided.
    fn whole_part(&self) -> Option<f64> {
        let Step::Given(step) = self.scene.run.step else { return None };
        let most = LONGEST_PART * self.state.clock.stable;
        let holds = self.divides() && most > 0.0;
        holds.then(|| step / (step / most).ceil().max(1.0))
    }

    /// Divides a given time step where the stable one has fallen below it. Returns whether it has.
    pub(in crate::engine::simulation) fn divide_given(&mut self) -> bool {
        let is_above = self.state.clock.step > self.state.clock.stable;
        let Some(step) = self.whole_part().filter(|_| is_above) else { return false };
        self.state.clock.step = step;
        true
    }

    /// Joins the parts of a given time step again, where the stable one is far enough above them.
    pub(in crate::engine::simulation) fn join_given(&mut self) {
        if let Some(step) = self.whole_part() {
            self.state.clock.step = step.max(self.state.clock.step);
        }
    }

    /// Notes a time step of this length \[s\], where it is shorter than the scene says.
    pub(in crate::engine::simulation) fn count_divided(&mut self) {
        if let Step::Given(step) = self.scene.run.step {
            self.state.clock.divided += u64::from(self.state.clock.step < step);
        }
    }

    /// Shortens an automatic time step when the stable one has become shorter, or what moves goes farther.
    pub(in crate::engine::simulation) fn shorten_step(&mut self) {
        let Some(step) = self.automatic_step(self.state.clock.stable) else { return };
        // A bound of 0 is that of numbers beyond what is finite; no time step mends them.
        if step < self.state.clock.step && step > 0.0 {
            self.state.clock.step = step;
        }
    }

    /// Shortens an automatic time step within a communication step: at once or, so that inputs which differ a little make no difference,
    /// where it is a good deal too long. It shrinks by whole hundredths for the same reason. Returns whether it has.
    pub(in crate::engine::simulation) fn shorten_on_the_way(&mut self, at_once: bool) -> bool {
        let Some(step) = self.automatic_step(self.state.clock.stable) else { return self.divide_given() };
        let slack = if at_once { 1.0 } else { SLACK };
        let shorter = slack * step < self.state.clock.step && step > 0.0;
        while shorter && step < self.state.clock.step {
            self.state.clock.step /= RUNG;
        }
        shorter
    }

    /// Lengthens an automatic time step within a communication step, where a good deal more is allowed. Returns whether it has.
    pub(in crate::engine::simulation) fn lengthen_on_the_way(&mut self) -> bool {
        let Some(step) = self.automatic_step(self.state.clock.stable) else { return false };
        let longer = step.is_finite() && step > LENGTHENING * self.state.clock.step;
        while longer && step >= RUNG * self.state.clock.step {
            self.state.clock.step *= RUNG;
        }
        longer
    }

    /// Lengthens an automatic time step for a communication step of this length \[s\], where a good deal more is allowed.
    pub(in crate::engine::simulation) fn lengthen_step(&mut self, length: f64) {
        let Some(step) = self.automatic_step(self.state.clock.stable) else { return };
        let clock = &mut self.state.clock;
        if step.is_infinite() {
            clock.step = length;
        } else if step > LENGTHENING * clock.step {
            clock.step = step;
        }
    }
}
