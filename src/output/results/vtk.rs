//! Points, and lines and facets between them, as `.vtu` files, which meshio and VTK read back bit for bit.
//!
//! Random mantissas hardly compress, and compressing costs many times the writing: it is done where a scene asks for it.

use crate::base::vtk_writer::{Array, File, Numbers};
use crate::scene::import::CELL;
use std::io::{self, Write};

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

impl Values {
    /// The array of this name.
    fn array<'a>(&'a self, name: &'a str) -> Array<'a> {
        let (components, numbers) = match self {
            Self::Scalars(values) => (1, Numbers::Reals(values)),
            Self::Vectors(values) => (3, Numbers::Reals(values)),
            Self::Quaternions(values) => (4, Numbers::Reals(values)),
            Self::Integers(values) => (1, Numbers::Integers(values)),
            Self::Bytes(values) => (1, Numbers::Bytes(values)),
        };
        Array { name, components, named: &[], numbers }
    }
}

/// The arrays of fields.
fn arrays<'a>(fields: &'a [(&'static str, Values)]) -> Vec<Array<'a>> {
    fields.iter().map(|(name, values)| values.array(name)).collect()
}

impl PointCloud {
    /// Writes the cloud as a `.vtu` file, which may be compressed.
    pub(crate) fn write(&self, out: &mut impl Write, compressed: bool) -> io::Result<()> {
        let (points, cells) = (self.points.len() / 3, Cells::of(self.points.len() / 3, &self.kind));
        // The one cell of a file without points has no values.
        let cell_fields = if points == 0 { &[] } else { &self.cell_fields[..] };
        // Readers expect blocks, and an array without numbers has none.
        let mut file = File::begin(out, "UnstructuredGrid", compressed && points > 0)?;
        write!(file, "<UnstructuredGrid>")?;
        self.write_cell(&mut file)?;
        write!(file, "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{}\">", cells.types.len())?;
        file.attributes("PointData", &arrays(&self.fields))?;
        file.attributes("CellData", &arrays(cell_fields))?;
        write!(file, "<Points>")?;
        file.array(&Array { name: "Points", components: 3, named: &[], numbers: Numbers::Reals(&self.points) })?;
        write!(file, "</Points><Cells>")?;
        cells.arrays().iter().try_for_each(|array| file.array(array))?;
        write!(file, "</Cells></Piece></UnstructuredGrid>")?;
        file.end()
    }

    /// Writes the field of the periodic cell: digits give every bit back.
    fn write_cell(&self, file: &mut File<impl Write>) -> io::Result<()> {
        if self.cell.is_empty() {
            return Ok(());
        }
        let numbers: Vec<String> = self.cell.as_flattened().iter().map(|number| format!("{number:?}")).collect();
        write!(
            file,
            "<FieldData><DataArray type=\"Float64\" Name=\"{CELL}\" NumberOfComponents=\"3\" NumberOfTuples=\"{}\" \
             format=\"ascii\">{}</DataArray></FieldData>",
            self.cell.len(),
            numbers.join(" ")
        )
    }
}

/// What VTK calls a cell of one point.
const VERTEX: u8 = 1;

/// The same of any number of points.
const POINTS: u8 = 2;

/// The same of a line.
const LINE: u8 = 3;

/// The same of a triangle.
const TRIANGLE: u8 = 5;

/// The same of four corners in a ring.
const QUADRILATERAL: u8 = 9;

/// A cell of the file for each point, line or facet.
struct Cells {
    /// The points of each, one behind the other.
    corners: Vec<u64>,
    /// Behind the last point of each.
    ends: Vec<u64>,
    /// What each is.
    types: Vec<u8>,
}

impl Cells {
    /// The cells of so many points. Without points a single cell of no points: meshio refuses a file without cells.
    fn of(points: usize, kind: &Kind) -> Self {
        let whole = |numbers: &[u32]| numbers.iter().copied().map(u64::from).collect();
        match kind {
            _ if points == 0 => Self { corners: Vec::new(), ends: vec![0], types: vec![POINTS] },
            Kind::Points => Self::of_each(points, 1, VERTEX),
            Kind::Lines => Self::of_each(points, 2, LINE),
            Kind::Facets { corners, ends } => {
                let before = std::iter::once(&0).chain(ends);
                let shape = |(from, to)| if to - from == 3 { TRIANGLE } else { QUADRILATERAL };
                let types = before.zip(ends).map(shape).collect();
                Self { corners: whole(corners), ends: whole(ends), types }
            }
        }
    }

    /// Cells of so many points each, in their order.
    fn of_each(points: usize, corners: usize, kind: u8) -> Self {
        let count = points / corners;
        let ends = (1..=count).map(|cell| (cell * corners) as u64).collect();
        Self { corners: (0..(count * corners) as u64).collect(), ends, types: vec![kind; count] }
    }

    /// The arrays that say them.
    fn arrays(&self) -> [Array<'_>; 3] {
        let array = |name, numbers| Array { name, components: 1, named: &[], numbers };
        [
            array("connectivity", Numbers::Places(&self.corners)),
            array("offsets", Numbers::Places(&self.ends)),
            array("types", Numbers::Bytes(&self.types)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vtk_reader::{self, Wanted};
    use vtkio::Vtk;
    use vtkio::model::{Attribute, CellType, Cells, DataSet, VertexNumbers};

    /// The bytes of a cloud.
    fn bytes(cloud: &PointCloud) -> Vec<u8> {
        let mut bytes = Vec::new();
        cloud.write(&mut bytes, false).unwrap();
        bytes
    }

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
        let bytes = bytes(&cloud(7));
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
    fn files_are_what_vtkio_makes_of_their_contents() {
        let facets = Kind::Facets { corners: vec![0, 1, 2, 2, 3, 4, 5], ends: vec![3, 7] };
        let loads = vec![("boundary", Values::Integers(vec![0, 1])), ("force", Values::Vectors(vec![-1e-300; 6]))];
        for cloud in [cloud(1), cloud(4096), PointCloud { kind: facets, cell_fields: loads, ..cloud(6) }] {
            let (own, mut others) = (bytes(&cloud), Vec::new());
            let mut file = Vtk::parse_xml(&own[..]).unwrap();
            file.load_all_pieces().unwrap();
            file.write_xml(&mut others).unwrap();
            assert!(own == others, "{}", String::from_utf8_lossy(&others[..900.min(others.len())]));
        }
    }

    #[test]
    fn compressed_files_give_every_bit_back() {
        // The numbers of a field fill less than a block, blocks to the last byte, and more.
        for count in [7, 8192, 9001] {
            let mut compressed = Vec::new();
            cloud(count).write(&mut compressed, true).unwrap();
            let plain = bytes(&cloud(count));
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
        let bytes = bytes(&PointCloud { kind: Kind::Lines, cell_fields: lines, ..cloud(6) });
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
        let text = String::from_utf8(bytes(&cloud(0))).unwrap();
        assert!(text.contains(r#"<Piece NumberOfPoints="0" NumberOfCells="1">"#), "{text}");
    }
}
