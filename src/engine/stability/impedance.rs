//! The mechanical impedance of what servos press on.

use super::System;
use crate::engine::contacts::SearchLimits;

impl System<'_> {
    /// The mechanical impedance of what touches each boundary with a servo, along x, y, z \[kg/s\]: that of a chain of the
    /// touching particles' masses and the springs of their contacts, √(k m), at least what the dashpots do; summed over contacts and
    /// bonds. Zeros for other boundaries.
    pub(crate) fn impedances(&self) -> Vec<[f64; 3]> {
        let served =
            |boundary: usize| self.scene.boundaries[boundary].axes.iter().any(|motion| motion.servo().is_some());
        let mut impedances = vec![[0.0; 3]; self.scene.boundaries.len()];
        let particles = &self.state.particles;
        let owner = |slot: u32| (particles.owner[slot as usize] as usize).checked_sub(1);
        for pass in self.passes {
            pass.stiffness(self.state, &SearchLimits::default(), &mut |link| {
                let second = link.boundary.map(|boundary| boundary as usize).or(link.second.and_then(owner));
                let sides = [(owner(link.first), link.second), (second, Some(link.first))];
                if sides[0].0 == sides[1].0 {
                    return;
                }
                for (boundary, other) in sides {
                    let (Some(boundary), Some(other)) = (boundary.filter(|boundary| served(*boundary)), other) else {
                        continue;
                    };
                    let mass = particles.velocity[other as usize][3];
                    for (sum, part) in impedances[boundary].iter_mut().zip(link.normal.to_array()) {
                        let along = |[normal, across, ..]: [f64; 4]| across + (normal - across) * part * part;
                        let damping = along(link.damping);
                        *sum += (along(link.stiffness) * mass + damping * damping).sqrt();
                    }
                }
            });
        }
        impedances
    }
}
