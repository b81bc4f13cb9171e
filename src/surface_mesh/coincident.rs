//! Triangles in one plane that cover one another in part: both would count.

use super::SurfaceMesh;
use crate::number::Vector;

/// The first two triangles found that lie on one another, if any do.
pub(super) fn coincident(mesh: &SurfaceMesh, tolerance: f64) -> Option<[usize; 2]> {
    let bounds: Vec<[[f64; 3]; 2]> = mesh.triangles.iter().map(|corners| bounds(mesh, *corners)).collect();
    let widest = widest(&bounds);
    let mut order: Vec<usize> = (0..bounds.len()).collect();
    order.sort_by(|a, b| bounds[*a][0][widest].total_cmp(&bounds[*b][0][widest]));
    for (place, a) in order.iter().enumerate() {
        let reach = bounds[*a][1][widest];
        for b in order[place + 1..].iter().take_while(|b| bounds[**b][0][widest] <= reach) {
            let apart = (0..3).any(|axis| {
                bounds[*a][0][axis] > bounds[*b][1][axis] + tolerance
                    || bounds[*b][0][axis] > bounds[*a][1][axis] + tolerance
            });
            if !apart && lie_on_one_another(mesh, *a, *b, tolerance) {
                return Some([*a.min(b), *a.max(b)]);
            }
        }
    }
    None
}

/// The smallest box around a triangle.
fn bounds(mesh: &SurfaceMesh, corners: [u32; 3]) -> [[f64; 3]; 2] {
    let at = corners.map(|corner| mesh.vertices[corner as usize]);
    let part = |axis: usize, least: fn(f64, f64) -> f64| least(at[0][axis], least(at[1][axis], at[2][axis]));
    [[0, 1, 2].map(|axis| part(axis, f64::min)), [0, 1, 2].map(|axis| part(axis, f64::max))]
}

/// The axis along which the mesh is longest.
fn widest(bounds: &[[[f64; 3]; 2]]) -> usize {
    let extent = |axis: usize| {
        let lower = bounds.iter().map(|it| it[0][axis]).fold(f64::INFINITY, f64::min);
        bounds.iter().map(|it| it[1][axis]).fold(f64::NEG_INFINITY, f64::max) - lower
    };
    (1..3).fold(0, |widest, axis| if extent(axis) > extent(widest) { axis } else { widest })
}

/// Whether two triangles are in one plane and no line in it parts them.
fn lie_on_one_another(mesh: &SurfaceMesh, a: usize, b: usize, tolerance: f64) -> bool {
    let corners = [a, b].map(|triangle| mesh.triangles[triangle].map(|corner| mesh.at(corner)));
    let normals = [a, b].map(|triangle| super::vector(mesh.normals[triangle]));
    let flat = |of: usize, other: usize| {
        corners[other].iter().all(|corner| (*corner - corners[of][0]).dot(normals[of]).abs() <= tolerance)
    };
    if !flat(0, 1) || !flat(1, 0) {
        return false;
    }
    let parted = |of: usize, other: usize| {
        (0..3).any(|side| {
            let (from, to) = (corners[of][side], corners[of][(side + 1) % 3]);
            let outward = (to - from).cross(normals[of]);
            let outward: Vector = outward * (1.0 / outward.length());
            corners[other].iter().all(|corner| (*corner - from).dot(outward) >= -tolerance)
        })
    };
    !parted(0, 1) && !parted(1, 0)
}
