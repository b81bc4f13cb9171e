//! From particle sets as they are written to the particles of the scene.

use super::named_tables::Named;
use super::place::Place;
use super::raw_tables::RawTables;
use super::set_reader::{SetReader, Unnumbered};
use crate::base::document::Faults;
use crate::base::document::Mistake;
use crate::base::quantity::{ParticleId, SetIndex};
use crate::laws::column::Column;
use crate::laws::contact::Material;
use crate::scene::Source;
use crate::scene::cell::fault_of;
use crate::scene::file::tables::ParticlesTable;
use crate::scene::import::{FileBox, REPORTED};
use crate::scene::packing::{PackingProgress, Packings};
use crate::scene::{Clump, ClumpShape, Particle, Run, clump};
use std::collections::BTreeMap;

/// All particles, and where each comes from.
#[derive(Default)]
pub(super) struct ReadParticles {
    /// By ascending number.
    pub(super) particles: Vec<Particle>,
    /// Row in its set, of each.
    pub(super) rows: Vec<u32>,
    /// Shapes of clumps.
    pub(super) shapes: Vec<ClumpShape>,
    /// Clumps.
    pub(super) clumps: Vec<Clump>,
    /// Names of the sets.
    pub(super) sets: Vec<String>,
    /// Columns of each set that damping or the scene asks for.
    pub(super) columns: Vec<BTreeMap<String, Vec<f64>>>,
    /// Sets of spheres that a random packing made, and what decided it.
    pub(super) packed: Vec<(SetIndex, u64)>,
    /// Boxes that files say: table, file, box.
    pub(super) boxes: Vec<(String, String, FileBox)>,
}

/// Reads all sets.
pub(super) fn particles(
    written: &RawTables,
    source: &Source,
    (materials, asked): (&[Material], &[&'static Column]),
    faults: &mut Faults,
    (made, tell): (&Packings, &mut dyn FnMut(PackingProgress)),
) -> ReadParticles {
    let extra: Vec<String> = written
        .damping
        .iter()
        .filter_map(|(_, damping)| damping.scale.as_ref().and_then(|scale| scale.column.clone()))
        .collect();
    let cell = written.cell.as_ref().and_then(|keys| keys.cell(None, &mut |_, _| {})).map(|cell| cell.lattice);
    let cell = cell.filter(|lattice| fault_of(lattice).is_none());
    let seed = written.run.seed.unwrap_or(Run::default().seed);
    // Spheres of a packing, turned clumps and what comes are random.
    let is_random = |(_, set): &(String, ParticlesTable)| set.packing.is_some() || set.clump.is_some();
    if written.run.seed.is_some() && written.insertions.is_empty() && !written.particles.iter().any(is_random) {
        faults.unread("run", "seed", "nothing of this scene is random");
    }
    if written.run.skin.is_some() && written.contacts.is_empty() && written.bonds.is_empty() {
        faults.unread("run", "skin", "without contacts and bonds nothing looks for neighbours");
    }
    let shape = written.run.plane_particles.unwrap_or_default();
    let mut born = ReadParticles::default();
    let before = faults.count();
    born.shapes = super::clumps::shapes(&written.clumps, source, faults);
    if faults.count() > before {
        return born;
    }
    super::clumps::tell_unread(written, faults);
    let mut places = Vec::new();
    let mut newborn = Vec::new();
    for (index, (name, table)) in written.particles.iter().enumerate() {
        let set = SetIndex(index as u32);
        let reader = SetReader {
            table: format!("particles.{name}"),
            set,
            written: table,
            materials,
            cell,
            seed,
            shape,
            shapes: &born.shapes,
            keys: &written.clumps,
            columns: asked,
            made,
        };
        let extra: Vec<String> = extra.iter().cloned().chain(reader.names_in_files()).collect();
        let (list, clumps, place, columns) = reader.read(source, &extra, faults, tell);
        if let Place::File(file, _, Some(around)) = &place {
            born.boxes.push((reader.table.clone(), file.clone(), *around));
        }
        born.clumps.extend(clumps);
        newborn.extend((0..).zip(list));
        born.sets.push(name.clone());
        born.packed.extend(reader.packed().map(|made_of| (set, made_of)));
        born.columns.push(columns);
        places.push(place);
    }
    number(newborn, &mut born, &places, &written.particles, faults);
    born
}

/// Gives numbers to those who have none, above all given ones, and sorts by number.
fn number(
    newborn: Vec<(u32, Unnumbered)>,
    born: &mut ReadParticles,
    places: &[Place],
    sets: &Named<ParticlesTable>,
    faults: &mut Faults,
) {
    let mut next = newborn.iter().filter_map(|(_, newborn)| newborn.id).max().map_or(1, |id| u64::from(id) + 1);
    let mut all: Vec<(u64, u32, bool, Particle)> = Vec::with_capacity(newborn.len());
    for (row, newborn) in newborn {
        let id = newborn.id.map_or(next, u64::from);
        next += u64::from(newborn.id.is_none());
        all.push((id, row, newborn.is_of_clump, newborn.particle));
    }
    all.sort_by_key(|(id, ..)| *id);
    for two in all.windows(2).filter(|two| two[0].0 == two[1].0).take(REPORTED) {
        let (id, row, _, particle) = &two[1];
        let other = sets[two[0].3.set.index()].0.clone();
        let mistake = Mistake::DuplicateId { id: *id as u32, other };
        let set = particle.set.index();
        places[set].report(&format!("particles.{}", sets[set].0), *row as usize, "id", mistake, faults);
    }
    if let Some((id, ..)) = all.last().filter(|(id, ..)| *id > u64::from(u32::MAX)) {
        let expected = "numbers up to 4294967295".to_owned();
        faults.add("particles", "", Mistake::Unexpected { found: format!("particle {id}"), expected });
    }
    born.particles.reserve_exact(all.len());
    born.rows.reserve_exact(all.len());
    clump::number(&mut born.clumps, &born.shapes, all.iter().map(|(_, _, is_of_clump, _)| *is_of_clump));
    for (id, row, _, mut particle) in all {
        particle.id = ParticleId(id as u32);
        born.particles.push(particle);
        born.rows.push(row);
    }
}
