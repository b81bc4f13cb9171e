//! Which features of a surface a sphere touches, and how often each counts.

use super::SurfaceMesh;
use crate::number::Vector;
use std::collections::BTreeMap;

/// A part of a surface; the order is the one in which contacts are added up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Feature {
    /// A vertex, by number.
    Vertex(u32),
    /// The inside of an edge.
    Edge(u32),
    /// The inside of a triangle.
    Face(u32),
}

/// From which side a surface is felt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Only where the normals point: closed surfaces.
    Front,
    /// From both: open sheets.
    Both,
}

/// A feature within reach of a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// What is touched.
    pub feature: Feature,
    /// How often it counts: 1 where the distance has a local minimum, −1 at a shallow concave edge under the sphere.
    pub multiplicity: i32,
    /// The nearest point of the feature \[m\].
    pub foot: [f64; 3],
    /// Its distance from the centre \[m\].
    pub distance: f64,
    /// Unit vector from the foot to the centre.
    pub normal: [f64; 3],
}

impl SurfaceMesh {
    /// The features within reach of a centre whose multiplicity is not 0, in their order.
    ///
    /// `candidates` must name, once each, all triangles nearer than `reach` \[m\]; others do no harm. A centre on the
    /// surface itself has no normal; its distance is 0 and its normal that of the first face there.
    ///
    /// Weights are counted over the triangles in reach that are felt. All triangles at an edge or vertex in reach are in
    /// reach themselves, so the count is complete where it matters.
    pub fn touches(
        &self,
        centre: [f64; 3],
        reach: f64,
        sides: Sides,
        candidates: impl IntoIterator<Item = u32>,
    ) -> Vec<Touch> {
        let centre = super::vector(centre);
        let mut multiplicity: BTreeMap<Feature, i32> = BTreeMap::new();
        let (mut at_edge, mut at_vertex) = (BTreeMap::<u32, i32>::new(), BTreeMap::<u32, i32>::new());
        for triangle in candidates {
            let height = self.height(triangle, centre);
            if height.abs() >= reach || sides == Sides::Front && height <= 0.0 {
                continue;
            }
            let feature = self.nearest_of_triangle(triangle, centre);
            if self.way(feature, centre).1 >= reach {
                continue;
            }
            *multiplicity.entry(feature).or_default() += 1;
            for edge in self.edges_of[triangle as usize] {
                *at_edge.entry(edge).or_default() += 1;
            }
            for corner in self.triangles[triangle as usize] {
                *at_vertex.entry(corner).or_default() += 1;
            }
        }
        let mut vertex_weight: BTreeMap<u32, i32> =
            at_vertex.iter().map(|(vertex, count)| (*vertex, 1 - count)).collect();
        for (edge, count) in &at_edge {
            for end in self.edges[*edge as usize].ends {
                *vertex_weight.entry(end).or_default() += count - 1;
            }
            let feature = self.nearest_of_edge(*edge, centre);
            if *count != 1 && self.way(feature, centre).1 < reach {
                *multiplicity.entry(feature).or_default() += 1 - count;
            }
        }
        for (vertex, weight) in vertex_weight {
            let feature = Feature::Vertex(vertex);
            if weight != 0 && self.way(feature, centre).1 < reach {
                *multiplicity.entry(feature).or_default() += weight;
            }
        }
        let counted = multiplicity.into_iter().filter(|(_, multiplicity)| *multiplicity != 0);
        counted.map(|(feature, multiplicity)| self.touch(feature, multiplicity, centre)).collect()
    }

    /// A feature as it is touched.
    fn touch(&self, feature: Feature, multiplicity: i32, centre: Vector) -> Touch {
        let (way, distance) = self.way(feature, centre);
        let normal = match feature {
            Feature::Face(triangle) => {
                let sign = if self.height(triangle, centre) < 0.0 { -1.0 } else { 1.0 };
                super::vector(self.normals[triangle as usize]) * sign
            }
            _ if distance > 0.0 => way * (1.0 / distance),
            _ => Vector::zero(),
        };
        Touch { feature, multiplicity, foot: (centre - way).to_array(), distance, normal: normal.to_array() }
    }

