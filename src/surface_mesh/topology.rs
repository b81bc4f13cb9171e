//! From triangles of a file to a surface: vertices joined, edges found, faces turned alike, faults named.

use super::coincident::coincident;
use super::{Placement, Soup, vector};
use crate::number::Vector;
use std::collections::BTreeMap;

/// Distance below which vertices are one, over the diagonal of the mesh.
const JOINED: f64 = 1e-6;
/// The same over its shortest edge.
const JOINED_OF_EDGE: f64 = 1e-3;
/// Smallest angle below which a triangle is reported as a needle \[rad\]: half a degree.
const NEEDLE: f64 = 0.0087;

/// An edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its two vertices, the lower number first.
    pub ends: [u32; 2],
    /// How many triangles meet at it.
    pub triangles: u32,
}

/// What was found in a mesh; faces are counted from 1, as the file has them.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Finding {
    /// A triangle without area.
    #[error("face {face} has no area; its altitude is below {tolerance:.1e} m, within which vertices are one")]
    NoArea {
        /// The face.
        face: u32,
        /// The distance \[m\].
        tolerance: f64,
    },
    /// A triangle two of whose corners are one vertex; it is left out.
    #[error("face {face} is left out: two of its corners are one vertex")]
    Collapsed {
        /// The face.
        face: u32,
    },
    /// A triangle that is there already; it is left out.
    #[error("face {face} is left out: face {of} has the same corners")]
    Duplicate {
        /// The face.
        face: u32,
        /// The one that stays.
        of: u32,
    },
    /// A triangle with a very small angle; it is legal.
    #[error("face {face} is a needle of {angle:.2} degrees")]
    Needle {
        /// The face.
        face: u32,
        /// Its smallest angle \[°\].
        angle: f64,
    },
    /// Faces whose corners ran the other way round than those of their neighbours.
    #[error("{count} faces are turned round to agree with their neighbours, the first is face {face}")]
    Turned {
        /// How many.
        count: usize,
        /// The first of them.
        face: u32,
    },
    /// A surface with one side only.
    #[error("face {face} cannot be turned so that it agrees with all its neighbours: the surface has one side only")]
    OneSided {
        /// A face at the place where the sides meet.
        face: u32,
    },
    /// Free edges.
    #[error("{edges} edges of {length:.3e} m are free: the surface is open there, first at face {face}")]
    Rim {
        /// How many.
        edges: usize,
        /// Their length \[m\].
        length: f64,
        /// A face at one of them.
        face: u32,
    },
    /// An edge where more than two triangles meet; it is legal.
    #[error("{triangles} faces meet at one edge, one of them is face {face}")]
    ManyFaces {
        /// How many.
        triangles: u32,
        /// One of them.
        face: u32,
    },
    /// A vertex in the middle of an edge that does not have it.
    #[error(
        "vertex {position:?} m stands on an edge of face {face} without being its corner; the edge would be counted twice"
    )]
    Junction {
        /// Where \[m\].
        position: [f64; 3],
        /// The face.
        face: u32,
    },
    /// Two triangles in one plane that cover one another in part.
    #[error("faces {face} and {other} lie on one another; the surface would be counted twice there")]
    Coincident {
        /// A face.
        face: u32,
        /// The other.
        other: u32,
    },
    /// Vertices that no number holds after scaling.
    #[error("vertex {number} is at {position:?} m; finite numbers are right")]
    NotFinite {
        /// Which, counted from 1.
        number: usize,
        /// Where \[m\].
        position: [f64; 3],
    },
}

impl Finding {
    /// Whether a surface with it would give wrong forces, so that it is refused.
    pub fn is_fatal(&self) -> bool {
        use Finding::{Coincident, Junction, NoArea, NotFinite, OneSided};
        matches!(self, NoArea { .. } | OneSided { .. } | Junction { .. } | Coincident { .. } | NotFinite { .. })
    }
}

