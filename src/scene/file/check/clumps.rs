//! Sets of clumps: where each is placed, and the spheres that follow.

use super::columns::ByName;
use super::named_tables::Named;
use super::place::Place;
use super::raw_tables::RawTables;
use super::set_reader::{ReadSet, SetReader, Unnumbered, of_all};
use crate::base::document::{Faults, Mistake};
use crate::base::quantity::{MaterialIndex, Positive};
use crate::scene::clump::{ClumpKeys, OrientationKey, spheres, unit};
use crate::scene::file::tables::{ListEntry, ParticlesTable};
use crate::scene::import::{self, Bodies, Request, Rows};
use crate::scene::packing::generator::{generator, uniform};
use crate::scene::packing::{self, PackingProgress};
use crate::scene::{Clump, ClumpShape, Particle, Source};
use std::collections::BTreeMap;

/// Columns of a file that say how a clump is turned.
const TURN: [&str; 4] = ["qw", "qx", "qy", "qz"];

/// How far a mass of a file may be from what the clump's table says: texts have six digits.
const OF_DIGITS: f64 = 1e-5;

/// Clumps of a set, where they stand in its text or file, and the further columns of its file.
type Read = (Vec<Placed>, Place, ByName);

/// How large a clump is.
#[derive(Clone, Copy)]
enum Size {
    /// All lengths over those of the shape.
    Scale(f64),
    /// Radius of the bounding sphere \[m\].
    Bounding(f64),
}

impl Size {
    /// All lengths over those of the shape.
    fn scale(self, shape: &ClumpShape) -> f64 {
        match self {
            Self::Scale(scale) => scale,
            Self::Bounding(radius) => radius / shape.bounding_radius(),
        }
    }
}

/// Where a clump is to be, and of what.
struct Placed {
    /// What its spheres are like; the position is that of the mass centre.
    like: Particle,
    /// How large.
    size: Size,
    /// How its own frame is turned.
    orientation: OrientationKey,
    /// Density, if it has one of its own \[kg/m³\].
    density: Option<f64>,
}

