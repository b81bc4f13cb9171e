//! Directional derivatives: slopes go through the very time steps of the last communication step.
//!
//! The step is made again from its beginning, with the same bits, and slopes go beside it: each time step has its own
//! contacts, stick and slip, as they were.

use super::Simulation;
use crate::bond::creation::{ContactPolicy, Due};
use crate::dual::{DIRECTIONS, Dual, Slopes};
use crate::motion::{Progress, Way};
use crate::number::Number;
use crate::quantity::BoundaryIndex;
use crate::scene::{Boundary, Scene};
use crate::tangent::{BoundarySlopes, Tangent};

/// How a boundary changes with each of some inputs: at the end of the last communication step, per unit of the input at that
/// end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoundaryDerivatives {
    /// Of the force of the particles \[N\].
    pub force: [Slopes; 3],
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
        self.check_derivatives(inputs)?;
        let given: Vec<[[f64; 6]; 2]> =
            self.state.boundaries.iter().map(|boundary| [boundary.target, boundary.target_rate]).collect();
        let stop = self.stop.take();
        let length = self.return_to_last();
        let mut found = Err(NoDerivative::NoStep);
        if let Some(length) = length {
            let mut tangent = Tangent::of(&self.state);
            for (direction, &(boundary, axis)) in inputs.iter().enumerate().take(DIRECTIONS) {
                let steered = self.scene.boundaries[boundary.index()].axes[axis].takes_velocity();
                let way = if steered { length } else { 1.0 };
                tangent.boundaries[boundary.index()].end[axis][direction] = way;
            }
            self.tangent = Some(Box::new(tangent));
            self.advance(length).expect("a communication step that was made before can be made again");
            if let Some(tangent) = self.tangent.take() {
                found = Ok(tangent.boundaries.iter().map(|slopes| told(slopes, length)).collect());
            }
        }
        for (boundary, [target, rate]) in self.state.boundaries.iter_mut().zip(given) {
            (boundary.target, boundary.target_rate) = (target, rate);
        }
        self.stop = stop;
        found
    }

    /// Whether derivatives by these inputs are followed.
    pub fn check_derivatives(&self, inputs: &[(BoundaryIndex, usize)]) -> Result<(), NoDerivative> {
        refuse(&self.scene)?;
        for &(boundary, axis) in inputs {
            let boundary = &self.scene.boundaries[boundary.index()];
            if axis >= 3 {
                return Err(NoDerivative::Refused {
                    what: format!("[boundary.{}] turned by an input", boundary.name),
                    right: "an input along an axis",
                });
            }
        }
        Ok(())
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
        for (boundary, slopes) in self.scene.boundaries.iter().zip(&mut tangent.boundaries) {
            lead(boundary, slopes, progress);
            (slopes.force, slopes.moment) = Default::default();
        }
        self.carry_groups(&mut tangent);
        for pass in &self.passes {
            pass.add_slopes(&self.state, &mut tangent, Dual::splat(progress.step));
        }
        self.sum_groups(&mut tangent);
        self.tangent = Some(tangent);
    }

    /// The second half of a kick, after forces have been evaluated.
    pub(super) fn kick_slopes(&mut self, step: f64) {
        if let Some(tangent) = &mut self.tangent {
            tangent.follow_bonds(&self.state);
            let particles = &mut tangent.particles;
            self.fields.damp_slopes(&self.state.particles, &mut particles.force, &mut particles.torque);
            tangent.kick(&self.state, step);
            for boundary in &mut tangent.boundaries {
                boundary.book(0.5 * step);
            }
        }
    }

    /// The particles of groups go with their boundaries.
    fn carry_groups(&self, tangent: &mut Tangent) {
        for (boundary, slopes) in self.scene.boundaries.iter().zip(&tangent.boundaries) {
            for &member in boundary.shape.members().iter().filter(|_| slopes.is_moved()) {
                let slot = self.state.particles.slot[member as usize] as usize;
                let particles = &mut tangent.particles;
                particles.position[slot][..3].copy_from_slice(&slopes.displacement);
                particles.velocity[slot][..3].copy_from_slice(&slopes.velocity);
                particles.reached[slot] = true;
            }
        }
    }

    /// Loads on the particles of groups are loads on their boundaries. The particles go as the boundary does, so their arms
    /// stay.
    fn sum_groups(&self, tangent: &mut Tangent) {
        for ((boundary, moved), slopes) in
            self.scene.boundaries.iter().zip(&self.state.boundaries).zip(&mut tangent.boundaries)
        {
            for &member in boundary.shape.members() {
                let slot = self.state.particles.slot[member as usize] as usize;
                let particles = &tangent.particles;
                if particles.reached[slot] {
                    let position = self.state.particles.position[slot];
                    let arm: [f64; 3] = std::array::from_fn(|axis| position[axis] - moved.pivot[axis]);
                    let ([f, g, h, _], [a, b, c, _]) = (particles.force[slot], particles.torque[slot]);
                    let moment = std::array::from_fn(|direction| {
                        let across = [
                            arm[1] * h[direction] - arm[2] * g[direction],
                            arm[2] * f[direction] - arm[0] * h[direction],
                            arm[0] * g[direction] - arm[1] * f[direction],
                        ];
                        [across[0] + a[direction], across[1] + b[direction], across[2] + c[direction]]
                    });
                    slopes.load(&[f, g, h], &turned(moment));
                }
            }
        }
    }
}

/// Slopes by component, from those by direction.
fn turned(by_direction: [[f64; 3]; DIRECTIONS]) -> [Slopes; 3] {
    std::array::from_fn(|axis| std::array::from_fn(|direction| by_direction[direction][axis]))
}

/// A boundary goes on its way as it is led: in proportion to where it is to be at the end.
fn lead(boundary: &Boundary, slopes: &mut BoundarySlopes, progress: &Progress) {
    for axis in (0..3).filter(|&axis| boundary.axes[axis].is_driven()) {
        for direction in 0..DIRECTIONS {
            let (target, before) = (slopes.end[axis][direction], slopes.displacement[axis][direction]);
            let way = Way { start: 0.0, target, before, course: boundary.input };
            if let Some([displacement, velocity]) = boundary.axes[axis].lead(&way, progress) {
                slopes.displacement[axis][direction] = displacement;
                slopes.velocity[axis][direction] = velocity;
            }
        }
    }
}

/// What is told of a boundary after a communication step of this length \[s\].
fn told(slopes: &BoundarySlopes, length: f64) -> BoundaryDerivatives {
    let mean = |impulse: &[Slopes; 3]| impulse.map(|impulse| impulse.map(|impulse| impulse / length));
    BoundaryDerivatives {
        force: slopes.force,
        moment: slopes.moment,
        mean_force: mean(&slopes.impulse),
        mean_moment: mean(&slopes.angular_impulse),
    }
}

/// Refuses what slopes do not follow.
fn refuse(scene: &Scene) -> Result<(), NoDerivative> {
    let refused = |what: String, right| Err(NoDerivative::Refused { what, right });
    for boundary in &scene.boundaries {
        let name = &boundary.name;
        if boundary.axes.iter().any(|axis| axis.servo().is_some()) {
            return refused(
                format!("[boundary.{name}] moved by a servo"),
                "a boundary that an input or the scene leads",
            );
        }
        if boundary.axes.iter().any(|axis| axis.is_free()) {
            return refused(
                format!("[boundary.{name}] moved by forces"),
                "a boundary that an input or the scene leads",
            );
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
