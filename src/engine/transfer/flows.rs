//! What flows between bodies in a time step: by slots of particles, then by bodies.

use crate::base::lanes::Shared;
use crate::base::number::larger;
use crate::base::threads::{CHUNK, Context};
use crate::engine::state::{GONE, Heat, IMAGE, Particles, State};

/// The temperature of a particle: that at the start, and by how much the present one is above it \[K\].
type Level = [f64; 2];

/// Heat flow into a particle \[W\], and the sum of the conductances at it \[W/K\].
type Flow = [f64; 2];

/// Temperatures and heat flows by slots of particles, and of boundaries.
#[derive(Default)]
pub(super) struct Flows {
    /// Temperatures of the particles.
    levels: Vec<Level>,
    /// Flows into them.
    flows: Vec<Flow>,
    /// Temperatures of the boundaries.
    at_boundaries: Vec<Level>,
    /// Flows into these.
    into_boundaries: Vec<Flow>,
}

/// What has the temperature of a particle.
pub(super) enum Body {
    /// A particle by its index: itself, or the first sphere of its clump.
    Particle(usize),
    /// The boundary to whose group it belongs.
    Boundary(usize),
}

/// What has the temperature of the particle in a slot.
pub(super) fn body(state: &State, slot: usize) -> Body {
    let particles = &state.particles;
    let original = particles.original(slot as u32) as usize;
    match particles.group(original) {
        None => Body::Particle(particles.id[original] as usize),
        Some(group) => match group.checked_sub(state.boundaries.len()) {
            None => Body::Boundary(group),
            Some(clump) => Body::Particle(state.clumps.spheres_of(clump)[0] as usize),
        },
    }
}

/// What a thread adds to while it works on a slab.
#[derive(Clone, Copy)]
pub(super) struct SlabFlows<'a> {
    /// Temperatures.
    levels: &'a [Level],
    /// Flows.
    flows: Shared<Flow>,
}

impl SlabFlows<'_> {
    /// Lets heat flow between two particles (slots) over a conductance \[W/K\].
    ///
    /// # Safety
    /// Both are slots of particles, and no other thread adds to them meanwhile.
    #[inline(always)]
    pub(super) unsafe fn between(&self, first: usize, second: usize, conductance: f64) {
        let ([t, rise], [u, other]) = (self.levels[first], self.levels[second]);
        let flow = conductance * ((u - t) + (other - rise));
        // SAFETY: the caller's promise.
        unsafe {
            let [into, sum] = self.flows.at(first);
            (*into, *sum) = (*into + flow, *sum + conductance);
            let [into, sum] = self.flows.at(second);
            (*into, *sum) = (*into - flow, *sum + conductance);
        }
    }
}

