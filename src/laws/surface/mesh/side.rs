//! How far a surface of triangles is, and on which side of it.

use super::{Mesh, Sides};
use crate::base::number::Vector;

/// The point of a surface that is nearest to a centre.
struct Nearest {
    /// Distance \[m\].
    distance: f64,
    /// From the point to the centre \[m\].
    apart: Vector,
    /// The vertex, edge or face that it lies on: feature.
    feature: u32,
}

impl Mesh {
    /// Distance of a centre from the triangles that count; below 0 behind a closed surface that has only its front \[m\].
    pub(super) fn signed_distance(&self, centre: Vector) -> Option<f64> {
        let one_sided = self.closed && self.sides == Sides::Front;
        let Nearest { distance, apart, feature } = self.nearest(centre, one_sided)?;
        let behind = one_sided && self.outwards(feature).dot(apart) < 0.0;
        Some(if behind { -distance } else { distance })
    }

    /// Distance of a centre from a triangle \[m\].
    pub(super) fn distance_from(&self, centre: Vector, triangle: u32) -> f64 {
        self.nearest_of(centre, triangle).distance
    }

    /// The nearest point of all triangles, or of those that count.
    fn nearest(&self, centre: Vector, all: bool) -> Option<Nearest> {
        let mut best: Option<Nearest> = None;
        self.tree.search(centre, f64::INFINITY, |triangle| {
            if all || self.counts(centre, triangle) {
                let found = self.nearest_of(centre, triangle);
                if best.as_ref().is_none_or(|best| found.distance < best.distance) {
                    best = Some(found);
                }
            }
            best.as_ref().map_or(f64::INFINITY, |best| best.distance)
        });
        best
    }

    /// The triangle that is nearest to a point.
    pub(super) fn nearest_triangle(&self, point: Vector) -> usize {
        let (mut least, mut nearest) = (f64::INFINITY, 0);
        self.tree.search(point, f64::INFINITY, |triangle| {
            let distance = self.distance_from(point, triangle);
            if distance < least {
                (least, nearest) = (distance, triangle as usize);
            }
            least
        });
        nearest
    }

    /// The nearest point of a triangle.
    fn nearest_of(&self, centre: Vector, triangle: u32) -> Nearest {
        let face = self.faces.at(triangle);
        if face.is_over(centre) {
            let height = face.height(centre);
            let apart = face.normal * height;
            return Nearest { distance: height.abs(), apart, feature: self.face(triangle) };
        }
        let (edge, on) = self.nearest_edge(centre, self.topology.edges_of[triangle as usize]);
        Nearest { distance: on.distance, apart: on.apart, feature: self.feature_on(edge, &on) }
    }

    /// A direction that points to the front at a feature: the mean normal of the triangles there, by their angles at a vertex
    /// (Bærentzen and Aanæs, IEEE Trans. Vis. Comput. Graph. 11, 2005, 243). Of any length.
    fn outwards(&self, feature: u32) -> Vector {
        let topology = &self.topology;
        let (vertices, edges) = (topology.vertices.len(), topology.edges.len());
        let place = feature as usize;
        let normal = |triangle: &u32| self.faces.at(*triangle).normal;
        if place >= vertices + edges {
            self.faces.at((place - vertices - edges) as u32).normal
        } else if place >= vertices {
            topology.at_edge[place - vertices].iter().map(normal).fold(Vector::zero(), |sum, one| sum + one)
        } else {
            let weighted = |triangle: &u32| normal(triangle) * self.angle(*triangle, feature);
            topology.at_vertex[place].iter().map(weighted).fold(Vector::zero(), |sum, one| sum + one)
        }
    }

    /// The angle of a triangle at one of its vertices \[rad\].
    pub(super) fn angle(&self, triangle: u32, vertex: u32) -> f64 {
        let corners = self.topology.triangles[triangle as usize];
        let at = |number: usize| self.topology.vertices[corners[number % 3] as usize];
        let corner = corners.iter().position(|corner| *corner == vertex).unwrap_or(0);
        let (one, other) = (at(corner + 1) - at(corner), at(corner + 2) - at(corner));
        libm::atan2(one.cross(other).length(), one.dot(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::quantity::MaterialIndex;
    use crate::laws::surface::mesh::topology::Topology;

    /// A prism with a notch: concave and convex edges, vertices of both kinds.
    fn notched() -> Mesh {
        let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]];
        let at = |corner: usize, z: f64| [outline[corner % 5][0], outline[corner % 5][1], z];
        let mut triangles = Vec::new();
        for corner in 0..5 {
            let (a, b, c, d) = (at(corner, 0.0), at(corner + 1, 0.0), at(corner + 1, 1.0), at(corner, 1.0));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        for [a, b, c] in [[0, 1, 3], [1, 2, 3], [0, 3, 4]] {
            triangles.extend([[at(a, 1.0), at(b, 1.0), at(c, 1.0)], [at(a, 0.0), at(c, 0.0), at(b, 0.0)]]);
        }
        let topology = Topology::of(&triangles).unwrap_or_else(|triangle| panic!("triangle {triangle}"));
        Mesh::of(MaterialIndex(0), topology, None)
    }

    /// Whether a place is inside the prism.
    fn is_inside([x, y, z]: [f64; 3]) -> bool {
        let notch = 0.5 + 1.5 * (x - 1.0).abs();
        (0.0..1.0).contains(&z) && (0.0..2.0).contains(&x) && (0.0..notch).contains(&y)
    }

    #[test]
    fn the_inside_of_a_closed_surface_is_behind_it_wherever_the_nearest_point_lies() {
        let mesh = notched();
        for number in 0..20 * 20 * 12 {
            let (i, j, k) = (number % 20, number / 20 % 20, number / 400);
            let place = [(i, 0.151), (j, 0.153), (k, 0.171)].map(|(k, by)| f64::from(k) * by - 0.47);
            let found = mesh.signed_distance(place.into()).unwrap();
            assert_eq!(found < 0.0, is_inside(place), "{found} m at {place:?}");
        }
        // 0.1 before the face x = 2, beyond a vertex, and halfway between the floor and the lid in the middle of a leg.
        assert_eq!(mesh.signed_distance(Vector::new(2.1, 1.0, 0.5)), Some(2.1 - 2.0));
        let beyond = mesh.signed_distance(Vector::new(2.3, 2.4, 0.5)).unwrap();
        assert!((beyond - 0.5).abs() < 1e-15, "{beyond}");
        assert_eq!(mesh.signed_distance(Vector::new(0.25, 0.3, 0.5)), Some(-0.25));
    }
}
