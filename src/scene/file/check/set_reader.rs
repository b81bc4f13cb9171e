//! The particles of one set, before they have numbers.

use super::columns::ByName;
use super::contacts::unknown_material;
use super::named_tables::Named;
use super::place::Place;
use crate::base::document::Faults;
use crate::base::document::Mistake;
use crate::base::geometry::Lattice;
use crate::base::quantity::{MaterialIndex, ParticleId, SetIndex};
use crate::laws::column::Column;
use crate::laws::contact::Material;
use crate::scene::Source;
use crate::scene::clump::ClumpKeys;
use crate::scene::file::tables::{ListEntry, ParticlesTable, Triple};
use crate::scene::import::{self, Bodies, REPORTED, Request, Rows};
use crate::scene::packing::{self, PackingProgress, Packings, made};
use crate::scene::{Clump, ClumpShape, Particle, ParticleShape};
use std::collections::BTreeMap;

/// A particle whose number is not yet known.
pub(super) struct Unnumbered {
    /// Its number, if the scene gives one.
    pub(super) id: Option<u32>,
    /// Whether it is a sphere of a clump.
    pub(super) is_of_clump: bool,
    /// The rest; its number means nothing.
    pub(super) particle: Particle,
}

/// One set while it is read.
pub(super) struct SetReader<'a> {
    /// Its table, as `particles.beam`.
    pub(super) table: String,
    /// Its index.
    pub(super) set: SetIndex,
    /// What is written.
    pub(super) written: &'a ParticlesTable,
    /// All materials.
    pub(super) materials: &'a [Material],
    /// The cell that repeats, if there is a sound one.
    pub(super) cell: Option<Lattice>,
    /// The scene's seed.
    pub(super) seed: u64,
    /// What all particles are.
    pub(super) shape: ParticleShape,
    /// Shapes of clumps.
    pub(super) shapes: &'a [ClumpShape],
    /// What is written about each of them.
    pub(super) keys: &'a Named<ClumpKeys>,
    /// Columns that the scene asks for.
    pub(super) columns: &'a [&'static Column],
    /// Random packings that were made before.
    pub(super) made: &'a Packings,
}

/// The particles of a set, the clumps that they are spheres of, their place, and the columns that damping or the scene asks for.
pub(super) type ReadSet = (Vec<Unnumbered>, Vec<Clump>, Place, ByName);

