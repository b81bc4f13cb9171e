//! A mesh whose nodes move one by one, and how the surface moves with them.
//!
//! The surface at a foot moves at the velocity v of the foot and turns at ω. Both follow from the velocities v_a of the nodes
//! around it, and what the surface feels there, a force F at the foot and a couple M, is shared out on them by the transpose:
//!
//! ```text
//! v = Σ w_a v_a     ω = Σ W_a v_a          f_a = w_a F + W_aᵀ M
//!
//! face     w_a = N_a      W_a = (e_a ⊗ N)/2A + N ⊗ (N × r_a)/J          e_a the opposite edge, J = Σ r_a²
//! edge     w_a = 1 − s, s W v = t × (v_b − v_a)/L + t (t · mean of ω of the triangles at it)
//! vertex   w_a = 1        W_a = mean over the triangles there, by their angles
//! ```
//!
//! Any rigid motion of the nodes gives its own v and ω; hence Σ f = F, Σ x × f = x_foot × F + M, and Σ f_a·v_a = F·v + M·ω for any
//! velocities. A couple along an edge is carried by its triangles, one across it by its ends: triangles in one plane are no
//! special case.

use super::edge::Edge;
use super::{Features, Flat, Mesh, Surface};
use crate::base::number::{Row, Vector};

/// What a node gives to the motion of the surface at a foot, and takes from the load there.
#[derive(Clone, Copy, Debug)]
pub struct NodeWeights {
    /// The node, from 0.
    pub node: u32,
    /// Share of its velocity in that of the foot, and of the force in its own.
    weight: f64,
    /// Angular velocity of the surface by its velocity, row by row \[1/m\].
    turn: [Vector; 3],
}

impl NodeWeights {
    /// What its velocity \[m/s\] gives to velocity \[m/s\] and angular velocity \[rad/s\] of the surface at the foot.
    pub fn motion(&self, velocity: Vector) -> [Vector; 2] {
        [velocity * self.weight, Vector::from(self.turn.map(|row| row.dot(velocity)))]
    }

    /// Its share of what the surface has at the foot; the shares of all nodes add up to 1.
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// Its part of a force \[N\] and a couple \[N m\] at the foot \[N\].
    pub fn load(&self, force: Vector, couple: Vector) -> Vector {
        let [x, y, z] = self.turn;
        force * self.weight + x * couple.x + y * couple.y + z * couple.z
    }

    /// A node that only turns the surface: an angular velocity along `out` by its velocity along `by`.
    fn turning(node: u32, out: Vector, by: Vector) -> Self {
        Self { node, weight: 0.0, turn: [by * out.x, by * out.y, by * out.z] }
    }
}

/// Whether a centre on its straight way goes through a triangle whose corners go from the first of these places to the second
/// meanwhile \[m\].
fn leads_through(way: [Vector; 2], corners: [[Vector; 3]; 2]) -> bool {
    let height = |place: usize| {
        let [a, b, c] = corners[place];
        (way[place] - a)
            .dot(crate::laws::surface::direction((b - a).cross(c - a).to_array()).map_or(Vector::zero(), Vector::from))
    };
    let [before, after] = [height(0), height(1)];
    if (before > 0.0) == (after > 0.0) || before == 0.0 {
        return false;
    }
    let share = before / (before - after);
    let between = |from: Vector, to: Vector| from + (to - from) * share;
    let centre = between(way[0], way[1]);
    let arms = [0, 1, 2].map(|corner| between(corners[0][corner], corners[1][corner]) - centre);
    let normal = (arms[1] - arms[0]).cross(arms[2] - arms[0]);
    let area = normal.dot(normal);
    [[0, 1], [1, 2], [2, 0]].iter().all(|[one, other]| arms[*one].cross(arms[*other]).dot(normal) >= -EDGE * area)
}

/// What a centre may be beside a triangle and goes through it all the same: no way leads between two of them.
const EDGE: f64 = 1e-6;

/// A mesh that changes its shape.
#[derive(Clone, Debug)]
pub struct Deforming {
    /// The mesh where its nodes stand now. Its tree is that of the last call of [`Deforming::sort`].
    mesh: Mesh,
    /// Where they stood at time 0 \[m\].
    first: Vec<Vector>,
    /// Their displacements \[m\].
    displacement: Vec<Row>,
    /// A triangle without area: its number in the files, from 1.
    collapsed: Option<usize>,
}

