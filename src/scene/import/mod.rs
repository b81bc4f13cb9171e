//! Particles from files: whatever the format, rows of numbers with the names that CSV columns have.

mod bodies;
mod csv;
mod data;
mod dump;
mod format;
mod multisphere;
mod vtu;

pub(crate) use bodies::{Bodies, CELL};
pub(crate) use format::{Format, Units};

use crate::base::document::{Mistake, told_columns};
use crate::base::geometry::Lattice;
use crate::base::memory;
use flate2::read::MultiGzDecoder;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;

/// Memory that a line of a text file takes as it is read, at least \[bytes\].
const ROW: u64 = 100;

/// The particles of a file.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    /// How many there are.
    pub(crate) count: usize,
    /// Numbers by column; every number is finite.
    pub(crate) columns: BTreeMap<String, Vec<f64>>,
    /// What the file calls the materials: names or types.
    pub(crate) labels: Vec<String>,
    /// Where each label stands.
    label_index: BTreeMap<String, u32>,
    /// Index into the labels, of each particle; empty if the file names no materials.
    pub(crate) label: Vec<u32>,
    /// The column that names materials.
    pub(crate) label_column: String,
    /// Line of each particle in the file; empty if the file has no lines.
    pub(crate) lines: Vec<u32>,
    /// The box around them, if the file says it.
    pub(crate) around: Option<FileBox>,
    /// What the file says and nothing reads: columns and sections by name.
    pub(crate) left_out: Vec<String>,
}

/// The box of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FileBox {
    /// Its corner and edges, and along which edges it repeats if the file says so \[m\].
    pub(crate) lattice: Lattice,
    /// Whether the file says along which edges it repeats.
    pub(crate) is_told: bool,
    /// The line that tells it, or the first one with a particle that crossed its faces; none in a file without lines.
    pub(crate) line: Option<usize>,
    /// Whether there is such a particle.
    pub(crate) is_crossed: bool,
}

impl FileBox {
    /// Whether particles of the file are in a cell that repeats.
    pub(crate) fn is_periodic(&self) -> bool {
        self.is_crossed || self.lattice.periodic != [false; 3]
    }
}

/// Numbers of a box as a file writes them.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    /// The lower corner.
    low: [f64; 3],
    /// The edges.
    edges: [[f64; 3]; 3],
}

impl Bounds {
    /// The box of these numbers at a line, if its edges are as a cell has them.
    fn lattice(self, line: Option<usize>) -> Result<Lattice, Vec<FileFault>> {
        let lattice = Lattice { origin: self.low, edges: self.edges, periodic: [false; 3] };
        match crate::scene::cell::fault_of(&lattice) {
            None => Ok(lattice),
            Some(expected) => {
                let found = format!("a box with edges {:?}", self.edges);
                let mistake = Mistake::Unexpected { found, expected: expected.to_owned() };
                Err(vec![FileFault { line, column: String::new(), mistake }])
            }
        }
    }
}

impl Rows {
    /// The line of a particle.
    pub(crate) fn line(&self, row: usize) -> Option<usize> {
        self.lines.get(row).map(|line| *line as usize)
    }

    /// Takes a column; diameters become radii.
    fn insert(&mut self, name: &str, mut column: Vec<f64>) {
        let name = match name {
            "diameter" => {
                column.iter_mut().for_each(|diameter| *diameter *= 0.5);
                "radius"
            }
            name => name,
        };
        self.columns.insert(name.to_owned(), column);
    }

    /// Takes what a column of a file says; if another one has said it before, they must agree.
    /// `tolerance`: by how much they may differ, beside the rounding of their own digits.
    fn insert_again(
        &mut self,
        name: &str,
        column: &str,
        numbers: Vec<f64>,
        tolerance: f64,
    ) -> Result<(), Vec<FileFault>> {
        let quantity = if name == "diameter" { "radius" } else { name };
        let first = self.columns.remove(quantity);
        self.insert(name, numbers);
        let (Some(first), Some(again)) = (first, self.columns.get(quantity)) else { return Ok(()) };
        agree(&first, again, tolerance + DIGITS * largest(&first), [quantity, column], &self.lines)?;
        self.columns.insert(quantity.to_owned(), first);
        Ok(())
    }

