//! Random numbers of a packing, and of particles that come.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use xxhash_rust::xxh3::xxh3_64;

/// A number from 0 to below 1.
pub(crate) fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// The generator of a set: the scene's seed, and a stream of the set's own.
pub(crate) fn generator(seed: u64, set: &str) -> ChaCha8Rng {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let mut random = ChaCha8Rng::from_seed(bytes);
    random.set_stream(xxh3_64(set.as_bytes()));
    random
}

/// The generator of whatever has this name, after it has handed out so many numbers.
pub(crate) fn generator_after(seed: u64, name: &str, draws: u64) -> ChaCha8Rng {
    let mut random = generator(seed, name);
    // A number takes two words of 32 bits.
    random.set_word_pos(2 * u128::from(draws));
    random
}
