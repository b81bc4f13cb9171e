//! Points, and lines and facets between them, as `.vtu` files, which meshio and VTK read back bit for bit.
//!
//! Random mantissas hardly compress, and compressing costs many times the writing: it is done where a scene asks for it.

use crate::scene::import::CELL;
use cograin_vtk::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, IOBuffer, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};

/// Why bytes could not be made.
#[derive(Debug, thiserror::Error)]
#[error("the frame cannot be encoded: {0}")]
pub struct EncodeError(pub(super) String);

/// Values of one field, point after point or line after line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    /// One real number each.
    Scalars(Vec<f64>),
    /// Three real numbers each.
    Vectors(Vec<f64>),
    /// Four real numbers each: scalar, x, y, z.
    Quaternions(Vec<f64>),
    /// One whole number each.
    Integers(Vec<i64>),
    /// One small whole number each.
    Bytes(Vec<u8>),
}

/// What the points stand for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Each for itself.
    #[default]
    Points,
    /// Each two, in order, for a line.
    Lines,
    /// For the corners of facets with three or four of them.
    Facets {
        /// The corners, facet after facet.
        corners: Vec<u32>,
        /// Behind the last corner of each facet.
        ends: Vec<u32>,
    },
}

/// Points with named fields.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PointCloud {
    /// x, y, z of each point \[m\].
    pub points: Vec<f64>,
    /// Rows of the field that holds the periodic cell around them; empty where there is none.
    pub cell: Vec<[f64; 3]>,
    /// What they stand for.
    pub kind: Kind,
    /// The fields of the points by name, in the order of the file.
    pub fields: Vec<(&'static str, Values)>,
    /// The fields of the lines or facets.
    pub cell_fields: Vec<(&'static str, Values)>,
}

impl PointCloud {
    /// The cloud as a `.vtu` file, which may be compressed.
    pub(crate) fn encode(self, compressed: bool) -> Result<Vec<u8>, EncodeError> {
        let count = self.points.len() / 3;
        let attributes = |fields: Vec<(&'static str, Values)>| fields.into_iter().map(attribute).collect();
        // The one cell of a file without points has no values.
        let cell_fields = if count == 0 { Vec::new() } else { self.cell_fields };
        let piece = UnstructuredGridPiece {
            points: self.points.into(),
            cells: cells(count, self.kind),
            data: Attributes { point: attributes(self.fields), cell: attributes(cell_fields) },
        };
        let file = Vtk {
            version: Version::new_xml(1, 0),
            title: String::new(),
            byte_order: ByteOrder::LittleEndian,
            file_path: None,
            data: DataSet::inline(piece),
        };
        let mut bytes =
            cograin_vtk::write(file, compressed && count > 0).map_err(|error| EncodeError(error.to_string()))?;
        add_cell(&mut bytes, &self.cell)?;
        if count == 0 { name_no_points(bytes) } else { Ok(bytes) }
    }
}

/// Adds the field of the periodic cell, which the library cannot write: digits give every bit back.
fn add_cell(bytes: &mut Vec<u8>, cell: &[[f64; 3]]) -> Result<(), EncodeError> {
    if cell.is_empty() {
        return Ok(());
    }
    let tag = b"<UnstructuredGrid>";
    let place = bytes.windows(tag.len()).position(|window| window == tag).map(|place| place + tag.len());
    let place = place.ok_or_else(|| EncodeError("no grid in the file".to_owned()))?;
    let numbers: Vec<String> = cell.as_flattened().iter().map(|number| format!("{number:?}")).collect();
    let field = format!(
        "<FieldData><DataArray type=\"Float64\" Name=\"{CELL}\" NumberOfComponents=\"3\" NumberOfTuples=\"{}\" \
         format=\"ascii\">{}</DataArray></FieldData>",
        cell.len(),
        numbers.join(" ")
    );
    bytes.splice(place..place, field.into_bytes());
    Ok(())
}

/// A cell for each point, line or facet. Without points a single cell of no points: meshio refuses a file without cells.
fn cells(points: usize, kind: Kind) -> Cells {
    let whole = |numbers: Vec<u32>| numbers.into_iter().map(u64::from).collect::<Vec<_>>();
    let (connectivity, offsets, types) = match kind {
        _ if points == 0 => (Vec::new(), vec![0], vec![CellType::PolyVertex]),
        Kind::Points => each_of(points, 1, CellType::Vertex),
        Kind::Lines => each_of(points, 2, CellType::Line),
        Kind::Facets { corners, ends } => {
            let before = std::iter::once(&0).chain(&ends);
            let shape = |(from, to)| if to - from == 3 { CellType::Triangle } else { CellType::Quad };
            let types = before.zip(&ends).map(shape).collect();
            (whole(corners), whole(ends), types)
        }
    };
    Cells { cell_verts: VertexNumbers::XML { connectivity, offsets }, types }
}

/// Cells of so many points each, in their order: corners, where each cell ends, types.
fn each_of(points: usize, corners: usize, cell: CellType) -> (Vec<u64>, Vec<u64>, Vec<CellType>) {
    let count = points / corners;
    let ends = (1..=count).map(|cell| (cell * corners) as u64).collect();
    ((0..(count * corners) as u64).collect(), ends, vec![cell; count])
}

/// One field as the file has it.
fn attribute((name, values): (&'static str, Values)) -> Attribute {
    Attribute::DataArray(match values {
        Values::Scalars(values) => DataArray { data: IOBuffer::F64(values), ..DataArray::scalars(name, 1) },
        Values::Vectors(values) => DataArray { data: IOBuffer::F64(values), ..DataArray::vectors(name) },
        Values::Quaternions(values) => DataArray { data: IOBuffer::F64(values), ..DataArray::scalars(name, 4) },
        Values::Integers(values) => DataArray { data: IOBuffer::I64(values), ..DataArray::scalars(name, 1) },
        Values::Bytes(values) => DataArray { data: IOBuffer::U8(values), ..DataArray::scalars(name, 1) },
    })
}

/// Says that there are no points: the library leaves a count of 0 out, and no reader takes that.
fn name_no_points(bytes: Vec<u8>) -> Result<Vec<u8>, EncodeError> {
    let text = String::from_utf8(bytes).map_err(|error| EncodeError(error.to_string()))?;
    if text.contains("NumberOfPoints") {
        return Ok(text.into_bytes());
    }
    Ok(text.replacen("<Piece ", "<Piece NumberOfPoints=\"0\" ", 1).into_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vtk_reader::{self, Wanted};

    /// A cloud of `count` points with every kind of field, and numbers that do not survive rounding.
    fn cloud(count: usize) -> PointCloud {
        let reals = |count: usize| (0..count).map(|k| (k as f64 + 0.1) / 3.0).collect::<Vec<_>>();
        PointCloud {
            points: reals(3 * count),
            fields: vec![
                ("radius", Values::Scalars(reals(count))),
                ("velocity", Values::Vectors(reals(3 * count))),
                ("orientation", Values::Quaternions(reals(4 * count))),
                ("id", Values::Integers((0..count as i64).map(|k| k - (1 << 40)).collect())),
                ("sliding", Values::Bytes((0..count).map(|k| (k % 2) as u8).collect())),
            ],
            ..PointCloud::default()
        }
    }

    /// What comes back of a file: its points and its fields as `f64` bits.
    fn read_back(bytes: &[u8]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let file = Vtk::parse_xml(bytes).unwrap();
        let DataSet::UnstructuredGrid { pieces, .. } = file.data else { panic!("not an unstructured grid") };
        let piece = pieces.into_iter().next().unwrap().into_loaded_piece_data(None).unwrap();
        let fields = piece.data.point.into_iter().map(|attribute| match attribute {
            Attribute::DataArray(array) => array.data.cast_into::<f64>().unwrap(),
            Attribute::Field { .. } => panic!("not a plain field"),
        });
        (piece.points.cast_into().unwrap(), fields.collect())
    }

    #[test]
    fn gives_every_bit_back() {
        let bytes = cloud(7).encode(false).unwrap();
        let (points, fields) = read_back(&bytes);
        assert_eq!(points, cloud(7).points);
        for ((name, values), read) in cloud(7).fields.into_iter().zip(fields) {
            let expected = match values {
                Values::Scalars(values) | Values::Vectors(values) | Values::Quaternions(values) => values,
                Values::Integers(values) => values.into_iter().map(|value| value as f64).collect(),
                Values::Bytes(values) => values.into_iter().map(f64::from).collect(),
            };
            assert_eq!(read, expected, "{name}");
        }
    }

    #[test]
    fn compressed_files_give_every_bit_back() {
        // The numbers of a field fill less than a block, blocks to the last byte, and more.
        for count in [7, 8192, 9001] {
            let [plain, compressed] = [false, true].map(|compressed| cloud(count).encode(compressed).unwrap());
            assert!(count < 100 || compressed.len() < plain.len(), "{} of {}", compressed.len(), plain.len());
            let [told, expected] =
                [&compressed, &plain].map(|bytes| vtk_reader::read(bytes, &Wanted::Arrays(&|_| true)).unwrap());
            assert!(told == expected && told[0].arrays.len() == 5, "{count} points");
        }
    }

    #[test]
    fn lines_join_each_two_points() {
        let energy = vec![0.1, 0.2, 0.3];
        let lines = vec![("energy", Values::Scalars(energy.clone()))];
        let bytes = PointCloud { kind: Kind::Lines, cell_fields: lines, ..cloud(6) }.encode(false).unwrap();
        let DataSet::UnstructuredGrid { pieces, .. } = Vtk::parse_xml(&bytes[..]).unwrap().data else {
            panic!("not an unstructured grid")
        };
        let piece = pieces.into_iter().next().unwrap().into_loaded_piece_data(None).unwrap();
        let expected = VertexNumbers::XML { connectivity: vec![0, 1, 2, 3, 4, 5], offsets: vec![2, 4, 6] };
        assert_eq!(piece.cells, Cells { cell_verts: expected, types: vec![CellType::Line; 3] });
        let Attribute::DataArray(array) = &piece.data.cell[0] else { panic!("not a plain field") };
        assert_eq!(array.data.cast_into::<f64>().unwrap(), energy);
    }

    #[test]
    fn names_the_number_of_points_also_where_there_are_none() {
        let text = String::from_utf8(cloud(0).encode(true).unwrap()).unwrap();
        assert!(text.contains(r#"<Piece NumberOfPoints="0" NumberOfCells="1">"#), "{text}");
    }
}