impl Deforming {
    /// A mesh as it is at time 0.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let first = mesh.topology.vertices.clone();
        // No edge stays flat.
        let mesh = Mesh { flat: Flat::nowhere(mesh.faces.len()), ..mesh.clone() };
        Self { displacement: vec![[0.0; 4]; first.len()], first, mesh, collapsed: None }
    }

    /// Takes the shape that it has with these displacements \[m\]. An error is the number of a triangle that has no area then,
    /// counted from 1 in the order of the files.
    pub fn follow(&mut self, displacement: &[Row]) -> Result<(), usize> {
        if self.displacement != displacement {
            self.displacement.clear();
            self.displacement.extend_from_slice(displacement);
            self.place();
        }
        self.collapsed.map_or(Ok(()), Err)
    }

    /// Puts vertices, triangles and edges where the nodes stand.
    fn place(&mut self) {
        let Mesh { topology, faces, edges, .. } = &mut self.mesh;
        for ((vertex, first), way) in topology.vertices.iter_mut().zip(&self.first).zip(&self.displacement) {
            *vertex = *first + Vector::from(*way);
        }
        let corners = topology.triangles.iter().map(|triangle| topology.corners(triangle));
        let mut numbered = corners.clone().zip(&topology.numbers);
        self.collapsed = numbered.find(|(corners, _)| topology.lacks_area(*corners)).map(|(_, number)| *number);
        faces.follow(corners);
        edges.clear();
        edges.extend(Edge::all(topology));
    }

    /// Sorts its triangles, so that those near a place are found.
    pub fn sort(&mut self) {
        self.mesh.tree = self.mesh.topology.tree();
    }

    /// The surface as it is now.
    pub fn surface(&self) -> &dyn Surface {
        &self.mesh
    }

    /// Its features as they are now.
    pub fn features(&self) -> &dyn Features {
        &self.mesh
    }

    /// Whether the straight way of a centre leads through the mesh \[m\], whose nodes came straight from these displacements meanwhile \[m\].
    pub fn is_passed(&self, way: [Vector; 2], before: &[Row]) -> bool {
        let came = |vertex: u32| self.first[vertex as usize] + Vector::from(before[vertex as usize]);
        self.mesh
            .topology
            .triangles
            .iter()
            .any(|triangle| leads_through(way, [triangle.map(came), self.mesh.topology.corners(triangle)]))
    }

    /// Adds what the nodes around a foot on a feature give to the motion there.
    pub fn grips(&self, feature: u32, foot: Vector, grips: &mut Vec<NodeWeights>) {
        let topology = &self.mesh.topology;
        let (vertices, edges) = (topology.vertices.len() as u32, topology.edges.len() as u32);
        if feature < vertices {
            self.at_vertex(feature, grips);
        } else if feature < vertices + edges {
            self.at_edge(feature - vertices, foot, grips);
        } else {
            self.on_face(feature - vertices - edges, foot, grips);
        }
    }

    /// Where a node stands \[m\].
    fn at(&self, node: u32) -> Vector {
        self.mesh.topology.vertices[node as usize]
    }

    /// How the nodes of a triangle turn it, `share` of it: by their motion along the normal about axes in its plane, by that in its plane
    /// about the normal.
    fn turn_face(&self, triangle: u32, share: f64, grips: &mut Vec<NodeWeights>) {
        let nodes = self.mesh.topology.triangles[triangle as usize];
        let [a, b, c] = nodes.map(|node| self.at(node));
        let (middle, normal) = ((a + b + c) * (1.0 / 3.0), self.mesh.faces.at(triangle).normal);
        let area = (b - a).cross(c - a).length();
        let arms = [a - middle, b - middle, c - middle];
        let squares: f64 = arms.iter().map(|arm| arm.dot(*arm)).sum();
        for ((node, opposite), arm) in nodes.into_iter().zip([c - b, a - c, b - a]).zip(arms) {
            grips.push(NodeWeights::turning(node, opposite * (share / area), normal));
            grips.push(NodeWeights::turning(node, normal * (share / squares), normal.cross(arm)));
        }
    }

    /// At a foot inside a triangle.
    fn on_face(&self, triangle: u32, foot: Vector, grips: &mut Vec<NodeWeights>) {
        let nodes = self.mesh.topology.triangles[triangle as usize];
        let [a, b, c] = nodes.map(|node| self.at(node));
        let normal = (b - a).cross(c - a);
        let square = normal.dot(normal);
        let opposite = |one: Vector, other: Vector| (one - foot).cross(other - foot).dot(normal) / square;
        let [first, second] = [opposite(b, c), opposite(c, a)];
        for (node, weight) in nodes.into_iter().zip([first, second, 1.0 - first - second]) {
            grips.push(NodeWeights { node, weight, turn: [Vector::zero(); 3] });
        }
        self.turn_face(triangle, 1.0, grips);
    }

    /// At a foot inside an edge.
    fn at_edge(&self, edge: u32, foot: Vector, grips: &mut Vec<NodeWeights>) {
        let topology = &self.mesh.topology;
        let ends = topology.edges[edge as usize];
        let [a, b] = ends.map(|node| self.at(node));
        let way = b - a;
        let square = way.dot(way);
        let (share, along) = ((foot - a).dot(way) / square, way * (1.0 / square.sqrt()));
        for (node, weight, sign) in [(ends[0], 1.0 - share, -1.0), (ends[1], share, 1.0)] {
            // t × v/L, row by row.
            let t = way * (sign / square);
            let turn = [Vector::new(0.0, -t.z, t.y), Vector::new(t.z, 0.0, -t.x), Vector::new(-t.y, t.x, 0.0)];
            grips.push(NodeWeights { node, weight, turn });
        }
        let triangles = &topology.at_edge[edge as usize];
        let from = grips.len();
        for &triangle in triangles {
            self.turn_face(triangle, 1.0 / triangles.len() as f64, grips);
        }
        for grip in &mut grips[from..] {
            // Of what the triangles turn, the part along the edge.
            let [x, y, z] = grip.turn;
            let by = x * along.x + y * along.y + z * along.z;
            *grip = NodeWeights::turning(grip.node, along, by);
        }
    }

    /// At a vertex.
    fn at_vertex(&self, vertex: u32, grips: &mut Vec<NodeWeights>) {
        grips.push(NodeWeights { node: vertex, weight: 1.0, turn: [Vector::zero(); 3] });
        let triangles = &self.mesh.topology.at_vertex[vertex as usize];
        let whole: f64 = triangles.iter().map(|triangle| self.mesh.angle(*triangle, vertex)).sum();
        for &triangle in triangles {
            self.turn_face(triangle, self.mesh.angle(triangle, vertex) / whole, grips);
        }
    }
}
