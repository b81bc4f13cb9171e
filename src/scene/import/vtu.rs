//! Particles from VTK files: points of an unstructured grid or of polygonal data, and arrays of point data.

use super::bodies::{Bodies, CELL, UNWRAPPED, cell_of};
use super::rows::twice;
use super::{FileFault, Request, Rows};
use crate::base::document::Mistake;
use crate::base::vtk_reader::{self, Array, Piece, Wanted};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Arrays that hold several columns: name, and names of the columns.
const SEVERAL: [(&str, &[&str]); 5] = [
    ("velocity", &["vx", "vy", "vz"]),
    ("angular_velocity", &["wx", "wy", "wz"]),
    // As LIGGGHTS writes them.
    ("v", &["vx", "vy", "vz"]),
    ("omega", &["wx", "wy", "wz"]),
    (ORIENTATION, &["qw", "qx", "qy", "qz"]),
];

/// How clumps are turned.
const ORIENTATION: &str = "orientation";

/// Reads a `.vtu`, `.vtp` or `.vtk` file.
pub(crate) fn read(bytes: &[u8], request: &Request) -> Result<Rows, Vec<FileFault>> {
    let left_out = RefCell::new(BTreeSet::new());
    let wanted = |name: &str| {
        let joint = SEVERAL.iter().any(|(array, _)| *array == name);
        let turns = name != ORIENTATION || request.bodies == Bodies::Clumps;
        let is_read = joint && turns || ["material", "type", UNWRAPPED].contains(&name) || request.reads(name);
        if !is_read && request.misses(name) {
            left_out.borrow_mut().insert(name.to_owned());
        }
        is_read
    };
    let mut pieces = vtk_reader::read(bytes, &Wanted::Arrays(&wanted)).map_err(refused)?;
    let field = pieces.first_mut().and_then(|piece| {
        let place = piece.fields.iter().position(|field| field.name == CELL)?;
        Some(piece.fields.swap_remove(place))
    });
    let mut rows = Rows { around: field.as_ref().map(cell_of).transpose()?, ..Rows::default() };
    for piece in pieces {
        points(&piece, &mut rows)?;
        for array in piece.arrays.into_iter().filter(|array| array.name != UNWRAPPED) {
            array_of_points(array, &mut rows)?;
        }
    }
    rows.left_out = left_out.into_inner().into_iter().collect();
    let found: Vec<String> = rows.columns.keys().cloned().collect();
    if rows.count > 0 {
        request.needed(&found, None)?;
    }
    let odd =
        rows.columns.iter().find(|(_, column)| column.len() != rows.count).map(|(name, column)| (name, column.len()));
    if let Some((name, length)) = odd {
        return Err(refused(format!("{length} numbers of {name} for {} points", rows.count)));
    }
    rows.expect_labels()?;
    Ok(rows)
}

/// Where the points of a piece are: without the cell, where a frame of one says it.
fn points(piece: &Piece, rows: &mut Rows) -> Result<(), Vec<FileFault>> {
    rows.count += piece.points.len();
    let unwrapped = piece.arrays.iter().find(|array| array.name == UNWRAPPED);
    if unwrapped.is_some() && rows.around.is_none() {
        let found = format!("an array {UNWRAPPED} of a periodic cell without the field {CELL}");
        return Err(refused_as(found, "its edges beside it: a frame of this version"));
    }
    let places = match unwrapped {
        Some(array) => array.values.chunks_exact(array.components.max(1)).map(<[f64]>::to_vec).collect(),
        None => piece.points.iter().map(|point| point.to_vec()).collect::<Vec<_>>(),
    };
    if let Some(place) = places.iter().find(|place| place.len() != 3) {
        return Err(refused_as(format!("{} numbers of {UNWRAPPED} at a point", place.len()), "three"));
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let values: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        rows.extend(name, finite(values, "points")?.into_iter());
    }
    Ok(())
}

/// One array of point data.
fn array_of_points(array: Array, rows: &mut Rows) -> Result<(), Vec<FileFault>> {
    let Array { name, components, values } = array;
    if let Some((_, columns)) = SEVERAL.iter().find(|(array, _)| *array == name) {
        if components != columns.len() {
            let found = format!("{components} numbers of {name} at a point");
            return Err(refused_as(found, &format!("{}: {}", columns.len(), columns.join(", "))));
        }
        let values = finite(values, &name)?;
        for (place, column) in columns.iter().enumerate() {
            rows.extend(column, values.iter().skip(place).step_by(components).copied());
        }
        return Ok(());
    }
    if components != 1 {
        return Err(refused_as(format!("{components} numbers of {name} at a point"), "one"));
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

/// What was found in a grid that can be read, and what was expected.
fn refused_as(found: String, expected: &str) -> Vec<FileFault> {
    vec![FileFault::whole(Mistake::Unexpected { found, expected: expected.to_owned() })]
}

/// What was found instead of a readable grid.
fn refused(found: String) -> Vec<FileFault> {
    let expected = "points of a VTK file (.vtu, .vtp, .vtk), plain or packed by zlib or lz4".to_owned();
    vec![FileFault::whole(Mistake::Unexpected { found, expected })]
}
