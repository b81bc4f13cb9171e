//! The cloud of the boundaries: their surfaces where they stand, and what the particles do to each facet.

use super::vtk::{Kind, PointCloud, Values};
use crate::base::geometry::Frame;
use crate::base::number::Vector;
use crate::engine::simulation::{BondRecord, ContactRecord};
use crate::engine::state::{BoundaryState, FacetTraces, Nodes, Particles};
use crate::laws::surface::{Deforming, Facets, Surface};
use crate::scene::{Boundary, Scene};

/// The surfaces of all boundaries where they stand, facet by facet, with what the particles do to each facet. A plane is shown as
/// far as the particles reach beside it.
pub(crate) fn boundaries(
    scene: &Scene,
    bodies: &Particles,
    (moved, nodes): (&[BoundaryState], &[Nodes]),
    (contacts, bonds): (&[ContactRecord], &[BondRecord]),
    traces: Option<&[FacetTraces]>,
) -> PointCloud {
    let mut shown = FacetRows::default();
    for (index, (boundary, moved)) in (0..).zip(scene.boundaries.iter().zip(moved)) {
        let frame = Frame::of(boundary.reference.into(), moved.shift().into(), moved.orientation.0);
        let beside: Vec<Vector> = corners_around(bodies).map(|corner| frame.inside(corner)).collect();
        let bent = nodes.iter().find(|nodes| nodes.boundary == index).and_then(|nodes| bent(boundary, nodes));
        let shape = bent.as_ref().map_or(&*boundary.shape, Deforming::surface);
        let facets = |shape: &dyn Surface| shape.facets(&beside).filter(|facets| !facets.is_empty());
        let Some([facets, first]) = facets(shape).zip(facets(&*boundary.shape)).map(<[Facets; 2]>::from) else {
            continue;
        };
        let mut bear = FacetLoads { force: vec![Vector::zero(); facets.len()], pressing: vec![0.0; facets.len()] };
        let at = |point: [f64; 3]| shape.facet_at(frame.inside(point.into()));
        for contact in contacts.iter().filter(|contact| contact.boundary == Some(index)) {
            let along = Vector::from(contact.normal) * contact.normal_force;
            bear.add(at(contact.point), along + contact.tangential_force.into(), contact.normal_force);
        }
        let law_at = |law: u32| scene.bonds.get(law as usize).and_then(|law| law.plane).map(|plane| plane.0);
        for bond in bonds.iter().filter(|bond| law_at(bond.law) == Some(index)) {
            bear.add(at(bond.other), bond.force.into(), bond.carried.normal);
        }
        shown.add(index, (&facets, &first), &frame, &bear);
        if let Some(left) = traces.and_then(|traces| traces.get(index as usize)) {
            shown.left.add(&first, left);
        }
    }
    shown.cloud(scene)
}

/// A mesh as its nodes stand.
fn bent(boundary: &Boundary, nodes: &Nodes) -> Option<Deforming> {
    let mut mesh = boundary.shape.deforming()?;
    // The run has stopped at a face without area.
    mesh.follow(&nodes.displacement).ok()?;
    mesh.sort();
    Some(mesh)
}

/// The corners of the box around all particles \[m\].
fn corners_around(bodies: &Particles) -> impl Iterator<Item = Vector> {
    let end = |axis: usize, side: f64| {
        let ends = bodies.position.iter().map(|row| side * (row[axis] + side * row[3]));
        side * ends.fold(f64::NEG_INFINITY, f64::max)
    };
    let ends: [[f64; 2]; 3] = [0, 1, 2].map(|axis| [end(axis, -1.0), end(axis, 1.0)]);
    let count = if bodies.position.is_empty() { 0 } else { 8 };
    (0..count).map(move |corner: usize| [0, 1, 2].map(|axis| ends[axis][corner >> axis & 1]).into())
}

/// What the particles do to the facets of a boundary.
struct FacetLoads {
    /// Force on each \[N\].
    force: Vec<Vector>,
    /// The sum of the normal forces of its contacts, which press from either side \[N\].
    pressing: Vec<f64>,
}

