//! Meshes whose nodes the outside moves: forces of the nodes are those of theory on faces, edges and vertices, add up to force and
//! moment of the surface, and do its work; the surface moves as its nodes do.
//!
//! Unless something else is said: radius 5 mm, E = 5 MPa and ν = 0.3 of both, restitution 0.5, friction 0.4, rolling friction 0.1.

use crate::support::scene_with;
use cograin::quantity::BoundaryIndex;
use cograin::scene::Scene;
use cograin::simulation::{RunError, Simulation};
use cograin::state::{Nodes, State};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Radius \[m\].
const RADIUS: f64 = 5e-3;

/// Overlap at the start \[m\].
const OVERLAP: f64 = 5e-5;

/// The sheet.
const SHEET: BoundaryIndex = BoundaryIndex(0);

/// Three numbers.
type Three = [f64; 3];

/// A triangle.
type Triangle = [Three; 3];

/// Nodes that the outside moves.
const DRIVEN: &str = "nodes = \"driven\"";

/// Triangles as an OBJ file, each with corners of its own, which are welded.
fn obj(triangles: &[Triangle]) -> Vec<u8> {
    let vertex = |[x, y, z]: &Three| format!("v {x:.17e} {y:.17e} {z:.17e}\n");
    let face = |number: usize| format!("f {} {} {}\n", 3 * number + 1, 3 * number + 2, 3 * number + 3);
    let corners: String = triangles.iter().flatten().map(vertex).collect();
    (corners + &(0..triangles.len()).map(face).collect::<String>()).into_bytes()
}

/// What a scene is made of.
struct Stage<'a> {
    /// Place, velocity and angular velocity of each sphere.
    spheres: Vec<[Three; 3]>,
    /// The sheet.
    mesh: Vec<Triangle>,
    /// How it moves.
    motion: &'a str,
    /// Restitution, friction and rolling friction.
    properties: Three,
    /// Sub-models beside Hertz's.
    law: &'a str,
    /// `[run]`.
    run: &'a str,
    /// Gravity \[m/s²\].
    gravity: Three,
}

/// Friction and rolling resistance.
const ROUGH: &str = "[contact.touch.tangential.history]\n[contact.touch.rolling.cdt]\n";

impl Default for Stage<'_> {
    fn default() -> Self {
        Self {
            spheres: Vec::new(),
            mesh: Vec::new(),
            motion: DRIVEN,
            properties: [0.5, 0.4, 0.1],
            law: ROUGH,
            run: "step = 1e-6\nthreads = 1",
            gravity: [0.0; 3],
        }
    }
}

