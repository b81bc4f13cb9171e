//! The acceleration of the fluid in time, where it carries added mass.
//!
//! Loads are found at the end of a time step, with the acceleration in that step. The half kick that begins the next step is one with
//! another acceleration where that changes: at communication points, or from step to step. What it lacks is given beside it, so in each
//! half kick acts the acceleration of its own step. With the change q of the fluid's velocity that the half kick lacks, on a mass m
//!
//! ```text
//! (m + m_a + ½ Δt β) Δ = (ρ V + m_a + ½ Δt β) q
//! ```
//!
//! A sphere of the density of the fluid that follows it thus goes on following it exactly.

use super::half_kick::Exchanged;
use super::sums::Given;
use super::{Medium, Stream, volume};
use crate::base::lanes::Shared;
use crate::base::number::{Vector, add};
use crate::base::threads::Context;
use crate::engine::bodies::loads::came_to;
use crate::engine::integration::kick;
use crate::engine::state::{FluidState, Row, State};
use crate::laws::motion::Progress;
use crate::laws::region::Weights;
use crate::scene::Scene;
use std::ops::Range;

/// Finds how fast the velocity changes in the time step that begins \[m/s²\], and by how much more than in the step before.
fn change(scene: &Scene, fluid: &mut FluidState, progress: &Progress, changes: &mut Vec<Row>) {
    changes.clear();
    let Some(keys) = &scene.fluid else { return };
    let goes_to = keys.velocity.at(progress.time);
    let FluidState { velocity, acceleration, .. } = fluid;
    for (cell, rate) in acceleration.iter_mut().enumerate() {
        let (from, to, length) = match goes_to {
            Some([x, y, z]) => (velocity.now[cell], [x, y, z, 0.0], progress.step),
            None => (velocity.start[cell], velocity.end[cell], progress.length),
        };
        let next = [0, 1, 2].map(|axis: usize| (to[axis] - from[axis]) / length);
        changes.push([next[0] - rate[0], next[1] - rate[1], next[2] - rate[2], 0.0]);
        rate[..3].copy_from_slice(&next);
    }
}

/// Gives the half kick that begins a time step what it lacks of the acceleration of the fluid in this step.
pub(crate) fn accelerate(
    medium: &mut Medium,
    scene: &Scene,
    state: &mut State,
    progress: &Progress,
    context: &Context,
) {
    let Some(mut fluid) = state.fluid.take() else { return };
    let mut changes = std::mem::take(&mut medium.changes);
    change(scene, &mut fluid, progress, &mut changes);
    if changes.iter().flatten().any(|part| *part != 0.0) {
        let half = 0.5 * context.step;
        let sum = give(medium, (&mut fluid, state), &changes, half, context);
        super::book::enter(&mut fluid, state, sum.booked());
        hold(&Stream::of(medium, &fluid), scene, state, &changes);
    }
    medium.changes = changes;
    state.fluid = Some(fluid);
}

/// Gives all bodies what they lack in a half kick of this length \[s\].
fn give(
    medium: &mut Medium,
    (fluid, state): (&mut FluidState, &mut State),
    changes: &[Row],
    half: f64,
    context: &Context,
) -> Exchanged {
    // What is written is lent out meanwhile.
    let mut sums = std::mem::take(&mut medium.sums);
    let [mut velocities, mut of_clumps] =
        [&mut state.particles.velocity, &mut state.clumps.velocity].map(std::mem::take);
    let (stream, rows) = (Stream::of(medium, fluid), fluid.exchanged.len());
    let (cell, each) = (medium.grid.map_or(1.0, |grid| grid.cell_volume()), fluid.rows());
    let lacking = Lacking {
        stream,
        medium,
        changes,
        half,
        velocity: Shared::new(&mut velocities),
        of_clumps: Shared::new(&mut of_clumps),
    };
    let now = &*state;
    let of_some = |some: Range<usize>, given: &mut Given| {
        some.filter_map(|body| lacking.give(now, body)).fold(Exchanged::default(), |sum, (weights, one)| {
            match each {
                1 => given.share(&weights, [one.on_fluid(cell)[0]]),
                _ => given.share(&weights, one.on_fluid(cell)),
            }
            sum.plus(one)
        })
    };
    let count = velocities.len() + of_clumps.len();
    let sum = sums.over((count, rows), context, of_some, (Exchanged::default(), Exchanged::plus));
    fluid.exchanged.iter_mut().zip(sums.whole()).for_each(|(cell, row)| add(cell, row));
    medium.sums = sums;
    (state.particles.velocity, state.clumps.velocity) = (velocities, of_clumps);
    sum
}

