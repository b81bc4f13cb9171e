//! What the particles lose the surfaces get: force, moment, work.

use super::scenes::{FullBox, ROUGH, drum, scene, sheet};
use crate::support::Triangle;
use cograin::quantity::BoundaryIndex;
use cograin::scene::{Scene, SceneDraft};
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::sync::Arc;

/// Spheres in a turning drum with a bumpy sheet on the way, rough.
fn tumbling() -> Arc<Scene> {
    let mut places = Vec::new();
    for i in 0..4 {
        for j in 0..3 {
            for k in 0..3 {
                places.push([
                    0.011 * f64::from(i) - 0.0165,
                    0.011 * f64::from(j) - 0.011,
                    0.0108 * f64::from(k) - 0.03,
                ]);
            }
        }
    }
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut bumps = sheet(&mut rng, 2e-3);
    bumps.iter_mut().flatten().for_each(|corner| corner[2] -= 0.041);
    let boundaries = "[boundary.wall]\nmaterial = \"wall\"\nmesh = { file = \"wall.stl\", sides = 2 }\n\
                      motion = { driven = [\"x\", \"z\", \"rotation.y\"] }\nreference = [0.0, 0.0, 0.01]\n\
                      [boundary.bumps]\nmaterial = \"wall\"\nmesh = { file = \"bumps.stl\" }\n\
                      motion = { driven = [\"z\"] }\n[output]\nenergy = true\n";
    let scene = scene(&places, ROUGH, boundaries, &[("wall.stl", drum(48, 0.03)), ("bumps.stl", bumps)]);
    let mut scene = SceneDraft::clone(&scene);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.run.step = cograin::scene::Step::Given(2e-5);
    Arc::new(scene.build().unwrap())
}

