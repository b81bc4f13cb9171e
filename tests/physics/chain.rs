//! Chains of equal bonded spheres along x, as scenes.

use cograin::simulation::Simulation;
use std::f64::consts::PI;

/// Radius of the spheres and of the bonds; neighbours touch \[m\].
pub(crate) const RADIUS: f64 = 1e-3;
/// Density of the spheres \[kg/m³\].
const DENSITY: f64 = 2500.0;
/// Normal stiffness of the bonds per unit area \[Pa/m\].
const NORMAL: f64 = 1e12;
/// Tangential stiffness of the bonds per unit area \[Pa/m\].
const TANGENTIAL: f64 = 4e11;

/// Length of a bond \[m\].
pub(crate) const LENGTH: f64 = 2.0 * RADIUS;
/// Section of a bond \[m²\].
const AREA: f64 = PI * RADIUS * RADIUS;
/// Mass of a sphere \[kg\].
pub(crate) const MASS: f64 = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * DENSITY;
/// Moment of inertia of a sphere \[kg m²\].
pub(crate) const INERTIA: f64 = 0.4 * MASS * RADIUS * RADIUS;
/// k_n A: axial stiffness of a bond \[N/m\].
pub(crate) const AXIAL: f64 = NORMAL * AREA;
/// k_t A: shear stiffness of a bond \[N/m\].
pub(crate) const SHEAR: f64 = TANGENTIAL * AREA;
/// k_n I: bending stiffness of a bond \[N m\].
pub(crate) const BENDING: f64 = NORMAL * AREA * RADIUS * RADIUS / 4.0;

/// Velocity \[m/s\] and angular velocity \[rad/s\] of a sphere.
pub(crate) type Motion = [[f64; 3]; 2];

/// The scene of a chain of spheres with ids from 1 that start with these motions; `more` is the rest of its text.
pub(crate) fn chain(formulation: &str, step: f64, motions: &[Motion], more: &str) -> String {
    let body = |(place, [velocity, spin]): (usize, &Motion)| {
        let x = LENGTH * place as f64;
        format!(
            "{{ id = {}, position = [{x:?}, 0.0, 0.0], radius = {RADIUS:?}, velocity = {velocity:?}, \
             angular_velocity = {spin:?} }},\n",
            place + 1
        )
    };
    let bodies: String = motions.iter().enumerate().map(body).collect();
    format!(
        r#"
[run]
step = {step:?}
threads = 1
[material.glass]
density = {DENSITY:?}
[particles.beam]
material = "glass"
list = [
{bodies}]
[bond.beam]
formulation = "{formulation}"
between = ["beam", "beam"]
create_distance = {:?}
normal_stiffness = {NORMAL:?}
tangential_stiffness = {TANGENTIAL:?}
{more}"#,
        1.05 * LENGTH
    )
}

/// Holds the first sphere.
pub(crate) const CLAMP: &str = "[boundary.clamp]\nparticles = { set = \"beam\", ids = [1] }\n";

/// The rows of a quantity, in the order of the chain.
pub(crate) fn in_order<'a>(simulation: &'a Simulation, rows: &'a [[f64; 4]]) -> impl Iterator<Item = [f64; 4]> + 'a {
    simulation.state().particles.slot.iter().map(|&slot| rows[slot as usize])
}
