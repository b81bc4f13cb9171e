//! A blow on the end of a chain of equal spheres that touch runs along it as a solitary wave, which keeps its height and is the faster the
//! higher it is.
//!
//! Source: V. F. Nesterenko, *J. Appl. Mech. Tech. Phys.* 24 (1983) 733–743. With F = A δ^1.5 between neighbours, spheres of mass m and diameter a,
//! long waves of the strain ξ = −∂u/∂x obey u_tt = −c² ∂/∂x (ξ^1.5 + a²/10 ξ^¼ ∂²ξ^1.25/∂x²), c² = A a^2.5/m. A wave that moves at V is
//! ξ = (5 V²/(4 c²))² cos⁴(√10 x/(5 a)), one arch long, so its largest force F = A (a ξ)^1.5 gives V² = ⅘ A^⅔ a² F^⅓/m. With A of two spheres,
//! E √a/(3 (1 − ν²)), and m = π/6 ρ a³ this is V = 0.680 (2 E/(a ρ^1.5 (1 − ν²)))^⅓ F^⅙, of which the literature has 0.682.

use crate::physics::chain::in_order;
use crate::physics::stage::assert_close;
use crate::support::start;
use std::f64::consts::PI;
use std::fmt::Write;

/// Young's modulus \[Pa\], Poisson's ratio, density \[kg/m³\] and diameter \[m\] of the spheres.
/// Young's modulus of the spheres \[Pa\].
const MODULUS: f64 = 1e9;
/// Their Poisson's ratio.
const RATIO: f64 = 0.2;
/// Their density \[kg/m³\].
const DENSITY: f64 = 2500.0;
/// Their diameter \[m\].
const DIAMETER: f64 = 2e-3;
/// How many there are.
const COUNT: usize = 60;
/// Contacts at which the wave is looked at: it has its shape long before the first, and the ends are far from both.
const LOOKS: [usize; 2] = [25, 45];

/// A in F = A δ^1.5 \[N/m^1.5\].
fn stiffness() -> f64 {
    MODULUS * DIAMETER.sqrt() / (3.0 * (1.0 - RATIO * RATIO))
}

/// Speed of the long wave of this largest force \[m/s\].
fn speed(force: f64) -> f64 {
    let mass = PI / 6.0 * DENSITY * DIAMETER.powi(3);
    (0.8 * stiffness().powf(2.0 / 3.0) * DIAMETER * DIAMETER * force.cbrt() / mass).sqrt()
}

/// Largest force \[N\] at both places, and the speed from one to the other \[m/s\], after a blow of this speed \[m/s\] on the first sphere.
fn found(blow: f64) -> ([f64; 2], f64) {
    let mut list = String::new();
    for place in 0..COUNT {
        let (x, velocity) = (DIAMETER * place as f64, if place == 0 { blow } else { 0.0 });
        writeln!(
            list,
            "{{ position = [{x:?}, 0.0, 0.0], radius = {:?}, velocity = [{velocity:?}, 0.0, 0.0] }},",
            0.5 * DIAMETER
        )
        .unwrap();
    }
    // 400 steps while a wave passes a sphere.
    let step = 2e-3 * (DIAMETER / blow).powf(0.2) * (DIAMETER * (DENSITY / MODULUS).sqrt()).powf(0.8);
    let text = format!(
        "[run]\nstep = {step:?}\nthreads = 1\n[material.g]\ndensity = {DENSITY:?}\nyoungs_modulus = {MODULUS:?}\npoissons_ratio = {RATIO:?}\n\
         [pair.g.g]\nrestitution = 1.0\n[contact.c.normal.hertz]\n[particles.p]\nmaterial = \"g\"\nlist = [\n{list}]\n"
    );
    let mut simulation = start(&text);
    let mut peaks = [[0.0; 2]; 2];
    let mut before = [[0.0; 2]; 2];
    // A solitary wave takes less than twice the time of one that would have the blow's speed as that of its spheres.
    while simulation.state().clock.steps < 200_000 && peaks[1][0] * 0.5 <= before[1][0] {
        simulation.advance(step).unwrap();
        let places: Vec<f64> =
            in_order(&simulation, &simulation.state().particles.position).map(|row| row[0]).collect();
        for (look, contact) in LOOKS.into_iter().enumerate() {
            let overlap = DIAMETER - (places[contact + 1] - places[contact]);
            let force = stiffness() * overlap.max(0.0).powf(1.5);
            let [last, second] = before[look];
            if last > peaks[look][0] && force < last {
                // Between three looks lies the top of a parabola.
                let beside = 0.5 * (second - force) / (second - 2.0 * last + force);
                peaks[look] = [last, simulation.time() + step * (beside - 1.0)];
            }
            before[look] = [force, last];
        }
    }
    let [[first, begun], [second, ended]] = peaks;
    ([first, second], DIAMETER * (LOOKS[1] - LOOKS[0]) as f64 / (ended - begun))
}

#[test]
fn a_blow_runs_along_a_chain_as_a_solitary_wave() {
    let waves = [0.01, 1.0].map(found);
    for ([first, second], speed_found) in waves {
        // What the blow leaves behind it still takes 1e-4 of the height between both places.
        assert_close(second, first, 1e-3, "height of the wave, which it keeps");
        // The wave is five spheres long. A chain of points on springs, integrated by itself, is faster than the long wave by 1.2 %.
        assert_close(speed_found, 1.0124 * speed(second), 2e-3, "speed of the wave");
    }
    let [(low, slow), (high, fast)] = waves;
    let power = (fast / slow).ln() / (high[1] / low[1]).ln();
    assert!((power - 1.0 / 6.0).abs() < 1e-4, "the speed grows with the force to the power {power}, not 1/6");
}
