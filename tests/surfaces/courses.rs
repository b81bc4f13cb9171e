//! Courses of spheres over surfaces of features: facets are felt with the order of theory, energy is kept over bends, and neither
//! the triangulation nor the axes of the scene matter.
//!
//! Unless something else is said: radius 5 mm, density 2500 kg/m³, E = 5 MPa and ν = 0.3 of both.

use crate::support::start_with;
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Radius of the spheres \[m\].
const RADIUS: f64 = 5e-3;

/// Their mass \[kg\].
const MASS: f64 = 2500.0 * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;

/// Radius of the drums \[m\].
const DRUM: f64 = 0.05;

/// Gravity \[m/s²\].
const G: f64 = 9.81;

/// A triangle.
type Triangle = [[f64; 3]; 3];

/// Restitution, friction, rolling friction and the law that needs them.
type Law = ([f64; 3], &'static str);

/// No friction, no loss.
const SMOOTH: Law = ([1.0, 0.0, 0.0], "");

/// Friction with a spring, and loss.
const ROUGH: Law = ([0.5, 0.5, 0.0], "[contact.touch.tangential.history]\n");

/// Triangles as an OBJ file, each with corners of its own, which are welded.
fn obj(triangles: &[Triangle]) -> Vec<u8> {
    let vertex = |[x, y, z]: &[f64; 3]| format!("v {x:.17e} {y:.17e} {z:.17e}\n");
    let face = |number: usize| format!("f {} {} {}\n", 3 * number + 1, 3 * number + 2, 3 * number + 3);
    let corners: String = triangles.iter().flatten().map(vertex).collect();
    (corners + &(0..triangles.len()).map(face).collect::<String>()).into_bytes()
}

/// Spheres, each with place and velocity, before the boundary `wall` of this shape.
fn start(
    spheres: &[[[f64; 3]; 2]],
    (properties, tangential): Law,
    gravity: [f64; 3],
    step: f64,
    wall: &str,
    mesh: &[Triangle],
) -> Simulation {
    let [restitution, friction, rolling] = properties;
    let each = |[at, velocity]: &[[f64; 3]; 2]| {
        format!("{{ position = {at:?}, velocity = {velocity:?}, radius = {RADIUS:?} }}")
    };
    let list: Vec<String> = spheres.iter().map(each).collect();
    let text = format!(
        r#"
gravity = {gravity:?}
[run]
step = {step:?}
threads = 1
[material.stone]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.3
[pair.stone.stone]
restitution = {restitution:?}
friction = {friction:?}
rolling_friction = {rolling:?}
[contact.touch.normal.hertz]
{tangential}
[particles.all]
material = "stone"
list = [{}]
[boundary.wall]
material = "stone"
{wall}
"#,
        list.join(", ")
    );
    let files = BTreeMap::from([("wall.obj".to_owned(), obj(mesh))]);
    start_with(&text, files)
}

/// A boundary of that mesh.
const MESH: &str = "mesh = { file = \"wall.obj\", sides = 2 }\n";

/// The exact drum.
const CYLINDER: &str =
    "cylinder = { from = [0.0, -0.02, 0.0], to = [0.0, 0.02, 0.0], radius = 0.05, infinite = true }\n";

/// The drum as this many facets, of which in- and circumscribed radius have its radius as their mean; a facet begins at this share
/// of its angle from the bottom.
fn drum(count: u32, phase: f64) -> Vec<Triangle> {
    let angle = TAU / f64::from(count);
    let radius = DRUM * 2.0 / (1.0 + (0.5 * angle).cos());
    let at = |number: u32, y: f64| {
        let (sine, cosine) = (angle * (f64::from(number % count) + phase)).sin_cos();
        [radius * sine, y, -radius * cosine]
    };
    let facet = |number: u32| {
        let (a, b) = (at(number, -0.02), at(number + 1, -0.02));
        let (c, d) = (at(number + 1, 0.02), at(number, 0.02));
        [[a, b, c], [a, c, d]]
    };
    (0..count).flat_map(facet).collect()
}

/// A sphere at rest in the drum, so many degrees from the bottom, pressed in as by its weight.
fn released(degrees: f64) -> [[f64; 3]; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let modulus = 5.0e6 / (1.0 - 0.3 * 0.3) / 2.0;
    let overlap = (MASS * G * cosine / (4.0 / 3.0 * modulus * RADIUS.sqrt())).powf(2.0 / 3.0);
    let out = DRUM - RADIUS + overlap;
    [[out * sine, 0.0, -out * cosine], [0.0; 3]]
}

/// What is compared of a course: place over R, spin · R, torque of friction.
type Seen = [[f64; 3]; 3];

/// The course of a sphere in a drum, every 20th step over 0.3 s.
fn course(degrees: f64, law: Law, wall: &str, mesh: &[Triangle]) -> Vec<Seen> {
    let mut simulation = start(&[released(degrees)], law, [0.0, 0.0, -G], 1e-5, wall, mesh);
    let look = |_| {
        simulation.advance(20.0 * 1e-5).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        let three = |row: [f64; 4], scale: f64| [0, 1, 2].map(|axis| row[axis] * scale);
        let [place, spin] = [particles.position[0], particles.angular_velocity[0]];
        [three(place, 1.0 / RADIUS), three(spin, RADIUS), three(particles.torque[0], 1.0)]
    };
    (0..1500).map(look).collect()
}

/// Largest difference of two courses, of each thing seen.
fn apart(one: &[Seen], other: &[Seen]) -> [f64; 3] {
    let length = |a: [f64; 3], b: [f64; 3]| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    [0, 1, 2].map(|part| one.iter().zip(other).map(|(a, b)| length(a[part], b[part])).fold(0.0, f64::max))
}

/// Largest difference from the exact drum with so many facets, over four phases.
fn facets(degrees: f64, law: Law, exact: &[Seen], count: u32) -> [f64; 3] {
    let phase = |quarter: u32| apart(&course(degrees, law, MESH, &drum(count, 0.25 * f64::from(quarter))), exact);
    (0..4).map(phase).fold([0.0; 3], |most, found| [0, 1, 2].map(|part| most[part].max(found[part])))
}

#[test]
fn a_sphere_in_a_drum_of_facets_goes_the_way_of_the_cylinder() {
    // mesh-contact, row d: worst of 4 phases 0.19, 0.056, 0.020, 0.0065 of the radius.
    let exact = course(40.0, SMOOTH, CYLINDER, &[]);
    let errors = [64, 512].map(|count| facets(40.0, SMOOTH, &exact, count)[0]);
    let order = (errors[0] / errors[1]).log2() / 3.0;
    assert!(order >= 1.4, "order {order} of {errors:?}");
    assert!(errors[1] <= 0.01, "{} R at 512 facets", errors[1]);
}

#[test]
fn a_sphere_that_rolls_over_bends_keeps_spring_and_spin() {
    let exact = course(20.0, ROUGH, CYLINDER, &[]);
    let most = |part: usize| {
        exact.iter().map(|seen| seen[part].iter().map(|it| it * it).sum::<f64>().sqrt()).fold(0.0, f64::max)
    };
    let [place, spin, torque] = facets(20.0, ROUGH, &exact, 512);
    assert!(place <= 0.01, "{place} R");
    assert!(spin <= 0.01 * most(1), "spin: {} of its largest", spin / most(1));
    // A spring that is forgotten at a bend loses the whole torque there.
    assert!(torque <= 0.05 * most(2), "torque: {} of its largest", torque / most(2));
}

#[test]
fn rolling_resistance_holds_a_sphere_on_the_slope_of_a_turning_drum() {
    // Slip is 0 and the moments about the contact balance: tan θ = µ_r R/(R − δ/2), spin Ω (C + δ/2)/(R − δ/2).
    let law = ([0.3, 0.5, 0.1], "[contact.touch.tangential.history]\n[contact.touch.rolling.cdt]\n");
    let wall =
        format!("{MESH}reference = [0.0, 0.0, 0.0]\nmotion = {{ prescribed = {{ \"rotation.y\" = {PI:?} }} }}\n");
    let mut simulation = start(&[released(-5.7)], law, [0.0, 0.0, -G], 2e-5, &wall, &drum(180, 0.0));
    simulation.advance(0.3).unwrap_or_else(|error| panic!("{error}"));
    // It swings a little about that slope, and the resistance, which has always the same direction, does not damp it: means over four periods.
    let period = TAU * (1.4 * (DRUM - RADIUS) / G).sqrt();
    let count = (4.0 * period / 4e-4).round() as u32;
    let (mut slope, mut spin) = (0.0, 0.0);
    for _ in 0..count {
        simulation.advance(4e-4).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        let [x, _, z, _] = particles.position[0];
        slope += x / z / f64::from(count);
        spin += particles.angular_velocity[0][1] / f64::from(count);
    }
    let overlap = 13.5e-6;
    let expected = 0.1 * RADIUS / (RADIUS - 0.5 * overlap);
    assert!((slope / expected - 1.0).abs() < 0.02, "tan θ = {slope}, not {expected}");
    let expected = PI * (DRUM + 0.5 * overlap) / (RADIUS - 0.5 * overlap);
    assert!((spin / expected - 1.0).abs() < 0.002, "{spin} rad/s, not {expected} rad/s");
}

/// Largest deviation of the energy over its first value, and largest change of the force from one step to the next over the weight.
fn energy_and_force(simulation: &mut Simulation, gravity: f64, step: f64, duration: f64) -> [f64; 2] {
    let (mut first, mut before, mut worst) = (None, None, [0.0_f64; 2]);
    for _ in 0..(duration / step).round() as usize {
        simulation.advance(step).unwrap_or_else(|error| panic!("{error}"));
        let particles = &simulation.state().particles;
        let height = particles.position[0][2];
        let kinetic = simulation.kinetic_energy();
        let energy = kinetic + simulation.elastic_energy() + MASS * gravity * height;
        let (start, scale) = *first.get_or_insert((energy, kinetic));
        worst[0] = worst[0].max((energy - start).abs() / scale);
        let force = particles.force[0];
        let earlier: [f64; 4] = before.replace(force).unwrap_or(force);
        let change = (0..3).map(|axis| (force[axis] - earlier[axis]).powi(2)).sum::<f64>().sqrt();
        worst[1] = worst[1].max(change / (MASS * gravity));
    }
    worst
}

#[test]
fn drops_on_a_vertex_an_edge_and_a_needle_keep_their_energy_to_the_second_order() {
    let top = [0.0, 0.0, 0.0];
    let base = [[0.01, 0.0, -0.01], [-0.006, 0.008, -0.01], [-0.006, -0.008, -0.01]];
    let vertex: Vec<Triangle> = (0..3).map(|side| [top, base[side], base[(side + 1) % 3]]).collect();
    let at = |x: f64, y: f64| [x, y, -x.abs()];
    let side = |x: f64| [[at(0.0, -0.02), at(x, -0.02), at(x, 0.02)], [at(0.0, -0.02), at(x, 0.02), at(0.0, 0.02)]];
    let edge = [side(0.02), side(-0.02)].concat();
    let needle = vec![[[-0.03, -3e-4, 0.0], [0.03, 0.0, 0.0], [-0.03, 3e-4, 0.0]]];
    for (name, mesh, x) in [("vertex", vertex, 4e-4), ("edge", edge, 1e-3), ("needle", needle, 0.0297)] {
        let error = |step: f64| {
            let sphere = [[x, 2e-4, RADIUS + 1e-4], [0.0, 0.0, -0.2]];
            let mut simulation = start(&[sphere], SMOOTH, [0.0, 0.0, -G], step, MESH, &mesh);
            energy_and_force(&mut simulation, G, step, 4e-3)[0]
        };
        let errors = [4e-6, 2e-6].map(error);
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "{name}: order {order} of {errors:?}");
    }
}

