//! Heat: which flows where bodies touch, and how temperatures follow.
//!
//! Where the forces of contacts are evaluated each conducts by its law, from the new places and the old temperatures. What flows is summed in
//! the order of the lists, as forces are, and integrated by Euler's explicit method; where
//! nothing moves and no time step is given, by a stabilised one of second order. A scene in which no heat flows has neither this nor a column of it.

mod begin;
mod boundaries;
mod conduction;
mod flows;
mod held;
mod network;
mod relaxation;
mod renew;
mod scheme;
mod sources;

use crate::base::threads::Context;
use crate::engine::contacts::Pass;
use crate::engine::state::contacts::{BONDED, TOUCHING};
use crate::engine::state::{Heat, State};
use crate::laws::motion::Progress;
use crate::scene::{HeatGiven, Scene};
pub(crate) use begin::{begun, take, tell};
use boundaries::Ramp;
pub(crate) use boundaries::{begin, end, put, takes_heat};
use conduction::{BondConduction, Conductances, Conduction};
pub(crate) use flows::warm_at_once;
pub(crate) use held::remembered;
use relaxation::Relaxation;

/// What conducts, composed for the scene.
pub(crate) struct Transfer {
    /// Of each contact law; none where it conducts nothing.
    laws: Vec<Option<Conduction>>,
    /// Of each bond law.
    bonds: Vec<Option<BondConduction>>,
    /// Whether heat flows into each boundary.
    takes: Vec<bool>,
    /// What flows where nothing moves.
    relaxation: Relaxation,
    /// Whether temperatures stay as they are, whatever would flow.
    holds: bool,
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
            relaxation: Relaxation::default(),
            holds: false,
        })
    }

    /// Lets temperatures stay as they are from now on.
    pub(crate) fn hold(&mut self) {
        self.holds = true;
    }

    /// Whether temperatures stay as they are.
    pub(crate) fn holds(&self) -> bool {
        self.holds
    }

    /// Begins a time step, before forces are evaluated: open contacts let heat flow there, those that bonds suppress here.
    pub(crate) fn prepare(&self, (scene, passes): (&Scene, &[Box<dyn Pass>]), state: &mut State, context: &Context) {
        if scene.heat.frozen {
            return;
        }
        if state.exchange.is_some() {
            renew::renew(scene, state);
        }
        let Some(mut heat) = state.heat.take() else { return };
        flows::begin(state, &mut heat, scene.heat.warms(), context);
        if scene.suppresses_contacts() {
            self.tell_contacts((scene, passes), (state, BONDED), &mut heat);
        }
        state.heat = Some(heat);
    }

    /// Ends a time step: what else conducts, what sources and losses give, and what follows from all that flows.
    pub(crate) fn advance(
        &mut self,
        (scene, passes): (&Scene, &[Box<dyn Pass>]),
        state: &mut State,
        progress: &Progress,
        context: &Context,
    ) {
        if self.holds {
            state.heat.iter_mut().for_each(Heat::forget_step);
            return;
        }
        if scene.heat.frozen {
            self.relax((scene, passes), state, progress, context);
            return;
        }
        let Some(mut heat) = state.heat.take() else { return };
        self.tell_bonds(scene, state, &mut heat);
        flows::take_losses(&mut heat, progress.step);
        flows::gather(state, &mut heat);
        heat.given += give(scene, state, &mut heat, progress.step);
        flows::integrate(&state.particles, &mut heat, progress.step, context);
        boundaries::advance(scene, &mut heat, &Ramp::of(progress));
        heat.forget_step();
        state.heat = Some(heat);
    }

    /// Finds how long a time step may be in the present network; nothing flows.
    pub(crate) fn look(&mut self, (scene, passes): (&Scene, &[Box<dyn Pass>]), state: &mut State) {
        if state.exchange.is_some() {
            renew::renew(scene, state);
        }
        let mut relaxation = Relaxation::default();
        relaxation.connect(self, (scene, passes), state);
        if let Some(heat) = &mut state.heat {
            heat.rate = relaxation.rate(heat);
        }
    }

    /// Something else may conduct from now on.
    pub(crate) fn forget(&mut self) {
        self.relaxation.forget();
    }

    /// Tells all conductances.
    fn tell(&self, (scene, passes): (&Scene, &[Box<dyn Pass>]), state: &State, hear: &mut impl Conductances) {
        self.tell_contacts((scene, passes), (state, TOUCHING | BONDED), hear);
        self.tell_bonds(scene, state, hear);
    }

    /// Tells the conductances of bonds.
    fn tell_bonds(&self, scene: &Scene, state: &State, hear: &mut impl Conductances) {
        for (place, law) in self.bonds.iter().enumerate() {
            if let Some(law) = law {
                law.tell((scene, place), state, hear);
            }
        }
    }

    /// Tells the conductances of contacts that have one of these flags.
    fn tell_contacts(
        &self,
        (scene, passes): (&Scene, &[Box<dyn Pass>]),
        (state, flags): (&State, u8),
        hear: &mut impl Conductances,
    ) {
        for (law, list) in self.laws.iter().zip(&state.contacts) {
            if let Some(law) = law {
                law.tell((list, flags), state, hear);
            }
        }
        for pass in passes {
            pass.touched((state, flags), &mut |touch| {
                let law = self.laws[touch.law as usize].as_ref();
                if let Some(law) = law.filter(|_| self.takes[touch.boundary as usize]) {
                    law.at_boundary(scene, &touch, state, hear);
                }
            });
        }
    }
}

/// Adds what heat sources give. Returns the heat of a time step \[J\].
fn give(scene: &Scene, state: &State, heat: &mut Heat, step: f64) -> f64 {
    let mut sum = 0.0;
    for source in &scene.heat_sources {
        for slot in sources::warmed(source, state) {
            let (flow, conductance) = match source.gives {
                HeatGiven::Power(power) => (power, 0.0),
                HeatGiven::Ambient { temperature, conductance } => {
                    (conductance * flows::below(heat, slot, temperature), conductance)
                }
            };
            let row = &mut heat.slots[slot as usize];
            (row[2], row[3]) = (row[2] + flow, row[3] + conductance);
            sum += step * flow;
        }
    }
    sum
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
