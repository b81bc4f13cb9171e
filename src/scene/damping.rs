//! What acts on chosen particles: global damping and constant forces.

/// `[damping.<name>]`: Cundall's damping of the unbalanced force.
#[derive(Clone, Debug)]
pub struct Damping {
    /// Its name in the scene.
    pub name: String,
    /// Fraction of the force, for each particle of the scene (0: not damped), scale included.
    pub linear: Vec<f64>,
    /// Fraction of the torque, for each particle of the scene, scale included.
    pub angular: Vec<f64>,
    /// The same two for particles that come later: those of a damping of all particles.
    pub newcomers: [f64; 2],
    /// Whether gravity is part of the force that is damped.
    pub gravity_damped: bool,
    /// Whether applied forces are part of the force that is damped.
    pub applied_forces_damped: bool,
}

/// `[force.<name>]`: a constant force on each of some particles.
#[derive(Clone, Debug)]
pub struct AppliedForce {
    /// Its name in the scene.
    pub name: String,
    /// Indices into [`SceneDraft::particles`](super::SceneDraft::particles), ascending.
    pub members: Vec<u32>,
    /// Force on each \[N\].
    pub force: [f64; 3],
}
