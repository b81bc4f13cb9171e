//! What must hold in any scene, read from a file or built in code.

use super::bonded_pairs::{Bonded, idle};
use super::finding::Finding;
use crate::base::document::Mistake;
use crate::base::quantity::ParticleId;
use crate::laws::bond::creation::ContactPolicy;
use crate::laws::contact::{Law, MaterialPair, Missing};
use crate::scene::cell::with_images;
use crate::scene::packing::overlaps::for_each_overlap;
use crate::scene::{AxisMotion, Boundary, ContactLaw, Outside, Particle, Probe, Probed, SceneDraft, plane_objections};
use std::collections::BTreeSet;

/// Whether each two materials that can touch have a law, and the law its properties.
pub(super) fn laws(scene: &SceneDraft) -> Vec<Finding> {
    let mut findings: Vec<Finding> = scene.contacts.iter().filter_map(objection).collect();
    if scene.contacts.is_empty() {
        return findings;
    }
    findings.extend(scene.contacts.iter().filter_map(|law| cannot_be_suppressed(scene, law)));
    let count = scene.materials.len();
    let mut told = BTreeSet::new();
    for (a, b) in touching(scene) {
        let (first, second) = (&scene.materials[a], &scene.materials[b]);
        let Some(law) = scene.contacts.iter().find(|law| law.between[a * count + b]) else {
            let mistake = Mistake::NoLaw { a: first.name.clone(), b: second.name.clone() };
            findings.push(Finding::at("contact".to_owned(), "", mistake));
            continue;
        };
        let pair = MaterialPair { a: first, b: second, properties: &scene.pairs[a * count + b] };
        for Missing { table, key } in law.choice.coefficients(&pair).err().unwrap_or_default() {
            if !told.insert((table.clone(), key)) {
                continue;
            }
            let expected = format!("[contact.{}] needs it for {} and {}", law.name, first.name, second.name);
            let (key, otherwise) = (key.to_owned(), format!("contact.{}", law.name));
            findings.push(Finding { table, key, otherwise, mistake: Mistake::Missing { expected } });
        }
    }
    findings
}

/// Pairs of materials (the first not after the second) of bodies that can touch.
fn touching(scene: &SceneDraft) -> Vec<(usize, usize)> {
    let count = scene.materials.len();
    let mut particles = vec![0_usize; count];
    for particle in &scene.particles {
        particles[particle.material.index()] += 1;
    }
    for insertion in &scene.insertions {
        particles[insertion.material.index()] += 2;
    }
    let mut walls = vec![false; count];
    for boundary in &scene.boundaries {
        if let Some(material) = boundary.shape.material() {
            walls[material.index()] = true;
        }
    }
    let touch = |a: usize, b: usize| match a == b {
        true => particles[a] > 1 || particles[a] > 0 && walls[a],
        false => particles[a] > 0 && (particles[b] > 0 || walls[b]) || particles[b] > 0 && walls[a],
    };
    (0..count).flat_map(|a| (a..count).map(move |b| (a, b))).filter(|(a, b)| touch(*a, *b)).collect()
}

/// What speaks against a law where a bond suppresses contacts: its normal force must be one that an offset can be taken from.
fn cannot_be_suppressed(scene: &SceneDraft, law: &ContactLaw) -> Option<Finding> {
    let bond = scene.bonds.iter().find(|bond| bond.keys.contact != ContactPolicy::Parallel)?;
    let composed = Law::of(&law.choice);
    if composed.takes_offset() {
        return None;
    }
    let (kind, model, why) = match composed.presses() {
        false => ("normal", law.choice.normal.name(), "adheres or remembers"),
        true => ("cohesion", law.choice.cohesion.name(), "acts beyond touch or remembers"),
    };
    let message = format!(
        "expected \"parallel\", or another {kind} model of [contact.{}] than {model}, which {why}, found \
         a policy that suppresses contacts",
        law.name,
    );
    Some(Finding::at(format!("bond.{}", bond.name), "contact", Mistake::Refused { message }))
}

/// What speaks against the combination of a law's sub-models and switches.
fn objection(law: &ContactLaw) -> Option<Finding> {
    let objection = law.choice.objection()?;
    let mut table = format!("contact.{}", law.name);
    if !objection.table.is_empty() {
        let model = match objection.table {
            "normal" => law.choice.normal.name(),
            "tangential" => law.choice.tangential.name(),
            "rolling" => law.choice.rolling.name(),
            _ => law.choice.cohesion.name(),
        };
        table = format!("{table}.{}.{model}", objection.table);
    }
    Some(Finding::at(table, objection.key, Mistake::Refused { message: objection.reason.to_owned() }))
}

/// Whether the particles are where they may be.
pub(super) fn places(scene: &SceneDraft) -> Vec<Finding> {
    let mut findings = Vec::new();
    outside(scene, &mut findings);
    findings.extend(numbers(scene));
    surfaces(scene, &mut findings);
    overlaps(scene, &mut findings);
    findings.extend(idle(scene));
    findings.extend(looks(scene));
    findings.extend(plane_objections(scene).into_iter().map(|(table, key, mistake)| Finding::at(table, key, mistake)));
    findings
}