    /// Refuses labels of some particles only.
    fn expect_labels(&self) -> Result<(), Vec<FileFault>> {
        if self.label.is_empty() || self.label.len() == self.count {
            return Ok(());
        }
        let found = format!("{} materials for {} particles", self.label.len(), self.count);
        let mistake = Mistake::Unexpected { found, expected: "one for each".to_owned() };
        Err(vec![FileFault { line: None, column: self.label_column.clone(), mistake }])
    }

    /// Adds numbers to a column.
    fn extend(&mut self, name: &str, numbers: impl Iterator<Item = f64>) {
        self.columns.entry(name.to_owned()).or_default().extend(numbers);
    }

    /// Notes what the file calls the material of the next particle.
    fn push_label(&mut self, name: &str) {
        let last = self.label.last().copied().filter(|index| self.labels[*index as usize] == name);
        let index = last.or_else(|| self.label_index.get(name).copied()).unwrap_or_else(|| {
            let index = self.labels.len() as u32;
            self.labels.push(name.to_owned());
            self.label_index.insert(name.to_owned(), index);
            index
        });
        self.label.push(index);
    }
}

/// How far two columns that say the same may be apart: texts with six digits, as a part of the largest number.
const DIGITS: f64 = 1e-5;

/// The largest size of a number of a column.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |largest: f64, number| largest.max(number.abs()))
}

/// Refuses two columns that say the same and differ by more than a tolerance.
fn agree(first: &[f64], again: &[f64], tolerance: f64, names: [&str; 2], lines: &[u32]) -> Result<(), Vec<FileFault>> {
    let apart = first.iter().zip(again).position(|(first, again)| (first - again).abs() > tolerance);
    apart.map_or(Ok(()), |row| {
        let found = format!("{:?} of {} and {:?} of {}", first[row], names[0], again[row], names[1]);
        let mistake = Mistake::Unexpected { found, expected: "the same of both columns".to_owned() };
        let line = lines.get(row).map(|line| *line as usize);
        Err(vec![FileFault { line, column: names[1].to_owned(), mistake }])
    })
}

/// Refuses two columns of which each may say the same, in other words.
fn twice(names: [&str; 2], line: Option<usize>) -> Vec<FileFault> {
    let found = format!("both columns {} and {}", names[0], names[1]);
    let mistake = Mistake::Unexpected { found, expected: "one of them".to_owned() };
    vec![FileFault { line, column: names[1].to_owned(), mistake }]
}

/// A mistake in a file.
#[derive(Debug)]
pub(crate) struct FileFault {
    /// Its line.
    pub(crate) line: Option<usize>,
    /// The column, or empty.
    pub(crate) column: String,
    /// What is wrong.
    pub(crate) mistake: Mistake,
}

impl FileFault {
    /// At a column of a line.
    fn at(line: usize, column: &str, mistake: Mistake) -> Self {
        Self { line: Some(line), column: column.to_owned(), mistake }
    }

    /// In the file as a whole.
    fn whole(mistake: Mistake) -> Self {
        Self { line: None, column: String::new(), mistake }
    }

    /// A column that is not there.
    fn missing(line: Option<usize>, column: &str, found: &[String]) -> Self {
        let mistake = if told_columns(found).is_some() {
            Mistake::Column { column: column.to_owned(), found: found.to_vec() }
        } else {
            let expected = format!("a line of column names with {column}");
            Mistake::Unexpected { found: "a first line without names of columns".to_owned(), expected }
        };
        Self { line, column: String::new(), mistake }
    }

    /// A word where a number should stand, or a number that is not finite.
    fn number(line: usize, column: &str, found: &str) -> Self {
        Self::at(
            line,
            column,
            Mistake::Unexpected { found: format!("{found:?}"), expected: "a finite number".to_owned() },
        )
    }
}

/// How many mistakes of one kind and file are reported.
pub(crate) const REPORTED: usize = 10;

/// How the scene describes a file.
pub(crate) struct Request<'a> {
    /// The file's name.
    pub(crate) file: &'a str,
    /// What its rows are.
    pub(crate) bodies: Bodies,
    /// Columns wanted beside the known ones, where the file has them.
    pub(crate) extra: &'a [String],
    /// What it is.
    pub(crate) format: Option<Format>,
    /// Its units.
    pub(crate) units: Option<Units>,
    /// The snapshot wanted.
    pub(crate) timestep: Option<u64>,
}

