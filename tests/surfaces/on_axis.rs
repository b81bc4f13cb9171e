//! A sphere on the axis of a hole, a rim, a cone or a tight pipe touches all around it. By symmetry the force is along the axis:
//! |F| cos θ, where θ is the angle of the normals to it; and it comes there continuously.

use crate::support::start;
use cograin::simulation::Simulation;

/// Radius of the sphere \[m\].
const RADIUS: f64 = 0.01;

/// Overlap on the axis \[m\].
const OVERLAP: f64 = 1e-4;

/// Effective modulus \[Pa\].
const MODULUS: f64 = 5e6 / (2.0 * (1.0 - 0.25 * 0.25));

/// Radius of the rim on which it sits \[m\].
const RIM: f64 = 0.006;

/// A sphere at this place \[m\], scaled, at this velocity \[m/s\] beside a surface.
fn sphere([x, z]: [f64; 2], velocity: [f64; 3], surface: &str) -> Simulation {
    start(&format!(
        r#"
[run]
step = 1e-6
threads = 1
[material.g]
density = 2500.0
youngs_modulus = 5e6
poissons_ratio = 0.25
[pair.g.g]
restitution = 1.0
friction = 0.0
[contact.c.normal.hertz]
[particles.p]
material = "g"
list = [{{ position = [{x:?}, 0.0, {z:?}], radius = {RADIUS:?}, velocity = {velocity:?} }}]
[boundary.s]
material = "g"
{surface}
[output]
energy = true
losses = true
"#
    ))
}

/// The force on the sphere \[N\].
fn force(place: [f64; 2], surface: &str) -> [f64; 3] {
    sphere(place, [0.0; 3], surface).state().boundaries[0].force.map(|part| -part)
}

/// Hertz' force at an overlap \[N\].
fn hertz(overlap: f64) -> f64 {
    4.0 / 3.0 * MODULUS * RADIUS.sqrt() * overlap.powf(1.5)
}

/// Seats: how each is written, the height of the sphere \[m\] and cos θ.
fn seats() -> Vec<(String, f64, f64)> {
    let height = ((RADIUS - OVERLAP).powi(2) - RIM * RIM).sqrt();
    let cosine = height / (RADIUS - OVERLAP);
    let steep = 0.5_f64.sqrt();
    vec![
        (
            format!("disc = {{ centre = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], radius = 0.05, hole = {RIM} }}"),
            height,
            cosine,
        ),
        (format!("cylinder = {{ from = [0.0, 0.0, -0.05], to = [0.0, 0.0, 0.0], radius = {RIM} }}"), height, cosine),
        (
            format!(
                "revolution = {{ origin = [0.0, 0.0, 0.0], axis = [0.0, 0.0, 2.0], profile = [[{RIM}, -0.05], [{RIM}, 0.0], [0.05, 0.0]] }}"
            ),
            height,
            cosine,
        ),
        (
            "cone = { from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.1], radii = [0.0, 0.1] }".to_owned(),
            (RADIUS - OVERLAP) / steep,
            steep,
        ),
        (
            "cone = { from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.1], radii = [0.002, 0.102] }".to_owned(),
            (RADIUS - OVERLAP) / steep - 0.002,
            steep,
        ),
        ("cylinder = { from = [0.0, 0.0, -0.05], to = [0.0, 0.0, 0.05], radius = 0.0099 }".to_owned(), 0.003, 0.0),
        (
            "cylinder = { from = [0.0, 0.0, -0.05], to = [0.0, 0.0, 0.05], radius = 0.0099, infinite = true }"
                .to_owned(),
            0.003,
            0.0,
        ),
    ]
}

#[test]
fn on_the_axis_the_force_is_along_it() {
    for (seat, height, cosine) in seats() {
        let (found, expected) = (force([0.0, height], &seat), cosine * hertz(OVERLAP));
        let off = [found[0], found[1], found[2] - expected].iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        assert!(off < 1e-9 * hertz(OVERLAP), "{found:?} is not {expected} along the axis: {seat}");
    }
}

#[test]
fn beside_the_axis_the_force_comes_to_that_on_it_without_a_jump() {
    for (seat, height, cosine) in seats() {
        // From where the far side is out of touch to the axis: no difference of two neighbours is more than their distance makes of
        // the stiffness of the contact.
        let stiffness = 2.0 * MODULUS * (RADIUS * OVERLAP).sqrt();
        let (mut before, steps) = (force([0.0, height], &seat), 400);
        for step in 1..=steps {
            let way = 4.0 * OVERLAP / f64::from(steps);
            let found = force([way * f64::from(step), height], &seat);
            let jump = (0..3).map(|axis| (found[axis] - before[axis]).powi(2)).sum::<f64>().sqrt();
            assert!(jump < 6.0 * stiffness * way, "{before:?} and {found:?} are {way:e} m apart: {seat}");
            before = found;
        }
        for beside in [1e-15, 1e-12, 1e-9] {
            let found = force([beside, height], &seat);
            let lateral = (found[0] * found[0] + found[1] * found[1]).sqrt();
            assert!(lateral < 6.0 * stiffness * beside && found[0] <= 0.0, "{found:?} at {beside:e} m: {seat}");
            assert!((found[2] - cosine * hertz(OVERLAP)).abs() < 1e-4 * hertz(OVERLAP), "{found:?}: {seat}");
        }
    }
}

#[test]
fn the_force_beside_the_axis_is_the_slope_of_the_energy() {
    for (seat, height, _) in seats() {
        let energy = |x: f64, z: f64| sphere([x, z], [0.0; 3], &seat).elastic_energy();
        for x in [0.0, 1e-5, 3e-5, 5e-5, 8e-5, 1.3e-4, 2e-4, 3.5e-4] {
            let found = force([x, height], &seat);
            let h = 1e-8;
            let slope = [
                (energy(x - h, height) - energy(x + h, height)) / (2.0 * h),
                (energy(x, height - h) - energy(x, height + h)) / (2.0 * h),
            ];
            let off = (found[0] - slope[0]).abs().max((found[2] - slope[1]).abs());
            assert!(off < 1e-5 * hertz(2.0 * OVERLAP), "{found:?} at {x:e} m, slope {slope:?}: {seat}");
        }
    }
}

#[test]
fn a_sphere_that_is_thrown_into_a_seat_keeps_its_energy() {
    for (seat, height, cosine) in seats() {
        let up = if cosine > 0.0 { 2e-4 / cosine } else { 0.0 };
        for x in [0.0, 2e-5, 1.7e-4] {
            let mut simulation = sphere([x, height + up], [0.013, 0.007, -0.3], &seat);
            let start = simulation.kinetic_energy() + simulation.elastic_energy();
            for _ in 0..40 {
                simulation.advance(2e-4).unwrap();
                let now = simulation.kinetic_energy() + simulation.elastic_energy();
                assert!((now / start - 1.0).abs() < 2e-3, "{now:e} J of {start:e} J from x = {x:e} m: {seat}");
            }
        }
    }
}

#[test]
fn a_ball_in_a_tight_pipe_stays() {
    for (seat, height, _) in seats().into_iter().filter(|(_, _, cosine)| *cosine == 0.0) {
        let mut simulation = sphere([0.0, height], [0.0; 3], &seat);
        simulation.advance(0.01).unwrap();
        let velocity = simulation.state().particles.velocity[0];
        assert_eq!(velocity[..3], [0.0; 3], "{seat}");
        assert_eq!(simulation.state().walls[0].particle.len(), 1, "{seat}");
    }
}
