//! How many pairs will be listed, found from a few particles before memory is asked for.

use crate::base::geometry::Frame;
use crate::base::number::Vector;
use crate::engine::state::Particles;
use crate::laws::surface::Features;

/// Particles whose neighbours are counted, at most.
const LOOKED_AT: usize = 64;

/// About how many pairs of particles have centres nearer than their reach \[m\], which follows from their radii \[m\].
pub(crate) fn pairs(particles: &Particles, reach: impl Fn(f64, f64) -> f64) -> f64 {
    let position = &particles.position;
    let stride = position.len().div_ceil(LOOKED_AT).max(1);
    let (mut looked_at, mut near) = (0_usize, 0_usize);
    for (index, one) in position.iter().enumerate().step_by(stride) {
        looked_at += 1;
        near += position
            .iter()
            .enumerate()
            .filter(|(other, row)| {
                let reach = reach(one[3], row[3]);
                let square: f64 = one.iter().zip(&row[..3]).map(|(a, b)| (a - b) * (a - b)).sum();
                *other != index && square < reach * reach
            })
            .count();
    }
    0.5 * near as f64 * position.len() as f64 / looked_at.max(1) as f64
}

/// About how many parts of a surface that stands so are nearer to particles than their radius and the skin \[m\], each
/// counted for each particle.
pub(crate) fn parts(particles: &Particles, features: &dyn Features, (frame, skin): (&Frame, f64)) -> f64 {
    let stride = particles.len().div_ceil(LOOKED_AT).max(1);
    let (mut looked_at, mut near) = (0_usize, 0_usize);
    let mut found = Vec::new();
    for row in particles.position.iter().step_by(stride) {
        found.clear();
        features.near(frame.inside(Vector::from(*row)), row[3] + skin, &mut found);
        (looked_at, near) = (looked_at + 1, near + found.len());
    }
    near as f64 * particles.len() as f64 / looked_at.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_counted_where_all_particles_are_looked_at() {
        let position = (0..10).map(|k| [f64::from(k), 0.0, 0.0, 0.5]).collect();
        let particles = Particles { position, ..Particles::default() };
        assert_eq!(pairs(&particles, |a, b| a + b + 0.1), 9.0);
        assert_eq!(pairs(&particles, |_, _| 1e3), 45.0);
    }
}
