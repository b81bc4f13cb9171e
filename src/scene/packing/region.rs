//! Where a packing goes: a box, a cylinder, or a periodic cell.

use super::Sphere;
use super::generator::uniform;
use super::keys::{CylinderTable, PackingTable};
use crate::base::document::Mistake;
use crate::base::geometry::Lattice;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// The shape of a region, in coordinates of its own that begin at the lower corner of the smallest box around it.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// Its edges \[m\].
    Box([f64; 3]),
    /// Along the third axis.
    Cylinder {
        /// Radius \[m\].
        radius: f64,
        /// Length \[m\].
        length: f64,
    },
    /// Spheres go on through its faces along edges that repeat, and lie whole inside along the others.
    Cell(Lattice),
}

/// A region, and where it stands in the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// What it looks like.
    shape: Shape,
    /// Where its coordinates begin \[m\].
    origin: [f64; 3],
    /// Directions of its axes.
    axes: [[f64; 3]; 3],
}

/// Axes of the scene.
const UPRIGHT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Region {
    /// The region that a table names, which is the scene's cell where it names none; otherwise the key that is wrong.
    pub(super) fn named(table: &PackingTable, cell: Option<Lattice>) -> Result<Self, (&'static str, Mistake)> {
        match (&table.r#box, &table.cylinder) {
            (None, None) if cell.is_some() => Ok(Self::cell(cell.unwrap_or_default())),
            (Some(corners), None) => {
                let [lower, upper] = corners.0;
                let edges = std::array::from_fn(|axis| upper[axis] - lower[axis]);
                Ok(Self { shape: Shape::Box(edges), origin: lower, axes: UPRIGHT })
            }
            (None, Some(cylinder)) => Self::cylinder(cylinder),
            _ => {
                let found = if table.r#box.is_some() { "both" } else { "neither" }.to_owned();
                let expected = "one of box and cylinder, or a [cell]".to_owned();
                Err(("packing", Mistake::Unexpected { found, expected }))
            }
        }
    }

    /// A cell.
    fn cell(lattice: Lattice) -> Self {
        let least = |axis: usize| lattice.edges.iter().map(|edge| edge[axis].min(0.0)).sum::<f64>();
        let low = [0, 1, 2].map(least);
        let origin = [0, 1, 2].map(|axis| lattice.origin[axis] + low[axis]);
        Self { shape: Shape::Cell(Lattice { origin: low.map(|part| -part), ..lattice }), origin, axes: UPRIGHT }
    }

    /// A cylinder between two points.
    fn cylinder(table: &CylinderTable) -> Result<Self, (&'static str, Mistake)> {
        let (from, to, radius) = (table.from.0, table.to.0, table.radius.get());
        let way: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let length = dot(way, way).sqrt();
        if length == 0.0 {
            let (found, expected) = (format!("from and to at {from:?}"), "two different points".to_owned());
            return Err(("packing.cylinder", Mistake::Unexpected { found, expected }));
        }
        let along = way.map(|part| part / length);
        // The axis of the scene that is least along the cylinder begins the frame.
        let least = (0..3).fold(0, |least, axis| if along[axis].abs() < along[least].abs() { axis } else { least });
        let start = std::array::from_fn(|axis| UPRIGHT[least][axis] - along[least] * along[axis]);
        let size = dot(start, start).sqrt();
        let first = start.map(|part: f64| part / size);
        let second = [
            along[1] * first[2] - along[2] * first[1],
            along[2] * first[0] - along[0] * first[2],
            along[0] * first[1] - along[1] * first[0],
        ];
        let origin = std::array::from_fn(|axis| from[axis] - radius * (first[axis] + second[axis]));
        Ok(Self { shape: Shape::Cylinder { radius, length }, origin, axes: [first, second, along] })
    }

    /// Edges of the smallest box around it \[m\].
    pub(super) fn size(&self) -> [f64; 3] {
        match self.shape {
            Shape::Box(edges) => edges,
            Shape::Cylinder { radius, length } => [2.0 * radius, 2.0 * radius, length],
            Shape::Cell(Lattice { edges, .. }) => {
                [0, 1, 2].map(|axis| edges.iter().map(|edge| edge[axis].abs()).sum::<f64>())
            }
        }
    }

    /// The largest diameter of a sphere that it holds, and that in a cell does not meet an image of itself \[m\].
    pub(super) fn width(&self) -> f64 {
        let widths = if let Shape::Cell(lattice) = &self.shape { lattice.heights() } else { self.size() };
        widths.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Volume \[m³\].
    pub(super) fn volume(&self) -> f64 {
        match self.shape {
            Shape::Box(edges) => edges.iter().product(),
            Shape::Cylinder { radius, length } => PI * radius * radius * length,
            Shape::Cell(lattice) => lattice.volume(),
        }
    }

    /// Whether a sphere in the smallest box around the region is in the region as well.
    pub(super) fn holds(&self, place: [f64; 3], sphere: f64) -> bool {
        match self.shape {
            // Places there are drawn, and pushed, where the whole sphere is inside.
            Shape::Box(_) | Shape::Cell(_) => true,
            Shape::Cylinder { radius, .. } => {
                let (x, y) = (place[0] - radius, place[1] - radius);
                let free = radius - sphere;
                x * x + y * y <= free * free
            }
        }
    }

    /// A random place for a sphere that fits, coordinate by coordinate; in a cylinder it may lie in a corner of the box around
    /// it.
    pub(super) fn anywhere(&self, sphere: f64, random: &mut ChaCha8Rng) -> [f64; 3] {
        if let Shape::Cell(lattice) = &self.shape {
            let heights = lattice.heights();
            let part = |edge: usize, share: f64| match lattice.periodic[edge] {
                true => share,
                false => sphere / heights[edge] + (1.0 - 2.0 * sphere / heights[edge]) * share,
            };
            let parts = [0, 1, 2].map(|edge| part(edge, uniform(random)));
            return lattice.point(parts);
        }
        self.size().map(|length| sphere + (length - 2.0 * sphere) * uniform(random))
    }

    /// Random places for spheres of these radii \[m\], each of which fits.
    ///
    /// Those that fall into the corners of the box around a cylinder go to its rim, where pushes part them. If they would cover
    /// the rim more than once, they are drawn again until they fall inside: from a rim that is so crowded they do not come
    /// apart.
    pub(super) fn scatter(&self, radii: &[f64], random: &mut ChaCha8Rng) -> Vec<Sphere> {
        let crowded = match self.shape {
            Shape::Box(_) | Shape::Cell(_) => false,
            Shape::Cylinder { radius, length } => {
                let shadows: f64 = radii.iter().map(|radius| PI * radius * radius).sum();
                (1.0 - PI / 4.0) * shadows > 2.0 * PI * radius * length
            }
        };
        let mut place = |sphere: f64| {
            let mut place = self.anywhere(sphere, random);
            while crowded && !self.holds(place, sphere) {
                place = self.anywhere(sphere, random);
            }
            (self.nearest_inside(place, sphere), sphere)
        };
        radii.iter().map(|radius| place(*radius)).collect()
    }

    /// The place nearest to this one where the whole sphere is inside; it must fit at all.
    pub(super) fn nearest_inside(&self, place: [f64; 3], sphere: f64) -> [f64; 3] {
        if let Shape::Cell(lattice) = &self.shape {
            if lattice.periodic == [true; 3] {
                return place;
            }
            let (parts, heights) = (lattice.parts(place), lattice.heights());
            return lattice.point([0, 1, 2].map(|edge| {
                let least = sphere / heights[edge];
                if lattice.periodic[edge] { parts[edge] } else { parts[edge].max(least).min(1.0 - least) }
            }));
        }
        let size = self.size();
        let mut inside = std::array::from_fn(|axis| place[axis].max(sphere).min(size[axis] - sphere));
        if let Shape::Cylinder { radius, .. } = self.shape {
            let (x, y) = (place[0] - radius, place[1] - radius);
            let distance = (x * x + y * y).sqrt();
            let free = radius - sphere;
            if distance > free {
                inside[0] = radius + x * (free / distance);
                inside[1] = radius + y * (free / distance);
            } else {
                [inside[0], inside[1]] = [place[0], place[1]];
            }
        }
        inside
    }

    /// The same place, brought back into a cell.
    pub(super) fn brought_back(&self, place: [f64; 3]) -> [f64; 3] {
        if let Shape::Cell(lattice) = &self.shape { lattice.brought_back(place) } else { place }
    }

    /// Hands out where a sphere in a cell has images no further than `depth` \[m\] from the cell, one of each two that are opposite.
    pub(super) fn images(&self, place: [f64; 3], depth: f64, mut hand: impl FnMut([f64; 3])) {
        if let Shape::Cell(lattice) = &self.shape {
            lattice.images(place, depth, &mut |edges| hand(lattice.displacement(edges)));
        }
    }

    /// Whether this holds of a place and, in a cell, of all its images no further than `depth` \[m\] from it.
    pub(super) fn everywhere(&self, place: [f64; 3], depth: f64, mut holds: impl FnMut([f64; 3]) -> bool) -> bool {
        let Shape::Cell(lattice) = &self.shape else { return holds(place) };
        let mut all = true;
        lattice.near(place, &[[0.0, 1.0]; 3], depth, |shift| {
            all = all && holds([0, 1, 2].map(|axis| place[axis] + shift[axis]));
        });
        all
    }

    /// From coordinates of the region to those of the scene \[m\].
    pub(super) fn in_scene(&self, place: [f64; 3]) -> [f64; 3] {
        let [first, second, third] = self.axes;
        match self.shape {
            Shape::Box(_) => std::array::from_fn(|axis| self.origin[axis] + place[axis]),
            Shape::Cell(lattice) => {
                let place = lattice.brought_back(place);
                [0, 1, 2].map(|axis| self.origin[axis] + place[axis])
            }
            Shape::Cylinder { .. } => std::array::from_fn(|axis| {
                self.origin[axis] + first[axis] * place[0] + second[axis] * place[1] + third[axis] * place[2]
            }),
        }
    }
}

/// Scalar product.
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
