//! `mesh`: triangles of a file.

mod edge;
mod face;
mod faults;
mod files;
mod nodes;
mod side;
mod topology;
mod tree;

use super::facets::Facets;
use super::feet::{Features, Feet, Foot};
use super::{Around, Shape, ShapeKeys, Surface};
use crate::geometry::rotation;
use crate::number::Vector;
use crate::quantity::{MaterialIndex, Positive, Triple};
use edge::{Edge, OnEdge};
use face::{Face, Place, Stand};
pub use nodes::{Deforming, Grip};
use serde::Deserialize;
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

    /// The nearest point of an edge.
    fn on_edge(&self, centre: Vector, edge: u32) -> OnEdge {
        self.edges[edge as usize].nearest(centre)
    }

    /// The feature on which the nearest point of an edge lies.
    fn feature_on(&self, edge: u32, on: &OnEdge) -> u32 {
        on.vertex.unwrap_or(self.topology.vertices.len() as u32 + edge)
    }

    /// The nearest point of three edges, and the edge: of those that are equally near the first.
    fn nearest_edge(&self, centre: Vector, edges: [u32; 3]) -> (u32, OnEdge) {
        let [first, second, third] = edges.map(|edge| (edge, self.on_edge(centre, edge)));
        let nearer = if second.1.distance < first.1.distance { second } else { first };
        if third.1.distance < nearer.1.distance { third } else { nearer }
    }

    /// The feature of a triangle.
    fn face(&self, triangle: u32) -> u32 {
        (self.topology.vertices.len() + self.topology.edges.len()) as u32 + triangle
    }

    /// How many triangles at an edge count.
    fn at_edge(&self, centre: Vector, edge: u32) -> usize {
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

/// Adds to the weight of a foot.
fn count(list: &mut Vec<Foot>, foot: Foot) {
    match list.iter_mut().find(|other| other.feature == foot.feature) {
        Some(other) => other.weight += foot.weight,
        None => list.push(foot),
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
            let face = &self.faces[triangle as usize];
            let height = face.height(centre);
            let counts = self.sides == Sides::Both || height > 0.0;
            if !counts || height.abs() > radius {
                continue;
            }
            let rest = radius * radius - height * height;
            match face.place(centre, rest, radius, self.flat.0[triangle as usize]) {
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

    fn meet(&self, one: u32, other: u32) -> bool {
        let ends = self.vertices_of(one);
        self.vertices_of(other).iter().any(|vertex| ends.contains(vertex))
    }

    fn extent(&self, point: Vector) -> f64 {
        self.topology.vertices.iter().map(|vertex| (*vertex - point).length()).fold(0.0, f64::max)
    }
}

impl Mesh {
    /// The foot of a centre at this height over a triangle, inside of which it lies.
    #[inline(always)]
    fn on_face(&self, triangle: u32, height: f64) -> Foot {
        let (normal, behind) = (self.faces[triangle as usize].normal, height < 0.0);
        let normal = if behind { -normal } else { normal };
        Foot { feature: self.face(triangle), distance: height.abs(), normal, weight: 1.0, behind }
    }

    /// The feet on these parts where some are on edges and vertices, or near them.
    #[inline(never)]
    fn feet_at_bends(&self, centre: Vector, radius: f64, parts: &[u32], feet: &mut Feet) {
        let bend = |feature: u32, apart: Vector, distance: f64, weight: f64| {
            let normal = apart * (1.0 / distance);
            Foot { feature, distance, normal, weight, behind: false }
        };
        let Feet { list, room: [touched, vertices], .. } = feet;
        touched.clear();
        for &triangle in parts {
            let face = &self.faces[triangle as usize];
            let height = face.height(centre);
            let counts = self.sides == Sides::Both || height > 0.0;
            if !counts || height.abs() > radius {
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

    /// Finds the edges of negative weight between two faces that both carry the sphere.
    fn find_saddles(&self, centre: Vector, feet: &mut Feet) {
        let vertices = self.topology.vertices.len() as u32;
        let edges = vertices..vertices + self.topology.edges.len() as u32;
        for place in 0..feet.list.len() {
            let edge = feet.list[place];
            if edge.weight >= 0.0 || !edges.contains(&edge.feature) {
                continue;
            }
            let foot = centre - edge.normal * edge.distance;
            let at = &self.topology.at_edge[(edge.feature - vertices) as usize];
            let mut on_faces = at
                .iter()
                .filter_map(|triangle| feet.on(self.face(*triangle)))
                .map(|face| (face.feature, (centre - face.normal * face.distance - foot).length()));
            if let (Some((one, x)), Some((other, y)), None) = (on_faces.next(), on_faces.next(), on_faces.next()) {
                feet.add_saddle(edge.feature, [one, other], [x, y]);
            }
        }
    }
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

/// `mesh = { file }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Keys {
    /// The file: STL, OBJ or VTK.
    file: String,
    /// Files of further triangles of the same surface.
    #[serde(default)]
    joined: Vec<String>,
    /// Length of one unit of the file \[m\].
    scale: Option<Positive>,
    /// Rotation after scaling: a rotation vector \[rad\].
    rotation: Option<Triple>,
    /// Displacement after that \[m\].
    offset: Option<Triple>,
    /// Which sides of the triangles count: 1, where the normals point, or 2.
    sides: Option<u8>,
}

impl Keys {
    /// The triangles of a file, where the scene wants them; what is wrong is reported.
    fn triangles(&self, key: &str, file: &str, around: &mut dyn Around) -> Option<Vec<[[f64; 3]; 3]>> {
        let mut triangles = match files::read(file, around.file(file)?) {
            Ok(triangles) if !triangles.is_empty() => triangles,
            Ok(_) => {
                around.refuse(key, format!("no triangle in {file}"), "a surface");
                return None;
            }
            Err((found, right)) => {
                around.refuse(key, format!("{file}: {found}"), &right);
                return None;
            }
        };
        let (scale, offset) = (self.scale.map_or(1.0, Positive::get), self.offset.unwrap_or_default().0);
        let turn = self.rotation.map(|rotation| rotation::orientation(rotation.0.into()));
        for corner in triangles.iter_mut().flatten() {
            let place = corner.map(|part| part * scale);
            let place = turn.map_or(place, |turn| turn.turn(place.into()).to_array());
            *corner = [0, 1, 2].map(|axis| place[axis] + offset[axis]);
        }
        let lost = triangles.iter().position(|triangle| !triangle.iter().flatten().all(|part| part.is_finite()));
        if let Some(triangle) = lost {
            let found = format!("{file}: triangle {} with a number that is not finite", triangle + 1);
            around.refuse(key, found, "finite coordinates");
            return None;
        }
        Some(triangles)
    }
}

impl ShapeKeys for Keys {
    const HINT: &'static str = "mesh = { file }";

    fn shape(&self, around: &mut dyn Around) -> Option<Shape> {
        let material = around.material("a mesh");
        if let Some(sides) = self.sides.filter(|sides| ![1, 2].contains(sides)) {
            around.refuse("mesh.sides", sides.to_string(), "1 or 2");
            return None;
        }
        let mut triangles = self.triangles("mesh.file", &self.file, around)?;
        for file in &self.joined {
            triangles.extend(self.triangles("mesh.joined", file, around)?);
        }
        let mut refuse =
            |found: String, right: &str| around.refuse("mesh.file", format!("{}: {found}", self.file), right);
        let mut topology = match Topology::of(&triangles) {
            Ok(topology) => topology,
            Err(triangle) => {
                refuse(format!("triangle {triangle} without area"), "triangles of some area");
                return None;
            }
        };
        if let (Err(triangle), Some(1)) = (topology.turn_alike(), self.sides) {
            refuse(format!("a surface that has one side only, seen at triangle {triangle},"), "sides = 2");
            return None;
        }
        if let Some(found) = faults::found(&topology) {
            refuse(found, "a surface that is there once everywhere");
            return None;
        }
        Some(Shape::of(Mesh::of(material?, topology, self.sides)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block of n × n × 1 squares of two triangles each, turned and rounded to single precision as an STL file would; or,
    /// without `closed`, its lid alone, with a slot in it.
    fn block(n: u32, closed: bool) -> Mesh {
        let turn = rotation::orientation(Vector::new(0.3, -0.5, 0.2));
        let at = |corner: [f64; 3]| turn.turn(Vector::from(corner)).to_array().map(|part| f64::from(part as f32));
        let mut triangles = Vec::new();
        let mut square = |corners: [[f64; 3]; 4]| {
            let [a, b, c, d] = corners.map(at);
            triangles.extend([[a, b, c], [a, c, d]]);
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [x, y] = [f64::from(i), f64::from(j)];
            if closed {
                square([[x, y, 0.0], [x, y + 1.0, 0.0], [x + 1.0, y + 1.0, 0.0], [x + 1.0, y, 0.0]]);
            } else if (i, j) == (n / 2, n / 2) {
                continue;
            }
            square([[x, y, 1.0], [x + 1.0, y, 1.0], [x + 1.0, y + 1.0, 1.0], [x, y + 1.0, 1.0]]);
        }
        for i in (0..n).filter(|_| closed) {
            let (x, end) = (f64::from(i), f64::from(n));
            square([[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x + 1.0, 0.0, 1.0], [x, 0.0, 1.0]]);
            square([[x + 1.0, end, 0.0], [x, end, 0.0], [x, end, 1.0], [x + 1.0, end, 1.0]]);
            square([[0.0, x + 1.0, 0.0], [0.0, x, 0.0], [0.0, x, 1.0], [0.0, x + 1.0, 1.0]]);
            square([[end, x, 0.0], [end, x + 1.0, 0.0], [end, x + 1.0, 1.0], [end, x, 1.0]]);
        }
        let topology = Topology::of(&triangles).unwrap_or_else(|triangle| panic!("triangle {triangle}"));
        Mesh::of(MaterialIndex(0), topology, None)
    }

    #[test]
    fn feet_inside_of_flat_patches_are_those_of_the_whole_rule() {
        let turn = rotation::orientation(Vector::new(0.3, -0.5, 0.2));
        for (closed, flat) in [(true, 3 * 2 * (3 * 3 * 2 + 4 * 3) - 2 * (12 + 12 + 4)), (false, 3 * 16 - 12 - 4)] {
            let mesh = block(3, closed);
            assert_eq!(mesh.flat.0.iter().map(|bits| bits.count_ones()).sum::<u32>(), flat);
            let parts: Vec<u32> = (0..mesh.faces.len() as u32).collect();
            let (mut quick, mut whole, mut met, mut flat) = (Feet::default(), Feet::default(), 0, 0);
            for number in 0..20_000_u32 {
                // Places as even as those of a lattice, none of which is like another.
                let part = |ratio: f64| (f64::from(number) * ratio).fract();
                let place =
                    [part(0.754_877_67) * 4.0 - 0.5, part(0.569_840_29) * 4.0 - 0.5, part(0.430_159_71) * 2.0 - 0.5];
                let (centre, radius) = (turn.turn(Vector::from(place)), 0.1 + 0.7 * part(0.618_033_99));
                quick.clear();
                whole.clear();
                mesh.feet(centre, radius, &parts, &mut quick);
                mesh.feet_at_bends(centre, radius, &parts, &mut whole);
                assert_eq!(quick.list, whole.list, "{place:?}, radius {radius}");
                assert_eq!(quick.saddles, whole.saddles);
                met += usize::from(!whole.list.is_empty());
                flat += usize::from(whole.list.len() == 1);
            }
            assert!(met > 5000 && flat > 2000, "{met} {flat}");
        }
    }
}
