//! Near pairs for bonds that are made in every step: they are searched again only when a particle has moved.

use super::near_pairs;
use crate::base::number::Vector;
use crate::engine::state::{GONE, Particles, Row};

/// Margin of the remembered pairs over the distance that is asked for.
const MARGIN: f64 = 0.2;

/// Pairs that may be near, with where everything was when they were found. What it hands out follows from the
/// positions alone, so it is not part of the state.
#[derive(Debug, Default)]
pub(crate) struct PairCache {
    /// Positions at that time, by index; not a number where there was no such particle.
    reference: Vec<Row>,
    /// Pairs not further apart than the distance and its margin: indices into the scene's particles.
    pairs: Vec<[u32; 2]>,
    /// Times they were looked for.
    searches: u64,
}

impl PairCache {
    /// Hands out every two particles (slots) that are not further apart than `reach` \[m\], with their distance.
    pub(crate) fn pairs(&mut self, particles: &Particles, reach: f64, mut hand: impl FnMut(u32, u32, f64)) {
        if self.outdated(particles, 0.5 * MARGIN * reach) {
            self.find(particles, (1.0 + MARGIN) * reach);
        }
        for pair in &self.pairs {
            let [a, b] = pair.map(|index| particles.slot[index as usize]);
            let apart = Vector::from(particles.position[a as usize]) - Vector::from(particles.position[b as usize]);
            let distance = apart.length();
            if distance <= reach {
                hand(a, b, distance);
            }
        }
    }

    /// Whether any particle has moved further than this \[m\], or is a new one.
    fn outdated(&self, particles: &Particles, most: f64) -> bool {
        self.reference.len() != particles.slot.len()
            || self.reference.iter().zip(&particles.slot).any(|(then, &slot)| {
                if slot == GONE {
                    return !then[0].is_nan();
                }
                let moved = Vector::from(particles.position[slot as usize]) - Vector::from(*then);
                let way = moved.dot(moved);
                way > most * most || way.is_nan()
            })
    }

    /// Looks for all pairs anew.
    fn find(&mut self, particles: &Particles, reach: f64) {
        self.pairs.clear();
        near_pairs(particles, reach, |a, b, _| {
            self.pairs.push([a, b].map(|slot| particles.id[slot as usize]));
        });
        self.reference.clear();
        let place = |&slot: &u32| if slot == GONE { [f64::NAN; 4] } else { particles.position[slot as usize] };
        self.reference.extend(particles.slot.iter().map(place));
        self.searches += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles in a row at this distance, the later ones shifted \[m\].
    fn row(distance: f64, shift: f64) -> Particles {
        let mut particles = Particles::default();
        for index in 0..20_u32 {
            let shift = if index < 10 { 0.0 } else { shift };
            particles.position.push([distance * f64::from(index), shift, 0.0, 0.5]);
            particles.id.push(index);
            particles.slot.push(index);
        }
        particles
    }

    #[test]
    fn gives_the_pairs_of_a_new_search_and_searches_only_after_motion() {
        let mut near = PairCache::default();
        for (shift, searches) in [(0.0, 1), (0.05, 1), (0.09, 1), (0.2, 2), (0.6, 3), (0.55, 3), (0.0, 4)] {
            let particles = row(0.95, shift);
            let (mut found, mut expected) = (Vec::new(), Vec::new());
            near.pairs(&particles, 1.0, |a, b, distance| found.push((a.min(b), a.max(b), distance.to_bits())));
            near_pairs(&particles, 1.0, |a, b, distance| expected.push((a.min(b), a.max(b), distance.to_bits())));
            found.sort_unstable();
            expected.sort_unstable();
            assert_eq!(found, expected, "shifted by {shift}");
            assert_eq!(near.searches, searches, "shifted by {shift}");
        }
    }
}
