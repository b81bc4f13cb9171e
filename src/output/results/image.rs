//! Fields on a grid as a `.vti` file: image data of VTK, a number for each cell.

use super::vtk::EncodeError;
use crate::interface::{Field, Type};
use crate::laws::region::Grid;
use cograin_vtk::model::{
    Attribute, Attributes, ByteOrder, DataArray, DataSet, Extent, IOBuffer, ImageDataPiece, Piece, Version, Vtk,
};

/// The file of these fields, which may be compressed.
pub(super) fn encode(grid: &Grid, fields: Vec<Field>, compressed: bool) -> Result<Vec<u8>, EncodeError> {
    let extent = || Extent::Ranges(grid.counts.map(|count| 0..=count as i32));
    let names: Vec<_> = fields.iter().map(|field| (field.name, field.components.clone())).collect();
    let cell = fields.into_iter().map(attribute).collect();
    let piece = ImageDataPiece { extent: extent(), data: Attributes { point: Vec::new(), cell } };
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::ImageData {
            extent: extent(),
            origin: [0.0; 3],
            spacing: [1.0; 3],
            meta: None,
            pieces: vec![Piece::Inline(Box::new(piece))],
        },
    };
    let bytes = cograin_vtk::write(file, compressed).map_err(|error| EncodeError(error.to_string()))?;
    let mut text = String::from_utf8(bytes).map_err(|error| EncodeError(error.to_string()))?;
    // The library keeps the two with 32 bits: digits give every bit back.
    for (key, numbers) in [("Origin", grid.corners[0]), ("Spacing", grid.edges())] {
        let place = value_of(&text, key).ok_or_else(|| EncodeError(format!("no {key} in the file")))?;
        text.replace_range(place, &numbers.map(|number| format!("{number:?}")).join(" "));
    }
    for (name, components) in names.into_iter().filter(|(_, components)| components.len() > 1) {
        // The library has no names of components.
        let tag = format!(" Name=\"{name}\"");
        let named = (0..).zip(components).map(|(place, own)| format!(" ComponentName{place}=\"{own}\""));
        text = text.replacen(&tag, &format!("{tag}{}", named.collect::<String>()), 1);
    }
    Ok(text.into_bytes())
}

/// Where the value of an attribute stands in the text of a file.
fn value_of(text: &str, key: &str) -> Option<std::ops::Range<usize>> {
    let begins = format!(" {key}=\"");
    let from = text.find(&begins)? + begins.len();
    Some(from..from + text[from..].find('"')?)
}

/// One field as the file has it.
fn attribute(field: Field) -> Attribute {
    let is_whole = field.quantity.of_type() == Type::Integer;
    let data = match is_whole {
        true => IOBuffer::I64(field.values.into_iter().map(|value| value as i64).collect()),
        false => IOBuffer::F64(field.values),
    };
    let empty = match field.components.len() {
        3 if !is_whole => DataArray::vectors(field.name),
        components => DataArray::scalars(field.name, components as u32),
    };
    Attribute::DataArray(DataArray { data, ..empty })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::Quantity;

    #[test]
    fn gives_every_bit_back_and_names_components() {
        let grid = Grid { corners: [[0.1, -0.2, 1e-7], [0.3, 0.7, 0.9]], counts: [3, 2, 4], repeats: [false; 3] };
        let reals = |count: usize| (0..count).map(|k| (k as f64 + 0.1) / 3.0).collect::<Vec<_>>();
        let field = |name: &'static str, quantity, components: &[&str], values| Field {
            name,
            quantity,
            components: components.iter().map(|&it| it.to_owned()).collect(),
            values,
        };
        let fields = vec![
            field("porosity", Quantity::Ratio, &[""], reals(24)),
            field("velocity", Quantity::Velocity, &["x", "y", "z"], reals(72)),
            field("stress", Quantity::Pressure, &["xx", "yy", "zz", "xy", "xz", "yz"], reals(144)),
            field("count", Quantity::Count, &[""], (0..24).map(f64::from).collect()),
        ];
        let bytes = encode(&grid, fields.clone(), false).unwrap();
        let text = std::str::from_utf8(&bytes).unwrap();
        for part in [
            "WholeExtent=\"0 3 0 2 0 4\"",
            "Origin=\"0.1 -0.2 1e-7\"",
            "ComponentName3=\"xy\" ComponentName4=\"xz\"",
            "Name=\"velocity\" ComponentName0=\"x\"",
        ] {
            assert!(text.contains(part), "{part} in {}", &text[..600]);
        }
        let DataSet::ImageData { pieces, .. } = Vtk::parse_xml(&bytes[..]).unwrap().data else { panic!("no image") };
        let piece = pieces.into_iter().next().unwrap().into_loaded_piece_data(None).unwrap();
        assert_eq!(piece.data.cell.len(), fields.len());
        for (field, attribute) in fields.into_iter().zip(piece.data.cell) {
            let Attribute::DataArray(array) = attribute else { panic!("not a plain field") };
            assert_eq!((array.name.as_str(), array.num_comp()), (field.name, field.components.len()));
            assert_eq!(array.data.cast_into::<f64>().unwrap(), field.values);
        }
    }
}