/// A number from −½ to ½.
fn random(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / f64::from(u32::MAX) - 0.5
}

/// A square of 60 mm about the origin of 625 points that are shifted at random, also up and down by as much as this \[m\].
fn bumps(height: f64) -> Vec<Triangle> {
    const CELLS: usize = 24;
    let mut rng = ChaCha8Rng::seed_from_u64(29);
    let mut point = |number: usize| {
        let (i, j) = (number / (CELLS + 1), number % (CELLS + 1));
        // Less than a quarter of a cell: no triangle folds over its neighbour.
        let mut place = |k: usize| {
            let inside = if k == 0 || k == CELLS { 0.0 } else { 0.4 };
            0.06 * ((k as f64 + inside * random(&mut rng)) / CELLS as f64 - 0.5)
        };
        let [x, y] = [place(i), place(j)];
        [x, y, height * (random(&mut rng) - 0.5)]
    };
    let points: Vec<[f64; 3]> = (0..(CELLS + 1) * (CELLS + 1)).map(&mut point).collect();
    let at = |i: usize, j: usize| points[i * (CELLS + 1) + j];
    let cell = |number: usize| {
        let (i, j) = (number / CELLS, number % CELLS);
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    (0..CELLS * CELLS).flat_map(cell).collect()
}

#[test]
fn over_bumps_energy_and_force_follow_the_time_step() {
    // mesh-contact, row l: a contact that comes or goes would give steps of 3 to 6 times the weight at any Δt.
    for height in [1e-5, 2e-4] {
        let mesh = bumps(height);
        let errors = [1e-5, 5e-6].map(|step| {
            let sphere = [[-0.027, 0.004, RADIUS + 0.2 * height], [0.54, 0.0, 0.0]];
            let mut simulation = start(&[sphere], SMOOTH, [0.0, 0.0, -100.0], step, MESH, &mesh);
            energy_and_force(&mut simulation, 100.0, step, 0.1)
        });
        let [energy, force] = [0, 1].map(|part| (errors[0][part] / errors[1][part]).log2());
        assert!(energy >= 1.3, "{height} m: energy of order {energy}, {errors:?}");
        assert!((force - 1.0).abs() < 0.1, "{height} m: force steps of order {force}, {errors:?}");
    }
}

/// A vector turned about (1, 2, 2)/3 by 0.7 rad.
fn turned(v: [f64; 3]) -> [f64; 3] {
    let (sine, cosine) = 0.7_f64.sin_cos();
    let n = [1.0, 2.0, 2.0].map(|part| part / 3.0);
    let along = (0..3).map(|axis| n[axis] * v[axis]).sum::<f64>() * (1.0 - cosine);
    let cross = [n[1] * v[2] - n[2] * v[1], n[2] * v[0] - n[0] * v[2], n[0] * v[1] - n[1] * v[0]];
    [0, 1, 2].map(|axis| v[axis] * cosine + cross[axis] * sine + n[axis] * along)
}

/// Places and velocities of spheres that fall on bumps and touch each other, after 3 ms.
fn tossed(law: Law, mesh: &[Triangle], turn: fn([f64; 3]) -> [f64; 3]) -> Vec<[[f64; 3]; 2]> {
    let sphere = |number: u32| {
        let [i, j] = [number % 4, number / 4].map(f64::from);
        [turn([0.0102 * i - 0.0151, 0.0103 * j - 0.0153, RADIUS + 2e-4]), turn([0.3, 0.1, -0.2])]
    };
    let spheres: Vec<_> = (0..16).map(sphere).collect();
    let mesh: Vec<Triangle> = mesh.iter().map(|corners| corners.map(turn)).collect();
    let mut simulation = start(&spheres, law, turn([0.0, 0.0, -G]), 1e-5, MESH, &mesh);
    simulation.advance(3e-3).unwrap_or_else(|error| panic!("{error}"));
    let state = simulation.state();
    assert!(state.boundaries[0].force[2].abs() > 0.0, "they touch the bumps");
    let three = |row: [f64; 4]| [row[0], row[1], row[2]];
    let slots = state.particles.slot.iter().map(|slot| *slot as usize);
    slots.map(|slot| [three(state.particles.position[slot]), three(state.particles.velocity[slot])]).collect()
}

/// Fails unless places agree to a share of the radius, and velocities to one of 0.3 m/s.
#[track_caller]
fn assert_same(found: &[[[f64; 3]; 2]], expected: &[[[f64; 3]; 2]], share: f64) {
    for (found, expected) in found.iter().zip(expected) {
        for (part, scale) in [(0, RADIUS), (1, 0.3)] {
            let apart = (0..3).map(|axis| (found[part][axis] - expected[part][axis]).abs()).fold(0.0, f64::max);
            assert!(apart <= share * scale, "{found:?} found, {expected:?} expected");
        }
    }
}

#[test]
fn order_and_orientation_of_the_triangles_do_not_matter() {
    let mesh = bumps(2e-4);
    let expected = tossed(ROUGH, &mesh, |v| v);
    let mixed = mesh.iter().rev().zip(0..).map(|([a, b, c], k)| match k % 3 {
        0 => [*a, *b, *c],
        1 => [*b, *c, *a],
        _ => [*c, *a, *b],
    });
    assert_same(&tossed(ROUGH, &mixed.collect::<Vec<_>>(), |v| v), &expected, 1e-12);
    let over: Vec<Triangle> = mesh.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    assert_same(&tossed(ROUGH, &over, |v| v), &expected, 1e-12);
}

#[test]
fn four_triangles_in_place_of_each_change_no_course() {
    let middle = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| 0.5 * (a[axis] + b[axis]));
    let four = |[a, b, c]: &Triangle| {
        let (d, e, f) = (middle(*a, *b), middle(*b, *c), middle(*c, *a));
        [[*a, d, f], [d, *b, e], [f, e, *c], [d, e, f]]
    };
    let mesh = bumps(2e-4);
    let finer: Vec<Triangle> = mesh.iter().flat_map(four).collect();
    for law in [SMOOTH, ROUGH] {
        assert_same(&tossed(law, &finer, |v| v), &tossed(law, &mesh, |v| v), 1e-10);
    }
}

