//! Where there is no room for a new sphere: other spheres and surfaces.

use crate::base::geometry::Frame;
use crate::base::geometry::Lattice;
use crate::base::number::Vector;
use crate::engine::cell::near::{self, Place};
use crate::engine::neighbours::sorted;
use crate::engine::state::State;
use crate::laws::surface::{Deforming, Feet};
use crate::scene::Scene;

/// Cells along an axis at most.
const MOST_CELLS: usize = 64;

/// The spheres in and near a box, in cells, and the surfaces of a scene where they stand.
pub(super) struct Occupied<'a> {
    /// The scene.
    scene: &'a Scene,
    /// The periodic cell, if there is one.
    lattice: Option<Lattice>,
    /// The box, as spheres see it that are no further than the largest two reach \[m\].
    place: (Place, f64),
    /// Where each of its boundaries stands.
    frames: Vec<Frame>,
    /// Meshes whose nodes have moved, as they stand.
    deformed: Vec<Option<Deforming>>,
    /// Lower corner of the cells \[m\].
    low: [f64; 3],
    /// Edges of a cell \[m\]: spheres in cells further apart than one do not touch.
    edges: [f64; 3],
    /// Cells along each axis.
    counts: [usize; 3],
    /// Centre and radius of the spheres of each cell \[m\].
    cells: Vec<Vec<[f64; 4]>>,
    /// Parts of a surface that are near.
    parts: Vec<u32>,
    /// Feet on them.
    feet: Feet,
}

impl<'a> Occupied<'a> {
    /// What a sphere may meet whose centre is in this box \[m\] and whose radius is not above `largest` \[m\].
    pub(super) fn around([low, high]: [[f64; 3]; 2], largest: f64, scene: &'a Scene, state: &State) -> Self {
        let all = state.particles.position.iter().map(|row| row[3]);
        let reach = largest + all.fold(largest, f64::max);
        let mut counts = [1; 3];
        let mut edges = [0.0; 3];
        for axis in 0..3 {
            let wide = high[axis] - low[axis];
            counts[axis] = ((wide / reach) as usize).clamp(1, MOST_CELLS);
            edges[axis] = (wide / counts[axis] as f64).max(reach);
        }
        let frame = |(boundary, moved): (&crate::scene::Boundary, &crate::engine::state::BoundaryState)| {
            Frame::of(boundary.reference.into(), moved.shift().into(), moved.orientation.0)
        };
        let deformed = |boundary: usize| {
            let nodes = state.nodes_of(boundary)?;
            Some(sorted(scene.boundaries[boundary].shape.deforming()?, nodes))
        };
        let mut occupied = Self {
            scene,
            lattice: near::lattice(scene, state),
            place: (Place::of(scene, state, [low, high]), reach),
            deformed: (0..scene.boundaries.len()).map(deformed).collect(),
            frames: scene.boundaries.iter().zip(&state.boundaries).map(frame).collect(),
            low,
            edges,
            counts,
            cells: vec![Vec::new(); counts.iter().product()],
            parts: Vec::new(),
            feet: Feet::default(),
        };
        near::particles(state).for_each(|slot| occupied.add(state.particles.position[slot]));
        occupied
    }

    /// Adds a sphere and its images, where they are near the box.
    pub(super) fn add(&mut self, sphere: [f64; 4]) {
        let Self { place: (place, reach), low, edges, counts, cells, .. } = self;
        let high = [0, 1, 2].map(|axis| low[axis] + counts[axis] as f64 * edges[axis]);
        place.meets(sphere.into(), *reach, |centre| {
            let centre = centre.row_with(sphere[3]);
            if (0..3).all(|axis| (low[axis] - *reach..=high[axis] + *reach).contains(&centre[axis])) {
                let [x, y, z] = [0, 1, 2].map(|axis| cell(centre[axis], (low[axis], edges[axis], counts[axis])));
                cells[(x * counts[1] + y) * counts[2] + z].push(centre);
            }
        });
    }

    /// Whether a sphere would overlap another or a surface.
    pub(super) fn meets(&mut self, sphere: [f64; 4]) -> bool {
        self.meets_sphere(sphere) || self.meets_surface(sphere)
    }

    /// Whether it would overlap another.
    fn meets_sphere(&self, sphere: [f64; 4]) -> bool {
        let around = |axis: usize| {
            let cell = cell(sphere[axis], (self.low[axis], self.edges[axis], self.counts[axis]));
            cell.saturating_sub(1)..(cell + 2).min(self.counts[axis])
        };
        let overlaps = |other: &[f64; 4]| {
            let (way, reach) = (Vector::from(sphere) - Vector::from(*other), sphere[3] + other[3]);
            way.dot(way) < reach * reach
        };
        around(0).any(|x| {
            around(1).any(|y| {
                let row = (x * self.counts[1] + y) * self.counts[2];
                around(2).any(|z| self.cells[row + z].iter().any(overlaps))
            })
        })
    }

    /// Whether it would overlap a surface, or be behind a plane.
    fn meets_surface(&mut self, sphere: [f64; 4]) -> bool {
        for ((boundary, frame), deformed) in self.scene.boundaries.iter().zip(&self.frames).zip(&self.deformed) {
            let features = boundary.shape.features().filter(|_| boundary.shape.material().is_some());
            let Some(features) = features else { continue };
            let features = deformed.as_ref().map_or(features, Deforming::features);
            let place = Vector::from(sphere).to_array();
            let place = self.lattice.map_or(place, |lattice| lattice.brought_back(place));
            let centre = frame.inside(place.into());
            self.parts.clear();
            features.near(centre, sphere[3], &mut self.parts);
            if self.parts.is_empty() {
                continue;
            }
            self.feet.clear();
            features.feet(centre, sphere[3], &self.parts, &mut self.feet);
            if !self.feet.list.is_empty() {
                return true;
            }
        }
        false
    }
}

/// The cell of a coordinate along an axis where cells begin at `low` \[m\]; what is beyond the box belongs to the last cell before.
fn cell(coordinate: f64, (low, edge, count): (f64, f64, usize)) -> usize {
    (((coordinate - low) / edge).max(0.0) as usize).min(count - 1)
}