impl FacetLoads {
    /// Adds what a particle feels at a facet: the force on it, and how hard it is pressed away \[N\].
    fn add(&mut self, facet: usize, on_particle: Vector, pressing: f64) {
        if let (Some(force), Some(sum)) = (self.force.get_mut(facet), self.pressing.get_mut(facet)) {
            *force = *force - on_particle;
            *sum += pressing;
        }
    }
}

/// The facets of all boundaries so far.
#[derive(Default)]
struct FacetRows {
    /// Where their corners are, and how far each has gone \[m\].
    points: [Vec<f64>; 2],
    /// Their corners.
    corners: Vec<u32>,
    /// Behind the last corner of each.
    ends: Vec<u32>,
    /// The boundary of each.
    boundary: Vec<i64>,
    /// Force on each \[N\], and over its area \[Pa\].
    loads: [Vec<f64>; 2],
    /// Normal pressure on each \[Pa\].
    pressure: Vec<f64>,
    /// What contacts left on each, where the scene asks for it.
    left: LeftRows,
}

/// What contacts left on the facets of all boundaries so far.
#[derive(Default)]
struct LeftRows {
    /// Volume worn off each \[m³\].
    wear: Vec<f64>,
    /// How deep that is, over its area at time 0 \[m\].
    depth: Vec<f64>,
    /// Energy lost at each, along the normal and across it \[J\].
    lost: [Vec<f64>; 2],
}

impl LeftRows {
    /// Adds those of a boundary with these facets at time 0.
    fn add(&mut self, first: &Facets, left: &FacetTraces) {
        for facet in 0..first.len() {
            let of = |numbers: &[f64]| numbers.get(facet).copied().unwrap_or(0.0);
            self.wear.push(of(&left.wear));
            self.depth.push(of(&left.wear) / first.area(facet));
            self.lost[0].push(of(&left.normal));
            self.lost[1].push(of(&left.tangential));
        }
    }

    /// Fields of the facets: those that the scene asks for.
    fn fields(self, scene: &Scene) -> Vec<(&'static str, Values)> {
        let wears = scene.boundaries.iter().any(|boundary| !boundary.wear.is_empty());
        let [normal, tangential] = self.lost.map(Values::Scalars);
        let wear = [("wear", Values::Scalars(self.wear)), ("wear_depth", Values::Scalars(self.depth))];
        let lost = [("impact_energy_normal", normal), ("impact_energy_tangential", tangential)];
        let wear = wear.into_iter().filter(|_| wears);
        wear.chain(lost.into_iter().filter(|_| scene.output.impacts.is_some())).collect()
    }
}

impl FacetRows {
    /// Adds those of a boundary.
    fn add(&mut self, index: u32, (facets, first): (&Facets, &Facets), frame: &Frame, bear: &FacetLoads) {
        let (before, behind) = ((self.points[0].len() / 3) as u32, self.corners.len() as u32);
        for (point, first) in facets.points.iter().zip(&first.points) {
            let now = frame.outside(*point - frame.reference()) + frame.pivot();
            self.points[0].extend(now.to_array());
            self.points[1].extend((now - *first).to_array());
        }
        self.corners.extend(facets.corners.iter().map(|corner| before + corner));
        self.ends.extend(facets.ends.iter().map(|end| behind + end));
        for (facet, (force, pressing)) in bear.force.iter().zip(&bear.pressing).enumerate() {
            let per_area = 1.0 / facets.area(facet);
            self.boundary.push(i64::from(index));
            self.loads[0].extend(force.to_array());
            self.loads[1].extend((*force * per_area).to_array());
            self.pressure.push(pressing * per_area);
        }
    }

