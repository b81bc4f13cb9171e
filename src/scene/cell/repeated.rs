//! What repeats with a cell: copies of surfaces, and images of spheres.

use super::refused::{Objection, objections};
use super::{AXES, MOST_IMAGES};
use crate::base::document::Mistake;
use crate::base::geometry::Lattice;
use crate::base::number::Vector;
use crate::laws::surface::Copies;
use crate::scene::{AxisMotion, Boundary, SceneDraft};

/// A surface that is so many times as wide as its copy is away meets it.
const WIDE: f64 = 1.0 + 1e-6;

/// Lets surfaces go on through the faces of a cell that repeats.
pub(in crate::scene) fn repeat_surfaces(scene: &mut SceneDraft) -> Vec<Objection> {
    let Some(cell) = scene.cell.filter(|_| objections(scene).is_empty()) else { return Vec::new() };
    let largest = scene.radii().fold(0.0, f64::max);
    // Lists reach by the skin and what a law holds beyond touch; particles may be out of the cell by the skin, spheres by their clump.
    let reach = 2.0 * (largest + scene.run.skin.unwrap_or(0.0).max(largest)) + scene.widest_clump();
    let mut found = Vec::new();
    for boundary in scene.boundaries.iter_mut().filter(|boundary| boundary.shape.material().is_some()) {
        let copies = copies(boundary, &cell.lattice, reach);
        match copies.and_then(|copies| boundary.shape.with_copies(copies)) {
            Ok(shape) => boundary.shape = shape,
            Err([found_shape, expected]) => {
                let mistake = Mistake::Unexpected { found: found_shape, expected };
                found.push((format!("boundary.{}", boundary.name), boundary.shape.key(), mistake));
            }
        }
    }
    found
}

/// Where the copies of a surface stand that particles in a cell reach \[m\].
fn copies(boundary: &Boundary, lattice: &Lattice, reach: f64) -> Result<Copies, [String; 2]> {
    let shape = &boundary.shape;
    let mut points = shape.facets(&[]).unwrap_or_default().points;
    if points.is_empty() && shape.plane().is_none() {
        // The box around what is no further than it reaches.
        let reference = Vector::from(boundary.reference);
        let extent = shape.features().map_or(f64::INFINITY, |features| features.extent(reference));
        for corner in 0..8 {
            let side = |axis: usize| if corner >> axis & 1 == 0 { -extent } else { extent };
            points.push(reference + Vector::new(side(0), side(1), side(2)));
        }
    }
    let heights = lattice.heights();
    // Moved along an edge, it is brought back where it has gone by half of one.
    let moves = |edge: usize| {
        let along = |axis: usize| {
            let mut end = lattice.origin;
            end[axis] += lattice.edges[edge][edge];
            lattice.parts(end)[edge] != 0.0
        };
        (0..3).any(|axis| {
            let motion = &boundary.axes[axis];
            !motion.is_fixed() && !matches!(motion, AxisMotion::Conveying(_)) && along(axis)
        })
    };
    let mut range = [[0, 0]; 3];
    for edge in (0..3).filter(|&edge| lattice.periodic[edge] && !points.is_empty()) {
        let parts = points.iter().map(|point| lattice.parts(point.to_array())[edge]);
        let [low, high] =
            parts.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], part| [low.min(part), high.max(part)]);
        let beyond = reach / heights[edge] + if moves(edge) { 0.5 } else { 0.0 };
        let (from, to) = ((-beyond - high).ceil(), (1.0 + beyond - low).floor());
        if from < -MOST_IMAGES || to > MOST_IMAGES {
            let found = format!("copies from {from} to {to} edges away along {}", AXES[edge]);
            return Err([found, format!("no more than {MOST_IMAGES}: a wider cell, or a surface nearer to it")]);
        }
        range[edge] = [from.min(0.0) as i64, to.max(0.0) as i64];
    }
    let [a, b, c] = range.map(|[from, to]| from..=to);
    let mut counts = vec![[0; 3]];
    for k in c {
        for j in b.clone() {
            counts.extend(a.clone().map(|i| [i, j, k]).filter(|count| *count != [0; 3]));
        }
    }
    let shifts: Vec<Vector> = counts.iter().map(|count| lattice.displacement(*count).into()).collect();
    // A copy is beyond the surface as seen along the way to it, or along the normal of a face.
    let width = |of: &dyn Fn(&Vector) -> f64| {
        let [low, high] = points
            .iter()
            .map(of)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], part| [low.min(part), high.max(part)]);
        high - low
    };
    let widths = [0, 1, 2].map(|edge| width(&|point| lattice.parts(point.to_array())[edge]));
    let is_beyond = |(count, shift): (&[i64; 3], &Vector)| {
        width(&|point| point.dot(*shift)) <= shift.dot(*shift) * WIDE
            || (0..3).any(|edge| widths[edge] <= count[edge].abs() as f64 * WIDE && count[edge] != 0)
    };
    match counts.iter().zip(&shifts).skip(1).find(|copy| !is_beyond(*copy)) {
        None => Ok(Copies { counts, shifts }),
        Some((_, shift)) => {
            let found = format!("a surface wider than its copy at {:?} m is away", shift.to_array());
            Err([found, "one that is no wider than the cell".to_owned()])
        }
    }
}

/// Spheres with the images of those that are no further than `depth` \[m\] from the cell, and whose image each is.
pub(in crate::scene) fn with_images(
    scene: &SceneDraft,
    spheres: &mut Vec<([f64; 3], f64)>,
    depth: impl Fn(f64) -> f64,
) -> Vec<u32> {
    let own = spheres.len();
    let mut originals: Vec<u32> = (0..own as u32).collect();
    let Some(cell) = &scene.cell else { return originals };
    if !objections(scene).is_empty() {
        return originals;
    }
    for (position, _) in spheres.iter_mut() {
        *position = cell.lattice.brought_back(*position);
    }
    for index in 0..own {
        let (position, radius) = spheres[index];
        cell.lattice.images(position, depth(radius), &mut |edges| {
            let shift = cell.lattice.displacement(edges);
            spheres.push(([0, 1, 2].map(|axis| position[axis] + shift[axis]), radius));
            originals.push(index as u32);
        });
    }
    originals
}
