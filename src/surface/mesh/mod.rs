//! `mesh`: triangles of a file.

mod edge;
mod face;
mod faults;
mod feet;
mod files;
mod keys;
mod nodes;
mod side;
mod topology;
mod tree;

use super::facets::Facets;
use super::feet::Features;
use super::{Shape, Surface};
use crate::number::Vector;
use crate::quantity::MaterialIndex;
use edge::Edge;
use face::Face;
pub(crate) use keys::Keys;
pub use nodes::{Deforming, Grip};
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
    faces: Vec<Face>,
    /// The edges, likewise.
    edges: Vec<Edge>,
    /// Which edges of each triangle are flat: there it meets one other triangle, in the same plane. A bit for each.
    flat: Flat,
    /// The tree that finds near triangles.
    tree: Tree,
    /// Which side counts.
    sides: Sides,
    /// Whether it has no rim.
    closed: bool,
    /// Middle of the box around it \[m\].
    middle: Vector,
}

impl Mesh {
    /// A surface.
    fn of(material: MaterialIndex, topology: Topology, sides: Option<u8>) -> Self {
        let faces: Vec<Face> = topology.triangles.iter().map(|triangle| Face::of(topology.corners(triangle))).collect();
        let [low, high] = topology::around(&topology.vertices);
        let closed = topology.is_closed();
        let front = sides.map_or(closed, |sides| sides == 1);
        Self {
            material,
            tree: topology.tree(),
            flat: flat_edges(&topology, &faces),
            faces,
            edges: Edge::all(&topology).collect(),
            sides: if front { Sides::Front } else { Sides::Both },
            closed,
            middle: (Vector::from(low) + Vector::from(high)) * 0.5,
            topology,
        }
    }

    /// Height of a centre over a triangle \[m\].
    fn height(&self, centre: Vector, triangle: usize) -> f64 {
        self.faces[triangle].height(centre)
    }

    /// Whether a triangle counts for a centre.
    fn counts(&self, centre: Vector, triangle: u32) -> bool {
        self.sides == Sides::Both || self.height(centre, triangle as usize) > 0.0
    }
}

/// The flat edges of each triangle, a bit for each.
#[derive(Clone)]
struct Flat(Vec<u8>);

/// Nothing but the name, as for [`Face`].
impl std::fmt::Debug for Flat {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Flat")
    }
}

/// Which edges are flat.
fn flat_edges(topology: &Topology, faces: &[Face]) -> Flat {
    let is_flat = |edge: u32| match topology.at_edge[edge as usize][..] {
        [one, other] => {
            let [one, other] = [one, other].map(|triangle| faces[triangle as usize].normal);
            one.dot(other) > 0.0 && one.cross(other).length() < face::FLAT
        }
        _ => false,
    };
    let bits = |[first, second, third]: [u32; 3]| {
        u8::from(is_flat(first)) | u8::from(is_flat(second)) << 1 | u8::from(is_flat(third)) << 2
    };
    Flat(topology.edges_of.iter().map(|edges| bits(*edges)).collect())
}

/// A surface of the triangles in STL files; an error says what is wrong with them. `sides`: 1, where the normals point, or 2;
/// if absent, 1 for a closed surface and 2 for any other.
pub fn of_files(material: MaterialIndex, files: &[Vec<u8>], sides: Option<u8>) -> Result<Shape, String> {
    let mut triangles = Vec::new();
    for file in files {
        triangles.extend(
            files::read("mesh.stl", file).map_err(|(found, right)| format!("{found} found; {right} is right"))?,
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
        format!("mesh of {} triangles", self.topology.triangles.len())
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
}
