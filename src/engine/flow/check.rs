//! Whether particles of a saved state can be those of a scene in which particles come and go.

use crate::engine::state::exchange::Exchange;
use crate::engine::state::{IMAGE, Particles, StateFault, demand};
use crate::scene::{ParticleShape, Scene};

/// Looks through particles that stand for themselves: the scene's own are as it has them, the others as an insertion makes them,
/// groups are whole, and no number is used twice.
pub(crate) fn check(scene: &Scene, particles: &Particles, exchange: &Exchange) -> Result<(), StateFault> {
    let own = scene.particles.len();
    let there = particles.slot.len() - particles.numbers.len();
    demand(there == own, "slot", there, "a place for each of the scene's own particles")?;
    let mut owners = vec![0; own];
    for (index, boundary) in (1..).zip(&scene.boundaries) {
        for &member in boundary.shape.members() {
            owners[member as usize] = index;
            let here = particles.slot_of(member).is_some();
            demand(here, "particles", member as usize, "every particle of a group")?;
        }
    }
    for clump in &scene.clumps {
        owners[scene.spheres_of(clump)].fill(OF_CLUMP);
    }
    for slot in 0..particles.len() {
        let index = particles.id[slot] as usize;
        let expected = "radius, mass, inertia, material and group that the scene gives it";
        demand(is_as_made(scene, particles, slot, owners.get(index).copied()), "particles", slot, expected)?;
    }
    let kinds = exchange.feeds.iter().zip(&scene.insertions);
    let known = kinds.into_iter().all(|(feed, insertion)| (feed.kind as usize) < insertion.kinds.len());
    demand(known, "feeds", 0, "kinds that insertions let come")?;
    let last = scene.particles.last().map_or(0, |last| last.id.0);
    let mut numbers: Vec<u32> =
        (own..particles.slot.len()).filter_map(|index| number_at(particles, index as u32)).collect();
    numbers.sort_unstable();
    let ascend = numbers.windows(2).all(|pair| pair[0] < pair[1]);
    let within = numbers.first().is_none_or(|&first| first > last || own == 0)
        && numbers.last().is_none_or(|&number| number < exchange.next);
    demand(ascend && within, "numbers", 0, "numbers that no other particle has or will have")
}

/// The number of a particle that came later and is there.
fn number_at(particles: &Particles, index: u32) -> Option<u32> {
    particles.slot_of(index).and_then(|_| particles.number_of_inserted(index))
}

/// Stands for the owner of a sphere of a clump, which is looked at with its clump.
const OF_CLUMP: u32 = u32::MAX;

/// Whether what never changes of the particle in a slot is as the scene, which gives it an owner, or an insertion has it.
fn is_as_made(scene: &Scene, particles: &Particles, slot: usize, owner: Option<u32>) -> bool {
    let (radius, mass) = (particles.position[slot][3], particles.velocity[slot][3]);
    let (inertia, material) = (particles.angular_velocity[slot][3], particles.material[slot]);
    let same = |shape: ParticleShape, expected: f64| {
        mass.to_bits() == expected.to_bits() && inertia.to_bits() == shape.inertia(expected, radius).to_bits()
    };
    if particles.owner[slot] == IMAGE {
        // Its particle has been looked at.
        return true;
    }
    let is_of_clump = particles.owner[slot] as usize > scene.boundaries.len();
    match owner {
        Some(OF_CLUMP) => return is_of_clump,
        None if is_of_clump => return true,
        owner if particles.owner[slot] != owner.unwrap_or(0) => return false,
        _ => {}
    }
    match scene.particles.get(particles.id[slot] as usize) {
        Some(own) => {
            own.radius.to_bits() == radius.to_bits() && own.material.0 == material && same(own.shape, own.mass())
        }
        None => same(ParticleShape::Sphere, mass) && is_made(scene, radius, mass, material),
    }
}

/// Whether an insertion of a scene makes loose spheres of this radius \[m\], mass \[kg\] and material.
pub(crate) fn is_made(scene: &Scene, radius: f64, mass: f64, material: u32) -> bool {
    let made = |insertion: &crate::scene::Insertion| {
        let of_kind = |kind: &crate::scene::Kind| {
            let same = kind.mass(radius).to_bits() == mass.to_bits();
            kind.clump.is_none() && kind.sizes.hold(radius, 1.0) && same
        };
        insertion.material.0 == material && insertion.kinds.iter().any(of_kind)
    };
    scene.insertions.iter().any(made)
}
