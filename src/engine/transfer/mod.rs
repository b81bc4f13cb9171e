//! Heat: which flows where bodies touch, and how temperatures follow.
//!
//! After the forces the touching entries of the lists are gone over again: each conducts by the law of its contact, from the new places and
//! the old temperatures. What flows is summed in the order of the lists, as forces are, and integrated by Euler's explicit method. A scene
//! in which no heat flows has neither this nor a column of it.

mod begin;
mod boundaries;
mod conduction;
mod flows;
mod renew;

use crate::base::threads::Context;
use crate::engine::contacts::Pass;
use crate::engine::state::{GONE, Heat, State};
use crate::laws::motion::Progress;
use crate::scene::{HeatGiven, Scene};
pub(crate) use begin::{begun, take, tell};
pub(crate) use boundaries::{begin, end, put, takes_heat};
use conduction::{BondConduction, Conduction};
use flows::Flows;

/// What conducts, composed for the scene.
pub(crate) struct Transfer {
    /// Of each contact law; none where it conducts nothing.
    laws: Vec<Option<Conduction>>,
    /// Of each bond law.
    bonds: Vec<Option<BondConduction>>,
    /// Whether heat flows into each boundary.
    takes: Vec<bool>,
    /// Working arrays.
    flows: Flows,
}

/// The temperature of the particle in a slot: of what it belongs to, where that has one \[K\].
pub(crate) fn temperature(state: &State, slot: usize) -> Option<f64> {
    let heat = state.heat.as_ref()?;
    Some(match flows::body(state, slot) {
        flows::Body::Particle(index) => heat.temperature(index),
        flows::Body::Boundary(boundary) => heat.boundaries[boundary].temperature(),
    })
}

/// Specific heat of the particle in a slot, where heat flows \[J/(kg K)\].
pub(crate) fn specific_heat(scene: &Scene, state: &State, slot: usize) -> f64 {
    scene.materials[state.particles.material[slot] as usize].thermal.specific_heat.unwrap_or(0.0)
}

impl Transfer {
    /// What conducts in a scene, if anything does.
    pub(crate) fn of(scene: &Scene) -> Option<Self> {
        scene.has_heat().then(|| Self {
            laws: (0..scene.contacts.len()).map(|law| Conduction::of(scene, law)).collect(),
            bonds: (0..scene.bonds.len()).map(|bond| BondConduction::of(scene, bond)).collect(),
            takes: scene.boundaries.iter().map(takes_heat).collect(),
            flows: Flows::default(),
        })
    }

    /// Lets heat flow for a time step, from where everything stands now.
    pub(crate) fn advance(
        &mut self,
        (scene, passes): (&Scene, &[Box<dyn Pass>]),
        state: &mut State,
        progress: &Progress,
        context: &Context,
    ) {
        self.conduct((scene, passes), state, context);
        self.flows.take_losses(state.heat.as_mut(), progress.step);
        self.flows.gather(state);
        let given = self.sources(scene, state, progress.step);
        let Some(heat) = &mut state.heat else { return };
        heat.given += given;
        self.flows.integrate(&state.particles, heat, progress.step, context);
        boundaries::advance(scene, heat, progress);
    }

    /// Finds the conductances of the present network, of which follows how long a time step may be; nothing flows.
    pub(crate) fn look(&mut self, (scene, passes): (&Scene, &[Box<dyn Pass>]), state: &mut State, context: &Context) {
        self.conduct((scene, passes), state, context);
        self.flows.gather(state);
        self.sources(scene, state, 0.0);
        if let Some(heat) = &mut state.heat {
            heat.collect(0);
            self.flows.integrate(&state.particles, heat, 0.0, context);
            heat.flow.fill(0.0);
            heat.boundaries.iter_mut().for_each(|boundary| boundary.flow = 0.0);
        }
    }

    /// Sums up what flows between bodies.
    fn conduct(&mut self, (scene, passes): (&Scene, &[Box<dyn Pass>]), state: &mut State, context: &Context) {
        if state.exchange.is_some() {
            renew::renew(scene, state);
        }
        self.flows.begin(state, context);
        for (law, list) in self.laws.iter().zip(&state.contacts) {
            if let Some(law) = law {
                law.between_particles(list, state, &mut self.flows, context);
            }
        }
        for (place, law) in self.bonds.iter().enumerate() {
            if let Some(law) = law {
                law.conduct((scene, place), state, &mut self.flows);
            }
        }
        for pass in passes {
            pass.touched(state, &mut |touch| {
                let law = self.laws[touch.law as usize].as_ref();
                if let Some(law) = law.filter(|_| self.takes[touch.boundary as usize]) {
                    law.at_boundary(scene, &touch, state, &mut self.flows);
                }
            });
        }
    }

    /// Adds what heat sources give. Returns the heat of a time step \[J\].
    fn sources(&mut self, scene: &Scene, state: &State, step: f64) -> f64 {
        let mut sum = 0.0;
        for source in &scene.heat_sources {
            for &member in &source.members {
                let slot = state.particles.slot[member as usize];
                let stands_for = |slot: u32| match flows::body(state, slot as usize) {
                    flows::Body::Particle(index) => index == member as usize,
                    flows::Body::Boundary(_) => false,
                };
                if slot == GONE || !stands_for(slot) {
                    continue;
                }
                let flow = match source.gives {
                    HeatGiven::Power(power) => power,
                    HeatGiven::Ambient { temperature, conductance } => {
                        self.flows.conducts(slot, conductance);
                        conductance * self.flows.below(slot, temperature)
                    }
                };
                self.flows.add(slot, flow);
                sum += step * flow;
            }
        }
        sum
    }
}

/// The longest time step in which no body gives more heat than would bring it to the temperature of its neighbours \[s\].
pub(crate) fn longest_step(heat: Option<&Heat>) -> f64 {
    heat.map_or(f64::INFINITY, |heat| 1.0 / heat.rate)
}

/// Heat that is not accounted for: what particles gained, less what boundaries, sources and losses gave \[J\].
pub(crate) fn residual(heat: &Heat) -> f64 {
    let boundaries: f64 = heat.boundaries.iter().map(|boundary| boundary.heat()).sum();
    heat.energy() + boundaries - heat.given - heat.by_losses
}