/// A surface of triangles. Vertices and edges are numbered by first appearance.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceMesh {
    /// Vertices \[m\].
    pub vertices: Vec<[f64; 3]>,
    /// Corners of each triangle, anticlockwise as seen from where its normal points.
    pub triangles: Vec<[u32; 3]>,
    /// Edges of each triangle: from its first corner to the second, to the third, and back.
    pub edges_of: Vec<[u32; 3]>,
    /// Unit normal of each triangle.
    pub normals: Vec<[f64; 3]>,
    /// All edges.
    pub edges: Vec<Edge>,
    /// The face of the file that each triangle is or is part of, counted from 1.
    pub faces: Vec<u32>,
    /// How many triangles meet at each vertex.
    pub triangles_at: Vec<u32>,
}

/// Triangles at each edge, with the direction in which they run along it.
type Sides = BTreeMap<[u32; 2], Vec<(usize, bool)>>;

impl SurfaceMesh {
    /// The surface that triangles make, and what was found on the way.
    ///
    /// # Errors
    /// All findings, if one of them would make forces wrong.
    pub fn new(soup: &Soup, placement: &Placement) -> Result<(Self, Vec<Finding>), Vec<Finding>> {
        let placed: Vec<[f64; 3]> = soup.vertices.iter().map(|vertex| placement.place(*vertex)).collect();
        let strange = placed.iter().position(|vertex| vertex.iter().any(|part| !part.is_finite()));
        if let Some(index) = strange {
            return Err(vec![Finding::NotFinite { number: index + 1, position: placed[index] }]);
        }
        let tolerance = tolerance(soup, &placed);
        let (vertices, number) = joined(&placed, tolerance);
        let mut findings = Vec::new();
        let (mut triangles, faces) = kept(soup, &number, &vertices, tolerance, &mut findings);
        if findings.iter().any(Finding::is_fatal) {
            return Err(findings);
        }
        turn_alike(&mut triangles, &faces, &mut findings);
        let mesh = Self::numbered(vertices, triangles, faces);
        mesh.rims(tolerance, &mut findings);
        if let Some([a, b]) = coincident(&mesh, tolerance) {
            findings.push(Finding::Coincident { face: mesh.faces[a], other: mesh.faces[b] });
        }
        if findings.iter().any(Finding::is_fatal) { Err(findings) } else { Ok((mesh, findings)) }
    }

    /// Numbers the edges and counts triangles at edges and vertices.
    fn numbered(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>, faces: Vec<u32>) -> Self {
        let mut known: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut edges: Vec<Edge> = Vec::new();
        let mut triangles_at = vec![0; vertices.len()];
        let edges_of = triangles
            .iter()
            .map(|corners| {
                corners.iter().for_each(|corner| triangles_at[*corner as usize] += 1);
                [0, 1, 2].map(|side| {
                    let ends = ends(*corners, side);
                    let edge = *known.entry(ends).or_insert_with(|| {
                        edges.push(Edge { ends, triangles: 0 });
                        edges.len() as u32 - 1
                    });
                    edges[edge as usize].triangles += 1;
                    edge
                })
            })
            .collect();
        let normals = triangles.iter().map(|corners| unit(area(&vertices, *corners)).to_array()).collect();
        Self { vertices, triangles, edges_of, normals, edges, faces, triangles_at }
    }