/// Reads a file into SI units.
pub(crate) fn read(bytes: &[u8], request: &Request) -> Result<Rows, Vec<FileFault>> {
    let bytes = unpacked(bytes)?;
    let format = format(request, &bytes)?;
    if request.timestep.is_some() && format != Format::Dump {
        let mistake = Mistake::InvalidCombination {
            what: "this file has no time steps to choose from".to_owned(),
            expected: "leave timestep out".to_owned(),
        };
        return Err(vec![FileFault { line: None, column: "timestep".to_owned(), mistake }]);
    }
    if format != Format::Vtu {
        has_room(bytes.iter().filter(|byte| **byte == b'\n').count(), ROW)?;
    }
    let (mut rows, stated) = match format {
        Format::Csv => (csv::read(&bytes, request)?, Some("si".to_owned()).filter(|_| request.units.is_none())),
        Format::Vtu => (vtu::read(&bytes, request)?, Some("si".to_owned()).filter(|_| request.units.is_none())),
        Format::Data => data::read(text(&bytes)?, request)?,
        Format::Dump => dump::read(text(&bytes)?, request)?,
        Format::Multisphere => (multisphere::read(text(&bytes)?)?, Some("si".to_owned())),
    };
    has_room(rows.count, memory::SPHERE)?;
    convert(&mut rows, units(request, stated)?);
    bodies::memberships(&mut rows, request)?;
    bodies::density_of_mass(&mut rows, request)?;
    Ok(rows)
}

/// Refuses more particles than there is memory for, where each needs so much \[bytes\].
fn has_room(count: usize, each: u64) -> Result<(), Vec<FileFault>> {
    let needed = each.saturating_mul(count as u64);
    memory::lacking(needed).map_or(Ok(()), |expected| {
        let found = format!("{count} particles, which need about {:.2} GB of memory", needed as f64 / 1e9);
        Err(vec![FileFault::whole(Mistake::Unexpected { found, expected })])
    })
}

/// The bytes of a file that may be packed by gzip.
fn unpacked(bytes: &[u8]) -> Result<Cow<'_, [u8]>, Vec<FileFault>> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(Cow::Borrowed(bytes));
    }
    // A list that grows is copied into one twice as long.
    let most = memory::available().map_or(u64::MAX, |free| free / 3);
    let mut unpacked = Vec::new();
    match MultiGzDecoder::new(bytes).take(most).read_to_end(&mut unpacked) {
        Ok(length) if length as u64 == most => Err(vec![FileFault::whole(Mistake::Unexpected {
            found: format!("a gzip file that holds more than {:.2} GB", most as f64 / 1e9),
            expected: "what fits into a third of the memory that is free".to_owned(),
        })]),
        Ok(_) => Ok(Cow::Owned(unpacked)),
        Err(error) => Err(vec![FileFault::whole(Mistake::Unexpected {
            found: format!("a damaged gzip file ({error})"),
            expected: "a whole one".to_owned(),
        })]),
    }
}

/// The format of a file: as the scene says, as its name says, or as its beginning shows.
fn format(request: &Request, bytes: &[u8]) -> Result<Format, Vec<FileFault>> {
    if let Some(format) = request.format {
        return Ok(format);
    }
    let name = request.file.to_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    match name.rsplit('.').next() {
        Some("csv") => Ok(Format::Csv),
        Some("vtu" | "vtp" | "vtk") => Ok(Format::Vtu),
        Some("data" | "lmpdat") => Ok(Format::Data),
        Some("dump" | "lammpstrj" | "liggghts") => Ok(Format::Dump),
        Some("multisphere") if request.bodies == Bodies::SpheresOfClump => Ok(Format::Multisphere),
        Some("multisphere") => Err(unknown(
            "the spheres of one clump",
            "single bodies; [clump.<name>] file takes such a file, and a set with clump = \"<name>\" places the clumps",
        )),
        _ if bytes.starts_with(b"ITEM:") => Ok(Format::Dump),
        _ if request.bodies == Bodies::SpheresOfClump => Err(unknown(
            "a file of unknown kind",
            "a name that ends in .csv, .vtu, .vtp, .vtk, .data, .dump or .multisphere",
        )),
        _ => Err(unknown("a file of unknown kind", "format = \"csv\", \"vtu\", \"data\" or \"dump\" in the scene")),
    }
}

/// Refuses a file for its kind.
fn unknown(found: &str, expected: &str) -> Vec<FileFault> {
    vec![FileFault::whole(Mistake::Unexpected { found: found.to_owned(), expected: expected.to_owned() })]
}