#[test]
fn a_scene_that_is_turned_as_a_whole_goes_on_turned() {
    let mesh = bumps(2e-4);
    let expected: Vec<_> = tossed(ROUGH, &mesh, |v| v).into_iter().map(|both| both.map(turned)).collect();
    assert_same(&tossed(ROUGH, &mesh, turned), &expected, 1e-10);
}

#[test]
fn a_floor_and_walls_of_triangles_bear_the_weight_of_what_lies_in_them() {
    let (low, high) = (-0.0125, 0.0125);
    let corner = |x: usize, y: usize, z: f64| [[low, high][x], [low, high][y], z];
    let quad = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| [[a, b, c], [a, c, d]];
    let ring = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let mut mesh = quad(corner(0, 0, 0.0), corner(1, 0, 0.0), corner(1, 1, 0.0), corner(0, 1, 0.0)).to_vec();
    for side in 0..4 {
        let ([a, b], [c, d]) = (ring[side], ring[(side + 1) % 4]);
        mesh.extend(quad(corner(a, b, 0.0), corner(a, b, 0.05), corner(c, d, 0.05), corner(c, d, 0.0)));
    }
    let sphere = |number: usize| {
        let [i, j, k] = [number % 2, number / 2 % 2, number / 4].map(|it| it as f64);
        [[0.0125 * i - 0.00625 + 1e-4 * k, 0.0124 * j - 0.0061, 0.0051 + 0.0104 * k], [0.0; 3]]
    };
    let spheres: Vec<_> = (0..8).map(sphere).collect();
    let law = ([0.1, 0.5, 0.0], ROUGH.1);
    let mut simulation = start(&spheres, law, [0.0, 0.0, -G], 2e-5, MESH, &mesh);
    simulation.advance(1.0).unwrap_or_else(|error| panic!("{error}"));
    let force = simulation.state().boundaries[0].force;
    let weight = 8.0 * MASS * G;
    assert!((force[2] / -weight - 1.0).abs() < 1e-6, "{} N, not {} N", force[2], -weight);
}