/// Moves the boundaries of [`tumbling`] through a communication step.
fn drive(simulation: &mut Simulation, step: u32) {
    let wave = 2e-4 * f64::from(step % 5) - 3e-4;
    simulation.set_input(BoundaryIndex(0), 0, wave);
    simulation.set_input(BoundaryIndex(0), 2, 0.5 * wave);
    simulation.set_input(BoundaryIndex(0), 4, 0.01 * f64::from(step));
    simulation.set_input(BoundaryIndex(1), 2, 1e-4 * f64::from(step % 3));
    simulation.advance(3.3e-4 + 1e-5 * f64::from(step % 3)).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn change_of_work_is_mean_force_times_displacement_and_mean_moment_times_turn() {
    let mut simulation = Simulation::new(tumbling()).unwrap();
    let mut turnover = 0.0_f64;
    for step in 1..150 {
        let before = simulation.state().boundaries.clone();
        drive(&mut simulation, step);
        for (before, after) in before.iter().zip(&simulation.state().boundaries) {
            let moved = |axis: usize| after.displacement[axis] - before.displacement[axis];
            let turned = |axis: usize| after.rotation[axis] - before.rotation[axis];
            let expected: f64 = -(0..3)
                .map(|axis| after.mean_force[axis] * moved(axis) + after.mean_moment[axis] * turned(axis))
                .sum::<f64>();
            let found = after.work - before.work;
            turnover += found.abs();
            assert!((found - expected).abs() <= 1e-11 * turnover.max(1e-9), "{found:e} J, not {expected:e} J");
        }
    }
    assert!(simulation.contact_count() > 5, "{} contacts", simulation.contact_count());
    assert!(turnover > 1e-4, "the boundaries worked: {turnover:e} J");
}

/// Force and moment on all particles and surfaces together, about the origin, but for gravity, and the forces on the particles added up as
/// numbers \[N, N m, N\].
fn unbalanced(simulation: &Simulation, gravity: [f64; 3]) -> ([f64; 3], [f64; 3], f64) {
    let state = simulation.state();
    let (mut force, mut moment, mut turnover) = ([0.0; 3], [0.0; 3], 0.0);
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    for slot in 0..state.particles.len() {
        let row = |row: [f64; 4]| [row[0], row[1], row[2]];
        let (load, mass) = (row(state.particles.force[slot]), state.particles.velocity[slot][3]);
        let load = [0, 1, 2].map(|axis| load[axis] - mass * gravity[axis]);
        let about = cross(row(state.particles.position[slot]), load);
        for axis in 0..3 {
            force[axis] += load[axis];
            moment[axis] += about[axis] + state.particles.torque[slot][axis];
            turnover += load[axis].abs();
        }
    }
    for boundary in &state.boundaries {
        let about = cross(boundary.pivot, boundary.force);
        for axis in 0..3 {
            force[axis] += boundary.force[axis];
            moment[axis] += about[axis] + boundary.moment[axis];
        }
    }
    (force, moment, turnover)
}

#[test]
fn what_the_particles_lose_the_surfaces_get() {
    let mut simulation = Simulation::new(tumbling()).unwrap();
    (1..100).for_each(|step| drive(&mut simulation, step));
    let (force, moment, turnover) = unbalanced(&simulation, [0.0, 0.0, -9.81]);
    assert!(turnover > 0.01, "{turnover} N");
    assert!(force.iter().all(|part| part.abs() < 1e-12 * turnover), "{force:?} N of {turnover} N");
    assert!(moment.iter().all(|part| part.abs() < 1e-12 * 0.05 * turnover), "{moment:?} N m");
}

/// A ball of 512 triangles about the origin with this radius \[m\], its corners counter-clockwise as seen from outside.
fn ball(radius: f64) -> Vec<Triangle> {
    let signs = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let eighth = |[x, y]: [f64; 2], z: f64| {
        let corners = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
        if x * y * z > 0.0 { corners } else { [corners[1], corners[0], corners[2]] }
    };
    let mut triangles: Vec<Triangle> =
        signs.into_iter().flat_map(|sign| [eighth(sign, 1.0), eighth(sign, -1.0)]).collect();
    let out = |point: [f64; 3]| {
        let length = point.map(|part| part * part).iter().sum::<f64>().sqrt();
        point.map(|part| part / length)
    };
    for _ in 0..3 {
        let middle = |a: [f64; 3], b: [f64; 3]| out([0, 1, 2].map(|axis| a[axis] + b[axis]));
        let four = |[a, b, c]: Triangle| {
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        triangles = triangles.into_iter().flat_map(four).collect();
    }
    triangles.into_iter().map(|corners| corners.map(|corner| corner.map(|part| radius * part))).collect()
}

#[test]
fn a_closed_body_in_a_bed_gets_what_the_particles_lose() {
    let full = FullBox::turned(2, |place| place);
    let far = |place: &&[f64; 3]| place.map(|part| part * part).iter().sum::<f64>().sqrt() > 0.0165;
    let places: Vec<[f64; 3]> = full.places.iter().filter(far).copied().collect();
    let boundaries = format!("{}[boundary.body]\nmaterial = \"wall\"\nmesh = {{ file = \"ball.stl\" }}\n", full.planes);
    let mut scene = SceneDraft::clone(&scene(&places, ROUGH, &boundaries, &[("ball.stl", ball(0.011))]));
    scene.gravity = [0.0, 0.0, -98.1];
    scene.run.step = cograin::scene::Step::Given(2e-5);
    let mut simulation = Simulation::new(Arc::new(scene.build().unwrap())).unwrap_or_else(|error| panic!("{error}"));
    simulation.advance(0.1).unwrap_or_else(|error| panic!("{error}"));
    let (force, moment, turnover) = unbalanced(&simulation, [0.0, 0.0, -98.1]);
    assert!(simulation.state().boundaries[6].force[2].abs() > 1e-3 * turnover, "the bed lies on the body");
    assert!(force.iter().all(|part| part.abs() < 1e-12 * turnover), "{force:?} N of {turnover} N");
    assert!(moment.iter().all(|part| part.abs() < 1e-12 * 0.05 * turnover), "{moment:?} N m");
}

#[test]
fn a_saved_state_gives_the_same_bits() {
    let run = |simulation: &mut Simulation, steps: std::ops::Range<u32>| steps.for_each(|step| drive(simulation, step));
    let mut one = Simulation::new(tumbling()).unwrap();
    run(&mut one, 1..60);
    let middle = one.state().clone();
    run(&mut one, 60..100);
    assert!(one.state().clock.rebuilds > 2, "the lists were made anew");
    let mut again = Simulation::resume(tumbling(), middle).unwrap();
    run(&mut again, 60..100);
    assert_eq!(one.state().fingerprint(), again.state().fingerprint());
}
