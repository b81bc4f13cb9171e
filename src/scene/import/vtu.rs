//! Particles from VTK files: points of an unstructured grid or of polygonal data, and arrays of point data.

use super::{FileFault, POSSIBLE, Request, Rows, needed, twice};
use crate::base::document::Mistake;
use crate::base::vtk_reader::{self, Array, Wanted};

/// Reads a `.vtu`, `.vtp` or `.vtk` file.
pub(crate) fn read(bytes: &[u8], request: &Request) -> Result<Rows, Vec<FileFault>> {
    let wanted = |name: &str| {
        ["velocity", "angular_velocity", "material", "type", "radius"].contains(&name)
            || POSSIBLE.contains(&name)
            || request.extra.iter().any(|extra| extra == name)
    };
    let pieces = vtk_reader::read(bytes, &Wanted::Arrays(&wanted)).map_err(refused)?;
    let mut rows = Rows::default();
    for piece in pieces {
        rows.count += piece.points.len();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let values: Vec<f64> = piece.points.iter().map(|point| point[axis]).collect();
            rows.extend(name, finite(values, "points")?.into_iter());
        }
        for array in piece.arrays {
            array_of_points(array, &mut rows)?;
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
    rows.expect_labels()?;
    Ok(rows)
}

/// One array of point data.
fn array_of_points(array: Array, rows: &mut Rows) -> Result<(), Vec<FileFault>> {
    let Array { name, components, values } = array;
    let parts = match (name.as_str(), components) {
        ("velocity", 3) => Some(["vx", "vy", "vz"]),
        ("angular_velocity", 3) => Some(["wx", "wy", "wz"]),
        _ => None,
    };
    if let Some(parts) = parts {
        let values = finite(values, &name)?;
        for (axis, part) in parts.into_iter().enumerate() {
            rows.extend(part, values.iter().skip(axis).step_by(3).copied());
        }
        return Ok(());
    }
    if components != 1 {
        return Ok(());
    }
    let values = finite(values, &name)?;
    if name == "material" || name == "type" {
        if !rows.label_column.is_empty() && rows.label_column != name {
            return Err(twice(["material", "type"], None));
        }
        for value in values {
            rows.push_label(&value.to_string());
        }
        rows.label_column = name;
    } else {
        rows.extend(&name, values.into_iter());
    }
    Ok(())
}

/// The numbers, all finite.
fn finite(values: Vec<f64>, name: &str) -> Result<Vec<f64>, Vec<FileFault>> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(place) => {
            let mistake = Mistake::Unexpected {
                found: format!("{:?} at place {}", values[place], place + 1),
                expected: "a finite number".to_owned(),
            };
            Err(vec![FileFault { line: None, column: name.to_owned(), mistake }])
        }
    }
}

/// What was found instead of a readable grid.
fn refused(found: String) -> Vec<FileFault> {
    let expected = "points of a VTK file (.vtu, .vtp, .vtk), plain or packed by zlib or lz4".to_owned();
    vec![FileFault::whole(Mistake::Unexpected { found, expected })]
}
