//! Directional derivatives: slopes go through the very time steps of the last communication step.
//!
//! They go along in the step itself where the host is expected to ask ([`super::habit`]). Otherwise the step is made again from its
//! beginning, with the same bits. Each time step has its own contacts, stick and slip, as they were.

use super::Simulation;
use super::habit::Input;
use super::way_back::Given;
use crate::bond::creation::{ContactPolicy, Due};
use crate::boundaries::slopes;
use crate::motion::AxisMotion;
use crate::motion::Progress;
use crate::quantity::BoundaryIndex;
use crate::run_error::RunError;
use crate::scene::Scene;
use crate::tangent::{BoundarySlopes, OneInput, PASSING, Tangent};

/// How a boundary changes with an input: at the end of the last communication step, per unit of the input at that end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoundaryDerivatives {
    /// Of the force of the particles \[N\].
    pub force: [f64; 3],
    /// Of its displacement \[m\].
    pub displacement: [f64; 3],
    /// Of its velocity \[m/s\].
    pub velocity: [f64; 3],
    /// Of their moment \[N m\].
    pub moment: [f64; 3],
    /// Of the mean force of the communication step \[N\].
    pub mean_force: [f64; 3],
    /// Of the mean moment of the communication step \[N m\].
    pub mean_moment: [f64; 3],
}

/// Why there is no derivative.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoDerivative {
    /// Something in the scene is not followed.
    #[error("{what}: derivatives do not follow it; {right} has them")]
    Refused {
        /// What it is.
        what: String,
        /// What would be right.
        right: &'static str,
    },
    /// No communication step to follow.
    #[error(
        "derivatives are those of the last communication step, and there is none since the state was set or a parameter \
         changed; a communication step before is right"
    )]
    NoStep,
}

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
    fn follow_all(&self, inputs: &[Input], length: f64) -> Vec<Tangent<OneInput>> {
        let follow = |&(boundary, axis): &Input| {
            let mut tangent = Tangent::of(&self.state, self.width, self.turning);
            let place = boundary.index();
            let (moved, followed) = (&self.state.boundaries[place], &mut tangent.boundaries[place]);
            slopes::begin(&self.scene.boundaries[place], moved, followed, (axis, 0), length);
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
            fields.damp_slopes::<OneInput>(&state.particles, &mut tangent.particles.force, &mut tangent.particles.torque);
            tangent.kick_particles(state, step);
            slopes::kick_again(bodies, state, tangent, step);
            for boundary in &mut tangent.boundaries {
                boundary.book(0.5 * step);
            }
        }
    }
}

/// What is told of the boundaries after a communication step of this length \[s\].
fn told_of(tangent: &Tangent<OneInput>, length: f64) -> Vec<BoundaryDerivatives> {
    tangent.boundaries.iter().map(|slopes| told(slopes, length)).collect()
}

/// What is told of a boundary after a communication step of this length \[s\].
fn told(slopes: &BoundarySlopes<OneInput>, length: f64) -> BoundaryDerivatives {
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

/// Refuses what slopes do not follow.
fn refuse(scene: &Scene) -> Result<(), NoDerivative> {
    let refused = |what: String, right| Err(NoDerivative::Refused { what, right });
    let right = "a scene whose particles stay";
    if let Some(insertion) = scene.insertions.first() {
        return refused(format!("[insertion.{}] particles that come", insertion.name), right);
    }
    if let Some(outlet) = scene.outlets.first() {
        return refused(format!("[outlet.{}] particles that go", outlet.name), right);
    }
    if scene.removes() {
        return refused("[domain] outside = \"remove\", particles that go".to_owned(), right);
    }
    for boundary in &scene.boundaries {
        let name = &boundary.name;
        if boundary.axes.iter().any(|axis| axis.servo().is_some()) {
            return refused(format!("[boundary.{name}] moved by a servo"), "one that is driven or loaded");
        }
        if boundary.axes[3..].iter().any(AxisMotion::is_free) {
            return refused(format!("[boundary.{name}] turned by forces"), "one that forces move along its axes alone");
        }
        let free = boundary.axes.iter().any(AxisMotion::is_free);
        let damped = |member: &u32| scene.damping.iter().any(|set| set.linear[*member as usize] != 0.0);
        if free && boundary.shape.members().iter().any(damped) {
            let what = format!("[boundary.{name}] moved by forces under [damping]");
            return refused(what, "one without global damping");
        }
        if boundary.shape.material().is_some() && boundary.shifting_plane().is_none() {
            return refused(format!("[boundary.{name}] a surface of features"), "a plane, or a group of particles,");
        }
    }
    for bond in &scene.bonds {
        if bond.keys.contact != ContactPolicy::Parallel {
            return refused(format!("[bond.{}] a bond that suppresses contacts", bond.name), "contact = \"parallel\"");
        }
        if bond.create.due() != Due::AtStart {
            return refused(format!("[bond.{}] a bond made on the way", bond.name), "one made before the first step");
        }
    }
    Ok(())
}
