//! One communication step: how many time steps, and what is looked at between them.

use super::pace::{BETWEEN_LOOKS, Seen};
use super::{RunError, Simulation};
use crate::base::threads::{Context, Threads};
use crate::engine::boundaries::{course, nodes};
use crate::engine::fluid;
use crate::engine::state::Underway;
use crate::engine::state::clock::MOST_STEPS;
use crate::engine::transfer::{self, Transfer};
use crate::laws::motion::Progress;
use crate::scene::Boundary;

/// An interval this close to a whole number of time steps (over the time step) counts as that number.
const WHOLE: f64 = 1e-6;

/// How many times as long as the one before a time step may be where the outside moves boundaries. The forces at the end of a step
/// begin the next one: after a communication step that is far shorter than a time step, its dashpots would act for far longer than
/// the motion that they belong to.
const GROWTH: f64 = 2.0;

impl Simulation {
    /// Runs one communication step of `interval` \[s\]: driven axes arrive at its end. One that was left on its way is not gone on
    /// with.
    ///
    /// An error that is found before a step ([`RunError::Runaway`]) leaves the state of the last good time step, at
    /// [`Simulation::time`]. An error that a step itself causes leaves the state after that step, which serves to find
    /// the cause only: to be able to go on, keep a copy of the state.
    pub fn advance(&mut self, interval: f64) -> Result<(), RunError> {
        self.state.underway = None;
        self.advance_part(interval, u64::MAX).map(drop)
    }

    /// The same in parts of at most so many time steps: goes on with the communication step that is under way, or begins one of
    /// `interval` \[s\]. Returns whether its end is reached. Parts, and saving the state between them, change no bit.
    pub fn advance_part(&mut self, interval: f64, most: u64) -> Result<bool, RunError> {
        let (elapsed, result) = self.with_helpers(|it, threads| it.run((interval, most), threads))?;
        if self.state.underway.is_some() {
            return Ok(false);
        }
        course::end(&mut self.state, elapsed);
        nodes::end(&mut self.state, elapsed);
        transfer::end(self.state.heat.as_mut(), elapsed);
        fluid::end(self.state.fluid.as_mut(), elapsed);
        transfer::tell(&self.scene, &mut self.state);
        if let Some(cell) = &self.cell {
            cell.end(&mut self.state, elapsed);
        }
        if let Some(flow) = &self.flow {
            flow.end(&mut self.state, elapsed);
        }
        result.map(|()| true).map_err(|error| self.named(error))
    }

    /// Refuses inputs that move a boundary where nothing moves.
    fn check_frozen(&self) -> Result<(), RunError> {
        if !self.scene.heat.frozen {
            return Ok(());
        }
        for (boundary, moved) in self.scene.boundaries.iter().zip(&self.state.boundaries) {
            let stands = |axis: usize| if axis < 3 { moved.displacement[axis] } else { moved.rotation[axis - 3] };
            let moves = |axis: &usize| moved.target[*axis] != stands(*axis) || moved.target_rate[*axis] != 0.0;
            if let Some(axis) = (0..6).filter(|&axis| boundary.axes[axis].is_driven()).find(moves) {
                let (boundary, value) = (boundary.name.clone(), moved.target[axis]);
                return Err(RunError::Frozen { boundary, value, time: self.time() });
            }
        }
        for nodes in &self.state.nodes {
            let stand = nodes.target.iter().zip(&nodes.displacement).zip(&nodes.target_rate);
            let mut moved = stand.flat_map(|((target, now), rate)| {
                (0..3).filter(|&axis| target[axis] != now[axis] || rate[axis] != 0.0).map(|axis| target[axis])
            });
            if let Some(value) = moved.next() {
                let boundary = self.scene.boundaries[nodes.boundary as usize].name.clone();
                return Err(RunError::Frozen { boundary, value, time: self.time() });
            }
        }
        Ok(())
    }