/// The text of a file.
fn text(bytes: &[u8]) -> Result<&str, Vec<FileFault>> {
    std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        let mistake =
            Mistake::Unexpected { found: "bytes that are not UTF-8".to_owned(), expected: "a text file".to_owned() };
        vec![FileFault { line: Some(line), column: String::new(), mistake }]
    })
}

/// The units of a file: as it says itself, or else as the scene says.
fn units(request: &Request, stated: Option<String>) -> Result<Units, Vec<FileFault>> {
    match (stated, request.units) {
        (None, None) if request.bodies == Bodies::SpheresOfClump => Err(unknown(
            "a file that does not state its units",
            "units = si in the first line of a data file, ITEM: UNITS in a dump",
        )),
        (None, None) => Err(vec![FileFault::whole(Mistake::NoUnits)]),
        (None, Some(units)) => Ok(units),
        (Some(name), given) => match Units::named(&name) {
            None => Err(vec![FileFault::whole(Mistake::Units { found: name })]),
            Some(units) if given.is_some_and(|given| given != units) => Err(vec![FileFault {
                line: None,
                column: "units".to_owned(),
                mistake: Mistake::InvalidCombination {
                    what: format!("the file itself says {name} units"),
                    expected: "leave units out".to_owned(),
                },
            }]),
            Some(units) => Ok(units),
        },
    }
}

/// From a file's units to SI.
fn convert(rows: &mut Rows, units: Units) {
    if units == Units::Si {
        return;
    }
    let [length, mass, time] = units.sizes();
    if let Some(FileBox { lattice, .. }) = &mut rows.around {
        let parts = lattice.edges.as_flattened_mut().iter_mut().chain(&mut lattice.origin);
        parts.for_each(|part| *part *= length);
    }
    for (name, column) in &mut rows.columns {
        let factor = match name.as_str() {
            "x" | "y" | "z" | "radius" => length,
            "mass" => mass,
            "density" => mass / (length * length * length),
            "vx" | "vy" | "vz" => length / time,
            "wx" | "wy" | "wz" => 1.0 / time,
            _ => continue,
        };
        column.iter_mut().for_each(|value| *value *= factor);
    }
}

/// Refuses particles that crossed a face of a box which does not repeat.
fn crossed(line: usize) -> Vec<FileFault> {
    let (found, expected) = ("a particle that crossed a face".to_owned(), "a box that repeats there".to_owned());
    vec![FileFault { line: Some(line), column: String::new(), mistake: Mistake::Unexpected { found, expected } }]
}

