//! VTK's XML files: ascii, binary and appended arrays.

use super::packed::{Packing, Storage, Stream, memory_for};
use super::{Array, Number, Order, POLYGON, Piece, TRIANGLE_STRIP, Wanted, cells, from_text, points};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

/// What is no file of this kind.
const DAMAGED: &str = "a file that is no VTK file, or a damaged one";

/// Parts of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Nothing that is read.
    Other,
    /// Points.
    Points,
    /// Fields of the file.
    Field,
    /// Point data.
    PointData,
    /// Cells of an unstructured grid.
    Cells,
    /// Polygons of polygonal data.
    Polygons,
    /// Strips of polygonal data.
    Strips,
}

impl Part {
    /// The part that a tag begins.
    fn of(tag: &str) -> Self {
        match tag {
            "FieldData" => Self::Field,
            "Points" => Self::Points,
            "PointData" => Self::PointData,
            "Cells" => Self::Cells,
            "Polys" => Self::Polygons,
            "Strips" => Self::Strips,
            _ => Self::Other,
        }
    }
}

/// An array as the text has it.
struct Found {
    /// Piece that it belongs to.
    piece: usize,
    /// Part of the piece.
    part: Part,
    /// Its name.
    name: String,
    /// Numbers of each point or cell.
    components: usize,
    /// What its elements are.
    number: String,
    /// `ascii`, `binary` or `appended`.
    format: String,
    /// Where it begins in the appended data.
    offset: usize,
    /// Its text.
    text: String,
}

/// What the text of a file holds.
#[derive(Default)]
struct Contents {
    /// How arrays are stored.
    storage: Option<Storage>,
    /// The compressor, if it is one that is not read.
    compressor: Option<String>,
    /// How many points, cells, polygons and strips each piece has.
    counts: Vec<[Option<usize>; 4]>,
    /// All arrays.
    arrays: Vec<Found>,
}

/// Reads a file.
pub(super) fn read(bytes: &[u8], wanted: &Wanted) -> Result<Vec<Piece>, String> {
    // Appended data need not be a text.
    let tag = b"<AppendedData";
    let end = bytes.windows(tag.len()).position(|window| window == tag);
    let text = std::str::from_utf8(&bytes[..end.unwrap_or(bytes.len())]).map_err(|_| DAMAGED.to_owned())?;
    let contents = scan(text, end.is_some())?;
    let appended = end.map_or(Some(Stream::Raw(&[])), |end| appended(&bytes[end..]));
    let mut pieces: Vec<Piece> = contents.counts.iter().map(|_| Piece::default()).collect();
    let mut lists = Vec::new();
    for array in &contents.arrays {
        let is_wanted = match array.part {
            Part::Other => false,
            Part::Points => true,
            Part::Field => matches!(wanted, Wanted::Arrays(_)) && array.number != "String" && !pieces.is_empty(),
            Part::PointData => wanted.array(&array.name),
            Part::Cells | Part::Polygons | Part::Strips => wanted.cells(),
        };
        if !is_wanted {
            continue;
        }
        let values = contents.values(array, appended.as_ref())?;
        match array.part {
            Part::Points => pieces[array.piece].points = points(&values),
            Part::PointData => {
                let (name, components) = (array.name.clone(), array.components);
                pieces[array.piece].arrays.push(Array { name, components, values });
            }
            Part::Field => {
                let (name, components) = (array.name.clone(), array.components);
                pieces[0].fields.push(Array { name, components, values });
            }
            _ => lists.push((array, values)),
        }
    }
    for (place, (piece, counts)) in pieces.iter_mut().zip(&contents.counts).enumerate() {
        expect("points", counts[0], piece.points.len())?;
        for (part, count) in [Part::Cells, Part::Polygons, Part::Strips].into_iter().zip(&counts[1..]) {
            let list = |name: &str| {
                let found =
                    lists.iter().find(|(array, _)| array.piece == place && array.part == part && array.name == name);
                found.map_or(&[][..], |(_, values)| values)
            };
            let types = list("types");
            let kind = |cell: usize| match part {
                Part::Polygons => Some(POLYGON),
                Part::Strips => Some(TRIANGLE_STRIP),
                _ => types.get(cell).map(|kind| *kind as u8),
            };
            let cells = cells(list("connectivity"), list("offsets"), kind)?;
            if wanted.cells() {
                expect("cells", *count, cells.len())?;
            }
            piece.cells.extend(cells);
        }
    }
    Ok(pieces)
}

/// Refuses another number of points or cells than the file announces.
fn expect(what: &str, announced: Option<usize>, found: usize) -> Result<(), String> {
    match announced {
        Some(announced) if announced != found => Err(format!("{announced} {what} announced and {found}")),
        _ => Ok(()),
    }
}

/// The appended data, from its tag on. `None` if they are encoded in another way than those known.
fn appended(bytes: &[u8]) -> Option<Stream<'_>> {
    let close = bytes.iter().position(|byte| *byte == b'>')?;
    let data = bytes[close + 1..].trim_ascii_start().strip_prefix(b"_")?;
    let tag = std::str::from_utf8(&bytes[..close]).ok()?;
    if tag.contains("raw") {
        return Some(Stream::Raw(data));
    }
    tag.contains("base64").then_some(Stream::Base64(data, Vec::new()))
}