    /// Begins a communication step: what the outside gave is taken.
    fn begin_interval(&mut self, interval: f64) -> Result<(), RunError> {
        self.check_frozen()?;
        self.transfer.iter_mut().for_each(Transfer::forget);
        course::begin(&self.scene, &mut self.state, interval)?;
        nodes::begin(&self.scene, &mut self.state, interval);
        transfer::begin(self.state.heat.as_mut(), interval);
        fluid::begin(self.state.fluid.as_mut(), interval);
        if let Some(cell) = &self.cell {
            cell.begin(&mut self.state, interval)?;
        }
        self.state.breaks.clear();
        if let Some(traces) = &mut self.state.traces {
            traces.impacts.clear();
        }
        if let Some(flow) = &self.flow {
            flow.begin(&mut self.state, interval);
        }
        Ok(())
    }

    /// Makes the time steps of a communication step, or as many as are asked for, and looks at where it led. Returns how much of its
    /// time has passed \[s\], and why it ended early; an error where it does not begin.
    fn run(
        &mut self,
        (interval, most): (f64, u64),
        threads: Option<&Threads>,
    ) -> Result<(f64, Result<(), RunError>), RunError> {
        let all = Context { threads, ..self.standing() };
        let standing = self.worth_while(&all);
        let mut underway = match self.state.underway.take() {
            Some(underway) => underway,
            None => {
                if !interval.is_finite() || interval <= 0.0 {
                    return Err(RunError::Interval { interval });
                }
                let chosen = self.choose_step(interval, &standing);
                self.begin_interval(interval)?;
                match chosen.and_then(|()| self.divided(interval, &standing)) {
                    Ok(underway) => underway,
                    Err(error) => return Ok((0.0, Err(error))),
                }
            }
        };
        let result = self.make_steps(&mut underway, most, &all);
        if result.is_ok() && underway.done < underway.count {
            self.state.underway = Some(underway);
            return Ok((underway.elapsed(), Ok(())));
        }
        fluid::renew(self.medium.as_ref(), &self.scene, &mut self.state, &standing);
        let looks = || {
            self.check_domain().and_then(|()| self.check_plane()).and_then(|()| self.check_books())?;
            self.check_temperatures()
        };
        Ok((underway.elapsed(), result.and_then(|()| looks())))
    }

    /// Chooses an automatic time step for a communication step, by the state alone: before what the outside gives is taken. So a
    /// communication step that is made again with other inputs is divided alike, whatever was tried in between.
    fn choose_step(&mut self, interval: f64, standing: &Context) -> Result<(), RunError> {
        if !self.scene.run.step.is_automatic() {
            return Ok(());
        }
        let boundary_speed = self.boundary_speed();
        let (_, step) = divide(interval, self.state.clock.step);
        self.look_at_contacts(boundary_speed, standing);
        if self.is_due(boundary_speed, step) {
            self.look(step, &Context { step, ..*standing })?;
        }
        self.shorten_step();
        self.lengthen_step(interval);
        Ok(())
    }

    /// Divides a communication step into as many time steps as fit when it begins. What the outside gave makes these shorter where they
    /// would be a good deal too long.
    fn divided(&mut self, interval: f64, standing: &Context) -> Result<Underway, RunError> {
        let boundary_speed = self.boundary_speed();
        let (_, step) = divide(interval, self.state.clock.step);
        let seen = self.look_at_contacts(boundary_speed, standing);
        if self.is_due(boundary_speed, step) {
            self.look(step, &Context { step, ..*standing })?;
        }
        self.join_given();
        self.shorten_on_the_way(seen != Seen::Nothing);
        let (step, time) = (self.state.clock.step, self.time());
        if interval < step / MOST_STEPS {
            return Err(RunError::TooShort { interval, step, time });
        }
        let (count, step) = self.divide(interval, step)?;
        let (begun, length) = (self.state.clock.steps, count as f64 * step);
        Ok(Underway { begun, done: 0, count, step, passed: 0.0, length, boundary_speed })
    }

    /// Divides an interval \[s\] by this time step, unless nobody can mean so many.
    fn divide(&self, interval: f64, step: f64) -> Result<(u64, f64), RunError> {
        let time = self.time();
        let count = interval / step;
        if count > MOST_STEPS {
            return Err(RunError::TooManySteps { step, count, interval, time });
        }
        Ok(divide(interval, step))
    }