/// Gives groups that stay what their loads lack.
fn hold(stream: &Stream, scene: &Scene, state: &mut State, changes: &[Row]) {
    let State { boundaries, particles, cell, .. } = state;
    for (boundary, moved) in scene.boundaries.iter().zip(boundaries) {
        for &member in boundary.shape.members() {
            let place = particles.position[particles.slot[member as usize] as usize];
            let Some((_, weights)) = stream.at(place.into()) else { continue };
            let density = stream.medium.added_mass + stream.medium.inertial;
            let lacks = Vector::from(super::stream::between(changes, &weights)) * (density * volume(2.0 * place[3]));
            let arm = came_to(cell.as_ref(), member, place.into()) - moved.pivot.into();
            moved.force = (Vector::from(moved.force) + lacks).to_array();
            moved.moment = (Vector::from(moved.moment) + arm.cross(lacks)).to_array();
        }
    }
}

/// What bodies lack of the acceleration of the fluid, and where it is given.
struct Lacking<'a> {
    /// How the fluid flows.
    stream: Stream<'a>,
    /// What never changes of it.
    medium: &'a Medium,
    /// By how much more its velocity changes at each place than in the step before \[m/s²\].
    changes: &'a [Row],
    /// Length of the half kick \[s\].
    half: f64,
    /// Velocities of particles.
    velocity: Shared<Row>,
    /// Velocities of clumps.
    of_clumps: Shared<Row>,
}

impl Lacking<'_> {
    /// Gives it to a body: particles and, counted on behind these, clumps. Returns what the fluid exchanges, and where.
    fn give(&self, state: &State, body: usize) -> Option<(Weights, Exchanged)> {
        let (particles, clumps) = (&state.particles, &state.clumps);
        let Some(clump) = body.checked_sub(particles.owner.len()) else {
            // Images and spheres of clumps are counted on behind the boundaries.
            let owner = particles.owner[body] as usize;
            if owner > state.boundaries.len() {
                return None;
            }
            let place = particles.position[body];
            // SAFETY: each body has a row of its own, and is worked on by one thread.
            let velocity = unsafe { self.velocity.at(body) };
            return self.to((place, 2.0 * place[3]), (velocity, &particles.force[body]), owner == 0);
        };
        // SAFETY: as above.
        let velocity = unsafe { self.of_clumps.at(clump) };
        let diameter = self.stream.diameter(clumps, clump);
        self.to((clumps.position[clump], diameter), (velocity, &clumps.force[clump]), true)
    }

    /// Gives it to a sphere that moves so by this load; one that is held stays.
    fn to(
        &self,
        (place, diameter): (Row, f64),
        (velocity, force): (&mut Row, &Row),
        is_free: bool,
    ) -> Option<(Weights, Exchanged)> {
        let (here, weights) = self.stream.at(place.into())?;
        let (sphere, lacks) = (volume(diameter), Vector::from(super::stream::between(self.changes, &weights)));
        let [added, pushed] = [self.medium.added_mass, self.medium.inertial].map(|density| density * sphere);
        if !is_free {
            return Some((weights, Exchanged::of_held(lacks * (added * self.half))));
        }
        let (mass, before) = (velocity[3], Vector::from(*velocity));
        let dashpot = self.half * force[3] * ((mass + added) / mass);
        let lacks = lacks * self.half;
        let gained = lacks * ((pushed + added + dashpot) / (mass + added + dashpot));
        // The half kick itself adds to the velocity, whatever that is.
        let mean = before + Vector::from(*force) * kick(velocity, force, self.half) + gained * 0.5;
        *velocity = (before + gained).row_with(mass);
        let (drag, all) = ((lacks - gained) * dashpot, gained * mass);
        let exchanged = Exchanged::of_free((drag, (lacks - gained) * added), all, [here.velocity, mean]);
        Some((weights, exchanged.with_way(gained * (self.half * sphere))))
    }
}
