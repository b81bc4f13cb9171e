//! Directional derivatives: the last communication step is made again from where it began, with some inputs displaced, and its end is
//! compared.
//!
//! The engine repeats its bits, so the difference of two steps from the same state holds nothing but what the inputs did. Everything
//! that is made in a time step is in it, and nothing is frozen: contacts may open, close, stick and slide.

use super::{RunError, Simulation};
use crate::base::number::Vector;
use crate::base::quantity::BoundaryIndex;
use crate::engine::bodies::loads::came_to;
use crate::engine::state::contacts::TOUCHING;
use crate::engine::state::fluid::FluidField;
use crate::engine::state::ledger::Source;

/// How far a one-sided difference displaces a body, over the median overlap of the contacts that the input moves. By so much the force
/// of such a contact bends as much as positions lose by rounding: some ten-millionths of the derivative.
const ONE_SIDED: f64 = 1e-6;

/// The same of a central difference, from which the bend falls out. With ten times as much, contacts of a sheared bed begin to slide on
/// one side and not on the other.
const CENTRAL: f64 = 1e-5;

/// How much warmer a difference makes a boundary, over its temperature.
const WARMER: f64 = 1.0 / 1024.0;

/// No body is displaced by less, over the radius of the smallest sphere: positions are rounded.
const LEAST: f64 = 1e-9;

/// An input that changes continuously.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// Of an axis of a boundary, along x, y, z (0 to 2) or about them (3 to 5).
    Axis(BoundaryIndex, usize),
    /// Of a node of a mesh, by its number from 0, along x, y or z.
    Node(BoundaryIndex, usize, usize),
    /// The rate of an insertion.
    Rate(usize),
    /// Of a component of the strain of the periodic cell.
    Strain(usize),
    /// The temperature of a boundary or of one of its nodes, by its number from 0, or the heat flow into a boundary from the outside.
    Heat(BoundaryIndex, Option<usize>),
    /// Of what the fluid is given in a cell of its grid, by its number from 0, along x, y or z.
    Fluid(FluidField, usize, usize),
}

/// Why there is no derivative.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoDerivative {
    /// No communication step to make again.
    #[error(
        "expected a last communication step to make again, found none since the state was set or a parameter changed"
    )]
    NoStep,
    /// The step ends early on both sides.
    #[error(
        "expected a step that can be made with displaced inputs, found one that ends early on either side: {error}; choose a smaller \
         run.derivative_displacement"
    )]
    Fails {
        /// Why it ends early.
        error: String,
    },
}

/// What an input moves.
struct CurrentContact {
    /// Median overlap of the contacts; the radius of the smallest sphere where there are none \[m\].
    overlap: f64,
    /// Radius of the smallest sphere \[m\].
    radius: f64,
    /// From the reference point to what is met or carried furthest from it \[m\].
    arm: f64,
}

/// By how much the inputs were displaced along their direction, and what was read at the end of the step.
type Side = (f64, Vec<f64>);

impl Simulation {
    /// By how much what is read changes at the end of the last communication step for each unit by which inputs change along a
    /// direction at that end: a share of each. One step is made again, or two where `[run] central_derivatives` asks for them; where
    /// one ends early, the other side serves. The state stays as it is, to the bit.
    pub fn differences(
        &mut self,
        direction: &[(Input, f64)],
        read: &mut dyn FnMut(&Self) -> Vec<f64>,
    ) -> Result<Vec<f64>, NoDerivative> {
        let here = read(self);
        let Some(length) = self.rollback.last_length() else { return Err(NoDerivative::NoStep) };
        let displacements: Vec<f64> = direction.iter().map(|(input, _)| self.displacement(*input, length)).collect();
        let shares = direction.iter().zip(&displacements).filter(|((_, share), _)| *share != 0.0);
        let change = shares.map(|((_, share), most)| most / share.abs()).fold(f64::INFINITY, f64::min);
        if change == f64::INFINITY {
            return Ok(vec![0.0; here.len()]);
        }
        let central = self.scene.run.central_derivatives;
        let ahead = self.displaced((direction, &displacements), change, read);
        let both = central || ahead.is_err();
        let behind = both.then(|| self.displaced((direction, &displacements), -change, read));
        let [(to, there), (from, back)] = match (ahead, behind) {
            (Ok(ahead), Some(Ok(behind))) => [ahead, behind],
            (Ok(ahead), _) => [ahead, (0.0, here)],
            (Err(_), Some(Ok(behind))) => [(0.0, here), behind],
            (Err(error), _) => return Err(NoDerivative::Fails { error: error.to_string() }),
        };
        Ok(there.iter().zip(&back).map(|(there, back)| (there - back) / (to - from)).collect())
    }

