//! Fields on a grid as a `.vti` file: image data of VTK, a number for each cell.

use crate::base::vtk_writer::{Array, File, Numbers};
use crate::interface::{Field, Type};
use crate::laws::region::Grid;
use std::io::{self, Write};

/// Writes the file of these fields, which may be compressed.
pub(super) fn write(grid: &Grid, fields: &[Field], out: &mut impl Write, compressed: bool) -> io::Result<()> {
    let is_whole = |field: &Field| field.quantity.of_type() == Type::Integer;
    let integers = |field: &Field| field.values.iter().map(|value| *value as i64).collect();
    let whole: Vec<Vec<i64>> =
        fields.iter().map(|field| if is_whole(field) { integers(field) } else { Vec::new() }).collect();
    let array = |(field, whole)| array(field, is_whole(field).then_some(whole));
    let arrays: Vec<Array<'_>> = fields.iter().zip(&whole).map(array).collect();
    let extent = grid.counts.map(|count| format!("0 {count}")).join(" ");
    // Digits give every bit back.
    let [origin, spacing] = [grid.corners[0], grid.edges()].map(|three| three.map(|it| format!("{it:?}")).join(" "));
    let mut file = File::begin(out, "ImageData", compressed)?;
    write!(
        file,
        "<ImageData WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{spacing}\"><Piece Extent=\"{extent}\">"
    )?;
    file.attributes("CellData", &arrays)?;
    write!(file, "</Piece></ImageData>")?;
    file.end()
}

/// One field as the file has it, of these whole numbers if it has any.
fn array<'a>(field: &'a Field, whole: Option<&'a Vec<i64>>) -> Array<'a> {
    let numbers = whole.map_or(Numbers::Reals(&field.values), |whole| Numbers::Integers(whole));
    let named = if field.components.len() > 1 { &field.components[..] } else { &[] };
    Array { name: field.name, components: field.components.len(), named, numbers }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::Quantity;
    use vtkio::Vtk;
    use vtkio::model::{Attribute, DataSet};

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
        let mut bytes = Vec::new();
        write(&grid, &fields, &mut bytes, false).unwrap();
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