/// Probes of what is not there, and sums that have no name of their own.
fn looks(scene: &SceneDraft) -> Vec<Finding> {
    let sets = scene.sets.len();
    let probes = scene.probes.iter().filter_map(|probe| {
        let (key, mistake) = probe.objection(&scene.particles, sets).or_else(|| of_one_clump(scene, probe))?;
        Some(Finding::at(format!("probe.{}", probe.name), key, mistake))
    });
    let derived =
        scene.derived.iter().filter(|derived| derived.name == "time" || derived.sum.is_empty()).map(|derived| {
            let (key, found, expected) = match derived.sum.is_empty() {
                true => ("sum", "none", "names of outputs"),
                false => ("", "that of the first column", "a name of its own"),
            };
            let mistake = Mistake::Unexpected { found: found.to_owned(), expected: expected.to_owned() };
            Finding::at(format!("derived.{}", derived.name), key, mistake)
        });
    probes.chain(derived).collect()
}

/// What speaks against a probe of a contact that never comes: of two spheres of one clump.
fn of_one_clump(scene: &SceneDraft, probe: &Probe) -> Option<(&'static str, Mistake)> {
    let Probed::Contact(ids) = probe.of else { return None };
    let clump = |id: ParticleId| {
        let place = scene.particles.binary_search_by_key(&id.0, |particle| particle.id.0).ok()? as u32;
        let behind = scene.clumps.partition_point(|clump| clump.first <= place);
        let clump = behind.checked_sub(1)?;
        let of = &scene.clumps[clump];
        (place - of.first < scene.clump_shapes[of.shape as usize].spheres.len() as u32).then_some(clump)
    };
    let [a, b] = ids.map(clump);
    (a.is_some() && a == b).then(|| {
        let found = format!("{} and {} of one clump", ids[0].0, ids[1].0);
        ("contact", Mistake::Unexpected { found, expected: "two particles that can touch".to_owned() })
    })
}

/// Particles whose mass or inertia no number holds, or which are so far away that numbers do not resolve their radius.
fn numbers(scene: &SceneDraft) -> Vec<Finding> {
    let holds = |value: f64| value.is_normal();
    let light = |particle: &&Particle| !holds(particle.mass()) || !holds(particle.inertia());
    let far = |particle: &&Particle| {
        let most = particle.position.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        most > Particle::farthest(particle.radius)
    };
    let table = |particle: &Particle| {
        scene.sets.get(particle.set.index()).map_or("particles".to_owned(), |set| format!("particles.{set}"))
    };
    let mut findings = Vec::new();
    if let Some(particle) = scene.particles.iter().find(light) {
        let (id, radius, mass, density) = (particle.id.0, particle.radius, particle.mass(), particle.density);
        let found = format!("{mass:?} kg of particle {id} of radius {radius:?} m and density {density:?} kg/m³");
        let expected = "a mass and a moment of inertia that 64 bits hold (about 1e-308 to 1e308)".to_owned();
        findings.push(Finding::at(table(particle), "", Mistake::Unexpected { found, expected }));
    }
    if let Some(particle) = scene.particles.iter().find(far) {
        let (id, position, radius) = (particle.id.0, particle.position, particle.radius);
        let found = format!("particle {id} of radius {radius:?} m at {position:?} m, where numbers are too coarse");
        let expected = format!("particles at most {:.1e} m from the origin", Particle::farthest(radius));
        findings.push(Finding::at(table(particle), "", Mistake::Unexpected { found, expected }));
    }
    findings
}

/// Particles outside the domain.
fn outside(scene: &SceneDraft, findings: &mut Vec<Finding>) {
    let Some([lower, upper]) = scene.domain.filter(|_| scene.outside == Outside::Stop) else { return };
    let inside = |position: &[f64; 3]| (0..3).all(|axis| (lower[axis]..=upper[axis]).contains(&position[axis]));
    let mut lost = scene.particles.iter().filter(|particle| !inside(&particle.position));
    if let Some(first) = lost.next() {
        let (id, position, more) = (first.id.0, first.position, lost.count());
        let mistake = Mistake::OutsideDomain { id, position, more };
        findings.push(Finding::at("domain".to_owned(), "box", mistake));
    }
}

