//! What stops a run before its numbers become meaningless, and the messages for it.

use super::{RunError, Simulation};
use crate::base::number::Vector;
use crate::engine::bodies;
use crate::engine::boundaries::passing::MovedParticles;
use crate::engine::integration::kick;
use crate::engine::run_error::Cause;
use crate::engine::state::heat::BoundaryHeat;
use crate::engine::state::{Clock, GONE, Particles};
use crate::laws::motion::InputCourse;
use crate::laws::surface;
use crate::scene::{Outside, Scene};

/// Way of a particle in one time step, over its radius, that counts as an error instead of motion.
const RUNAWAY: f64 = 0.5;

/// Cohesion energy density over effective modulus from which contacts collapse.
pub(crate) const COLLAPSING_COHESION: f64 = 0.07;

/// Energy out of nothing, over all that was turned over, that no law and no time step below the stable one makes.
const LARGEST_GAIN: f64 = 0.25;

/// The number that a particle carries in outputs, by its index: the scene's, or that with which it came.
pub fn number(scene: &Scene, particles: &Particles, index: u32) -> u32 {
    match scene.particles.get(index as usize) {
        Some(particle) => particle.id.0,
        None => particles.number_of_inserted(index).unwrap_or(index),
    }
}

impl Simulation {
    /// Refuses a step in which a particle would move further than makes sense.
    pub(super) fn check_displacement(&self, step: f64) -> Result<(), RunError> {
        let smallest = self.search.smallest_radius();
        if self.state.clock.speed * step <= RUNAWAY * smallest {
            return Ok(());
        }
        let particles = &self.state.particles;
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == 0) {
            let (velocity, force) = (particles.velocity[slot], particles.force[slot]);
            let gained = kick(&velocity, &force, 0.5 * step);
            let next = |axis: usize| velocity[axis] + gained * force[axis];
            let radius = particles.position[slot][3];
            let way = step * (0..3).map(|axis| next(axis) * next(axis)).sum::<f64>().sqrt();
            if way > RUNAWAY * radius {
                let [speed, force] = [velocity, force].map(|row| Vector::from(row).length());
                let cause = self.cause_of_displacement(step, speed, force, step * speed > 0.5 * way);
                return Err(self.runaway(particles.id[slot], way / radius, cause));
            }
        }
        for body in bodies::each(&self.bodies, &self.state) {
            let way = step * body.speed_after(step);
            if way > RUNAWAY * body.smallest {
                let now = body.speed_after(0.0);
                let cause = self.cause_of_displacement(step, now, body.force().length(), step * now > 0.5 * way);
                let Some(&member) = body.members.first() else {
                    let (boundary, time) = (self.scene.boundaries[body.number].name.clone(), self.time());
                    return Err(RunError::SurfaceRunaway { boundary, way, radii: way / body.smallest, time, cause });
                };
                return Err(self.runaway(member, way / body.smallest, cause));
            }
        }
        Ok(())
    }

    /// A particle that would move further than makes sense.
    fn runaway(&self, id: u32, radii: f64, cause: Cause) -> RunError {
        RunError::Runaway { id, radii, time: self.time(), cause }
    }

    /// Why a body goes far in one step \[s\]: the step itself, its speed \[m/s\] (where it `has` that already) or the force on it \[N\].
    fn cause_of_displacement(&self, step: f64, speed: f64, force: f64, has: bool) -> Cause {
        let stable = self.state.clock.stable;
        self.step_as_cause().unwrap_or(if has { Cause::Speed { speed, step, stable } } else { Cause::Force { force } })
    }

    /// The time step as the cause, where it is above the stable one.
    pub(super) fn step_as_cause(&self) -> Option<Cause> {
        let Clock { last_step, step, stable, .. } = self.state.clock;
        let step = if last_step > 0.0 { last_step } else { step };
        (step > stable).then_some(Cause::Step { step, stable })
    }

    /// The step as the cause, or none that is seen.
    fn step_or_unidentified(&self) -> Cause {
        let Clock { last_step: step, stable, .. } = self.state.clock;
        self.step_as_cause().or_else(|| Some(self.coincident()?.1)).unwrap_or(Cause::Unidentified { step, stable })
    }

    /// Two particles that touch and whose centres coincide, or did at the start where they are no numbers any more: the number
    /// of the first, and what is said of both.
    pub(super) fn coincident(&self) -> Option<(u32, Cause)> {
        let particles = &self.state.particles;
        let centre = |slot: u32| {
            let [x, y, z, _] = *particles.position.get(slot as usize)?;
            let start = || Some(self.scene.particles.get(particles.id[slot as usize] as usize)?.position);
            if (x + y + z).is_finite() { Some([x, y, z]) } else { start() }
        };
        let pairs = self.state.contacts.iter().flat_map(|list| list.first.iter().zip(&list.second));
        let (&i, &j) = pairs.into_iter().find(|&(&i, &j)| centre(i).is_some() && centre(i) == centre(j))?;
        let [first, second] = [i, j].map(|slot| self.number(particles.id[slot as usize]));
        Some((first, Cause::Coincident { first, second }))
    }

    /// Stops where particles are so deep in each other that no law holds, and before energy comes out of nothing.
    pub(super) fn check_contacts(&self) -> Result<(), RunError> {
        if self.scene.run.allow_unstable {
            return Ok(());
        }
        self.check_depth()?;
        self.check_energy()
    }

    /// Stops where a scene that keeps an energy book sees more energy come out of contacts and bonds than went in.
    fn check_energy(&self) -> Result<(), RunError> {
        // A boundary that jumps loads contacts by a way that no force went along. A cell that is deformed streams, and the error of its work
        // is of the size of that energy, which is in no book.
        let jumps = self.scene.boundaries.iter().any(|boundary| boundary.input == InputCourse::Hold);
        let streams = self.scene.cell.as_ref().is_some_and(|cell| cell.moves());
        let found = if jumps || streams { None } else { self.gain_by_losses().or_else(|| self.gain_by_ledger()) };
        match found.filter(|[gained, scale]| *scale > 0.0 && *gained > LARGEST_GAIN * scale) {
            None => Ok(()),
            Some([gained, turnover]) => {
                Err(RunError::EnergyGain { gained, turnover, time: self.time(), cause: self.step_or_unidentified() })
            }
        }
    }

    /// Energy that came out of nothing by the book of forces, and all that was turned over \[J\]. The potential of an attraction is
    /// not in it: scenes with cohesion are not judged.
    fn gain_by_ledger(&self) -> Option<[f64; 2]> {
        let ledger = self.state.ledger.as_ref()?;
        let cohesive = self.scene.contacts.iter().any(|law| law.choice.cohesion.name() != "none");
        let scale = ledger.turnover.max(ledger.initial_kinetic + ledger.initial_elastic);
        (!cohesive && ledger.turnover > 0.0).then_some([-self.dissipated_energy()?, scale])
    }

    /// Finds what is not finite.
    pub(super) fn not_finite(&self) -> RunError {
        let particles = &self.state.particles;
        let finite = |row: &[f64; 4]| row.iter().all(|number| number.is_finite());
        for slot in 0..particles.len() {
            let quantities = [
                ("position", &particles.position[slot]),
                ("force", &particles.force[slot]),
                ("torque", &particles.torque[slot]),
                ("velocity", &particles.velocity[slot]),
                ("angular velocity", &particles.angular_velocity[slot]),
            ];
            if let Some((quantity, _)) = quantities.into_iter().find(|(_, row)| !finite(row)) {
                let (time, cause) = (self.time(), self.step_or_unidentified());
                return RunError::NotFinite { id: particles.id[slot], quantity, time, cause };
            }
        }
        RunError::NotFinite { id: 0, quantity: "speed", time: self.time(), cause: self.step_or_unidentified() }
    }

    /// Refuses energy books with sums that are not finite.
    pub(super) fn check_books(&self) -> Result<(), RunError> {
        if self.state.has_finite_books() {
            return Ok(());
        }
        Err(RunError::Books { time: self.time(), cause: self.step_or_unidentified() })
    }

    /// Finds a body that is colder than any can be: more heat was taken from it than it had.
    pub(super) fn check_temperatures(&self) -> Result<(), RunError> {
        let Some(heat) = &self.state.heat else { return Ok(()) };
        let cold = |temperature: f64| temperature <= 0.0;
        let particle = (0..heat.capacity.len()).find(|&it| heat.capacity[it] > 0.0 && cold(heat.temperature(it)));
        let (body, temperature) = if let Some(index) = particle {
            (format!("particle {}", self.number(index as u32)), heat.temperature(index))
        } else {
            let held = |it: &BoundaryHeat| it.capacity > 0.0 && cold(it.temperature());
            let Some(boundary) = heat.boundaries.iter().position(held) else { return Ok(()) };
            (format!("[boundary.{}]", self.scene.boundaries[boundary].name), heat.boundaries[boundary].temperature())
        };
        Err(RunError::Cold { body, temperature, time: self.time() })
    }

    /// Finds a particle that a group of particles went over in a time step of this length \[s\].
    pub(super) fn check_groups(&self, step: f64) -> Result<(), RunError> {
        let Some((slot, group)) = self.passing.through_groups(&self.state, step) else { return Ok(()) };
        let (id, boundary) = (self.state.particles.id[slot as usize], self.scene.boundaries[group].name.clone());
        Err(RunError::Behind { id, boundary, time: self.time(), cause: Cause::NotSearched })
    }

    /// Finds a particle outside the domain.
    pub(super) fn check_domain(&self) -> Result<(), RunError> {
        let stops = self.scene.outside == Outside::Stop;
        let Some([low, high]) = self.scene.domain.filter(|_| stops) else { return Ok(()) };
        let particles = &self.state.particles;
        for (slot, row) in particles.position.iter().enumerate() {
            if (0..3).any(|axis| row[axis] < low[axis] || row[axis] > high[axis]) {
                let [x, y, z, _] = *row;
                return Err(RunError::Escaped { id: particles.id[slot], time: self.time(), x, y, z });
            }
        }
        Ok(())
    }

    /// Why a particle, by its index, is behind a boundary.
    fn cause_behind(&self, id: u32, name: &str) -> Cause {
        let at = self.scene.boundaries.iter().position(|boundary| boundary.name == name);
        let (Some(at), Some(slot)) = (at, self.state.particles.slot_of(id)) else { return Cause::Load };
        let step = self.state.clock.last_step;
        let particles = MovedParticles::of(&self.state, step);
        let [from, to] = self.passing.way((at, &self.state.boundaries), particles, slot);
        let (way, radius) = ((to - from).length(), particles.position[slot][3]);
        if way > RUNAWAY * radius {
            return Cause::Meeting { speed: way / step, step };
        }
        if let Some(cause) = self.step_as_cause() {
            return cause;
        }
        let closing = match self.scene.boundaries[at].shape.plane() {
            Some(surface::Plane { normal, .. }) => (from - to).dot(normal.into()),
            None => way,
        };
        self.impact_or_load(closing / step, radius)
    }

    /// The number of a particle by its index; of none, that of the next to come.
    pub fn number(&self, index: u32) -> u32 {
        let next = self.state.exchange.as_ref().filter(|_| index == GONE).map(|exchange| exchange.next);
        next.unwrap_or_else(|| number(&self.scene, &self.state.particles, index))
    }

    /// The error with the particle's number in the scene instead of its index.
    pub(super) fn named(&self, mut error: RunError) -> RunError {
        match &mut error {
            RunError::Runaway { id, .. }
            | RunError::NotFinite { id, .. }
            | RunError::Escaped { id, .. }
            | RunError::LeftPlane { id, .. }
            | RunError::GroupLeaves { id, .. } => {
                *id = self.number(*id);
            }
            RunError::Behind { id, boundary, cause, .. } => {
                *cause = self.cause_behind(*id, boundary);
                *id = self.number(*id);
            }
            RunError::Crushed { first, second, .. } => {
                (*first, *second) = (self.number(*first), self.number(*second));
            }
            RunError::Overbent { first, second, cause, .. } => {
                *cause = self.step_as_cause().unwrap_or(Cause::Unbroken);
                (*first, *second) = (self.number(*first), second.map(|second| self.number(second)));
            }
            RunError::StepTooLong { .. }
            | RunError::EnergyGain { .. }
            | RunError::Books { .. }
            | RunError::CellElsewhere
            | RunError::CellStrain { .. }
            | RunError::CellStep { .. }
            | RunError::CellNarrow { .. }
            | RunError::SurfaceRunaway { .. }
            | RunError::Turn { .. }
            | RunError::Frozen { .. }
            | RunError::Cold { .. }
            | RunError::PutAtPlane { .. }
            | RunError::Invalid { .. }
            | RunError::Stopped { .. }
            | RunError::TooManySteps { .. }
            | RunError::TooShort { .. }
            | RunError::Interval { .. }
            | RunError::GroupElsewhere { .. }
            | RunError::ClumpElsewhere { .. }
            | RunError::Collapsed { .. }
            | RunError::NoNumberLeft { .. }
            | RunError::Memory { .. } => {}
        }
        error
    }
}