/// Refuses bodies that are not spheres.
fn non_spherical(line: usize) -> Vec<FileFault> {
    let mistake = Mistake::Unsupported { what: "non-spherical bodies but clumps", instead: "spheres" };
    vec![FileFault { line: Some(line), column: String::new(), mistake }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ParticleShape;
    use std::path::Path;

    /// Reads a text as a file of this name.
    fn read_as(file: &str, bytes: &[u8]) -> Result<Rows, String> {
        let bodies = Bodies::Particles(ParticleShape::Sphere);
        let request = Request { file, bodies, extra: &[], format: None, units: None, timestep: None };
        let units = (file.ends_with("dump") || file.ends_with("data")).then_some(Units::Si);
        read(bytes, &Request { units, ..request }).map_err(|faults| format!("{faults:?}"))
    }

    /// The dump file of these columns and lines.
    fn dump(faces: &str, columns: &str, lines: &[&str]) -> Result<Rows, String> {
        let text = format!(
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {faces}\n0 2\n0 2\n0 2\nITEM: ATOMS {columns}\n{}\n",
            lines.len(),
            lines.join("\n")
        );
        read_as("a.dump", text.as_bytes())
    }

    #[test]
    fn files_that_other_programs_wrote_give_the_same_grains() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/foreign/clouds");
        let mut read = 0;
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_str().unwrap();
            if name == "readme" {
                continue;
            }
            read += 1;
            let rows =
                read_as(name, &std::fs::read(&path).unwrap()).unwrap_or_else(|faults| panic!("{name}: {faults}"));
            let expected =
                [[0.0, 0.0, 0.05, 0.005, 2500.0], [0.03, 0.01, 0.06, 0.01, 7800.0], [0.1, 0.05, 0.09, 0.005, 2500.0]];
            assert_eq!(rows.count, 3, "{name}");
            for (axis, column) in ["x", "y", "z", "radius", "density"].into_iter().enumerate() {
                let Some(found) = rows.columns.get(column) else {
                    assert!(column == "density", "{name}: no {column}");
                    continue;
                };
                // Texts have six digits.
                let right = found
                    .iter()
                    .zip(expected)
                    .all(|(found, right)| (found - right[axis]).abs() <= 1e-6 * right[axis].max(1.0));
                let right = right
                    || (axis == 4
                        && found.iter().zip(expected).all(|(found, it)| (found / it[axis] - 1.0).abs() < 1e-5));
                assert!(right, "{name}: {column} {found:?}");
            }
            let labels: Vec<&str> = rows.label.iter().map(|label| rows.labels[*label as usize].as_str()).collect();
            assert!(labels == ["1", "2", "1"] || labels == ["glass", "steel", "glass"], "{name}: {labels:?}");
        }
        assert!(read > 15, "{read}");
    }

    #[test]
    fn velocities_that_stand_before_the_atoms_are_read() {
        let rows = read_as(
            "a.data",
            b"t, units = si\n\n1 atoms\n\nVelocities\n\n4 1 2 3 0 0 5\n\nAtoms # sphere\n\n4 1 0.1 2500 0 0 0\n",
        );
        let rows = rows.unwrap();
        assert_eq!((rows.columns["vx"][0], rows.columns["vz"][0], rows.columns["wz"][0]), (1.0, 3.0, 5.0));
    }

    #[test]
    fn columns_that_say_the_same_twice_must_agree() {
        let right = dump(
            "ff ff ff",
            "id id type type xs ys zs x y z radius diameter",
            &["1 1 1 1 0.25 0 0 0.5 0 0 0.1 0.2", "2 2 2 2 0.5 0 0 1 0 0 0.1 0.2"],
        );
        let right = right.unwrap();
        assert_eq!((right.columns["x"][0], right.columns["x"][1], right.label), (0.5, 1.0, vec![0, 1]));
        let wrong = |columns: &str, line: &str, part: &str| {
            let found = dump("ff ff ff", columns, &[line]).unwrap_err();
            assert!(found.contains(part), "{found}");
        };
        wrong("id type type x y z radius", "1 1 2 0 0 0 0.1", "1 and 2 in two columns of this name");
        wrong("id id type x y z radius", "1 2 1 0 0 0 0.1", "1.0 of id and 2.0 of id");
        wrong("id type x x y z radius", "1 1 0.5 0.6 0 0 0.1", "0.5 of x and 0.6 of x");
        wrong("id type xs ys zs x y z radius", "1 1 0.25 0 0 0.75 0 0 0.1", "0.75 of x and 0.5 of xs");
        wrong("id type x y z radius diameter", "1 1 0 0 0 0.1 0.1", "0.1 of radius and 0.05 of diameter");
        wrong("id type x y z radius density mass", "1 1 0 0 0 0.1 2500 1", "2500.0 of density");
        wrong("id type x y z radius", "1 1 0 0 0 0.1 7", "6 numbers");
        let labels = read_as("a.csv", b"x,y,z,radius,type,material\n0,0,0,1,1,glass\n").unwrap_err();
        assert!(labels.contains("both columns material and type"), "{labels}");
    }

    /// Positions of a particle.
    fn place(rows: &Rows, row: usize) -> [f64; 3] {
        ["x", "y", "z"].map(|axis| rows.columns[axis][row])
    }

    #[test]
    fn places_in_a_periodic_box_are_those_without_its_faces() {
        // Bounds are those around the leaning box: edges (2, 0, 0), (0.5, 2, 0), (0, 0, 2) from (0, 0, 0).
        let read = |columns: &str, line: &str| {
            let text = format!(
                "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp ff\n0 2.5 0.5\n0 2 0\n0 2 0\n\
                 ITEM: ATOMS id type radius {columns}\n1 1 0.1 {line}\n"
            );
            read_as("a.dump", text.as_bytes())
        };
        let unwrapped = [0.5 + 2.0 * 3.0 - 0.5, 1.0 - 2.0, 1.5];
        for (columns, line) in [
            ("x y z ix iy iz", "0.5 1 1.5 3 -1 0"),
            ("xs ys zs ix iy iz", "0.125 0.5 0.75 3 -1 0"),
            ("xu yu zu", "6 -1 1.5"),
            ("xsu ysu zsu", "3.125 -0.5 0.75"),
            ("x y z xu yu zu", "0.5 1 1.5 6 -1 1.5"),
            ("xu yu zu x y z ix iy iz", "6 -1 1.5 0.5 1 1.5 3 -1 0"),
            ("xs ys zs xsu ysu zsu", "0.125 0.5 0.75 3.125 -0.5 0.75"),
            ("xs ys zs xu yu zu", "0.125 0.5 0.75 6 -1 1.5"),
        ] {
            let rows = read(columns, line).unwrap_or_else(|faults| panic!("{columns}: {faults}"));
            assert_eq!(place(&rows, 0), unwrapped, "{columns}");
            let around = rows.around.unwrap();
            assert_eq!(around.lattice.edges, [[2.0, 0.0, 0.0], [0.5, 2.0, 0.0], [0.0, 0.0, 2.0]]);
            assert_eq!((around.lattice.periodic, around.lattice.origin), ([true, true, false], [0.0; 3]));
        }
        assert_eq!(place(&read("x y z", "0.5 1 1.5").unwrap(), 0), [0.5, 1.0, 1.5]);
        for (columns, line, part) in [
            ("x y z ix iy iz", "0.5 1 1.5 0 0 1", "a particle that crossed a face"),
            ("x y z ix", "0.5 1 1.5 1", "ix without iy and iz"),
            ("xu yu zu x y z ix iy iz", "6 -1 1.5 0.5 1 1.5 2 -1 0", "of x and "),
            ("xu yu zu x y z", "6.1 -1 1.5 0.5 1 1.5", "whole edges of the box apart"),
            ("xu yu zu x y z", "6 -1 3.5 0.5 1 1.5", "whole edges of the box apart"),
            ("x yu z", "0.5 -1 1.5", "all of xu, yu, zu of a box that leans"),
            ("xs ysu zs", "0.125 -0.5 0.75", "all three"),
        ] {
            let found = read(columns, line).unwrap_err();
            assert!(found.contains(part), "{found}");
        }
        let general = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS abc origin pp pp pp\n2 0 0 0.1\n\
                       0.5 2 0 0.2\n0 0 2 0.3\nITEM: ATOMS id type radius xs ys zs\n1 1 0.1 0.5 0.5 0.5\n";
        let rows = read_as("a.dump", general.as_bytes()).unwrap();
        assert_eq!(place(&rows, 0), [0.1 + 1.25, 1.2, 1.3]);
        let turned = read_as("a.dump", general.replace("2 0 0 0.1", "2 1 0 0.1").as_bytes()).unwrap_err();
        assert!(turned.contains("a box with edges [[2.0, 1.0, 0.0]"), "{turned}");
    }

    #[test]
    fn image_flags_of_a_data_file_lead_out_of_its_box() {
        let text = "t, units = si\n\n1 atoms\n0 2 xlo xhi\n0 2 ylo yhi\n0 2 zlo zhi\n0.5 0 0 xy xz yz\n\nAtoms # sphere\n\n\
                    4 1 0.1 2500 0.5 1 1.5 3 -1 0\n";
        let rows = read_as("a.data", text.as_bytes()).unwrap();
        assert_eq!(place(&rows, 0), [6.0, -1.0, 1.5]);
        let around = rows.around.unwrap();
        assert!(around.is_crossed && !around.is_told && around.line == Some(11), "{around:?}");
        let without = read_as("a.data", text.replace("0 2 xlo xhi\n", "\n").as_bytes()).unwrap_err();
        assert!(without.contains("xlo xhi"), "{without}");
        let general = text.replace(
            "0 2 xlo xhi\n0 2 ylo yhi\n0 2 zlo zhi\n0.5 0 0 xy xz yz",
            "2 0 0 avec\n0.5 2 0 bvec\n0 0 2 cvec\n0 0 0 abc origin",
        );
        assert_eq!(place(&read_as("a.data", general.as_bytes()).unwrap(), 0), [6.0, -1.0, 1.5]);
    }

    #[test]
    fn a_tilted_box_with_fixed_faces_is_read() {
        let line = ["1 1 0.5 0.5 0.5 0.1"];
        assert!(dump("xy xz yz ff ff ff", "id type x y z radius", &line).is_ok());
    }
}