/// Particles behind surfaces or too deep in them.
fn surfaces(scene: &SceneDraft, findings: &mut Vec<Finding>) {
    let permitted = scene.run.max_overlap;
    let fixed_groups = fixed_groups(scene);
    let in_cell = |place: [f64; 3]| scene.cell.map_or(place, |cell| cell.lattice.brought_back(place));
    for boundary in &scene.boundaries {
        let Some(material) = boundary.shape.material() else { continue };
        let fixed = is_fixed(boundary);
        let name = &boundary.name;
        let (mut behind, mut deep) = ((0.0, 0, 0), (0.0, 0, 0));
        for (index, particle) in scene.particles.iter().enumerate() {
            let Some(distance) = boundary.shape.distance(in_cell(particle.position).into()) else { continue };
            let overlap = 1.0 - distance / particle.radius;
            if distance < 0.0 {
                note(&mut behind, -distance, particle.id.0);
            } else if overlap > permitted
                && !(fixed && fixed_groups[index])
                && governed(scene, material.index(), particle.material.index())
            {
                note(&mut deep, overlap, particle.id.0);
            }
        }
        let table = format!("boundary.{name}");
        if let (depth, id, count @ 1..) = behind {
            let mistake = Mistake::BehindSurface { id, boundary: name.clone(), depth, more: count - 1 };
            findings.push(Finding::at(table, boundary.shape.key(), mistake));
        } else if let (overlap, id, count @ 1..) = deep {
            let mistake = Mistake::WallOverlap { id, boundary: name.clone(), overlap, permitted, more: count - 1 };
            findings.push(Finding::at(table, boundary.shape.key(), mistake));
        }
    }
}

/// Whether no axis of a boundary moves.
fn is_fixed(boundary: &Boundary) -> bool {
    boundary.axes.iter().all(AxisMotion::is_fixed)
}

/// Whether each particle belongs to a group that does not move; such a group may be built into a fixed plane.
fn fixed_groups(scene: &SceneDraft) -> Vec<bool> {
    let mut fixed = vec![false; scene.particles.len()];
    for boundary in scene.boundaries.iter().filter(|boundary| is_fixed(boundary)) {
        boundary.shape.members().iter().for_each(|member| fixed[*member as usize] = true);
    }
    fixed
}

/// Keeps the worst, its number, and how many there are.
fn note((worst, id, count): &mut (f64, u32, usize), value: f64, of: u32) {
    *count += 1;
    if value > *worst {
        (*worst, *id) = (value, of);
    }
}

/// Whether two materials have a contact law.
fn governed(scene: &SceneDraft, a: usize, b: usize) -> bool {
    scene.contacts.iter().any(|law| law.between[a * scene.materials.len() + b])
}

/// The rigid group or clump of each particle, counted from 1; 0 for free ones.
fn rigid_groups(scene: &SceneDraft) -> Vec<u32> {
    let mut group = vec![0; scene.particles.len()];
    for (number, boundary) in (1..).zip(&scene.boundaries) {
        boundary.shape.members().iter().for_each(|member| group[*member as usize] = number);
    }
    for (number, clump) in (1 + scene.boundaries.len() as u32..).zip(&scene.clumps) {
        group[scene.spheres_of(clump)].fill(number);
    }
    group
}

/// Particles too deep in one another.
fn overlaps(scene: &SceneDraft, findings: &mut Vec<Finding>) {
    if scene.contacts.is_empty() {
        return;
    }
    let group = rigid_groups(scene);
    let mut spheres: Vec<([f64; 3], f64)> =
        scene.particles.iter().map(|particle| (particle.position, particle.radius)).collect();
    let largest = spheres.iter().fold(0.0, |most: f64, (_, radius)| most.max(*radius));
    let originals = with_images(scene, &mut spheres, |radius| radius + largest);
    let permitted = scene.run.max_overlap;
    let bonded = Bonded::of(scene);
    let mut worst: Option<(f64, u32, u32, bool)> = None;
    let mut count = 0;
    for_each_overlap(&spheres, |i, j, overlap| {
        if i.min(j) as usize >= scene.particles.len() {
            return; // two images
        }
        let across = i.max(j) as usize >= scene.particles.len();
        let (i, j) = (originals[i as usize], originals[j as usize]);
        let (i, j) = (i.min(j) as usize, i.max(j) as usize);
        let (a, b) = (&scene.particles[i], &scene.particles[j]);
        let relative = overlap / a.radius.min(b.radius);
        let rigid = group[i] != 0 && group[i] == group[j];
        if relative <= permitted || rigid || !governed(scene, a.material.index(), b.material.index()) {
            return;
        }
        if bonded.holds(i, j, a.radius + b.radius - overlap) {
            return;
        }
        count += 1;
        // Ties go to the lower numbers, whatever the order of the search.
        let this = (relative, a.id.0, b.id.0, across);
        if worst.is_none_or(|(most, a, b, _)| relative > most || relative == most && (this.1, this.2) < (a, b)) {
            worst = Some(this);
        }
    });
    if let Some((overlap, a, b, across)) = worst {
        let set = scene
            .particles
            .iter()
            .find(|particle| particle.id.0 == b)
            .and_then(|particle| scene.sets.get(particle.set.index()));
        let table = set.map_or("particles".to_owned(), |set| format!("particles.{set}"));
        let mistake = Mistake::Overlap { a, b, overlap, permitted, across, more: count - 1 };
        findings.push(Finding::at(table, "", mistake));
    }
}
