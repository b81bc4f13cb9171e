//! A gas of spheres whose impacts dissipate cools down with the square of time.
//!
//! Source: P. K. Haff, *J. Fluid Mech.* 134 (1983) 401–430. Spheres of mass m and diameter d with n of them in the unit of volume and a temperature T, a third
//! of m ⟨v²⟩, have 2 √π g n² d² √(T/m) impacts in the units of volume and time. Approach speeds along the normal are distributed as v exp(−m v²/(4 T)), so their mean
//! square is 4 T/m and an impact takes (1 − e²) T. Hence 3/2 n dT/dt = −2 √π g n² d² √(T/m) (1 − e²) T, and √(T₀/T) = 1 + t/τ with
//! 1/τ = 2/3 √π (1 − e²) g n d² √(T₀/m). Pairs at touch are more frequent by g = (1 − φ/2)/(1 − φ)³ (Carnahan & Starling). In a cube of edge L a part of them
//! would lie beyond a wall: 1 − 3/2 d/L + 2/π (d/L)² are left, the mean over directions of the part that a cube shares with itself displaced by d.

use crate::physics::stage::assert_close;
use crate::support::start;
use cograin::simulation::Simulation;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;
use std::fmt::Write;

/// Spheres along an edge of the box at the start.
const EDGE: usize = 9;
/// Diameter of the spheres \[m\].
const DIAMETER: f64 = 2e-3;
/// Density of the spheres \[kg/m³\].
const DENSITY: f64 = 2500.0;
/// Part of the volume that they fill.
const FRACTION: f64 = 0.05;

/// A third of ⟨v²⟩, T/m \[m²/s²\].
fn temperature(simulation: &Simulation) -> f64 {
    let motions = &simulation.state().particles.velocity;
    motions.iter().map(|[x, y, z, _]| x * x + y * y + z * z).sum::<f64>() / (3.0 * motions.len() as f64)
}

/// A gas between smooth walls that reflect, of which the centres have this edge \[m\].
fn gas(restitution: f64, edge: f64) -> Simulation {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut even = || f64::from(random.next_u32()) / f64::from(u32::MAX) - 0.5;
    let mut list = String::new();
    for place in 0..EDGE * EDGE * EDGE {
        let [x, y, z] = [place % EDGE, place / EDGE % EDGE, place / (EDGE * EDGE)]
            .map(|along| edge * along as f64 / (EDGE - 1) as f64);
        let velocity = [even(), even(), even()];
        writeln!(
            list,
            "{{ position = [{x:?}, {y:?}, {z:?}], radius = {:?}, velocity = {velocity:?} }},",
            0.5 * DIAMETER
        )
        .unwrap();
    }
    let mut walls = String::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (side, place) in [(1.0, -0.5 * DIAMETER), (-1.0, edge + 0.5 * DIAMETER)] {
            let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
            (point[axis], normal[axis]) = (place, side);
            let which = if side > 0.0 { "low" } else { "high" };
            writeln!(
                walls,
                "{name}_{which} = {{ plane = {{ point = {point:?}, normal = {normal:?} }}, material = \"wall\" }}"
            )
            .unwrap();
        }
    }
    start(&format!(
        "[run]\nstep = 2e-6\nthreads = 1\n[material]\n\
         gas = {{ density = {DENSITY:?}, youngs_modulus = 1e9, poissons_ratio = 0.2 }}\n\
         wall = {{ density = {DENSITY:?}, youngs_modulus = 1e9, poissons_ratio = 0.2 }}\n\
         [pair.gas]\ngas = {{ restitution = {restitution:?} }}\nwall = {{ restitution = 1.0 }}\n[contact.c.normal.hertz]\n\
         [particles.p]\nmaterial = \"gas\"\nlist = [\n{list}]\n[boundary]\n{walls}"
    ))
}

#[test]
fn a_gas_cools_down_as_haff_says() {
    let sphere = PI / 6.0 * DIAMETER.powi(3);
    let count = (EDGE * EDGE * EDGE) as f64;
    let edge = (count * sphere / FRACTION).cbrt();
    let beside = DIAMETER / edge;
    let inside = 1.0 - 1.5 * beside + 2.0 / PI * beside * beside;
    let pairs = inside * (1.0 - 0.5 * FRACTION) / (1.0 - FRACTION).powi(3);
    for restitution in [0.9, 0.7] {
        let mut simulation = gas(restitution, edge);
        // Impacts make a gas of the lattice.
        simulation.advance(0.02).unwrap();
        let begun = temperature(&simulation);
        let rate = 2.0 / 3.0 * PI.sqrt() * (1.0 - restitution * restitution) * pairs * FRACTION / sphere
            * DIAMETER
            * DIAMETER
            * begun.sqrt();
        simulation.advance((1.0 / rate).min(0.2)).unwrap();
        let found = ((begun / temperature(&simulation)).sqrt() - 1.0) / (simulation.time() - 0.02);
        // Some 6,000 impacts scatter by 1.3 %, of three deviations; an impact lasts a hundredth of the time between two.
        assert_close(found, rate, 0.05, &format!("rate of cooling for e = {restitution}"));
    }
}
