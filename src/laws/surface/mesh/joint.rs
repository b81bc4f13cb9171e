//! A surface of triangles and its copies in a periodic cell, joined where they meet.

use super::topology::Topology;
use super::{Mesh, Sides, faults};
use crate::base::number::Vector;
use crate::base::quantity::MaterialIndex;
use crate::laws::surface::{Copies, Repeated, Surface};

/// Of which copies a surface is joined.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    /// The copies.
    copies: Copies,
    /// Triangles of each.
    count: usize,
    /// Place of each triangle among all of them, ascending: one that is there twice is left out.
    places: Vec<usize>,
}

impl Joint {
    /// The same triangle of the copy that stands by so many edges of the cell beside.
    fn beside(&self, triangle: u32, by: [i64; 3]) -> Option<usize> {
        let place = self.places[triangle as usize];
        let (copy, own) = (place / self.count, place % self.count);
        let wanted = self.copies.beside(copy, by)? * self.count + own;
        self.places.binary_search(&wanted).ok()
    }
}

/// Triangles with two sides and their copies.
pub(in crate::laws::surface) fn joined(
    material: MaterialIndex,
    corners: &[[[f64; 3]; 3]],
    copies: &Copies,
) -> Result<Repeated, [String; 2]> {
    let topology = Topology::of(corners).map_err(|_| fault("a triangle without area"))?;
    Mesh::of(material, topology, Some(2)).repeated(copies)
}

/// What is wrong with a surface and its copies.
fn fault(found: &str) -> [String; 2] {
    [format!("with its copies, {found}"), "edges that meet at the faces of the cell".to_owned()]
}

impl Mesh {
    /// The surface with its copies.
    pub(super) fn joined(&self, copies: &Copies) -> Result<Self, [String; 2]> {
        let Topology { triangles, numbers, tolerance, .. } = &self.topology;
        let moved = |shift: &Vector| {
            let shift = *shift;
            let corners = triangles.iter().map(|triangle| self.topology.corners(triangle));
            corners.map(move |corners| corners.map(|corner| (corner + shift).to_array()))
        };
        let all: Vec<_> = copies.shifts.iter().flat_map(moved).collect();
        let mut topology = Topology::welded(&all, Some(*tolerance)).map_err(|_| fault("a triangle without area"))?;
        let places: Vec<usize> = topology.numbers.iter().map(|number| number - 1).collect();
        topology.numbers = places.iter().map(|place| numbers[place % triangles.len()]).collect();
        if topology.turn_alike().is_err() && self.sides == Sides::Front {
            return Err(fault("a surface that has one side only"));
        }
        if let Some(found) = faults::found(&topology) {
            return Err(fault(&found));
        }
        let sides = if self.sides == Sides::Front { 1 } else { 2 };
        let joint = Joint { copies: copies.clone(), count: triangles.len(), places };
        Ok(Self { joint: Some(joint), ..Self::of(self.material, topology, Some(sides)) })
    }

    /// The same feature of another copy: that of the same corners of the same triangle.
    pub(super) fn of_copy(&self, feature: u32, by: [i64; 3]) -> Option<u32> {
        let Some(joint) = &self.joint else { return Some(feature) };
        let (topology, vertices) = (&self.topology, self.topology.vertices.len() as u32);
        let find = |at: &[u32], of: &[[u32; 3]], own: u32| {
            at.iter().find_map(|&triangle| {
                let corner = of[triangle as usize].iter().position(|it| *it == own)?;
                Some(of[joint.beside(triangle, by)?][corner])
            })
        };
        if feature >= self.face(0) {
            joint.beside(feature - self.face(0), by).map(|triangle| self.face(triangle as u32))
        } else if feature >= vertices {
            let edge = feature - vertices;
            find(&topology.at_edge[edge as usize], &topology.edges_of, edge).map(|edge| vertices + edge)
        } else {
            find(&topology.at_vertex[feature as usize], &topology.triangles, feature)
        }
    }
}
