//! Particles from files: whatever the format, rows of numbers with the names that CSV columns have.

mod csv;
mod data;
mod dump;
mod format;
mod vtu;

pub(crate) use format::{Format, Units};

use crate::document::Mistake;
use crate::memory;
use flate2::read::MultiGzDecoder;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;

/// Columns that every file must have.
const NEEDED: [&str; 4] = ["x", "y", "z", "radius"];

/// Columns that a file may have: number, density \[kg/m³\], velocity \[m/s\], angular velocity \[rad/s\].
const POSSIBLE: [&str; 8] = ["id", "density", "vx", "vy", "vz", "wx", "wy", "wz"];

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
        let mistake = Mistake::Column { column: column.to_owned(), found: found.to_vec() };
        Self { line, column: String::new(), mistake }
    }

    /// A word where a number should stand, or a number that is not finite.
    fn number(line: usize, column: &str, found: &str) -> Self {
        Self::at(line, column, Mistake::Wrong { found: format!("{found:?}"), right: "a finite number".to_owned() })
    }
}

/// How many mistakes of one kind and file are reported.
pub(crate) const REPORTED: usize = 10;

/// How the scene describes a file.
pub(crate) struct Request<'a> {
    /// The file's name.
    pub(crate) file: &'a str,
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
        let mistake = Mistake::Senseless {
            what: "this file has no time steps to choose from".to_owned(),
            right: "leave timestep out".to_owned(),
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
    };
    has_room(rows.count, memory::SPHERE)?;
    convert(&mut rows, units(request, stated)?);
    Ok(rows)
}

/// Refuses more particles than there is memory for, where each needs so much \[bytes\].
fn has_room(count: usize, each: u64) -> Result<(), Vec<FileFault>> {
    let needed = each.saturating_mul(count as u64);
    memory::lacking(needed).map_or(Ok(()), |right| {
        let found = format!("{count} particles, which need about {:.2} GB of memory", needed as f64 / 1e9);
        Err(vec![FileFault::whole(Mistake::Wrong { found, right })])
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
        Ok(length) if length as u64 == most => Err(vec![FileFault::whole(Mistake::Wrong {
            found: format!("a gzip file that holds more than {:.2} GB", most as f64 / 1e9),
            right: "what fits into a third of the memory that is free".to_owned(),
        })]),
        Ok(_) => Ok(Cow::Owned(unpacked)),
        Err(error) => Err(vec![FileFault::whole(Mistake::Wrong {
            found: format!("a damaged gzip file ({error})"),
            right: "a whole one".to_owned(),
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
        Some("vtu") => Ok(Format::Vtu),
        Some("data" | "lmpdat") => Ok(Format::Data),
        Some("dump" | "lammpstrj" | "liggghts") => Ok(Format::Dump),
        _ if bytes.starts_with(b"ITEM:") => Ok(Format::Dump),
        _ => Err(vec![FileFault::whole(Mistake::Wrong {
            found: "a file of unknown kind".to_owned(),
            right: "format = \"csv\", \"vtu\", \"data\" or \"dump\" in the scene".to_owned(),
        })]),
    }
}

/// The text of a file.
fn text(bytes: &[u8]) -> Result<&str, Vec<FileFault>> {
    std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        let mistake = Mistake::Wrong { found: "bytes that are not UTF-8".to_owned(), right: "a text file".to_owned() };
        vec![FileFault { line: Some(line), column: String::new(), mistake }]
    })
}

/// The units of a file: as it says itself, or else as the scene says.
fn units(request: &Request, stated: Option<String>) -> Result<Units, Vec<FileFault>> {
    match (stated, request.units) {
        (None, None) => Err(vec![FileFault::whole(Mistake::NoUnits)]),
        (None, Some(units)) => Ok(units),
        (Some(name), given) => match Units::named(&name) {
            None => Err(vec![FileFault::whole(Mistake::Units { found: name })]),
            Some(units) if given.is_some_and(|given| given != units) => Err(vec![FileFault {
                line: None,
                column: "units".to_owned(),
                mistake: Mistake::Senseless {
                    what: format!("the file itself says {name} units"),
                    right: "leave units out".to_owned(),
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
    for (name, column) in &mut rows.columns {
        let factor = match name.as_str() {
            "x" | "y" | "z" | "radius" => length,
            "density" => mass / (length * length * length),
            "vx" | "vy" | "vz" => length / time,
            "wx" | "wy" | "wz" => 1.0 / time,
            _ => continue,
        };
        column.iter_mut().for_each(|value| *value *= factor);
    }
}

/// Refuses a file without the columns that every file must have.
fn needed(found: &[String], line: Option<usize>) -> Result<(), Vec<FileFault>> {
    let missing: Vec<FileFault> = NEEDED
        .iter()
        .filter(|column| !found.iter().any(|name| name == *column))
        .map(|column| FileFault::missing(line, column, found))
        .collect();
    if missing.is_empty() { Ok(()) } else { Err(missing) }
}

/// Refuses particles that crossed the face of a periodic cell, or the cell itself.
fn periodic(line: usize) -> Vec<FileFault> {
    let mistake =
        Mistake::NotThere { what: "periodic cells", instead: "positions in a box with fixed or shrink-wrapped faces" };
    vec![FileFault { line: Some(line), column: String::new(), mistake }]
}

/// Refuses bodies that are not spheres.
fn non_spherical(line: usize) -> Vec<FileFault> {
    let mistake = Mistake::NotThere { what: "non-spherical bodies", instead: "spheres" };
    vec![FileFault { line: Some(line), column: String::new(), mistake }]
}
