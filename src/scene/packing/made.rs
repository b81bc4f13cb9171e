//! Random packings that were made before, so that nobody makes them again.

use super::{PackingTable, Sphere};
use crate::base::geometry::Lattice;
use crate::base::quantity::SetIndex;
use crate::scene::SceneDraft;
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Write};
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

/// Numbers of a sphere: its centre and its radius.
const NUMBERS: usize = 4;

/// A packing of a file: what it was made of, how many spheres it has, and a checksum of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Packed {
    /// Digest of all that decides it.
    made_of: u64,
    /// Spheres.
    count: u64,
    /// Checksum of the spheres.
    checksum: u64,
}

/// Random packings that were made before, each by the digest of all that decides it: the keys, the cell, the seed, the set and the build
/// of the program.
#[derive(Clone, Debug, Default)]
pub struct Packings(Vec<(u64, Vec<Sphere>)>);

/// Digest of all that decides a packing.
pub(crate) fn digest(table: &PackingTable, cell: Option<Lattice>, seed: u64, set: &str) -> u64 {
    xxh3_64(format!("{} {table:?} {cell:?} {seed} {set:?}", env!("COGRAIN_BUILD")).as_bytes())
}

impl Packings {
    /// The spheres of a packing, if it was made.
    pub(crate) fn get(&self, made_of: u64) -> Option<&[Sphere]> {
        self.0.iter().find(|(known, _)| *known == made_of).map(|(_, spheres)| &spheres[..])
    }

    /// Reads those that a file has; one that is damaged is made anew.
    pub(crate) fn read(told: &[Packed], mut from: impl Read) -> io::Result<Self> {
        let mut packings = Vec::new();
        for packed in told {
            let mut bytes = Vec::new();
            from.by_ref().take(packed.bytes()).read_to_end(&mut bytes)?;
            if bytes.len() as u64 == packed.bytes() && xxh3_64(&bytes) == packed.checksum {
                packings.push((packed.made_of, spheres(&bytes)));
            }
        }
        Ok(Self(packings))
    }
}

impl Packed {
    /// Length of its spheres in a file \[bytes\].
    pub(crate) fn bytes(&self) -> u64 {
        self.count.saturating_mul((NUMBERS * size_of::<f64>()) as u64)
    }

    /// Those of a scene.
    pub(crate) fn of(scene: &SceneDraft) -> Vec<Self> {
        let of = |&(set, made_of): &(SetIndex, u64)| {
            let (mut count, mut checksum) = (0, Xxh3::new());
            for sphere in numbers(scene, set) {
                count += 1;
                checksum.update(&sphere);
            }
            Self { made_of, count, checksum: checksum.digest() }
        };
        scene.packed.iter().map(of).collect()
    }

    /// Writes the spheres of those of a scene, in their order.
    pub(crate) fn write(scene: &SceneDraft, to: &mut impl Write) -> io::Result<()> {
        let mut sets = scene.packed.iter();
        sets.try_for_each(|&(set, _)| numbers(scene, set).try_for_each(|sphere| to.write_all(&sphere)))
    }
}

/// The spheres of a set, as bytes.
fn numbers(scene: &SceneDraft, set: SetIndex) -> impl Iterator<Item = [u8; NUMBERS * size_of::<f64>()]> + '_ {
    scene.particles.iter().filter(move |particle| particle.set == set).map(|particle| {
        let [x, y, z] = particle.position;
        let mut bytes = [0; NUMBERS * size_of::<f64>()];
        for (place, number) in bytes.chunks_exact_mut(size_of::<f64>()).zip([x, y, z, particle.radius]) {
            place.copy_from_slice(&number.to_le_bytes());
        }
        bytes
    })
}

/// Spheres of these bytes.
fn spheres(bytes: &[u8]) -> Vec<Sphere> {
    let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
    let sphere = |row: &[u8]| {
        let mut numbers = row.chunks_exact(size_of::<f64>()).map(number);
        let mut next = || numbers.next().unwrap_or(f64::NAN);
        ([next(), next(), next()], next())
    };
    bytes.chunks_exact(NUMBERS * size_of::<f64>()).map(sphere).collect()
}