impl Flows {
    /// Begins with the present temperatures; nothing flows yet.
    pub(super) fn begin(&mut self, state: &State, context: &Context) {
        let Some(heat) = &state.heat else { return };
        let count = state.particles.len();
        self.flows.clear();
        self.flows.resize(count, [0.0; 2]);
        self.levels.resize(count, [0.0; 2]);
        self.into_boundaries.clear();
        self.into_boundaries.resize(heat.boundaries.len(), [0.0; 2]);
        self.at_boundaries.clear();
        self.at_boundaries.extend(heat.boundaries.iter().map(|boundary| [boundary.initial, boundary.rise]));
        let (levels, at_boundaries) = (Shared::new(&mut self.levels), &self.at_boundaries);
        context.each(count.div_ceil(CHUNK), |piece| {
            for slot in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
                let level = match body(state, slot) {
                    Body::Particle(index) => [heat.initial[index], heat.rise(index)],
                    Body::Boundary(boundary) => at_boundaries[boundary],
                };
                // SAFETY: pieces do not overlap.
                unsafe { *levels.at(slot) = level };
            }
        });
    }

    /// What threads that work on slabs add to.
    pub(super) fn slabs(&mut self) -> SlabFlows<'_> {
        SlabFlows { levels: &self.levels, flows: Shared::new(&mut self.flows) }
    }

    /// Lets heat flow between two particles (slots) over a conductance \[W/K\].
    pub(super) fn between(&mut self, first: u32, second: u32, conductance: f64) {
        let flow = conductance * self.difference(self.levels[second as usize], self.levels[first as usize]);
        self.add(first, flow);
        self.add(second, -flow);
        self.conducts(first, conductance);
        self.conducts(second, conductance);
    }

    /// Lets heat flow between a particle (slot) and a boundary over a conductance \[W/K\].
    pub(super) fn at_boundary(&mut self, slot: u32, boundary: u32, conductance: f64) {
        let flow = conductance * self.difference(self.at_boundaries[boundary as usize], self.levels[slot as usize]);
        self.add(slot, flow);
        self.conducts(slot, conductance);
        let [into, sum] = &mut self.into_boundaries[boundary as usize];
        (*into, *sum) = (*into - flow, *sum + conductance);
    }

    /// Difference of two temperatures, in which small rises are not lost \[K\].
    fn difference(&self, [t, rise]: Level, [u, other]: Level) -> f64 {
        (t - u) + (rise - other)
    }

    /// How far the temperature of a particle (slot) is below another \[K\].
    pub(super) fn below(&self, slot: u32, temperature: f64) -> f64 {
        self.difference([temperature, 0.0], self.levels[slot as usize])
    }

    /// Adds a heat flow into a particle (slot) \[W\].
    pub(super) fn add(&mut self, slot: u32, flow: f64) {
        self.flows[slot as usize][0] += flow;
    }

    /// Counts a conductance at a particle (slot) \[W/K\].
    pub(super) fn conducts(&mut self, slot: u32, conductance: f64) {
        self.flows[slot as usize][1] += conductance;
    }

    /// Adds what losses gave in a time step of this length \[s\].
    pub(super) fn take_losses(&mut self, heat: Option<&mut Heat>, step: f64) {
        let Some(heat) = heat else { return };
        let mut sum = 0.0;
        for ([flow, _], given) in self.flows.iter_mut().zip(&heat.of_losses) {
            *flow += given / step;
            sum += given;
        }
        for ([flow, _], boundary) in self.into_boundaries.iter_mut().zip(&heat.boundaries) {
            *flow += boundary.of_losses / step;
            sum += boundary.of_losses;
        }
        heat.by_losses += sum;
        heat.collect(0);
    }

    /// Adds what flows into images to their particles, then what flows into spheres of clumps and particles of groups to what has their
    /// temperature.
    pub(super) fn gather(&mut self, state: &State) {
        let particles = &state.particles;
        let owned = |slot: &usize| particles.owner[*slot] != 0;
        for slot in (0..particles.len()).filter(|&slot| particles.owner[slot] == IMAGE) {
            let flow = std::mem::take(&mut self.flows[slot]);
            add(&mut self.flows[particles.original(slot as u32) as usize], flow);
        }
        for slot in (0..particles.len()).filter(owned).filter(|&slot| particles.owner[slot] != IMAGE) {
            match body(state, slot) {
                Body::Boundary(boundary) => {
                    let flow = std::mem::take(&mut self.flows[slot]);
                    add(&mut self.into_boundaries[boundary], flow);
                }
                Body::Particle(index) => {
                    let first = particles.slot[index] as usize;
                    if first != slot {
                        let flow = std::mem::take(&mut self.flows[slot]);
                        add(&mut self.flows[first], flow);
                    }
                }
            }
        }
    }

    /// Gives a time step of heat to all bodies, and notes the largest sum of conductances over a heat capacity.
    pub(super) fn integrate(&self, particles: &Particles, heat: &mut Heat, step: f64, context: &Context) {
        let Heat { capacity, gained, flow, boundaries, .. } = heat;
        let (count, capacity) = (capacity.len(), &*capacity);
        let (gained, flow) = (Shared::new(gained), Shared::new(flow));
        let piece = |piece: usize| {
            let mut rate = 0.0_f64;
            for index in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
                let slot = particles.slot[index];
                if slot == GONE || capacity[index] == 0.0 {
                    continue;
                }
                let [into, sum] = self.flows[slot as usize];
                // SAFETY: pieces do not overlap.
                unsafe {
                    *flow.at(index) = into;
                    *gained.at(index) += step * into;
                }
                rate = larger(rate, sum / capacity[index]);
            }
            rate
        };
        let mut rate = context.fold(count.div_ceil(CHUNK), piece, 0.0, larger);
        for (boundary, &[into, sum]) in boundaries.iter_mut().zip(&self.into_boundaries) {
            boundary.flow = into;
            boundary.present += step * into;
            if boundary.capacity > 0.0 {
                rate = larger(rate, sum / boundary.capacity);
            }
        }
        heat.rate = rate;
    }
}

/// Adds a flow to another.
fn add([into, sum]: &mut Flow, [flow, conductance]: Flow) {
    *into += flow;
    *sum += conductance;
}