    /// All of them.
    fn cloud(self, scene: &Scene) -> PointCloud {
        let left = self.left.fields(scene);
        let ([points, gone], [force, traction]) = (self.points, self.loads);
        PointCloud {
            points,
            cell: Vec::new(),
            kind: Kind::Facets { corners: self.corners, ends: self.ends },
            fields: vec![("displacement", Values::Vectors(gone))],
            cell_fields: [
                ("boundary", Values::Integers(self.boundary)),
                ("force", Values::Vectors(force)),
                ("traction", Values::Vectors(traction)),
                ("normal_pressure", Values::Scalars(self.pressure)),
            ]
            .into_iter()
            .chain(left)
            .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simulation::Simulation;
    use crate::scene::Source;
    use std::collections::BTreeMap;
    use std::sync::Arc;

    /// Grains that a disc presses into a tube on a mesh of two triangles and a plane, one of them bonded to the plane.
    const SCENE: &str = r#"
gravity = [0.0, 0.0, -9.81]
[run]
step = 2e-6
end = 1.0
[output]
frame_interval = 1.0
boundaries = true
[material.glass]
youngs_modulus = 1e7
poissons_ratio = 0.3
density = 2500.0
[pair.glass.glass]
restitution = 0.5
friction = 0.4
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.grain]
material = "glass"
list = [
    { position = [2e-3, 1e-3, 0.99e-3], radius = 1e-3 },
    { position = [-1.5e-3, 1e-3, 0.99e-3], radius = 1e-3 },
    { position = [0.5e-3, 2.4e-3, 2.0e-3], radius = 1e-3 },
]
[boundary.ground]
plane = { point = [0.0, 0.0, -0.01e-3], normal = [0.0, 0.0, 1.0] }
material = "glass"
motion = { prescribed = { x = 0.05 } }
[boundary.sheet]
mesh = { file = "sheet.stl" }
material = "glass"
motion = { prescribed = { "rotation.z" = 3.0 } }
[boundary.tube]
cylinder = { from = [0.0, 0.0, -1e-3], to = [0.0, 0.0, 9e-3], radius = 3.43e-3 }
material = "glass"
[boundary.lid]
disc = { centre = [0.0, 0.0, 2.99e-3], normal = [0.0, 0.0, -1.0], radius = 3e-3 }
material = "glass"
motion = { prescribed = { z = -0.05 } }
[bond.glue]
formulation = "incremental"
between = ["grain", "ground"]
create_distance = 2.02e-3
normal_stiffness = 1e9
tangential_stiffness = 4e8
"#;

    /// A square in the plane z = 0 as two triangles: below the diagonal x = y, and above it.
    const SHEET: &str = "solid sheet\n\
        facet normal 0 0 1\n\
        outer loop\n\
        vertex -4e-3 -4e-3 0\n\
        vertex 4e-3 -4e-3 0\n\
        vertex 4e-3 4e-3 0\n\
        endloop\n\
        endfacet\n\
        facet normal 0 0 1\n\
        outer loop\n\
        vertex -4e-3 -4e-3 0\n\
        vertex 4e-3 4e-3 0\n\
        vertex -4e-3 4e-3 0\n\
        endloop\n\
        endfacet\n\
        endsolid sheet\n";

    /// A scene at time 0.
    fn begun(text: &str) -> Simulation {
        let files = BTreeMap::from([("sheet.stl".to_owned(), SHEET.as_bytes().to_vec())]);
        let source = Source { name: "scene.toml".into(), text: text.into(), files };
        let scene = Scene::from_source(&source).unwrap_or_else(|errors| panic!("{errors}"));
        Simulation::new(Arc::new(scene)).unwrap()
    }

    /// That scene after so many milliseconds.
    fn simulation(milliseconds: f64) -> Simulation {
        let mut simulation = begun(SCENE);
        simulation.advance(1e-3 * milliseconds).unwrap();
        simulation
    }

    /// The cloud of a simulation.
    fn cloud(simulation: &Simulation) -> PointCloud {
        let (state, contacts, bonds) = (simulation.state(), simulation.contacts(), simulation.bonds());
        let moved = (&state.boundaries[..], &state.nodes[..]);
        boundaries(simulation.scene(), &state.particles, moved, (&contacts, &bonds), None)
    }

    /// The numbers of a field of the facets.
    fn numbers(cloud: &PointCloud, name: &str) -> Vec<f64> {
        match cloud.cell_fields.iter().find(|(field, _)| *field == name) {
            Some((_, Values::Scalars(numbers) | Values::Vectors(numbers))) => numbers.clone(),
            Some((_, Values::Integers(numbers))) => numbers.iter().map(|number| *number as f64).collect(),
            _ => panic!("{name}"),
        }
    }

    #[test]
    fn forces_on_facets_add_up_to_the_force_on_the_boundary() {
        let simulation = simulation(0.2);
        let cloud = cloud(&simulation);
        let (boundary, force) = (numbers(&cloud, "boundary"), numbers(&cloud, "force"));
        assert_eq!(boundary.len(), 1 + 2 + 64 + 64);
        for (index, moved) in simulation.state().boundaries.iter().enumerate() {
            let of = (0..boundary.len()).filter(|&facet| boundary[facet] == index as f64);
            let sum = of.fold(Vector::zero(), |sum, facet| {
                sum + Vector::from([force[3 * facet], force[3 * facet + 1], force[3 * facet + 2]])
            });
            let expected = Vector::from(moved.force);
            assert!(expected.length() > 1e-6, "nothing at boundary {index}");
            let off = (sum - expected).length() / expected.length();
            assert!(off < 1e-9, "boundary {index}: {sum:?} and {expected:?}, {off:e}");
        }
    }

    #[test]
    fn each_triangle_bears_what_stands_on_it() {
        let simulation = simulation(0.02);
        let cloud = cloud(&simulation);
        let (pressure, force) = (numbers(&cloud, "normal_pressure"), numbers(&cloud, "force"));
        let on = |particle: u32| {
            let contacts =
                simulation.contacts().into_iter().filter(|it| it.first == particle && it.boundary == Some(1));
            contacts.map(|contact| contact.normal_force).sum::<f64>()
        };
        let area = 0.5 * 64e-6;
        // The first grain is below the diagonal, the second above it; facet 0 is the plane.
        for (facet, grain) in [(1, 0), (2, 1)] {
            let pressing = on(grain);
            assert!(pressing > 0.0 && (pressure[facet] * area / pressing - 1.0).abs() < 1e-12, "{facet}");
            assert!((force[3 * facet + 2] / pressing + 1.0).abs() < 1e-2, "{}", force[3 * facet + 2]);
        }
    }

    #[test]
    fn a_mesh_whose_nodes_move_is_shown_as_it_stands() {
        let driven = SCENE.replace("motion = { prescribed = { \"rotation.z\" = 3.0 } }", "nodes = \"driven\"");
        let mut simulation = begun(&driven);
        simulation.set_node(crate::base::quantity::BoundaryIndex(1), (2, 0), 1e-5);
        simulation.advance(2e-4).unwrap();
        let cloud = cloud(&simulation);
        let (_, Values::Vectors(gone)) = &cloud.fields[0] else { panic!("not vectors") };
        // Behind the four corners of the plane: the third node of the sheet.
        let expected = [12, 15, 18, 21].map(|first| (gone[first] * 1e5).round());
        assert_eq!(expected, [0.0, 0.0, 1.0, 0.0]);
        assert!((cloud.points[18] - 4.01e-3).abs() < 1e-15);
        let force = numbers(&cloud, "force");
        let sum = force[5] + force[8];
        let expected = simulation.state().boundaries[1].force[2];
        assert!(expected < 0.0 && (sum / expected - 1.0).abs() < 1e-9, "{sum} N, not {expected} N");
    }

    #[test]
    fn points_go_where_their_boundary_goes() {
        let simulation = simulation(0.2);
        let PointCloud { points, fields, .. } = cloud(&simulation);
        let (_, Values::Vectors(gone)) = &fields[0] else { panic!("not vectors") };
        // Behind the four corners of the plane comes the sheet; its corner turned by 3 rad/s about its middle.
        let (turn, corner) = (3.0 * 0.2e-3, [-4e-3, -4e-3]);
        let (sin, cos) = libm::sincos(turn);
        let expected = [cos * corner[0] - sin * corner[1], sin * corner[0] + cos * corner[1], 0.0];
        for axis in 0..3 {
            let [start, now] = [[corner[0], corner[1], 0.0][axis], points[12 + axis]];
            assert!((now - expected[axis]).abs() < 1e-15, "{now} and {}", expected[axis]);
            assert!((gone[12 + axis] - (now - start)).abs() < 1e-18);
        }
        let disc_z = points[points.len() - 1];
        assert!((disc_z - (2.99e-3 - 0.05 * 0.2e-3)).abs() < 1e-15, "{disc_z}");
    }
}
