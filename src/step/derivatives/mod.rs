//! Directional derivatives: slopes go through the very time steps of the last communication step.
//!
//! They go along in the step itself where the host is expected to ask ([`habit`]). Otherwise the step is made again from its
//! beginning, with the same bits. Each time step has its own contacts, stick and slip, as they were.

mod answer;
mod habit;

pub use answer::{BoundaryDerivatives, NoDerivative};
pub(super) use habit::Habit;

use super::Simulation;
use super::way_back::Given;
use crate::boundaries::slopes;
use crate::motion::Progress;
use crate::quantity::BoundaryIndex;
use crate::run_error::RunError;
use crate::scene::Scene;
use crate::tangent::{BoundarySlopes, PASSING, Tangent};
use answer::refuse;
use habit::Input;

impl Simulation {
    /// How the boundaries change with each of some inputs, axes of boundaries, at the end of the last communication step. The
    /// state stays as it is. What the step did not carry along is found by making it again, and up to 64 time steps before it.
    pub fn derivatives(
        &mut self,
        inputs: &[(BoundaryIndex, usize)],
    ) -> Result<Vec<Vec<BoundaryDerivatives>>, NoDerivative> {
        refuse(&self.scene)?;
        if !self.way_back.has_last() {
            return Err(NoDerivative::NoStep);
        }
        self.habit.ask(inputs);
        let missing: Vec<Input> = inputs.iter().filter(|input| self.habit.by(**input).is_none()).copied().collect();
        let mut found = if missing.is_empty() { Vec::new() } else { self.make_again(&missing) }.into_iter();
        let mut told = |input: &Input| match self.habit.by(*input) {
            Some(known) => known.clone(),
            None => found.next().unwrap_or_default(),
        };
        Ok(inputs.iter().map(&mut told).collect())
    }

    /// Makes the last communication step again, with slopes by these inputs.
    fn make_again(&mut self, inputs: &[Input]) -> Vec<Vec<BoundaryDerivatives>> {
        let given: Vec<Given> = self.state.boundaries.iter().map(Given::of).collect();
        let stop = self.stop.take();
        let length = self.return_to_last();
        self.followed = self.follow_all(inputs, length);
        self.advance(length).expect("a communication step that was made before can be made again");
        let found = self.told(length);
        self.state.boundaries.iter_mut().zip(given).for_each(|(boundary, given)| given.give_to(boundary));
        self.stop = stop;
        found
    }

    /// What was found of the inputs that were followed through a communication step of this length \[s\]; nothing is followed any
    /// more.
    fn told(&mut self, length: f64) -> Vec<Vec<BoundaryDerivatives>> {
        let followed = std::mem::take(&mut self.followed);
        followed.iter().map(|followed| told_of(followed, length)).collect()
    }

    /// Makes a communication step of this length \[s\], and carries slopes along by the inputs that the host will probably ask for.
    pub(super) fn advance_with_slopes(&mut self, inputs: &[Input], length: f64) -> Result<(), RunError> {
        self.followed = self.follow_all(inputs, length);
        let result = self.advance(length);
        let found = self.told(length);
        if result.is_ok() {
            self.habit.keep(inputs.iter().copied().zip(found));
        }
        result
    }

    /// What follows these inputs through a communication step of this length \[s\] that begins now.
    fn follow_all(&self, inputs: &[Input], length: f64) -> Vec<Tangent> {
        let follow = |&(boundary, axis): &Input| {
            let mut tangent = Tangent::of(&self.state, self.width, self.turning);
            let place = boundary.index();
            let (moved, followed) = (&self.state.boundaries[place], &mut tangent.boundaries[place]);
            slopes::begin(&self.scene.boundaries[place], moved, followed, axis, length);
            tangent
        };
        inputs.iter().map(follow).collect()
    }

    /// Whether derivatives are followed in a scene.
    pub fn follows(scene: &Scene) -> Result<(), NoDerivative> {
        refuse(scene)
    }

    /// Whether rates of loads are known in a scene.
    pub fn has_rates(scene: &Scene) -> Result<(), NoDerivative> {
        refuse(scene)?;
        match scene.bonds.iter().find(|bond| bond.keys.formulation.is_engine()) {
            None => Ok(()),
            Some(bond) => {
                let what = format!("[bond.{}] formulation engine_exact in time", bond.name);
                Err(NoDerivative::Refused { what, right: "another formulation" })
            }
        }
    }

    /// How force and moment of each boundary change in time at present \[N/s, N m/s\]: as positions, velocities and springs go on.
    /// The state stays as it is.
    pub fn rates(&self) -> Result<Vec<BoundaryDerivatives>, NoDerivative> {
        Self::has_rates(&self.scene)?;
        let mut tangent = Tangent::of(&self.state, self.width, self.turning);
        tangent.go_on(&self.state);
        for pass in &self.passes {
            pass.add_slopes(&self.state, &mut tangent, PASSING);
        }
        let particles = &self.state.particles;
        slopes::sum_groups(&self.scene, &self.state, &mut tangent, |slot| self.fields.weight_of(particles, slot));
        Ok(told_of(&tangent, 1.0))
    }

    /// The first half of a kick and the drift.
    pub(super) fn drift_slopes(&mut self, step: f64) {
        for tangent in &mut self.followed {
            for boundary in &mut tangent.boundaries {
                boundary.book(0.5 * step);
            }
            tangent.drift_particles(&self.state, step);
        }
    }

