//! Particles from VTK's XML unstructured grids, read by vtkio: points, and arrays of point data.

use super::{FileFault, POSSIBLE, Request, Rows, needed};
use crate::document::Mistake;
use crate::vtk_reader;
use cograin_vtk::IOBuffer;
use cograin_vtk::model::{Attribute, DataArray, DataSet, Piece, Vtk};

/// Reads a `.vtu` file.
pub(crate) fn read(bytes: &[u8], request: &Request) -> Result<Rows, Vec<FileFault>> {
    let pieces = match vtk_reader::read(bytes) {
        Ok(Vtk { data: DataSet::UnstructuredGrid { pieces, .. }, .. }) => pieces,
        Ok(_) => return Err(refused("VTK data of another kind".to_owned())),
        Err(found) => return Err(refused(found)),
    };
    let mut rows = Rows::default();
    for piece in pieces {
        let Piece::Inline(piece) = piece else {
            return Err(refused("a reference to another file".to_owned()));
        };
        let points = numbers(&piece.points, "points")?;
        rows.count += points.len() / 3;
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            rows.extend(name, points.iter().skip(axis).step_by(3).copied());
        }
        for attribute in &piece.data.point {
            if let Attribute::DataArray(array) = attribute {
                array_of_points(array, request, &mut rows)?;
            }
        }
    }
    let found: Vec<String> = rows.columns.keys().cloned().collect();
    if rows.count > 0 {
        needed(&found, None)?;
    }
    let odd =
        rows.columns.iter().find(|(_, column)| column.len() != rows.count).map(|(name, column)| (name, column.len()));
    if let Some((name, length)) = odd {
        return Err(refused(format!("{length} numbers of {name} for {} points", rows.count)));
    }
    if !rows.label.is_empty() && rows.label.len() != rows.count {
        return Err(refused(format!("{} materials for {} points", rows.label.len(), rows.count)));
    }
    Ok(rows)
}

/// One array of point data, if anything is wanted of it.
fn array_of_points(array: &DataArray, request: &Request, rows: &mut Rows) -> Result<(), Vec<FileFault>> {
    let name = array.name.as_str();
    let parts = match (name, array.elem.num_comp()) {
        ("velocity", 3) => Some(["vx", "vy", "vz"]),
        ("angular_velocity", 3) => Some(["wx", "wy", "wz"]),
        _ => None,
    };
    if let Some(parts) = parts {
        let values = numbers(&array.data, name)?;
        for (axis, part) in parts.into_iter().enumerate() {
            rows.extend(part, values.iter().skip(axis).step_by(3).copied());
        }
        return Ok(());
    }
    if array.elem.num_comp() != 1 {
        return Ok(());
    }
    if name == "material" || name == "type" {
        rows.label_column = name.to_owned();
        for value in numbers(&array.data, name)? {
            rows.push_label(&value.to_string());
        }
    } else if name == "radius" || POSSIBLE.contains(&name) || request.extra.iter().any(|extra| extra == name) {
        let values = numbers(&array.data, name)?;
        rows.extend(name, values.into_iter());
    }
    Ok(())
}

/// The numbers of a buffer, all finite.
fn numbers(buffer: &IOBuffer, name: &str) -> Result<Vec<f64>, Vec<FileFault>> {
    let values: Option<Vec<f64>> = buffer.cast_into();
    let Some(values) = values else { return Err(refused(format!("no numbers in {name}"))) };
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(place) => {
            let mistake = Mistake::Wrong {
                found: format!("{:?} at place {}", values[place], place + 1),
                right: "a finite number".to_owned(),
            };
            Err(vec![FileFault { line: None, column: name.to_owned(), mistake }])
        }
    }
}

/// What was found instead of a readable grid.
fn refused(found: String) -> Vec<FileFault> {
    let right = "an unstructured grid (.vtu) with ascii or base64 data, plain or packed by zlib or lz4".to_owned();
    vec![FileFault::whole(Mistake::Wrong { found, right })]
}
