//! Levels of sizes: particles that differ much in radius are looked for in cells of different size.

use crate::engine::state::Particles;

/// Radii in one level differ by no more than this factor, unless there are very many levels.
const RANGE: f64 = 2.0;

/// More levels than this are not made; the last one holds all smaller particles.
const MOST_LEVELS: usize = 12;

/// The sizes that there are, the largest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sizes {
    /// Largest radius of each level \[m\].
    pub largest: Vec<f64>,
    /// Number of particles in each level.
    pub counts: Vec<usize>,
}

impl Sizes {
    /// One level for all particles, of a given largest radius \[m\].
    pub(crate) fn single(largest: f64, count: usize) -> Self {
        Self { largest: vec![largest], counts: vec![count] }
    }

    /// Sorts radii into levels.
    pub(crate) fn of(radii: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = radii.collect();
        sorted.sort_unstable_by(|a, b| b.total_cmp(a));
        let mut sizes = Self::default();
        for radius in sorted {
            let begins = sizes.largest.last().is_none_or(|largest| radius * RANGE < *largest);
            if begins && sizes.largest.len() < MOST_LEVELS {
                sizes.largest.push(radius);
                sizes.counts.push(0);
            }
            *sizes.counts.last_mut().expect("the first radius begins a level") += 1;
        }
        if sizes.largest.is_empty() {
            return Self::single(0.0, 0);
        }
        sizes
    }

    /// Counts the particles of each level.
    pub(crate) fn count(&mut self, particles: &Particles) {
        self.counts.fill(0);
        for row in &particles.position {
            let level = self.level(row[3]);
            self.counts[level] += 1;
        }
    }

    /// The level of a radius \[m\].
    #[inline(always)]
    pub(crate) fn level(&self, radius: f64) -> usize {
        let mut level = 0;
        while level + 1 < self.largest.len() && radius <= self.largest[level + 1] {
            level += 1;
        }
        level
    }
}