    /// Motion of the boundaries, before forces are evaluated.
    pub(super) fn lead_slopes(&mut self, progress: &Progress) {
        let Self { scene, state, bodies, followed, .. } = self;
        for tangent in followed {
            tangent.follow(state);
            slopes::advance(scene, bodies, state, tangent, progress);
        }
    }

    /// The second half of a kick, after forces have been evaluated.
    pub(super) fn kick_slopes(&mut self, weighed: bool, step: f64) {
        let Self { scene, state, bodies, fields, followed, .. } = self;
        let weight = |slot: usize| if weighed { fields.weight_of(&state.particles, slot) } else { [0.0; 3] };
        for tangent in followed {
            slopes::sum_groups(scene, state, tangent, weight);
            tangent.follow_bonds(state);
            fields.damp_slopes(&state.particles, &mut tangent.particles.force, &mut tangent.particles.torque);
            tangent.kick_particles(step);
            slopes::kick_again(bodies, state, tangent, step);
            for boundary in &mut tangent.boundaries {
                boundary.book(0.5 * step);
            }
        }
    }
}

/// What is told of the boundaries after a communication step of this length \[s\].
fn told_of(tangent: &Tangent, length: f64) -> Vec<BoundaryDerivatives> {
    tangent.boundaries.iter().map(|slopes| told(slopes, length)).collect()
}

/// What is told of a boundary after a communication step of this length \[s\].
fn told(slopes: &BoundarySlopes, length: f64) -> BoundaryDerivatives {
    let of = |slopes: &[[f64; 1]; 3]| slopes.map(|[slope]| slope);
    let mean = |impulse: &[[f64; 1]; 3]| impulse.map(|[impulse]| impulse / length);
    BoundaryDerivatives {
        displacement: of(&slopes.displacement),
        velocity: of(&slopes.velocity),
        force: of(&slopes.force),
        moment: of(&slopes.moment),
        mean_force: mean(&slopes.impulse),
        mean_moment: mean(&slopes.angular_impulse),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Source;
    use std::sync::Arc;

    /// Spheres between two planes, whose upper one is driven.
    const PRESSED: &str = r#"
[run]
step = 1.0e-5
threads = 2
[material.glass]
density = 2500.0
youngs_modulus = 5.0e7
poissons_ratio = 0.3
[pair.glass.glass]
restitution = 0.5
friction = 0.5
[contact.all.normal.hertz]
[contact.all.tangential.history]
[particles.all]
material = "glass"
lattice = { kind = "simple_cubic", radius = 0.005, spacing = 0.00999, counts = [12, 3, 3], origin = [0.0, 0.0, 0.0] }
[boundary.floor]
plane = { point = [0.0, 0.0, -0.004995], normal = [0.0, 0.0, 1.0] }
material = "glass"
[boundary.top]
plane = { point = [0.0, 0.0, 0.024975], normal = [0.0, 0.0, -1.0] }
material = "glass"
motion = { driven = ["x", "z"] }
"#;

    /// At time 0, on so many threads.
    fn begin(threads: usize) -> Simulation {
        let text = PRESSED.replace("threads = 2", &format!("threads = {threads}"));
        let source = Source { name: "scene.toml".into(), text, files: Default::default() };
        let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
        Simulation::new(Arc::new(scene)).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Makes a communication step in which the top goes on.
    fn advance(simulation: &mut Simulation, number: u32) {
        simulation.set_input(BoundaryIndex(1), 0, 2.0e-6 * f64::from(number));
        simulation.set_input(BoundaryIndex(1), 2, -1.0e-6 * f64::from(number));
        simulation.advance_or_return(1.0e-4).unwrap_or_else(|error| panic!("{error}"));
    }

    #[test]
    fn slopes_that_go_along_are_those_of_the_step_made_again_and_change_nothing() {
        let across = (BoundaryIndex(1), 0);
        let inputs = [across, (BoundaryIndex(1), 2)];
        for threads in [1, 2] {
            let (mut asked, mut plain) = (begin(threads), begin(1));
            for number in 1..=6 {
                advance(&mut asked, number);
                advance(&mut plain, number);
                assert!(asked.state() == plain.state());
                assert_eq!(asked.habit.by(across).is_some(), number > 3);
                assert!(plain.habit.by(across).is_none());
                let found = asked.derivatives(&inputs).unwrap_or_else(|refusal| panic!("{refusal}"));
                if number == 6 {
                    assert!(found[0] != found[1]);
                    assert!(found == plain.derivatives(&inputs).unwrap_or_else(|refusal| panic!("{refusal}")));
                }
            }
            // What does not go along is found beside what does.
            advance(&mut asked, 7);
            advance(&mut plain, 7);
            let other = [(BoundaryIndex(1), 1), across];
            let both = [&mut asked, &mut plain].map(|it| it.derivatives(&other));
            assert!(both[0].is_ok() && both[0] == both[1]);
            assert!(asked.state() == plain.state());
        }
    }

    #[test]
    fn slopes_of_a_state_that_was_left_are_forgotten() {
        let mut simulation = begin(1);
        for number in 1..=5 {
            advance(&mut simulation, number);
            simulation.derivatives(&[(BoundaryIndex(1), 2)]).unwrap_or_else(|refusal| panic!("{refusal}"));
        }
        let state = simulation.state().clone();
        simulation.return_to(&state);
        assert_eq!(simulation.derivatives(&[(BoundaryIndex(1), 2)]), Err(NoDerivative::NoStep));
    }
}
