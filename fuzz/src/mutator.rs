//! Changes of input that know lines, numbers and the rest of the corpus.

use crate::Target;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Numbers at which something may end.
const NUMBERS: [&str; 32] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "0.5",
    "1e-9",
    "1e-300",
    "5e-324",
    "1e300",
    "-1e300",
    "1.7976931348623157e308",
    "inf",
    "-inf",
    "nan",
    "255",
    "256",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "-9223372036854775808",
    "1e-12",
    "1e12",
    "3",
    "1000",
    "1_0",
];

/// Changes inputs of one target.
pub struct Mutator {
    /// Where lines and pieces are taken from.
    entries: Vec<Vec<u8>>,
}

impl Mutator {
    /// That of a target.
    pub fn of(target: &Target) -> Self {
        Self { entries: target.entries().into_iter().map(|(_, bytes)| bytes).collect() }
    }

    /// An entry of the corpus, by a number.
    pub fn entry(&self, number: u64) -> &[u8] {
        let count = self.entries.len().max(1) as u64;
        self.entries.get((number % count) as usize).map_or(&[], Vec::as_slice)
    }

    /// The bytes after one change or several, which follow from the seed.
    pub fn changed(&self, bytes: &[u8], seed: u64) -> Vec<u8> {
        let mut chance = ChaCha8Rng::seed_from_u64(seed);
        let mut bytes = bytes.to_vec();
        for _ in 0..1 + chance.next_u32() % 4 {
            self.change(&mut bytes, &mut chance);
        }
        bytes
    }

    /// One change.
    fn change(&self, bytes: &mut Vec<u8>, chance: &mut ChaCha8Rng) {
        let mut below = |count: usize| if count == 0 { 0 } else { chance.next_u32() as usize % count };
        let kind = below(10);
        let (place, byte) = (below(bytes.len()), below(256) as u8);
        match kind {
            0 if !bytes.is_empty() => bytes[place] = byte,
            1 if !bytes.is_empty() => bytes[place] ^= 1 << (byte % 8),
            2 => {
                let end = (place + 1 + below(8)).min(bytes.len());
                bytes.drain(place.min(end)..end);
            }
            3 => {
                let end = (place + 1 + below(64)).min(bytes.len());
                let (copy, to) = (bytes[place.min(end)..end].to_vec(), below(bytes.len() + 1));
                bytes.splice(to..to, copy);
            }
            // A piece of another entry.
            4 => {
                let other = self.entry(below(1 << 30) as u64);
                let from = below(other.len());
                let end = (from + 1 + below(64)).min(other.len());
                bytes.splice(place..place, other[from.min(end)..end].iter().copied());
            }
            // A line goes, or one comes from here or from another entry.
            5 => {
                let (from, to) = line(bytes, place);
                bytes.drain(from..to);
            }
            6 | 7 => {
                let source = if kind == 6 { bytes.clone() } else { self.entry(below(1 << 30) as u64).to_vec() };
                let (from, to) = line(&source, below(source.len()));
                let (at, _) = line(bytes, place);
                bytes.splice(at..at, source[from..to].iter().copied());
            }
            _ => {
                let numbers = numbers(bytes);
                if !numbers.is_empty() {
                    let (from, to) = numbers[below(numbers.len())];
                    let other = NUMBERS[below(NUMBERS.len())];
                    bytes.splice(from..to, other.bytes());
                }
            }
        }
    }
}

/// Where the line begins and ends that holds a place.
fn line(bytes: &[u8], place: usize) -> (usize, usize) {
    let place = place.min(bytes.len());
    let from = bytes[..place].iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let to = bytes[place..].iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |end| place + end + 1);
    (from, to)
}

/// Where numbers begin and end.
fn numbers(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let begins = bytes[at].is_ascii_digit() && (at == 0 || !bytes[at - 1].is_ascii_alphanumeric());
        let more = |byte: &u8| byte.is_ascii_digit() || b".eE-+_".contains(byte);
        let length = if begins { bytes[at..].iter().take_while(|byte| more(byte)).count() } else { 0 };
        if length > 0 {
            found.push((at, at + length));
        }
        at += length.max(1);
    }
    found
}
