//! Where a sphere touches triangles: on faces, edges and vertices.

use super::edge::OnEdge;
use super::face::{FLAT, Place, Stand};
use super::planes::Look;
use super::{Mesh, Sides};
use crate::base::lanes::{self, Width};
use crate::base::number::Vector;
use crate::laws::surface::feet::{DEEP, Features, Feet, Foot, OnPlanes};

impl Mesh {
    /// The nearest point of an edge.
    pub(super) fn on_edge(&self, centre: Vector, edge: u32) -> OnEdge {
        self.edges[edge as usize].nearest(centre)
    }

    /// The feature on which the nearest point of an edge lies.
    pub(super) fn feature_on(&self, edge: u32, on: &OnEdge) -> u32 {
        on.vertex.unwrap_or(self.topology.vertices.len() as u32 + edge)
    }

    /// The nearest point of three edges, and the edge: of those that are equally near the first.
    pub(super) fn nearest_edge(&self, centre: Vector, edges: [u32; 3]) -> (u32, OnEdge) {
        let [first, second, third] = edges.map(|edge| (edge, self.on_edge(centre, edge)));
        let nearer = if second.1.distance < first.1.distance { second } else { first };
        if third.1.distance < nearer.1.distance { third } else { nearer }
    }

    /// The feature of a triangle.
    pub(super) fn face(&self, triangle: u32) -> u32 {
        (self.topology.vertices.len() + self.topology.edges.len()) as u32 + triangle
    }

    /// How many triangles at an edge count.
    pub(super) fn at_edge(&self, centre: Vector, edge: u32) -> usize {
        match self.sides {
            Sides::Both => self.edges[edge as usize].triangles as usize,
            Sides::Front => {
                let at = &self.topology.at_edge[edge as usize];
                at.iter().filter(|triangle| self.counts(centre, **triangle)).count()
            }
        }
    }

    /// The weight of a vertex: 1 − k_v + Σ (k_e − 1) over what counts.
    fn of_vertex(&self, centre: Vector, vertex: u32) -> f64 {
        let at = &self.topology.at_vertex[vertex as usize];
        let triangles = at.iter().filter(|triangle| self.counts(centre, **triangle)).count();
        let edges = self.topology.edges_at_vertex[vertex as usize].iter().map(|edge| self.at_edge(centre, *edge));
        let edges: f64 = edges.filter(|count| *count > 0).map(|count| count as f64 - 1.0).sum();
        1.0 - triangles as f64 + edges
    }
}

/// Adds to the weight of a foot.
fn count(list: &mut Vec<Foot>, foot: Foot) {
    match list.iter_mut().find(|other| other.feature == foot.feature) {
        Some(other) => other.weight += foot.weight,
        None => list.push(foot),
    }
}

/// Adds the weights of feet that fall together with one on a face to that one, which alone is left of them: as a foot on the common edge of
/// two faces of a plane, or on a corner there, is on both. Friction has one face to act on.
fn unite(list: &mut [Foot], first_face: u32, within: f64) {
    let is_face = |foot: &Foot| foot.feature >= first_face;
    if list.iter().filter(|foot| is_face(foot)).count() < 2 {
        return;
    }
    for place in 0..list.len() {
        let one = list[place];
        if !is_face(&one) || one.weight == 0.0 {
            continue;
        }
        let falls_together =
            |other: &Foot| (other.normal * other.distance - one.normal * one.distance).length() <= within;
        for other in (0..list.len()).filter(|&other| other != place) {
            if falls_together(&list[other]) {
                list[place].weight += std::mem::take(&mut list[other].weight);
            }
        }
    }
}

impl Features for Mesh {
    fn near(&self, centre: Vector, reach: f64, parts: &mut Vec<u32>) {
        let before = parts.len();
        self.tree.near(centre, reach, |triangle| {
            if self.distance_from(centre, triangle) <= reach {
                parts.push(triangle);
            }
        });
        parts[before..].sort_unstable();
    }

