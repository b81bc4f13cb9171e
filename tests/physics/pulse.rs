//! A wave packet runs along a chain of bonds with its group velocity, c₀ cos(q a/2).

use crate::physics::chain::{AXIAL, LENGTH, MASS, Motion, chain, in_order};
use crate::physics::stage::assert_close;
use crate::support::start;

/// Spheres of the chain, which is free at both ends; the packet starts in its middle.
const SPHERES: usize = 601;

/// Width of the packet, in bonds.
const WIDTH: f64 = 25.0;

/// Two spheres at which the packet is awaited, in bonds from where it starts: four widths and eight.
const PLACES: [usize; 2] = [100, 200];

/// Mean time of passage of the packet at two spheres to the right, a hundred bonds apart, as velocity \[m/s\].
fn found(wave: f64, step: f64) -> f64 {
    let middle = (SPHERES / 2) as f64;
    let speed = |sphere: usize| {
        let away = sphere as f64 - middle;
        1e-3 * (-0.5 * (away / WIDTH).powi(2)).exp() * (wave * away).cos()
    };
    let motions: Vec<Motion> = (0..SPHERES).map(|sphere| [[speed(sphere), 0.0, 0.0], [0.0; 3]]).collect();
    let mut simulation = start(&chain("finite_rotation", step, &motions, ""));
    let (mut weights, mut times) = ([0.0; 2], [0.0; 2]);
    // Until it is past the second sphere by four widths; what comes back from the end is as far away again.
    let end = LENGTH * (PLACES[1] as f64 + 4.0 * WIDTH) / group_velocity(wave);
    while simulation.time() < end {
        simulation.advance(4.0 * step).unwrap();
        let velocity: Vec<_> = in_order(&simulation, &simulation.state().particles.velocity).collect();
        for (index, place) in PLACES.into_iter().enumerate() {
            let speed = velocity[SPHERES / 2 + place][0];
            weights[index] += speed * speed;
            times[index] += speed * speed * simulation.time();
        }
    }
    let [first, second] = [0, 1].map(|index| times[index] / weights[index]);
    LENGTH * (PLACES[1] - PLACES[0]) as f64 / (second - first)
}

/// c₀ cos(q a/2), with c₀ = a √(k/m) \[m/s\].
fn group_velocity(wave: f64) -> f64 {
    LENGTH * (AXIAL / MASS).sqrt() * (wave / 2.0).cos()
}

#[test]
fn a_packet_arrives_with_the_group_velocity() {
    let step = 0.1 * (MASS / AXIAL).sqrt();
    for wave in [0.3, 1.0, 2.0] {
        let (found, expected) = (found(wave, step), group_velocity(wave));
        let what = format!("q a = {wave}");
        assert_close(found, expected, 1e-2, &what);
        // Velocity Verlet makes 2/Δt arcsin(ω Δt/2) of ω, which hastens the packet: by 3.6e-3 with q = 2/a. Its width
        // delays it, as the slow parts count most: the mean of 1/c² over that of 1/c, to the square of its spread in q.
        let half = (AXIAL / MASS).sqrt() * (wave / 2.0).sin() * step;
        let tangent = (wave / 2.0).tan();
        let delay = (1.0 + 4.0 * tangent * tangent) / (16.0 * WIDTH * WIDTH);
        assert_close(found, expected * (1.0 - delay) / (1.0 - half * half).sqrt(), 5e-5, &what);
    }
}