    /// Reports free edges, crowded edges, and vertices that stand on free edges.
    fn rims(&self, tolerance: f64, findings: &mut Vec<Finding>) {
        let mut face_at = vec![0; self.edges.len()];
        for (edges, face) in self.edges_of.iter().zip(&self.faces).rev() {
            edges.iter().for_each(|edge| face_at[*edge as usize] = *face);
        }
        let (mut count, mut length, mut first) = (0, 0.0, None);
        let mut free_vertices: Vec<u32> = Vec::new();
        for (edge, face) in self.edges.iter().zip(&face_at) {
            if edge.triangles > 2 {
                findings.push(Finding::ManyFaces { triangles: edge.triangles, face: *face });
            } else if edge.triangles == 1 {
                count += 1;
                length += (self.at(edge.ends[1]) - self.at(edge.ends[0])).length();
                first.get_or_insert(*face);
                free_vertices.extend(edge.ends);
            }
        }
        if let Some(face) = first {
            findings.push(Finding::Rim { edges: count, length, face });
        }
        free_vertices.sort_unstable();
        free_vertices.dedup();
        let along = |vertex: u32| self.vertices[vertex as usize][0];
        free_vertices.sort_by(|a, b| along(*a).total_cmp(&along(*b)));
        for (edge, face) in self.edges.iter().zip(&face_at).filter(|(edge, _)| edge.triangles == 1) {
            let [a, b] = edge.ends;
            let (low, high) = (along(a).min(along(b)) - tolerance, along(a).max(along(b)) + tolerance);
            let start = free_vertices.partition_point(|vertex| along(*vertex) < low);
            let near = free_vertices[start..].iter().take_while(|vertex| along(**vertex) <= high);
            for vertex in near.filter(|vertex| **vertex != a && **vertex != b) {
                let (from, way) = (self.at(a), self.at(b) - self.at(a));
                let share = (self.at(*vertex) - from).dot(way) / way.dot(way);
                let beside = (self.at(*vertex) - from - way * share).length();
                if (0.0..=1.0).contains(&share) && beside <= tolerance {
                    findings.push(Finding::Junction { position: self.vertices[*vertex as usize], face: *face });
                }
            }
        }
    }

    /// Where a vertex is \[m\].
    pub(super) fn at(&self, vertex: u32) -> Vector {
        vector(self.vertices[vertex as usize])
    }

    /// Whether every edge has two triangles.
    pub fn is_closed(&self) -> bool {
        self.edges.iter().all(|edge| edge.triangles == 2)
    }

    /// Volume that a closed surface encloses \[m³\]: above 0 if its normals point outwards.
    pub fn volume(&self) -> Option<f64> {
        let part = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.at(corner));
            a.dot(b.cross(c)) / 6.0
        };
        self.is_closed().then(|| self.triangles.iter().map(part).sum())
    }

    /// Signed weight of an edge.
    pub fn edge_weight(&self, edge: u32) -> i32 {
        1 - self.edges[edge as usize].triangles as i32
    }

    /// Signed weight of each vertex.
    pub fn vertex_weights(&self) -> Vec<i32> {
        let mut weights: Vec<i32> = self.triangles_at.iter().map(|count| 1 - *count as i32).collect();
        for edge in &self.edges {
            edge.ends.iter().for_each(|end| weights[*end as usize] += edge.triangles as i32 - 1);
        }
        weights
    }
}

/// The ends of a side of a triangle, the lower number first.
fn ends(corners: [u32; 3], side: usize) -> [u32; 2] {
    let (a, b) = (corners[side], corners[(side + 1) % 3]);
    [a.min(b), a.max(b)]
}

/// Normal of a triangle, as long as twice its area \[m²\].
fn area(vertices: &[[f64; 3]], corners: [u32; 3]) -> Vector {
    let [a, b, c] = corners.map(|corner| vector(vertices[corner as usize]));
    (b - a).cross(c - a)
}

/// A vector of length 1.
fn unit(way: Vector) -> Vector {
    way * (1.0 / way.length())
}

/// The distance within which vertices are one \[m\].
fn tolerance(soup: &Soup, vertices: &[[f64; 3]]) -> f64 {
    let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for vertex in vertices {
        for axis in 0..3 {
            lower[axis] = lower[axis].min(vertex[axis]);
            upper[axis] = upper[axis].max(vertex[axis]);
        }
    }
    let joined = JOINED * (vector(upper) - vector(lower)).length();
    // Shorter ones are corners that ought to be one.
    let lengths = soup.triangles.iter().flat_map(|corners| {
        let at = corners.map(|corner| vector(vertices[corner as usize]));
        [at[1] - at[0], at[2] - at[1], at[0] - at[2]].map(Vector::length)
    });
    let shortest = lengths.filter(|length| *length > 0.1 * joined).fold(f64::INFINITY, f64::min);
    joined.min(JOINED_OF_EDGE * shortest)
}

