//! `mesh`: triangles of a file.

mod faults;
mod files;
mod side;
mod topology;
mod tree;

use super::feet::{Features, Feet, Foot};
use super::{Around, Shape, ShapeKeys, Surface};
use crate::geometry::rotation;
use crate::number::Vector;
use crate::quantity::{MaterialIndex, Positive, Triple};
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
    /// Unit normal of each triangle.
    normals: Vec<Vector>,
    /// The tree that finds near triangles.
    tree: Tree,
    /// Which side counts.
    sides: Sides,
    /// Whether it has no rim.
    closed: bool,
    /// Middle of the box around it \[m\].
    middle: Vector,
}

/// How the foot of a centre in the plane of a triangle stands to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stand {
    /// Inside, and no edge is within reach.
    Inside,
    /// Inside.
    Over,
    /// Outside.
    Beside,
    /// Outside, and the triangle is out of reach.
    Apart,
}

/// The nearest point of an edge.
#[derive(Clone, Copy)]
struct OnEdge {
    /// The vertex or the edge: feature.
    feature: u32,
    /// From the foot to the centre \[m\].
    apart: Vector,
    /// Distance \[m\].
    distance: f64,
}

impl Mesh {
    /// A surface.
    fn of(material: MaterialIndex, topology: Topology, sides: Option<u8>) -> Self {
        let places = |triangle: &[u32; 3]| triangle.map(|vertex| topology.vertices[vertex as usize]);
        let normal = |triangle: &[u32; 3]| {
            let [a, b, c] = places(triangle);
            let across = (b - a).cross(c - a);
            super::direction(across.to_array()).map_or(across, Vector::from)
        };
        let normals = topology.triangles.iter().map(normal).collect();
        let around = |places: &[Vector]| {
            let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for place in places.iter().map(|place| place.to_array()) {
                for axis in 0..3 {
                    low[axis] = low[axis].min(place[axis]);
                    high[axis] = high[axis].max(place[axis]);
                }
            }
            [low, high]
        };
        let boxes: Vec<_> = topology.triangles.iter().map(|triangle| around(&places(triangle))).collect();
        let [low, high] = around(&topology.vertices);
        let closed = topology.is_closed();
        let front = sides.map_or(closed, |sides| sides == 1);
        Self {
            material,
            tree: Tree::of(&boxes),
            normals,
            sides: if front { Sides::Front } else { Sides::Both },
            closed,
            middle: (Vector::from(low) + Vector::from(high)) * 0.5,
            topology,
        }
    }

    /// Height of a centre over a triangle \[m\].
    fn height(&self, centre: Vector, triangle: usize) -> f64 {
        let corner = self.topology.vertices[self.topology.triangles[triangle][0] as usize];
        (centre - corner).dot(self.normals[triangle])
    }

    /// Whether a triangle counts for a centre.
    fn counts(&self, centre: Vector, triangle: u32) -> bool {
        self.sides == Sides::Both || self.height(centre, triangle as usize) > 0.0
    }

    /// The nearest point of an edge. Every triangle at the edge sees the same numbers.
    fn on_edge(&self, centre: Vector, edge: u32) -> OnEdge {
        let ends = self.topology.edges[edge as usize];
        let [a, b] = ends.map(|vertex| self.topology.vertices[vertex as usize]);
        let (way, from_a, from_b) = (b - a, centre - a, centre - b);
        let (before, beyond) = (way.dot(from_a), way.dot(from_b));
        let (feature, apart) = if before <= 0.0 {
            (ends[0], from_a)
        } else if beyond >= 0.0 {
            (ends[1], from_b)
        } else {
            let foot = a + way * (before / (before - beyond));
            (self.topology.vertices.len() as u32 + edge, centre - foot)
        };
        OnEdge { feature, apart, distance: apart.length() }
    }

    /// How the foot of a centre in the plane of a triangle stands to it, where the square of a radius goes beyond that of the
    /// height by `rest` \[m²\].
    fn stand(&self, centre: Vector, triangle: usize, rest: f64) -> Stand {
        /// What rounding may take from a distance, with room.
        const ROUNDING: f64 = 1.0 + 1e-9;
        let corners = self.topology.triangles[triangle].map(|vertex| self.topology.vertices[vertex as usize]);
        let (mut over, mut near) = (true, false);
        for corner in 0..3 {
            let way = corners[(corner + 1) % 3] - corners[corner];
            // Beyond the edge where this is above 0: the distance from it times the length of the edge.
            let beyond = way.cross(self.normals[triangle]).dot(centre - corners[corner]);
            let out_of_reach = beyond * beyond > rest * way.dot(way) * ROUNDING;
            if beyond > 0.0 && out_of_reach {
                return Stand::Apart;
            }
            over &= beyond <= 0.0;
            near |= !out_of_reach;
        }
        match (over, near) {
            (true, false) => Stand::Inside,
            (true, true) => Stand::Over,
            (false, _) => Stand::Beside,
        }
    }

