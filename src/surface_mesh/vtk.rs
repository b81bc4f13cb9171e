//! Surfaces in VTK files, read by vtkio: polygons, strips, and cells that are triangles or quads.

use super::read::{MeshError, Soup};
use crate::vtk_reader;
use vtkio::model::{CellType, Cells, DataSet, IOBuffer, Piece, VertexNumbers};

/// What is right.
const RIGHT: &str = "a VTK file with triangles, quads, polygons or triangle strips";

/// Reads a VTK file, legacy or XML.
pub(super) fn read(bytes: &[u8]) -> Result<Soup, MeshError> {
    let file = vtk_reader::read(bytes).map_err(|found| MeshError::whole(found, RIGHT))?;
    let mut soup = Soup::default();
    let mut face = 0;
    match file.data {
        DataSet::PolyData { pieces, .. } => {
            for piece in pieces {
                let Piece::Inline(piece) = piece else { return Err(MeshError::whole("a reference to a file", RIGHT)) };
                let first = points(&piece.points, &mut soup)?;
                for (cells, strips) in [(piece.polys, false), (piece.strips, true)] {
                    let Some(cells) = cells else { continue };
                    for cell in split(cells, face)? {
                        face += 1;
                        let cell = shifted(&cell, first, face)?;
                        if strips { strip(&mut soup, &cell, face)? } else { soup.polygon(&cell, face)? }
                    }
                }
            }
        }
        DataSet::UnstructuredGrid { pieces, .. } => {
            for piece in pieces {
                let Piece::Inline(piece) = piece else { return Err(MeshError::whole("a reference to a file", RIGHT)) };
                let first = points(&piece.points, &mut soup)?;
                let Cells { cell_verts, types } = piece.cells;
                for (cell, kind) in split(cell_verts, face)?.iter().zip(types) {
                    face += 1;
                    let cell = shifted(cell, first, face)?;
                    match kind {
                        CellType::Triangle | CellType::Quad | CellType::Polygon => soup.polygon(&cell, face)?,
                        CellType::TriangleStrip => strip(&mut soup, &cell, face)?,
                        other => return Err(MeshError::at_face(face, format!("a cell of type {other:?}"), RIGHT)),
                    }
                }
            }
        }
        _ => return Err(MeshError::whole("VTK data of another kind", RIGHT)),
    }
    Ok(soup)
}

/// Adds points; the number of the first.
fn points(buffer: &IOBuffer, soup: &mut Soup) -> Result<usize, MeshError> {
    let first = soup.vertices.len();
    let values: Vec<f64> = buffer.cast_into().ok_or_else(|| MeshError::whole("points that are no numbers", RIGHT))?;
    for (number, point) in (1..).zip(values.chunks_exact(3)) {
        let point = [point[0], point[1], point[2]];
        if point.iter().any(|part| !part.is_finite()) {
            return Err(MeshError::whole(format!("point {number} at {point:?}"), "finite numbers"));
        }
        soup.vertices.push(point);
    }
    Ok(first)
}

/// The vertices of each cell.
fn split(cells: VertexNumbers, face: usize) -> Result<Vec<Vec<u64>>, MeshError> {
    let damaged = || MeshError::at_face(face + 1, "a list of corners that is cut short", RIGHT);
    let mut list = Vec::new();
    match cells {
        VertexNumbers::XML { connectivity, offsets } => {
            let mut start = 0;
            for end in offsets {
                let end = usize::try_from(end).map_err(|_| damaged())?;
                list.push(connectivity.get(start..end).ok_or_else(damaged)?.to_vec());
                start = end;
            }
        }
        VertexNumbers::Legacy { vertices, .. } => {
            let mut rest = &vertices[..];
            while let [count, after @ ..] = rest {
                let count = *count as usize;
                list.push(after.get(..count).ok_or_else(damaged)?.iter().map(|vertex| u64::from(*vertex)).collect());
                rest = &after[count..];
            }
        }
    }
    Ok(list)
}

/// Corners counted from the first point of all pieces.
fn shifted(cell: &[u64], first: usize, face: usize) -> Result<Vec<u32>, MeshError> {
    let corner = |vertex: &u64| u32::try_from(vertex.checked_add(first as u64)?).ok();
    cell.iter()
        .map(|vertex| corner(vertex).ok_or_else(|| MeshError::at_face(face, format!("vertex {vertex}"), RIGHT)))
        .collect()
}

/// The triangles of a strip: every second one is turned round.
fn strip(soup: &mut Soup, corners: &[u32], face: usize) -> Result<(), MeshError> {
    for (index, triangle) in corners.windows(3).enumerate() {
        let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
        soup.polygon(&if index % 2 == 0 { [a, b, c] } else { [b, a, c] }, face)?;
    }
    Ok(())
}