    /// Divides what is left of a communication step by this time step.
    fn divide_rest(&mut self, underway: &mut Underway, step: f64) -> Result<(), RunError> {
        let (elapsed, length) = (underway.elapsed(), underway.length);
        let (count, step) = self.divide(length - elapsed, step)?;
        *underway = Underway { done: 0, count, step, passed: elapsed / length, ..*underway };
        Ok(())
    }

    /// The time step by which what is left is to be divided anew, since the one before was far shorter than time steps are, or heat
    /// alone asks for another; none where neither is so.
    fn growing(&self, underway: &Underway) -> Option<f64> {
        if self.scene.heat.frozen {
            let left = underway.count - underway.done;
            let is_other =
                |stride: &f64| underway.step > (1.0 + WHOLE) * stride || (left > 1 && 2.0 * underway.step <= *stride);
            return self.stride().filter(is_other);
        }
        let (last, whole) = (self.state.clock.last_step, self.state.clock.step);
        if last <= 0.0 || !self.scene.boundaries.iter().any(Boundary::is_led) {
            return None;
        }
        let left = underway.count - underway.done;
        let most = GROWTH * last.max(left as f64 * underway.step / MOST_STEPS);
        let longest = whole.min(most);
        let is_other = underway.step > (1.0 + WHOLE) * most || (left > 1 && GROWTH * underway.step <= longest);
        is_other.then_some(longest)
    }

    /// Makes the time steps that are left, but no more than `most`; where the stable one becomes shorter on the way, or what is in contact
    /// asks for others, the rest is divided again.
    fn make_steps(&mut self, underway: &mut Underway, most: u64, all: &Context) -> Result<(), RunError> {
        let mut left = most;
        while underway.done < underway.count && left > 0 {
            let standing = &self.worth_while(all);
            let step = underway.step;
            if self.outruns(step) && self.shorten_on_the_way(true) {
                self.divide_rest(underway, self.state.clock.step)?;
                continue;
            }
            if let Some(longer) = self.growing(underway) {
                self.divide_rest(underway, longer)?;
                continue;
            }
            self.check_displacement(step)?;
            if self.is_stopped() {
                return Err(RunError::Stopped { time: self.time() });
            }
            left -= 1;
            underway.done += 1;
            let Underway { done, count, passed, length, .. } = *underway;
            let context = Context { step, ..*standing };
            self.count_divided();
            self.step(Progress { done, count, step, time: 0.0, passed, length }, &context)?;
            if self.boundaries_change_speed() {
                underway.boundary_speed = self.boundary_speed();
            }
            let seen = self.look_at_contacts(underway.boundary_speed, standing);
            let is_due = self.is_due(underway.boundary_speed, step) || (seen == Seen::Everything && self.is_calmer());
            if is_due {
                self.check_plane()?;
                self.look(step, &context)?;
            }
            if is_due || seen != Seen::Nothing {
                self.follow(seen, underway)?;
            }
        }
        Ok(())
    }

    /// Chooses another time step for what is left of a communication step, if what was found asks for it.
    fn follow(&mut self, seen: Seen, underway: &mut Underway) -> Result<(), RunError> {
        let is_left = underway.done < underway.count;
        if !is_left {
            // The next communication step chooses its own.
            return Ok(());
        }
        let is_long = self.state.clock.steps >= underway.begun + BETWEEN_LOOKS;
        let changes = self.shorten_on_the_way(is_long || seen != Seen::Nothing)
            || (seen == Seen::Everything && self.lengthen_on_the_way());
        if changes { self.divide_rest(underway, self.state.clock.step) } else { Ok(()) }
    }
}

/// Divides an interval into equal time steps: of exactly `step`, where a whole number of them fits, otherwise shorter.
pub fn divide(interval: f64, step: f64) -> (u64, f64) {
    let ratio = interval / step;
    let whole = ratio.round();
    if whole >= 1.0 && (ratio - whole).abs() <= WHOLE {
        return (whole as u64, step);
    }
    let count = ratio.ceil().max(1.0);
    (count as u64, interval / count)
}
