//! How far beyond touch the next lists reach.
//!
//! A wide skin lists pairs that do not touch and are looked at in every step; a narrow one is soon used up, and lists
//! are dear to make. Both costs are counted, never timed: every machine chooses the same.
//!
//! ```text
//! cost of a step(s) = P (1 + 3 (s − s₀) / d) + W N r / s
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | s, s₀ | skin of the next lists, of the present ones | m |
//! | P | listed pairs, which grow with the volume that the skin reaches | – |
//! | d | mean distance of listed pairs: diameter and skin | m |
//! | N | particles | – |
//! | r | skin used up in a time step | m |
//! | W | what making lists costs a particle, in looks at a pair | – |
//!
//! The least cost is at s² = W N r d / (3 P).

use crate::engine::state::State;

/// Making lists costs a particle as much as so many looks at a pair that does not touch: 75 ns and 1.2 ns, as
/// measured on one core.
const MAKING: f64 = 60.0;

/// The skin changes by no more than this factor at a time: motion varies.
const CHANGE: f64 = 1.5;

/// Least and largest skin over the mean radius.
const RANGE: [f64; 2] = [0.02, 1.0];

/// Skin of the first lists over the mean radius, when nothing is known of the motion.
pub(crate) const FIRST: f64 = 0.1;

/// The skin of the next lists \[m\], when the present ones are used up by `used` \[m\]. `mean` is the mean radius \[m\].
pub(crate) fn next(state: &State, used: f64, mean: f64) -> f64 {
    let neighbours = &state.neighbours;
    let pairs: usize = state.contacts.iter().map(|list| list.first.len()).sum();
    let steps = (state.clock.steps - neighbours.made_at).max(1);
    let rate = used / steps as f64;
    let (particles, pairs) = (state.particles.len() as f64, pairs.max(1) as f64);
    let apart = 2.0 * mean + neighbours.skin;
    let best = (MAKING * particles * rate * apart / (3.0 * pairs)).sqrt();
    let skin = best.max(neighbours.skin / CHANGE).min(neighbours.skin * CHANGE);
    skin.max(RANGE[0] * mean).min(RANGE[1] * mean)
}
