//! Directional derivatives: slopes go through the very time steps of the last communication step.
//!
//! The step is made again from its beginning, with the same bits, and slopes go beside it: each time step has its own
//! contacts, stick and slip, as they were.

use super::Simulation;
use super::way_back::Given;
use crate::bond::creation::{ContactPolicy, Due};
use crate::boundaries::slopes;
use crate::dual::{DIRECTIONS, Dual, Slopes};
use crate::motion::AxisMotion;
use crate::motion::Progress;
use crate::number::Number;
use crate::quantity::BoundaryIndex;
use crate::scene::Scene;
use crate::tangent::{BoundarySlopes, Tangent, passing};

/// How a boundary changes with each of some inputs: at the end of the last communication step, per unit of the input at that
/// end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoundaryDerivatives {
    /// Of the force of the particles \[N\].
    pub force: [Slopes; 3],
    /// Of its displacement \[m\].
    pub displacement: [Slopes; 3],
    /// Of its velocity \[m/s\].
    pub velocity: [Slopes; 3],
    /// Of their moment \[N m\].
    pub moment: [Slopes; 3],
    /// Of the mean force of the communication step \[N\].
    pub mean_force: [Slopes; 3],
    /// Of the mean moment of the communication step \[N m\].
    pub mean_moment: [Slopes; 3],
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
    /// How the boundaries change with each of at most [`DIRECTIONS`] inputs, axes of boundaries, at the end of the last
    /// communication step. The state stays as it is. From the first call on the beginning of each communication step is
    /// kept; before it is found by making up to 64 time steps again.
    pub fn derivatives(&mut self, inputs: &[(BoundaryIndex, usize)]) -> Result<Vec<BoundaryDerivatives>, NoDerivative> {
        refuse(&self.scene)?;
        let given: Vec<Given> = self.state.boundaries.iter().map(Given::of).collect();
        let stop = self.stop.take();
        let length = self.return_to_last();
        let mut found = Err(NoDerivative::NoStep);
        if let Some(length) = length {
            let mut tangent = Tangent::of(&self.state, self.width, self.turning);
            for (direction, &(boundary, axis)) in inputs.iter().enumerate().take(DIRECTIONS) {
                let place = boundary.index();
                let (moved, followed) = (&self.state.boundaries[place], &mut tangent.boundaries[place]);
                slopes::begin(&self.scene.boundaries[place], moved, followed, (axis, direction), length);
            }
            self.tangent = Some(Box::new(tangent));
            self.advance(length).expect("a communication step that was made before can be made again");
            if let Some(tangent) = self.tangent.take() {
                found = Ok(tangent.boundaries.iter().map(|slopes| told(slopes, length)).collect());
            }
        }
        self.state.boundaries.iter_mut().zip(given).for_each(|(boundary, given)| given.give_to(boundary));
        self.stop = stop;
        found
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

    /// How force and moment of each boundary change in time at present, in the first of the directions \[N/s, N m/s\]: as
    /// positions, velocities and springs go on. The state stays as it is.
    pub fn rates(&self) -> Result<Vec<BoundaryDerivatives>, NoDerivative> {
        Self::has_rates(&self.scene)?;
        let mut tangent = Tangent::of(&self.state, self.width, self.turning);
        tangent.go_on(&self.state);
        for pass in &self.passes {
            pass.add_slopes(&self.state, &mut tangent, passing());
        }
        let particles = &self.state.particles;
        slopes::sum_groups(&self.scene, &self.state, &mut tangent, |slot| self.fields.weight_of(particles, slot));
        Ok(tangent.boundaries.iter().map(|slopes| told(slopes, 1.0)).collect())
    }

    /// The first half of a kick and the drift.
    pub(super) fn drift_slopes(&mut self, step: f64) {
        if let Some(tangent) = &mut self.tangent {
            for boundary in &mut tangent.boundaries {
                boundary.book(0.5 * step);
            }
            tangent.drift(&self.state, step);
        }
    }

    /// Motion of the boundaries and the forces, before these are evaluated.
    pub(super) fn evaluate_slopes(&mut self, progress: &Progress) {
        let Some(mut tangent) = self.tangent.take() else { return };
        tangent.follow(&self.state);
        slopes::advance(&self.scene, &self.bodies, &self.state, &mut tangent, progress);
        for pass in &self.passes {
            pass.add_slopes(&self.state, &mut tangent, Dual::splat(progress.step));
        }
        self.tangent = Some(tangent);
    }

    /// The second half of a kick, after forces have been evaluated.
    pub(super) fn kick_slopes(&mut self, weighed: bool, step: f64) {
        if let Some(tangent) = &mut self.tangent {
            let particles = &self.state.particles;
            let weight = |slot: usize| if weighed { self.fields.weight_of(particles, slot) } else { [0.0; 3] };
            slopes::sum_groups(&self.scene, &self.state, tangent, weight);
            tangent.follow_bonds(&self.state);
            let particles = &mut tangent.particles;
            self.fields.damp_slopes(&self.state.particles, &mut particles.force, &mut particles.torque);
            tangent.kick(&self.state, step);
            slopes::kick_again(&self.bodies, &self.state, tangent, step);
            for boundary in &mut tangent.boundaries {
                boundary.book(0.5 * step);
            }
        }
    }
}

/// What is told of a boundary after a communication step of this length \[s\].
fn told(slopes: &BoundarySlopes, length: f64) -> BoundaryDerivatives {
    let mean = |impulse: &[Slopes; 3]| impulse.map(|impulse| impulse.map(|impulse| impulse / length));
    BoundaryDerivatives {
        displacement: slopes.displacement,
        velocity: slopes.velocity,
        force: slopes.force,
        moment: slopes.moment,
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
