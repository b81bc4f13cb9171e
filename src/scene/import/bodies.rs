//! What the rows of a file are: which columns say something about them, and what these mean.

use super::file_box::Bounds;
use super::rows::{DIGITS, agree, largest};
use super::{FileBox, FileFault, Request, Rows};
use crate::base::document::Mistake;
use crate::base::geometry::Lattice;
use crate::base::vtk_reader::Array;
use crate::scene::ParticleShape;

/// What the rows of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bodies {
    /// Particles of this shape.
    Particles(ParticleShape),
    /// Clumps.
    Clumps,
    /// The spheres of one clump.
    SpheresOfClump,
}

/// Columns that every file has.
const PLACE: [&str; 3] = ["x", "y", "z"];

/// Columns that a file may have: number, density \[kg/m³\], mass \[kg\], velocity \[m/s\], angular velocity \[rad/s\].
const POSSIBLE: [&str; 9] = ["id", "density", "mass", "vx", "vy", "vz", "wx", "wy", "wz"];

/// Columns of clumps beside these: how each is turned, how large it is, and which shape it has.
const OF_CLUMPS: [&str; 6] = ["qw", "qx", "qy", "qz", "scale", "shape"];

/// Columns that follow from all others: leaving them out changes nothing.
const FOLLOWING: [&str; 11] = ["force", "torque", "moment", "orientation", "fx", "fy", "fz", "tqx", "tqy", "tqz", "f"];

/// Columns that say to what a particle belongs, with the least number that says so.
const MEMBERSHIPS: [(&str, f64); 5] =
    [("clump", 0.0), ("id_multisphere", 0.0), ("group", 0.0), ("molecule", 1.0), ("mol", 1.0)];

/// The field of a frame that holds the cell: its corner, its three edges \[m\], and 1 for each edge along which it repeats.
pub(crate) const CELL: &str = "cell";

/// The array of a frame with the places that particles would have without the cell \[m\].
pub(super) const UNWRAPPED: &str = "unwrapped";

impl Request<'_> {
    /// Whether a column is read.
    pub(super) fn reads(&self, column: &str) -> bool {
        let of_clumps = self.bodies == Bodies::Clumps && OF_CLUMPS.contains(&column);
        [&PLACE[..], &["radius"], &POSSIBLE].concat().contains(&column)
            || of_clumps
            || MEMBERSHIPS.iter().any(|(name, _)| *name == column)
            || self.extra.iter().any(|name| name == column)
    }

    /// Whether a column that is not read must be told.
    pub(super) fn misses(&self, column: &str) -> bool {
        !self.reads(column) && !FOLLOWING.contains(&column)
    }

    /// Refuses a file without the columns that it must have.
    pub(super) fn needed(&self, found: &[String], line: Option<usize>) -> Result<(), Vec<FileFault>> {
        let there = |column: &str| found.iter().any(|name| name == column);
        let sized = there("radius") || self.bodies == Bodies::Clumps && there("scale");
        let missing = PLACE.into_iter().filter(|column| !there(column)).chain((!sized).then_some("radius"));
        let faults: Vec<FileFault> = missing.map(|column| FileFault::missing(line, column, found)).collect();
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }
}

/// Takes away the columns that say to what rows belong: what would come apart is refused, what is left out is noted.
pub(super) fn memberships(rows: &mut Rows, request: &Request) -> Result<(), Vec<FileFault>> {
    for (name, least) in MEMBERSHIPS {
        if request.extra.iter().any(|extra| extra == name) {
            continue;
        }
        let Some(column) = &rows.columns.remove(name) else { continue };
        let column = column.as_slice();
        let Some(row) = column.iter().position(|number| *number >= least) else { continue };
        // Clumps get their numbers in the order of the file.
        if name == "clump"
            && request.bodies == Bodies::Clumps
            && (0..).zip(column).all(|(row, it)| *it == f64::from(row))
        {
            continue;
        }
        let is_body = ["clump", "id_multisphere"].contains(&name);
        if is_body && matches!(request.bodies, Bodies::Particles(_)) {
            let found = format!("a sphere of body {:?}, which would come apart", column[row]);
            let expected = "single spheres: clumps are placed by a set with clump = \"..\" and their mass centres, \
                            which frames clumps_*.vtu hold"
                .to_owned();
            let mistake = Mistake::Unexpected { found, expected };
            return Err(vec![FileFault { line: rows.line(row), column: name.to_owned(), mistake }]);
        }
        rows.left_out.push(name.to_owned());
    }
    Ok(())
}

/// From masses to densities \[kg/m³\]; if the file has both, they agree.
pub(super) fn density_of_mass(rows: &mut Rows, request: &Request) -> Result<(), Vec<FileFault>> {
    let Bodies::Particles(shape) = request.bodies else { return Ok(()) };
    let (Some(mass), Some(radius)) = (rows.columns.get("mass"), rows.columns.get("radius")) else { return Ok(()) };
    if let Some(row) = mass.iter().position(|mass| *mass <= 0.0) {
        let found = format!("{:?}", mass[row]);
        let mistake = Mistake::Unexpected { found, expected: "a number above 0".to_owned() };
        return Err(vec![FileFault { line: rows.line(row), column: "mass".to_owned(), mistake }]);
    }
    let density: Vec<f64> = mass.iter().zip(radius).map(|(mass, radius)| mass / shape.volume(*radius)).collect();
    if let Some(stated) = rows.columns.get("density") {
        // The radius counts three times.
        let names = ["density", if shape == ParticleShape::Disc { "mass of discs" } else { "mass of spheres" }];
        return agree(stated, &density, 4.0 * DIGITS * largest(stated), names, &rows.lines);
    }
    if !request.extra.iter().any(|name| name == "mass") {
        rows.columns.remove("mass");
    }
    rows.insert("density", density);
    Ok(())
}

/// The cell of a frame, from the field that holds it.
pub(super) fn cell_of(field: &Array) -> Result<FileBox, Vec<FileFault>> {
    let rows: Vec<[f64; 3]> = field.values.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect();
    let [low, a, b, c, repeats] = rows[..] else {
        let found = format!("{} numbers", field.values.len());
        let expected = "15: the corner, three edges, and 1 for each that repeats".to_owned();
        let mistake = Mistake::Unexpected { found, expected };
        return Err(vec![FileFault { line: None, column: CELL.to_owned(), mistake }]);
    };
    let lattice = Bounds { low, edges: [a, b, c] }.lattice(None)?;
    let lattice = Lattice { periodic: repeats.map(|flag| flag != 0.0), ..lattice };
    Ok(FileBox { lattice, is_told: true, line: None, is_crossed: false })
}
