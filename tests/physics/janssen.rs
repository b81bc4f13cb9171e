//! In a silo whose filling slides down along the wall the pressure does not grow with depth as in a liquid: the wall bears the rest.
//!
//! Source: H. A. Janssen, *Z. Ver. Dtsch. Ing.* 39 (1895) 1045–1049. A slice has the weight ρ g A dz and the friction µ K σ π D dz on it, where the wall
//! is pressed with K σ and friction is at its limit, so σ = ρ g D/(4 µ K) (1 − exp(−4 µ K z/D)). The mean of σ_xx and σ_yy in a slice is what presses on
//! its wall, so the regions tell K; µ is that of the wall, which must be smoother than the filling is inside.

use crate::physics::stage::assert_close;
use crate::support::{start, value};
use std::f64::consts::PI;

/// Friction at the wall.
const FRICTION: f64 = 0.2;
/// Density of the grains \[kg/m³\].
const DENSITY: f64 = 2500.0;
/// Diameter of the silo \[m\].
const DIAMETER: f64 = 16e-3;
/// Standard gravity, rounded \[m/s²\].
const GRAVITY: f64 = 9.81;
/// Lower and upper end of the slices that are looked at \[m\].
const SLICES: [[f64; 2]; 3] = [[3e-3, 13e-3], [25e-3, 35e-3], [45e-3, 55e-3]];

/// A silo of which the floor is let down, slowly, from 0.06 s on: 2,000 grains, 75 mm high and 8 grains wide.
fn silo() -> String {
    let regions: String = (SLICES.iter().enumerate())
        .map(|(number, [low, high])| {
            format!(
                "[region.slice{number}]\ncylinder = {{ from = [0.0, 0.0, {low:?}], to = [0.0, 0.0, {high:?}], radius = {:?} }}\n",
                0.5 * DIAMETER
            )
        })
        .collect();
    format!(
        r#"
gravity = [0.0, 0.0, -{GRAVITY:?}]
[run]
safety = 0.8
threads = 1
[material]
grain = {{ density = {DENSITY:?}, youngs_modulus = 1.0e6, poissons_ratio = 0.25 }}
wall = {{ density = {DENSITY:?}, youngs_modulus = 1.0e6, poissons_ratio = 0.25 }}
[pair.grain]
grain = {{ restitution = 0.3, friction = 0.5 }}
wall = {{ restitution = 0.3, friction = {FRICTION:?} }}
[contact.touch.normal.hertz]
[contact.touch.tangential.history]
[particles.grains]
material = "grain"
packing = {{ cylinder = {{ from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.075], radius = 8.0e-3 }}, solid_fraction = 0.55, radius = [0.9e-3, 1.1e-3] }}
[boundary.wall]
cylinder = {{ from = [0.0, 0.0, -0.02], to = [0.0, 0.0, 0.1], radius = 8.0e-3 }}
material = "wall"
[boundary.floor]
plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
material = "grain"
motion = {{ prescribed = {{ z = {{ trapezoid = {{ distance = -2.0e-3, speed = 0.01, acceleration = 1.0, start = 0.06 }} }} }} }}
{regions}"#
    )
}

#[test]
fn the_pressure_in_a_silo_saturates_with_depth() {
    const LOOKS: usize = 60;
    let mut simulation = start(&silo());
    simulation.advance(0.12).unwrap();
    let weight = GRAVITY * simulation.state().particles.velocity.iter().map(|row| row[3]).sum::<f64>();
    let mean = |parts: &[f64]| parts.iter().sum::<f64>() / parts.len() as f64;
    let (mut along, mut across, mut solid, mut floor) =
        ([[0.0; LOOKS]; 3], [[0.0; LOOKS]; 3], [[0.0; LOOKS]; 3], [0.0; LOOKS]);
    for look in 0..LOOKS {
        simulation.advance(2e-3).unwrap();
        floor[look] = -value(&simulation, "floor.mean_force.z");
        for slice in 0..SLICES.len() {
            let of = |what: &str| value(&simulation, &format!("slice{slice}.{what}"));
            along[slice][look] = -of("stress.zz");
            across[slice][look] = -0.5 * (of("stress.xx") + of("stress.yy"));
            solid[slice][look] = 1.0 - of("porosity");
        }
    }
    let all = |parts: &[[f64; LOOKS]; 3]| mean(&parts.map(|of| mean(&of)));
    let (area, ratio, density) = (0.25 * PI * DIAMETER * DIAMETER, all(&across) / all(&along), DENSITY * all(&solid));
    let most = density * GRAVITY * DIAMETER / (4.0 * FRICTION * ratio);
    let decay = 4.0 * FRICTION * ratio / DIAMETER;
    // The floor has gone down by 1.2 mm on the average.
    let top = weight / (density * GRAVITY * area) - 1.2e-3;
    for (slice, [low, high]) in SLICES.into_iter().enumerate() {
        let depth = top - 0.5 * (low + high);
        // K is 0.7 to 1.05 in single slices, where the theory has one for all.
        let what = format!("pressure {depth} m below the top, with K = {ratio}");
        assert_close(mean(&along[slice]), most * (1.0 - (-decay * depth).exp()), 0.12, &what);
    }
    let borne = mean(&floor) / weight;
    assert!(borne < 0.4, "the floor bears {borne} of the weight");
}