impl Stage<'_> {
    /// The scene.
    fn scene(&self) -> Arc<Scene> {
        let each = |[at, velocity, spin]: &[Three; 3]| {
            format!(
                "{{ position = {at:?}, velocity = {velocity:?}, angular_velocity = {spin:?}, radius = {RADIUS:?} }}"
            )
        };
        let list: Vec<String> = self.spheres.iter().map(each).collect();
        let [restitution, friction, rolling] = self.properties;
        let text = format!(
            r#"
gravity = {gravity:?}
[run]
max_overlap = 0.5
{run}
[material.stone]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[pair.stone.stone]
restitution = {restitution:?}
friction = {friction:?}
rolling_friction = {rolling:?}
[contact.touch.normal.hertz]
{law}
[particles.all]
material = "stone"
list = [{list}]
[boundary.sheet]
material = "stone"
mesh = {{ file = "sheet.obj", sides = 2 }}
{motion}
"#,
            gravity = self.gravity,
            run = self.run,
            law = self.law,
            list = list.join(", "),
            motion = self.motion,
        );
        let files = BTreeMap::from([("sheet.obj".to_owned(), obj(&self.mesh))]);
        scene_with(&text, files)
    }

    /// The scene at time 0.
    fn start(&self) -> Simulation {
        Simulation::new(self.scene()).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// The nodes of the sheet.
fn nodes(simulation: &Simulation) -> &Nodes {
    &simulation.state().nodes[0]
}

/// Where its nodes stood at time 0 \[m\].
fn places(simulation: &Simulation) -> Vec<Three> {
    simulation.scene().boundaries[0].shape.vertices().iter().map(|place| place.to_array()).collect()
}

/// Moves every node to its place at time 0 plus this function of it.
fn drive(simulation: &mut Simulation, way: impl Fn(Three) -> Three) {
    for (node, place) in places(simulation).into_iter().enumerate() {
        for (axis, value) in way(place).into_iter().enumerate() {
            simulation.set_node(SHEET, (node, axis), value);
        }
    }
}

/// Advances, or fails with the message.
#[track_caller]
fn advance(simulation: &mut Simulation, interval: f64) {
    simulation.advance(interval).unwrap_or_else(|error| panic!("{error}"));
}

/// Sum of two vectors, the second this often.
fn sum(a: Three, b: Three, times: f64) -> Three {
    [0, 1, 2].map(|axis| a[axis] + times * b[axis])
}

/// A vector by a number.
fn by(a: Three, times: f64) -> Three {
    a.map(|part| part * times)
}

/// Vector product.
fn cross([a, b, c]: Three, [x, y, z]: Three) -> Three {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Scalar product.
fn dot(a: Three, b: Three) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

/// Length.
fn length(a: Three) -> f64 {
    dot(a, a).sqrt()
}

/// First three numbers of a row.
fn three(row: [f64; 4]) -> Three {
    [row[0], row[1], row[2]]
}

/// A number from −1 to 1.
fn random(rng: &mut ChaCha8Rng) -> f64 {
    2.0 * f64::from(rng.next_u32()) / f64::from(u32::MAX) - 1.0
}

/// A square about the origin of so many cells a side, heights at random up to this; corners inside shifted at random.
fn sheet(cells: usize, half: f64, height: f64, rng: &mut ChaCha8Rng) -> Vec<Triangle> {
    let cell = 2.0 * half / cells as f64;
    let mut points = Vec::new();
    for i in 0..=cells {
        for j in 0..=cells {
            let mut inside = |k: usize| {
                let shift = if k == 0 || k == cells { 0.0 } else { 0.2 * random(rng) };
                cell * (k as f64 + shift) - half
            };
            points.push([inside(i), inside(j), height * random(rng)]);
        }
    }
    let at = |i: usize, j: usize| points[i * (cells + 1) + j];
    let cut = |number: usize| {
        let (i, j) = (number / cells, number % cells);
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    (0..cells * cells).flat_map(cut).collect()
}

/// Spheres that slide and roll over a sheet with friction, at random places a little above its highest point.
fn over(count: usize, half: f64, height: f64, rng: &mut ChaCha8Rng) -> Vec<[Three; 3]> {
    let side = (count as f64).sqrt().ceil() as usize;
    let pitch = 2.0 * half / side as f64;
    let place = |k: usize| pitch * (k as f64 + 0.5) - half;
    (0..count)
        .map(|number| {
            let at = [place(number / side), place(number % side), RADIUS + height * random(rng)];
            let three = |scale: f64, rng: &mut ChaCha8Rng| [0, 1, 2].map(|_| scale * random(rng));
            [at, three(0.5, rng), three(60.0, rng)]
        })
        .collect()
}

/// Forces of the nodes at the start of one sphere that slides at (0.3, 0.2, 0) m/s over a mesh, its foot at this place, and the
/// force on it.
#[track_caller]
fn pressed(mesh: &[Triangle], foot: Three) -> (Vec<Three>, Three) {
    let at = sum(foot, [0.0, 0.0, RADIUS - OVERLAP], 1.0);
    let spheres = vec![[at, [0.3, 0.2, 0.0], [0.0; 3]]];
    let simulation =
        Stage { spheres, mesh: mesh.to_vec(), law: "[contact.touch.tangential.history]", ..Stage::default() }.start();
    let force = three(simulation.state().particles.force[0]);
    assert!(force[0] < 0.0 && force[1] < 0.0 && force[2] > 0.0, "{force:?}");
    (nodes(&simulation).force.iter().map(|row| three(*row)).collect(), force)
}

/// Fails unless forces are those expected, to a share of the largest.
#[track_caller]
fn assert_forces(found: &[Three], expected: &[Three]) {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().map(|force| length(*force)).fold(0.0, f64::max);
    for (node, (found, expected)) in found.iter().zip(expected).enumerate() {
        let apart = length(sum(*found, *expected, -1.0));
        assert!(apart <= 1e-12 * largest, "node {node}: {found:?} N, not {expected:?} N");
    }
}

#[test]
fn inside_a_face_forces_go_by_area_and_the_couple_by_normal_forces() {
    let (l, h) = (0.03, 0.5 * OVERLAP);
    let mesh = [[[0.0, 0.0, 0.0], [l, 0.0, 0.0], [0.0, l, 0.0]]];
    let (found, force) = pressed(&mesh, [0.4 * l, 0.3 * l, 0.0]);
    // The gradients of the weights are −(1, 1)/l, (1, 0)/l, (0, 1)/l.
    let [x, y, _] = force;
    let couples = [-(x + y) / l, x / l, y / l].map(|gradient| [0.0, 0.0, h * gradient]);
    let expected = [0, 1, 2].map(|node| by(sum(by(force, [0.3, 0.4, 0.3][node]), couples[node], 1.0), -1.0));
    assert_forces(&found, &expected);
}

#[test]
fn on_an_edge_its_ends_carry_the_couple_across_it_and_both_faces_that_along_it() {
    // A ridge along y; one face goes down by 10 mm over 24 mm, the other over 7.5 mm: 26 and 12.5 mm long.
    let l = 0.03;
    let (a, b) = ([0.0; 3], [0.0, l, 0.0]);
    let (left, right) = ([-0.0075, 0.5 * l, -0.01], [0.024, 0.5 * l, -0.01]);
    let (found, force) = pressed(&[[a, b, left], [a, right, b]], [0.0, 0.3 * l, 0.0]);
    // The couple on the surface is the arm (0, 0, −δ/2) times −F.
    let (across, along) = (-0.5 * OVERLAP * force[1], 0.5 * OVERLAP * force[0]);
    // Half of what is along the edge on each face: a force along its normal at the far corner, half of it back at the ends.
    let normals = [[-0.01 / 0.0125, 0.0, 0.0075 / 0.0125], [0.01 / 0.026, 0.0, 0.024 / 0.026]];
    let far = [by(normals[0], 0.5 * along / 0.0125), by(normals[1], -0.5 * along / 0.026)];
    let back = by(sum(far[0], far[1], 1.0), -0.5);
    let end = |share: f64, sign: f64| sum(sum(back, force, -share), [0.0, 0.0, sign * across / l], 1.0);
    assert_forces(&found, &[end(0.7, -1.0), end(0.3, 1.0), far[0], far[1]]);
}

#[test]
fn on_a_vertex_the_faces_around_it_carry_the_couple_by_their_angles() {
    // A pyramid with a rhombus as its base: two faces of one angle at the top, two of another one.
    let (w, v, s) = (0.02, 0.03, 0.01);
    let ring = [[w, 0.0, -s], [0.3 * v, v, -s], [-w, 0.0, -s], [0.3 * v, -v, -s]];
    let mesh: Vec<Triangle> = (0..4).map(|k| [[0.0; 3], ring[k], ring[(k + 1) % 4]]).collect();
    let (found, force) = pressed(&mesh, [0.0; 3]);
    let couple = [-0.5 * OVERLAP * force[1], 0.5 * OVERLAP * force[0], 0.0];
    let angle = |k: usize| {
        let (p, q) = (ring[k], ring[(k + 1) % 4]);
        (dot(p, q) / (length(p) * length(q))).acos()
    };
    let all: f64 = (0..4).map(angle).sum();
    let mut expected = [by(force, -1.0), [0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]];
    for k in 0..4 {
        let (p, q) = (ring[k], ring[(k + 1) % 4]);
        let normal = by(cross(p, q), 1.0 / length(cross(p, q)));
        let couple = by(couple, angle(k) / all);
        let middle = by(sum(p, q, 1.0), 1.0 / 3.0);
        let corners = [(0, [0.0; 3], sum(q, p, -1.0)), (1 + k, p, by(q, -1.0)), (1 + (k + 1) % 4, q, p)];
        let inertia: f64 = corners.iter().map(|(_, at, _)| length(sum(*at, middle, -1.0)).powi(2)).sum();
        for (node, at, opposite) in corners {
            let pressed = dot(couple, opposite) / length(cross(p, q));
            let drilled = by(cross(normal, sum(at, middle, -1.0)), dot(couple, normal) / inertia);
            expected[node] = sum(sum(expected[node], normal, pressed), drilled, 1.0);
        }
    }
    assert_forces(&found, &expected);
}

/// A sheet and spheres at random.
fn rough_stage(seed: u64) -> Stage<'static> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mesh = sheet(8, 0.03, 6e-4, &mut rng);
    let mut spheres = over(16, 0.024, 1e-4, &mut rng);
    spheres.iter_mut().for_each(|[at, ..]| at[2] += 5e-4);
    Stage { spheres, mesh, gravity: [0.0, 0.0, -100.0], ..Stage::default() }
}

/// New targets of all nodes, up to this far from where they stood at time 0 \[m\].
fn shake(simulation: &mut Simulation, way: f64, rng: &mut ChaCha8Rng) {
    for node in 0..nodes(simulation).target.len() {
        for axis in 0..3 {
            simulation.set_node(SHEET, (node, axis), way * random(rng));
        }
    }
}

#[test]
fn node_forces_add_up_to_force_and_moment_while_spheres_cross_edges_and_vertices() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut simulation = rough_stage(3).start();
    let (mut features, mut touched) = (std::collections::BTreeSet::new(), 0);
    for _ in 0..240 {
        shake(&mut simulation, 2e-4, &mut rng);
        for _ in 0..5 {
            advance(&mut simulation, 1e-4);
            let (state, nodes) = (simulation.state(), nodes(&simulation));
            let pivot = state.boundaries[0].pivot;
            let (mut force, mut moment, mut turnover) = ([0.0; 3], [0.0; 3], [0.0; 2]);
            for ((place, way), load) in places(&simulation).into_iter().zip(&nodes.displacement).zip(&nodes.force) {
                let (arm, load) = (sum(sum(place, three(*way), 1.0), pivot, -1.0), three(*load));
                force = sum(force, load, 1.0);
                moment = sum(moment, cross(arm, load), 1.0);
                turnover = [turnover[0] + length(load), turnover[1] + length(arm) * length(load)];
            }
            let boundary = &state.boundaries[0];
            let apart = [sum(force, boundary.force, -1.0), sum(moment, boundary.moment, -1.0)].map(length);
            assert!(apart[0] <= 1e-12 * turnover[0], "{} N of {}", apart[0], turnover[0]);
            assert!(apart[1] <= 1e-12 * turnover[1], "{} N m of {}", apart[1], turnover[1]);
            features.extend(state.walls[0].feature.iter().copied());
            touched += state.walls[0].feature.len();
        }
    }
    let [vertices, edges] = [81, 81 + 208];
    let crossed = |range: std::ops::Range<u32>| features.range(range).count();
    let [at_vertices, at_edges, at_faces] = [crossed(0..vertices), crossed(vertices..edges), crossed(edges..u32::MAX)];
    assert!(at_vertices > 0 && at_edges > 10 && at_faces > 20 && touched > 500, "{at_vertices} {at_edges} {at_faces}");
}

#[test]
fn work_is_that_of_the_nodes_whatever_the_spheres_do() {
    for input in ["", "input = \"ramp\""] {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let motion = format!("{DRIVEN}\n{input}");
        let mut simulation = Stage { motion: &motion, ..rough_stage(5) }.start();
        let mut turnover = 0.0;
        for _ in 0..40 {
            shake(&mut simulation, 3e-4, &mut rng);
            let (before, work) = (nodes(&simulation).displacement.clone(), simulation.state().boundaries[0].work);
            advance(&mut simulation, 2.5e-4);
            let nodes = nodes(&simulation);
            let mut done = 0.0;
            for ((now, then), force) in nodes.displacement.iter().zip(&before).zip(&nodes.mean_force) {
                let part = dot(three(*force), sum(three(*now), three(*then), -1.0));
                (done, turnover) = (done - part, turnover + part.abs());
            }
            let apart = (simulation.state().boundaries[0].work - work - done).abs();
            assert!(apart <= 1e-12 * turnover, "{apart} J of {turnover} J");
        }
        assert!(turnover > 1e-6, "{turnover} J");
    }
}

#[test]
fn the_energy_of_elastic_spheres_changes_by_the_work_of_the_nodes_with_the_second_power_of_the_step() {
    let error = |step: f64| {
        let run = format!("step = {step:?}\nthreads = 1");
        let stage = Stage {
            law: "",
            properties: [1.0, 0.0, 0.0],
            run: &run,
            motion: "nodes = \"driven\"\ninput = \"smooth\"",
            ..rough_stage(9)
        };
        let mut simulation = Stage { gravity: [0.0; 3], ..stage }.start();
        let energy = |it: &Simulation| it.kinetic_energy() + it.elastic_energy();
        let (begun, mut most) = (energy(&simulation), 0.0_f64);
        for number in 0..10 {
            let lift = 2e-4 * f64::from(number + 1);
            drive(&mut simulation, |[x, y, _]| [0.05 * lift, -0.02 * lift, lift * (1.0 + 20.0 * x - 10.0 * y)]);
            advance(&mut simulation, 8e-4);
            let gained = energy(&simulation) - begun;
            most = most.max((gained - simulation.state().boundaries[0].work).abs() / begun);
        }
        most
    };
    let errors = [8e-6, 4e-6, 2e-6].map(error);
    assert!(errors[0] < 2e-3 && errors[2] < 0.1 * errors[0], "{errors:?}");
}

#[test]
fn a_membrane_that_is_stretched_presses_as_before_and_carries_the_load() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mesh = sheet(8, 0.03, 0.0, &mut rng);
    let spheres = vec![[[1e-4, -2e-4, RADIUS - OVERLAP], [0.0; 3], [0.0; 3]]];
    let boundary = "[boundary.hand]\nparticles = { set = \"all\" }\n";
    let motion = format!("{DRIVEN}\n{boundary}");
    let stage = Stage { spheres, mesh, law: "", motion: &motion, properties: [1.0, 0.0, 0.0], ..Stage::default() };
    let mut simulation = stage.start();
    let modulus = 5.0e6 / (1.0 - 0.3 * 0.3) / 2.0;
    let hertz = 4.0 / 3.0 * modulus * (RADIUS * OVERLAP.powi(3)).sqrt();
    for number in 0..=20 {
        drive(&mut simulation, |[x, y, _]| [0.01 * f64::from(number) * x, 0.01 * f64::from(number) * y, 0.0]);
        advance(&mut simulation, 1e-4);
        let all = nodes(&simulation).force.iter().fold([0.0; 3], |all, row| sum(all, three(*row), 1.0));
        assert!(length(sum(all, [0.0, 0.0, -hertz], -1.0)) < 1e-11 * hertz, "{all:?} N, not {hertz} N down");
        // The sphere's force goes to the nodes around it alone, whose moment about its foot is zero.
        let loaded = nodes(&simulation).force.iter().filter(|row| row[2] != 0.0).count();
        assert!((1..=4).contains(&loaded), "{loaded} nodes");
    }
    assert!(simulation.state().boundaries[0].work.abs() < 1e-18, "no work along the surface");
}

