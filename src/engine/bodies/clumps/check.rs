//! Whether clumps of a saved state are such as a scene has them, or lets them come.

use super::rows;
use crate::engine::state::{ClumpRows, State, StateFault, demand};
use crate::scene::{Clump, ParticleShape, Scene};

/// Looks through clumps whose rows and spheres fit each other: what never changes of them is as the scene or an insertion makes it.
pub(crate) fn check(scene: &Scene, state: &State) -> Result<(), StateFault> {
    let next = state.exchange.as_ref().map_or(scene.clumps.len() as u32, |exchange| exchange.next_clump);
    let unused = state.clumps.number.last().is_none_or(|&last| last < next);
    demand(unused, "clumps", 0, "numbers that no other clump will have")?;
    for (clump, &number) in state.clumps.number.iter().enumerate() {
        let made = match scene.clumps.get(number as usize) {
            Some(own) => {
                let spheres = scene.spheres_of(own).map(|index| index as u32);
                let there = state.clumps.spheres_of(clump);
                let radii = |place: usize| scene.particles[there[place] as usize].radius;
                spheres.eq(there.iter().copied()) && is_made_of(scene, state, clump, (own, &radii))
            }
            None => is_made(scene, state, clump, Some),
        };
        demand(made, "clumps", clump, "the clumps of the scene, or such as an insertion lets come")?;
    }
    Ok(())
}

/// Whether an insertion of the scene makes clumps such as one of a state, whose materials have these indices in the scene.
pub(crate) fn is_made(scene: &Scene, state: &State, clump: usize, material_here: impl Fn(u32) -> Option<u32>) -> bool {
    let scale = state.clumps.scale[clump];
    let is_of = |material: u32, sphere: u32| {
        let slot = state.particles.slot_of(sphere);
        slot.and_then(|slot| material_here(state.particles.material[slot])) == Some(material)
    };
    let kinds = scene.insertions.iter().flat_map(|it| it.kinds.iter().map(move |kind| (it.material.0, kind)));
    let mut clumps = kinds.filter_map(|(material, kind)| Some((material, kind.clump_of_scale(scale)?)));
    clumps.any(|(material, made)| {
        let radii = |place: usize| scale * scene.clump_shapes[made.shape as usize].spheres[place].1;
        is_made_of(scene, state, clump, (&made, &radii))
            && state.clumps.spheres_of(clump).iter().all(|&sphere| is_of(material, sphere))
    })
}

/// Whether what never changes of a clump, and of its spheres of these radii \[m\], is that of this one.
fn is_made_of(scene: &Scene, state: &State, clump: usize, (made, radius): (&Clump, &dyn Fn(usize) -> f64)) -> bool {
    let (clumps, particles) = (&state.clumps, &state.particles);
    let ClumpRows { position, moments, velocity, scale, shape, .. } = rows(scene, made);
    let [x, y, z, smallest] = clumps.moments[clump];
    let found = [clumps.position[clump][3], clumps.velocity[clump][3], clumps.scale[clump], x, y, z, smallest];
    let expected = [position[3], velocity[3], scale, moments[0], moments[1], moments[2], moments[3]];
    let spheres = clumps.spheres_of(clump);
    let same = |(place, &sphere): (usize, &u32)| {
        let radius = radius(place);
        let rows = particles.slot_of(sphere).map(|slot| {
            let rows = [particles.position[slot], particles.velocity[slot], particles.angular_velocity[slot]];
            rows.map(|row| row[3].to_bits())
        });
        rows == Some([radius, made.mass, ParticleShape::Sphere.inertia(made.mass, radius)].map(f64::to_bits))
    };
    found.map(f64::to_bits) == expected.map(f64::to_bits)
        && clumps.shape[clump] == shape
        && spheres.len() == scene.clump_shapes[shape as usize].spheres.len()
        && spheres.iter().enumerate().all(same)
}
