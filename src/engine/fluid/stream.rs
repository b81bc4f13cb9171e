//! The fluid as it flows now, and what it does to a sphere at a point.

use super::{Flow, Medium, volume};
use crate::base::number::Vector;
use crate::engine::state::{Clumps, FluidState, Row, State};
use crate::laws::region::{Centres, Weights};

/// The weights of the only cell, where there is no grid.
const ALONE: Weights = [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0), (0, 0.0), (0, 0.0), (0, 0.0), (0, 0.0)];

/// A fluid as it flows now.
#[derive(Clone, Copy)]
pub(crate) struct Stream<'a> {
    /// What never changes.
    pub(super) medium: &'a Medium,
    /// How it flows in the first cell: everywhere, without a grid.
    first: Here<'a>,
    /// The centres of the cells of its grid, the velocity in each \[m/s\] with the porosity behind it, and the gradient of the pressure there \[Pa/m\], if one
    /// is given.
    pub(super) cells: Option<(Centres, &'a [Row], &'a [Row])>,
    /// How fast the velocity in each cell changed in the last time step \[m/s²\]; empty without added mass.
    pub(super) accelerations: &'a [Row],
    /// Lift on each particle and clump \[N\]; empty where nothing lifts.
    pub(super) lifts: &'a [Row],
    /// The temperature in each cell \[K\], along x; empty where no heat flows into it.
    temperatures: &'a [Row],
}

/// A fluid as it flows at a point.
#[derive(Clone, Copy)]
pub(crate) struct Here<'a> {
    /// What never changes.
    pub(super) medium: &'a Medium,
    /// Its velocity \[m/s\].
    pub(super) velocity: Vector,
    /// Part of the space that the particles leave to it.
    pub(super) porosity: f64,
    /// Force of the pressure gradient on each volume \[N/m³\].
    pub(super) push: Vector,
}

/// The sum of rows by their weights.
#[inline(always)]
pub(super) fn between(rows: &[Row], weights: &Weights) -> Row {
    let mut sum = [0.0; 4];
    for &(cell, weight) in weights {
        let row = &rows[cell];
        for (sum, part) in sum.iter_mut().zip(row) {
            *sum += weight * part;
        }
    }
    sum
}

impl<'a> Stream<'a> {
    /// That of a fluid in a state.
    pub(crate) fn of(medium: &'a Medium, fluid: &'a FluidState) -> Self {
        let (flow, gradients) = (&fluid.velocity.now[..], &fluid.pressure_gradient.now[..]);
        let [x, y, z, porosity] = flow[0];
        let gradient = gradients.first().map_or(Vector::zero(), |row| Vector::from(*row));
        let (velocity, push) = (Vector::new(x, y, z), medium.buoyancy - gradient);
        let first = Here { medium, velocity, porosity, push };
        let cells = medium.grid.map(|grid| (grid.centres(), flow, gradients));
        let FluidState { acceleration, lift, temperature, .. } = fluid;
        Self { medium, first, cells, accelerations: acceleration, lifts: lift, temperatures: &temperature.now }
    }

    /// How it flows at a point \[m\], and of which cells that is by which weights; none where there is no fluid.
    #[inline(always)]
    pub(crate) fn at(&self, point: Vector) -> Option<(Here<'a>, Weights)> {
        let Some((centres, flow, gradients)) = &self.cells else { return Some((self.first, ALONE)) };
        if !centres.holds(point) {
            return None;
        }
        let weights = centres.weights(point);
        let [x, y, z, porosity] = between(flow, &weights);
        let mut push = self.medium.buoyancy;
        if !gradients.is_empty() {
            push = push - Vector::from(between(gradients, &weights));
        }
        // Weights add up to 1 but for rounding, and drag laws take roots of the solid fraction.
        let porosity = porosity.min(1.0);
        Some((Here { medium: self.medium, velocity: Vector::new(x, y, z), porosity, push }, weights))
    }