/// Vertices with those that are within the tolerance made one, and the number of each; the lowest number wins.
fn joined(placed: &[[f64; 3]], tolerance: f64) -> (Vec<[f64; 3]>, Vec<u32>) {
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let mut number = Vec::with_capacity(placed.len());
    let width = if tolerance > 0.0 { tolerance } else { 1.0 };
    for vertex in placed {
        let cell = vertex.map(|part| (part / width).floor() as i64);
        let mut nearest: Option<u32> = None;
        for x in -1..=1 {
            for y in -1..=1 {
                for z in -1..=1 {
                    let around = [cell[0].saturating_add(x), cell[1].saturating_add(y), cell[2].saturating_add(z)];
                    for known in cells.get(&around).into_iter().flatten() {
                        let near = (vector(vertices[*known as usize]) - vector(*vertex)).length() <= tolerance;
                        if near && nearest.is_none_or(|nearest| *known < nearest) {
                            nearest = Some(*known);
                        }
                    }
                }
            }
        }
        number.push(nearest.unwrap_or_else(|| {
            let index = vertices.len() as u32;
            cells.entry(cell).or_default().push(index);
            vertices.push(*vertex);
            index
        }));
    }
    (vertices, number)
}

/// The triangles that have three corners, an area, and no double; with their faces.
fn kept(
    soup: &Soup,
    number: &[u32],
    vertices: &[[f64; 3]],
    tolerance: f64,
    findings: &mut Vec<Finding>,
) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let (mut triangles, mut faces) = (Vec::new(), Vec::new());
    for (corners, face) in soup.triangles.iter().zip(&soup.faces) {
        let corners = corners.map(|corner| number[corner as usize]);
        let face = *face;
        if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
            findings.push(Finding::Collapsed { face });
            continue;
        }
        let at = corners.map(|corner| vector(vertices[corner as usize]));
        let mut lengths = [at[1] - at[0], at[2] - at[1], at[0] - at[2]].map(Vector::length);
        lengths.sort_by(f64::total_cmp);
        let double_area = area(vertices, corners).length();
        let smallest_sine = double_area / (lengths[1] * lengths[2]);
        if double_area <= tolerance * lengths[2] {
            findings.push(Finding::NoArea { face, tolerance });
            continue;
        }
        if smallest_sine < NEEDLE {
            findings.push(Finding::Needle { face, angle: smallest_sine.to_degrees() });
        }
        let mut sorted = corners;
        sorted.sort_unstable();
        if let Some(of) = known.get(&sorted) {
            findings.push(Finding::Duplicate { face, of: *of });
            continue;
        }
        known.insert(sorted, face);
        triangles.push(corners);
        faces.push(face);
    }
    (triangles, faces)
}

/// Turns triangles round until neighbours run along their common edge in opposite directions. The first triangle of
/// each connected part stays as it is.
fn turn_alike(triangles: &mut [[u32; 3]], faces: &[u32], findings: &mut Vec<Finding>) {
    let mut sides: Sides = BTreeMap::new();
    for (index, corners) in triangles.iter().enumerate() {
        for side in 0..3 {
            let forward = corners[side] < corners[(side + 1) % 3];
            sides.entry(ends(*corners, side)).or_default().push((index, forward));
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; triangles.len()];
    let mut one_sided = None;
    for start in 0..triangles.len() {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let mut waiting = vec![start];
        while let Some(here) = waiting.pop() {
            for side in 0..3 {
                let Some([one, two]) = sides.get(&ends(triangles[here], side)).map(Vec::as_slice) else { continue };
                let (mine, other) = if one.0 == here { (one, two) } else { (two, one) };
                let wanted = turned[here].map(|turned| turned ^ (mine.1 == other.1));
                match turned[other.0] {
                    None => {
                        turned[other.0] = wanted;
                        waiting.push(other.0);
                    }
                    there if there != wanted => {
                        one_sided.get_or_insert(faces[other.0]);
                    }
                    _ => {}
                }
            }
        }
    }
    if let Some(face) = one_sided {
        findings.push(Finding::OneSided { face });
    }
    let round: Vec<usize> = (0..triangles.len()).filter(|index| turned[*index] == Some(true)).collect();
    if let Some(first) = round.first() {
        findings.push(Finding::Turned { count: round.len(), face: faces[*first] });
    }
    round.into_iter().for_each(|index| triangles[index].swap(1, 2));
}
