//! From triangles to a surface: which corners are one vertex, which triangles meet in an edge.

use super::tree::Tree;
use crate::base::number::Vector;
use std::collections::BTreeMap;

/// A vertex of several triangles is welded where its copies are nearer than this share of the size of the surface.
const WELD_OF_SIZE: f64 = 1e-6;

/// And nearer than this share of the shortest edge.
const WELD_OF_EDGE: f64 = 1e-3;

/// The simplices of a surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Topology {
    /// The vertices \[m\].
    pub vertices: Vec<Vector>,
    /// The vertices at the ends of each edge, the lower one first.
    pub edges: Vec<[u32; 2]>,
    /// Distance below which corners are one vertex \[m\].
    pub tolerance: f64,
    /// The number of each triangle among those given, counted from 1.
    pub numbers: Vec<usize>,
    /// The vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Its edges.
    pub edges_of: Vec<[u32; 3]>,
    /// The triangles at each edge.
    pub at_edge: Vec<Vec<u32>>,
    /// The triangles at each vertex.
    pub at_vertex: Vec<Vec<u32>>,
    /// The edges at each vertex.
    pub edges_at_vertex: Vec<Vec<u32>>,
}

impl Topology {
    /// Welds triangles; those that are there twice are left out. An error is the number of a triangle without area, counted
    /// from 1.
    pub(super) fn of(corners: &[[[f64; 3]; 3]]) -> Result<Self, usize> {
        Self::welded(corners, None)
    }

