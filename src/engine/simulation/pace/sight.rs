//! How far speeds, contacts and bonds may change until the stable time step is computed again.

use crate::engine::bodies::RigidBody;
use crate::engine::boundaries::course;
use crate::engine::contacts::{FASTER, SearchLimits};
use crate::engine::simulation::Simulation;
use crate::engine::stability;
use crate::engine::state::Row;
use crate::laws::bond::creation::Window;

/// Time steps for which bonds to come and the slow motion of a bed are foreseen, about.
const STEPS_BETWEEN_LOOKS: f64 = 1500.0;

/// Time steps in which a dense flow uses up the way that was foreseen, about. A look takes as long as fifty to ninety steps. In a flow
/// all near pairs count as contacts to come, up to the closing energy of each, so a longer way changes hardly more than the number
/// of looks. It would where impacts of bodies that are in no list limit the step: there the flow is not dense.
const STEPS_OF_DENSE_FLOW: f64 = 6000.0;

/// Time steps in which free fall may use up the speed that was foreseen.
const STEPS_OF_FALL: f64 = 50.0;

/// Time steps that anything may have made from rest, by the load from outside alone, before what came of it is seen.
const STEPS_OF_START: f64 = 2.0;

/// Way of both bodies that is always foreseen, over the mean overlap of the contacts.
const CERTAIN: f64 = 0.005;

/// The least of it over the smallest radius: with contacts that hardly touch, and without contacts.
const LEAST: [f64; 2] = [2e-6, 2e-3];

/// By how much a cell that is deformed brings neighbours nearer until the next look at most: over the mean overlap, and over the
/// smallest radius.
const STRAINED: [f64; 2] = [0.25, 5e-3];

/// How far is to be foreseen.
#[derive(Clone, Copy)]
pub(in crate::engine::simulation) struct Horizon {
    /// How much faster than now anything may become.
    pub(in crate::engine::simulation) faster: f64,
    /// Whether time steps are far below the stable one: then a bound that is a little lower costs nothing.
    pub(in crate::engine::simulation) is_far: bool,
}

impl Horizon {
    /// No further than it has to be.
    pub(in crate::engine::simulation) const NEAR: Self = Self { faster: FASTER, is_far: false };
}

/// What is foreseen.
pub(in crate::engine::simulation) struct LookAhead {
    /// How far.
    pub(in crate::engine::simulation) ahead: SearchLimits,
    /// Half of the speed at which bodies may meet \[m/s\].
    pub(in crate::engine::simulation) speed: f64,
    /// The largest speed of anything \[m/s\].
    pub(in crate::engine::simulation) fastest: f64,
    /// Whether nothing moves, and no load is about to move anything.
    pub(in crate::engine::simulation) rests: bool,
    /// By how much a cell that is deformed may bring neighbours nearer until the next look \[m\].
    pub(in crate::engine::simulation) strained: f64,
    /// Whether it is a dense flow: impacts of bodies that are in no list do not limit the time step. Never where that is near the
    /// stable one.
    pub(in crate::engine::simulation) is_dense: bool,
}

impl LookAhead {
    /// The way of the fastest and what comes towards it until the next look, at time steps of this length \[s\] \[m\].
    pub(in crate::engine::simulation) fn way(&self, step: f64) -> f64 {
        way(self.is_dense, self.fastest, step)
    }
}

/// The way towards each other of bodies this fast \[m/s\] until the next look, at time steps of this length \[s\] \[m\].
fn way(is_dense: bool, fastest: f64, step: f64) -> f64 {
    let steps = if is_dense { STEPS_OF_DENSE_FLOW } else { STEPS_BETWEEN_LOOKS };
    2.0 * fastest * steps * step
}

