//! Surfaces in VTK files, read by vtkio: polygons, strips, and cells that are triangles or quads.

use super::{Triangles, Wrong, add_polygon};
use crate::vtk_reader;
use cograin_vtk::model::{CellType, DataSet, IOBuffer, Piece, VertexNumbers};

/// What is right.
const RIGHT: &str = "a VTK file with triangles, quads, polygons or triangle strips";

/// A refusal.
fn wrong(found: impl Into<String>) -> Wrong {
    (found.into(), RIGHT.to_owned())
}

/// The triangles of a file, legacy or XML.
pub(super) fn read(bytes: &[u8]) -> Result<Triangles, Wrong> {
    let mut triangles = Triangles::new();
    let mut face = 0;
    match vtk_reader::read(bytes).map_err(wrong)?.data {
        DataSet::PolyData { pieces, .. } => {
            for piece in pieces {
                let Piece::Inline(piece) = piece else { return Err(wrong("a reference to another file")) };
                let points = points(&piece.points)?;
                let polygons = piece.polys.map(|cells| (cells, CellType::Polygon));
                let strips = piece.strips.map(|cells| (cells, CellType::TriangleStrip));
                for (cells, kind) in [polygons, strips].into_iter().flatten() {
                    for cell in split(cells)? {
                        face += 1;
                        add_cell(&corners(&cell, &points, face)?, kind, face, &mut triangles)?;
                    }
                }
            }
        }
        DataSet::UnstructuredGrid { pieces, .. } => {
            for piece in pieces {
                let Piece::Inline(piece) = piece else { return Err(wrong("a reference to another file")) };
                let points = points(&piece.points)?;
                for (cell, kind) in split(piece.cells.cell_verts)?.iter().zip(piece.cells.types) {
                    face += 1;
                    add_cell(&corners(cell, &points, face)?, kind, face, &mut triangles)?;
                }
            }
        }
        _ => return Err(wrong("VTK data of another kind")),
    }
    Ok(triangles)
}

/// The points of a piece.
fn points(buffer: &IOBuffer) -> Result<Vec<[f64; 3]>, Wrong> {
    let values: Vec<f64> = buffer.cast_into().ok_or_else(|| wrong("points that are no numbers"))?;
    Ok(values.chunks_exact(3).map(|point| [point[0], point[1], point[2]]).collect())
}

/// The vertices of each cell.
fn split(cells: VertexNumbers) -> Result<Vec<Vec<u64>>, Wrong> {
    let cut = || wrong("a list of corners that is cut short");
    let mut list = Vec::new();
    match cells {
        VertexNumbers::XML { connectivity, offsets } => {
            let mut start = 0;
            for end in offsets {
                let end = usize::try_from(end).map_err(|_| cut())?;
                list.push(connectivity.get(start..end).ok_or_else(cut)?.to_vec());
                start = end;
            }
        }
        VertexNumbers::Legacy { vertices, .. } => {
            let mut rest = &vertices[..];
            while let [count, after @ ..] = rest {
                let count = *count as usize;
                list.push(after.get(..count).ok_or_else(cut)?.iter().map(|vertex| u64::from(*vertex)).collect());
                rest = &after[count..];
            }
        }
    }
    Ok(list)
}

/// Where the corners of a cell are.
fn corners(cell: &[u64], points: &[[f64; 3]], face: usize) -> Result<Vec<[f64; 3]>, Wrong> {
    let corner = |vertex: &u64| usize::try_from(*vertex).ok().and_then(|place| points.get(place).copied());
    let strange = |vertex: &u64| wrong(format!("face {face} with vertex {vertex} of {}", points.len()));
    cell.iter().map(|vertex| corner(vertex).ok_or_else(|| strange(vertex))).collect()
}

/// Adds the triangles of a cell.
fn add_cell(corners: &[[f64; 3]], kind: CellType, face: usize, triangles: &mut Triangles) -> Result<(), Wrong> {
    match kind {
        CellType::Triangle | CellType::Quad | CellType::Polygon => add_polygon(corners, face, triangles),
        // Every second triangle of a strip runs the other way round.
        CellType::TriangleStrip => {
            let strip = (0..).zip(corners.windows(3));
            triangles.extend(
                strip.map(|(place, it)| if place % 2 == 0 { [it[0], it[1], it[2]] } else { [it[1], it[0], it[2]] }),
            );
            Ok(())
        }
        other => Err(wrong(format!("face {face}, a cell of type {other:?}"))),
    }
}
