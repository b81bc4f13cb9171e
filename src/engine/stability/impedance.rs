//! What servos press on.

use super::System;
use crate::base::threads::Context;
use crate::engine::contacts::SearchLimits;

/// Stiffness \[N/m\] and mechanical impedance \[kg/s\] of what touches a boundary, along x, y, z.
pub(crate) type Resistance = [[f64; 3]; 2];

impl System<'_> {
    /// Stiffness of what touches each boundary with a servo, and its mechanical impedance: that of a chain of the touching particles'
    /// masses and the springs of their contacts, √(k m), at least what the dashpots do; summed over contacts and bonds. Zeros for other
    /// boundaries.
    pub(crate) fn resistances(&self) -> Vec<Resistance> {
        let served =
            |boundary: usize| self.scene.boundaries[boundary].axes.iter().any(|motion| motion.servo().is_some());
        let mut resistances = vec![[[0.0; 3]; 2]; self.scene.boundaries.len()];
        let (particles, boundaries) = (&self.state.particles, self.scene.boundaries.len());
        let owner = |slot: u32| particles.group(slot as usize);
        for pass in self.passes {
            pass.stiffness(self.state, &SearchLimits::default(), &Context::ALONE, &mut |link| {
                let second = link.boundary.map(|boundary| boundary as usize).or(link.second.and_then(owner));
                let sides = [(owner(link.first), link.second), (second, Some(link.first))];
                if sides[0].0 == sides[1].0 {
                    return;
                }
                for (boundary, other) in sides {
                    let (Some(boundary), Some(other)) =
                        (boundary.filter(|&boundary| boundary < boundaries && served(boundary)), other)
                    else {
                        continue;
                    };
                    let mass = particles.velocity[other as usize][3];
                    let [stiffnesses, impedances] = &mut resistances[boundary];
                    for (axis, part) in link.normal.to_array().into_iter().enumerate() {
                        let along = |[normal, across, ..]: [f64; 4]| across + (normal - across) * part * part;
                        let (stiffness, damping) = (along(link.stiffness), along(link.damping));
                        stiffnesses[axis] += stiffness;
                        impedances[axis] += (stiffness * mass + damping * damping).sqrt();
                    }
                }
            });
        }
        resistances
    }
}