impl SetReader<'_> {
    /// Reads the set.
    pub(super) fn read(
        &self,
        source: &Source,
        extra: &[String],
        faults: &mut Faults,
        tell: &mut dyn FnMut(PackingProgress),
    ) -> ReadSet {
        let nobody = (Vec::new(), Vec::new(), Place::Nowhere, BTreeMap::new());
        if !self.has_one_origin(faults) {
            return nobody;
        }
        if let Some(name) = &self.written.clump {
            return self.clumps(name, source, extra, faults, tell).unwrap_or(nobody);
        }
        let ParticlesTable { list, file, lattice, packing, .. } = self.written;
        if let Some(list) = list {
            return (self.listed(list, faults), Vec::new(), Place::List, self.listed_columns(faults));
        }
        if let Some(file) = file {
            return self.filed(file, source, extra, faults);
        }
        if let Some(spheres) = self.packed().and_then(|made_of| self.made.get(made_of)) {
            return (self.generated(spheres, faults), Vec::new(), Place::Nowhere, BTreeMap::new());
        }
        let spheres = match (lattice, packing) {
            (Some(lattice), _) => packing::lattice(lattice),
            (_, Some(packing)) => packing::packing(packing, self.cell, (self.seed, &self.table), tell),
            (None, None) => Ok(Vec::new()),
        };
        match spheres {
            Ok(spheres) => (self.generated(&spheres, faults), Vec::new(), Place::Nowhere, BTreeMap::new()),
            Err((key, mistake)) => {
                faults.add(&self.table, key, mistake);
                nobody
            }
        }
    }

    /// The digest of what decides its random packing, if it is one of spheres.
    pub(super) fn packed(&self) -> Option<u64> {
        let packing = self.written.packing.as_ref().filter(|_| self.written.clump.is_none())?;
        Some(made::digest(packing, self.cell, self.seed, &self.table))
    }

    /// Whether the set says once where its particles come from, and nothing that belongs to another origin.
    fn has_one_origin(&self, faults: &mut Faults) -> bool {
        let written = self.written;
        let origins = [
            ("list", written.list.is_some()),
            ("file", written.file.is_some()),
            ("lattice", written.lattice.is_some()),
            ("packing", written.packing.is_some()),
        ];
        let given: Vec<&str> = origins.into_iter().filter(|(_, given)| *given).map(|(name, _)| name).collect();
        match given[..] {
            [_] => {}
            [] => {
                let expected = "one of list, file, lattice, packing says where its particles come from".to_owned();
                faults.add(&self.table, "", Mistake::Missing { expected });
                return false;
            }
            [_, second, ..] => {
                let (found, expected) = (given.join(" and "), "one origin of the particles".to_owned());
                faults.add(&self.table, second, Mistake::Unexpected { found, expected });
                return false;
            }
        }
        let of_files = [
            ("format", written.format.is_some()),
            ("units", written.units.is_some()),
            ("timestep", written.timestep.is_some()),
            ("materials", !written.materials.is_empty()),
        ];
        for (key, _) in of_files.into_iter().filter(|(_, given)| *given && written.file.is_none()) {
            let (what, expected) = ("this is about a file, and there is none".to_owned(), "leave it out".to_owned());
            faults.add(&self.table, key, Mistake::InvalidCombination { what, expected });
        }
        if written.orientation.is_some() && written.clump.is_none() {
            let (what, expected) =
                ("spheres have no orientation".to_owned(), "clump = \"..\" beside it, or leave it out".to_owned());
            faults.add(&self.table, "orientation", Mistake::InvalidCombination { what, expected });
        }
        true
    }

    /// Particles that are only spheres.
    fn generated(&self, spheres: &[([f64; 3], f64)], faults: &mut Faults) -> Vec<Unnumbered> {
        if self.written.material.is_none() {
            self.no_material(faults);
        }
        let Some(material) = self.fallback(faults) else { return Vec::new() };
        let newborn = |(position, radius): &([f64; 3], f64)| Unnumbered {
            id: None,
            is_of_clump: false,
            particle: self.particle(material, *position, *radius),
        };
        spheres.iter().map(newborn).collect()
    }

    /// Particles written one by one.
    fn listed(&self, list: &[ListEntry], faults: &mut Faults) -> Vec<Unnumbered> {
        let fallback = self.fallback(faults);
        self.tell_unread(|key| of_all(list, key), faults);
        let mut newborn = Vec::new();
        for (row, entry) in list.iter().enumerate() {
            let material = match &entry.material {
                Some(name) => self.material(name, &format!("list.{}.material", row + 1), faults),
                None => fallback,
            };
            let Some(material) = material else {
                if entry.material.is_none() && self.written.material.is_none() {
                    self.no_material(faults);
                    break;
                }
                continue;
            };
            let Some(radius) = entry.radius.filter(|_| entry.scale.is_none() && entry.orientation.is_none()) else {
                self.no_sphere(row, entry, faults);
                break;
            };
            let mut particle = self.particle(material, entry.position.0, radius.get());
            let or = |own: Option<Triple>, otherwise| own.map_or(otherwise, |own| own.0);
            particle.density = entry.density.map_or(particle.density, crate::base::quantity::Positive::get);
            particle.velocity = or(entry.velocity, particle.velocity);
            particle.angular_velocity = or(entry.angular_velocity, particle.angular_velocity);
            newborn.push(Unnumbered { id: entry.id, is_of_clump: false, particle });
        }
        newborn
    }

    /// Particles from a file.
    fn filed(&self, file: &str, source: &Source, extra: &[String], faults: &mut Faults) -> ReadSet {
        match self.read_file(file, source, extra, faults) {
            Some(rows) => self.rows(file, rows, extra, faults),
            None => (Vec::new(), Vec::new(), Place::Nowhere, BTreeMap::new()),
        }
    }

    /// The rows of a file.
    pub(super) fn read_file(&self, file: &str, source: &Source, extra: &[String], faults: &mut Faults) -> Option<Rows> {
        let bytes = source.files.get(file)?;
        let ParticlesTable { format, units, timestep, .. } = *self.written;
        let bodies = if self.written.clump.is_some() { Bodies::Clumps } else { Bodies::Particles(self.shape) };
        let list = match import::read(bytes, &Request { file, bodies, extra, format, units, timestep }) {
            Ok(rows) => {
                faults.left_out(&self.table, file, &rows.left_out);
                return Some(rows);
            }
            Err(list) => list,
        };
        for fault in list {
            // What the scene says about the file is mistaken in the scene.
            if ["units", "timestep"].contains(&fault.column.as_str()) {
                faults.add(&self.table, &fault.column, fault.mistake);
                continue;
            }
            faults.in_file(file, fault.line, &self.table, &fault.column, fault.mistake);
        }
        None
    }

    /// Reports what makes an entry of a list no sphere.
    fn no_sphere(&self, row: usize, entry: &ListEntry, faults: &mut Faults) {
        let at = |key: &str| format!("list.{}.{key}", row + 1);
        if entry.radius.is_none() {
            let expected = "this table needs it".to_owned();
            faults.add(&self.table, &at("radius"), Mistake::Missing { expected });
        }
        for (key, given) in [("scale", entry.scale.is_some()), ("orientation", entry.orientation.is_some())] {
            if given {
                let (what, expected) = ("it is a key of clumps", "clump = \"..\" in this table, or leave it out");
                let mistake = Mistake::InvalidCombination { what: what.to_owned(), expected: expected.to_owned() };
                faults.add(&self.table, &at(key), mistake);
            }
        }
    }

    /// Particles from the rows of a file.
    fn rows(&self, file: &str, mut rows: Rows, extra: &[String], faults: &mut Faults) -> ReadSet {
        let before = faults.count();
        let materials = self.labelled(file, &rows, faults);
        let mut newborn = Vec::with_capacity(rows.count);
        let column = |name: &str| rows.columns.get(name).map(Vec::as_slice);
        let triple = |names: [&str; 3]| match names.map(column) {
            [None, None, None] => None,
            columns => Some(columns),
        };
        let at =
            |columns: [Option<&[f64]>; 3], row: usize| columns.map(|column| column.map_or(0.0, |column| column[row]));
        let (position, radius) = (triple(["x", "y", "z"]), column("radius"));
        let (velocity, spin) = (triple(["vx", "vy", "vz"]), triple(["wx", "wy", "wz"]));
        let (id, density) = (column("id"), column("density"));
        let own = |key: &str| match key {
            "material" => !rows.label.is_empty(),
            "density" => density.is_some(),
            "velocity" => velocity.is_some(),
            _ => spin.is_some(),
        };
        self.tell_unread(own, faults);
        for row in 0..rows.count {
            let material = materials[if rows.label.is_empty() { 0 } else { rows.label[row] as usize }];
            let (Some(material), Some(position), Some(radius)) = (material, position, radius) else { break };
            let mut particle = self.particle(material, at(position, row), radius[row]);
            particle.density = density.map_or(particle.density, |density| density[row]);
            particle.velocity = velocity.map_or(particle.velocity, |velocity| at(velocity, row));
            particle.angular_velocity = spin.map_or(particle.angular_velocity, |spin| at(spin, row));
            let number = id.map(|id| id[row]);
            for (key, found, expected, fine) in [
                ("radius", particle.radius, "a number above 0", particle.radius > 0.0),
                ("density", particle.density, "a number above 0", particle.density > 0.0),
                ("id", number.unwrap_or(0.0), "a whole number from 0 to 4294967295", whole(number)),
            ] {
                if !fine && faults.count() < before + REPORTED {
                    let found = if key == "id" { format!("{found}") } else { format!("{found:?}") };
                    let mistake = Mistake::Unexpected { found, expected: expected.to_owned() };
                    faults.in_file(file, rows.line(row), &self.table, key, mistake);
                }
            }
            newborn.push(Unnumbered { id: number.map(|number| number as u32), is_of_clump: false, particle });
        }
        let columns = self.further_columns(file, &mut rows, extra, faults);
        (newborn, Vec::new(), Place::File(file.to_owned(), rows.lines, rows.around), columns)
    }

    /// What a file has of the columns that damping or the scene asks for.
    pub(super) fn further_columns(&self, file: &str, rows: &mut Rows, extra: &[String], faults: &mut Faults) -> ByName {
        let mut columns: ByName = extra.iter().filter_map(|name| rows.columns.remove_entry(name)).collect();
        let mut report = |row, key: &str, mistake| faults.in_file(file, rows.line(row), &self.table, key, mistake);
        self.filed_columns(&mut columns, &mut report);
        for column in self.columns {
            self.tell_unread_column(column, columns.contains_key(column.name), faults);
        }
        columns
    }

    /// The material of each label of a file; of the set, if the file has none.
    pub(super) fn labelled(&self, file: &str, rows: &Rows, faults: &mut Faults) -> Vec<Option<MaterialIndex>> {
        if rows.label.is_empty() {
            if self.written.material.is_none() && rows.count > 0 {
                self.no_material(faults);
            }
            self.refuse_materials(faults);
            return vec![self.fallback(faults)];
        }
        for (label, _) in self.written.materials.iter().filter(|(label, _)| !rows.labels.contains(label)) {
            faults.unread(&self.table, &format!("materials.{label}"), &format!("{file} has none of it"));
        }
        let before = faults.count();
        let mut found = Vec::new();
        for (index, label) in rows.labels.iter().enumerate() {
            let mapped = self.written.materials.get(label);
            let material = match mapped {
                Some(name) => self.material(name, &format!("materials.{label}"), faults),
                None => {
                    self.materials.iter().position(|material| material.name == *label).map(|i| MaterialIndex(i as u32))
                }
            };
            if material.is_none() && mapped.is_none() && faults.count() < before + REPORTED {
                let row = rows.label.iter().position(|label| *label as usize == index).unwrap_or(0);
                let mistake = match label.parse::<i64>() {
                    Ok(_) => Mistake::Unexpected {
                        found: format!("type {label}"),
                        expected: format!("a type named in materials, as materials = {{ {label} = \"..\" }}"),
                    },
                    Err(_) => unknown_material(self.materials, label),
                };
                faults.in_file(file, rows.line(row), &self.table, &rows.label_column, mistake);
            }
            found.push(material);
        }
        found
    }

    /// Refuses materials by type of a file that has no types.
    pub(super) fn refuse_materials(&self, faults: &mut Faults) {
        if !self.written.materials.is_empty() {
            let (what, expected) = ("the file names no materials or types", "leave it out");
            let mistake = Mistake::InvalidCombination { what: what.to_owned(), expected: expected.to_owned() };
            faults.add(&self.table, "materials", mistake);
        }
    }

    /// A particle of which only this is known.
    pub(super) fn particle(&self, material: MaterialIndex, position: [f64; 3], radius: f64) -> Particle {
        let own = self.written.density.map(crate::base::quantity::Positive::get);
        Particle {
            id: ParticleId(0),
            set: self.set,
            material,
            shape: self.shape,
            radius,
            density: own.unwrap_or(self.materials[material.index()].density),
            position,
            velocity: self.written.velocity.unwrap_or_default().0,
            angular_velocity: self.written.angular_velocity.unwrap_or_default().0,
        }
    }

    /// The set's own material.
    pub(super) fn fallback(&self, faults: &mut Faults) -> Option<MaterialIndex> {
        self.written.material.as_ref().and_then(|name| self.material(name, "material", faults))
    }

    /// Where a material stands.
    pub(super) fn material(&self, name: &str, key: &str, faults: &mut Faults) -> Option<MaterialIndex> {
        super::contacts::material_index(self.materials, name, &self.table, key, faults)
    }

    /// Tells keys that are for particles that have none of their own, where each has.
    pub(super) fn tell_unread(&self, own: impl Fn(&str) -> bool, faults: &mut Faults) {
        let ParticlesTable { material, density, velocity, angular_velocity, orientation, .. } = self.written;
        let written = [
            ("material", material.is_some()),
            ("density", density.is_some()),
            ("velocity", velocity.is_some()),
            ("angular_velocity", angular_velocity.is_some()),
            ("orientation", orientation.is_some()),
        ];
        for (key, _) in written.into_iter().filter(|(key, given)| *given && own(key)) {
            faults.unread(&self.table, key, "each of its particles has its own");
        }
    }

    /// Neither the set nor its particles say what they are made of.
    pub(super) fn no_material(&self, faults: &mut Faults) {
        let expected = "the name of a [material] table".to_owned();
        faults.add(&self.table, "material", Mistake::Missing { expected });
    }
}

/// Whether all entries of a list have a key of their own.
pub(super) fn of_all(list: &[ListEntry], key: &str) -> bool {
    list.iter().all(|entry| match key {
        "material" => entry.material.is_some(),
        "density" => entry.density.is_some(),
        "velocity" => entry.velocity.is_some(),
        "angular_velocity" => entry.angular_velocity.is_some(),
        _ => entry.orientation.is_some(),
    })
}

/// Whether a number can be a particle's.
fn whole(number: Option<f64>) -> bool {
    number.is_none_or(|number| number >= 0.0 && number <= f64::from(u32::MAX) && number == number.trunc())
}