    /// Whether the foot of a centre in the plane of a triangle is inside it.
    fn is_over(&self, centre: Vector, triangle: usize) -> bool {
        let corners = self.topology.triangles[triangle].map(|vertex| self.topology.vertices[vertex as usize]);
        (0..3).all(|corner| {
            let way = corners[(corner + 1) % 3] - corners[corner];
            way.cross(self.normals[triangle]).dot(centre - corners[corner]) <= 0.0
        })
    }

    /// The feature of a triangle.
    fn face(&self, triangle: u32) -> u32 {
        (self.topology.vertices.len() + self.topology.edges.len()) as u32 + triangle
    }

    /// How many triangles at an edge count.
    fn at_edge(&self, centre: Vector, edge: u32) -> usize {
        let at = &self.topology.at_edge[edge as usize];
        at.iter().filter(|triangle| self.counts(centre, **triangle)).count()
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
fn count(feet: &mut Feet, foot: Foot) {
    match feet.list.iter_mut().find(|other| other.feature == foot.feature) {
        Some(other) => other.weight += foot.weight,
        None => feet.list.push(foot),
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
        let edge_foot = |on: &OnEdge, weight: f64| {
            let normal = on.apart * (1.0 / on.distance);
            Foot { feature: on.feature, distance: on.distance, normal, weight, behind: false }
        };
        let [mut touched, mut vertices] = std::mem::take(&mut feet.room);
        touched.clear();
        vertices.clear();
        for &triangle in parts.iter().filter(|triangle| self.counts(centre, **triangle)) {
            let place = triangle as usize;
            let (height, normal) = (self.height(centre, place), self.normals[place]);
            if height.abs() > radius {
                continue;
            }
            let edges = self.topology.edges_of[place];
            let stand = self.stand(centre, place, radius * radius - height * height);
            if stand == Stand::Apart {
                continue;
            }
            if matches!(stand, Stand::Inside | Stand::Over) {
                let (behind, normal) = (height < 0.0, if height < 0.0 { -normal } else { normal });
                let (feature, distance) = (self.face(triangle), height.abs());
                count(feet, Foot { feature, distance, normal, weight: 1.0, behind });
                if stand == Stand::Inside {
                    continue;
                }
            } else {
                let feet_on = edges.map(|edge| self.on_edge(centre, edge));
                let nearest = |one: OnEdge, other: OnEdge| if other.distance < one.distance { other } else { one };
                let on = feet_on.into_iter().reduce(nearest).filter(|on| on.distance <= radius);
                let Some(on) = on else { continue };
                count(feet, edge_foot(&on, 1.0));
            }
            touched.extend(edges);
        }
        touched.sort_unstable();
        touched.dedup();
        for &edge in &touched {
            let on = self.on_edge(centre, edge);
            if on.distance <= radius {
                count(feet, edge_foot(&on, 1.0 - self.at_edge(centre, edge) as f64));
                vertices.extend(self.topology.edges[edge as usize]);
            }
        }
        vertices.sort_unstable();
        vertices.dedup();
        for &vertex in &vertices {
            let apart = centre - self.topology.vertices[vertex as usize];
            let distance = apart.length();
            if distance <= radius {
                let on = OnEdge { feature: vertex, apart, distance };
                count(feet, edge_foot(&on, self.of_vertex(centre, vertex)));
            }
        }
        feet.list.retain(|foot| foot.weight != 0.0);
        feet.list.sort_unstable_by_key(|foot| foot.feature);
        self.find_saddles(centre, feet);
        feet.room = [touched, vertices];
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

    fn distance(&self, centre: Vector) -> Option<f64> {
        self.signed_distance(centre)
    }

    fn reference(&self) -> Option<[f64; 3]> {
        Some(self.middle.to_array())
    }

    fn turns(&self) -> bool {
        true
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