#[test]
fn a_rigid_motion_of_the_nodes_is_felt_as_that_of_a_rigid_mesh() {
    // One step with so small a turn that chords are arcs: at faces, edges and vertices, with friction and rolling resistance.
    let axes = ["x", "y", "z", "rotation.x", "rotation.y", "rotation.z"];
    let inputs = [2e-9, -1e-9, 3e-9, 4e-7, -7e-7, 5e-7];
    let driven = format!("{DRIVEN}\nreference = [0.0, 0.0, 0.0]");
    let rigid = format!("motion = {{ driven = {axes:?} }}\nreference = [0.0, 0.0, 0.0]");
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let mesh = sheet(6, 0.03, 2e-3, &mut rng);
    let mut corners: Vec<Three> =
        mesh.iter().flatten().copied().filter(|p| p[0].abs() < 0.029 && p[1].abs() < 0.029).collect();
    corners.dedup();
    let mut seen = [0; 3];
    for corner in corners {
        for shift in [[0.0, 0.0], [1e-3, 0.0], [0.0, 2e-3], [2e-3, 1e-3]] {
            let at = [corner[0] + shift[0], corner[1] + shift[1], corner[2] + RADIUS - 2.0 * OVERLAP];
            let spheres = vec![[at, [0.0; 3], [0.0; 3]]];
            let stage = |motion| Stage { spheres: spheres.clone(), mesh: mesh.clone(), motion, ..Stage::default() };
            let [mut bent, mut stiff] = [stage(&driven).start(), stage(&rigid).start()];
            if bent.state().walls[0].feature.is_empty() {
                continue;
            }
            let [x, y, z, a, b, c] = inputs;
            drive(&mut bent, |place| sum([x, y, z], cross([a, b, c], place), 1.0));
            (0..6).for_each(|axis| stiff.set_input(SHEET, axis, inputs[axis]));
            for simulation in [&mut bent, &mut stiff] {
                advance(simulation, 1e-6);
            }
            let [one, other] = [&bent, &stiff].map(|it| {
                let (particles, boundary) = (&it.state().particles, &it.state().boundaries[0]);
                [
                    three(particles.force[0]),
                    by(three(particles.torque[0]), 200.0),
                    boundary.force,
                    by(boundary.moment, 200.0),
                ]
            });
            for (one, other) in one.into_iter().zip(other) {
                let scale = length(stiff.state().boundaries[0].force);
                assert!(length(sum(one, other, -1.0)) < 3e-6 * scale, "{one:?}, not {other:?} at {at:?}");
            }
            for feature in &bent.state().walls[0].feature {
                seen[usize::from(*feature >= 49) + usize::from(*feature >= 49 + 120)] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 3), "{seen:?}");
}

#[test]
fn nodes_that_all_move_alike_hit_spheres_as_a_driven_mesh_does() {
    // 12 mm up to spheres that were far above: lists are made in time, and the course of the input is the same.
    for input in ["ramp", "smooth"] {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mesh = sheet(6, 0.03, 5e-4, &mut rng);
        let spheres: Vec<[Three; 3]> = over(9, 0.02, 1e-4, &mut rng)
            .into_iter()
            .map(|[at, v, w]| [sum(at, [0.0, 0.0, 8e-3], 1.0), v, w])
            .collect();
        let one = format!("{DRIVEN}\ninput = \"{input}\"");
        let other = format!("motion = {{ driven = [\"x\", \"z\"] }}\ninput = \"{input}\"");
        let course = |motion: &str| {
            let mut simulation =
                Stage { spheres: spheres.clone(), mesh: mesh.clone(), motion, ..Stage::default() }.start();
            for number in 1..=4 {
                let (x, z) = (5e-4 * f64::from(number), 3e-3 * f64::from(number));
                if simulation.state().nodes.is_empty() {
                    simulation.set_input(SHEET, 0, x);
                    simulation.set_input(SHEET, 2, z);
                } else {
                    drive(&mut simulation, |_| [x, 0.0, z]);
                }
                advance(&mut simulation, 1e-3);
            }
            let particles = &simulation.state().particles;
            particles.slot.iter().map(|slot| three(particles.velocity[*slot as usize])).collect::<Vec<_>>()
        };
        let [one, other] = [&one, &other].map(|motion| course(motion));
        for (one, other) in one.iter().zip(&other) {
            assert!(length(sum(*one, *other, -1.0)) < 1e-8, "{one:?}, not {other:?} m/s");
        }
        assert!(one.iter().any(|velocity| velocity[2] > 1.0), "{one:?}");
    }
}

#[test]
fn nodes_at_rest_give_the_very_forces_of_a_rigid_mesh() {
    let course = |motion| {
        let mut simulation = Stage { motion, ..rough_stage(8) }.start();
        advance(&mut simulation, 1e-2);
        let State { particles, boundaries, .. } = simulation.state().clone();
        (particles, boundaries)
    };
    assert_eq!(course(DRIVEN), course(""));
}

#[test]
fn threads_and_saved_states_change_no_bit() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let (mesh, spheres) = (sheet(30, 0.35, 5e-4, &mut rng), over(2500, 0.34, 1e-4, &mut rng));
    let start = |threads: usize| {
        let run = format!("step = 1e-6\nthreads = {threads}");
        Stage {
            spheres: spheres.clone(),
            mesh: mesh.clone(),
            run: &run,
            gravity: [0.0, 0.0, -100.0],
            ..Stage::default()
        }
        .start()
    };
    let go_on = |simulation: &mut Simulation, from: u64| {
        for number in from..6 {
            shake(simulation, 1e-4, &mut ChaCha8Rng::seed_from_u64(number));
            advance(simulation, 2e-5);
        }
        simulation.state().to_bytes(0)
    };
    let mut first = start(1);
    let saved = {
        for number in 0..3 {
            shake(&mut first, 1e-4, &mut ChaCha8Rng::seed_from_u64(number));
            advance(&mut first, 2e-5);
        }
        first.state().to_bytes(0)
    };
    let expected = go_on(&mut first, 3);
    assert!(first.state().walls[0].particle.len() > 500);
    for threads in [2, 3] {
        assert!(go_on(&mut start(threads), 0) == expected, "{threads} threads");
    }
    let state = State::from_bytes(&saved, 0).unwrap_or_else(|error| panic!("{error}"));
    let mut resumed = Simulation::resume(Arc::clone(first.scene()), state).unwrap_or_else(|fault| panic!("{fault}"));
    assert!(go_on(&mut resumed, 3) == expected, "resumed");
}