impl Simulation {
    /// What is to be foreseen at time steps of about this length \[s\], so far, where the network had this root at the last look \[1/s\]
    /// (0 if there was none).
    pub(in crate::engine::simulation) fn sight(
        &self,
        step: f64,
        Horizon { faster, is_far }: Horizon,
        root: f64,
    ) -> LookAhead {
        let fastest = self.system().fastest();
        let boundaries = course::speeds(&self.scene, &self.bodies, &self.state, step).collect::<Vec<_>>();
        let streaming = self.cell.as_ref().map_or(0.0, |cell| cell.speed(&self.state));
        let driven = boundaries.iter().copied().fold(streaming, f64::max);
        let answer = self.acceleration();
        let acceleration = self.acceleration_of_fields();
        let least = self.search.smallest_radius().min(f64::MAX);
        let mean = self.mean_overlap();
        // Strain comes whatever the bodies do.
        let most = (STRAINED[0] * mean.unwrap_or(0.0)).max(STRAINED[1] * least);
        let strained = (streaming * STEPS_BETWEEN_LOOKS * step).min(most);
        let margin = match mean {
            Some(mean) => (CERTAIN * mean).max(LEAST[0] * least),
            None => LEAST[1] * least,
        };
        let rest = if step > 0.0 { 0.5 * margin / (STEPS_BETWEEN_LOOKS * step) } else { 0.0 };
        let falling = fastest + acceleration * STEPS_OF_FALL * step;
        let speed = stability::foreseen_speed(fastest, driven, faster).max(rest).max(falling);
        let is_dense = is_far && self.system().impact(speed, acceleration).is_none_or(|impacts| impacts <= root);
        let fastest = fastest.max(driven);
        // A load from outside may make contacts, as far as nothing holds against it.
        let from_outside = self.acceleration_of_bodies().fold(acceleration, f64::max).min(answer);
        let begun = STEPS_OF_START * STEPS_OF_START * from_outside * step * step;
        let way = margin.max(way(false, fastest * faster / FASTER, step)).max(way(is_dense, fastest, step)).max(begun);
        let margin = margin + strained;
        let clock = &self.state.clock;
        let window = Window {
            after: clock.steps,
            until: clock.steps + STEPS_BETWEEN_LOOKS as u64,
            from: clock.time,
            to: clock.time + STEPS_BETWEEN_LOOKS * step,
        };
        let window = (!self.scene.bonds.is_empty()).then_some(window);
        let moved = self.bodies.iter().map(|body| body.as_ref().is_some_and(RigidBody::is_free)).collect();
        let loads = self.bodies.iter().zip(&self.state.boundaries).map(|(body, moved)| {
            let body = body.as_ref().filter(|body| body.is_free());
            body.map_or(0.0, |body| body.mass * body.acceleration(moved, body.farthest))
        });
        let loads = loads.collect();
        let ahead = SearchLimits { margin, way, acceleration, faster, boundaries, loads, moved, streaming, window };
        let rests = fastest == 0.0 && answer == 0.0;
        LookAhead { ahead, speed, fastest, rests, strained, is_dense }
    }

    /// The largest acceleration that anything has by its present load \[m/s²\].
    fn acceleration(&self) -> f64 {
        let particles = &self.state.particles;
        let square = |(force, velocity): (&Row, &Row)| {
            (force[0] * force[0] + force[1] * force[1] + force[2] * force[2]) / (velocity[3] * velocity[3])
        };
        let rows = particles.force.iter().zip(&particles.velocity).zip(&particles.owner);
        let free = rows.filter(|(_, owner)| **owner == 0).map(|(rows, _)| square(rows));
        let clumps = self.state.clumps.force.iter().zip(&self.state.clumps.velocity).map(square);
        self.acceleration_of_bodies().fold(free.chain(clumps).fold(0.0, f64::max).sqrt(), f64::max)
    }

    /// The acceleration of each boundary that forces move \[m/s²\].
    fn acceleration_of_bodies(&self) -> impl Iterator<Item = f64> + '_ {
        self.bodies.iter().zip(&self.state.boundaries).filter_map(|(body, moved)| {
            let body = body.as_ref().filter(|body| body.is_free())?;
            Some(body.acceleration(moved, body.farthest))
        })
    }
}