    /// What is read at the end of the last communication step if inputs are displaced by so much along a direction; most of each are
    /// `displacements`. The state stays as it is.
    fn displaced(
        &mut self,
        (direction, displacements): (&[(Input, f64)], &[f64]),
        change: f64,
        read: &mut dyn FnMut(&Self) -> Vec<f64>,
    ) -> Result<Side, RunError> {
        // Neither a host that ends its step nor a benchmark is told of this one.
        let (stop, watch) = (self.stop.take(), self.watch.take());
        let room = self.rollback.room.take().unwrap_or_else(|| self.state.clone());
        let present = std::mem::replace(&mut self.state, room);
        let length = self.return_to_last();
        // Inputs are rounded: what counts is how far they went, each measured by its displacement.
        let (mut way, mut whole) = (0.0, 0.0);
        for ((input, share), most) in direction.iter().zip(displacements) {
            let went = self.displace(*input, share * change);
            way += share / most * (went / most);
            whole += share / most * (share / most);
        }
        let result = self.advance(length).map(|()| (way / whole, read(self)));
        self.rollback.room = Some(std::mem::replace(&mut self.state, present));
        (self.stop, self.watch) = (stop, watch);
        result
    }

    /// Displaces what was given for an input. Returns by how much it changed.
    fn displace(&mut self, input: Input, by: f64) -> f64 {
        let state = &mut self.state;
        let value = match input {
            Input::Axis(boundary, axis) => Some(&mut state.boundaries[boundary.index()].target[axis]),
            Input::Node(boundary, node, axis) => {
                state.nodes_of_mut(boundary.index()).map(|nodes| &mut nodes.target[node][axis])
            }
            Input::Heat(boundary, node) => {
                let surface = state.heat.as_mut().and_then(|heat| heat.surface_mut(boundary.index(), node));
                surface.map(|surface| &mut surface.target)
            }
            Input::Fluid(field, cell, axis) => {
                state.fluid.as_mut().map(|fluid| &mut fluid.given_mut(field).target[cell][axis])
            }
            Input::Strain(component) => state.cell.as_mut().map(|cell| &mut cell.target[component]),
            Input::Rate(insertion) => {
                state.exchange.as_mut().and_then(|it| it.feeds.get_mut(insertion)).map(|feed| &mut feed.rate)
            }
        };
        let Some(value) = value else { return 0.0 };
        let before = *value;
        *value += by;
        *value - before
    }

    /// By how much an input is displaced in a communication step of this length \[s\], in its unit: so that what it moves goes on by
    /// a part of the median overlap of its contacts. Loads are displaced by the same part, or by what moves the mass so far.
    fn displacement(&self, input: Input, length: f64) -> f64 {
        let run = &self.scene.run;
        let part = run.derivative_displacement * if run.central_derivatives { CENTRAL } else { ONE_SIDED };
        let (boundary, axis) = match input {
            Input::Axis(boundary, axis) => (boundary, axis),
            Input::Node(boundary, _, axis) => (boundary, axis),
            Input::Rate(insertion) => return part * self.usual_rate(insertion, length),
            Input::Strain(component) => return self.usual_strain(component, part),
            Input::Fluid(field, ..) => return run.derivative_displacement * self.usual_fluid(field, length),
            Input::Heat(boundary, _) => return run.derivative_displacement * self.usual_heat(boundary, length),
        };
        let CurrentContact { overlap, radius, arm } = self.met_by(boundary);
        let way = (part * overlap).max(LEAST * radius);
        // About an axis, a way is an angle times the arm, and a force a moment over it.
        let arm = if axis < 3 { 1.0 } else { arm };
        let motion = &self.scene.boundaries[boundary.index()].axes[axis];
        if motion.takes_force() && matches!(input, Input::Axis(..)) {
            let moved = &self.state.boundaries[boundary.index()];
            let felt = Vector::from(if axis < 3 { moved.force } else { moved.moment }).length();
            let load = felt.max(moved.target[axis].abs());
            return (load * way / overlap).max(2.0 * self.mass_of(boundary) * arm * way / (length * length));
        }
        if motion.takes_velocity() { way / arm / length } else { way / arm }
    }

    /// Mass of a boundary that forces move, of the lightest sphere for another \[kg\].
    fn mass_of(&self, boundary: BoundaryIndex) -> f64 {
        let lightest = self.state.particles.velocity.iter().map(|row| row[3]).fold(f64::INFINITY, f64::min);
        self.bodies[boundary.index()].as_ref().map_or(0.0, |body| body.mass).max(if lightest.is_finite() {
            lightest
        } else {
            0.0
        })
    }

