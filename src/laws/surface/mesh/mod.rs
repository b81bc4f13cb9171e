//! `mesh`: triangles of a file.

mod edge;
mod face;
mod faults;
mod feet;
#[cfg(test)]
mod feet_tests;
mod files;
mod joint;
mod keys;
mod nodes;
mod planes;
mod side;
mod topology;
mod tree;

use super::facets::Facets;
use super::feet::Features;
use super::{Copies, Repeated, Shape, Surface};
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;
use crate::base::words::counted;
use edge::Edge;
use face::Faces;
use joint::Joint;
pub(super) use joint::joined;
pub(crate) use keys::Keys;
pub use nodes::{Deforming, NodeWeights};
use topology::Topology;
use tree::Tree;

/// Which side of its triangles a surface has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    /// The one where the normals point: triangles behind which a centre is do not count.
    Front,
    /// Both.
    Both,
}

/// A surface of triangles. Features are numbered vertices first, then edges, then triangles.
#[derive(Clone, Debug)]
struct Mesh {
    /// Its material.
    material: MaterialIndex,
    /// The simplices.
    topology: Topology,
    /// The triangles, as the search for feet wants them.
    faces: Faces,
    /// The edges, likewise.
    edges: Vec<Edge>,
    /// Where triangles lie in one plane.
    flat: Flat,
    /// The tree that finds near triangles.
    tree: Tree,
    /// Which side counts.
    sides: Sides,
    /// Whether it has no rim.
    closed: bool,
    /// Middle of the box around it \[m\].
    middle: Vector,
    /// Of which copies of a surface it is joined.
    joint: Option<Joint>,
}

impl Mesh {
    /// A surface.
    fn of(material: MaterialIndex, topology: Topology, sides: Option<u8>) -> Self {
        let faces = Faces::of(topology.triangles.iter().map(|triangle| topology.corners(triangle)));
        let [low, high] = topology::around(&topology.vertices);
        let closed = topology.is_closed();
        let front = sides.map_or(closed, |sides| sides == 1);
        Self {
            material,
            tree: topology.tree(),
            flat: Flat::of(&topology, &faces),
            faces,
            edges: Edge::all(&topology).collect(),
            sides: if front { Sides::Front } else { Sides::Both },
            closed,
            middle: (Vector::from(low) + Vector::from(high)) * 0.5,
            topology,
            joint: None,
        }
    }

    /// Height of a centre over a triangle \[m\].
    fn height(&self, centre: Vector, triangle: u32) -> f64 {
        self.faces.at(triangle).height(centre)
    }

    /// Whether a triangle counts for a centre.
    fn counts(&self, centre: Vector, triangle: u32) -> bool {
        self.sides == Sides::Both || self.height(centre, triangle) > 0.0
    }
}

/// Where triangles lie in one plane.
#[derive(Clone)]
struct Flat {
    /// The flat edges of each triangle, a bit for each.
    edges: Vec<u8>,
    /// The patch of each: its first triangle. Triangles that meet in flat edges are of one patch.
    patch: Vec<u32>,
}

/// Nothing but the name, as for [`Faces`].
impl std::fmt::Debug for Flat {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Flat")
    }
}

impl Flat {
    /// What is flat of a surface.
    fn of(topology: &Topology, faces: &Faces) -> Self {
        let mut flat = Self::nowhere(faces.len());
        for (edge, at) in (0..).zip(&topology.at_edge) {
            let [one, other] = at[..] else { continue };
            let [n, m] = [one, other].map(|triangle| faces.at(triangle).normal);
            if n.dot(m) > 0.0 && n.cross(m).length() < face::FLAT {
                for triangle in [one, other] {
                    let edges = topology.edges_of[triangle as usize];
                    let place = edges.iter().position(|other| *other == edge).unwrap_or(0);
                    flat.edges[triangle as usize] |= 1 << place;
                }
                let [one, other] = [one, other].map(|triangle| flat.first(triangle));
                flat.patch[one.max(other) as usize] = one.min(other);
            }
        }
        for triangle in 0..faces.len() as u32 {
            flat.patch[triangle as usize] = flat.first(triangle);
        }
        flat
    }