/// Goes through the text of a file; `open`: appended data follow it.
fn scan(text: &str, open: bool) -> Result<Contents, String> {
    let damaged = || DAMAGED.to_owned();
    let mut reader = Reader::from_str(text);
    let (mut contents, mut part) = (Contents::default(), Part::Other);
    let mut depth = 0;
    let mut in_array = false;
    loop {
        match reader.read_event().map_err(|_| damaged())? {
            Event::Eof => break,
            Event::Text(text) if in_array => {
                if let Some(array) = contents.arrays.last_mut() {
                    array.text.push_str(&text);
                }
            }
            Event::Start(tag) => {
                depth += 1;
                contents.begin(&tag, &mut part)?;
                in_array = tag.name().as_ref() == "DataArray";
            }
            Event::Empty(tag) => contents.begin(&tag, &mut part)?,
            Event::End(tag) => {
                depth -= 1;
                // Text behind a tag within an array is none of its numbers.
                in_array = false;
                if Part::of(tag.name().as_ref()) == part {
                    part = Part::Other;
                }
            }
            _ => {}
        }
    }
    let whole = depth == i32::from(open);
    if whole && contents.storage.is_some() { Ok(contents) } else { Err(damaged()) }
}

impl Contents {
    /// Notes what a tag begins.
    fn begin(&mut self, tag: &BytesStart, part: &mut Part) -> Result<(), String> {
        let attribute = |name: &str| {
            let found = tag.try_get_attribute(name).ok().flatten()?;
            found.normalized_value(XmlVersion::Implicit1_0).ok().map(|value| value.into_owned())
        };
        let whole = |name: &str| attribute(name).and_then(|number| number.trim().parse::<usize>().ok());
        match tag.name().as_ref() {
            "VTKFile" => {
                let kind = attribute("type").unwrap_or_default();
                if !["PolyData", "UnstructuredGrid"].contains(&kind.as_str()) {
                    return Err("VTK data of another kind".to_owned());
                }
                let packing = match attribute("compressor").as_deref() {
                    None => None,
                    Some("vtkZLibDataCompressor") => Some(Packing::Zlib),
                    Some("vtkLZ4DataCompressor") => Some(Packing::Lz4),
                    Some(other) => {
                        self.compressor =
                            Some(other.trim_start_matches("vtk").trim_end_matches("DataCompressor").to_owned());
                        None
                    }
                };
                self.storage = Some(Storage {
                    word: if attribute("header_type").as_deref() == Some("UInt64") { 8 } else { 4 },
                    order: if attribute("byte_order").as_deref() == Some("BigEndian") {
                        Order::Big
                    } else {
                        Order::Little
                    },
                    packing,
                });
            }
            "Piece" => {
                self.counts.push(["NumberOfPoints", "NumberOfCells", "NumberOfPolys", "NumberOfStrips"].map(whole));
            }
            "DataArray" if !self.counts.is_empty() || *part == Part::Field => self.arrays.push(Found {
                piece: self.counts.len().saturating_sub(1),
                part: *part,
                name: attribute("Name").unwrap_or_default(),
                components: whole("NumberOfComponents").unwrap_or(1),
                number: attribute("type").unwrap_or_default(),
                format: attribute("format").unwrap_or_default(),
                offset: whole("offset").unwrap_or(0),
                text: String::new(),
            }),
            name if *part == Part::Other => *part = Part::of(name),
            _ => {}
        }
        Ok(())
    }

    /// The numbers of an array.
    fn values(&self, array: &Found, appended: Option<&Stream>) -> Result<Vec<f64>, String> {
        let name = if array.name.is_empty() { "of points" } else { &array.name };
        let number = match array.number.as_str() {
            "Float64" => Number::Real(8),
            "Float32" => Number::Real(4),
            "Int8" => Number::Signed(1),
            "Int16" => Number::Signed(2),
            "Int32" => Number::Signed(4),
            "Int64" => Number::Signed(8),
            "UInt8" => Number::Unsigned(1),
            "UInt16" => Number::Unsigned(2),
            "UInt32" => Number::Unsigned(4),
            "UInt64" => Number::Unsigned(8),
            _ => return Err(format!("no numbers in {name}")),
        };
        if array.format == "ascii" {
            memory_for(array.text.len(), name)?;
            return from_text(&array.text, name);
        }
        if let Some(compressor) = &self.compressor {
            return Err(format!("data packed by {}", compressor.to_lowercase()));
        }
        let damaged = || DAMAGED.to_owned();
        let storage = self.storage.ok_or_else(damaged)?;
        let mut stream = match array.format.as_str() {
            "binary" => Stream::Base64(array.text.as_bytes(), Vec::new()),
            "appended" => appended.and_then(|data| data.from(array.offset)).ok_or_else(damaged)?,
            _ => return Err(damaged()),
        };
        Ok(number.all(&storage.unpack(&mut stream, name)?, storage.order))
    }
}