impl SetReader<'_> {
    /// Reads a set of clumps of this name; none where a mistake was reported.
    pub(super) fn clumps(
        &self,
        name: &str,
        source: &Source,
        extra: &[String],
        faults: &mut Faults,
        tell: &mut dyn FnMut(PackingProgress),
    ) -> Option<ReadSet> {
        let before = faults.count();
        let Some(index) = self.keys.iter().position(|(known, _)| known == name) else {
            let known = self.keys.iter().map(|(name, _)| name.clone()).collect();
            faults.add(&self.table, "clump", Mistake::UnknownName { found: name.to_owned(), kind: "clump", known });
            return None;
        };
        let (shape, keys) = (&self.shapes[index], &self.keys[index].1);
        let (placed, place, columns) = self.placed((keys, shape), source, extra, faults, tell)?;
        if shape.mass.is_some() && placed.iter().any(|it| it.density.is_some()) {
            let what = format!("[clump.{name}] has a mass");
            let expected = "leave density out".to_owned();
            faults.add(&self.table, "density", Mistake::InvalidCombination { what, expected });
        }
        let all = (placed.len() * shape.spheres.len()) as f64;
        if let Some(expected) = packing::too_many(all) {
            faults.add(&self.table, "clump", Mistake::Unexpected { found: format!("{all} spheres"), expected });
        }
        if faults.count() > before {
            return None;
        }
        let mut random = generator(self.seed, &format!("{}.orientation", self.table));
        let (mut particles, mut clumps, mut rows) = (Vec::new(), Vec::new(), Vec::new());
        for (row, Placed { like, size, orientation, density }) in placed.into_iter().enumerate() {
            let scale = size.scale(shape);
            let turn = orientation.turn(shape, &mut || uniform(&mut random));
            let density = density.or(keys.density.map(Positive::get)).unwrap_or(like.density);
            let motion = [like.velocity, like.angular_velocity];
            let clump = Clump::of((shape, index as u32), (scale, density), (like.position, turn), motion);
            for particle in spheres(&clump, shape, &like) {
                particles.push(Unnumbered { id: None, is_of_clump: true, particle });
                rows.push(row);
            }
            clumps.push(clump);
        }
        // Damping and messages ask by sphere.
        let by_sphere = |column: Vec<f64>| rows.iter().map(|&row| column[row]).collect();
        let columns = columns.into_iter().map(|(name, column)| (name, by_sphere(column))).collect();
        let place = match place {
            Place::File(file, lines, around) => {
                let lines = if lines.is_empty() { lines } else { rows.iter().map(|&row| lines[row]).collect() };
                Place::File(file, lines, around)
            }
            other => other,
        };
        Some((particles, clumps, place, columns))
    }

    /// Where the clumps of the set are to be.
    fn placed(
        &self,
        (keys, shape): (&ClumpKeys, &ClumpShape),
        source: &Source,
        extra: &[String],
        faults: &mut Faults,
        tell: &mut dyn FnMut(PackingProgress),
    ) -> Option<Read> {
        let ParticlesTable { list, file, lattice, packing, .. } = self.written;
        let fallback = self.clump_material(keys, faults);
        if let Some(list) = list {
            let columns = self.listed_columns(faults);
            return Some((self.listed_clumps(list, fallback, faults), Place::Nowhere, columns));
        }
        if let Some(file) = file {
            return self.filed_clumps(file, (fallback, shape), source, extra, faults);
        }
        let bounding = match (lattice, packing) {
            (Some(lattice), _) => packing::lattice(lattice),
            (_, Some(packing)) => packing::packing(packing, self.cell, (self.seed, &self.table), tell),
            (None, None) => Ok(Vec::new()),
        };
        let bounding = bounding.map_err(|(key, mistake)| faults.add(&self.table, key, mistake)).ok()?;
        let Some(material) = fallback else {
            self.no_material(faults);
            return None;
        };
        let placed = bounding.into_iter().map(|(position, radius)| {
            self.like(self.particle(material, position, radius), Size::Bounding(radius), None)
        });
        Some((placed.collect(), Place::Nowhere, BTreeMap::new()))
    }

    /// The material of clumps that name none.
    fn clump_material(&self, keys: &ClumpKeys, faults: &mut Faults) -> Option<MaterialIndex> {
        if self.written.material.is_some() {
            return self.fallback(faults);
        }
        let name = keys.material.as_ref()?;
        let table = format!("clump.{}", self.written.clump.as_deref().unwrap_or_default());
        super::contacts::material_index(self.materials, name, &table, "material", faults)
    }

    /// A clump with what the set says of all.
    fn like(&self, like: Particle, size: Size, orientation: Option<OrientationKey>) -> Placed {
        let own = orientation.or(self.written.orientation);
        Placed {
            like,
            size,
            orientation: own.unwrap_or(OrientationKey::Turned([1.0, 0.0, 0.0, 0.0])),
            density: self.written.density.map(Positive::get),
        }
    }

    /// Clumps written one by one.
    fn listed_clumps(&self, list: &[ListEntry], fallback: Option<MaterialIndex>, faults: &mut Faults) -> Vec<Placed> {
        self.tell_unread(|key| of_all(list, key), faults);
        let mut placed = Vec::new();
        for (row, entry) in list.iter().enumerate() {
            let at = |key: &str| format!("list.{}.{key}", row + 1);
            let material = match &entry.material {
                Some(name) => self.material(name, &at("material"), faults),
                None => fallback,
            };
            let Some(material) = material else {
                if entry.material.is_none() && fallback.is_none() {
                    self.no_material(faults);
                    break;
                }
                continue;
            };
            if entry.id.is_some() {
                let (what, expected) = ("spheres of clumps get their numbers by themselves", "leave it out");
                let mistake = Mistake::InvalidCombination { what: what.to_owned(), expected: expected.to_owned() };
                faults.add(&self.table, &at("id"), mistake);
            }
            let size = match (entry.scale, entry.radius) {
                (Some(_), Some(_)) => {
                    let (found, expected) = ("scale and radius".to_owned(), "one of them".to_owned());
                    faults.add(&self.table, &at("scale"), Mistake::Unexpected { found, expected });
                    continue;
                }
                (Some(scale), None) => Size::Scale(scale.get()),
                (None, Some(radius)) => Size::Bounding(radius.get()),
                (None, None) => Size::Scale(1.0),
            };
            let mut like = self.particle(material, entry.position.get(), 0.0);
            like.velocity = entry.velocity.map_or(like.velocity, |it| it.get());
            like.angular_velocity = entry.angular_velocity.map_or(like.angular_velocity, |it| it.get());
            let mut one = self.like(like, size, entry.orientation);
            one.density = entry.density.map(Positive::get).or(one.density);
            placed.push(one);
        }
        placed
    }

    /// Whether the rows of a file are clumps of one shape, of which each says once how large it is.
    fn of_one_shape(&self, file: &str, rows: &Rows, faults: &mut Faults) -> bool {
        let mut wrong = |row: usize, key: &str, found: String, expected: &str| {
            let mistake = Mistake::Unexpected { found, expected: expected.to_owned() };
            faults.in_file(file, rows.line(row), &self.table, key, mistake);
            false
        };
        let several = |names: [&str; 2]| names.iter().all(|name| rows.columns.contains_key(*name));
        if let Some([a, b]) = [["radius", "scale"], ["density", "mass"]].into_iter().find(|names| several(*names)) {
            return wrong(0, b, format!("both columns {a} and {b}"), "one of them");
        }
        let shapes = rows.columns.get("shape").map_or(&[][..], Vec::as_slice);
        match shapes.iter().position(|shape| *shape != shapes[0]) {
            Some(row) => {
                let found = format!("shape {} beside shape {}", shapes[row], shapes[0]);
                wrong(row, "shape", found, "clumps of one shape: the set names one, so each shape needs its own file")
            }
            None => true,
        }
    }

    /// Clumps from the rows of a file.
    fn filed_clumps(
        &self,
        file: &str,
        (fallback, shape): (Option<MaterialIndex>, &ClumpShape),
        source: &Source,
        extra: &[String],
        faults: &mut Faults,
    ) -> Option<Read> {
        let mut rows = self.read_file(file, source, extra, faults)?;
        if !self.of_one_shape(file, &rows, faults) {
            return None;
        }
        let by_label = if rows.label.is_empty() {
            self.refuse_materials(faults);
            vec![fallback]
        } else {
            self.labelled(file, &rows, faults)
        };
        if rows.label.is_empty() && fallback.is_none() {
            self.no_material(faults);
            return None;
        }
        let column = |name: &str| rows.columns.get(name);
        let three = |names: [&str; 3], row: usize| {
            let columns = names.map(column);
            columns.iter().any(Option::is_some).then(|| columns.map(|column| column.map_or(0.0, |it| it[row])))
        };
        let turned = TURN.map(column);
        if turned.iter().any(Option::is_some) && !turned.iter().all(Option::is_some) {
            let found = "some of qw, qx, qy, qz".to_owned();
            let mistake = Mistake::Unexpected { found, expected: "all four columns, or none".to_owned() };
            faults.in_file(file, Some(1), &self.table, "", mistake);
            return None;
        }
        let own = |key: &str| match key {
            "material" => !rows.label.is_empty(),
            "density" => column("density").is_some() || column("mass").is_some(),
            "velocity" => ["vx", "vy", "vz"].into_iter().any(|name| column(name).is_some()),
            "angular_velocity" => ["wx", "wy", "wz"].into_iter().any(|name| column(name).is_some()),
            _ => turned.iter().all(Option::is_some),
        };
        self.tell_unread(own, faults);
        let mut placed = Vec::with_capacity(rows.count);
        for row in 0..rows.count {
            let material = by_label[if rows.label.is_empty() { 0 } else { rows.label[row] as usize }]?;
            let mut wrong = |key: &str, found: String, expected: &str| {
                let mistake = Mistake::Unexpected { found, expected: expected.to_owned() };
                faults.in_file(file, rows.line(row), &self.table, key, mistake);
            };
            let number = |name: &str| column(name).map(|column| column[row]);
            let keys = ["radius", "scale", "density", "mass"];
            if let Some(key) = keys.into_iter().find(|key| number(key).is_some_and(|value| value <= 0.0)) {
                wrong(key, format!("{:?}", number(key).unwrap_or(0.0)), "a number above 0");
                return None;
            }
            let radius = number("radius").unwrap_or(0.0);
            let size = number("scale").map_or(Size::Bounding(radius), Size::Scale);
            let scale = size.scale(shape);
            // Of a shape whose density is one.
            let light = shape.mass.unwrap_or(shape.volume) * (scale * scale * scale);
            let density = match (shape.mass, number("mass")) {
                (Some(_), Some(mass)) if (mass - light).abs() > OF_DIGITS * light => {
                    wrong("mass", format!("{mass:?} kg"), &format!("{light:?} kg, which [clump] says of this size"));
                    return None;
                }
                (None, Some(mass)) => Some(mass / light),
                (_, _) => number("density"),
            };
            if column("id").is_some() {
                wrong("id", "a column id".to_owned(), "none: spheres of clumps get their numbers by themselves");
                return None;
            }
            let mut orientation = None;
            if let [Some(w), Some(x), Some(y), Some(z)] = turned {
                let Some(unit) = unit([w[row], x[row], y[row], z[row]]) else {
                    wrong("qw", "a quaternion of zeros".to_owned(), "a quaternion qw, qx, qy, qz that is not zero");
                    return None;
                };
                orientation = Some(OrientationKey::Turned(unit));
            }
            let mut like = self.particle(material, three(["x", "y", "z"], row)?, radius);
            like.velocity = three(["vx", "vy", "vz"], row).unwrap_or(like.velocity);
            like.angular_velocity = three(["wx", "wy", "wz"], row).unwrap_or(like.angular_velocity);
            let mut one = self.like(like, size, orientation);
            one.density = density.or(one.density);
            placed.push(one);
        }
        let columns = self.further_columns(file, &mut rows, extra, faults);
        Some((placed, Place::File(file.to_owned(), rows.lines, rows.around), columns))
    }
}

