//! Clumps in cells.

use crate::support::DRIVEN;
use cograin::interface::{Interface, Value};
use cograin::simulation::Simulation;

/// Spheres of this modulus and Poisson's ratio 0.25.
pub(super) const LAW: &str = r#"
[material.a]
density = 2500.0
youngs_modulus = 1e7
poissons_ratio = 0.25
[contact.touch.normal.hertz]
"#;

/// Clumps of three spheres and loose ones in a cell, that are pressed together; each at a place and turned as a generator says.
pub(super) fn dense(pair: &str, more: &str, shift: [f64; 3], threads: usize) -> String {
    format!(
        r#"
[run]
step = 5e-6
threads = {threads}
{LAW}
[contact.touch.tangential.history]
[pair.a.a]
{pair}
[clump.bent]
spheres = [
    {{ position = [0.0, 0.0, 0.0], radius = 0.002 }},
    {{ position = [0.003, 0.0, 0.0], radius = 0.002 }},
    {{ position = [0.003, 0.003, 0.0], radius = 0.0015 }},
]
[particles.bent]
material = "a"
clump = "bent"
orientation = "random"
lattice = {{ kind = "simple_cubic", origin = {:?}, counts = [4, 4, 3], radius = 0.0039, spacing = 0.008 }}
[particles.loose]
material = "a"
lattice = {{ kind = "simple_cubic", origin = {:?}, counts = [7, 7, 1], radius = 0.0019, spacing = 0.0045 }}
[cell]
edges = [[0.032, 0.0, 0.0], [0.0, 0.032, 0.0], [0.0, 0.0, 0.028]]
{DRIVEN}
[output]
energy = true
losses = true
{more}
"#,
        shift,
        [shift[0], shift[1], shift[2] + 0.022],
    )
}

/// Strains a cell at once, in one communication step, by its inputs.
pub(super) fn strain(simulation: &mut Simulation, strains: &[(&str, f64)], interval: f64) {
    let interface = Interface::of(simulation.scene());
    for (name, value) in strains {
        let input = interface.find(&format!("cell.strain.{name}")).expect("an input");
        interface.set(simulation, input, Value::Real(*value)).expect("a strain");
    }
    simulation.advance(interval).expect("it runs");
}

/// The strains in the order of the program.
pub(super) const STRAINS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];
