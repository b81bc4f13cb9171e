//! Heat that flows while nothing moves, in time steps that follow its error.
//!
//! The conductances stay as they are, so temperatures obey a linear equation whose roots Gershgorin's circles bound: none is beyond
//! 2 ΣH/C. The stages of a time step ([`Stages`]) keep it stable whatever its length; its length follows from what it is wrong by.

use super::boundaries::{Ramp, is_driven, takes_heat};
use super::network::{Network, NodeFoot, Told};
use super::scheme::{Stage, Stages};
use super::{Transfer, sources};
use crate::base::lanes::Shared;
use crate::base::number::larger;
use crate::base::threads::{CHUNK, Context};
use crate::engine::contacts::Pass;
use crate::engine::state::heat::{Level, difference};
use crate::engine::state::{Heat, State};
use crate::laws::motion::Progress;
use crate::scene::{HeatGiven, Scene};

/// Error of a time step over the differences of temperature at its beginning.
const ERROR: f64 = 1e-6;

/// Below this share of the temperature a difference is rounding.
const ROUNDING: f64 = 1e-13;

/// Where the error is below this share of what it may be, the next time step is twice as long: its error is eight times as large.
const SMALL: f64 = 1.0 / 16.0;

/// A time step as short as this, in lengths of C/ΣH, is taken whatever its error.
const SHORTEST: f64 = 1.0 / 65536.0;

/// Working arrays, node by node.
#[derive(Default)]
pub(super) struct Relaxation {
    /// What conducts.
    network: Network,
    /// Temperatures.
    levels: Vec<Level>,
    /// Heat that sources give \[W\].
    power: Vec<f64>,
    /// Heat flows \[W\]: at the beginning of the time step, and now.
    flows: [Vec<f64>; 2],
    /// Heat that came since its beginning \[J\]: at the last stage, and at that before it.
    increments: [Vec<f64>; 2],
    /// Where the network's nodes of surroundings begin.
    surroundings: usize,
    /// Where those of feet on meshes begin whose nodes have temperatures.
    first_foot: usize,
    /// These feet.
    feet: Vec<NodeFoot>,
    /// Whether the network is that of the present communication step.
    is_connected: bool,
}

impl Transfer {
    /// Lets heat flow for a time step, while nothing moves.
    pub(super) fn relax(
        &mut self,
        (scene, passes): (&Scene, &[Box<dyn Pass>]),
        state: &mut State,
        progress: &Progress,
        context: &Context,
    ) {
        let mut relaxation = std::mem::take(&mut self.relaxation);
        if !relaxation.is_connected {
            relaxation.connect(self, (scene, passes), state);
        }
        if let Some(heat) = &mut state.heat {
            heat.rate = relaxation.rate(heat);
            let ramp = Ramp::of(progress);
            if scene.run.step.is_automatic() {
                relaxation.advance(scene, heat, &ramp, context);
            } else {
                relaxation.advance_by_euler(scene, heat, &ramp, context);
            }
        }
        self.relaxation = relaxation;
    }
}

impl Relaxation {
    /// The network may be another from now on.
    pub(super) fn forget(&mut self) {
        self.is_connected = false;
    }

    /// Finds what conducts.
    pub(super) fn connect(&mut self, transfer: &Transfer, (scene, passes): (&Scene, &[Box<dyn Pass>]), state: &State) {
        let particles = state.particles.slot.len();
        self.network.clear();
        self.feet.clear();
        self.surroundings = particles + scene.boundaries.len();
        self.first_foot = self.surroundings + scene.heat_sources.len();
        let (network, feet, first_foot) = (&mut self.network, &mut self.feet, self.first_foot);
        let mut told = Told { state, network, feet, first_foot };
        transfer.tell((scene, passes), state, &mut told);
        self.power.clear();
        self.power.resize(first_foot + told.feet.len(), 0.0);
        self.levels.clear();
        self.levels.resize(self.power.len(), [0.0; 2]);
        for (place, source) in (self.surroundings..).zip(&scene.heat_sources) {
            for slot in sources::warmed(source, state) {
                let node = told.node(slot);
                match source.gives {
                    HeatGiven::Power(power) => self.power[node] += power,
                    HeatGiven::Ambient { temperature, conductance } => {
                        told.network.connect(node, place, conductance);
                        self.levels[place] = [temperature, 0.0];
                    }
                }
            }
        }
        self.network.sort(self.power.len());
        for column in self.flows.iter_mut().chain(&mut self.increments) {
            column.clear();
            column.resize(self.power.len(), 0.0);
        }
        self.is_connected = true;
    }

