//! Scenes written as text, run, and looked at particle by particle.

use cograin::scene::{Scene, Source};
use cograin::simulation::Simulation;
use cograin_chart::ChartError;
use std::sync::Arc;

/// A running scene.
pub(crate) struct Stage {
    /// The simulation.
    pub simulation: Simulation,
}

/// Reads a scene from its text.
pub(crate) fn scene(text: &str) -> Result<Scene, ChartError> {
    let source = Source { name: "scene.toml".into(), text: text.into(), ..Source::default() };
    Ok(Scene::from_source(&source)?)
}

impl Stage {
    /// Reads and begins a scene.
    pub(crate) fn of(text: &str) -> Result<Self, ChartError> {
        Ok(Self { simulation: Simulation::new(Arc::new(scene(text)?))? })
    }

    /// Runs for this time \[s\].
    pub(crate) fn advance(&mut self, time: f64) -> Result<(), ChartError> {
        Ok(self.simulation.advance(time)?)
    }

    /// The time step \[s\].
    pub(crate) fn step(&self) -> f64 {
        self.simulation.state().clock.step
    }

    /// The stable time step as the program states it \[s\].
    pub(crate) fn stable(&self) -> f64 {
        self.simulation.stable_step()
    }

    /// How many particles there are.
    pub(crate) fn count(&self) -> usize {
        self.simulation.state().particles.len()
    }

    /// The first three numbers of a particle's row.
    fn row(&self, rows: &[[f64; 4]], particle: usize) -> [f64; 3] {
        let [x, y, z, _] = rows[self.simulation.state().particles.slot[particle] as usize];
        [x, y, z]
    }

    /// Position of a particle \[m\].
    pub(crate) fn position(&self, particle: usize) -> [f64; 3] {
        self.row(&self.simulation.state().particles.position, particle)
    }

    /// Velocity of a particle \[m/s\].
    pub(crate) fn velocity(&self, particle: usize) -> [f64; 3] {
        self.row(&self.simulation.state().particles.velocity, particle)
    }

    /// Angular velocity of a particle \[rad/s\].
    pub(crate) fn spin(&self, particle: usize) -> [f64; 3] {
        self.row(&self.simulation.state().particles.angular_velocity, particle)
    }
}