#[test]
fn a_face_without_area_stops_the_run_in_words_and_the_way_back_leads_to_the_beginning() {
    let mut simulation = rough_stage(6).start();
    drive(&mut simulation, |[x, y, _]| [1e-3 * x, 0.0, 1e-3 * y]);
    simulation.advance_or_roll_back(1e-5).unwrap_or_else(|error| panic!("{error}"));
    let before = simulation.state().clone();
    drive(&mut simulation, |[x, _, z]| [-x, 0.0, -z]);
    let error = simulation.advance_or_roll_back(1e-5).expect_err("a sheet on a line");
    assert!(matches!(&error, RunError::Collapsed { boundary, face: 1, .. } if boundary == "sheet"), "{error}");
    let said = error.to_string();
    assert!(said.contains(" without one at t = 0.0000") && said.contains("moved onto a line or a point"), "{said}");
    drive(&mut simulation, |[x, y, _]| [1e-3 * x, 0.0, 1e-3 * y]);
    assert!(*simulation.state() == before, "the state of the beginning");
    advance(&mut simulation, 1e-5);
    drive(&mut simulation, |_| [1e300; 3]);
    assert!(simulation.advance(1e-5).is_err(), "nodes out of all bounds");
}

#[test]
fn nodes_start_where_their_inputs_say_without_motion() {
    let mut simulation = rough_stage(10).start();
    drive(&mut simulation, |[x, y, _]| [0.0, 0.0, 0.01 * (x + y)]);
    simulation.place(None).unwrap_or_else(|error| panic!("{error}"));
    let nodes = nodes(&simulation);
    assert_eq!(nodes.displacement, nodes.target);
    assert!(nodes.velocity.iter().flatten().all(|part| *part == 0.0));
    assert_eq!(nodes.mean_force, nodes.force);
    assert!(nodes.target.iter().any(|row| row[2] > 1e-4));
    assert_eq!(simulation.state().boundaries[0].work, 0.0);
}