    fn counts(&self) -> [usize; 2] {
        let parts = self.topology.triangles.len();
        [parts, self.topology.vertices.len() + self.topology.edges.len() + parts]
    }

    fn feet(&self, centre: Vector, radius: f64, parts: &[u32], feet: &mut Feet) {
        for &triangle in parts {
            let face = self.faces.at(triangle);
            let height = face.height(centre);
            let counts = self.sides == Sides::Both || height > 0.0;
            if !counts || height.abs() > radius {
                feet.behind |= !counts && face.is_within(centre, DEEP * radius, height);
                continue;
            }
            let rest = radius * radius - height * height;
            match face.place(centre, rest, radius, self.flat.edges[triangle as usize]) {
                Place::Away => {}
                Place::Over => feet.list.push(self.on_face(triangle, height)),
                Place::AtBend => {
                    feet.list.clear();
                    return self.feet_at_bends(centre, radius, parts, feet);
                }
            }
        }
        // Feet inside of faces alone: in order already, and each counts once.
    }

    fn plane(&self, centre: Vector, reach: f64, parts: &[u32]) -> Option<u32> {
        let first = *parts.first()?;
        let (normal, height) = (self.faces.at(first).normal, self.height(centre, first));
        let is_plane = parts.iter().all(|&part| {
            let (edges, flat) = (self.topology.edges_of[part as usize], self.flat.edges[part as usize]);
            let bends = edges.iter().enumerate().filter(|(place, _)| flat >> place & 1 == 0);
            self.flat.patch[part as usize] == self.flat.patch[first as usize]
                && self.faces.at(part).normal.cross(normal).length() < 4.0 * FLAT
                && (self.height(centre, part) - height).abs() < FLAT * reach
                && bends.into_iter().all(|(_, edge)| self.on_edge(centre, *edge).distance > reach)
        });
        is_plane.then_some(self.face(first))
    }

    fn on_planes(&self, spheres: &mut OnPlanes, width: Width) {
        lanes::run(width, Look { mesh: self, spheres });
    }

    fn prefetch(&self, features: &[u32]) {
        if self.faces.are_many() {
            let triangles = features.iter().filter_map(|feature| feature.checked_sub(self.face(0)));
            triangles.for_each(|triangle| self.faces.prefetch(triangle));
        }
    }

    fn meet(&self, one: u32, other: u32) -> bool {
        let ends = self.vertices_of(one);
        self.vertices_of(other).iter().any(|vertex| ends.contains(vertex))
    }

    fn extent(&self, point: Vector) -> f64 {
        self.topology.vertices.iter().map(|vertex| (*vertex - point).length()).fold(0.0, f64::max)
    }

    fn beside(&self, feature: u32, by: [i64; 3]) -> Option<u32> {
        self.of_copy(feature, by)
    }
}

impl Mesh {
    /// The foot of a centre at this height over a triangle, inside of which it lies.
    #[inline(always)]
    fn on_face(&self, triangle: u32, height: f64) -> Foot {
        let normal = self.faces.at(triangle).normal;
        let normal = if height < 0.0 { -normal } else { normal };
        Foot { feature: self.face(triangle), distance: height.abs(), normal, weight: 1.0, slope: 1.0 }
    }