    /// By how much the input of a component of the strain is displaced: by this part of the strain that closes the mean overlap, or by
    /// what makes that of a stress.
    fn usual_strain(&self, component: usize, part: f64) -> f64 {
        let least = self.search.smallest_radius();
        let strain = ((part * self.mean_overlap().unwrap_or(least)).max(LEAST * least)) / (2.0 * least);
        let Some(cell) = &self.state.cell else { return strain };
        let Some(servo) = self.scene.cell.as_ref().and_then(|cell| cell.motion[component].servo()) else {
            return strain;
        };
        let stress = strain * cell.stiffness[component];
        if stress > 0.0 {
            stress
        } else {
            part * servo.stress.abs().max(cell.target[component].abs()).max(f64::MIN_POSITIVE)
        }
    }

    /// By how much a thermal input is displaced in a communication step of this length \[s\]: a part of the temperature, or what warms the
    /// boundary by as much. Heat flows in proportion to it.
    fn usual_heat(&self, boundary: BoundaryIndex, length: f64) -> f64 {
        let Some(heat) = &self.state.heat else { return WARMER };
        let boundary = &heat.boundaries[boundary.index()];
        let warmer = WARMER * boundary.temperature();
        if boundary.capacity > 0.0 { boundary.capacity * warmer / length } else { warmer }
    }

    /// By how much what the fluid is given is displaced in a communication step of this length \[s\]: a part of what it is, or of the speeds in
    /// it, of what takes a particle past its radius and of the gradient of the pressure that accelerates it so. Drag follows it smoothly.
    fn usual_fluid(&self, field: FluidField, length: f64) -> f64 {
        let Some((fluid, keys)) = self.state.fluid.as_ref().zip(self.scene.fluid.as_ref()) else { return WARMER };
        let sizes = fluid.given(field).now.iter().map(|&[x, y, z, _]| Vector::new(x, y, z).length());
        let speed = self.system().fastest().max(self.search.smallest_radius().min(f64::MAX) / length);
        let least = match field {
            FluidField::Velocity => speed,
            FluidField::PressureGradient => keys.density * speed / length,
            FluidField::Temperature => 0.0,
        };
        WARMER * sizes.fold(least, f64::max)
    }

    /// The rate of an insertion, or that of one particle in a communication step of this length \[s\] where that is more.
    fn usual_rate(&self, insertion: usize, length: f64) -> f64 {
        let rate = self.state.exchange.as_ref().map_or(0.0, |exchange| exchange.feeds[insertion].rate);
        rate.max(self.scene.insertions[insertion].least_amount() / length)
    }

    /// What a boundary meets.
    fn met_by(&self, boundary: BoundaryIndex) -> CurrentContact {
        let (state, place) = (&self.state, boundary.index());
        let particles = &state.particles;
        let carried = |slot: u32| particles.owner[particles.original(slot) as usize] as usize == place + 1;
        let pivot = Vector::from(state.boundaries[place].pivot);
        let mut arm = self.bodies[place].as_ref().map_or(0.0, |body| body.farthest);
        let mut overlaps = Vec::new();
        let mut meet = |overlap: f64, point: Vector| {
            arm = arm.max((point - pivot).length());
            if overlap != 0.0 {
                overlaps.push(overlap.abs());
            }
        };
        for pass in self.passes.iter().filter(|pass| pass.source() == Source::Walls) {
            pass.contacts(state, state.clock.last_step, &mut |record| {
                if record.boundary == Some(boundary.0) {
                    meet(record.overlap, record.point.into());
                } else if carried(particles.slot[record.first as usize]) {
                    meet(record.overlap, came_to(state.cell.as_ref(), record.first, record.point.into()));
                }
            });
        }
        if !self.scene.boundaries[place].shape.members().is_empty() {
            for list in &state.contacts {
                let pairs = list.first.iter().zip(&list.second).zip(&list.flags);
                for ((&first, &second), _) in pairs.filter(|(_, flags)| **flags & TOUCHING != 0) {
                    if carried(first) != carried(second) {
                        let [one, other] = [first, second].map(|slot| particles.position[slot as usize]);
                        let apart = (Vector::from(one) - Vector::from(other)).length();
                        let member = particles.original(if carried(first) { first } else { second });
                        meet(one[3] + other[3] - apart, state.unwrapped(member as usize).into());
                    }
                }
            }
        }
        let least = particles.position.iter().map(|row| row[3]).fold(f64::INFINITY, f64::min);
        // Where there are no particles, any displacement does.
        let radius = if least.is_finite() { least } else { 1.0 };
        let middle = overlaps.len() / 2;
        let overlap = match overlaps.is_empty() {
            true => radius,
            false => *overlaps.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        CurrentContact { overlap, radius, arm: if arm > 0.0 { arm } else { radius } }
    }
}
