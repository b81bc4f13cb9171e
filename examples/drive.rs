//! Drives the model `piston` as a coupled program does: lifts the piston, and prints the force of the grains on it.
//!
//! `cargo run --release --example drive`
#![allow(clippy::print_stdout, reason = "an example prints what it finds")]

use cograin::interface::{Interface, Value};
use cograin::scene::Scene;
use cograin::simulation::Simulation;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let (scene, _) = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("models/piston/scene.toml"))?;
    let interface = Interface::of(&scene);
    let find = |name: &str| interface.find(name).ok_or_else(|| format!("the scene has no variable {name}"));
    let (lift, force) = (find("piston.displacement.z")?, find("piston.mean_force.z")?);
    let mut simulation = Simulation::new(Arc::new(scene))?;
    for step in 1..=50 {
        interface.set(&mut simulation, lift, Value::Real(2e-5 * f64::from(step)))?;
        simulation.advance(1e-3)?;
        println!("{:.3} s: {:+.3e} N", simulation.time(), interface.value(&simulation, force).number());
    }
    Ok(())
}
