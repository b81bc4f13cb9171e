//! Usual magnitudes of what a unit measures.

use crate::interface::Quantity;
use crate::scene::Scene;

/// How large quantities of a scene are: by these an importer chooses tolerances and axes.
pub(super) struct Scales {
    /// Mean radius of the particles \[m\].
    length: f64,
    /// Their mass \[kg\].
    mass: f64,
    /// Magnitude of gravity \[m/s²\].
    gravity: f64,
}

impl Scales {
    /// Those of a scene.
    pub(super) fn of(scene: &Scene) -> Self {
        let radii = scene.particles.iter().map(|particle| particle.radius);
        let mass = scene.particles.iter().map(|it| it.density * it.radius * it.radius * it.radius);
        Self {
            length: radii.sum::<f64>() / scene.particles.len() as f64,
            mass: mass.sum::<f64>() * (4.0 / 3.0 * std::f64::consts::PI),
            gravity: scene.gravity.iter().map(|part| part * part).sum::<f64>().sqrt(),
        }
    }

    /// A usual magnitude of a quantity, to three digits, where the scene tells one: a radius, the weight of all particles and what
    /// follows of these.
    pub(super) fn nominal(&self, quantity: Quantity) -> Option<f64> {
        let Self { length, mass, gravity } = *self;
        let value = match quantity {
            Quantity::Length => length,
            Quantity::Mass => mass,
            Quantity::Velocity => (gravity * length).sqrt(),
            Quantity::GranularTemperature => gravity * length,
            Quantity::Force => mass * gravity,
            Quantity::Torque | Quantity::Energy => mass * gravity * length,
            Quantity::Stiffness => mass * gravity / length,
            _ => return None,
        };
        let rounded: f64 = format!("{value:.2e}").parse().ok()?;
        (rounded.is_finite() && rounded > 0.0).then_some(rounded)
    }
}