/// Tells clumps that nothing places or lets come, and what all that do say themselves.
pub(super) fn tell_unread(written: &RawTables, faults: &mut Faults) {
    for (name, keys) in &written.clumps {
        let table = format!("clump.{name}");
        let sets: Vec<_> = (written.particles.iter().map(|(_, set)| set))
            .filter(|set| set.clump.as_deref() == Some(name.as_str()))
            .collect();
        let inflows: Vec<_> = (written.insertions.iter().map(|(_, keys)| keys))
            .filter(|keys| keys.sizes.clumps().contains(name))
            .collect();
        if sets.is_empty() && inflows.is_empty() {
            faults.unread(&table, "spheres", "no set or insertion has such clumps");
            continue;
        }
        let listed = |set: &ParticlesTable, key: &str| set.list.as_ref().is_some_and(|list| of_all(list, key));
        let material = |set: &&ParticlesTable| set.material.is_some() || listed(set, "material");
        let density = |set: &&ParticlesTable| set.density.is_some() || listed(set, "density");
        let bring_material = inflows.iter().all(|keys| keys.material.is_some());
        let own = [
            ("material", keys.material.is_some() && sets.iter().all(material) && bring_material),
            ("density", keys.density.is_some() && sets.iter().all(density) && inflows.is_empty()),
        ];
        for (key, _) in own.into_iter().filter(|(_, own)| *own) {
            faults.unread(&table, key, "all that place such clumps have their own");
        }
    }
}