    /// Height of a point above the plane of a triangle \[m\].
    fn height(&self, triangle: u32, point: Vector) -> f64 {
        let corner = self.at(self.triangles[triangle as usize][0]);
        (point - corner).dot(super::vector(self.normals[triangle as usize]))
    }

    /// From the nearest point of the line, plane or point of a feature to the centre, and its length \[m\].
    fn way(&self, feature: Feature, centre: Vector) -> (Vector, f64) {
        match feature {
            Feature::Vertex(vertex) => {
                let way = centre - self.at(vertex);
                (way, way.length())
            }
            Feature::Edge(edge) => {
                let [a, b] = self.edges[edge as usize].ends.map(|end| self.at(end));
                let along = b - a;
                let way = centre - a - along * ((centre - a).dot(along) / along.dot(along));
                (way, way.length())
            }
            Feature::Face(triangle) => {
                let height = self.height(triangle, centre);
                (super::vector(self.normals[triangle as usize]) * height, height.abs())
            }
        }
    }

    /// On which part of an edge the point nearest to a centre lies.
    fn nearest_of_edge(&self, edge: u32, centre: Vector) -> Feature {
        let ends = self.edges[edge as usize].ends;
        let [a, b] = ends.map(|end| self.at(end));
        let share = (centre - a).dot(b - a);
        if share <= 0.0 {
            Feature::Vertex(ends[0])
        } else if share >= (b - a).dot(b - a) {
            Feature::Vertex(ends[1])
        } else {
            Feature::Edge(edge)
        }
    }

    /// On which part of a triangle the point nearest to a centre lies (Ericson, Real-Time Collision Detection, 5.1.5).
    fn nearest_of_triangle(&self, triangle: u32, centre: Vector) -> Feature {
        let corners = self.triangles[triangle as usize];
        let edges = self.edges_of[triangle as usize];
        let [a, b, c] = corners.map(|corner| self.at(corner));
        let (ab, ac) = (b - a, c - a);
        let [to_a, to_b, to_c] = [a, b, c].map(|corner| centre - corner);
        let (a_along_ab, a_along_ac) = (ab.dot(to_a), ac.dot(to_a));
        if a_along_ab <= 0.0 && a_along_ac <= 0.0 {
            return Feature::Vertex(corners[0]);
        }
        let (b_along_ab, b_along_ac) = (ab.dot(to_b), ac.dot(to_b));
        if b_along_ab >= 0.0 && b_along_ac <= b_along_ab {
            return Feature::Vertex(corners[1]);
        }
        let beside_ab = a_along_ab * b_along_ac - b_along_ab * a_along_ac;
        if beside_ab <= 0.0 && a_along_ab >= 0.0 && b_along_ab <= 0.0 {
            return Feature::Edge(edges[0]);
        }
        let (c_along_ab, c_along_ac) = (ab.dot(to_c), ac.dot(to_c));
        if c_along_ac >= 0.0 && c_along_ab <= c_along_ac {
            return Feature::Vertex(corners[2]);
        }
        let beside_ca = c_along_ab * a_along_ac - a_along_ab * c_along_ac;
        if beside_ca <= 0.0 && a_along_ac >= 0.0 && c_along_ac <= 0.0 {
            return Feature::Edge(edges[2]);
        }
        let beside_bc = b_along_ab * c_along_ac - c_along_ab * b_along_ac;
        if beside_bc <= 0.0 && b_along_ac - b_along_ab >= 0.0 && c_along_ab - c_along_ac >= 0.0 {
            return Feature::Edge(edges[1]);
        }
        Feature::Face(triangle)
    }
}

#[cfg(test)]
mod tests;