    /// The same, welding what is no further apart than this \[m\]; by default as little as says [`WELD_OF_SIZE`].
    pub(super) fn welded(corners: &[[[f64; 3]; 3]], distance: Option<f64>) -> Result<Self, usize> {
        let mut welder = Welder::of(corners, distance);
        let mut topology = Self::default();
        let mut known = BTreeMap::new();
        let mut edges = BTreeMap::new();
        for (number, corners) in (1..).zip(corners) {
            let triangle = corners.map(|corner| welder.vertex(corner.into()));
            let [a, b, c] = triangle.map(|vertex| welder.vertices[vertex as usize]);
            if lacks_area([a, b, c], welder.tolerance) {
                return Err(number);
            }
            let mut sorted = triangle;
            sorted.sort_unstable();
            if known.insert(sorted, number).is_some() {
                continue;
            }
            let place = topology.triangles.len() as u32;
            let sides = [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|corner: usize| triangle[corner]));
            let edges_of = sides.map(|[a, b]| {
                let ends = [a.min(b), a.max(b)];
                let edge = *edges.entry(ends).or_insert_with(|| {
                    topology.edges.push(ends);
                    topology.at_edge.push(Vec::new());
                    topology.edges.len() as u32 - 1
                });
                topology.at_edge[edge as usize].push(place);
                edge
            });
            topology.triangles.push(triangle);
            topology.numbers.push(number);
            topology.edges_of.push(edges_of);
        }
        topology.tolerance = welder.tolerance;
        topology.vertices = welder.vertices;
        topology.at_vertex = vec![Vec::new(); topology.vertices.len()];
        topology.edges_at_vertex = vec![Vec::new(); topology.vertices.len()];
        for (place, triangle) in (0..).zip(&topology.triangles) {
            triangle.iter().for_each(|vertex| topology.at_vertex[*vertex as usize].push(place));
        }
        for (place, edge) in (0..).zip(&topology.edges) {
            edge.iter().for_each(|vertex| topology.edges_at_vertex[*vertex as usize].push(place));
        }
        Ok(topology)
    }

    /// Whether a triangle with these corners has no area.
    pub(super) fn lacks_area(&self, corners: [Vector; 3]) -> bool {
        lacks_area(corners, self.tolerance)
    }

    /// The corners of a triangle \[m\].
    pub(super) fn corners(&self, triangle: &[u32; 3]) -> [Vector; 3] {
        triangle.map(|vertex| self.vertices[vertex as usize])
    }

    /// The tree that finds its triangles.
    pub(super) fn tree(&self) -> Tree {
        let boxes: Vec<_> = self.triangles.iter().map(|triangle| around(&self.corners(triangle))).collect();
        Tree::of(&boxes)
    }

    /// Turns triangles round until any two at an edge go along it in opposite directions; the first triangle of each
    /// connected part stays as it is. An error is the number of a triangle of a surface that has one side only.
    pub(super) fn turn_alike(&mut self) -> Result<(), usize> {
        let along = |corners: [u32; 3], [a, b]: [u32; 2]| {
            (0..3).any(|corner| corners[corner] == a && corners[(corner + 1) % 3] == b)
        };
        let mut met = vec![false; self.triangles.len()];
        for start in 0..self.triangles.len() {
            let mut waiting = if met[start] { Vec::new() } else { vec![start] };
            met[start] = true;
            while let Some(here) = waiting.pop() {
                for edge in self.edges_of[here] {
                    let [one, two] = self.at_edge[edge as usize][..] else { continue };
                    let other = if one as usize == here { two } else { one } as usize;
                    let ends = self.edges[edge as usize];
                    let agree = along(self.triangles[here], ends) != along(self.triangles[other], ends);
                    match (met[other], agree) {
                        (true, false) => return Err(self.numbers[other]),
                        (true, true) => {}
                        (false, _) => {
                            met[other] = true;
                            waiting.push(other);
                            if !agree {
                                self.triangles[other].swap(1, 2);
                                self.edges_of[other].swap(0, 2);
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether the surface has no rim: every edge has two triangles that go along it in opposite directions.
    pub(super) fn is_closed(&self) -> bool {
        let along = |triangle: u32, [a, b]: [u32; 2]| {
            let corners = self.triangles[triangle as usize];
            (0..3).any(|corner| corners[corner] == a && corners[(corner + 1) % 3] == b)
        };
        let pairs = self.edges.iter().zip(&self.at_edge);
        pairs.into_iter().all(|(edge, at)| matches!(at[..], [one, other] if along(one, *edge) != along(other, *edge)))
    }
}

/// Whether a triangle with these corners has no area: its height over the longest edge is below the tolerance \[m\].
fn lacks_area([a, b, c]: [Vector; 3], tolerance: f64) -> bool {
    let longest = [b - a, c - b, a - c].iter().map(|edge| edge.length()).fold(0.0, f64::max);
    let area = (b - a).cross(c - a).length();
    !area.is_finite() || area <= longest * tolerance
}

/// The smallest box around some places: lower and upper corner \[m\].
pub(super) fn around(places: &[Vector]) -> [[f64; 3]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for place in places.iter().map(|place| place.to_array()) {
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    [low, high]
}

/// Makes one vertex of corners that coincide.
struct Welder {
    /// Vertices so far \[m\].
    vertices: Vec<Vector>,
    /// Those in each cell.
    cells: BTreeMap<[i64; 3], Vec<u32>>,
    /// Corners nearer than this are one vertex \[m\].
    tolerance: f64,
}

impl Welder {
    /// For these triangles, by the distance that is given, if one is \[m\].
    fn of(triangles: &[[[f64; 3]; 3]], distance: Option<f64>) -> Self {
        let (mut low, mut high, mut shortest) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], f64::INFINITY);
        for corners in triangles {
            for (place, corner) in corners.iter().enumerate() {
                for axis in 0..3 {
                    low[axis] = low[axis].min(corner[axis]);
                    high[axis] = high[axis].max(corner[axis]);
                }
                let edge = (Vector::from(*corner) - Vector::from(corners[(place + 1) % 3])).length();
                shortest = if edge > 0.0 { shortest.min(edge) } else { shortest };
            }
        }
        let size = (Vector::from(high) - Vector::from(low)).length();
        let tolerance = distance.unwrap_or((WELD_OF_SIZE * size).min(WELD_OF_EDGE * shortest));
        Self { vertices: Vec::new(), cells: BTreeMap::new(), tolerance }
    }

    /// The vertex of a corner.
    fn vertex(&mut self, corner: Vector) -> u32 {
        // Cells are wider than the tolerance: what is near is in a neighbouring one.
        let cell = corner.to_array().map(|part| (part / (2.0 * self.tolerance)).floor() as i64);
        let mut near: Option<u32> = None;
        for number in 0..27 {
            let beside = [number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1];
            let other = [0, 1, 2].map(|axis: usize| cell[axis].saturating_add(beside[axis]));
            for &vertex in self.cells.get(&other).into_iter().flatten() {
                if (self.vertices[vertex as usize] - corner).length() <= self.tolerance {
                    near = Some(near.map_or(vertex, |near| near.min(vertex)));
                }
            }
        }
        near.unwrap_or_else(|| {
            self.vertices.push(corner);
            let vertex = self.vertices.len() as u32 - 1;
            self.cells.entry(cell).or_default().push(vertex);
            vertex
        })
    }
}