    /// Makes a time step, in parts where its error asks for them.
    fn advance(&mut self, scene: &Scene, heat: &mut Heat, whole: &Ramp, context: &Context) {
        self.increments[0].fill(0.0);
        self.look(scene, heat, (whole, 0.0), context);
        self.flows.swap(0, 1);
        let (mut parts, mut done, mut was_refused) = (1_u64, 0_u64, false);
        while done < parts {
            let part = whole.part(done, parts);
            let allowed = self.allowed(scene, heat, &part);
            let error = self.try_step(scene, heat, &part, context);
            if error > allowed && part.step * heat.rate > SHORTEST {
                (parts, done, was_refused) = (2 * parts, 2 * done, true);
                continue;
            }
            self.take(scene, heat, &part);
            done += 1;
            let is_small = error <= SMALL * allowed;
            let kept = if is_small && !was_refused { heat.stride } else { 0.0 };
            let next = if is_small { 2.0 * part.step } else { part.step };
            heat.stride = larger(next, kept).min(Stages::longest_of_all() / heat.rate);
            if is_small && done % 2 == 0 {
                (parts, done) = (parts / 2, done / 2);
            }
        }
        self.tell(heat);
    }

    /// Makes a time step by Euler's explicit method, as it was given.
    fn advance_by_euler(&mut self, scene: &Scene, heat: &mut Heat, ramp: &Ramp, context: &Context) {
        self.increments[0].fill(0.0);
        self.look(scene, heat, (ramp, 0.0), context);
        let [_, now] = &self.flows;
        self.increments[0].iter_mut().zip(now).for_each(|(came, flow)| *came = ramp.step * flow);
        self.take(scene, heat, ramp);
        self.tell(heat);
    }

    /// Largest sum of conductances over a heat capacity \[1/s\].
    pub(super) fn rate(&self, heat: &Heat) -> f64 {
        capacities(heat).map(|(node, capacity)| self.network.sum(node) / capacity).fold(0.0, larger)
    }

    /// By how much a temperature may be wrong after a time step \[K\].
    fn allowed(&self, scene: &Scene, heat: &Heat, ramp: &Ramp) -> f64 {
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        let mut take = |temperature: f64| (least, most) = (least.min(temperature), larger(most, temperature));
        let warm = heat.capacity.iter().enumerate().filter(|(_, capacity)| **capacity > 0.0);
        warm.for_each(|(index, _)| take(heat.temperature(index)));
        let surroundings = self.levels[self.surroundings..self.first_foot].iter().filter(|level| level[0] > 0.0);
        surroundings.for_each(|level| take(level[0]));
        for node in heat.nodes.iter().flat_map(|mesh| &mesh.each) {
            [0.0, 1.0].into_iter().for_each(|reached| take(node.initial + ramp.rise(true, node, 0.0, reached)));
        }
        for (boundary, moved) in scene.boundaries.iter().zip(&heat.boundaries).filter(|(it, _)| takes_heat(it)) {
            [0.0, 1.0]
                .into_iter()
                .for_each(|reached| take(moved.initial + ramp.rise(is_driven(boundary), moved, 0.0, reached)));
        }
        larger(ERROR * (most - least), ROUNDING * most)
    }

    /// Makes the stages of a time step from the flows at its beginning, and finds the flows at its end. Returns what it is wrong by \[K\].
    fn try_step(&mut self, scene: &Scene, heat: &Heat, ramp: &Ramp, context: &Context) -> f64 {
        let stages = Stages::for_length(ramp.step * heat.rate);
        self.increments.iter_mut().for_each(|column| column.fill(0.0));
        for stage in stages.each() {
            self.make(&stage, ramp.step, context);
            self.look(scene, heat, (ramp, stage.time), context);
        }
        let deviation = |(node, capacity): (usize, f64)| {
            let [first, last] = [0, 1].map(|column: usize| self.flows[column][node]);
            (0.5 * ramp.step * (first + last) - self.increments[0][node]).abs() / capacity
        };
        // What has come is wrong by τ³ Y'''/12 by the trapezoidal rule.
        12.0 * stages.error() * capacities(heat).map(deviation).fold(0.0, larger)
    }

