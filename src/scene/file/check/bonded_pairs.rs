//! Which pairs are bonded at the start, and bond laws that bond no pair then.

use super::finding::Finding;
use crate::base::document::Mistake;
use crate::base::quantity::BoundaryIndex;
use crate::laws::bond::creation::Moment;
use crate::scene::cell::with_images;
use crate::scene::packing::overlaps::for_each_overlap;
use crate::scene::{Bond, Particle, SceneDraft};

/// Which pairs are bonded at the start, so that their overlap is not a mistake.
pub(super) struct Bonded<'a> {
    /// The scene.
    scene: &'a SceneDraft,
    /// Listed pairs, the lower index first, ascending.
    listed: Vec<[u32; 2]>,
}

impl<'a> Bonded<'a> {
    /// Those of a scene.
    pub(super) fn of(scene: &'a SceneDraft) -> Self {
        let pairs = scene.bonds.iter().flat_map(|bond| &bond.pairs);
        let mut listed: Vec<[u32; 2]> = pairs.map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
        listed.sort_unstable();
        Self { scene, listed }
    }

    /// Whether two particles (the lower index first) at this distance of the centres \[m\] are bonded.
    pub(super) fn holds(&self, a: usize, b: usize, distance: f64) -> bool {
        let sets = [a, b].map(|index| self.scene.particles[index].set);
        self.listed.binary_search(&[a as u32, b as u32]).is_ok()
            || self.scene.bonds.iter().any(|bond| {
                bond.keys.create.bonds_at_start()
                    && bond.joins(sets[0], sets[1])
                    && bond.create_distance().is_some_and(|most| distance < most)
            })
    }
}

/// Reports bond laws that bond no pair at the start, although they make their bonds then.
pub(super) fn idle(scene: &SceneDraft) -> Vec<Finding> {
    let waiting = |bond: &&Bond| bond.keys.create.bonds_near_pairs(&Moment::START);
    scene.bonds.iter().filter(waiting).filter_map(|bond| idle_law(scene, bond)).collect()
}

/// Whether this law bonds no particle to its plane.
fn idle_at_plane(scene: &SceneDraft, bond: &Bond, distance: f64, plane: BoundaryIndex) -> Option<Finding> {
    let plane = scene.boundaries.get(plane.index())?.shape.plane()?;
    let members = scene.particles.iter().filter(|particle| bond.between.contains(&particle.set));
    let away = |particle: &Particle| 2.0 * plane.height(particle.position);
    let closest = members.map(away).filter(|away| *away > 0.0).reduce(f64::min);
    if closest.is_some_and(|closest| closest < distance) {
        return None;
    }
    let expected = closest.map_or_else(
        || "a particle in front of the plane".to_owned(),
        |closest| format!("a distance above {closest:.3e}, twice that of the closest centre from the plane"),
    );
    let mistake = Mistake::Unexpected { found: format!("{distance:.3e}"), expected };
    Some(Finding::at(format!("bond.{}", bond.name), "create_distance", mistake))
}

/// Whether this law bonds no pair.
fn idle_law(scene: &SceneDraft, bond: &Bond) -> Option<Finding> {
    let distance = bond.create_distance()?;
    if let Some(plane) = bond.plane {
        return idle_at_plane(scene, bond, distance, plane);
    }
    let members: Vec<usize> =
        (0..scene.particles.len()).filter(|index| bond.between.contains(&scene.particles[*index].set)).collect();
    let of_clump = scene.clump_of_particles();
    let rigid = |[a, b]: [usize; 2]| of_clump.get(a).is_some_and(|of| of.is_some() && *of == of_clump[b]);
    let closest = |reach: f64| {
        let mut spheres: Vec<([f64; 3], f64)> =
            members.iter().map(|index| (scene.particles[*index].position, 0.5 * reach)).collect();
        let originals = with_images(scene, &mut spheres, |_| reach);
        let mut least = f64::INFINITY;
        for_each_overlap(&spheres, |i, j, overlap| {
            let pair = [i, j].map(|place| members[originals[place as usize] as usize]);
            let sets = pair.map(|index| scene.particles[index].set);
            if (i.min(j) as usize) < members.len() && bond.joins(sets[0], sets[1]) && !rigid(pair) {
                least = least.min(reach - overlap);
            }
        });
        least
    };
    let mut reach = distance;
    if closest(reach) < distance {
        return None;
    }
    // Looked for ever further out; beyond a millionfold nobody asks how far it is.
    let found = (0..20).find_map(|_| {
        reach *= 2.0;
        Some(closest(reach)).filter(|least| least.is_finite())
    });
    let mistake = Mistake::BondsNoPair { distance, closest: found };
    Some(Finding::at(format!("bond.{}", bond.name), "create_distance", mistake))
}