/// Reads the shapes of clumps.
pub(super) fn shapes(written: &Named<ClumpKeys>, source: &Source, faults: &mut Faults) -> Vec<ClumpShape> {
    let mut shapes = Vec::new();
    for (name, keys) in written {
        let table = format!("clump.{name}");
        let before = faults.count();
        let filed = keys.file.as_ref().and_then(|file| filed_spheres(file, &table, source, faults));
        if faults.count() == before {
            shapes.extend(keys.shape(name, filed, &mut |key, mistake| faults.add(&table, key, mistake)));
        }
    }
    shapes
}

/// The spheres that a file of a clump's table has: centres and radii \[m\].
fn filed_spheres(file: &str, table: &str, source: &Source, faults: &mut Faults) -> Option<Vec<([f64; 3], f64)>> {
    let bodies = Bodies::SpheresOfClump;
    let request = Request { file, bodies, extra: &[], format: None, units: None, timestep: None };
    let read = import::read(source.files.get(file)?, &request);
    let rows = read.map_err(|list| {
        list.into_iter().for_each(|fault| faults.in_file(file, fault.line, table, &fault.column, fault.mistake));
    });
    let rows = rows.ok()?;
    faults.left_out(table, file, &rows.left_out);
    if rows.labels.len() > 1 {
        let (found, expected) = (format!("spheres of {} materials", rows.labels.len()), "those of one".to_owned());
        faults.in_file(file, Some(1), table, &rows.label_column, Mistake::Unexpected { found, expected });
        return None;
    }
    if let Some(column) = rows.columns.keys().find(|name| name.starts_with(['d', 'm', 'v', 'w'])) {
        let (found, expected) = (format!("a column {column}"), "x, y, z, radius: a clump moves as a whole".to_owned());
        faults.in_file(file, Some(1), table, column, Mistake::Unexpected { found, expected });
        return None;
    }
    let [x, y, z, radius] = ["x", "y", "z", "radius"].map(|name| &rows.columns[name]);
    if let Some(row) = radius.iter().position(|radius| *radius <= 0.0) {
        let (found, expected) = (format!("{:?}", radius[row]), "a number above 0".to_owned());
        faults.in_file(file, rows.line(row), table, "radius", Mistake::Unexpected { found, expected });
        return None;
    }
    Some((0..rows.count).map(|row| ([x[row], y[row], z[row]], radius[row])).collect())
}