    /// Triangles without neighbours, each a patch of its own.
    fn nowhere(triangles: usize) -> Self {
        Self { edges: vec![0; triangles], patch: (0..triangles as u32).collect() }
    }

    /// The first triangle of a patch.
    fn first(&mut self, mut triangle: u32) -> u32 {
        while self.patch[triangle as usize] != triangle {
            // Half of the way is left the next time.
            let next = self.patch[triangle as usize];
            self.patch[triangle as usize] = self.patch[next as usize];
            triangle = next;
        }
        triangle
    }
}

/// A surface of the triangles in STL files; an error says what is wrong with them. `sides`: 1, where the normals point, or 2;
/// if absent, 1 for a closed surface and 2 for any other.
pub fn of_files(material: MaterialIndex, files: &[Vec<u8>], sides: Option<u8>) -> Result<Shape, String> {
    let mut triangles = Vec::new();
    for file in files {
        triangles.extend(
            files::read("mesh.stl", file).map_err(|(found, expected)| format!("expected {expected}, found {found}"))?,
        );
    }
    let topology = Topology::of(&triangles).map_err(|triangle| format!("triangle {triangle} has no area"))?;
    Ok(Shape::of(Mesh::of(material, topology, sides)))
}

impl Surface for Mesh {
    fn key(&self) -> &'static str {
        "mesh"
    }

    fn words(&self) -> String {
        format!("mesh of {}", counted(self.topology.triangles.len(), "triangle"))
    }

    fn material(&self) -> Option<MaterialIndex> {
        Some(self.material)
    }

    fn features(&self) -> Option<&dyn Features> {
        Some(self)
    }

    fn deforming(&self) -> Option<Deforming> {
        Some(Deforming::of(self))
    }

    fn vertices(&self) -> &[Vector] {
        &self.topology.vertices
    }

    fn triangles(&self) -> &[[u32; 3]] {
        &self.topology.triangles
    }

    fn distance(&self, centre: Vector) -> Option<f64> {
        self.signed_distance(centre)
    }

    fn reference(&self) -> Option<[f64; 3]> {
        Some(self.middle.to_array())
    }

    fn turns(&self) -> bool {
        true
    }

    fn facets(&self, _beside: &[Vector]) -> Option<Facets> {
        let mut facets = Facets { points: self.topology.vertices.clone(), ..Facets::default() };
        self.topology.triangles.iter().for_each(|triangle| facets.add(triangle));
        Some(facets)
    }

    fn facet_at(&self, point: Vector) -> usize {
        self.nearest_triangle(point)
    }

    fn share_out(&self, feature: u32, _foot: Vector, give: &mut dyn FnMut(usize, f64)) {
        let (topology, faces) = (&self.topology, self.face(0));
        let vertices = topology.vertices.len() as u32;
        if let Some(triangle) = feature.checked_sub(faces) {
            give(triangle as usize, 1.0);
        } else if let Some(edge) = feature.checked_sub(vertices) {
            let there = &topology.at_edge[edge as usize];
            there.iter().for_each(|triangle| give(*triangle as usize, 1.0 / there.len() as f64));
        } else {
            let there = &topology.at_vertex[feature as usize];
            let whole: f64 = there.iter().map(|triangle| self.angle(*triangle, feature)).sum();
            there.iter().for_each(|triangle| give(*triangle as usize, self.angle(*triangle, feature) / whole));
        }
    }

    fn crack(&self, within: f64) -> Option<String> {
        faults::crack(&self.topology, within)
    }

    fn repeated(&self, copies: &Copies) -> Result<Repeated, [String; 2]> {
        self.joined(copies).map(|mesh| Repeated::Joined(Shape::of(mesh)))
    }
}