    /// The feet on these parts where some are on edges and vertices, or near them.
    #[inline(never)]
    pub(super) fn feet_at_bends(&self, centre: Vector, radius: f64, parts: &[u32], feet: &mut Feet) {
        let bend = |feature: u32, apart: Vector, distance: f64, weight: f64| {
            let normal = apart * (1.0 / distance);
            Foot { feature, distance, normal, weight, slope: 1.0 }
        };
        let Feet { list, behind, room: [touched, vertices], .. } = feet;
        touched.clear();
        for &triangle in parts {
            let face = self.faces.at(triangle);
            let height = face.height(centre);
            let counts = self.sides == Sides::Both || height > 0.0;
            if !counts || height.abs() > radius {
                *behind |= !counts && face.is_within(centre, DEEP * radius, height);
                continue;
            }
            let Stand::Near { over, edges } = face.stand(centre, radius * radius - height * height) else { continue };
            let own_edges = self.topology.edges_of[triangle as usize];
            if over {
                list.push(self.on_face(triangle, height));
            } else {
                let (edge, on) = self.nearest_edge(centre, own_edges);
                if on.distance > radius {
                    continue;
                }
                count(list, bend(self.feature_on(edge, &on), on.apart, on.distance, 1.0));
            }
            touched.extend(own_edges.into_iter().zip(edges).filter_map(|(edge, near)| near.then_some(edge)));
        }
        touched.sort_unstable();
        touched.dedup();
        vertices.clear();
        for &edge in touched.iter() {
            let on = self.on_edge(centre, edge);
            if on.distance <= radius {
                let weight = 1.0 - self.at_edge(centre, edge) as f64;
                count(list, bend(self.feature_on(edge, &on), on.apart, on.distance, weight));
                vertices.extend(self.edges[edge as usize].ends);
            }
        }
        vertices.sort_unstable();
        vertices.dedup();
        for &vertex in vertices.iter() {
            let apart = centre - self.topology.vertices[vertex as usize];
            let distance = apart.length();
            if distance <= radius {
                count(list, bend(vertex, apart, distance, self.of_vertex(centre, vertex)));
            }
        }
        unite(list, self.face(0), FLAT * radius);
        list.retain(|foot| foot.weight != 0.0);
        list.sort_unstable_by_key(|foot| foot.feature);
        self.find_saddles(centre, feet);
    }

    /// The vertices of a feature.
    fn vertices_of(&self, feature: u32) -> &[u32] {
        let (vertices, edges) = (self.topology.vertices.len() as u32, self.topology.edges.len() as u32);
        match feature {
            edge if (vertices..vertices + edges).contains(&edge) => &self.topology.edges[(edge - vertices) as usize],
            face if face >= vertices + edges => &self.topology.triangles[(face - vertices - edges) as usize],
            // An edge knows its vertices; a vertex is one of the ends of any edge there.
            vertex => {
                let edge = self.topology.edges[self.topology.edges_at_vertex[vertex as usize][0] as usize];
                let place = usize::from(edge[1] == vertex);
                &self.topology.edges[self.topology.edges_at_vertex[vertex as usize][0] as usize][place..=place]
            }
        }
    }

    /// The foot on a triangle, or on another one of its patch.
    fn on_patch<'a>(&self, feet: &'a Feet, triangle: u32) -> Option<&'a Foot> {
        let (faces, patch) = (self.face(0), |triangle: u32| self.flat.patch[triangle as usize]);
        let is_there = |foot: &&Foot| foot.feature >= faces && patch(foot.feature - faces) == patch(triangle);
        feet.list.iter().find(is_there)
    }

    /// Finds the bends of negative weight between two faces that both carry the sphere: an edge, or a vertex between two edges
    /// of one bend.
    fn find_saddles(&self, centre: Vector, feet: &mut Feet) {
        let vertices = self.topology.vertices.len();
        for place in 0..feet.list.len() {
            let (bend, feature) = (feet.list[place], feet.list[place].feature as usize);
            if bend.weight >= 0.0 || bend.feature >= self.face(0) {
                continue;
            }
            let foot = centre - bend.normal * bend.distance;
            let at = match feature.checked_sub(vertices) {
                Some(edge) => &self.topology.at_edge[edge],
                None => &self.topology.at_vertex[feature],
            };
            let (mut faces, mut count) = ([(0, 0.0); 2], 0);
            for face in at.iter().filter_map(|triangle| self.on_patch(feet, *triangle)) {
                if faces[..count.min(2)].iter().all(|(known, _)| *known != face.feature) {
                    if let Some(one) = faces.get_mut(count) {
                        *one = (face.feature, (centre - face.normal * face.distance - foot).length());
                    }
                    count += 1;
                }
            }
            if let ([(one, x), (other, y)], 2) = (faces, count) {
                feet.add_saddle(bend.feature, [one, other], [x, y]);
            }
        }
    }
}
