//! What a host gets that asks for derivatives: how boundaries change, or why that is not known.

use crate::bond::creation::{ContactPolicy, Due};
use crate::motion::AxisMotion;
use crate::scene::Scene;

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

/// Refuses what slopes do not follow.
pub(super) fn refuse(scene: &Scene) -> Result<(), NoDerivative> {
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
