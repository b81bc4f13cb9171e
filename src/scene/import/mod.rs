//! Particles from files: whatever the format, rows of numbers with the names that CSV columns have.

mod bodies;
mod bytes;
mod csv;
mod data;
mod dump;
mod fault;
mod file_box;
mod format;
mod multisphere;
mod rows;
#[cfg(test)]
mod tests;
mod vtu;

pub(crate) use bodies::{Bodies, CELL};
pub(crate) use fault::{FileFault, REPORTED};
pub(crate) use file_box::FileBox;
pub(crate) use format::{Format, Units};
pub(crate) use rows::Rows;

use crate::base::document::Mistake;
use crate::base::memory;
use bytes::{has_room, text, unpacked};
use format::{convert, format, units};

/// Memory that a line of a text file takes as it is read, at least \[bytes\].
const ROW: u64 = 100;

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
