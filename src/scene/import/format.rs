//! What a particle file is and which units it has: as the scene says it, or the file itself.

use super::fault::unknown;
use super::{Bodies, FileBox, FileFault, Request, Rows};
use crate::base::document::Mistake;
use serde::Deserialize;

/// Formats of particle files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Format {
    /// Comma-separated columns.
    Csv,
    /// VTK's XML unstructured grid.
    Vtu,
    /// Data file of LIGGGHTS or LAMMPS.
    Data,
    /// Dump file of LIGGGHTS or LAMMPS.
    Dump,
    /// The spheres of one body, as LIGGGHTS reads them: known by the name of the file alone.
    #[serde(skip)]
    Multisphere,
}

/// Units of particle files, by the names that LIGGGHTS and LAMMPS have for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Units {
    /// Metre, kilogram, second.
    Si,
    /// Centimetre, gram, second.
    Cgs,
    /// Micrometre, picogram, microsecond.
    Micro,
    /// Nanometre, attogram, nanosecond.
    Nano,
}

impl Units {
    /// The units of this name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        [("si", Self::Si), ("cgs", Self::Cgs), ("micro", Self::Micro), ("nano", Self::Nano)]
            .into_iter()
            .find_map(|(known, units)| (known == name).then_some(units))
    }

    /// Length \[m\], mass \[kg\] and time \[s\] of one.
    pub(crate) fn sizes(self) -> [f64; 3] {
        match self {
            Self::Si => [1.0, 1.0, 1.0],
            Self::Cgs => [1e-2, 1e-3, 1.0],
            Self::Micro => [1e-6, 1e-15, 1e-6],
            Self::Nano => [1e-9, 1e-21, 1e-9],
        }
    }
}

/// The format of a file: as the scene says, as its name says, or as its beginning shows.
pub(super) fn format(request: &Request, bytes: &[u8]) -> Result<Format, Vec<FileFault>> {
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

/// The units of a file: as it says itself, or else as the scene says.
pub(super) fn units(request: &Request, stated: Option<String>) -> Result<Units, Vec<FileFault>> {
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
pub(super) fn convert(rows: &mut Rows, units: Units) {
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
