//! Spheres before a wall.

use crate::support::{Triangle, obj, start_with};
use cograin::simulation::Simulation;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Radius of the spheres \[m\].
pub(super) const RADIUS: f64 = 5e-3;

/// Their mass \[kg\].
pub(super) const MASS: f64 = 2500.0 * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;

/// Gravity \[m/s²\].
pub(super) const G: f64 = 9.81;

/// Restitution, friction, rolling friction and the law that needs them.
pub(super) type Law = ([f64; 3], &'static str);

/// No friction, no loss.
pub(super) const SMOOTH: Law = ([1.0, 0.0, 0.0], "");

/// Friction with a spring, and loss.
pub(super) const ROUGH: Law = ([0.5, 0.5, 0.0], "[contact.touch.tangential.history]\n");

/// Spheres, each with place and velocity, before the boundary `wall` of this shape.
pub(super) fn start(
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
pub(super) const MESH: &str = "mesh = { file = \"wall.obj\", sides = 2 }\n";

/// Radius of the drums \[m\].
pub(super) const DRUM: f64 = 0.05;
