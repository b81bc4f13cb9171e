//! VTK files as other programs write them: points, their arrays and cells, from XML and legacy files.
//!
//! Only what the caller wants is unpacked, and no count that a file states is believed before the file has as many bytes.

mod legacy;
mod packed;
mod xml;

use std::str::FromStr;

/// Cells that are chains of triangles.
pub(crate) const TRIANGLE_STRIP: u8 = 6;

/// Cells of any number of corners.
pub(crate) const POLYGON: u8 = 7;

/// Points of a file, with what belongs to them.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Piece {
    /// x, y, z \[file's unit\].
    pub(crate) points: Vec<[f64; 3]>,
    /// Arrays of point data that were wanted.
    pub(crate) arrays: Vec<Array>,
    /// Cells with a surface, or of any kind in an unstructured grid.
    pub(crate) cells: Vec<Cell>,
    /// Fields of the file as a whole, in its first piece: those of numbers, where arrays are wanted.
    pub(crate) fields: Vec<Array>,
}

/// Numbers of each point.
#[derive(Debug, PartialEq)]
pub(crate) struct Array {
    /// What they are.
    pub(crate) name: String,
    /// How many each point has.
    pub(crate) components: usize,
    /// Point after point.
    pub(crate) values: Vec<f64>,
}

/// A cell.
#[derive(Debug, PartialEq)]
pub(crate) struct Cell {
    /// VTK's number of its type.
    pub(crate) kind: u8,
    /// Places of its corners among the points.
    pub(crate) corners: Vec<usize>,
}

/// What the caller wants of a file beside its points.
pub(crate) enum Wanted<'a> {
    /// Cells.
    Cells,
    /// Arrays of point data with names that this accepts.
    Arrays(&'a dyn Fn(&str) -> bool),
}

impl Wanted<'_> {
    /// Whether cells are wanted.
    fn cells(&self) -> bool {
        matches!(self, Self::Cells)
    }

    /// Whether an array of this name is wanted.
    fn array(&self, name: &str) -> bool {
        matches!(self, Self::Arrays(accepts) if accepts(name))
    }
}

/// Reads polygonal data or an unstructured grid, XML or legacy; otherwise what was found instead.
pub(crate) fn read(bytes: &[u8], wanted: &Wanted) -> Result<Vec<Piece>, String> {
    if bytes.starts_with(b"# vtk DataFile") {
        return legacy::read(bytes, wanted).map(|piece| vec![piece]);
    }
    xml::read(bytes, wanted)
}

/// What a number of a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    /// Whole, with a sign.
    Signed(usize),
    /// Whole.
    Unsigned(usize),
    /// Real.
    Real(usize),
}

impl Number {
    /// Bytes of one.
    fn size(self) -> usize {
        match self {
            Self::Signed(size) | Self::Unsigned(size) | Self::Real(size) => size,
        }
    }

    /// The numbers that these bytes stand for.
    fn all(self, bytes: &[u8], order: Order) -> Vec<f64> {
        bytes.chunks_exact(self.size()).map(|bytes| self.one(order.word(bytes))).collect()
    }

    /// The number that these bits stand for.
    fn one(self, bits: u64) -> f64 {
        match self {
            Self::Unsigned(_) => bits as f64,
            Self::Signed(size) => {
                let unused = 64 - 8 * size as u32;
                ((bits << unused) as i64 >> unused) as f64
            }
            Self::Real(4) => f64::from(f32::from_bits(bits as u32)),
            Self::Real(_) => f64::from_bits(bits),
        }
    }
}

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    /// The lowest.
    Little,
    /// The highest.
    Big,
}

impl Order {
    /// The bits of up to eight bytes.
    fn word(self, bytes: &[u8]) -> u64 {
        let join = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        match self {
            Self::Little => bytes.iter().rev().fold(0, join),
            Self::Big => bytes.iter().fold(0, join),
        }
    }
}

/// Numbers written as text.
fn from_text<T: FromStr>(text: &str, name: &str) -> Result<Vec<T>, String> {
    text.split_ascii_whitespace()
        .map(|word| word.parse().map_err(|_| format!("{:?} among the numbers of {name}", shortened(word))))
        .collect()
}

/// The beginning of a word of a file.
fn shortened(word: &str) -> String {
    word.chars().take(20).collect()
}

/// Points of three numbers each.
fn points(values: &[f64]) -> Vec<[f64; 3]> {
    values.chunks_exact(3).map(|point| [point[0], point[1], point[2]]).collect()
}

/// Cells from their corners one after another and from where each ends.
fn cells(corners: &[f64], ends: &[f64], kind: impl Fn(usize) -> Option<u8>) -> Result<Vec<Cell>, String> {
    let mut start = 0;
    let mut cells = Vec::new();
    for (place, end) in ends.iter().enumerate() {
        let end = *end as usize;
        let (Some(corners), Some(kind)) = (corners.get(start..end), kind(place)) else {
            return Err("a list of corners that is cut short".to_owned());
        };
        // What is no place at all becomes one that no point has.
        let place = |corner: &f64| if *corner >= 0.0 { *corner as usize } else { usize::MAX };
        cells.push(Cell { kind, corners: corners.iter().map(place).collect() });
        start = end;
    }
    Ok(cells)
}