    /// Makes one stage of a time step \[s\].
    fn make(&mut self, stage: &Stage, step: f64, context: &Context) {
        let Self { flows: [first, now], increments: [last, before], .. } = self;
        let (count, places) = (last.len(), Shared::new(before));
        let [of_now, of_first] = stage.of_flows.map(|part| step * part);
        context.each(count.div_ceil(CHUNK), |piece| {
            for node in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
                let carried = stage.of_increments[0] * last[node];
                // SAFETY: pieces do not overlap.
                let place = unsafe { places.at(node) };
                *place = carried + stage.of_increments[1] * *place + (of_now * now[node] + of_first * first[node]);
            }
        });
        self.increments.swap(0, 1);
    }

    /// Finds the temperatures at this share of a time step with what has come until then, and what flows.
    fn look(&mut self, scene: &Scene, heat: &Heat, (ramp, reached): (&Ramp, f64), context: &Context) {
        let Self { network, levels, power, flows: [_, now], increments: [came, _], feet, first_foot, .. } = self;
        let particles = heat.capacity.len();
        let places = Shared::new(levels);
        context.each(particles.div_ceil(CHUNK), |piece| {
            for index in piece * CHUNK..((piece + 1) * CHUNK).min(particles) {
                let capacity = heat.capacity[index];
                let rise = if capacity > 0.0 { (heat.gained[index] + came[index]) / capacity } else { 0.0 };
                // SAFETY: pieces do not overlap.
                unsafe { *places.at(index) = [heat.initial[index], rise] };
            }
        });
        for ((node, boundary), moved) in (particles..).zip(&scene.boundaries).zip(&heat.boundaries) {
            levels[node] = [moved.initial, ramp.rise(is_driven(boundary), moved, came[node], reached)];
        }
        for (level, foot) in levels[*first_foot..].iter_mut().zip(feet) {
            let nodes = &heat.nodes[foot.mesh].each;
            *level = foot.shares.iter().fold([0.0; 2], |[t, rise], &(node, share)| {
                let moved = &nodes[node as usize];
                [t + share * moved.initial, rise + share * ramp.rise(true, moved, 0.0, reached)]
            });
        }
        let (levels, now, nodes) = (&*levels, Shared::new(now), power.len());
        context.each(nodes.div_ceil(CHUNK), |piece| {
            for node in piece * CHUNK..((piece + 1) * CHUNK).min(nodes) {
                let own = levels[node];
                let leads = network.leads(node).iter();
                let flow = leads.map(|&(other, conductance)| conductance * difference(levels[other as usize], own));
                // SAFETY: pieces do not overlap.
                unsafe { *now.at(node) = power[node] + flow.sum::<f64>() };
            }
        });
    }

    /// Takes the time step that was tried.
    fn take(&mut self, scene: &Scene, heat: &mut Heat, ramp: &Ramp) {
        let came = &self.increments[0];
        let particles = heat.gained.len();
        heat.gained.iter_mut().zip(came).for_each(|(gained, came)| *gained += came);
        for ((boundary, moved), came) in scene.boundaries.iter().zip(&mut heat.boundaries).zip(&came[particles..]) {
            moved.present += came;
            ramp.advance(is_driven(boundary), moved);
        }
        for (foot, came) in self.feet.iter().zip(&came[self.first_foot..]) {
            heat.boundaries[foot.boundary].present += came;
            let nodes = &mut heat.nodes[foot.mesh].each;
            foot.shares.iter().for_each(|&(node, share)| nodes[node as usize].present += share * came);
        }
        heat.nodes.iter_mut().flat_map(|mesh| &mut mesh.each).for_each(|node| ramp.advance(true, node));
        let power: f64 = self.power.iter().sum();
        heat.given += ramp.step * power - came[self.surroundings..self.first_foot].iter().sum::<f64>();
        self.flows.swap(0, 1);
    }

    /// Writes what flows at the end of the time step.
    fn tell(&self, heat: &mut Heat) {
        let (particles, boundaries) = self.flows[0].split_at(heat.flow.len());
        heat.flow.copy_from_slice(particles);
        heat.boundaries.iter_mut().zip(boundaries).for_each(|(boundary, flow)| boundary.flow = *flow);
        heat.nodes.iter_mut().flat_map(|mesh| &mut mesh.each).for_each(|node| node.flow = 0.0);
        for (foot, flow) in self.feet.iter().zip(&self.flows[0][self.first_foot..]) {
            heat.boundaries[foot.boundary].flow += flow;
            let nodes = &mut heat.nodes[foot.mesh].each;
            foot.shares.iter().for_each(|&(node, share)| nodes[node as usize].flow += share * flow);
        }
    }
}

/// The nodes that take up heat, with their capacities \[J/K\].
fn capacities(heat: &Heat) -> impl Iterator<Item = (usize, f64)> + '_ {
    let boundaries = heat.boundaries.iter().map(|boundary| boundary.capacity);
    heat.capacity.iter().copied().chain(boundaries).enumerate().filter(|(_, capacity)| *capacity > 0.0)
}
