//! Forces of nodes: their shares, their sums, and those of rigid meshes.

use super::scenes::{
    DRIVEN, OVERLAP, RADIUS, SHEET, Stage, Three, advance, by, cross, dot, drive, length, nodes, over, places, pressed,
    rough_stage, shake, sheet, sum, three,
};
use crate::support::Triangle;
use cograin::state::State;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

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
