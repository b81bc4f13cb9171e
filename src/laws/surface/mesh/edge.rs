//! An edge as the search for feet wants it: all numbers side by side.

use super::topology::Topology;
use crate::base::number::Vector;

/// An edge. It fills a line of the cache.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Edge {
    /// Its ends \[m\].
    places: [Vector; 2],
    /// Their vertices, the lower one first.
    pub(super) ends: [u32; 2],
    /// How many triangles have it.
    pub(super) triangles: u32,
}

/// The nearest point of an edge.
#[derive(Clone, Copy)]
pub(super) struct OnEdge {
    /// The vertex on which it lies; on none, inside the edge.
    pub(super) vertex: Option<u32>,
    /// From it to the centre \[m\].
    pub(super) apart: Vector,
    /// Distance \[m\].
    pub(super) distance: f64,
}

/// Nothing but the name: all numbers follow from the topology, which is told already where scenes are compared.
impl std::fmt::Debug for Edge {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Edge")
    }
}

impl Edge {
    /// Those of a surface.
    pub(super) fn all(topology: &Topology) -> impl Iterator<Item = Self> + '_ {
        let edge = move |(ends, at): (&[u32; 2], &Vec<u32>)| Self {
            places: ends.map(|vertex| topology.vertices[vertex as usize]),
            ends: *ends,
            triangles: at.len() as u32,
        };
        topology.edges.iter().zip(&topology.at_edge).map(edge)
    }

    /// The point that is nearest to a centre. Every triangle at the edge sees the same numbers.
    #[inline(always)]
    pub(super) fn nearest(&self, centre: Vector) -> OnEdge {
        let [a, b] = self.places;
        let (way, from_a, from_b) = (b - a, centre - a, centre - b);
        let (before, beyond) = (way.dot(from_a), way.dot(from_b));
        let (vertex, apart) = if before <= 0.0 {
            (Some(self.ends[0]), from_a)
        } else if beyond >= 0.0 {
            (Some(self.ends[1]), from_b)
        } else {
            (None, centre - (a + way * (before / (before - beyond))))
        };
        OnEdge { vertex, apart, distance: apart.length() }
    }
}
