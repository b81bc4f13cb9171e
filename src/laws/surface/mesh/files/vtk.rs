//! Surfaces in VTK files: polygons, strips, and cells that are triangles or quads.

use super::{Triangles, Wrong, add_polygon};
use crate::base::vtk_reader::{self, Cell, POLYGON, TRIANGLE_STRIP, Wanted};

/// What is expected.
const EXPECTED: &str = "a VTK file with triangles, quads, polygons or triangle strips";

/// VTK's number of a triangle.
const TRIANGLE: u8 = 5;

/// VTK's number of a rectangle whose corners are numbered by rows.
const PIXEL: u8 = 8;

/// VTK's number of a quadrilateral.
const QUAD: u8 = 9;

/// A refusal.
fn wrong(found: impl Into<String>) -> Wrong {
    (found.into(), EXPECTED.to_owned())
}

/// The triangles of a file, legacy or XML.
pub(super) fn read(bytes: &[u8]) -> Result<Triangles, Wrong> {
    let mut triangles = Triangles::new();
    let mut face = 0;
    for piece in vtk_reader::read(bytes, &Wanted::Cells).map_err(wrong)? {
        for cell in &piece.cells {
            face += 1;
            add_cell(&corners(cell, &piece.points, face)?, cell.kind, face, &mut triangles)?;
        }
    }
    Ok(triangles)
}

/// Where the corners of a cell are.
fn corners(cell: &Cell, points: &[[f64; 3]], face: usize) -> Result<Vec<[f64; 3]>, Wrong> {
    let strange = |vertex: &usize| wrong(format!("face {face} with vertex {vertex} of {}", points.len()));
    cell.corners.iter().map(|vertex| points.get(*vertex).copied().ok_or_else(|| strange(vertex))).collect()
}

/// Adds the triangles of a cell.
fn add_cell(corners: &[[f64; 3]], kind: u8, face: usize, triangles: &mut Triangles) -> Result<(), Wrong> {
    match kind {
        TRIANGLE | QUAD | POLYGON => add_polygon(corners, face, triangles),
        PIXEL => match *corners {
            [a, b, c, d] => add_polygon(&[a, b, d, c], face, triangles),
            _ => add_polygon(&[], face, triangles),
        },
        // Every second triangle of a strip runs the other way round.
        TRIANGLE_STRIP => {
            let strip = (0..).zip(corners.windows(3));
            triangles.extend(
                strip.map(|(place, it)| if place % 2 == 0 { [it[0], it[1], it[2]] } else { [it[1], it[0], it[2]] }),
            );
            Ok(())
        }
        other => Err(wrong(format!("face {face}, a cell of VTK type {other}"))),
    }
}