    /// Its temperature in cells of these weights \[K\].
    pub(super) fn temperature(&self, weights: &Weights) -> f64 {
        between(self.temperatures, weights)[0]
    }

    /// Lift on a particle or, counted on behind these, on a clump, as present loads hold it \[N\].
    pub(super) fn lift(&self, body: usize) -> Vector {
        self.lifts.get(body).map_or(Vector::zero(), |row| Vector::from(*row))
    }

    /// Whether it brakes rotation.
    pub(super) fn has_torque(&self) -> bool {
        self.medium.torque
    }

    /// Diameter of the sphere of the volume of a clump \[m\].
    pub(crate) fn diameter(&self, clumps: &Clumps, clump: usize) -> f64 {
        self.medium.diameter(clumps, clump)
    }

    /// The largest acceleration that it gives to what forces move in a state \[m/s²\].
    pub(crate) fn acceleration(&self, state: &State) -> f64 {
        let State { particles, clumps, .. } = state;
        let of = |body: usize, place: Row, velocity: Row, drag: f64, diameter: f64| {
            let Some((here, weights)) = self.at(place.into()) else { return 0.0 };
            let drag = (here.velocity - Vector::from(velocity)) * drag;
            let push = if self.acts_beside() {
                let around = self.around(place.into(), here.velocity, &weights);
                let beside = self.beside(&around, diameter, (velocity[3], true), self.lift(body));
                here.with(&around, &beside, diameter).push(diameter) * beside.share
            } else {
                here.push(diameter)
            };
            (drag.length() + push.length()) / velocity[3]
        };
        let free = (0..particles.len()).filter(|&slot| particles.owner[slot] == 0);
        let of_particles = free.map(|slot| {
            let place = particles.position[slot];
            of(slot, place, particles.velocity[slot], particles.force[slot][3], 2.0 * place[3])
        });
        let of_clumps = (0..clumps.len()).map(|it| {
            let (body, diameter) = (particles.len() + it, self.medium.diameter(clumps, it));
            of(body, clumps.position[it], clumps.velocity[it], clumps.force[it][3], diameter)
        });
        of_particles.chain(of_clumps).fold(0.0, f64::max)
    }
}

impl Here<'_> {
    /// Force of the pressure gradient on a sphere \[N\].
    #[inline(always)]
    pub(super) fn push(&self, diameter: f64) -> Vector {
        self.push * volume(diameter)
    }

    /// Conductance between it and a sphere of this diameter \[m\] with this velocity \[m/s\] \[W/K\].
    #[inline(always)]
    pub(super) fn conductance(&self, diameter: f64, velocity: Vector) -> f64 {
        self.medium.conductance(diameter, self.porosity, self.velocity - velocity)
    }

    /// What it does to a sphere of this diameter \[m\] with this velocity \[m/s\] and angular velocity \[rad/s\], on which another force acts
    /// \[N\]; forces move its mass \[kg\] in half kicks of this length \[s\], or it is held where the length is 0.
    pub(crate) fn on(&self, diameter: f64, motion: [Vector; 2], (mass, other): (f64, Vector), half: f64) -> Flow {
        let (medium, push) = (self.medium, self.push(diameter));
        let slip = self.velocity - motion[0];
        let drag_of = |slip| {
            let factor = medium.law.factor(self.porosity, medium.reynolds(diameter, self.porosity, slip));
            medium.drag(diameter, self.porosity, factor)
        };
        let drag = drag_of(slip - gain(slip, drag_of(slip), (mass, other + push), half));
        let turning = medium.turning(diameter);
        Flow { force: slip * drag + push, drag, torque: motion[1] * -turning, turning }
    }
}

/// What a half kick of this length \[s\] gives to the velocity \[m/s\] of a mass \[kg\] on which a force acts \[N\] beside drag; the half kick of
/// what is held has the length 0.
#[inline(always)]
pub(super) fn gain(slip: Vector, drag: f64, (mass, other): (f64, Vector), half: f64) -> Vector {
    (other + slip * drag) * (half / (mass + half * drag))
}
